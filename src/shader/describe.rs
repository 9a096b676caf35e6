//! What the GPU would get for a scene, as text: `plumb dump --stage features|buffers|wgsl`. Opens no device.

use std::fmt::Write as _;

use super::binding::BINDINGS;
use super::compose::{Entry, compose};
use super::feature::Feature;
use super::feature_set::{FeatureSet, SOFTWARE_LANES};
use super::pack::Packed;
use crate::scene::Scene;
use crate::settings::Settings;

fn packed(scene: &Scene, settings: &Settings) -> (Packed, FeatureSet) {
    let packed = Packed::new(scene, settings);
    let features = FeatureSet::new(&packed, settings, SOFTWARE_LANES).for_a_file(true);
    (packed, features)
}

/// The features, one a line.
pub fn features(scene: &Scene, settings: &Settings) -> String {
    let (packed, features) = packed(scene, settings);
    let mut text = String::new();
    let mut names: Vec<&str> = features.features().into_iter().map(Feature::name).collect();
    names.sort_unstable();
    for name in names {
        text.push_str(name);
        text.push('\n');
    }
    for kind in &features.kinds {
        text.push_str(&kind.name().to_lowercase());
        text.push('\n');
    }
    writeln!(
        text,
        "objects tested by a ray: {} of {}",
        packed.tested(),
        packed.objects.len()
    )
    .unwrap_or_default();
    text
}

/// The packed records, one a line.
pub fn buffers(scene: &Scene, settings: &Settings) -> String {
    let (packed, _) = packed(scene, settings);
    let mut text = format!("{:?}\n", packed.camera);
    for binding in BINDINGS {
        if let Some(contents) = binding.contents {
            contents(&packed).describe(binding.name, &mut text);
        }
    }
    text
}

/// The composed shader.
pub fn wgsl(scene: &Scene, settings: &Settings) -> String {
    let (packed, features) = packed(scene, settings);
    compose(&packed, &features, Entry::Picture)
}

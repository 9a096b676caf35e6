//! What the GPU would get for a scene, as text: `plumb dump --stage features|buffers|wgsl`. Opens no device.

use std::fmt::Write as _;

use super::compose::compose;
use super::device::SOFTWARE_LANES;
use super::features::FeatureSet;
use super::pack::Packed;
use crate::scene::Scene;
use crate::settings::Settings;

fn packed(scene: &Scene, settings: &Settings) -> (Packed, FeatureSet) {
    let packed = Packed::new(scene, settings);
    let features = FeatureSet::new(&packed, settings, SOFTWARE_LANES);
    (packed, features)
}

/// The features, one a line.
pub fn features(scene: &Scene, settings: &Settings) -> String {
    let (packed, features) = packed(scene, settings);
    let mut text = String::new();
    for name in features.names() {
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
    fn list<T: std::fmt::Debug>(text: &mut String, name: &str, records: &[T]) {
        if records.is_empty() {
            return;
        }
        let bytes = size_of_val(records);
        writeln!(
            text,
            "{name}: {} records of {} bytes, {bytes} in all",
            records.len(),
            size_of::<T>()
        )
        .unwrap_or_default();
        for (i, record) in records.iter().enumerate() {
            writeln!(text, "  {i}: {record:?}").unwrap_or_default();
        }
    }
    list(&mut text, "objects", &packed.objects);
    list(&mut text, "planes", &packed.planes);
    list(&mut text, "spheres", &packed.spheres);
    list(&mut text, "sphere_points", &packed.sphere_points);
    list(&mut text, "tiled_planes", &packed.tiled_planes);
    list(&mut text, "pplanes", &packed.pplanes);
    list(&mut text, "rectangles", &packed.rectangles);
    list(&mut text, "tile lists", &packed.tile_lists());
    list(&mut text, "bvh", &packed.bvh);
    list(&mut text, "texplanes", &packed.texplanes);
    if !packed.tables.words.is_empty() {
        writeln!(
            text,
            "tables: {} words, {} columns",
            packed.tables.words.len(),
            packed.tables.columns
        )
        .unwrap_or_default();
    }
    if let Some(lit) = &packed.lit {
        list(&mut text, "lit objects", &lit.objects);
        list(&mut text, "materials", &lit.materials);
        list(&mut text, "lights", &lit.lights);
        list(&mut text, "world_planes", &lit.planes);
        list(&mut text, "world_spheres", &lit.spheres);
    }
    text
}

/// The composed shader.
pub fn wgsl(scene: &Scene, settings: &Settings) -> String {
    let (packed, features) = packed(scene, settings);
    compose(&packed, &features)
}

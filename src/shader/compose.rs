//! The WGSL for exactly one scene, put together from the files of `shaders/`, whose directives
//! [`preprocess`](super::preprocess) resolves.
//!
//! `//#insert` is replaced by what is written here: records' structs, bindings, the objects of a small scene as
//! literals, the procedural shaders used. Helpers that only some shaders call (`color_wheel`, `pplane_odd`, …) come in
//! when a text that does come in names them.

use std::fmt::Write as _;

use super::binding;
use super::constants::constants;
use super::double::double;
use super::feature::{Feature, Features};
use super::feature_set::FeatureSet;
use super::format::Format;
use super::kind::SurfaceKind;
use super::pack::Packed;
use super::preprocess::{Directives, preprocess};
use super::record::{Layout, Record as _};
use super::records::{self, CameraNumbers, wide};

/// What the composed shader's entry point makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entry {
    /// Pixels of a picture.
    Picture,
    /// A single pixel before it is quantised, with its error bounds.
    Pixel,
    /// What primary rays meet first, and how far away.
    FirstHit,
    /// Pixels of a list, again.
    Listed,
}

impl Entry {
    fn file(self) -> &'static str {
        match self {
            Self::Picture => include_str!("../../shaders/entry/picture.wgsl"),
            Self::Pixel => include_str!("../../shaders/entry/pixel.wgsl"),
            Self::FirstHit => include_str!("../../shaders/entry/first_hit.wgsl"),
            Self::Listed => include_str!("../../shaders/entry/listed.wgsl"),
        }
    }
}

/// A file of `shaders/`, and which features ask for it.
type File = (&'static str, fn(&Features) -> bool);

macro_rules! file {
    ($name:literal, $needed:expr) => {
        (include_str!(concat!("../../shaders/", $name)), $needed)
    };
}

/// The files of every entry point, in their order.
const FILES: [File; 17] = [
    file!("bindings.wgsl", |_| true),
    file!("camera.wgsl", |_| true),
    file!("unit.wgsl", |f| f.contains(&Feature::Certified)
        && (f.contains(&Feature::Lit)
            || f.contains(&Feature::Quadric))),
    file!("jitter.wgsl", |f| f.contains(&Feature::Samples)
        && !f.contains(&Feature::Course)),
    file!("plane.wgsl", |f| [
        Feature::Plane,
        Feature::Polygon,
        Feature::Lit
    ]
    .iter()
    .any(|feature| f.contains(feature))),
    file!("sphere.wgsl", |f| f.contains(&Feature::Sphere)
        || f.contains(&Feature::LitSphere)),
    file!("bvh.wgsl", |f| f.contains(&Feature::Bvh)),
    file!("surface.wgsl", |f| f.contains(&Feature::AnyObject)),
    file!("world.wgsl", |f| f.contains(&Feature::Lit)),
    file!("glint.wgsl", |f| f.contains(&Feature::Glint)
        && f.contains(&Feature::Certified)),
    file!("projector.wgsl", |f| f.contains(&Feature::Projector)),
    file!("light.wgsl", |f| f.contains(&Feature::Lit)),
    file!("quadric.wgsl", |f| f.contains(&Feature::Quadric)),
    file!("closest.wgsl", |f| f.contains(&Feature::AnyObject)),
    file!("point.wgsl", |f| f.contains(&Feature::AnyObject)),
    file!("branch.wgsl", |f| f.contains(&Feature::Branches)),
    file!("trace.wgsl", |_| true),
];

/// Writes the shader for a packed scene.
///
/// # Panics
/// If a file of `shaders/` has a directive that means nothing: a test goes through all of them.
pub fn compose<F: Format>(packed: &Packed<F>, set: &FeatureSet, entry: Entry) -> String {
    compose_with(packed, set, &set.features(), entry)
}

/// The same with just these features.
pub(crate) fn compose_with<F: Format>(
    packed: &Packed<F>,
    set: &FeatureSet,
    features: &Features,
    entry: Entry,
) -> String {
    let insert = |what: &str| insertion(what, packed, set, features);
    let mut text = String::new();
    let needed = FILES.iter().filter(|(_, needed)| needed(features));
    for file in needed.map(|(file, _)| *file).chain([entry.file()]) {
        text.push('\n');
        resolve(file, features, &insert, &mut text);
    }
    if features.contains(&Feature::Moving) {
        // Constants of the text are fields of `Dispatch` while the camera moves.
        for field in CameraNumbers::LAYOUT.members() {
            let constant = format!("CAMERA_{}", field.name.to_uppercase());
            text = text.replace(&constant, &format!("dispatch.camera_{}", field.name));
        }
    }
    let text = constants(packed, set, features) + &text;
    if F::DOUBLE { double(&text) } else { text }
}

fn resolve(
    file: &str,
    features: &Features,
    insert: &dyn Fn(&str) -> Option<String>,
    text: &mut String,
) {
    let directives = Directives {
        holds: &|name| Some(features.contains(&Feature::named(name)?)),
        insert,
        certified: features.contains(&Feature::Certified),
    };
    if let Err(error) = preprocess(file, &directives, text) {
        let first = file.lines().next().unwrap_or_default();
        unreachable!("the file of shaders/ that begins with `{first}`: {error}");
    }
}

/// The text for `//#insert what`.
fn insertion<F: Format>(
    what: &str,
    packed: &Packed<F>,
    set: &FeatureSet,
    features: &Features,
) -> Option<String> {
    Some(match what.split(' ').collect::<Vec<_>>()[..] {
        ["struct", name] => layout(name)?.definition(),
        ["members", name] => layout(name)?.member_lines(""),
        ["members", name, prefix] => layout(name)?.member_lines(prefix),
        ["bindings"] => binding::declarations(features),
        ["procedural"] => {
            let shaders = set.procedural();
            shaders
                .iter()
                .map(|shader| format!("\n{}", shader.wgsl))
                .collect()
        }
        ["ambient_cases"] => {
            let [lit, certified] =
                [Feature::Lit, Feature::Certified].map(|f| features.contains(&f));
            let case = |kind: &SurfaceKind| kind.ambient_case(lit, certified);
            set.kinds.iter().filter_map(case).collect()
        }
        ["unrolled"] => unrolled(packed, set),
        ["unrolled_closest"] => unrolled_world(packed, set, |hits, object, group| {
            format!("nearer_secondary(&closest, {hits}, {object}u, {group}u, range);")
        }),
        ["unrolled_any"] => unrolled_world(packed, set, |hits, _, _| {
            format!("found = max(found, occludes({hits}, range));")
        }),
        _ => return None,
    })
}

fn layout(name: &str) -> Option<&'static Layout> {
    records::layouts().find(|layout| layout.name == name)
}

/// The objects of a small scene as literals, for primary rays: no load, no loop. Polygons come first: of objects that
/// share a surface a plane without end is the last that counts.
fn unrolled<F: Format>(packed: &Packed<F>, features: &FeatureSet) -> String {
    let mut text = String::new();
    if !features.unrolled {
        return text;
    }
    let mut line = |hits: &str, record: String, object: u32, index: usize, group: u32| {
        writeln!(
            text,
            "    nearer(&closest, {hits}({record}, ray), {object}u, {index}u, {group}u);"
        )
        .unwrap_or_default();
    };
    for (i, r) in packed.polygons.iter().enumerate() {
        let polygon: wide::Polygon = F::wide(r);
        line(
            "polygon_hits",
            r.literal(),
            polygon.object,
            i,
            polygon.group,
        );
    }
    for (i, p) in packed.planes.iter().enumerate() {
        let plane: wide::Plane = F::wide(p);
        line("plane_hits", p.literal(), plane.object, i, plane.group);
    }
    for (i, q) in packed.quadrics.iter().enumerate() {
        let quadric: wide::Quadric = F::wide(q);
        line("quadric_hits", q.literal(), quadric.object, i, 0);
    }
    for (i, s) in packed.spheres.iter().enumerate() {
        let sphere: wide::Sphere = F::wide(s);
        line("sphere_hits", s.literal(), sphere.object, i, 0);
    }
    text
}

/// The objects of a small scene as literals, for rays from anywhere: a statement for each call of its hits function,
/// with the object and its group.
fn unrolled_world<F: Format>(
    packed: &Packed<F>,
    features: &FeatureSet,
    statement: impl Fn(&str, u32, u32) -> String,
) -> String {
    let mut text = String::new();
    let (true, Some(lit)) = (features.unrolled, &packed.lit) else {
        return text;
    };
    let mut line = |call: String, object: u32, group: u32| {
        writeln!(text, "    {}", statement(&call, object, group)).unwrap_or_default();
    };
    for p in &lit.planes {
        let call = format!("plane_hits_from({}, ray, range)", p.literal());
        let plane: wide::WorldPlane = F::wide(p);
        line(call, plane.object, plane.group);
    }
    for q in &packed.quadrics {
        let call = format!("quadric_hits_from({}, ray, range)", q.literal());
        let quadric: wide::Quadric = F::wide(q);
        line(call, quadric.object, quadric.group);
    }
    for s in &lit.spheres {
        let call = format!("sphere_hits_from({}, ray, range)", s.literal());
        let sphere: wide::WorldSphere = F::wide(s);
        line(call, sphere.object, sphere.group);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// Directives are checked in parts that are left out too, so one scene is enough.
    #[test]
    fn every_directive_of_every_file_means_something() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/notes/walls.txt");
        let scene = crate::scene::load(path.as_ref()).unwrap();
        let packed = Packed::new(&scene, &Settings::default());
        let set = FeatureSet::new(&packed, &Settings::default(), 1);
        let features = set.features();
        let entries =
            [Entry::Picture, Entry::Pixel, Entry::FirstHit, Entry::Listed].map(Entry::file);
        let mut directives = 0;
        for file in FILES.iter().map(|(file, _)| *file).chain(entries) {
            let insert = |what: &str| insertion(what, &packed, &set, &features);
            resolve(file, &features, &insert, &mut String::new());
            directives += file.matches("//#").count();
        }
        assert!(directives > 300, "{directives}");
    }

    #[test]
    #[should_panic(expected = "there is no such feature")]
    fn a_misspelt_feature_does_not_drop_what_it_guards() {
        let file = "fn f() {\n//#if certifed\n    doubt = true;\n//#end\n}\n";
        resolve(
            file,
            &Features::from([Feature::Certified]),
            &|_| None,
            &mut String::new(),
        );
    }
}

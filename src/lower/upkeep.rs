//! The texts that are lowered: with all that a scene may need, so that what one has not is asked of its records. The
//! test says when what is checked in is out of date; `UPDATE_EXPECT=1` writes it.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::PathBuf;

use super::texts::{AMBIENT, LIT, LIT_DOUBLE, lowered};
use crate::procedural::Family;
use crate::settings::Settings;
use crate::shader::compose::{Entry, compose_with};
use crate::shader::feature::Feature;
use crate::shader::feature_set::{FeatureSet, LitFeatures};
use crate::shader::kind::SurfaceKind;
use crate::shader::pack::Packed;

/// Everything that scenes may have, so that one text serves all.
fn everything(lit: bool, double: bool) -> FeatureSet {
    FeatureSet {
        listed: false,
        double,
        planes: true,
        polygons: true,
        front: true,
        spheres: true,
        quadrics: true,
        screen_grid: false,
        groups: true,
        tables: true,
        certified: true,
        sphere_tree: false,
        triangle_tree: lit,
        grid_triangles: false,
        loose_polygons: true,
        unrolled: false,
        quad: false,
        moving: false,
        kinds: kinds(),
        values: true,
        packed: false,
        samples: 2,
        course: false,
        lanes: 1,
        lit: lit.then_some(LitFeatures {
            mirror: true,
            transparent: true,
            glint: true,
            cone: true,
            projectors: true,
            lights_on_surface: true,
            low_light: true,
            planes: true,
            loose_planes: true,
            sides: true,
            triangles: true,
            spheres: true,
            loose_spheres: true,
            max_path: 1.0,
            max_rays: 1,
        }),
    }
}

/// All kinds of surface.
fn kinds() -> BTreeSet<SurfaceKind> {
    let shaders = |family: Family| 0..family.shaders().len() as u32;
    let pplanes = shaders(Family::Pplane).map(SurfaceKind::Pplane);
    let pspheres = shaders(Family::Psphere).map(SurfaceKind::Psphere);
    let mut kinds: BTreeSet<_> = pplanes.collect();
    kinds.extend(pspheres);
    kinds.extend([
        SurfaceKind::Plain,
        SurfaceKind::Tiled,
        SurfaceKind::Textured,
    ]);
    kinds
}

/// Constants of the text that it needs as such: sizes of arrays and cases.
fn is_kept(constant: &str) -> bool {
    constant.starts_with("KIND_") || ["WORKGROUP", "STACK", "BVH_DEPTH"].contains(&constant)
}

/// The text for a set of features, the numbers of bounds and of the scene as names.
fn wgsl(set: &FeatureSet) -> String {
    // Of which the names alone count.
    let scene = if set.lit.is_some() {
        "scenes/lit/mirror_balls.txt"
    } else {
        "scenes/notes/walls.txt"
    };
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), scene].iter().collect();
    let (scene, settings) = (crate::scene::load(&path).unwrap(), Settings::default());
    let mut features = set.features();
    // Opaque scenes ask whether anything stands in the way, others what.
    if set.lit.is_some() {
        features.insert(Feature::AnyHit);
    }
    let text = if set.double {
        compose_with(
            &Packed::in_f64(&scene, &settings),
            set,
            &features,
            Entry::Pixel,
        )
    } else {
        compose_with(
            &Packed::new(&scene, &settings),
            set,
            &features,
            Entry::Pixel,
        )
    };
    let (head, rest) = text.split_once("\n\n").unwrap();
    let mut named = String::new();
    for line in head.lines() {
        let (declared, value) = line.split_once(" = ").unwrap();
        let constant = declared
            .trim_start_matches("const ")
            .split(':')
            .next()
            .unwrap();
        let value = value.trim_end_matches(';');
        let ty = match value {
            // The walk down a tree is written by hand, but has to be valid here.
            "0u" if constant == "BVH_DEPTH" => {
                writeln!(named, "const BVH_DEPTH = 1u;").unwrap();
                continue;
            }
            _ if is_kept(constant) => {
                writeln!(named, "{line}").unwrap();
                continue;
            }
            value if value.starts_with("vec") => value.split('(').next().unwrap(),
            value if value.ends_with('u') => "u32",
            _ if set.double => "f64",
            _ => "f32",
        };
        let how = if ty.starts_with("vec") {
            "var<private>"
        } else {
            "override"
        };
        writeln!(named, "{how} {constant}: {ty};").unwrap();
    }
    named + "\n" + rest
}

fn check(file: &str, text: &str) {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "src/certify/lanes", file]
        .iter()
        .collect();
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        there == text,
        "{file} is out of date: run this test with UPDATE_EXPECT=1"
    );
}

#[test]
fn what_is_checked_in_is_what_the_shaders_say() {
    let folder = std::env::var_os("DUMP_LOWERED");
    for (name, about, told, [lit, double]) in [
        ("ambient", "Scenes without lights", AMBIENT, [false, false]),
        ("lit", "Scenes with lights", LIT, [true, false]),
        (
            "lit_double",
            "Scenes with lights, in f64",
            LIT_DOUBLE,
            [true, true],
        ),
    ] {
        let text = wgsl(&everything(lit, double));
        if let Some(folder) = &folder {
            std::fs::write(PathBuf::from(folder).join(format!("{name}.wgsl")), &text).unwrap();
        }
        check(&format!("{name}/text.rs"), &lowered(about, &text, told));
    }
}

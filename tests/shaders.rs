//! Every composed shader is valid WGSL and holds only what its scene needs; checked by naga, without a GPU.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use glam::{DVec2, DVec3};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use plumb::cpu::procedural::{PPLANE_SHADERS, PSPHERE_SHADERS};
use plumb::gpu::compose::compose;
use plumb::gpu::features::FeatureSet;
use plumb::gpu::pack::Packed;
use plumb::prepare::Prepared;
use plumb::scene::{Camera, Material, Object, Scene, Shape, Surface};

/// Something that a scene may have and a shader then needs.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ingredient {
    Plane,
    PlaneAcrossTheScreen,
    Tiled,
    Pplane(u32),
    SmallSphere,
    WideSphere,
    SmallPsphere(u32),
    WidePsphere(u32),
    ManyPlanes,
    ManySpheres,
    Values,
}

use Ingredient::*;

fn ingredients() -> Vec<Ingredient> {
    let mut all = vec![
        Plane,
        PlaneAcrossTheScreen,
        Tiled,
        SmallSphere,
        WideSphere,
        ManyPlanes,
        ManySpheres,
        Values,
    ];
    all.extend((0..PPLANE_SHADERS).map(Pplane));
    all.extend((0..PSPHERE_SHADERS).flat_map(|n| [SmallPsphere(n), WidePsphere(n)]));
    all
}

fn plane(normal: DVec3, point: DVec3, surface: Surface) -> Object {
    let shape = Shape::Plane { normal, point, extent: None };
    Object { name: "p".into(), material: 0, shape, surface }
}

fn sphere(center: DVec3, radius: f64, surface: Surface) -> Object {
    Object { name: "s".into(), material: 0, shape: Shape::Sphere { center, radius }, surface }
}

fn objects(ingredient: Ingredient) -> Vec<Object> {
    let floor = |surface| plane(DVec3::Y, DVec3::new(0.0, -1.0, 0.0), surface);
    let small = |surface| sphere(DVec3::new(4.0, 3.0, -9.0), 1.0, surface);
    let wide = |surface| sphere(DVec3::new(4.0, -30.0, -9.0), 29.0, surface);
    match ingredient {
        Plane => vec![floor(Surface::Plain)],
        PlaneAcrossTheScreen => vec![plane(DVec3::new(3.0, 0.0, 1.0), DVec3::new(2.0, 0.0, 0.0), Surface::Plain)],
        Tiled => vec![floor(Surface::Tiled { dimension: DVec2::new(2.0, 3.0), altmaterial: 0, xdir: None })],
        Pplane(shader) => vec![floor(Surface::Procedural { shader })],
        SmallSphere => vec![small(Surface::Plain)],
        WideSphere => vec![wide(Surface::Plain)],
        SmallPsphere(shader) => vec![small(Surface::Procedural { shader })],
        WidePsphere(shader) => vec![wide(Surface::Procedural { shader })],
        ManyPlanes => (1..100)
            .map(|i| plane(DVec3::Z, DVec3::new(0.0, 0.0, -f64::from(i)), Surface::Plain))
            .collect(),
        ManySpheres => (0..1000)
            .map(|i| sphere(DVec3::new(f64::from(i % 8), f64::from(i / 8 % 6), -9.0 - f64::from(i)), 0.3, Surface::Plain))
            .collect(),
        Values => vec![],
    }
}

fn composed(chosen: &[Ingredient]) -> (String, FeatureSet) {
    let material = Material { name: "m".into(), ambient: DVec3::ONE, ..Material::default() };
    let scene = Scene {
        camera: Camera {
            name: "c".into(),
            pixeldim: [64, 48],
            worlddim: DVec2::new(8.0, 6.0),
            viewpoint: DVec3::new(4.0, 3.0, 6.0),
        },
        materials: vec![material],
        objects: chosen.iter().flat_map(|i| objects(*i)).collect(),
        lights: vec![],
        textures: vec![],
    };
    let packed = Packed::new(&Prepared::new(&scene, 0.0));
    let features = FeatureSet::new(&packed, chosen.contains(&Values));
    (compose(&packed, &features), features)
}

fn validate(wgsl: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map_err(|error| error.emit_to_string(wgsl))?;
    Ok(module)
}

fn assert_valid(wgsl: &str, what: &str) -> naga::Module {
    validate(wgsl).unwrap_or_else(|error| panic!("{what}: {error}\n{wgsl}"))
}

#[test]
fn each_alone_all_pairs_and_all_together_are_valid() {
    let all = ingredients();
    assert_valid(&composed(&[]).0, "nothing");
    for (i, a) in all.iter().enumerate() {
        assert_valid(&composed(&[*a]).0, &format!("{a:?}"));
        for b in &all[i + 1..] {
            assert_valid(&composed(&[*a, *b]).0, &format!("{a:?} and {b:?}"));
        }
    }
    let (wgsl, features) = composed(&all);
    assert_valid(&wgsl, "all");
    let without_many: Vec<_> = all.into_iter().filter(|i| !matches!(i, ManyPlanes | ManySpheres)).collect();
    assert_valid(&composed(&without_many).0, "all, unrolled");
    // Together they have every feature that there is, so that none is left out above.
    assert!(features.planes && features.front && features.small_spheres && features.wide_spheres && features.bvh);
}

#[test]
fn every_scene_of_ours_is_valid() {
    for path in common::good_scenes() {
        let packed = Packed::new(&Prepared::new(&common::read(&path), 0.0));
        for values in [false, true] {
            let features = FeatureSet::new(&packed, values);
            assert_valid(&compose(&packed, &features), &path.display().to_string());
        }
    }
}

#[test]
fn what_is_not_used_is_not_there() {
    // (a word of the feature, who may have it)
    let words: &[(&str, &dyn Fn(Ingredient) -> bool)] = &[
        ("plane_hits", &|i| {
            matches!(i, Plane | PlaneAcrossTheScreen | Tiled | Pplane(_) | ManyPlanes)
        }),
        ("plane.front.x *", &|i| i == PlaneAcrossTheScreen),
        ("small_sphere_hits", &|i| matches!(i, SmallSphere | SmallPsphere(_) | ManySpheres)),
        ("wide_sphere_hits", &|i| matches!(i, WideSphere | WidePsphere(_))),
        ("bvh", &|i| i == ManySpheres),
        ("Tiled", &|i| i == Tiled),
        ("Pplane", &|i| matches!(i, Pplane(_))),
        ("pplane_0_tiles", &|i| i == Pplane(0)),
        ("pplane_1_angle", &|i| matches!(i, Pplane(1 | 2))),
        ("psphere_0_angle", &|i| matches!(i, SmallPsphere(0) | WidePsphere(0))),
        ("color_wheel", &|i| matches!(i, Pplane(1 | 2) | SmallPsphere(_) | WidePsphere(_))),
        ("vec4u", &|i| i == Values),
        ("switch", &|i| matches!(i, Tiled | Pplane(_) | SmallPsphere(_) | WidePsphere(_))),
    ];
    for ingredient in ingredients() {
        let (wgsl, _) = composed(&[ingredient]);
        for (word, may) in words {
            assert_eq!(wgsl.contains(word), may(ingredient), "`{word}` and {ingredient:?}:\n{wgsl}");
        }
    }
    assert!(!composed(&[]).0.contains("Ray"));
}

#[test]
fn no_precondition_line_is_left() {
    let (wgsl, _) = composed(&ingredients());
    assert!(!wgsl.contains("//#"));
}

#[test]
fn a_broken_shader_is_noticed() {
    let (wgsl, _) = composed(&[Plane]);
    assert!(validate(&wgsl.replace("plane.inverse.x", "plane.inverse.w")).is_err());
}

mod layout {
    //! Offsets and sizes of the packed records are those that naga computes for the WGSL structs.

    use std::mem::offset_of;

    use plumb::gpu::pack;

    use super::*;

    /// Struct members by name with their offsets, and the array stride or span of the struct.
    fn wgsl_struct(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
        let (_, ty) = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some(name))
            .unwrap_or_else(|| panic!("no struct {name}"));
        let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
        let offsets = members.iter().map(|m| (m.name.clone().unwrap(), m.offset as usize)).collect();
        (offsets, *span as usize)
    }

    macro_rules! same_layout {
        ($module:expr, $wgsl:literal, $rust:ty, $($field:ident),+) => {{
            let (members, span) = wgsl_struct(&$module, $wgsl);
            let ours = vec![$((stringify!($field).to_owned(), offset_of!($rust, $field))),+];
            assert_eq!(members, ours, "{}", $wgsl);
            assert_eq!(span, size_of::<$rust>(), "{}", $wgsl);
        }};
    }

    #[test]
    fn records_are_laid_out_as_naga_says() {
        let module = assert_valid(&composed(&ingredients()).0, "all");
        same_layout!(module, "Job", pack::Job, first, size);
        same_layout!(module, "Object", pack::Object, ambient, kind);
        same_layout!(module, "Plane", pack::Plane, inverse, object, front, unused);
        same_layout!(
            module, "SmallSphere", pack::SmallSphere, toward, rho2, gain, distance, offset, anchor, object, unused
        );
        same_layout!(module, "WideSphere", pack::WideSphere, toward, kappa2, gain, distance, object, unused);
        same_layout!(module, "BvhNode", pack::BvhNode, min, first, max, count);
        same_layout!(module, "Tiled", pack::TiledPlane, per_unit, fraction, altmaterial, parity);
        same_layout!(
            module,
            "Pplane",
            pack::ProceduralPlane,
            per_unit,
            unused_0,
            fraction,
            unused_1,
            parity,
            unused_2,
            from_point
        );
    }

    #[test]
    fn a_shifted_field_is_noticed() {
        let wgsl = composed(&[Plane, ManyPlanes]).0.replace("    inverse: vec3f,\n", "    extra: u32,\n    inverse: vec3f,\n");
        let module = naga::front::wgsl::parse_str(&wgsl).unwrap();
        let (members, _) = wgsl_struct(&module, "Plane");
        assert_ne!(members[1].1, offset_of!(pack::Plane, inverse));
    }
}

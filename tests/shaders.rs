//! Every composed shader is valid WGSL and holds only what its scene needs; checked by naga, without a GPU.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use plumb::procedural::{PPLANE_SHADERS, PSPHERE_SHADERS};
use plumb::render::{Precision, Settings, Spread};
use plumb::scene::{
    Camera, Cone, Extent, Light, Material, Object, Rectangle, Scene, Shape, Surface, Texels,
    Texture, TextureMode,
};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature::Feature;
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;

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
    Coplanar,
    Fast,
    ManyPlanes,
    ManySpheres,
    Values,
    Rectangle,
    TiledAlong,
    Texplane(TextureMode),
    Lamp,
    Spotlight,
    LampInFloor,
    Mirror,
    Glass,
    Glint,
    Samples,
    CourseSamples,
}

use Ingredient::*;

fn ingredients() -> Vec<Ingredient> {
    let mut all = vec![
        Plane,
        PlaneAcrossTheScreen,
        Tiled,
        SmallSphere,
        WideSphere,
        Coplanar,
        Fast,
        ManyPlanes,
        ManySpheres,
        Values,
        Rectangle,
        TiledAlong,
        Texplane(TextureMode::Fit),
        Texplane(TextureMode::Tile),
        Lamp,
        Spotlight,
        LampInFloor,
        Mirror,
        Glass,
        Glint,
        Samples,
        CourseSamples,
    ];
    all.extend((0..PPLANE_SHADERS).map(Pplane));
    all.extend((0..PSPHERE_SHADERS).flat_map(|n| [SmallPsphere(n), WidePsphere(n)]));
    all
}

fn plane(normal: DVec3, point: DVec3, surface: Surface) -> Object {
    let shape = Shape::Plane {
        normal,
        point,
        extent: Extent::Unbounded,
    };
    Object {
        name: "p".into(),
        material: 0,
        shape,
        surface,
    }
}

fn sphere(center: DVec3, radius: f64, surface: Surface) -> Object {
    Object {
        name: "s".into(),
        material: 0,
        shape: Shape::Sphere { center, radius },
        surface,
    }
}

fn objects(ingredient: Ingredient) -> Vec<Object> {
    let floor = |surface| plane(DVec3::Y, DVec3::new(0.0, -1.0, 0.0), surface);
    let small = |surface| sphere(DVec3::new(4.0, 3.0, -9.0), 1.0, surface);
    let wide = |surface| sphere(DVec3::new(4.0, -30.0, -9.0), 29.0, surface);
    match ingredient {
        Plane => vec![floor(Surface::Plain)],
        PlaneAcrossTheScreen => vec![plane(
            DVec3::new(3.0, 0.0, 1.0),
            DVec3::new(2.0, 0.0, 0.0),
            Surface::Plain,
        )],
        Tiled => vec![floor(Surface::Tiled {
            dimension: DVec2::new(2.0, 3.0),
            altmaterial: 0,
            xdir: None,
        })],
        Pplane(shader) => vec![floor(Surface::Procedural { shader })],
        SmallSphere => vec![small(Surface::Plain)],
        WideSphere => vec![wide(Surface::Plain)],
        // Of equal spheres the first hides the others.
        SmallPsphere(shader) => vec![sphere(
            DVec3::new(3.0, 2.0, -8.0),
            1.0,
            Surface::Procedural { shader },
        )],
        WidePsphere(shader) => vec![sphere(
            DVec3::new(4.0, -30.0, -9.0),
            28.0,
            Surface::Procedural { shader },
        )],
        ManyPlanes => (1..100)
            .map(|i| {
                plane(
                    DVec3::Z,
                    DVec3::new(0.0, 0.0, -f64::from(i)),
                    Surface::Plain,
                )
            })
            .collect(),
        ManySpheres => (0..1000)
            .map(|i| {
                sphere(
                    DVec3::new(f64::from(i % 8), f64::from(i / 8 % 6), -9.0 - f64::from(i)),
                    0.3,
                    Surface::Plain,
                )
            })
            .collect(),
        Rectangle => vec![rectangle(Surface::Plain)],
        Coplanar => {
            let wall = plane(DVec3::Z, DVec3::new(0.0, 0.0, -4.0), Surface::Plain);
            vec![rectangle(Surface::Plain), wall]
        }
        TiledAlong => {
            vec![floor(Surface::Tiled {
                dimension: DVec2::ONE,
                altmaterial: 0,
                xdir: Some(DVec3::new(1.0, 0.0, 1.0)),
            })]
        }
        Texplane(mode) => vec![rectangle(Surface::Textured { texture: 0, mode })],
        Mirror => vec![of_material(1, floor(Surface::Plain))],
        Glass => vec![of_material(2, small(Surface::Plain))],
        Glint => vec![of_material(3, small(Surface::Plain))],
        LampInFloor => vec![floor(Surface::Plain)],
        Values | Fast | Lamp | Spotlight | Samples | CourseSamples => vec![],
    }
}

fn of_material(material: usize, object: Object) -> Object {
    Object { material, ..object }
}

fn rectangle(surface: Surface) -> Object {
    let extent = Extent::Rectangle(Rectangle {
        xdir: DVec3::X,
        dimensions: DVec2::new(2.0, 3.0),
    });
    let shape = Shape::Plane {
        normal: DVec3::Z,
        point: DVec3::new(1.0, 1.0, -4.0),
        extent,
    };
    Object {
        name: "r".into(),
        material: 0,
        shape,
        surface,
    }
}

fn lights(ingredient: Ingredient) -> Vec<Light> {
    let light = |y, cone| Light {
        name: "l".into(),
        location: DVec3::new(4.0, y, 2.0),
        emissivity: DVec3::ONE,
        cone,
    };
    match ingredient {
        // What materials do is seen by light alone.
        Lamp | Mirror | Glass | Glint => vec![light(6.0, None)],
        LampInFloor => vec![light(-1.0, None)],
        Spotlight => vec![light(
            6.0,
            Some(Cone {
                point: DVec3::ZERO,
                theta: 20.0,
            }),
        )],
        _ => vec![],
    }
}

fn materials() -> Vec<Material> {
    let material = || Material {
        name: "m".into(),
        ambient: DVec3::ONE,
        diffuse: DVec3::ONE,
        ..Material::default()
    };
    let specular = DVec3::splat(0.5);
    vec![
        material(),
        Material {
            specular,
            ..material()
        },
        Material {
            transparency: 0.5,
            ..material()
        },
        Material {
            specular,
            shininess: 20.0,
            ..material()
        },
    ]
}

fn composed(chosen: &[Ingredient]) -> (String, FeatureSet) {
    let (packed, features) = packed(chosen);
    (compose(&packed, &features, Entry::Picture), features)
}

fn packed(chosen: &[Ingredient]) -> (Packed, FeatureSet) {
    let texels = Texels {
        width: 2,
        height: 1,
        rgb: vec![0; 6],
    };
    let scene = Scene {
        camera: Camera {
            name: "c".into(),
            pixeldim: [64, 48],
            worlddim: DVec2::new(8.0, 6.0),
            viewpoint: DVec3::new(4.0, 3.0, 6.0),
        },
        materials: materials(),
        objects: chosen.iter().flat_map(|i| objects(*i)).collect(),
        lights: chosen.iter().flat_map(|i| lights(*i)).collect(),
        textures: vec![Texture {
            name: "t".into(),
            filename: "t.ppm".into(),
            path: "t.ppm".into(),
            texels: Arc::new(texels),
        }],
    };
    let has = |ingredient| chosen.contains(&ingredient);
    let settings = Settings {
        values: has(Values),
        samples: if has(Samples) || has(CourseSamples) {
            16
        } else {
            1
        },
        jitter: if has(CourseSamples) {
            Spread::Course
        } else {
            Spread::Hash
        },
        precision: if has(Fast) {
            Precision::Fast
        } else {
            Precision::Certified
        },
        ..Settings::default()
    };
    let packed = Packed::new(&scene, &settings);
    let features = FeatureSet::new(&packed, &settings, 8);
    (packed, features)
}

fn validate(wgsl: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator
        .validate(&module)
        .map_err(|error| error.emit_to_string(wgsl))?;
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
    // A scene that has everything but many objects has them as literals, and one without lights has other shapes.
    let few = |i: &Ingredient| !matches!(i, ManyPlanes | ManySpheres | Fast | Values);
    let dark =
        |i: &Ingredient| !matches!(i, Lamp | Spotlight | LampInFloor | Mirror | Glass | Glint);
    let without_many: Vec<_> = all.iter().copied().filter(few).collect();
    let (wgsl, few_features) = composed(&without_many);
    assert_valid(&wgsl, "all, unrolled");
    let without_light: Vec<_> = all.iter().copied().filter(dark).collect();
    let (wgsl, dark_features) = composed(&without_light);
    assert_valid(&wgsl, "all without lights");
    let both: Vec<_> = without_many.iter().copied().filter(dark).collect();
    let (wgsl, plain_features) = composed(&both);
    assert_valid(&wgsl, "all without lights, unrolled");
    let spread: Vec<_> = without_many
        .iter()
        .copied()
        .filter(|i| *i != CourseSamples)
        .collect();
    let (wgsl, spread_features) = composed(&spread);
    assert_valid(&wgsl, "all, unrolled, spread by the hash");
    // (Without the plain ones, which hide tiles and textures in the same place.)
    let once: Vec<_> = all
        .iter()
        .copied()
        .filter(|i| few(i) && !matches!(i, Samples | CourseSamples | Plane | Coplanar))
        .collect();
    let (wgsl, once_features) = composed(&once);
    assert_valid(&wgsl, "all, unrolled, a ray a pixel");
    let (wgsl, loop_features) = composed(&[ManyPlanes, SmallSphere, Lamp]);
    assert_valid(&wgsl, "spheres without a tree in a loop");
    let every = [
        loop_features,
        few_features,
        once_features,
        dark_features,
        plain_features,
        spread_features,
        features,
    ];
    // Together they have every feature, so that none is left out above.
    let found: BTreeSet<Feature> = every.iter().flat_map(FeatureSet::features).collect();
    for feature in Feature::ALL {
        // Only fast pictures have these, or scenes without mirrors, glass or lights.
        let elsewhere = [
            Feature::AnyHit,
            Feature::Moving,
            Feature::Values,
            Feature::Quad,
            Feature::SphereLoop,
        ];
        assert!(
            found.contains(feature) || elsewhere.contains(feature),
            "{feature:?}"
        );
    }
}

#[test]
fn every_scene_of_ours_is_valid() {
    for path in common::good_scenes() {
        for (values, samples, precision) in [
            (false, 1, Precision::Certified),
            (false, 16, Precision::Certified),
            (false, 1, Precision::Fast),
            (true, 16, Precision::Fast),
        ] {
            let settings = Settings {
                values,
                samples,
                precision,
                ..Settings::default()
            };
            let packed = Packed::new(&common::read(&path), &settings);
            let features = FeatureSet::new(&packed, &settings, 8);
            assert_valid(
                &compose(&packed, &features, Entry::Picture),
                &path.display().to_string(),
            );
            if precision == Precision::Fast {
                let moving = compose(&packed, &features.while_moving(), Entry::Picture);
                assert_valid(&moving, &format!("{} moving", path.display()));
            }
        }
    }
}

/// What lets a window show a scene from one viewpoint after the other without compiling.
#[test]
fn another_viewpoint_is_another_shader_only_where_the_camera_is_in_the_text() {
    let settings = Settings {
        precision: Precision::Fast,
        ..Settings::default()
    };
    for name in [
        "notes/walls.txt",
        "gallery/spheres_over_tiles.txt",
        "lit/mirror_and_glass.txt",
    ] {
        let mut scene = common::read(&common::scenes().join(name));
        let texts = |scene: &Scene| {
            let packed = Packed::new(scene, &settings);
            let features = FeatureSet::new(&packed, &settings, 8);
            [
                compose(&packed, &features, Entry::Picture),
                compose(&packed, &features.while_moving(), Entry::Picture),
            ]
        };
        let [text, moving] = texts(&scene);
        scene.camera.viewpoint += DVec3::new(0.01, -0.02, 0.005);
        let [other, moved] = texts(&scene);
        assert_ne!(text, other, "{name}");
        assert_eq!(moving, moved, "{name}");
        // Nor does a smaller picture ask for another one.
        scene.camera.pixeldim = scene.camera.pixeldim.map(|pixels| pixels / 4);
        assert_eq!(moving, texts(&scene)[1], "{name}");
    }
}

#[test]
fn what_is_not_used_is_not_there() {
    // (a word of the feature, who may have it)
    let lit = |i| matches!(i, Mirror | Glass | Glint | LampInFloor);
    let words: &[(&str, &dyn Fn(Ingredient) -> bool)] = &[
        ("plane_hits(", &|i| {
            matches!(
                i,
                Plane
                    | PlaneAcrossTheScreen
                    | Tiled
                    | TiledAlong
                    | Pplane(_)
                    | ManyPlanes
                    | Coplanar
                    | Mirror
                    | LampInFloor
            )
        }),
        ("rectangle_hits", &|i| {
            matches!(i, Rectangle | Texplane(_) | Coplanar)
        }),
        ("plane.front.x *", &|i| i == PlaneAcrossTheScreen),
        ("sphere_hits(", &|i| {
            matches!(
                i,
                SmallSphere
                    | WideSphere
                    | SmallPsphere(_)
                    | WidePsphere(_)
                    | ManySpheres
                    | Glass
                    | Glint
            )
        }),
        ("(group == 0u)", &|i| i == Coplanar),
        ("rival", &|i| {
            !matches!(i, Values | Fast) && !objects(i).is_empty()
        }),
        ("tiles[", &|i| i == ManySpheres),
        ("bvh", &|_| false),
        ("Tiled", &|i| matches!(i, Tiled | TiledAlong)),
        ("Pplane", &|i| matches!(i, Pplane(_))),
        ("Texplane", &|i| matches!(i, Texplane(_))),
        ("pplane_0_tiles", &|i| i == Pplane(0)),
        ("pplane_1_angle", &|i| matches!(i, Pplane(1 | 2))),
        ("psphere_0_angle", &|i| {
            matches!(i, SmallPsphere(0) | WidePsphere(0))
        }),
        ("color_wheel", &|i| {
            matches!(i, Pplane(1 | 2) | SmallPsphere(_) | WidePsphere(_))
        }),
        ("fn told(", &|i| {
            matches!(i, Tiled | Pplane(0 | 2) | Texplane(_))
        }),
        ("vec4u(bitcast", &|i| i == Values),
        ("fn make_pixel", &|i| {
            !objects(i).is_empty() && !lit(i) && !matches!(i, ManyPlanes | ManySpheres)
        }),
        ("switch", &|i| {
            matches!(
                i,
                Tiled | TiledAlong | Pplane(_) | Texplane(_) | SmallPsphere(_) | WidePsphere(_)
            )
        }),
        ("light_term", &lit),
        ("fn shadow", &lit),
        ("diffuse", &lit),
        ("array<Branch", &|_| false),
        ("mirror.beam.dir =", &|i| matches!(i, Mirror | Glint)),
        ("through.weight", &|i| i == Glass),
        ("power(", &|i| i == Glint),
        ("partial", &|_| false),
        ("summed", &|_| false),
        ("jitter_hash", &|_| false),
        ("offsets[", &|_| false),
    ];
    for ingredient in ingredients() {
        let (wgsl, _) = composed(&[ingredient]);
        for (word, may) in words {
            assert_eq!(
                wgsl.contains(word),
                may(ingredient),
                "`{word}` and {ingredient:?}:\n{wgsl}"
            );
        }
    }
    assert!(!composed(&[]).0.contains("Ray"));
    // Without anything to hit there is nothing to light or to sample.
    assert!(!composed(&[Lamp, Samples]).0.contains("light_term"));
    // A stack only where rays fork.
    assert!(composed(&[Mirror, Glass]).0.contains("array<Branch"));
    assert!(composed(&[Plane, Samples]).0.contains("jitter_hash"));
    let course = composed(&[Plane, CourseSamples]).0;
    assert!(course.contains("offsets[") && !course.contains("jitter_hash"));
    // Samples are in doubt one by one where pixels are certified.
    assert!(course.contains("pixels.partials"));
    // They take no buffer of their own: SwiftShader allows ten, and scenes of ours have as many.
    let buffers = |chosen: &[Ingredient]| composed(chosen).0.matches("var<storage").count();
    assert_eq!(buffers(&[Plane, Samples]), buffers(&[Plane]));
    for without in [[Plane, Samples, Fast], [Plane, Samples, Values]] {
        assert!(!composed(&without).0.contains("partial"), "{without:?}");
    }
    assert!(!composed(&[Plane, Lamp]).0.contains("light.axis)"));
    assert!(composed(&[Plane, Spotlight]).0.contains("light.axis)"));
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

    use plumb::shader::binding::BINDINGS;
    use plumb::shader::record::{Layout, Record as _};
    use plumb::shader::records::{CameraNumbers, Job, LAYOUTS};

    use super::*;

    /// Struct members by name with their offsets, and the array stride or span of the struct.
    fn wgsl_struct(module: &naga::Module, name: &str) -> Option<(Vec<(String, usize)>, usize)> {
        let (_, ty) = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some(name))?;
        let naga::TypeInner::Struct { members, span } = &ty.inner else {
            panic!("{name} is no struct")
        };
        let offsets = members
            .iter()
            .map(|m| (m.name.clone().unwrap(), m.offset as usize))
            .collect();
        Some((offsets, *span as usize))
    }

    /// Modules that have all the structs.
    fn modules() -> Vec<naga::Module> {
        let all = ingredients();
        let dark: Vec<_> = all
            .iter()
            .copied()
            .filter(|i| !matches!(i, Lamp | Spotlight | LampInFloor | Mirror | Glass | Glint))
            .collect();
        let (packed, features) = packed(&[Plane, Lamp, Fast]);
        let moving = compose(&packed, &features.while_moving(), Entry::Picture);
        [
            composed(&all).0,
            composed(&dark).0,
            composed(&[Plane, Samples]).0,
            composed(&[SmallSphere, SmallPsphere(0), ManyPlanes]).0,
            moving,
        ]
        .iter()
        .map(|wgsl| assert_valid(wgsl, "structs"))
        .collect()
    }

    fn ours(layout: &Layout) -> (Vec<(String, usize)>, usize) {
        let members = layout
            .members()
            .map(|field| (field.name.to_owned(), field.offset));
        (members.collect(), layout.size)
    }

    #[test]
    fn records_are_laid_out_as_naga_says() {
        let modules = modules();
        for layout in LAYOUTS {
            // The camera is no struct of its own: see below.
            if layout.name == "CameraNumbers" {
                continue;
            }
            let found: Vec<_> = modules
                .iter()
                .filter_map(|module| wgsl_struct(module, layout.wgsl))
                .collect();
            assert!(!found.is_empty(), "no struct {}", layout.wgsl);
            // Two records may have the same name in the shaders of different scenes.
            let named: Vec<_> = LAYOUTS
                .iter()
                .filter(|other| other.wgsl == layout.wgsl)
                .map(ours)
                .collect();
            assert!(found.contains(&ours(layout)), "{}: {found:?}", layout.name);
            for found in found
                .iter()
                .filter(|(members, _)| members.len() == ours(layout).0.len())
            {
                assert!(named.contains(found), "{}: {found:?}", layout.wgsl);
            }
        }
    }

    /// What the table says of bindings is what the shaders declare.
    #[test]
    fn bindings_are_as_the_table_says() {
        let all = ingredients();
        let mut scenes = vec![all.clone()];
        for ingredient in all {
            scenes.push(vec![ingredient]);
            scenes.push(vec![ingredient, Plane, Samples, Pplane(0)]);
            scenes.push(vec![ingredient, ManyPlanes]);
            scenes.push(vec![ingredient, ManyPlanes, Lamp, Mirror]);
        }
        let mut seen = BTreeSet::new();
        for ingredients in scenes {
            let (wgsl, set) = composed(&ingredients);
            let features = set.features();
            let module = assert_valid(&wgsl, "bindings");
            let declared: BTreeSet<(u32, &str)> = module
                .global_variables
                .iter()
                .filter_map(|(_, variable)| {
                    let binding = variable.binding.as_ref()?;
                    Some((binding.binding, variable.name.as_deref()?))
                })
                .collect();
            let holding: Vec<usize> = (0..BINDINGS.len())
                .filter(|&i| (BINDINGS[i].holds)(&features))
                .collect();
            let named = |&i: &usize| (BINDINGS[i].number, BINDINGS[i].name);
            // No number twice.
            assert_eq!(holding.len(), declared.len(), "{ingredients:?}");
            assert_eq!(
                declared,
                holding.iter().map(named).collect(),
                "{ingredients:?}"
            );
            seen.extend(holding);
        }
        assert_eq!(seen.len(), BINDINGS.len(), "{seen:?}");
    }

    #[test]
    fn a_camera_that_moves_stands_behind_the_job() {
        let (packed, features) = packed(&[Plane, Lamp, Fast]);
        let wgsl = compose(&packed, &features.while_moving(), Entry::Picture);
        let (members, span) = wgsl_struct(&assert_valid(&wgsl, "moving"), "Job").unwrap();
        let (job, camera) = (Job::LAYOUT, CameraNumbers::LAYOUT);
        let behind = camera
            .members()
            .map(|field| (format!("camera_{}", field.name), job.size + field.offset));
        assert_eq!(members[4..], behind.collect::<Vec<_>>());
        assert_eq!(span, job.size + camera.size);
    }

    #[test]
    fn a_shifted_field_is_noticed() {
        let wgsl = composed(&[Plane, ManyPlanes]).0.replace(
            "    inverse: vec3f,\n",
            "    extra: u32,\n    inverse: vec3f,\n",
        );
        let module = naga::front::wgsl::parse_str(&wgsl).unwrap();
        let found = wgsl_struct(&module, "Plane").unwrap();
        let plane = LAYOUTS
            .iter()
            .find(|layout| layout.name == "Plane")
            .unwrap();
        assert_ne!(found, ours(plane));
    }
}

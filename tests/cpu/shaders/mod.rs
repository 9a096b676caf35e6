//! Every composed shader is valid WGSL and holds only what its scene needs; checked by naga, without a GPU.

mod ingredients;
mod layout;

use std::collections::BTreeSet;

use glam::DVec3;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use plumb::procedural::{self, Family};
use plumb::render::{Precision, Settings};
use plumb::scene::{Scene, TextureMode};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature::Feature;
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;

use crate::common;
use ingredients::Ingredient::{self, *};
use ingredients::{composed, doubled, ingredients, objects, packed};

/// Whether an ingredient is a procedural surface whose shader, or one that it calls, names `helper`.
fn asks(ingredient: Ingredient, helper: &str) -> bool {
    match ingredient {
        Pplane(shader) | Ptriangle(shader) | Pquadric(shader) => {
            procedural::asks(Family::Pplane, shader, helper)
        }
        SmallPsphere(shader) | WidePsphere(shader) => {
            procedural::asks(Family::Psphere, shader, helper)
        }
        _ => false,
    }
}

fn validate(wgsl: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    // f64, and u64 for its bits, are what a shader for f64 asks for.
    let capabilities = if wgsl.contains("f64") {
        Capabilities::FLOAT64 | Capabilities::SHADER_INT64
    } else {
        Capabilities::empty()
    };
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
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
    let few = |i: &Ingredient| {
        !matches!(
            i,
            ManyPlanes | ManySpheres | ManyTriangles | ManyQuadrics | Fast | Values
        )
    };
    let dark = |i: &Ingredient| {
        !matches!(
            i,
            Lamp | Spotlight | Projector(_) | LampInFloor | LampOverFloor | Mirror | Glass | Glint
        )
    };
    let without_many: Vec<_> = all.iter().copied().filter(few).collect();
    let (wgsl, few_features) = composed(&without_many);
    assert_valid(&wgsl, "all, unrolled");
    let without_light: Vec<_> = all.iter().copied().filter(dark).collect();
    let (wgsl, dark_features) = composed(&without_light);
    assert_valid(&wgsl, "all without lights");
    let both: Vec<_> = without_many.iter().copied().filter(dark).collect();
    let (wgsl, plain_features) = composed(&both);
    assert_valid(&wgsl, "all without lights, unrolled");
    let hashed: Vec<_> = without_many
        .iter()
        .copied()
        .filter(|i| *i != CourseSamples)
        .collect();
    let (wgsl, hashed_features) = composed(&hashed);
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
        hashed_features,
        features,
    ];
    // Together they have every feature, so that none is left out above.
    let found: BTreeSet<Feature> = every.iter().flat_map(FeatureSet::features).collect();
    for feature in Feature::ALL {
        // Only fast pictures have these, files, or scenes without mirrors, glass or lights.
        let elsewhere = [
            Feature::Packed,
            Feature::AnyHit,
            Feature::Moving,
            Feature::Values,
            Feature::Quad,
            Feature::SphereLoop,
            Feature::Double,
            Feature::Listed,
        ];
        assert!(
            found.contains(feature) || elsewhere.contains(feature),
            "{feature:?}"
        );
    }
}

/// The same in f64, with the list of its pixels.
#[test]
fn in_f64_each_alone_all_pairs_and_all_together_are_valid() {
    let all = ingredients();
    let mut valid = 0;
    let mut bad = BTreeSet::new();
    let mut check = |chosen: &[Ingredient]| {
        let Some([listing, double]) = doubled(chosen) else {
            return;
        };
        assert_valid(&listing, &format!("{chosen:?}, listing"));
        assert!(!double.contains("vec3f"), "{double}");
        if let Err(e) = validate(&double) {
            bad.insert(e.lines().take(9).collect::<Vec<_>>().join("\n"));
        }
        valid += 1;
    };
    for (i, a) in all.iter().enumerate() {
        check(&[*a]);
        for b in &all[i + 1..] {
            check(&[*a, *b]);
        }
    }
    let many =
        |i: &Ingredient| matches!(i, ManyPlanes | ManySpheres | ManyTriangles | ManyQuadrics);
    let single = |i: &Ingredient| !matches!(i, Samples | CourseSamples | Fast | Values);
    let one_ray: Vec<_> = all.iter().copied().filter(single).collect();
    check(&one_ray);
    let few: Vec<_> = one_ray.iter().copied().filter(|i| !many(i)).collect();
    check(&few);
    for b in bad.iter().take(20) {
        println!("{b}");
    }
    assert!(bad.is_empty());
    assert!(valid > 500, "{valid}");
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
            let packed_pixels = features.clone().for_a_file(false);
            assert_valid(
                &compose(&packed, &packed_pixels, Entry::Picture),
                &format!("{} for a file", path.display()),
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
    let lit = |i| matches!(i, Mirror | Glass | Glint | LampInFloor | LampOverFloor);
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
                    | LampOverFloor
            )
        }),
        ("polygon_hits", &|i| {
            matches!(
                i,
                Rectangle | Texplane(_) | Coplanar | Triangle | Ptriangle(_) | ManyTriangles
            )
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
        ("screen_grid[", &|i| {
            matches!(i, ManySpheres | ManyTriangles)
        }),
        ("bvh", &|_| false),
        ("Tiled", &|i| matches!(i, Tiled | TiledAlong)),
        ("Pplane", &|i| {
            matches!(i, Pplane(_) | Ptriangle(_) | Pquadric(_))
        }),
        ("quadric_meets", &|i| {
            matches!(i, Quadric | Pquadric(_) | ManyQuadrics)
        }),
        ("Texplane", &|i| matches!(i, Texplane(_))),
        ("pplane_0_tiles", &|i| asks(i, "pplane_0_tiles(")),
        ("pplane_1_angle", &|i| asks(i, "pplane_1_angle(")),
        ("psphere_0_angle", &|i| asks(i, "psphere_0_angle(")),
        ("color_wheel", &|i| asks(i, "color_wheel(")),
        ("fn index_table(", &|i| {
            matches!(i, Tiled | Texplane(_)) || matches!(i, Pplane(_)) && asks(i, "pplane_odd(")
        }),
        ("vec4u(bitcast", &|i| i == Values),
        ("fn make_pixel", &|i| {
            !objects(i).is_empty()
                && !lit(i)
                && !matches!(i, ManyPlanes | ManySpheres | ManyTriangles | ManyQuadrics)
        }),
        ("switch", &|i| {
            matches!(
                i,
                Tiled
                    | TiledAlong
                    | Pplane(_)
                    | Ptriangle(_)
                    | Pquadric(_)
                    | Texplane(_)
                    | SmallPsphere(_)
                    | WidePsphere(_)
            )
        }),
        ("light_term", &lit),
        ("fn shadow", &lit),
        ("diffuse", &lit),
        ("array<Branch", &|_| false),
        ("mirror.ray.dir =", &|i| matches!(i, Mirror | Glint)),
        ("through.weight", &|i| i == Glass),
        ("power(", &|i| i == Glint),
        ("point.height", &|i| i == LampOverFloor),
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
    assert!(course.contains("pixels.records"));
    // They take no buffer of their own: SwiftShader allows ten, and scenes of ours have as many.
    let buffers = |chosen: &[Ingredient]| composed(chosen).0.matches("var<storage").count();
    assert_eq!(buffers(&[Plane, Samples]), buffers(&[Plane]));
    for without in [[Plane, Samples, Fast], [Plane, Samples, Values]] {
        assert!(!composed(&without).0.contains("partial"), "{without:?}");
    }
    assert!(!composed(&[Plane, Lamp]).0.contains("light.axis)"));
    assert!(composed(&[Plane, Spotlight]).0.contains("light.axis)"));
    assert!(!composed(&[Plane, Lamp]).0.contains("Passage"));
    let projected = composed(&[Plane, Projector(TextureMode::Fit)]).0;
    assert!(projected.contains("passage(") && projected.contains("texel_at("));
    // What belongs to textures on things is not there.
    assert!(!projected.contains("index_error(") && !projected.contains("Texplane"));
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

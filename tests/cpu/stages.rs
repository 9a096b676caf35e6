//! What decides a pixel on the CPU: which numbers decide what, that bounds hold, and that a broken one is noticed.

use std::cmp::Ordering;
use std::path::Path;

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::{Limits, Unobserved, ray_trace};
use plumb::frame::{DecidedBy, Part};
use plumb::jitter::{self, Sampling};
use plumb::prepare::{Prepared, ViewParameters};
use plumb::real::{Bounded, Lazy, Pair, Real};
use plumb::scene::{Scene, load_from};
use plumb::settings::{Backend, Precision, Settings};

use crate::common;

fn scene(text: &str) -> Scene {
    load_from("test", text.as_bytes(), Path::new(".")).unwrap()
}

/// The value of one pixel's sample in numbers of one kind.
fn color<R: Real>(scene: &Prepared<R>, x: u32, y: u32) -> Option<[R; 3]> {
    let limits = Limits {
        enough: f64::INFINITY,
        ..Limits::default()
    };
    let traced = ray_trace(scene, &limits, f64::from(x), f64::from(y), &mut Unobserved);
    traced.ok().map(|t| [t.color.x, t.color.y, t.color.z])
}

/// Over all scenes of ours: how many channels are off by more than their bound times `scale` allows, how many were
/// compared, and how many of them have a bound that is useless.
fn off(scale: f64) -> (usize, usize, usize) {
    let (mut off, mut all, mut useless) = (0, 0, 0);
    for path in common::good_scenes() {
        let scene = common::read(&path);
        let bounds = Prepared::<Bounded>::new(&scene, 0.0);
        Lazy::clear();
        let exact = Prepared::again(
            &scene,
            ViewParameters::from(0.0),
            &bounds,
            &bounds.sources(&scene, ViewParameters::from(0.0)),
        );
        let end = Lazy::mark();
        let [width, height] = scene.camera.pixeldim;
        for i in 0..12 {
            let (x, y) = (i * 7919 % width, i * 104_729 % height);
            let Some(value) = color(&bounds, x, y) else {
                continue;
            };
            let Some(better) = color::<Lazy>(&exact, x, y) else {
                // A thousand panes throw five hundred thousand shadows: more exact numbers than a thread makes.
                assert!(
                    path.ends_with("lit_thousand_panes.txt"),
                    "{}",
                    path.display()
                );
                Lazy::release(end);
                continue;
            };
            for (value, better) in value.into_iter().zip(better) {
                let better = better.bounded();
                let apart = (value.value - better.value).abs() - better.error;
                all += 1;
                off += usize::from(apart > scale * value.error * Bounded::GROW);
                useless += usize::from(value.error > 1e-9 * value.value.abs() + 1e-12);
            }
            Lazy::release(end);
        }
    }
    (off, all, useless)
}

#[test]
fn f64_bounds_contain_the_exact_values() {
    let (off, all, useless) = off(1.0);
    assert!(all > 4000, "only {all} compared");
    assert_eq!(off, 0, "of {all}");
    assert!(useless * 50 < all, "{useless} of {all} bounds say nothing");
}

#[test]
fn a_bound_of_zero_is_noticed() {
    let (off, all, _) = off(0.0);
    assert!(off > 100, "{off} of {all}");
}

/// The same of pairs of f64, in lit scenes, where they are asked: their bounds are so small that only exact signs tell.
fn off_pairs(scale: f64) -> (usize, usize, usize) {
    let (mut off, mut all, mut useless) = (0, 0, 0);
    for path in common::good_scenes() {
        let scene = common::read(&path);
        if scene.lights.is_empty() || path.ends_with("lit_thousand_panes.txt") {
            continue;
        }
        let bounds = Prepared::<Bounded>::new(&scene, 0.0);
        let pairs = Prepared::<Pair>::new(&scene, 0.0);
        Lazy::clear();
        let view = ViewParameters::from(0.0);
        let exact = Prepared::again(&scene, view, &bounds, &bounds.sources(&scene, view));
        let end = Lazy::mark();
        let [width, height] = scene.camera.pixeldim;
        for i in 0..3 {
            let (x, y) = (i * 7919 % width, i * 104_729 % height);
            let (Some(value), Some(better)) =
                (color::<Pair>(&pairs, x, y), color::<Lazy>(&exact, x, y))
            else {
                Lazy::release(end);
                continue;
            };
            for (value, better) in value.into_iter().zip(better) {
                let apart = better - Lazy::exact(value.high) - Lazy::exact(value.low);
                let bound = Lazy::exact(scale * value.error * Bounded::GROW);
                let beyond = [(apart - bound).sign(), (-apart - bound).sign()];
                all += 1;
                off += usize::from(beyond.contains(&Ok(Ordering::Greater)));
                useless += usize::from(value.error > 1e-24 * value.high.abs() + 1e-28);
            }
            Lazy::release(end);
        }
    }
    (off, all, useless)
}

#[test]
fn bounds_of_pairs_contain_the_exact_values() {
    let (off, all, useless) = off_pairs(1.0);
    assert!(all > 500, "only {all} compared");
    assert_eq!(off, 0, "of {all}");
    assert!(useless * 50 < all, "{useless} of {all} bounds say nothing");
    let (off, all, _) = off_pairs(0.0);
    assert!(off > 100, "{off} of {all}");
}

const CAMERA: &str = "camera c { pixeldim 9 7 worlddim 8 6 viewpoint 4 3 4 } ";

#[test]
fn a_tie_is_proven_and_said_so() {
    // Two walls that meet in the middle column, at x = 4.
    let scene = scene(&format!(
        "{CAMERA} material r {{ ambient 3 0 0 }} material g {{ ambient 0 3 0 }}
         plane right {{ material g normal -1 0 1 point 4 0 -4 }}
         plane left {{ material r normal 1 0 1 point 4 0 -4 }}"
    ));
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let trace = |x| {
        let sampling = Sampling::Once;
        exact_tracer
            .trace(&Limits::default(), sampling, x, 3)
            .unwrap()
    };
    // 3/8 of 255 is 95.6; the first in the file wins.
    assert_eq!(
        (trace(4).bytes, trace(4).by),
        ([0, 95, 0], DecidedBy::Exact)
    );
    assert_eq!(trace(3).by, DecidedBy::Bounded);
    assert_ne!(trace(3).bytes, trace(5).bytes);
}

#[test]
fn a_discriminant_of_2_to_the_minus_102_is_a_hit() {
    // Radius 1 + 2⁻⁵¹ at offset (1, 2⁻²⁵) from the middle ray; one step smaller it misses.
    let ball = |radius: f64, x: f64| {
        scene(&format!(
            "{CAMERA} material w {{ ambient 5 5 5 }}
             sphere s {{ material w center {x} {} -4 radius {radius:e} }}",
            3.0 + 2.0_f64.powi(-25),
        ))
    };
    let decided = |scene: &Scene| {
        let exact_tracer = ExactTracer::new(scene, ViewParameters::from(0.0));
        exact_tracer
            .trace(&Limits::default(), Sampling::Once, 4, 3)
            .unwrap()
    };
    let hit = decided(&ball(1.0 + 2.0_f64.powi(-51), 5.0));
    assert_eq!((hit.bytes, hit.by), ([159; 3], DecidedBy::Multiprecision));
    let miss = decided(&ball(1.0 + 2.0_f64.powi(-52), 5.0));
    assert_eq!((miss.bytes, miss.by), ([0; 3], DecidedBy::Multiprecision));
}

#[test]
fn values_are_the_nearest_f32() {
    // Head on at distance 1: the value is the reflectivity, here halfway between two f32, and a little above.
    for (extra, want) in [(0.0, 1.0_f32), (2.0_f64.powi(-50), 1.0 + f32::EPSILON)] {
        let ambient = 1.0 + 2.0_f64.powi(-24) + extra;
        let scene = scene(&format!(
            "camera c {{ pixeldim 1 1 worlddim 2 2 viewpoint 1 1 1 }}
             material m {{ ambient {ambient:e} 0.1 0 }} plane p {{ material m normal 0 0 1 point 0 0 0 }}"
        ));
        let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0)).with_values(true);
        let limits = Limits {
            enough: f64::INFINITY,
            ..Limits::default()
        };
        let decided = exact_tracer.trace(&limits, Sampling::Once, 0, 0).unwrap();
        assert_eq!(decided.value, [want, 0.1, 0.0]);
    }
}

/// A channel that is 0, and not because nothing is added: the f32 around it are not neighbours, and it is known all the
/// same.
#[test]
fn a_value_of_0_is_the_nearest_f32() {
    let scene = scene(
        "camera c { pixeldim 17 13 worlddim 8 6 viewpoint 4 3 6 }
         material m1 { ambient 3 6 0.5 }
         pplane o { material m1 normal 3 0 4 point 7.5 1 -1 shader 2 }",
    );
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0)).with_values(true);
    let limits = Limits {
        enough: f64::INFINITY,
        ..Limits::default()
    };
    let decided = exact_tracer.trace(&limits, Sampling::Once, 14, 11).unwrap();
    assert_ne!(decided.by, DecidedBy::Presumed);
    assert_eq!((decided.bytes[0], decided.value[0]), (0, 0.0));
}

/// A pixel part of whose samples is known: the others alone are traced, and its bytes are those of the whole. A part
/// that is off, or that says it holds a sample more than it does, is seen in the bytes.
#[test]
fn what_is_missing_of_a_part_is_added() {
    const SAMPLES: u32 = 40;
    let path = common::scenes().join("lit/mirror_balls.txt");
    let scene = common::read(&path);
    let view = Settings {
        samples: SAMPLES,
        ..Settings::default()
    }
    .view();
    let exact_tracer = ExactTracer::new(&scene, view);
    let plain = Prepared::<f64>::new(&scene, view);
    let limits = Limits::default();
    // The samples that the part holds: none, some, all but one of the second word.
    for held in [[0, 0], [0x00ff_0f37, 0x51], [!0, 0x7f]] {
        let (mut open, mut seen) = (0, [0; 2]);
        for i in 0..40 {
            let (x, y) = (i * 16, i * 9);
            let mut sum = [0.0; 3];
            for sample in (0..SAMPLES).filter(|s| held[*s as usize / 32] >> (s % 32) & 1 != 0) {
                let [a, b] = jitter::hash(x, y, sample);
                let (px, py) = (f64::from(x) + a, f64::from(y) + b);
                let color = ray_trace(&plain, &limits, px, py, &mut Unobserved)
                    .unwrap()
                    .color;
                for (sum, c) in sum.iter_mut().zip([color.x, color.y, color.z]) {
                    *sum += 255.0 * c / f64::from(SAMPLES);
                }
            }
            let sum = sum.map(|c| c as f32);
            let error = sum.map(|c| 1e-6 * c);
            let sampling = Sampling::Hash(SAMPLES);
            let whole = exact_tracer.trace(&limits, sampling, x, y).unwrap();
            let complete = |sum: [f32; 3], error: [f32; 3], summed: &[u32]| {
                let part = Part { sum, error, summed };
                let decided = exact_tracer
                    .complete(&limits, sampling, [x, y], &part, &[])
                    .unwrap();
                decided.map(|decided| decided.bytes)
            };
            match complete(sum, error, &held) {
                Some(bytes) => assert_eq!(bytes, whole.bytes, "({x}, {y})"),
                None => open += 1,
            }
            // Where the error is a byte or more nothing is decided.
            let white = whole.bytes == [255; 3];
            assert!(white || complete(sum, [2.0; 3], &held).is_none());
            let off = complete(sum.map(|c| c + 1.0), error, &held);
            let more = complete(
                sum,
                error,
                &[held[0] | (held[0] + u32::from(held[0] != !0)), 0xff],
            );
            seen[0] += usize::from(off.is_some_and(|bytes| bytes != whole.bytes));
            seen[1] += usize::from(more.is_some_and(|bytes| bytes != whole.bytes));
        }
        assert!(open < 3, "{open} of 40 were not decided");
        assert!(seen.iter().all(|seen| *seen > 20), "{held:x?}: {seen:?}");
    }
}

#[test]
fn of_many_spheres_only_those_near_the_ray_are_made_exact() {
    let mut text = "camera c { pixeldim 9 9 worlddim 8 8 viewpoint 4 4 8 }
        light l { location 4 4 8 emissivity 5 5 5 }
        material m { ambient 9 8 7 diffuse 1 1 1 }"
        .to_owned();
    for i in 0..4000 {
        let (x, y, z) = (i % 20, i / 20 % 20, i / 400);
        // Neighbours touch, and the middle ray is tangent to many.
        text += &format!(
            " sphere s{i} {{ material m center {} {} {} radius 0.5 }}",
            f64::from(x) - 5.5,
            f64::from(y) - 5.5,
            -1 - z
        );
    }
    let scene = scene(&text);
    let bounds = Prepared::<Bounded>::new(&scene, 0.0);
    let sources = bounds.sources(&scene, ViewParameters::from(0.0));
    Lazy::clear();
    let exact = Prepared::<Lazy>::again(&scene, ViewParameters::from(0.0), &bounds, &sources);
    assert!(exact.spheres.is_empty() && exact.sphere_count() == bounds.spheres.len());
    let world = exact.world.as_ref().unwrap();
    assert!(world.spheres.is_empty() && world.sphere_count() == 4000);
    // The same picture from a scene without a tree: the first 40 spheres, which stand in front, and those alone.
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let mut exact = 0;
    for y in 0..9 {
        for x in 0..9 {
            let decided = exact_tracer
                .trace(&Limits::default(), Sampling::Once, x, y)
                .unwrap();
            assert!(decided.by < DecidedBy::Presumed);
            exact += usize::from(decided.by == DecidedBy::Exact);
        }
    }
    assert!(exact > 0, "no ray is tangent");
}

/// What precision asks of a device's bytes does not change the CPU's: a scene packed for fast pictures has not all that
/// the bounds of many pixels at once lean on.
#[test]
fn the_cpus_bytes_are_certified_in_fast_pictures_too() {
    // Without that some pixels of these are sure and wrong.
    for name in ["gallery/pplane_slanted.txt", "hard/pplane_2_floor_tie.txt"] {
        let mut scene = common::read(&common::scenes().join(name));
        scene.camera.pixeldim = [160, 120];
        let [certified, fast] = [Precision::Certified, Precision::Fast].map(|precision| {
            let settings = Settings {
                precision,
                ..common::on(Backend::Cpu)
            };
            common::picture(&scene, &settings).0
        });
        assert!(fast == certified, "{name}");
    }
}

//! What decides a pixel on the CPU: which numbers decide what, that bounds hold, and that a broken one is noticed.

use std::path::Path;

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::Limits;
use plumb::frame::{DecidedBy, Part};
use plumb::jitter::{self, Sampling};
use plumb::prepare::ViewParameters;
use plumb::real::{Bounded, Real};
use plumb::scene::{Scene, load_from};
use plumb::settings::{Backend, Precision, Settings};

use crate::common;

fn scene(text: &str) -> Scene {
    load_from("test", text.as_bytes(), Path::new(".")).unwrap()
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
    let limits = Limits::default();
    let brings = |x, y, sample| {
        let offset = [jitter::hash(x, y, sample)];
        exact_tracer.pixel_enclosure(&limits, Sampling::Given(&offset), x, y)
    };
    // The samples that the part holds: none, some, all but one of the second word.
    for held in [[0, 0], [0x00ff_0f37, 0x51], [!0, 0x7f]] {
        let (mut open, mut seen, mut pixels) = (0, [0; 3], 0);
        for i in 0..40 {
            let (x, y) = (i * 16, i * 9);
            let all_bring = (0..SAMPLES).map(|sample| brings(x, y, sample));
            let Some(all_bring) = all_bring.collect::<Option<Vec<_>>>() else {
                // f64 does not tell what one of the rays meets.
                continue;
            };
            pixels += 1;
            let mut sum = [0.0; 3];
            for sample in (0..SAMPLES).filter(|s| held[*s as usize / 32] >> (s % 32) & 1 != 0) {
                let [r, g, b] = all_bring[sample as usize];
                for (sum, c) in sum.iter_mut().zip([r, g, b]) {
                    *sum += 255.0 * c.value / f64::from(SAMPLES);
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
            // What the samples that are missing bring may be known already, of some or of all.
            let missing = |sample: &u32| held[*sample as usize / 32] >> (sample % 32) & 1 == 0;
            let brought: Vec<_> = (0..SAMPLES)
                .filter(missing)
                .map(|sample| all_bring[sample as usize])
                .collect();
            let with = |brought: &[Option<[Bounded; 3]>]| {
                let summed = &held;
                let part = Part { sum, error, summed };
                let decided = exact_tracer.complete(&limits, sampling, [x, y], &part, brought);
                decided.unwrap().map(|decided| decided.bytes)
            };
            let all: Vec<_> = brought.iter().copied().map(Some).collect();
            let every_other: Vec<_> = (0..)
                .zip(&all)
                .map(|(i, b)| b.filter(|_| i % 2 == 0))
                .collect();
            for brought in [&all, &every_other] {
                assert!(
                    with(brought).is_none_or(|bytes| bytes == whole.bytes),
                    "({x}, {y})"
                );
            }
            let brighter =
                |[r, g, b]: [Bounded; 3]| Some([r, g, b].map(|c| c + Bounded::exact(2.0)));
            let brighter: Vec<_> = brought.into_iter().map(brighter).collect();
            let white = brighter.is_empty() || white;
            seen[2] += usize::from(white || with(&brighter) != Some(whole.bytes));
            let off = complete(sum.map(|c| c + 1.0), error, &held);
            let more = complete(
                sum,
                error,
                &[held[0] | (held[0] + u32::from(held[0] != !0)), 0xff],
            );
            seen[0] += usize::from(off.is_some_and(|bytes| bytes != whole.bytes));
            seen[1] += usize::from(more.is_some_and(|bytes| bytes != whole.bytes));
        }
        assert!(
            pixels > 35 && open < 3,
            "{open} of {pixels} were not decided"
        );
        assert!(seen.iter().all(|seen| *seen > 20), "{held:x?}: {seen:?}");
    }
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

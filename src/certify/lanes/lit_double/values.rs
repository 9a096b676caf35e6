//! In f64, values and their bounds: that these hold the exact value, and are not much larger than they have to be.

use std::path::PathBuf;

use fearless_simd::{Level, Simd};

use super::records::WorldSphere;
use super::{Scene, samples, text, traced};
use crate::certify::lanes::doubles::DoubleLanes;
use crate::certify::lanes::vector::{D, Lanewise as _, Vec2, Vec3};
use crate::cpu::pixel::{ExactTracer, pixel_value};
use crate::jitter::Sampling;
use crate::real::{Bounded, Pair, Real as _};
use crate::scene::load;
use crate::settings::{SamplePattern, Settings};

/// The number of a lane of each component.
fn lane<S: Simd>(v: Vec3<D<S>>, lane: usize) -> [f64; 3] {
    [v.x, v.y, v.z].map(|part| part.lane(lane))
}

/// How far the exact number surely lies from this one, at least and at most.
fn off(exact: Pair, from: f64) -> [f64; 2] {
    let off = (exact - Pair::exact(from)).enclosure();
    let error = off.error * 1.0001;
    [(off.value.abs() - error).max(0.0), off.value.abs() + error]
}

/// A sample's pixel, where in that it is, and what it brings.
type Truth = ([u32; 2], [f64; 2], [Pair; 3]);

/// What came of samples: how many were looked at, how many are not within their bounds if those are multiplied by a
/// factor, and the largest share of a bound that the error was.
#[derive(Debug, Default)]
struct Seen {
    samples: usize,
    beyond: usize,
    most: f64,
}

fn look<S: Simd>(scene: &Scene<'_, S>, truths: &[Truth], factor: f64, seen: &mut Seen) {
    what_is_brought_is_what_is_traced(scene, truths);
    let mut state = text::State::new(scene.simd);
    for truths in truths.chunks(4) {
        let places: Vec<_> = truths.iter().map(|(at, ..)| *at).collect();
        let offset = |lane: usize| truths[lane.min(truths.len() - 1)].1;
        let offset = Vec2::new(0, 1).map(|part| D::from_fn(scene.simd, |lane| offset(lane)[part]));
        let traced = traced(scene, &mut state, &places, offset);
        for (i, (_, _, truth)) in truths.iter().enumerate() {
            if traced.verdict.as_slice()[i] != 0 {
                continue;
            }
            seen.samples += 1;
            let (color, error) = (lane(traced.color, i), lane(traced.error, i));
            for channel in 0..3 {
                let exact = Pair::exact(255.0) * truth[channel];
                let [least, most] = off(exact, color[channel]);
                // What a GPU may flush is in a bound too, and more than all else; nothing is flushed here. What no ray
                // meets is black, with a bound of 0.
                let flushed = text::constants::FLUSHED;
                let bound = (error[channel] - flushed).max(0.0);
                // Of less nothing is left in the sum.
                let lost = f64::EPSILON * flushed;
                seen.beyond += usize::from(least > factor * bound + lost);
                if bound > 0.0 {
                    seen.most = seen.most.max(most / bound);
                }
            }
        }
    }
}

/// What is handed on of samples is what the text makes of them, and no bound is lost on the way.
fn what_is_brought_is_what_is_traced<S: Simd>(scene: &Scene<'_, S>, truths: &[Truth]) {
    let places: Vec<_> = truths.iter().map(|(at, ..)| *at).collect();
    let offsets: Vec<_> = truths.iter().map(|(_, offset, _)| *offset).collect();
    let mut brought = vec![None; truths.len()];
    samples(scene, &places, &offsets, &mut brought);
    let mut state = text::State::new(scene.simd);
    for (i, brought) in brought.iter().enumerate() {
        let offset = Vec2::new(0, 1).map(|part| scene.real(offsets[i][part]));
        let traced = traced(scene, &mut state, &places[i..=i], offset);
        // By itself it may be less in doubt, where lanes walk together.
        let Some(brought) = brought else {
            continue;
        };
        assert_eq!(traced.verdict.as_slice()[0], 0);
        let (color, error) = (lane(traced.color, 0), lane(traced.error, 0));
        for (channel, brought) in brought.iter().enumerate() {
            assert!((255.0 * brought.value - color[channel]).abs() <= 1e-15 * color[channel].abs());
            assert!(255.0 * brought.error * Bounded::GROW >= error[channel]);
        }
    }
}

/// What every so manyth pixel's samples bring, one of each.
fn truths(tracer: &ExactTracer<'_>, settings: &Settings, step: usize) -> Vec<Truth> {
    let [width, height] = SIZE;
    let (limits, jitter) = (settings.sample_limits(), settings.sampling(width, height));
    let sample = |i: u32| {
        let [x, y] = [i % width, i / width];
        let row = jitter.row(y);
        let sampling = jitter.pixel(row.as_deref(), width as usize, x as usize);
        let [a, b] = sampling
            .offsets(x, y)
            .nth((i / 3 % sampling.samples()) as usize)?;
        let value = pixel_value(tracer.pairs(), &limits, Sampling::Given(&[[a, b]]), x, y)?;
        // A sample is where the sum is, rounded.
        let offset = [(x, a), (y, b)].map(|(x, a)| (f64::from(x) + a) - f64::from(x));
        Some(([x, y], offset, [value.x, value.y, value.z]))
    };
    let all = (0..width * height).step_by(step);
    all.filter_map(sample).collect()
}

const SIZE: [u32; 2] = [40, 30];

#[test]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn bounds_hold_the_exact_values() {
    for (samples, jitter, step, least) in [
        (1, SamplePattern::Hash, 7, 700),
        (4, SamplePattern::Hash, 11, 400),
        (3, SamplePattern::Course, 13, 350),
    ] {
        let settings = Settings {
            samples,
            jitter,
            ..Settings::default()
        };
        let mut seen = Seen::default();
        let mut without = Seen::default();
        for name in [
            "lit/mirror_balls.txt",
            "lit/gem.txt",
            "hard/lit_glint_everywhere.txt",
            "hard/lit_balls_twice.txt",
            "showcase.txt",
            "gallery/quadric_lamp.txt",
            "gallery/quadric_chess.txt",
        ] {
            let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes", name]
                .iter()
                .collect();
            let mut model = load(&path).unwrap();
            model.camera.pixeldim = SIZE;
            let exact_tracer = ExactTracer::new(&model, settings.view());
            let truths = truths(&exact_tracer, &settings, step);
            let doubles = DoubleLanes::new(&model, &settings).unwrap();
            let simd = Level::new().as_avx2().expect("a processor with AVX2");
            let scene = doubles.scene(simd);
            let before = (seen.samples, seen.most);
            look(&scene, &truths, 1.0, &mut seen);
            look(&scene, &truths, 1e-4, &mut without);
            println!(
                "{name}: {} samples, most {:.3} after {:.3}",
                seen.samples - before.0,
                seen.most,
                before.1
            );
        }
        println!("{samples}, {jitter:?}: {seen:?}; with bounds of a ten-thousandth: {without:?}");
        assert!(seen.samples > least);
        assert_eq!(seen.beyond, 0);
        // Bounds are not much larger than they have to be, and were they nothing, that would be noticed.
        assert!(seen.most > 0.1, "{seen:?}");
        assert!(without.beyond > least, "{without:?}");
    }
}

/// At the limb of a tiny sphere the square of the half chord is far below what f32 is kept from 0 by.
#[test]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn normals_of_tiny_spheres_are_within_their_bounds() {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes/lit/mirror_balls.txt"]
        .iter()
        .collect();
    let doubles = DoubleLanes::new(&load(&path).unwrap(), &Settings::default()).unwrap();
    let simd = Level::new().as_avx2().expect("a processor with AVX2");
    let scene = doubles.scene(simd);
    let power = |n: i32| 2.0_f64.powi(n);
    let (radius, along) = (power(-39), power(-38));
    let mut sure = 0;
    for steps in (0..60).map(|i| 1.35_f64.powi(i).ceil()) {
        // From the line to the center: so many times its last digit less than the radius.
        let apart = radius - steps * radius * power(-53);
        let sphere = WorldSphere {
            center: [along, apart, 0.0],
            radius,
            size: along + radius,
            inverse_radius: 1.0 / radius,
            ..WorldSphere::default()
        };
        let mut ray = text::SecondaryRay::zero(scene.simd);
        ray.dir = Vec3::new(scene.real(1.0), scene.real(0.0), scene.real(0.0));
        ray.dir_error = scene.real(power(-50));
        let found = text::sphere_normal_from(&scene, scene.same(&sphere), ray);
        let mut range = text::Range::zero(scene.simd);
        range.skip = scene.u32(u32::MAX);
        range.limit = scene.real(1.0);
        let hits = text::sphere_hits_from(&scene, &sphere, ray, range);
        if !hits.hit.any() {
            continue;
        }
        sure += 1;
        let [r, p] = [radius, apart].map(Pair::exact);
        let root = (r * r - p * p).sqrt();
        let error = found.w.lane(0);
        for (exact, got) in [(-(root / r), found.x), (-(p / r), found.y)] {
            let [least, _] = off(exact, got.lane(0));
            assert!(least <= error, "{steps} steps: {least} and not {error}");
        }
        assert!(error < 1e-3, "{error}");
    }
    assert!(sure > 20, "{sure}");
}

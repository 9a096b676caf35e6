//! The GPU's arithmetic on the CPU: what it is sure of is right, and it is sure of nearly all.

use std::sync::Arc;

use plumb::certify::lanes::{LANES, Lanes};
use plumb::cpu::pixel::ExactTracer;
use plumb::jitter::Sampling;
use plumb::prepare::ViewParameters;
use plumb::render::Settings;
use plumb::shader::pack::Packed;

use super::pictures::{Count, without_literal_bounds};
use crate::common;

/// Columns and rows: not a multiple of the lanes.
const SIZE: [u32; 2] = [93, 61];

/// All scenes of ours without lights, packed and changed by `change`.
fn count(change: fn(&mut Packed)) -> (Count, usize) {
    let settings = Settings::default();
    let limits = settings.sample_limits();
    let (mut count, mut scenes) = (Count::default(), 0);
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        scene.camera.pixeldim = SIZE;
        if !scene.lights.is_empty() {
            continue;
        }
        let exact_tracer =
            ExactTracer::new(&scene, ViewParameters::from(settings.screen_tolerance));
        let mut packed = Packed::prepared(exact_tracer.bounded(), &scene, &settings);
        change(&mut packed);
        let Some(lanes) = Lanes::of(Arc::new(packed)) else {
            continue;
        };
        scenes += 1;
        for y in 0..SIZE[1] {
            for x in (0..SIZE[0]).step_by(LANES) {
                let eight = lanes.row(x, y);
                for (x, lane) in (x..SIZE[0]).zip(0..LANES) {
                    count.pixels += 1;
                    if !eight.sure[lane] {
                        continue;
                    }
                    let exact = exact_tracer.trace(&limits, Sampling::Once, x, y).unwrap();
                    count.sure += 1;
                    count.wrong += usize::from(eight.bytes[lane] != exact.bytes);
                }
            }
        }
    }
    (count, scenes)
}

#[test]
fn what_eight_lanes_are_sure_of_is_right() {
    let (count, scenes) = count(|_| ());
    assert!(scenes > 80, "{scenes} scenes");
    assert_eq!(count.wrong, 0, "{count:?}");
    // The others are ties, and surfaces that are not plain or tiled.
    assert!(count.sure * 10 > count.pixels * 9, "{count:?}");
}

#[test]
fn lanes_without_bounds_are_noticed() {
    let (count, _) = count(without_literal_bounds);
    assert!(count.wrong > 20, "{count:?}");
}

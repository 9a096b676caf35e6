//! The GPU's arithmetic on the CPU: what it is sure of is right, it is sure of nearly all, and vectors of all widths
//! make the same.

use std::sync::Arc;

use plumb::certify::lanes::{Lanes, OPEN};
use plumb::cpu::pixel::ExactTracer;
use plumb::jitter::Sampling;
use plumb::prepare::ViewParameters;
use plumb::render::Settings;
use plumb::scene::Scene;
use plumb::shader::pack::Packed;

use super::pictures::{Count, without_literal_bounds};
use crate::common;

/// Columns and rows: not a multiple of the lanes of any vector.
const SIZE: [u32; 2] = [93, 61];

/// The words of all pixels, with each kind of vectors.
fn words(lanes: &Lanes) -> Vec<(&'static str, Vec<u32>)> {
    let all = lanes.with_each_vector().into_iter();
    all.map(|(name, lanes)| {
        let mut words = vec![0; (SIZE[0] * SIZE[1]) as usize];
        for (y, row) in (0..).zip(words.chunks_mut(SIZE[0] as usize)) {
            lanes.strip(0, y, row);
        }
        (name, words)
    })
    .collect()
}

/// All scenes of ours that ask so, packed and changed by `change`.
fn count(asked: fn(&Scene) -> bool, change: fn(&mut Packed)) -> (Count, usize) {
    let settings = Settings::default();
    let limits = settings.sample_limits();
    let (mut count, mut scenes) = (Count::default(), 0);
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        scene.camera.pixeldim = SIZE;
        if !asked(&scene) {
            continue;
        }
        let exact_tracer =
            ExactTracer::new(&scene, ViewParameters::from(settings.screen_tolerance));
        let mut packed = Packed::prepared(exact_tracer.bounded(), &scene, &settings);
        change(&mut packed);
        let Some(lanes) = Lanes::of(Arc::new(packed), &settings) else {
            continue;
        };
        scenes += 1;
        let all = words(&lanes);
        let (_, first) = &all[0];
        for (name, words) in &all {
            let differ = first.iter().zip(words).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{}: {name}", path.display());
        }
        // `certified` compares all pixels of these scenes with the oracle; where there are lights, f64 takes long.
        let step = if scene.lights.is_empty() { 1 } else { 7 };
        for (place, word) in (0..).zip(first).step_by(step) {
            count.pixels += 1;
            if *word >= OPEN {
                continue;
            }
            let at = [place % SIZE[0], place / SIZE[0]];
            let exact = exact_tracer.trace(&limits, Sampling::Once, at[0], at[1]);
            let [red, green, blue, _] = word.to_le_bytes();
            count.sure += 1;
            count.wrong += usize::from([red, green, blue] != exact.unwrap().bytes);
        }
    }
    (count, scenes)
}

#[test]
fn what_lanes_are_sure_of_is_right_and_the_same_in_all_widths() {
    let (count, scenes) = count(|_| true, |_| ());
    assert!(scenes > 150, "{scenes} scenes");
    assert_eq!(count.wrong, 0, "{count:?}");
    // The others are ties, and what is made to be hard.
    assert!(count.sure * 10 > count.pixels * 9, "{count:?}");
}

#[test]
fn lanes_without_bounds_are_noticed() {
    let (count, _) = count(|scene| scene.lights.is_empty(), without_literal_bounds);
    assert!(count.wrong > 20, "{count:?}");
}

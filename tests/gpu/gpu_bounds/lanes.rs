//! The GPU's arithmetic on the CPU: what it is sure of is right, it is sure of nearly all, and vectors of all widths
//! make the same.

use std::path::Path;
use std::sync::Arc;

use plumb::certify::lanes::doubles::DoubleLanes;
use plumb::certify::lanes::{Lanes, OPEN};
use plumb::cpu::pixel::ExactTracer;
use plumb::jitter::Jitter;
use plumb::render::{SamplePattern, Settings};
use plumb::scene::Scene;
use plumb::shader::pack::Packed;

use super::pictures::{Count, without_literal_bounds};
use crate::common;

/// Columns and rows of pictures of a sample a pixel and of several: not a multiple of the lanes of any vector.
const SIZE: [u32; 2] = [61, 43];
const SMALL: [u32; 2] = [19, 11];

/// The words of all pixels, with each kind of vectors.
fn words(
    lanes: &Lanes,
    jitter: &Jitter,
    [width, height]: [u32; 2],
) -> Vec<(&'static str, Vec<u32>)> {
    let all = lanes.with_each_vector().into_iter();
    all.map(|(name, lanes)| {
        let mut words = vec![0; (width * height) as usize];
        for (y, row) in (0..).zip(words.chunks_mut(width as usize)) {
            common::row_by_lanes(&lanes, jitter, y, row);
        }
        (name, words)
    })
    .collect()
}

/// Whether lanes go through cells of the screen, or walk down a tree: together, so that each is asked about what those
/// beside it may meet.
fn walks(packed: &Packed) -> bool {
    packed.screen_grid.is_some() || packed.bvh_depth > 0
}

/// What vectors of two widths are sure of is the same. So is what they are in doubt about, but where lanes walk
/// together: a rival more may be a doubt more.
fn same_in_all_widths(path: &Path, all: &[(&str, Vec<u32>)], walks: bool) {
    let (_, first) = &all[0];
    for (name, words) in all {
        let pairs = || first.iter().zip(words);
        let doubts = pairs()
            .filter(|(a, b)| (**a < OPEN) != (**b < OPEN))
            .count();
        let bytes = pairs()
            .filter(|(a, b)| a != b && **a < OPEN && **b < OPEN)
            .count();
        assert_eq!(bytes, 0, "{}: {name}", path.display());
        let most = if walks { first.len() / 100 } else { 0 };
        assert!(
            doubts <= most,
            "{}: {name}, {doubts} doubts",
            path.display()
        );
    }
}

/// All scenes of ours that ask so, packed and changed by `change`.
fn count(
    settings: &Settings,
    asked: fn(&Scene) -> bool,
    change: fn(&mut Packed),
) -> (Count, usize) {
    let limits = settings.sample_limits();
    let size = settings.supersampling().map_or(SIZE, |_| SMALL);
    let [width, height] = size;
    let jitter = settings.sampling(width, height);
    let (mut count, mut scenes) = (Count::default(), 0);
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        scene.camera.pixeldim = size;
        if !asked(&scene) {
            continue;
        }
        let exact_tracer = ExactTracer::new(&scene, settings.view());
        let mut packed = Packed::prepared(exact_tracer.bounded(), &scene, settings);
        change(&mut packed);
        let walks = walks(&packed);
        let Some(lanes) = Lanes::of(Arc::new(packed), settings) else {
            continue;
        };
        scenes += 1;
        let all = words(&lanes, &jitter, size);
        same_in_all_widths(&path, &all, walks);
        let (_, first) = &all[0];
        // `certified` compares all pixels of these scenes with the oracle; where there are lights, f64 takes long.
        let lit = !scene.lights.is_empty();
        let step = if lit { 7 } else { 1 } * settings.samples;
        for (y, row) in (0..).zip(first.chunks(width as usize)) {
            let offsets = jitter.row(y);
            for (x, word) in (0..).zip(row) {
                if !(y * width + x).is_multiple_of(step) {
                    continue;
                }
                count.pixels += 1;
                if *word >= OPEN {
                    continue;
                }
                let sampling = jitter.pixel(offsets.as_deref(), width as usize, x as usize);
                let exact = exact_tracer.trace(&limits, sampling, x, y);
                let [red, green, blue, _] = word.to_le_bytes();
                count.sure += 1;
                count.wrong += usize::from([red, green, blue] != exact.unwrap().bytes);
            }
        }
    }
    (count, scenes)
}

#[test]
fn what_lanes_are_sure_of_is_right_and_the_same_in_all_widths() {
    let (count, scenes) = count(&Settings::default(), |_| true, |_| ());
    assert!(scenes > 150, "{scenes} scenes");
    assert_eq!(count.wrong, 0, "{count:?}");
    // The others are ties, and what is made to be hard.
    assert!(count.sure * 10 > count.pixels * 9, "{count:?}");
}

#[test]
fn lanes_without_bounds_are_noticed() {
    let unlit = |scene: &Scene| scene.lights.is_empty();
    let (count, _) = count(&Settings::default(), unlit, without_literal_bounds);
    assert!(count.wrong > 20, "{count:?}");
}

/// Fewer samples than lanes, as many as some, more than all; by the hash, and as the course's program had them.
#[test]
fn what_lanes_are_sure_of_pixels_of_several_samples_is_right() {
    // Many samples take long: they get a third of the scenes each.
    let every: fn(&Scene) -> bool = |_| true;
    let third: fn(&Scene) -> bool = |scene| scene.objects.len() % 3 == 2;
    let other: fn(&Scene) -> bool = |scene| scene.objects.len().is_multiple_of(3);
    for (samples, jitter, asked, least) in [
        (3, SamplePattern::Course, every, 150),
        (16, SamplePattern::Hash, third, 30),
        (21, SamplePattern::Hash, other, 30),
    ] {
        let settings = Settings {
            samples,
            jitter,
            ..Settings::default()
        };
        let (count, scenes) = count(&settings, asked, |_| ());
        println!("{samples} samples, {jitter:?}, {scenes} scenes: {count:?}");
        assert!(scenes > least, "{scenes} scenes");
        assert_eq!(count.wrong, 0, "{count:?}");
        assert!(count.sure * 10 > count.pixels * 7, "{count:?}");
    }
}

/// In f64, of all pixels, whether f32 is sure of them or not: of a sample each, or of several.
fn count_in_f64(settings: &Settings, every: usize) -> (Count, usize) {
    let limits = settings.sample_limits();
    let size = settings.supersampling().map_or(SIZE, |_| SMALL);
    let [width, height] = size;
    let jitter = settings.sampling(width, height);
    let rows: Vec<_> = (0..height).map(|y| jitter.row(y)).collect();
    let places: Vec<[u32; 2]> = (0..height)
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .collect();
    let (mut count, mut scenes) = (Count::default(), 0);
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        scene.camera.pixeldim = size;
        if !DoubleLanes::may_be(&scene, settings) {
            continue;
        }
        let Some(lanes) = DoubleLanes::new(&scene, settings) else {
            continue;
        };
        scenes += 1;
        let exact_tracer = ExactTracer::new(&scene, settings.view());
        let words = |(name, lanes): (&'static str, DoubleLanes)| {
            let words = common::words_in_f64(&lanes, &exact_tracer, settings, &places, size);
            (name, words)
        };
        let all: Vec<_> = lanes.with_each_vector().into_iter().map(words).collect();
        same_in_all_widths(&path, &all, walks(&Packed::new(&scene, settings)));
        let (_, first) = &all[0];
        // Where f64 alone decides is what `certified` and `random_scenes` ask the oracle.
        for (word, [x, y]) in first.iter().zip(&places).step_by(every) {
            count.pixels += 1;
            if *word < OPEN {
                let row = rows[*y as usize].as_deref();
                let sampling = jitter.pixel(row, width as usize, *x as usize);
                let exact = exact_tracer.trace(&limits, sampling, *x, *y);
                let [red, green, blue, _] = word.to_le_bytes();
                count.sure += 1;
                count.wrong += usize::from([red, green, blue] != exact.unwrap().bytes);
            }
        }
    }
    (count, scenes)
}

#[test]
fn what_f64_is_sure_of_is_right_and_the_same_in_all_widths() {
    for (samples, jitter, every) in [
        (1, SamplePattern::Hash, 11),
        (5, SamplePattern::Hash, 7),
        (3, SamplePattern::Course, 5),
    ] {
        let settings = Settings {
            samples,
            jitter,
            ..Settings::default()
        };
        let (count, scenes) = count_in_f64(&settings, every);
        println!("{samples} samples, {jitter:?}, {scenes} scenes in f64: {count:?}");
        assert!(scenes > 60, "{scenes} scenes");
        assert_eq!(count.wrong, 0, "{count:?}");
        // The others are ties, what is made to be hard, and rays that are more than the lanes follow.
        assert!(count.sure * 100 > count.pixels * 90, "{count:?}");
    }
}

//! Bounds of f64 and of pairs of f64 hold the exact values, and exact numbers are made of what a ray comes near alone.

use std::cmp::Ordering;
use std::path::Path;

use super::*;
use crate::cpu::trace::{Unobserved, ray_trace};
use crate::scene::{load, load_from};

/// The scenes of ours that are right, with their files' names.
fn good_scenes() -> Vec<(String, Scene)> {
    let folders = ["notes", "gallery", "known", "hard", "lit"];
    let mut scenes = Vec::new();
    for folder in folders {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(folder);
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "txt") {
                let name = path.file_stem().unwrap().display().to_string();
                scenes.push((name, load(&path).unwrap()));
            }
        }
    }
    scenes
}

/// The value of one pixel's sample in numbers of one kind.
fn value<R: Real>(scene: &Prepared<R>, [x, y]: [u32; 2]) -> Option<[R; 3]> {
    let limits = Limits {
        enough: f64::INFINITY,
        ..Limits::default()
    };
    let traced = ray_trace(scene, &limits, f64::from(x), f64::from(y), &mut Unobserved);
    traced.ok().map(|t| [t.color.x, t.color.y, t.color.z])
}

/// How many channels were compared, how many are off by more than their bounds, and how many of these are useless.
#[derive(Debug, Default)]
struct Count {
    all: usize,
    off: usize,
    useless: usize,
}

/// Compares some pixels of each scene, in numbers of a kind and exactly: `compare` says whether a channel is off by
/// more than its bound, and whether that is useless.
fn count<R: Real>(
    asked: impl Fn(&str, &Scene) -> bool,
    pixels: u32,
    compare: impl Fn(R, Lazy) -> [bool; 2],
) -> Count {
    let mut count = Count::default();
    for (name, scene) in good_scenes() {
        if !asked(&name, &scene) {
            continue;
        }
        let view = ViewParameters::from(0.0);
        let bounds = Prepared::<Bounded>::new(&scene, view);
        let sources = bounds.sources(&scene, view);
        let numbers = Prepared::<R>::again(&scene, view, &bounds, &sources);
        Lazy::clear();
        let exact = Prepared::<Lazy>::again(&scene, view, &bounds, &sources);
        let end = Lazy::mark();
        let [width, height] = scene.camera.pixeldim;
        for i in 0..pixels {
            let at = [i * 7919 % width, i * 104_729 % height];
            if let (Some(value), Some(better)) = (value(&numbers, at), value(&exact, at)) {
                for (value, better) in value.into_iter().zip(better) {
                    let [off, useless] = compare(value, better);
                    count.all += 1;
                    count.off += usize::from(off);
                    count.useless += usize::from(useless);
                }
            }
            Lazy::release(end);
        }
    }
    count
}

/// A thousand panes throw five hundred thousand shadows: more exact numbers than a thread makes.
fn has_few_numbers(name: &str) -> bool {
    name != "lit_thousand_panes"
}

fn of_f64(scale: f64) -> Count {
    count(
        |name, _| has_few_numbers(name),
        12,
        |value: Bounded, better| {
            let better = better.bounded();
            let apart = (value.value - better.value).abs() - better.error;
            [
                apart > scale * value.error * Bounded::GROW,
                value.error > 1e-9 * value.value.abs() + 1e-12,
            ]
        },
    )
}

/// The same of pairs of f64, in lit scenes, where they are asked: their bounds are so small that only exact signs tell.
fn of_pairs(scale: f64) -> Count {
    count(
        |name, scene| has_few_numbers(name) && !scene.lights.is_empty(),
        3,
        |value: Pair, better| {
            let apart = better - Lazy::exact(value.high) - Lazy::exact(value.low);
            let bound = Lazy::exact(scale * value.error * Bounded::GROW);
            let beyond = [(apart - bound).sign(), (-apart - bound).sign()];
            [
                beyond.contains(&Ok(Ordering::Greater)),
                value.error > 1e-24 * value.high.abs() + 1e-28,
            ]
        },
    )
}

#[test]
fn bounds_hold_the_exact_values() {
    for (count, least) in [(of_f64(1.0), 4000), (of_pairs(1.0), 500)] {
        assert!(count.all > least, "{count:?}");
        assert_eq!(count.off, 0, "{count:?}");
        assert!(count.useless * 50 < count.all, "{count:?}");
    }
}

#[test]
fn a_bound_of_zero_is_noticed() {
    for count in [of_f64(0.0), of_pairs(0.0)] {
        assert!(count.off > 100, "{count:?}");
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
    let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
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

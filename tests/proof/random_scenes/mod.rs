//! Random scenes against the oracle, every byte: shapes that touch, graze and coincide, exactly or nearly (see
//! `strategy`).
//!
//! Scenes are numbered; a number is a seed and gives the same scene everywhere. `PLUMB_RANDOM_SCENES=5000` tries that
//! many, `PLUMB_RANDOM_FIRST=123` starts at that number: one failing scene is tried again by
//! `PLUMB_RANDOM_FIRST=123 PLUMB_RANDOM_SCENES=1`; with `PLUMB_RANDOM_SHOW=1` every scene is printed. A failing scene
//! is made as small as it gets and printed as text.

mod motifs;
mod quadrics;
mod strategy;
mod triangles;

use std::sync::Arc;
use std::time::Instant;

use plumb::certify::lanes::{Lanes, OPEN};
use plumb::render::{Backend, Error, SamplePattern, Settings, render_with};
use plumb::scene::{Scene, parse};
use plumb::shader::pack::Packed;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::common;
use crate::doubles::{self, with_doubles};
use crate::oracle::{self, Answer, Failure, Rules};
use strategy::{Plan, plan};

/// Scenes tried without being asked for more.
const SCENES: u64 = 200;

/// Without being asked for a number, the GPU gets one scene in so many: it compiles a shader for each.
const ONE_FOR_THE_GPU: u64 = 8;

/// A pixel that takes more rays, or more mirrors one after another, is not compared: it would take the oracle minutes.
const MOST_RAYS: u32 = 1_000;
const MOST_MIRRORS: u32 = 24;

/// What a scene came to.
#[derive(Debug, Default)]
struct Tried {
    pixels: usize,
    differing: Vec<String>,
    unresolved: usize,
    skipped: usize,
    effort: oracle::real::Effort,
}

fn settings(plan: &Plan, backend: Backend) -> Settings {
    let mut settings = common::on(backend);
    settings.screen_tolerance = plan.tolerance;
    settings.limits.max_path = plan.max_path;
    settings.samples = plan.samples;
    if plan.course {
        settings.jitter = SamplePattern::Course;
    }
    settings
}

fn scene_of(plan: &Plan) -> Scene {
    let text = plan.text();
    parse("random", text.as_bytes(), &common::scenes())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn answer(plan: &Plan, scene: &Scene) -> Answer {
    let mut rules = Rules::from(&settings(plan, Backend::Cpu));
    rules.max_rays = MOST_RAYS;
    rules.max_mirrors = MOST_MIRRORS;
    oracle::picture(scene, &rules)
}

fn try_scene(plan: &Plan, gpu_too: bool) -> Tried {
    let scene = scene_of(plan);
    let answer = answer(plan, &scene);
    let mut tried = Tried {
        effort: answer.effort,
        ..Tried::default()
    };
    let failed = |failure| answer.pixels.iter().filter(|p| **p == Err(failure)).count();
    tried.unresolved = failed(Failure::Unresolved);
    tried.skipped = failed(Failure::TooManyRays);
    for &backend in oracle::CERTIFIED {
        if backend == Backend::Gpu && !gpu_too {
            continue;
        }
        let mut rgb = Vec::new();
        let wanted = settings(plan, backend);
        let rendered = render_with(&scene, &wanted, common::devices(), &mut |band| {
            rgb.extend_from_slice(&band.rgb);
            Ok(())
        });
        match rendered {
            Ok(report) => {
                // The picture is right then, and yet it must not have come to that.
                if let Some(revoked) = &report.revoked {
                    tried.differing.push(revoked.clone());
                    continue;
                }
                oracle::rendered_as_asked(&report, backend);
            }
            Err(Error::TooManyRays(_)) if tried.skipped > 0 => continue,
            Err(error) => {
                tried.differing.push(format!("{backend:?}: {error}"));
                continue;
            }
        }
        tried.pixels += answer.pixels.len() - tried.skipped;
        let mut pictures = vec![(format!("{backend:?}"), rgb)];
        if backend == Backend::Cpu {
            let in_f64 = doubles::with_lanes(&scene, &wanted, &pictures[0].1);
            pictures.extend(with_lanes(&scene, &wanted, &pictures[0].1));
            pictures.extend(in_f64);
        }
        if backend == Backend::Gpu {
            let doubled = with_doubles(&scene, &wanted, &pictures[0].1);
            pictures.extend(doubled.map(|rgb| ("the GPU in f64".to_owned(), rgb)));
        }
        for (by, rgb) in pictures {
            let differences = oracle::differences(&scene, &answer, &rgb);
            tried
                .differing
                .extend(differences.map(|d| format!("{by}: {d}")));
        }
    }
    tried
}

/// The picture once more for each kind of vectors that the processor has, with the bytes of the pixels that its lanes
/// are sure of: a rendering takes the widest alone.
fn with_lanes(scene: &Scene, wanted: &Settings, rgb: &[u8]) -> Vec<(String, Vec<u8>)> {
    let lanes = Lanes::new(wanted, || Arc::new(Packed::new(scene, wanted)));
    let [width, height] = scene.camera.pixeldim;
    let jitter = wanted.sampling(width, height);
    let picture = |(name, lanes): (&str, Lanes)| {
        let mut words = vec![OPEN; width as usize];
        let mut rgb = rgb.to_vec();
        for (y, row) in (0..height).rev().zip(rgb.chunks_mut(3 * width as usize)) {
            common::row_by_lanes(&lanes, &jitter, y, &mut words);
            for (pixel, word) in row.chunks_mut(3).zip(&words) {
                if *word < OPEN {
                    pixel.copy_from_slice(&word.to_le_bytes()[..3]);
                }
            }
        }
        (name.to_owned(), rgb)
    };
    let all = lanes.iter().flat_map(Lanes::with_each_vector);
    all.map(picture).collect()
}

/// The strategy's scene of this number.
fn tree(number: u64) -> impl ValueTree<Value = Plan> {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&number.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    plan().new_tree(&mut runner).unwrap()
}

/// A failing scene as small as it gets within a minute, and what fails.
fn smallest(mut tree: impl ValueTree<Value = Plan>, differs: bool) -> (Plan, Tried) {
    let bad = |tried: &Tried| {
        if differs {
            !tried.differing.is_empty()
        } else {
            tried.unresolved > 0
        }
    };
    let start = Instant::now();
    let mut found = tree.current();
    let mut moved = tree.simplify();
    while moved && start.elapsed().as_secs() < 60 {
        let plan = tree.current();
        if bad(&try_scene(&plan, true)) {
            found = plan;
            moved = tree.simplify();
        } else {
            moved = tree.complicate();
        }
    }
    let tried = try_scene(&found, true);
    (found, tried)
}

/// A scene and what is wrong with it, as text.
fn shown(plan: &Plan, tried: &Tried) -> String {
    let mut text = plan.text();
    for difference in tried.differing.iter().take(8) {
        text += &format!("\n  {difference}");
    }
    let count = tried.differing.len();
    text + &format!("\n  {count} differ, {} unresolved", tried.unresolved)
}

fn number(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{name}: {text} is not a number")),
        Err(_) => default,
    }
}

#[test]
fn random_scenes_are_certified() {
    let first = number("PLUMB_RANDOM_FIRST", 0);
    let count = number("PLUMB_RANDOM_SCENES", SCENES);
    let start = Instant::now();
    let mut all = Tried::default();
    let mut failed = Vec::new();
    let mut tied = 0;
    let asked = std::env::var_os("PLUMB_RANDOM_SCENES").is_some();
    let all_shown = std::env::var_os("PLUMB_RANDOM_SHOW").is_some();
    for n in first..first + count {
        if all_shown {
            println!("scene {n}:\n{}", tree(n).current().text());
        }
        let gpu_too = asked || n % ONE_FOR_THE_GPU == 0;
        let tried = try_scene(&tree(n).current(), gpu_too);
        all.pixels += tried.pixels;
        all.skipped += tried.skipped;
        all.effort += tried.effort;
        tied += u64::from(tried.effort.ties > 0);
        if !tried.differing.is_empty() || tried.unresolved > 0 {
            println!("PLUMB_RANDOM_FIRST={n} PLUMB_RANDOM_SCENES=1 fails:");
            println!("{}", shown(&tree(n).current(), &tried));
            if failed.len() < 3 {
                let (plan, tried) = smallest(tree(n), !tried.differing.is_empty());
                println!("made small:");
                println!("{}", shown(&plan, &tried));
            }
            failed.push(n);
        }
    }
    println!(
        "scenes {first}..{}: {tied} with ties, {} pixels, {} skipped, {:.1} s; {:?}",
        first + count,
        all.pixels,
        all.skipped,
        start.elapsed().as_secs_f64(),
        all.effort
    );
    assert!(failed.is_empty(), "scenes {failed:?}");
    // Scenes that never tie would test little.
    assert!(
        count < 100 || tied * 5 > count,
        "only {tied} scenes of {count} with ties"
    );
    // Nor would pixels that are all skipped.
    assert!(all.skipped * 20 < all.pixels, "{} skipped", all.skipped);
}

//! Thousands of scenes of each kind against the oracle, and how long each takes.
//!
//! `PLUMB_EXTREMES=500` tries so many of each kind, `PLUMB_EXTREMES_FIRST=17` begins at that number;
//! `PLUMB_EXTREMES_KIND=2` takes that kind alone.

use std::time::{Duration, Instant};

use plumb::render::{SamplePattern, Settings};

use super::kinds::{Case, KINDS, SurfaceKind, case};
use super::{cpu, picture, scene};
use crate::oracle::{self, Failure, Rules, differences};

/// Scenes of a kind that are tried without being asked for more.
const SCENES: u64 = 40;

/// A pixel that takes more rays, or more mirrors one after another, is not compared: it would take the oracle minutes.
const MOST_RAYS: u32 = 300;
const MOST_MIRRORS: u32 = 12;

/// No scene of so few pixels may take longer.
const LONGEST: Duration = Duration::from_secs(60);

#[derive(Debug, Default)]
struct Tried {
    pixels: usize,
    unresolved: usize,
    skipped: usize,
    seconds: f64,
    oracle: f64,
    slowest: (Duration, u64),
    wrong: Vec<String>,
}

pub(super) fn settings(case: &Case) -> Settings {
    let mut settings = cpu();
    settings.samples = case.samples;
    settings.limits.max_path = case.max_path;
    if case.course {
        settings.jitter = SamplePattern::Course;
    }
    settings
}

fn try_case(case: &Case, number: u64, tried: &mut Tried) {
    let scene = scene(&case.text);
    let settings = settings(case);
    let mut rules = Rules::from(&settings);
    rules.max_rays = MOST_RAYS;
    rules.max_mirrors = MOST_MIRRORS;
    let start = Instant::now();
    let answer = oracle::picture(&scene, &rules);
    tried.oracle += start.elapsed().as_secs_f64();
    let failed = |failure| answer.pixels.iter().filter(|p| **p == Err(failure)).count();
    let (unresolved, skipped) = (failed(Failure::Unresolved), failed(Failure::TooManyRays));
    let start = Instant::now();
    let rendered = picture(&scene, &settings);
    let took = start.elapsed();
    tried.seconds += took.as_secs_f64();
    tried.slowest = tried.slowest.max((took, number));
    tried.pixels += answer.pixels.len() - unresolved - skipped;
    tried.unresolved += unresolved;
    tried.skipped += skipped;
    let found: Vec<String> = match rendered {
        Ok(rgb) => differences(&scene, &answer, &rgb).collect(),
        Err(error) if error.contains("rays") && skipped > 0 => vec![],
        Err(error) => vec![error],
    };
    if !found.is_empty() {
        tried.wrong.push(format!(
            "{number}: {} samples, path {:e}\n{}{}",
            case.samples,
            case.max_path,
            case.text,
            found.join("\n")
        ));
    }
}

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap())
}

fn try_kind(kind: SurfaceKind) -> Tried {
    let first = number("PLUMB_EXTREMES_FIRST").unwrap_or(0);
    let count = number("PLUMB_EXTREMES").unwrap_or(SCENES);
    let mut tried = Tried::default();
    for number in first..first + count {
        try_case(&case(kind, number), number, &mut tried);
    }
    tried
}

#[test]
fn extreme_scenes_are_certified() {
    let mut wrong = Vec::new();
    for (i, kind) in (0..).zip(KINDS) {
        if number("PLUMB_EXTREMES_KIND").is_some_and(|asked| asked != i) {
            continue;
        }
        let tried = try_kind(kind);
        println!(
            "{kind:?}: {} pixels, {} unresolved, {} skipped, {:.1} s, slowest {:.2?}, the oracle {:.1} s",
            tried.pixels,
            tried.unresolved,
            tried.skipped,
            tried.seconds,
            tried.slowest,
            tried.oracle
        );
        assert!(tried.slowest.0 < LONGEST, "{kind:?}: {:?}", tried.slowest);
        assert!(
            tried.pixels > 2 * (tried.unresolved + tried.skipped),
            "{kind:?} says little"
        );
        wrong.extend(
            tried
                .wrong
                .into_iter()
                .map(|what| format!("{kind:?} {what}")),
        );
    }
    assert!(
        wrong.is_empty(),
        "{} scenes:\n{}",
        wrong.len(),
        wrong.join("\n\n")
    );
}

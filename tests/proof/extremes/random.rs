//! Thousands of scenes of each kind against the oracle, on both tracers, and how long each takes.
//!
//! `PLUMB_EXTREMES=500` tries so many of each kind, on the GPU too; `PLUMB_EXTREMES_FIRST=17` begins at that number;
//! `PLUMB_EXTREMES_KIND=2` takes that kind alone, `PLUMB_EXTREMES_GPU=0` leaves out the GPU.

use std::time::{Duration, Instant};

use plumb::render::{Backend, Error, SamplePattern, Settings, render};
use plumb::scene::Scene;

use super::kinds::{Case, KINDS, SurfaceKind, case};
use super::{cpu, scene};
use crate::oracle::{self, Answer, Failure, Rules, differences};

/// Scenes of a kind that are tried without being asked for more.
const SCENES: u64 = 40;

/// Without being asked for a number, the GPU gets one scene in so many, of those that are made for it: it compiles a
/// shader for each.
const ONE_FOR_THE_GPU: u64 = 6;

/// A pixel that takes more rays, or more mirrors one after another, is not compared: it would take the oracle minutes.
const MOST_RAYS: u32 = 300;
const MOST_MIRRORS: u32 = 12;

#[derive(Debug, Default)]
struct Tried {
    pixels: usize,
    unresolved: usize,
    skipped: usize,
    seconds: f64,
    oracle: f64,
    slowest: (Duration, u64),
    gpu: TriedOnGpu,
    wrong: Vec<String>,
}

/// The same scenes on the GPU, which leaves those whose numbers f32 cannot hold to the CPU, and single pixels too.
#[derive(Debug, Default)]
struct TriedOnGpu {
    scenes: usize,
    pixels: u64,
    doubtful: u64,
    left: usize,
    seconds: f64,
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

/// The rules of a case, within what the oracle can do.
pub(super) fn rules(settings: &Settings) -> Rules {
    Rules {
        max_rays: MOST_RAYS,
        max_mirrors: MOST_MIRRORS,
        ..Rules::from(settings)
    }
}

/// What is wrong with the scene's picture on that tracer.
fn wrong(scene: &Scene, settings: &Settings, answer: &Answer, gpu: &mut TriedOnGpu) -> Vec<String> {
    let mut rgb = Vec::new();
    let rendered = render(scene, settings, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    });
    let skipped = answer.pixels.contains(&Err(Failure::TooManyRays));
    match rendered {
        Ok(report) => {
            if let Some(revoked) = report.revoked {
                return vec![revoked];
            }
            oracle::rendered_as_asked(&report, settings.backend);
            if report.backend == Backend::Gpu {
                gpu.scenes += 1;
                gpu.pixels += report.pixels;
                gpu.doubtful += report.refined;
            } else if settings.backend == Backend::Gpu {
                gpu.left += 1;
            }
            differences(scene, answer, &rgb).collect()
        }
        Err(Error::TooManyRays(_)) if skipped => vec![],
        Err(error) => vec![error.to_string()],
    }
}

fn try_case(case: &Case, number: u64, gpu_too: bool, tried: &mut Tried) {
    let scene = scene(&case.text);
    let settings = settings(case);
    let start = Instant::now();
    let answer = oracle::picture(&scene, &rules(&settings));
    tried.oracle += start.elapsed().as_secs_f64();
    let failed = |failure| answer.pixels.iter().filter(|p| **p == Err(failure)).count();
    let (unresolved, skipped) = (failed(Failure::Unresolved), failed(Failure::TooManyRays));
    tried.pixels += answer.pixels.len() - unresolved - skipped;
    tried.unresolved += unresolved;
    tried.skipped += skipped;
    let start = Instant::now();
    let mut found = wrong(&scene, &settings, &answer, &mut tried.gpu);
    let took = start.elapsed();
    tried.seconds += took.as_secs_f64();
    tried.slowest = tried.slowest.max((took, number));
    if gpu_too {
        let start = Instant::now();
        let settings = Settings {
            backend: Backend::Gpu,
            ..settings
        };
        let on_gpu = wrong(&scene, &settings, &answer, &mut tried.gpu);
        found.extend(on_gpu.into_iter().map(|what| format!("GPU: {what}")));
        tried.gpu.seconds += start.elapsed().as_secs_f64();
    }
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

fn on_gpu() -> bool {
    number("PLUMB_EXTREMES_GPU") != Some(0)
}

fn try_kind(kind: SurfaceKind) -> Tried {
    let first = number("PLUMB_EXTREMES_FIRST").unwrap_or(0);
    let asked = number("PLUMB_EXTREMES");
    let mut tried = Tried::default();
    for number in first..first + asked.unwrap_or(SCENES) {
        let gpu_too = match asked {
            Some(_) => on_gpu(),
            None => number % ONE_FOR_THE_GPU == 1,
        };
        try_case(&case(kind, number), number, gpu_too, &mut tried);
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
        println!("  {:?}", tried.gpu);
        assert!(
            tried.pixels > 2 * (tried.unresolved + tried.skipped),
            "{kind:?} says little"
        );
        assert!(
            tried.gpu.scenes > 0 || !on_gpu(),
            "{kind:?} is left to the CPU"
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

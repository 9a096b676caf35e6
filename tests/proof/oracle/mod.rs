//! The oracle of the tests: every byte of any scene, in multiprecision or exactly, from the text of docs/SCENE.md
//! alone.
//!
//! It shares the parsed scene with plumb, plain f64, and nothing else: no geometry, no arithmetic. Near is never taken
//! for equal: what balls of 4,096 bits and towers of 7 square roots do not decide is reported, not guessed.
//!
//! ```text
//! plumb::scene::Scene ─ world ─► hits, surface ─► trace ─► bytes
//!                                       │
//!                 real (expressions) ─ ball (enclosures of 60 … 4,096 bits), tower (exact signs), angle (cosines)
//! ```
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

pub(crate) mod angle;
pub(crate) mod ball;
mod hits;
mod jitter;
pub(crate) mod real;
mod surface;
pub(crate) mod tower;
mod trace;
mod upper;
mod vector;
mod world;

use std::ops::AddAssign;

use plumb::render::{Backend, Report, SamplePattern, Settings};
use plumb::scene::Scene;
use rayon::prelude::*;

pub(crate) use trace::Failure;

use jitter::Jitter;
use real::{Effort, take_effort};
use world::World;

/// The backends that are held to every byte, with the settings they have by default.
pub(crate) const CERTIFIED: &[Backend] = &[Backend::Cpu, Backend::Gpu];

/// The certificate held to the end, and the backend is the one asked for unless the scene's numbers are beyond f32.
pub(crate) fn rendered_as_asked(report: &Report, backend: Backend) {
    assert_eq!(report.revoked, None, "the GPU was sure and wrong");
    let beyond = report
        .fallback
        .as_deref()
        .is_some_and(|why| why.contains("for f32 with error bounds"));
    assert!(report.backend == backend || beyond, "{:?}", report.fallback);
}

/// What docs/SCENE.md, "What a picture is", leaves to options, and what a test breaks on purpose.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rules {
    pub(crate) tolerance: f64,
    pub(crate) max_path: f64,
    pub(crate) max_rays: u32,
    /// Most mirrors that a ray may have met.
    pub(crate) max_mirrors: u32,
    pub(crate) samples: u32,
    pub(crate) pattern: SamplePattern,
    /// Bits that every number is evaluated in at once.
    pub(crate) first_bits: usize,
    /// A rule broken on purpose, to see that it shows.
    pub(crate) fault: Option<Fault>,
}

/// Rules that are wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// A ray that touches a sphere hits it: ≥ for >.
    TangentHits,
    /// Of equally near hits the last in the file counts.
    LaterOfEquals,
    /// The edge of a spotlight's cone is lit: ≥ for >.
    ConeEdgeLit,
    /// A ball that a shadow ray enters where the lamp is blocks it: ≤ for <.
    BlocksAtLamp,
    /// A path of exactly the longest is not followed: ≥ for >.
    PathEnds,
    /// The edges of a rectangle are not its own: < for ≤.
    OpenRectangle,
    /// A projector's glint has no picture: E for E∘texel.
    GlintWithoutPicture,
    /// A projector's picture that is behind the hit colours it: 0 < f for 0 < f < 1.
    PictureBehind,
    /// Bytes are rounded, not cut off.
    Rounds,
}

impl From<&Settings> for Rules {
    fn from(settings: &Settings) -> Self {
        Self {
            tolerance: settings.screen_tolerance,
            max_path: settings.limits.max_path,
            max_rays: settings.limits.max_rays,
            max_mirrors: u32::MAX,
            samples: settings.samples,
            pattern: settings.jitter,
            first_bits: real::FIRST,
            fault: None,
        }
    }
}

impl Default for Rules {
    fn default() -> Self {
        Self::from(&Settings::default())
    }
}

/// What the oracle found.
#[derive(Debug)]
pub(crate) struct Answer {
    /// The pixels asked for, in that order.
    pub(crate) pixels: Vec<Result<[u8; 3], Failure>>,
    pub(crate) effort: Effort,
}

impl AddAssign for Effort {
    fn add_assign(&mut self, other: Self) {
        self.open += other.open;
        self.exact += other.exact;
        self.ties += other.ties;
        self.deep += other.deep;
    }
}

/// A whole picture, top row first.
pub(crate) fn picture(scene: &Scene, rules: &Rules) -> Answer {
    let [width, height] = scene.camera.pixeldim;
    let pixels: Vec<[u32; 2]> = (0..height)
        .rev()
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .collect();
    pixels_of(scene, rules, &pixels)
}

/// Some pixels, each as column and row from the bottom.
pub(crate) fn pixels_of(scene: &Scene, rules: &Rules, pixels: &[[u32; 2]]) -> Answer {
    let jitter = Jitter::new(scene.camera.pixeldim, rules.samples, rules.pattern);
    let work = |part: &[[u32; 2]]| {
        real::evaluate_first_in(rules.first_bits);
        let world = World::new(scene, rules);
        take_effort();
        let found: Vec<_> = part
            .iter()
            .map(|&[x, y]| world.pixel(x, y, &jitter.of(x, y)))
            .collect();
        (found, take_effort())
    };
    let part = (pixels.len() / 16).clamp(8, 256);
    // Expressions nest as deep as rays do.
    let pool = rayon::ThreadPoolBuilder::new()
        .stack_size(256 << 20)
        .build()
        .unwrap();
    let parts: Vec<_> = pool.install(|| pixels.par_chunks(part).map(work).collect());
    let mut answer = Answer {
        pixels: Vec::with_capacity(pixels.len()),
        effort: Effort::default(),
    };
    for (found, effort) in parts {
        answer.pixels.extend(found);
        answer.effort += effort;
    }
    answer
}

/// Where a picture (top row first) is not what the oracle says. What the oracle has no bytes for is no difference.
pub(crate) fn differences<'a>(
    scene: &Scene,
    answer: &'a Answer,
    rgb: &'a [u8],
) -> impl Iterator<Item = String> + 'a {
    let [width, height] = scene.camera.pixeldim;
    assert_eq!(rgb.len(), 3 * answer.pixels.len());
    let pixels = answer.pixels.iter().zip(rgb.chunks_exact(3)).enumerate();
    pixels.filter_map(move |(i, (want, got))| match want {
        Ok(want) if want != got => {
            let (x, y) = (i as u32 % width, height - 1 - i as u32 / width);
            Some(format!("pixel ({x}, {y}) is {got:?}, ought to be {want:?}"))
        }
        _ => None,
    })
}

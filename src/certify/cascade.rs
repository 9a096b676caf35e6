//! What decides pixels that f32 leaves open: each decider takes what those before it left, and leaves less.
//!
//! `f64 for many pixels at once (lanes/doubles) -> f64, pairs of f64 and exact numbers for one (cpu/pixel)`. f32 is the
//! GPU's or the lanes'; what a GPU decides in f64 never comes here. [`pixels`](super::pixels) hands pixels in, from bands
//! that devices rendered and from those that the CPU makes alone.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::{Decided, DecidedBy};
use crate::certify::lanes::OPEN;
use crate::certify::lanes::doubles::DoubleLanes;
use crate::cpu::pixel::ExactTracer;
use crate::cpu::trace::Limits;
use crate::frame::{Halt, Part};
use crate::jitter::Sampling;
use crate::prepare::ViewParameters;
use crate::scene::Scene;
use crate::settings::Settings;

/// A pixel that is open.
pub(super) struct Open<'a> {
    /// Column, and row from the bottom.
    pub(super) at: [u32; 2],
    pub(super) sampling: Sampling<'a>,
    /// What is known of it: then only the samples that are missing are traced, if that is enough.
    pub(super) part: Option<Part<'a>>,
}

/// What deciding a pixel took.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Samples that were traced.
    pub(super) samples: u32,
    pub(super) took: Duration,
}

/// Who decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decides {
    /// Whoever is quickest.
    Any,
    /// The referee alone, who shares nothing with what is checked.
    Referee,
}

/// The deciders of a picture's pixels.
pub(super) struct Cascade<'a> {
    scene: &'a Scene,
    view: ViewParameters,
    limits: Limits,
    /// Whether the values before quantising are wanted, to the last bit of f32.
    values: bool,
    doubles: Doubles,
    exact_tracer: OnceLock<ExactTracer<'a>>,
}

impl<'a> Cascade<'a> {
    pub(super) fn new(scene: &'a Scene, settings: &Settings) -> Self {
        Self {
            scene,
            view: settings.view(),
            limits: settings.sample_limits(),
            values: settings.values,
            doubles: Doubles::new(scene, settings),
            exact_tracer: OnceLock::new(),
        }
    }

    /// Has the scene prepared already.
    pub(super) fn prepared(self, exact_tracer: ExactTracer<'a>) -> Self {
        let exact_tracer = exact_tracer.with_values(self.values);
        Self {
            exact_tracer: exact_tracer.into(),
            ..self
        }
    }

    /// Prepares the scene, if that was not done yet.
    pub(super) fn exact_tracer(&self) -> &ExactTracer<'a> {
        self.exact_tracer
            .get_or_init(|| ExactTracer::new(self.scene, self.view).with_values(self.values))
    }

    /// Whether pixels that are handed in together had better be many than of one row. They have no offsets then.
    pub(super) fn takes_any_rows(&self) -> bool {
        self.doubles.settings.is_some()
    }

    /// Decides these pixels, in any order, and hands each to `take` with its place among them. Where one cannot be
    /// decided, it is the first such.
    pub(super) fn decide(
        &self,
        open: &[Open<'_>],
        decides: Decides,
        take: &mut impl FnMut(usize, Decided, Effort),
    ) -> Result<(), Halt> {
        let doubles = match decides {
            Decides::Any => self.doubles.ask(self.scene, open.len()),
            Decides::Referee => None,
        };
        let left = match doubles {
            Some(doubles) => by_doubles(doubles, open, take),
            None => (0..open.len()).collect(),
        };
        let mut before = Instant::now();
        for i in left {
            let (decided, samples) = self.alone(&open[i])?;
            let after = Instant::now();
            let took = after - before;
            take(i, decided, Effort { samples, took });
            before = after;
        }
        Ok(())
    }

    /// A pixel by itself, in all numbers that it takes; and how many samples were traced.
    fn alone(&self, open: &Open<'_>) -> Result<(Decided, u32), Halt> {
        let exact_tracer = self.exact_tracer();
        let Open {
            at: [x, y],
            sampling,
            part,
        } = *open;
        let samples = sampling.samples();
        if let Some(part) = &part
            && let Some(decided) = exact_tracer.complete(&self.limits, sampling, x, y, part)?
        {
            return Ok((decided, samples - part.samples().min(samples)));
        }
        Ok((exact_tracer.trace(&self.limits, sampling, x, y)?, samples))
    }
}

/// Takes what f64 is sure of for many pixels at once. Returns the places of the others.
fn by_doubles(
    doubles: &DoubleLanes,
    open: &[Open<'_>],
    take: &mut impl FnMut(usize, Decided, Effort),
) -> Vec<usize> {
    let started = Instant::now();
    let at: Vec<[u32; 2]> = open.iter().map(|open| open.at).collect();
    let mut words = vec![OPEN; at.len()];
    doubles.pixels(&at, &mut words);
    let took = started.elapsed() / at.len().max(1) as u32;
    let mut left = Vec::new();
    for (i, word) in words.into_iter().enumerate() {
        if word >= OPEN {
            left.push(i);
            continue;
        }
        let [red, green, blue, _] = word.to_le_bytes();
        let bytes = [red, green, blue];
        let decided = Decided {
            // Nobody asks for values where there are these lanes.
            value: bytes.map(|byte| f32::from(byte) / 255.0),
            bytes,
            by: DecidedBy::Bounded,
        };
        take(i, decided, Effort { samples: 1, took });
    }
    left
}

/// The scene in f64 for many pixels at once, which is prepared when so many pixels were open that it is worth it.
struct Doubles {
    /// What it is prepared by, if it may be.
    settings: Option<Settings>,
    /// Pixels that were open so far.
    asked: AtomicUsize,
    made: OnceLock<Option<DoubleLanes>>,
}

/// Preparing a scene in f64 (0.1 ms, and 0.7 ms of 100 objects) takes as long as deciding some hundred pixels.
const WORTH: usize = 128;

impl Doubles {
    fn new(scene: &Scene, settings: &Settings) -> Self {
        Self {
            settings: DoubleLanes::may_be(scene, settings).then(|| settings.clone()),
            asked: AtomicUsize::new(0),
            made: OnceLock::new(),
        }
    }

    /// What decides so many pixels in f64, if that is there. Who finds that it is worth it makes it, and whoever asks
    /// meanwhile does without it: this thread may be given others' work while it waits for its own.
    fn ask(&self, scene: &Scene, pixels: usize) -> Option<&DoubleLanes> {
        let settings = self.settings.as_ref().filter(|_| pixels > 0)?;
        let before = self.asked.fetch_add(pixels, Ordering::Relaxed);
        if (before..before + pixels).contains(&WORTH) {
            // Nobody else makes it.
            let _ = self.made.set(DoubleLanes::new(scene, settings));
        }
        self.made.get()?.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::scene::load;

    const SIZE: [u32; 2] = [40, 30];

    /// How often each pixel of a picture is handed back, and the bytes that it has, if all are handed in so often.
    fn decided(cascade: &Cascade<'_>, decides: Decides) -> Vec<(usize, [u8; 3], DecidedBy)> {
        let open: Vec<_> = (0..SIZE[0] * SIZE[1])
            .map(|i| Open {
                at: [i % SIZE[0], i / SIZE[0]],
                sampling: Sampling::Once,
                part: None,
            })
            .collect();
        let mut all = vec![(0, [0; 3], DecidedBy::Presumed); open.len()];
        cascade
            .decide(&open, decides, &mut |i, decided, _| {
                all[i] = (all[i].0 + 1, decided.bytes, decided.by);
            })
            .unwrap();
        all
    }

    #[test]
    fn every_pixel_is_decided_once_whoever_decides() {
        let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes/lit/gem.txt"]
            .iter()
            .collect();
        let mut scene = load(&path).unwrap();
        scene.camera.pixeldim = SIZE;
        let settings = Settings::default();
        let cascade = Cascade::new(&scene, &settings);
        let alone = decided(&cascade, Decides::Referee);
        assert!(cascade.doubles.made.get().is_none());
        let any = decided(&cascade, Decides::Any);
        assert!(cascade.takes_any_rows());
        // Some are left, and they are decided too.
        let doubles = cascade.doubles.made.get().unwrap().as_ref().unwrap();
        let at: Vec<_> = (0..SIZE[0] * SIZE[1])
            .map(|i| [i % SIZE[0], i / SIZE[0]])
            .collect();
        let mut words = vec![0; at.len()];
        doubles.pixels(&at, &mut words);
        let left = words.iter().filter(|word| **word >= OPEN).count();
        assert!((1..at.len() / 4).contains(&left), "{left} left");
        for (alone, any) in alone.iter().zip(&any) {
            assert_eq!((alone.0, any.0), (1, 1));
            assert_eq!(alone.1, any.1);
        }
    }

    #[test]
    fn few_pixels_are_not_worth_the_preparation() {
        let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes/lit/gem.txt"]
            .iter()
            .collect();
        let scene = load(&path).unwrap();
        let doubles = Doubles::new(&scene, &Settings::default());
        assert!(doubles.ask(&scene, WORTH).is_none());
        assert!(doubles.ask(&scene, 0).is_none());
        assert!(doubles.ask(&scene, 1).is_some());
        // Values, or the samples of a pixel, are nothing for it.
        for settings in [
            Settings {
                values: true,
                ..Settings::default()
            },
            Settings {
                samples: 4,
                ..Settings::default()
            },
        ] {
            let doubles = Doubles::new(&scene, &settings);
            assert!(doubles.ask(&scene, 2 * WORTH).is_none());
        }
    }
}

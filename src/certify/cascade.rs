//! What decides pixels that f32 leaves open: each decider takes what those before it left, and leaves less.
//!
//! `f64 for many pixels at once (lanes/doubles) -> f64, pairs of f64 and exact numbers for one (cpu/pixel)`; of pixels
//! of several samples the first traces samples, and the second takes what these bring. f32 is the GPU's or the lanes';
//! what a GPU decides in f64 never comes here. [`pixels`](super::pixels) hands pixels in, from bands that devices
//! rendered and from those that the CPU makes alone.

use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::{Decided, DecidedBy};
use crate::certify::lanes::OPEN;
use crate::certify::lanes::doubles::DoubleLanes;
use crate::cpu::pixel::ExactTracer;
use crate::cpu::trace::Limits;
use crate::frame::{Halt, Part};
use crate::jitter::Sampling;
use crate::prepare::ViewParameters;
use crate::real::Bounded;
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

impl Open<'_> {
    /// How many of its samples are not known.
    fn missing(&self) -> u32 {
        let known = self.part.map_or(0, |part| part.samples());
        self.sampling.samples().saturating_sub(known)
    }
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
    /// Whether pixels have several samples.
    several: bool,
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
            several: settings.supersampling().is_some(),
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

    /// Whether pixels that are handed in together had better be many than of one row.
    pub(super) fn takes_many(&self) -> bool {
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
            Decides::Any => {
                let samples = open.iter().map(|open| u64::from(open.missing())).sum();
                self.doubles.ask(self.scene, samples)
            }
            Decides::Referee => None,
        };
        match doubles {
            Some(doubles) if self.several => groups(open).try_for_each(|group| {
                let brought = Brought::new(doubles, &open[group.clone()], group.start);
                self.each(open, group, &brought, take)
            }),
            Some(doubles) => {
                let left = by_doubles(doubles, open, take);
                self.each(open, left, &Brought::default(), take)
            }
            None => self.each(open, 0..open.len(), &Brought::default(), take),
        }
    }

    /// Decides those of the pixels that are left, one after the other.
    fn each(
        &self,
        open: &[Open<'_>],
        left: impl IntoIterator<Item = usize>,
        brought: &Brought,
        take: &mut impl FnMut(usize, Decided, Effort),
    ) -> Result<(), Halt> {
        let mut before = Instant::now();
        for i in left {
            let (decided, samples) = self.alone(&open[i], brought.of(i))?;
            let after = Instant::now();
            let took = after - before + brought.took;
            take(i, decided, Effort { samples, took });
            before = after;
        }
        Ok(())
    }

    /// A pixel by itself, in all numbers that it takes, but for what some samples are known to bring; and how many
    /// samples were traced.
    fn alone(
        &self,
        open: &Open<'_>,
        brought: &[Option<[Bounded; 3]>],
    ) -> Result<(Decided, u32), Halt> {
        let exact_tracer = self.exact_tracer();
        let Open {
            at: [x, y],
            sampling,
            part,
        } = *open;
        if part.is_some() || !brought.is_empty() {
            let part = part.unwrap_or(Part::NOTHING);
            let decided = exact_tracer.complete(&self.limits, sampling, [x, y], &part, brought)?;
            if let Some(decided) = decided {
                return Ok((decided, open.missing()));
            }
        }
        let decided = exact_tracer.trace(&self.limits, sampling, x, y)?;
        Ok((decided, sampling.samples()))
    }
}

/// So many samples are traced at once, or those of a pixel if these are more.
const AT_ONCE: u32 = 1 << 14;

/// Pixels that have so many missing samples together.
fn groups(open: &[Open<'_>]) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let (first, mut samples) = (start, 0);
        while start < open.len() && (start == first || samples < AT_ONCE) {
            samples += open[start].missing();
            start += 1;
        }
        (first < start).then_some(first..start)
    })
}

/// What the missing samples of pixels bring, traced many at once.
#[derive(Default)]
struct Brought {
    samples: Vec<Option<[Bounded; 3]>>,
    /// The first of the pixels.
    pixel: usize,
    /// Where each pixel's begin, and where the last one's end.
    first: Vec<usize>,
    /// What they took, for each pixel.
    took: Duration,
}

impl Brought {
    fn new(doubles: &DoubleLanes, open: &[Open<'_>], pixel: usize) -> Self {
        let started = Instant::now();
        let (mut places, mut offsets, mut first) = (Vec::new(), Vec::new(), vec![0]);
        for Open { at, sampling, part } in open {
            let all = (0..).zip(sampling.rounded_offsets(at[0], at[1]));
            let missing = all.filter(|(sample, _)| !part.is_some_and(|part| part.holds(*sample)));
            for (_, offset) in missing {
                places.push(*at);
                offsets.push(offset);
            }
            first.push(places.len());
        }
        let mut samples = vec![None; places.len()];
        doubles.samples(&places, &offsets, &mut samples);
        Self {
            samples,
            pixel,
            first,
            took: started.elapsed() / open.len().max(1) as u32,
        }
    }

    /// Those of a pixel; none where none were traced.
    fn of(&self, pixel: usize) -> &[Option<[Bounded; 3]>] {
        let place = pixel - self.pixel;
        match self.first.get(place..place + 2) {
            Some(ends) => &self.samples[ends[0]..ends[1]],
            None => &[],
        }
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

/// The scene in f64 for many samples at once, which is prepared when so many were missing that it is worth it.
struct Doubles {
    /// What it is prepared by, if it may be.
    settings: Option<Settings>,
    /// Samples that were missing so far.
    asked: AtomicU64,
    made: OnceLock<Option<DoubleLanes>>,
}

/// Preparing a scene in f64 (0.1 ms, and 0.7 ms of 100 objects) takes as long as tracing some hundred samples.
const WORTH: u64 = 128;

impl Doubles {
    fn new(scene: &Scene, settings: &Settings) -> Self {
        Self {
            settings: DoubleLanes::may_be(scene, settings).then(|| settings.clone()),
            asked: AtomicU64::new(0),
            made: OnceLock::new(),
        }
    }

    /// What traces so many samples in f64, if that is there. Who finds that it is worth it makes it, and whoever asks
    /// meanwhile does without it: this thread may be given others' work while it waits for its own.
    fn ask(&self, scene: &Scene, samples: u64) -> Option<&DoubleLanes> {
        let settings = self.settings.as_ref().filter(|_| samples > 0)?;
        let before = self.asked.fetch_add(samples, Ordering::Relaxed);
        if (before..before + samples).contains(&WORTH) {
            // Nobody else makes it.
            let _ = self.made.set(DoubleLanes::new(scene, settings));
        }
        self.made.get()?.as_ref()
    }
}

#[cfg(test)]
mod tests;

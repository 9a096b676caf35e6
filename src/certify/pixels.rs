//! Pixels decided on the CPU, on all cores: those that the GPU is not sure of, or whole bands.

use std::ops::Range;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::first_halt::FirstHalt;
use super::{Decided, DecidedBy, Tally};
use crate::certify::lanes::mean::Means;
use crate::certify::lanes::{LANES, Lanes, OPEN};
use crate::cpu::pixel::ExactTracer;
use crate::cpu::trace::Limits;
use crate::frame::{Band, Halt, Part, StopRequested, spare};
use crate::gpu::bands::Partials;
use crate::jitter::{Jitter, Sampling};
use crate::prepare::ViewParameters;
use crate::scene::Scene;
use crate::settings::Settings;

/// Single pixels are handed to the cores in pieces of this many: small, because some take a thousand times as long as
/// others, and those stand side by side.
const PIECE: usize = 16;

/// Up to this many pixels are decided on the calling thread: where the GPU is the CPU, waking another thread takes
/// longer (1 to 20 ms were measured).
const FEW: usize = 128;

/// What it takes to trace a pixel of a scene on the CPU.
pub struct PixelDecider<'a> {
    scene: &'a Scene,
    view: ViewParameters,
    limits: Limits,
    jitter: &'a Jitter,
    width: usize,
    /// Whether the values before quantising are wanted, to the last bit of f32.
    values: bool,
    /// Whether bands tell what decided each pixel.
    verdicts: bool,
    stop: &'a StopRequested<'a>,
    exact_tracer: OnceLock<ExactTracer<'a>>,
}

impl<'a> PixelDecider<'a> {
    /// For the scene's picture as the settings ask for it, whose samples are spread by `jitter`.
    pub fn new(scene: &'a Scene, settings: &Settings, jitter: &'a Jitter) -> Self {
        Self {
            scene,
            view: settings.view(),
            limits: settings.sample_limits(),
            jitter,
            width: scene.camera.pixeldim[0] as usize,
            values: settings.values,
            verdicts: settings.verdicts,
            stop: &|| false,
            exact_tracer: OnceLock::new(),
        }
    }

    /// Asks now and then whether to give up.
    #[must_use]
    pub fn stopping(self, stop: &'a StopRequested<'a>) -> Self {
        Self { stop, ..self }
    }

    /// Has the scene prepared already.
    #[must_use]
    pub fn prepared(self, exact_tracer: ExactTracer<'a>) -> Self {
        let exact_tracer = exact_tracer.with_values(self.values);
        Self {
            exact_tracer: exact_tracer.into(),
            ..self
        }
    }

    /// Prepares the scene, if that was not done yet.
    pub fn exact_tracer(&self) -> &ExactTracer<'a> {
        self.exact_tracer
            .get_or_init(|| ExactTracer::new(self.scene, self.view).with_values(self.values))
    }

    /// Decides the pixels at these places of a band (counted from its top left, in rising order) whose top row is
    /// `top`. Of those of which something is known only the samples that are missing are traced, if that is enough. Gives
    /// up where `unwanted` says that nobody wants them any more.
    pub fn pixels(
        &self,
        top: u32,
        places: &[u32],
        known: &Partials,
        unwanted: &StopRequested<'_>,
    ) -> Result<(Vec<Decided>, Tally), Halt> {
        let width = self.width as u32;
        // The offsets of a row's samples may have to be made for the whole row: once for all its pixels.
        let rows = places.chunk_by(|a, b| a / width == b / width);
        let row = |row: &[u32]| {
            let y = top - row[0] / width;
            (y, self.jitter.row(y).map(Arc::new))
        };
        let first = FirstHalt::default();
        let decided: Vec<(Vec<Decided>, Tally)> = if places.len() <= FEW {
            rows.map(|places| {
                let (y, offsets) = row(places);
                if unwanted() {
                    return Err(Halt::Stopped);
                }
                self.piece(y, offsets.as_deref().map(Vec::as_slice), places, known)
            })
            .collect::<Result<_, _>>()?
        } else {
            rows.collect::<Vec<_>>()
                .into_par_iter()
                .flat_map(|places| {
                    let (y, offsets) = row(places);
                    places
                        .par_chunks(PIECE)
                        .map(move |piece| (y, offsets.clone(), piece))
                })
                .map(|(y, offsets, piece)| {
                    first.unless_later(piece[0] as usize, || {
                        if unwanted() {
                            return Err(Halt::Stopped);
                        }
                        self.piece(y, offsets.as_deref().map(Vec::as_slice), piece, known)
                    })
                })
                .collect()
        };
        first.end()?;
        let mut tally = Tally::default();
        let mut all = Vec::with_capacity(places.len());
        for (piece, counted) in decided {
            all.extend(piece);
            tally = tally.merge(counted);
        }
        Ok((all, tally))
    }

    /// Decides pixels of row `y`, whose samples have these offsets.
    fn piece(
        &self,
        y: u32,
        offsets: Option<&[[f64; 2]]>,
        places: &[u32],
        known: &Partials,
    ) -> Result<(Vec<Decided>, Tally), Halt> {
        if (self.stop)() {
            return Err(Halt::Stopped);
        }
        let mut tally = Tally::default();
        let mut all = Vec::with_capacity(places.len());
        let mut before = Instant::now();
        for place in places {
            let x = place % self.width as u32;
            let sampling = self.jitter.pixel(offsets, self.width, x as usize);
            let (decided, samples) = self.decide(sampling, [x, y], known.get(*place))?;
            let after = Instant::now();
            tally.decided(decided.by, [x, y], samples, after - before);
            before = after;
            all.push(decided);
        }
        Ok((all, tally))
    }

    /// Traces a whole band; with `lanes`, many pixels at once as far as those are sure. Gives up where `unwanted` says
    /// that nobody wants this band any more.
    pub fn band(
        &self,
        rows: Range<u32>,
        lanes: Option<&Lanes>,
        unwanted: &StopRequested<'_>,
    ) -> Result<(Band, Tally), Halt> {
        let (width, top) = (self.width, rows.end - 1);
        let pixels = width * rows.len();
        let mut rgb = spare::take(3 * pixels);
        let mut values = vec![[0.0; 3]; if self.values { pixels } else { 0 }];
        let mut verdicts = vec![DecidedBy::Gpu; if self.verdicts { pixels } else { 0 }];
        // Rows are cut into pieces: small enough for all threads to get some, large enough that handing them out costs
        // nothing.
        let piece = (pixels / (8 * rayon::current_num_threads()))
            .clamp(64, 8192)
            .next_multiple_of(LANES)
            .min(width);
        let value_lines = lines(&mut values, width, rows.len());
        let verdict_lines = lines(&mut verdicts, width, rows.len());
        let first_halt = FirstHalt::default();
        let tally = rgb
            .par_chunks_mut(3 * width)
            .zip(value_lines)
            .zip(verdict_lines)
            .enumerate()
            .map(|(line, ((bytes, values), verdicts))| {
                let y = top - line as u32;
                let offsets = self.jitter.row(y);
                let count = width.div_ceil(piece);
                bytes
                    .par_chunks_mut(3 * piece)
                    .zip(lines(values, piece, count))
                    .zip(lines(verdicts, piece, count))
                    .enumerate()
                    .map(|(k, ((bytes, values), verdicts))| {
                        let strip = Strip {
                            first: k * piece,
                            y,
                            bytes,
                            values,
                            verdicts,
                        };
                        first_halt.unless_later(line * width + k * piece, || {
                            if unwanted() {
                                return Err(Halt::Stopped);
                            }
                            self.strip(strip, offsets.as_deref(), lanes)
                        })
                    })
                    .reduce(Tally::default, Tally::merge)
            })
            .reduce(Tally::default, Tally::merge);
        first_halt.end()?;
        let band = Band {
            rows,
            rgb,
            values: self.values.then_some(values),
            verdicts: self.verdicts.then_some(verdicts),
        };
        Ok((band, tally))
    }

    /// Decides up to `LANES` pixels of row `y` from column `x` on, as a band does, and forgets them: to see how long that
    /// takes.
    pub fn try_pixels(&self, [x, y]: [u32; 2], lanes: Option<&Lanes>) -> Result<Tally, Halt> {
        let mut bytes = [0; 3 * LANES];
        let strip = Strip {
            first: x as usize,
            y,
            bytes: &mut bytes[..3 * LANES.min(self.width - x as usize)],
            values: &mut [],
            verdicts: &mut [],
        };
        self.strip(strip, self.jitter.row(y).as_deref(), lanes)
    }

    /// Decides the pixels of a strip, whose row has these offsets.
    fn strip(
        &self,
        strip: Strip<'_>,
        offsets: Option<&[[f64; 2]]>,
        lanes: Option<&Lanes>,
    ) -> Result<Tally, Halt> {
        if (self.stop)() {
            return Err(Halt::Stopped);
        }
        let Strip {
            first,
            y,
            bytes,
            values,
            verdicts,
        } = strip;
        let mut tally = Tally::default();
        let mut quick = 0;
        // What the lanes are sure of, and which pixels they leave open.
        let mut words = vec![OPEN; bytes.len() / 3];
        let mut means = lanes.and_then(Lanes::means);
        let at_once = means.as_ref().map_or(words.len(), Means::at_once);
        for start in (0..words.len()).step_by(at_once) {
            let group = start..words.len().min(start + at_once);
            let at = [(first + start) as u32, y];
            match (lanes, &mut means) {
                (None, _) => {}
                (Some(lanes), None) => lanes.strip(at, &mut words[group.clone()]),
                (Some(lanes), Some(means)) => {
                    lanes.sampled(at, offsets, &mut words[group.clone()], means);
                }
            }
            for i in group {
                let x = first + i;
                let pixel = &mut bytes[3 * i..][..3];
                let mut by = DecidedBy::Single;
                if words[i] < OPEN {
                    let [red, green, blue, _] = words[i].to_le_bytes();
                    pixel.copy_from_slice(&[red, green, blue]);
                    quick += 1;
                } else {
                    let sampling = self.jitter.pixel(offsets, self.width, x);
                    let part = means.as_ref().and_then(|means| means.part(i - start));
                    let (decided, traced) = self.decide(sampling, [x as u32, y], part)?;
                    by = decided.by;
                    tally.decided(by, [x as u32, y], traced, Duration::ZERO);
                    pixel.copy_from_slice(&decided.bytes);
                    if let Some(value) = values.get_mut(i) {
                        *value = decided.value;
                    }
                }
                if let Some(verdict) = verdicts.get_mut(i) {
                    *verdict = by;
                }
            }
        }
        tally.add(DecidedBy::Single, quick);
        Ok(tally)
    }

    /// Decides a pixel, of which perhaps a part is known: then only the samples that are missing are traced, if that is
    /// enough. Tells how many were.
    fn decide(
        &self,
        sampling: Sampling<'_>,
        [x, y]: [u32; 2],
        part: Option<Part<'_>>,
    ) -> Result<(Decided, u32), Halt> {
        let exact_tracer = self.exact_tracer();
        let samples = sampling.samples();
        if let Some(part) = part
            && let Some(decided) = exact_tracer.complete(&self.limits, sampling, x, y, &part)?
        {
            return Ok((decided, samples - part.samples().min(samples)));
        }
        Ok((exact_tracer.trace(&self.limits, sampling, x, y)?, samples))
    }
}

/// Pixels side by side, to be decided: values and verdicts only where they are wanted.
struct Strip<'a> {
    /// Column of the first.
    first: usize,
    y: u32,
    bytes: &'a mut [u8],
    values: &'a mut [[f32; 3]],
    verdicts: &'a mut [DecidedBy],
}

/// Pieces of `size`, or as many empty ones.
fn lines<T>(all: &mut [T], size: usize, count: usize) -> Vec<&mut [T]> {
    if all.is_empty() {
        return (0..count).map(|_| Default::default()).collect();
    }
    all.chunks_mut(size).collect()
}

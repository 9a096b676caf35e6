//! Pixels decided on the CPU, on all cores: those that the GPU is not sure of, or whole bands.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use rayon::prelude::*;

use super::cascade::{Cascade, Decides, Effort, Open};
use super::first_halt::FirstHalt;
use super::{Decided, DecidedBy, Tally};
use crate::certify::lanes::mean::Means;
use crate::certify::lanes::{LANES, Lanes, OPEN};
use crate::cpu::pixel::ExactTracer;
use crate::frame::{Band, Halt, StopRequested, spare};
use crate::gpu::bands::Partials;
use crate::jitter::Jitter;
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
    cascade: Cascade<'a>,
    jitter: &'a Jitter,
    width: usize,
    /// Whether the values before quantising are wanted, to the last bit of f32.
    values: bool,
    /// Whether bands tell what decided each pixel.
    verdicts: bool,
    stop: &'a StopRequested<'a>,
}

impl<'a> PixelDecider<'a> {
    /// For the scene's picture as the settings ask for it, whose samples are spread by `jitter`.
    pub fn new(scene: &'a Scene, settings: &Settings, jitter: &'a Jitter) -> Self {
        Self {
            cascade: Cascade::new(scene, settings),
            jitter,
            width: scene.camera.pixeldim[0] as usize,
            values: settings.values,
            verdicts: settings.verdicts,
            stop: &|| false,
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
        Self {
            cascade: self.cascade.prepared(exact_tracer),
            ..self
        }
    }

    /// Prepares the scene, if that was not done yet.
    pub fn exact_tracer(&self) -> &ExactTracer<'a> {
        self.cascade.exact_tracer()
    }

    /// Decides the pixels at these places of a band (counted from its top left, in rising order) whose top row is
    /// `top`. Of those of which something is known only the samples that are missing are traced, if that is enough.
    /// Gives up where `unwanted` says that nobody wants them any more.
    pub fn pixels(
        &self,
        top: u32,
        places: &[u32],
        known: &Partials,
        decides: Decides,
        unwanted: &StopRequested<'_>,
    ) -> Result<(Vec<Decided>, Tally), Halt> {
        let width = self.width as u32;
        let piece = |offsets: Option<&[[f64; 2]]>, places: &[u32]| {
            self.piece(top, offsets, places, (known, decides))
        };
        // The offsets of a row's samples may have to be made for the whole row: once for all its pixels.
        let by_rows = matches!(self.jitter, Jitter::Course(_)) || !self.cascade.takes_many();
        let rows = places.chunk_by(|a, b| !by_rows || a / width == b / width);
        let row = |row: &[u32]| self.jitter.row(top - row[0] / width).map(Arc::new);
        let first = FirstHalt::default();
        let decided: Vec<(Vec<Decided>, Tally)> = if places.len() <= FEW {
            rows.map(|places| {
                let offsets = row(places);
                if unwanted() {
                    return Err(Halt::Stopped);
                }
                piece(offsets.as_deref().map(Vec::as_slice), places)
            })
            .collect::<Result<_, _>>()?
        } else {
            rows.collect::<Vec<_>>()
                .into_par_iter()
                .flat_map(|places| {
                    let offsets = row(places);
                    places
                        .par_chunks(PIECE)
                        .map(move |piece| (offsets.clone(), piece))
                })
                .map(|(offsets, places)| {
                    first.unless_later(places[0] as usize, || {
                        if unwanted() {
                            return Err(Halt::Stopped);
                        }
                        piece(offsets.as_deref().map(Vec::as_slice), places)
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

    /// Decides pixels of one row, whose samples have these offsets, or of any rows where they have none.
    fn piece(
        &self,
        top: u32,
        offsets: Option<&[[f64; 2]]>,
        places: &[u32],
        (known, decides): (&Partials, Decides),
    ) -> Result<(Vec<Decided>, Tally), Halt> {
        if (self.stop)() {
            return Err(Halt::Stopped);
        }
        let width = self.width as u32;
        let open = |place: &u32| {
            let at = [place % width, top - place / width];
            Open {
                at,
                sampling: self.jitter.pixel(offsets, self.width, at[0] as usize),
                part: known.get(*place),
            }
        };
        let open: Vec<_> = places.iter().map(open).collect();
        let mut tally = Tally::default();
        let mut all = vec![None; places.len()];
        self.cascade
            .decide(&open, decides, &mut |i, decided, effort| {
                tally.decided(decided.by, open[i].at, effort.samples, effort.took);
                all[i] = Some(decided);
            })?;
        Ok((all.into_iter().flatten().collect(), tally))
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

    /// Decides up to `LANES` pixels of row `y` from column `x` on, as a band does, and forgets them: to see how long
    /// that takes.
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
        mut strip: Strip<'_>,
        offsets: Option<&[[f64; 2]]>,
        lanes: Option<&Lanes>,
    ) -> Result<Tally, Halt> {
        if (self.stop)() {
            return Err(Halt::Stopped);
        }
        let (first, y) = (strip.first, strip.y);
        let mut tally = Tally::default();
        let mut quick = 0;
        // What the lanes are sure of, and which pixels they leave open.
        let mut words = vec![OPEN; strip.bytes.len() / 3];
        let mut means = lanes.and_then(Lanes::means);
        let at_once = means.as_ref().map_or(words.len(), Means::at_once);
        let (mut left, mut parts) = (Vec::new(), Partials::default());
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
                if words[i] < OPEN {
                    let [red, green, blue, _] = words[i].to_le_bytes();
                    strip.bytes[3 * i..][..3].copy_from_slice(&[red, green, blue]);
                    quick += 1;
                    if let Some(verdict) = strip.verdicts.get_mut(i) {
                        *verdict = DecidedBy::Single;
                    }
                    continue;
                }
                left.push(i);
                if let Some(part) = means.as_ref().and_then(|means| means.part(i - start)) {
                    parts.push(i as u32, &part);
                }
            }
            if parts.words() > MOST_WORDS {
                self.left((&left, &parts), &mut strip, offsets, &mut tally)?;
                (left, parts) = (Vec::new(), Partials::default());
            }
        }
        self.left((&left, &parts), &mut strip, offsets, &mut tally)?;
        tally.add(DecidedBy::Single, quick);
        Ok(tally)
    }

    /// Decides the pixels of a strip that lanes leave open, by their places, and what is known of them.
    fn left(
        &self,
        (left, parts): (&[usize], &Partials),
        strip: &mut Strip<'_>,
        offsets: Option<&[[f64; 2]]>,
        tally: &mut Tally,
    ) -> Result<(), Halt> {
        let open = |&i: &usize| Open {
            at: [(strip.first + i) as u32, strip.y],
            sampling: self.jitter.pixel(offsets, self.width, strip.first + i),
            part: parts.get(i as u32),
        };
        let open: Vec<_> = left.iter().map(open).collect();
        let mut take = |k: usize, decided: Decided, effort: Effort| {
            let i = left[k];
            tally.decided(decided.by, open[k].at, effort.samples, Duration::ZERO);
            strip.bytes[3 * i..][..3].copy_from_slice(&decided.bytes);
            if let Some(value) = strip.values.get_mut(i) {
                *value = decided.value;
            }
            if let Some(verdict) = strip.verdicts.get_mut(i) {
                *verdict = decided.by;
            }
        };
        self.cascade.decide(&open, Decides::Any, &mut take)
    }
}

/// With so many words of what is known of them pixels that lanes leave open are decided, whether there are more to come
/// or not.
const MOST_WORDS: usize = 1 << 14;

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

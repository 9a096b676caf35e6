//! What becomes of a band that a device rendered, while it renders the next ones: its doubtful pixels are decided on
//! the CPU, and some of its sure ones are computed again.

use std::time::Instant;

use super::Settings;
use super::bag::Finished;
use super::report::Beside;
use crate::certify::cascade::Decides;
use crate::certify::pixels::PixelDecider;
use crate::certify::spot::spots;
use crate::certify::{DecidedBy, Tally};
use crate::frame::{Band, Halt, StopRequested};
use crate::gpu::bands::{Partials, Rendered};

/// Of so many pixels that a device decided in f64 one is computed again.
const DOUBLED_A_CHECK: usize = 64;

/// Takes bands from a device, one after the other.
pub(super) struct Finish<'a, 's> {
    decider: &'a PixelDecider<'s>,
    /// Whether sure pixels are checked.
    certified: bool,
    verdicts: bool,
}

/// Why a band is not finished.
#[derive(Debug)]
pub(super) enum Unfinished {
    /// A pixel cannot be decided, or nobody wants it.
    Halt(Halt),
    /// A pixel that the GPU was sure of is wrong.
    Wrong(Wrong),
}

impl From<Halt> for Unfinished {
    fn from(halt: Halt) -> Self {
        Self::Halt(halt)
    }
}

/// A pixel that the GPU was sure of, and got wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Wrong {
    /// Column, and row from the bottom.
    at: [u32; 2],
    /// What the GPU had.
    gpu: [u8; 3],
    /// What the CPU has.
    cpu: [u8; 3],
}

impl Wrong {
    /// The fault of this adapter, in words.
    pub(super) fn of(&self, adapter: &str) -> String {
        let Self {
            at: [x, y],
            gpu,
            cpu,
        } = self;
        format!(
            "{adapter} was sure that pixel ({x}, {y}) has the bytes {gpu:?}, and they are {cpu:?}"
        )
    }
}

impl<'a, 's> Finish<'a, 's> {
    pub(super) fn new(decider: &'a PixelDecider<'s>, settings: &Settings) -> Self {
        Self {
            decider,
            certified: settings.has_gpu_bounds(),
            verdicts: settings.verdicts,
        }
    }

    /// Finishes a band of the worker `me`, unless `unwanted` says that nobody wants it any more.
    pub(super) fn band(
        &mut self,
        me: usize,
        mut rendered: Rendered,
        beside: &mut Beside,
        unwanted: &StopRequested<'_>,
    ) -> Result<Finished, Unfinished> {
        let start = Instant::now();
        let doubled = std::mem::take(&mut rendered.doubled);
        let (mut band, tally, alone) = self.refine(rendered, &doubled, unwanted)?;
        beside.refine += start.elapsed().as_secs_f64();
        if !self.certified {
            return Ok(Finished::new(me, band, tally));
        }
        let start = Instant::now();
        let checked = self.check(&mut band, &alone, &doubled, unwanted)?;
        beside.spot_checks += start.elapsed().as_secs_f64();
        Ok(Finished::new(me, band, tally).checked(checked))
    }

    /// Decides the doubtful pixels. Returns the places of those of them of which the GPU has no part.
    fn refine(
        &self,
        rendered: Rendered,
        doubled: &[u32],
        unwanted: &StopRequested<'_>,
    ) -> Result<(Band, Tally, Vec<u32>), Halt> {
        let Rendered {
            mut band,
            doubtful,
            partials,
            ..
        } = rendered;
        let pixels = band.rgb.len() / 3;
        let (decided, mut tally) = self.decider.pixels(
            band.rows.end - 1,
            &doubtful,
            &partials,
            Decides::Any,
            unwanted,
        )?;
        if self.verdicts {
            band.verdicts = Some(vec![DecidedBy::Gpu; pixels]);
        }
        if let Some(verdicts) = &mut band.verdicts {
            for place in doubled {
                verdicts[*place as usize] = DecidedBy::Double;
            }
        }
        tally.add(DecidedBy::Double, doubled.len() as u64);
        let mut alone = Vec::new();
        for (place, decided) in doubtful.iter().zip(decided) {
            *three(&mut band, *place) = decided.bytes;
            if let Some(values) = &mut band.values {
                values[*place as usize] = decided.value;
            }
            if let Some(verdicts) = &mut band.verdicts {
                verdicts[*place as usize] = decided.by;
            }
            if partials.get(*place).is_none() || decided.by == DecidedBy::Presumed {
                alone.push(*place);
            }
        }
        let others = doubtful.len() + doubled.len();
        tally.add(DecidedBy::Gpu, (pixels - others) as u64);
        Ok((band, tally, alone))
    }

    /// Computes some pixels that the GPU has a part in again, and returns how many; those that the CPU decided alone
    /// are not worth a check.
    fn check(
        &self,
        band: &mut Band,
        alone: &[u32],
        doubled: &[u32],
        unwanted: &StopRequested<'_>,
    ) -> Result<u64, Unfinished> {
        let top = band.rows.end - 1;
        let width = (band.rgb.len() / 3 / band.rows.len()) as u32;
        let mut places = spots(width, &band.rows, &band.rgb, alone);
        // Of what f64 decided more is looked at: it is little, and hard.
        places.extend(doubled.iter().step_by(DOUBLED_A_CHECK));
        places.sort_unstable();
        places.dedup();
        let (decided, _) = self.decider.pixels(
            top,
            &places,
            &Partials::default(),
            Decides::Referee,
            unwanted,
        )?;
        for (place, decided) in places.iter().zip(decided) {
            let gpu = *three(band, *place);
            if gpu != decided.bytes {
                return Err(Unfinished::Wrong(Wrong {
                    at: [place % width, top - place / width],
                    gpu,
                    cpu: decided.bytes,
                }));
            }
        }
        Ok(places.len() as u64)
    }
}

/// The bytes of the pixel at a place of a band.
fn three(band: &mut Band, place: u32) -> &mut [u8; 3] {
    &mut band.rgb.as_chunks_mut::<3>().0[place as usize]
}

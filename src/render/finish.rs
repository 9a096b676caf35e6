//! What becomes of a band that the GPU rendered, while the next ones are rendered: its doubtful pixels are decided on
//! the CPU, some of its sure ones are computed again, and it is handed on.

use std::hash::{DefaultHasher, Hasher as _};
use std::time::Instant;

use super::report::{Beside, Done};
use super::{Backend, Emit, Error, Settings};
use crate::certify::pixels::PixelDecider;
use crate::certify::spot::spots;
use crate::certify::{DecidedBy, Tally};
use crate::frame::Band;
use crate::gpu::bands::{Partials, Rendered};

/// Takes bands from the GPU, one after the other.
pub(super) struct Finish<'a, 's, 'e> {
    decider: &'a PixelDecider<'s>,
    emit: &'a mut Emit<'e>,
    /// Whether sure pixels are checked.
    certified: bool,
    verdicts: bool,
    /// What decided the pixels handed on.
    tally: Tally,
    /// Sure pixels that were computed again, and were right.
    spot_checks: u64,
    /// Number of bands handed on.
    bands: u32,
    /// What that took.
    beside: Beside,
    /// What was handed on so far.
    digest: Digest,
}

/// Why no more bands are taken.
#[derive(Debug)]
pub(super) enum FinishError {
    /// As any rendering may fail.
    Error(Error),
    /// A pixel that the GPU was sure of is wrong.
    Wrong(Wrong),
}

impl<E: Into<Error>> From<E> for FinishError {
    fn from(error: E) -> Self {
        Self::Error(error.into())
    }
}

/// A pixel that the GPU was sure of, and got wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Wrong {
    /// Column, and row from the bottom.
    pub(super) at: [u32; 2],
    /// What the GPU had.
    pub(super) gpu: [u8; 3],
    /// What the CPU has.
    pub(super) cpu: [u8; 3],
}

/// A hash of the rows handed on, from the top row down, and how far down they reach.
#[derive(Debug, Clone, Default)]
pub(super) struct Digest {
    hasher: DefaultHasher,
    /// The lowest row handed on, from the bottom; none before the first.
    pub(super) down_to: Option<u32>,
}

impl Digest {
    /// Adds a band. Row by row, so that the height of bands does not matter.
    pub(super) fn add(&mut self, band: &Band) {
        for row in band.rgb.chunks(band.rgb.len() / band.rows.len().max(1)) {
            self.hasher.write(row);
        }
        self.down_to = Some(band.rows.start);
    }

    /// Whether both saw the same rows.
    pub(super) fn agrees(&self, other: &Self) -> bool {
        self.down_to == other.down_to && self.hasher.finish() == other.hasher.finish()
    }
}

impl<'a, 's, 'e> Finish<'a, 's, 'e> {
    pub(super) fn new(
        decider: &'a PixelDecider<'s>,
        emit: &'a mut Emit<'e>,
        settings: &Settings,
    ) -> Self {
        Self {
            decider,
            emit,
            certified: settings.has_gpu_bounds(),
            verdicts: settings.verdicts,
            tally: Tally::default(),
            spot_checks: 0,
            bands: 0,
            beside: Beside::default(),
            digest: Digest::default(),
        }
    }

    /// What came of it, and what was handed on.
    pub(super) fn end(self) -> (Done, Digest) {
        let done = Done {
            backend: Backend::Gpu,
            spot_checks: self.spot_checks,
            beside: self.beside,
            ..Done::on_cpu(self.tally, self.bands)
        };
        (done, self.digest)
    }

    /// Finishes a band and hands it on; not before its sure pixels were checked.
    pub(super) fn band(&mut self, rendered: Rendered) -> Result<(), FinishError> {
        let start = Instant::now();
        let (mut band, alone) = self.refine(rendered)?;
        self.beside.refine += start.elapsed().as_secs_f64();
        if self.certified {
            let start = Instant::now();
            self.check(&mut band, &alone)?;
            self.beside.spot_checks += start.elapsed().as_secs_f64();
        }
        let start = Instant::now();
        (self.emit)(&band)?;
        if self.certified {
            self.digest.add(&band);
        }
        self.beside.emit += start.elapsed().as_secs_f64();
        self.bands += 1;
        Ok(())
    }

    /// Decides the doubtful pixels. Returns the places of those of them of which the GPU has no part.
    fn refine(&mut self, rendered: Rendered) -> Result<(Band, Vec<u32>), FinishError> {
        let Rendered {
            mut band,
            doubtful,
            partials,
        } = rendered;
        let pixels = band.rgb.len() / 3;
        let (decided, tally) = self
            .decider
            .pixels(band.rows.end - 1, &doubtful, &partials)?;
        if self.verdicts {
            band.verdicts = Some(vec![DecidedBy::Gpu; pixels]);
        }
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
        self.tally = std::mem::take(&mut self.tally).merge(tally);
        self.tally
            .add(DecidedBy::Gpu, (pixels - doubtful.len()) as u64);
        Ok((band, alone))
    }

    /// Computes some pixels that the GPU has a part in again; those that the CPU decided alone are not worth a check.
    fn check(&mut self, band: &mut Band, alone: &[u32]) -> Result<(), FinishError> {
        let top = band.rows.end - 1;
        let width = (band.rgb.len() / 3 / band.rows.len()) as u32;
        let places = spots(width, &band.rows, &band.rgb, alone);
        let (decided, _) = self.decider.pixels(top, &places, &Partials::default())?;
        for (place, decided) in places.iter().zip(decided) {
            let gpu = *three(band, *place);
            if gpu != decided.bytes {
                return Err(FinishError::Wrong(Wrong {
                    at: [place % width, top - place / width],
                    gpu,
                    cpu: decided.bytes,
                }));
            }
        }
        self.spot_checks += places.len() as u64;
        Ok(())
    }
}

/// The bytes of the pixel at a place of a band.
fn three(band: &mut Band, place: u32) -> &mut [u8; 3] {
    &mut band.rgb.as_chunks_mut::<3>().0[place as usize]
}

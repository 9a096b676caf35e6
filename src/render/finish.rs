//! What becomes of a band that the GPU rendered, while the next ones are rendered: its doubtful pixels are decided on the
//! CPU, some of its sure ones are computed again, and it is handed on.

use std::hash::{DefaultHasher, Hasher as _};
use std::time::Instant;

use super::{Emit, Error};
use crate::certify::pixels::Tracer;
use crate::certify::spot::spots;
use crate::certify::{Stage, Tally};
use crate::frame::Band;
use crate::gpu::bands::{Partials, Rendered};

/// Takes bands from the GPU, one after the other.
pub(super) struct Finish<'a, 's, 'e> {
    tracer: &'a Tracer<'s>,
    emit: &'a mut Emit<'e>,
    /// Whether sure pixels are checked.
    certified: bool,
    verdicts: bool,
    /// What decided the pixels handed on.
    pub(super) tally: Tally,
    /// Sure pixels that were computed again, and were right.
    pub(super) spot_checks: u64,
    /// Number of bands handed on.
    pub(super) bands: u32,
    /// Seconds for doubtful pixels, for spot checks, and in `emit`.
    pub(super) seconds: [f64; 3],
    /// What was handed on so far.
    pub(super) digest: Digest,
}

/// Why no more bands are taken.
#[derive(Debug)]
pub(super) enum Stop {
    /// As any rendering may fail.
    Error(Error),
    /// A pixel that the GPU was sure of is wrong.
    Wrong(Wrong),
}

impl<E: Into<Error>> From<E> for Stop {
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
        tracer: &'a Tracer<'s>,
        emit: &'a mut Emit<'e>,
        certified: bool,
        verdicts: bool,
    ) -> Self {
        Self {
            tracer,
            emit,
            certified,
            verdicts,
            tally: Tally::default(),
            spot_checks: 0,
            bands: 0,
            seconds: [0.0; 3],
            digest: Digest::default(),
        }
    }

    /// Finishes a band and hands it on; not before its sure pixels were checked.
    pub(super) fn band(&mut self, rendered: Rendered) -> Result<(), Stop> {
        let Rendered {
            mut band,
            doubtful,
            partials,
        } = rendered;
        let pixels = band.rgb.len() / 3;
        let top = band.rows.end - 1;
        let start = Instant::now();
        let (decided, tally) = self.tracer.pixels(top, &doubtful, &partials)?;
        if self.verdicts {
            band.verdicts = Some(vec![Stage::Gpu; pixels]);
        }
        // Those that owe nothing to the GPU; of the others its samples are worth a check.
        let mut alone = Vec::new();
        for (place, decided) in doubtful.iter().zip(decided) {
            *three(&mut band, *place) = decided.bytes;
            if let Some(values) = &mut band.values {
                values[*place as usize] = decided.value;
            }
            if let Some(verdicts) = &mut band.verdicts {
                verdicts[*place as usize] = decided.stage;
            }
            if partials.get(*place).is_none() || decided.stage == Stage::Presumed {
                alone.push(*place);
            }
        }
        let counted = std::mem::take(&mut self.tally).merge(tally);
        self.tally = counted;
        self.tally.add(Stage::Gpu, (pixels - doubtful.len()) as u64);
        self.seconds[0] += start.elapsed().as_secs_f64();
        if self.certified {
            let start = Instant::now();
            let width = (pixels / band.rows.len()) as u32;
            let places = spots(width, &band.rows, &alone);
            let (decided, _) = self.tracer.pixels(top, &places, &Partials::default())?;
            for (place, decided) in places.iter().zip(decided) {
                let gpu = three(&mut band, *place);
                if *gpu != decided.bytes {
                    return Err(Stop::Wrong(Wrong {
                        at: [place % width, top - place / width],
                        gpu: *gpu,
                        cpu: decided.bytes,
                    }));
                }
            }
            self.spot_checks += places.len() as u64;
            self.seconds[1] += start.elapsed().as_secs_f64();
        }
        let start = Instant::now();
        (self.emit)(&band)?;
        self.seconds[2] += start.elapsed().as_secs_f64();
        if self.certified {
            self.digest.add(&band);
        }
        self.bands += 1;
        Ok(())
    }
}

/// The bytes of the pixel at a place of a band.
fn three(band: &mut Band, place: u32) -> &mut [u8; 3] {
    &mut band.rgb.as_chunks_mut::<3>().0[place as usize]
}

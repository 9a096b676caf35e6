//! Who takes rows from the bag, and what they bring back.

use std::hash::{DefaultHasher, Hasher as _};
use std::time::{Duration, Instant};

use crate::certify::Tally;
use crate::frame::Band;

/// What a worker is here for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It takes bands.
    Works,
    /// It takes bands when all who work have left.
    StandsBy,
    /// It is tried against those who work: it uses the same cores, so only one of them is worth its bands.
    OnTrial,
}

/// What a worker did.
#[derive(Debug, Clone, Default)]
pub(crate) struct Activity {
    /// Bands of it that went out, or that showed others to be right.
    pub(crate) bands: u32,
    /// What decided their pixels.
    pub(crate) tally: Tally,
    /// Sure pixels of them that were computed again, and were right.
    pub(crate) spot_checks: u64,
    /// How long it waited for rows.
    pub(crate) waited: Duration,
    /// Pixels a second, lately; none before its first band.
    pub(crate) speed: Option<f64>,
    /// Whether it was tried, and others were quicker.
    pub(crate) outrun: bool,
}

/// What a worker is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The CPU, whose cores also decide what devices leave open: that comes first.
    Cpu,
    /// A device.
    Device,
}

/// A worker as the bag knows it.
#[derive(Debug)]
pub(super) struct Worker {
    pub(super) kind: Kind,
    pub(super) role: Role,
    /// Whether it could take rows now, as far as it itself is concerned.
    pub(super) ready: bool,
    pub(super) left: bool,
    pub(super) activity: Activity,
    pub(super) last_delivery: Option<Instant>,
}

impl Worker {
    pub(super) fn new(kind: Kind, role: Role) -> Self {
        Self {
            kind,
            role,
            ready: false,
            left: false,
            activity: Activity::default(),
            last_delivery: None,
        }
    }
}

/// A band that was brought back.
#[derive(Debug)]
pub(crate) struct Finished {
    pub(super) worker: usize,
    pub(super) band: Band,
    pub(super) tally: Tally,
    pub(crate) spot_checks: u64,
    /// A hash of its bytes, where the worker may be found to be wrong later.
    pub(super) hash: Option<u64>,
}

impl Finished {
    pub(crate) fn new(worker: usize, band: Band, tally: Tally) -> Self {
        Self {
            worker,
            band,
            tally,
            spot_checks: 0,
            hash: None,
        }
    }

    /// The same from a worker that computed so many of its pixels once more, and may still be found to be wrong.
    pub(crate) fn checked(self, spot_checks: u64) -> Self {
        let hash = Some(hash(&self.band));
        Self {
            spot_checks,
            hash,
            ..self
        }
    }
}

/// A hash of a band's bytes.
pub(super) fn hash(band: &Band) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(&band.rgb);
    hasher.finish()
}

//! Why the tracers of this folder have no colour for a ray.

use crate::real::Undecided;

/// Why a ray's colour is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The number type is too coarse.
    Undecided,
    /// The sample needs more rays than allowed.
    TooManyRays,
}

impl From<Undecided> for Fault {
    fn from(_: Undecided) -> Self {
        Self::Undecided
    }
}

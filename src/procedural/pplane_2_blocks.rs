//! pplane shader 2: blocks of half a unit, by turns shader 1's colours and the material's ambient.

use super::PlanePoint;
use super::pplane_1_angle::pplane_1_angle;
use crate::real::{Real, Undecided, V3};

/// Shader 1 where i + j + k is even, the ambient colour where it is odd.
pub(super) fn pplane_2_blocks<R: Real>(at: &impl PlanePoint<R>) -> Result<V3<R>, Undecided> {
    if (at.odd(0)? + at.odd(1)? + at.odd(2)?) % 2 == 0 {
        pplane_1_angle(at)
    } else {
        Ok(at.ambient())
    }
}

/// The brightest channel that it gives.
pub(super) fn brightest(ambient: f64) -> f64 {
    ambient.max(super::pplane_1_angle::brightest(ambient))
}

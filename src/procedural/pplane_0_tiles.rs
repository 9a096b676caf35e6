//! pplane shader 0: tiles of half a unit; the ambient colour without red, or without blue.

use super::PlanePoint;
use crate::real::{Real, Undecided, V3};

/// r = 0 where i + j is odd, else b = 0.
pub(super) fn pplane_0_tiles<R: Real>(at: &impl PlanePoint<R>) -> Result<V3<R>, Undecided> {
    let ambient = at.ambient();
    let odd = at.odd(0)? != at.odd(2)?;
    Ok(if odd {
        V3::new(R::zero(), ambient.y, ambient.z)
    } else {
        V3::new(ambient.x, ambient.y, R::zero())
    })
}

/// The brightest channel that it gives.
pub(super) fn brightest(ambient: f64) -> f64 {
    ambient
}

//! pplane shader 1: colours around the plane's point, by the angle.

use super::{PlanePoint, color_wheel};
use crate::real::{Real, Undecided, V3};

/// 6·(1 + cos(2θ + φ)) for each channel.
pub(super) fn pplane_1_angle<R: Real>(at: &impl PlanePoint<R>) -> Result<V3<R>, Undecided> {
    let [x, y] = at.offset_from_point();
    Ok(color_wheel(x, y)? * R::exact(6.0))
}

/// The brightest channel that it gives.
pub(super) fn brightest(_ambient: f64) -> f64 {
    12.0
}

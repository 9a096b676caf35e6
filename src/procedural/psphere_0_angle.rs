//! psphere shader 0: colours around the sphere's axis, by the angle.

use super::{SpherePoint, color_wheel};
use crate::real::{Real, Undecided, V3};

/// 1 + cos(2t + φ) with t = 2π − acos(c.x/√(c.x² + c.y²)), the angle of (c.x, −|c.y|).
pub(super) fn psphere_0_angle<R: Real>(at: &SpherePoint<R>) -> Result<V3<R>, Undecided> {
    color_wheel(at.from_center.x, -at.from_center.y.abs()?)
}

/// The brightest channel that it gives.
pub(super) fn brightest(_ambient: f64) -> f64 {
    2.0
}

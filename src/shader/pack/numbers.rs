//! Numbers as records have them.

use crate::real::V3;
use crate::shader::format::Known;

/// A factor of a colour: one that is not 0 stays so in f32, so that the check of its size sees it. One that is not
/// known stays so too.
pub(super) fn factor(value: f64) -> f64 {
    if value.is_nan() {
        value
    } else if value > 0.0 {
        value.max(f32::MIN_POSITIVE.into())
    } else {
        0.0
    }
}

pub(super) fn factors(v: V3<impl Known>) -> [f64; 3] {
    nearest(v).map(factor)
}

pub(super) fn nearest(v: V3<impl Known>) -> [f64; 3] {
    [v.x, v.y, v.z].map(Known::nearest)
}

/// The larger one; no number where one of them is none.
pub(super) fn larger([a, b]: [f64; 2]) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

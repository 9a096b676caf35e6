//! The colours around a point that several shaders share.

use std::cmp::Ordering;

use crate::real::{Real, Undecided, V3};

/// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)) with θ the angle of (x, y) from +x; θ = 0 at the origin.
///
/// By 1 + cos 2α = 2·cos²α: no acos, no cos, and never less than 0.
pub(super) fn color_wheel<R: Real>(x: R, y: R) -> Result<V3<R>, Undecided> {
    // The larger component becomes 1, so that squares neither overflow nor vanish. Any component that is not 0 would
    // do, since it is divided out again, with its sign.
    let (larger, smaller) = if x.to_f64().abs() >= y.to_f64().abs() {
        (x, y)
    } else {
        (y, x)
    };
    let larger = if larger.sign()? == Ordering::Equal {
        smaller
    } else {
        larger
    };
    if larger.sign()? == Ordering::Equal {
        return Ok(V3::new(R::exact(2.0), R::exact(0.5), R::exact(0.5)));
    }
    let half = R::exact(0.5);
    let half_root_3 = R::exact(0.75).sqrt();
    let (x, y) = (x / larger, y / larger);
    let green = half * x - half_root_3 * y;
    let blue = half * x + half_root_3 * y;
    let scale = R::exact(2.0) / (x * x + y * y);
    Ok(V3::new(
        x * x * scale,
        green * green * scale,
        blue * blue * scale,
    ))
}

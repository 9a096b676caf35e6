//! Twin of `shaders/plane.wgsl`.

use super::camera::Ray;
use crate::prepare::Plane;
use crate::real::{Real, Undecided};

/// 1/s of the hit on the plane, or None for a miss.
pub fn plane_hits<R: Real>(plane: &Plane<R>, ray: &Ray<R>) -> Result<Option<R>, Undecided> {
    if let Some(front) = &plane.front {
        let [x, y] = ray.pixel;
        let side = front[0] * R::exact(x) + front[1] * R::exact(y) + front[2];
        if !side.non_negative()? {
            return Ok(None);
        }
    }
    let inverse = plane.inverse[0] * ray.w.x + plane.inverse[1] * ray.w.y + plane.inverse[2];
    Ok(inverse.positive()?.then_some(inverse))
}

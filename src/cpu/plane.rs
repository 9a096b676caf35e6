//! Where rays meet a plane, and whether that is within its sides. Referee of `shaders/plane.wgsl`.

use std::cmp::Ordering;

use super::camera::Ray;
use crate::prepare::boxes::SLACK;
use crate::prepare::extent::Extent;
use crate::prepare::plane::Sides;
use crate::prepare::{Plane, WorldPlane};
use crate::real::{Bounded, Real, Undecided, V3};

/// 1/s of the hit on the plane, or None for a miss, and where that is surely below `least`.
#[inline]
pub fn plane_hits<R: Real>(
    plane: &Plane<R>,
    ray: &Ray<R>,
    least: f64,
) -> Result<Option<R>, Undecided> {
    if let Some(front) = &plane.front {
        let [x, y] = ray.pixel;
        let side = front[0].times(x) + front[1].times(y) + front[2];
        if !side.non_negative()? {
            return Ok(None);
        }
    }
    let along = |form: &[R; 3]| form[0] * ray.w.x + form[1] * ray.w.y + form[2];
    let inverse = along(&plane.inverse);
    if !inverse.positive()? {
        return Ok(None);
    }
    if inverse.quick_enclosure().most() < least {
        return Ok(None);
    }
    match &plane.sides {
        Sides::Unbounded => {}
        Sides::Triangle(sides) => {
            for side in sides.iter() {
                if !along(&side.form).non_negative()? {
                    return Ok(None);
                }
            }
        }
        Sides::Rectangle(strips) => {
            for strip in strips.iter() {
                // 0 ≤ p ≤ length, all times 1/s.
                let p = along(&strip.form);
                if !p.non_negative()? || !(strip.length * inverse - p).non_negative()? {
                    return Ok(None);
                }
            }
        }
    }
    Ok(Some(inverse))
}

/// t of the hit on the plane for a ray from anywhere, and its position; None for a miss, and where that is surely
/// farther than `reach`. `highest` is the rule H.z ≤ τ.
pub fn plane_hits_from<R: Real>(
    plane: &WorldPlane<R>,
    base: V3<R>,
    dir: V3<R>,
    highest: R,
    reach: f64,
) -> Result<Option<(R, V3<R>)>, Undecided> {
    let across = plane.direction.dot(dir);
    let facing = across.sign()?;
    if facing == Ordering::Equal {
        return Ok(None);
    }
    let away = plane.constant - plane.direction.dot(base);
    // t is their quotient, and > 0 where they have the same sign.
    if away.sign()? != facing {
        return Ok(None);
    }
    let (least, most) = (away.quick_enclosure(), across.quick_enclosure());
    let least = least.value.abs() - least.error * Bounded::GROW;
    let most = most.value.abs() + most.error * Bounded::GROW;
    if least > reach * most * SLACK {
        return Ok(None);
    }
    let t = away / across;
    let position = on_plane(plane, base + dir * t);
    if !(highest - position.z).non_negative()? {
        return Ok(None);
    }
    match &plane.extent {
        Extent::Unbounded => {}
        Extent::Triangle(sides) => {
            for side in sides.iter() {
                if !(side.row.dot(position) - side.origin).non_negative()? {
                    return Ok(None);
                }
            }
        }
        Extent::Rectangle(rectangle) => {
            if !rectangle.holds(position)? {
                return Ok(None);
            }
        }
    }
    Ok(Some((t, position)))
}

/// A hit point with the coordinate that all points of the plane share, if there is one, set to exactly that.
pub fn on_plane<R: Real>(plane: &WorldPlane<R>, position: V3<R>) -> V3<R> {
    plane
        .fixed_coordinate
        .map_or(position, |(axis, coordinate)| {
            position.with_axis(axis, coordinate)
        })
}

//! Where rays meet a quadric: by the quadratic of the notes, over the inverse of the distance. Referee of
//! `shaders/quadric.wgsl`.
//!
//! Along a ray the left side is a t² + b t + c. With s = 1/t that is c s² + b s + a = 0, and the nearest hit has the
//! largest s > 0; c is the left side at the ray's start, whose sign is certain nearly always.

use std::cmp::Ordering;

use super::camera::Ray;
use crate::prepare::Quadric;
use crate::real::{Real, Undecided, V3};

/// 1/s of the nearest hit on the quadric, or None for a miss.
pub fn quadric_hits<R: Real>(quadric: &Quadric<R>, ray: &Ray<R>) -> Result<Option<R>, Undecided> {
    let line = Line {
        square: quadric
            .square
            .as_ref()
            .map(|square| Quadric::squared(square, ray.w).0),
        slope: quadric.slope.dot(ray.w),
        constant: quadric.constant,
        side: quadric.side,
    };
    for inverse in line.inverses()?.into_iter().flatten() {
        // H within its borders, times 1/s.
        let inside = |axis: usize, border: R| ray.w.axis(axis) - border * inverse;
        if inverse.positive()? && within(quadric, inside)? {
            return Ok(Some(inverse));
        }
    }
    Ok(None)
}

/// What a ray from anywhere has to do with a quadric before they meet.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    /// Whether the ray starts on the surface, for certain.
    pub on_surface: bool,
    /// Whether the ray's light lies on it.
    pub light_on_surface: bool,
}

/// t of a hit, and its position.
pub type Met<R> = (R, V3<R>);

/// t of all hits on the quadric for a ray from anywhere, of unit direction, nearest first, with their positions.
/// `distance` is that of a shadow ray's light; hits are then told of only before it if it lies on the surface.
pub fn quadric_hits_from<R: Real>(
    quadric: &Quadric<R>,
    base: V3<R>,
    dir: V3<R>,
    start: Start,
    distance: Option<R>,
) -> Result<[Option<Met<R>>; 2], Undecided> {
    let mut line = Line {
        square: None,
        slope: quadric.slope.dot(dir),
        constant: quadric.constant + quadric.slope.dot(base),
        side: Ordering::Equal,
    };
    if let Some(square) = &quadric.square {
        let (at_base, gradient) = Quadric::squared(square, base);
        line.square = Some(Quadric::squared(square, dir).0);
        line.slope = line.slope + gradient.dot(dir).times(2.0);
        line.constant = line.constant + at_base;
    }
    if !start.on_surface {
        line.side = line.constant.sign()?;
    }
    let inverses = match distance.filter(|_| start.light_on_surface) {
        None => line.inverses()?,
        Some(distance) => line.inverse_before(distance)?,
    };
    let mut hits = [None, None];
    for (hit, inverse) in hits.iter_mut().zip(inverses) {
        let Some(inverse) = inverse else { continue };
        if !inverse.positive()? {
            continue;
        }
        let t = R::exact(1.0) / inverse;
        let position = base + dir * t;
        if within(quadric, |axis, border| position.axis(axis) - border)? {
            *hit = Some((t, position));
        }
    }
    Ok(hits)
}

/// Whether a hit is within all borders; `beyond` tells how far it is beyond one along an axis, up to a positive factor.
fn within<R: Real>(
    quadric: &Quadric<R>,
    beyond: impl Fn(usize, R) -> R,
) -> Result<bool, Undecided> {
    for (axis, [least, greatest]) in quadric.borders.iter().enumerate() {
        if let Some(least) = least
            && !beyond(axis, *least).non_negative()?
        {
            return Ok(false);
        }
        if let Some(greatest) = greatest
            && !(-beyond(axis, *greatest)).non_negative()?
        {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The left side along a ray: square·t² + slope·t + constant.
struct Line<R> {
    /// None on a plane.
    square: Option<R>,
    slope: R,
    constant: R,
    /// The sign of the constant.
    side: Ordering,
}

impl<R: Real> Line<R> {
    /// 1/t of where the left side is 0, the larger first; those that are not > 0 are no hits. A double root is none.
    fn inverses(&self) -> Result<[Option<R>; 2], Undecided> {
        // t = 0 is a root where the ray starts on the surface, and the only one on a plane.
        let (a, b, c) = match (&self.square, self.side) {
            (None, Ordering::Equal) => return Ok([None; 2]),
            (None, _) => return Ok([Some(-self.slope / self.constant), None]),
            (Some(square), Ordering::Equal) => {
                if self.slope.sign()? == Ordering::Equal {
                    return Ok([None; 2]);
                }
                return Ok([Some(-*square / self.slope), None]);
            }
            (Some(square), Ordering::Greater) => (*square, self.slope, self.constant),
            (Some(square), Ordering::Less) => (-*square, -self.slope, -self.constant),
        };
        let discriminant = b * b - (a * c).times(4.0);
        if !discriminant.positive()? {
            return Ok([None; 2]);
        }
        let root = discriminant.sqrt();
        // Both are right whatever the sign of b is; one of them does not cancel.
        Ok(if b.quick_enclosure().value > 0.0 {
            let sum = (b + root).times(-0.5);
            [Some(a / sum), Some(sum / c)]
        } else {
            let sum = (root - b).times(0.5);
            [Some(sum / c), Some(a / sum)]
        })
    }

    /// The same where a light lies on the surface at t = `distance`, so that this is a root: the other one, if it is
    /// before the light.
    fn inverse_before(&self, distance: R) -> Result<[Option<R>; 2], Undecided> {
        let (a, c) = match (&self.square, self.side) {
            (None, _) | (_, Ordering::Equal) => return Ok([None; 2]),
            (Some(square), Ordering::Greater) => (*square, self.constant),
            (Some(square), Ordering::Less) => (-*square, -self.constant),
        };
        // The product of both is a/c.
        let before = (a * distance * distance - c).positive()?;
        Ok([before.then(|| a * distance / c), None])
    }
}

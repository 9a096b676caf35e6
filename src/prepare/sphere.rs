//! Spheres as primary rays see them: by the perpendicular from the center to the ray, never by b² − 4ac.

use std::ops::Range;

use glam::DVec3;

use super::camera::{ANCHOR_LIMIT, Camera};
use crate::real::rational::{Ratio, dot, power_of_two, ratio, ratio3, sub, two_to};
use crate::real::{Real, V3};

/// A sphere that a primary ray can hit: the viewpoint is outside it.
///
/// With C the center from the viewpoint, e = C/|C|, ρ = r/|C| and κ² = 1 − ρ², the nearer hit on the ray s·W is at
/// 1/s = gain · (e·W + √disc), disc = ρ²·W·W − |e × W|² = (e·W)² − κ²·W·W, if disc > 0 and e·W > 0.
#[derive(Debug, Clone, Copy)]
pub struct Sphere<R> {
    /// Index of the object.
    pub object: usize,
    /// Direction from the viewpoint to the center, of unit length.
    pub toward: V3<R>,
    /// |C|, in units of 2^scale.
    pub distance: R,
    /// ρ² = (r/|C|)².
    pub rho2: R,
    /// κ² = 1 − ρ², from (|C|² − r²)/|C|² without cancellation.
    pub kappa2: R,
    /// |C| / (|C|² − r²), per unit of 2^scale.
    pub gain: R,
    /// Where the center is seen on the screen, for a sphere seen small enough; else disc comes from κ².
    pub projected: Option<ProjectedCenter<R>>,
}

/// The center's projection onto the screen, and the offset of a pixel's ray from it:
/// `W = W_c + ((x − anchor[0])·step + offset[0], (y − anchor[1])·step + offset[1], 0)`, W_c ∥ C.
///
/// e × W is then e × (W − W_c), a sum without cancellation, however small and far the sphere is.
#[derive(Debug, Clone, Copy)]
pub struct ProjectedCenter<R> {
    /// The pixel next to the projected center.
    pub anchor: [i32; 2],
    /// W − W_c at that pixel, in units of 2^scale.
    pub offset: [R; 2],
}

/// Spheres seen under more than a right angle (ρ² > ½) take the form (e·W)² − κ²·W·W, which is the accurate one there.
const SMALL_RHO2: f64 = 0.5;

/// Squared distances in which what under- and overflow take is nothing beside a millionth of them.
const SQUARES: Range<f64> = 1e-280..1e300;

impl<R: Real> Sphere<R> {
    /// Prepares a sphere; None if no ray through the screen can hit it: the viewpoint is in or on it (a ray that starts
    /// inside misses), or all of it lies behind.
    pub fn new(
        viewpoint: DVec3,
        prepared: &Camera<R>,
        object: usize,
        center: DVec3,
        radius: f64,
    ) -> Option<Self> {
        // All rays go towards negative z. Subtraction rounds monotonically, so this is exact enough to drop a sphere.
        if center.z - radius > viewpoint.z {
            return None;
        }
        let unit = R::exact(two_to(-prepared.scale));
        let c = (V3::exact(center) - V3::exact(viewpoint)) * unit;
        let r = R::exact(radius) * unit;
        let c2 = c.dot(c);
        let mut power = c2 - r * r;
        // Near the surface the difference of squares has lost its bits, its sign first: there it is taken exactly.
        // Likewise where squares are out of f64's range: too large, or so small that what underflow takes counts beside
        // them.
        let (near, far) = (power.to_f64(), c2.to_f64());
        let clear = near.abs() > 1e-6 * far && near.is_finite() && SQUARES.contains(&far);
        if !clear {
            let exact = power_of_viewpoint(viewpoint, center, radius);
            if exact <= Ratio::ZERO {
                return None;
            }
            power = R::ratio(&(exact / power_of_two(2 * prepared.scale)));
        } else if near < 0.0 {
            return None;
        }
        let distance = c2.sqrt();
        let toward = V3::new(c.x / distance, c.y / distance, c.z / distance);
        let rho2 = r * r / c2;
        Some(Self {
            object,
            toward,
            distance,
            rho2,
            kappa2: power / c2,
            gain: distance / power,
            projected: (rho2.to_f64() <= SMALL_RHO2)
                .then(|| projected(prepared, c))
                .flatten(),
        })
    }
}

/// |V − C|² − r², exactly.
fn power_of_viewpoint(viewpoint: DVec3, center: DVec3, radius: f64) -> Ratio {
    let d = sub(&ratio3(center), &ratio3(viewpoint));
    let r = ratio(radius);
    dot(&d, &d) - &r * &r
}

/// The projection of the center `c`, if it is on the screen's side of the viewpoint and not too far out.
fn projected<R: Real>(camera: &Camera<R>, c: V3<R>) -> Option<ProjectedCenter<R>> {
    if c.z.to_f64() >= 0.0 {
        return None;
    }
    let depth = camera.distance / -c.z;
    let axis = |i: usize, center: R| {
        let projected = center * depth;
        let column = if camera.step[i].to_f64() > 0.0 {
            let steps = (projected.to_f64() - camera.offset[i].to_f64()) / camera.step[i].to_f64();
            (f64::from(camera.anchor[i]) + steps).round()
        } else {
            0.0
        };
        let offset =
            R::exact(column - f64::from(camera.anchor[i])) * camera.step[i] + camera.offset[i];
        (column.abs() <= ANCHOR_LIMIT).then(|| (column as i32, offset - projected))
    };
    let (ax, ox) = axis(0, c.x)?;
    let (ay, oy) = axis(1, c.y)?;
    Some(ProjectedCenter {
        anchor: [ax, ay],
        offset: [ox, oy],
    })
}

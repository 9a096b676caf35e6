//! Where an object can be at all: a ball, or corners of what holds it; for remarks about objects that are nowhere to
//! be seen.
//!
//! f64 is enough: a remark is made where something is so beyond what may have been rounded, and not made elsewhere.

use glam::DVec3;

use crate::scene::{Extent, Object, Quadric, Rectangle, Shape};

/// What is less than this share of the numbers that it is the difference of may have been rounded away. A corner of a
/// rectangle takes some twenty operations of 2⁻⁵³ each, and a normal or an xdir of nearly the same direction takes more
/// of it; this is a million times as much.
pub(super) const DOUBT: f64 = 1e-9;

/// What holds an object.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Hull {
    /// A ball.
    Ball(DVec3, f64),
    /// Corners, between which it is.
    Corners(Vec<DVec3>),
    /// All points between two heights: coordinates z.
    Slab(f64, f64),
}

/// What holds an object, where it does not go on for ever.
pub(super) fn hull(object: &Object) -> Option<Hull> {
    match &object.shape {
        Shape::Sphere { center, radius } => Some(Hull::Ball(*center, *radius)),
        Shape::Triangle(triangle) => Some(Hull::Corners(triangle.vertices.to_vec())),
        Shape::Plane {
            normal,
            point,
            extent: Extent::Rectangle(rectangle),
        } => Some(Hull::Corners(corners(*normal, *point, rectangle))),
        Shape::Plane {
            extent: Extent::Unbounded,
            ..
        } => None,
        Shape::Quadric(quadric) => {
            let (lower, upper) = edges(quadric);
            if lower.is_finite() && upper.is_finite() {
                let corner = |i: u32| {
                    let at = |axis: u32| if i >> axis & 1 == 0 { lower } else { upper };
                    DVec3::new(at(0).x, at(1).y, at(2).z)
                };
                Some(Hull::Corners((0..8).map(corner).collect()))
            } else {
                (lower.z.is_finite() || upper.z.is_finite()).then_some(Hull::Slab(lower.z, upper.z))
            }
        }
    }
}

/// The corners of a rectangle.
fn corners(normal: DVec3, point: DVec3, rectangle: &Rectangle) -> Vec<DVec3> {
    // Of any length, up to the largest; divided first, so that no product is too large or too small.
    let unit = |v: DVec3| {
        let largest = v.abs().max_element();
        (v / largest).normalize()
    };
    let normal = unit(normal);
    let xdir = unit(rectangle.xdir);
    let first = unit(xdir - normal.dot(xdir) * normal);
    let along = first * rectangle.dimensions.x;
    let across = normal.cross(first) * rectangle.dimensions.y;
    vec![point, point + along, point + across, point + along + across]
}

/// The least and the largest coordinates of a quadric, infinite where it has no end that is known.
pub(super) fn edges(quadric: &Quadric) -> (DVec3, DVec3) {
    let (mut lower, mut upper) = (DVec3::NEG_INFINITY, DVec3::INFINITY);
    if let Some((center, semiaxes)) = ellipsoid(quadric) {
        // A little more than it is, for what is rounded.
        let more = DOUBT * (center.abs() + semiaxes);
        (lower, upper) = (center - semiaxes - more, center + semiaxes + more);
    }
    if let Some(given) = quadric.lower {
        lower = lower.max(given);
    }
    if let Some(given) = quadric.upper {
        upper = upper.min(given);
    }
    (lower, upper)
}

/// The center and the semi-axes of a quadric that is an ellipsoid along the axes.
pub(super) fn ellipsoid(quadric: &Quadric) -> Option<(DVec3, DVec3)> {
    let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients;
    let (square, slope) = (DVec3::new(a, b, c), DVec3::new(g, h, i));
    let sign = a.signum();
    let square = square * sign;
    if [d, e, f] != [0.0; 3] || square.min_element() <= 0.0 {
        return None;
    }
    let slope = slope * sign;
    let center = -0.5 * slope / square;
    // A (x − p)² + … = J + A p² + …
    let size = j * sign + (square * center * center).element_sum();
    let semiaxes = (DVec3::splat(size) / square).map(f64::sqrt);
    (semiaxes.is_finite() && semiaxes.min_element() > 0.0).then_some((center, semiaxes))
}

impl Hull {
    /// How far it goes in a direction of any length: the largest p · direction over it, and how much of that may be
    /// rounding.
    fn reach(&self, direction: DVec3, from: DVec3) -> (f64, f64) {
        let along = |point: DVec3| {
            let sizes = (point.abs() + from.abs()).dot(direction.abs());
            ((point - from).dot(direction), DOUBT * sizes)
        };
        match self {
            Self::Ball(center, radius) => {
                let (middle, doubt) = along(*center);
                let more = radius * direction.length();
                (middle + more, doubt + DOUBT * more)
            }
            Self::Corners(corners) => {
                let ends = corners.iter().map(|corner| along(*corner));
                ends.fold((f64::NEG_INFINITY, 0.0), |most, end| {
                    (most.0.max(end.0), most.1.max(end.1))
                })
            }
            Self::Slab(lower, upper) => {
                let end = if direction.z > 0.0 { upper } else { lower };
                if direction.truncate() == glam::DVec2::ZERO && end.is_finite() {
                    along(DVec3::new(0.0, 0.0, *end))
                } else {
                    (f64::INFINITY, 0.0)
                }
            }
        }
    }

    /// Whether all of it lies, for certain, on the side of a plane through `from` that `direction` points away from.
    pub(super) fn is_beyond(&self, from: DVec3, direction: DVec3) -> bool {
        let (reach, doubt) = self.reach(direction, from);
        reach < -doubt
    }

    /// Whether it is cut off by the rule that a hit's z is at most the tolerance; spheres are not.
    pub(super) fn least_z(&self) -> Option<f64> {
        match self {
            Self::Ball(..) => None,
            Self::Corners(corners) => corners.iter().map(|corner| corner.z).reduce(f64::min),
            Self::Slab(lower, _) => Some(*lower),
        }
    }
}

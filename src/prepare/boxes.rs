//! Boxes around what a ray from anywhere may meet and no tree holds. Above `world_plane` and `world_sphere`; `world`
//! has one for each of its own.
//!
//! A box says only that a ray passes an object by; what is hit, and where, the object tells. It is asked in f64,
//! whatever the tracer's number type is: for a fifth of what the object takes in `Bounded`, and without a new number
//! in `Lazy`.

use super::extent::Extent;
use super::quadric::Quadric;
use super::triangle;
use super::world_plane::WorldPlane;
use super::world_sphere::WorldSphere;
use crate::real::rational::two_to;
use crate::real::{Real, V3};
use crate::scene::{Scene, Shape};

/// A box, from the viewpoint in units of 2^scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Its least corner.
    pub min: [f64; 3],
    /// Its greatest corner.
    pub max: [f64; 3],
}

/// Boxes around what no tree holds, by its place; what has none may be anywhere.
#[derive(Debug, Clone, Default)]
pub struct Boxes {
    /// Around planes.
    pub planes: Vec<Option<Bounds>>,
    /// Around quadrics.
    pub quadrics: Vec<Option<Bounds>>,
    /// Around spheres.
    pub spheres: Vec<Option<Bounds>>,
    /// No point of the boxes is farther than this from the viewpoint.
    pub size: f64,
}

/// A slab test in f64 errs by a few 2⁻⁵³ of its distances.
pub const SLACK: f64 = 1.0 + 1e-12;

impl Bounds {
    /// Around the corners of what has straight sides; None where a number has no bound.
    fn of_corners<R: Real>(corners: &[V3<R>]) -> Option<Self> {
        let mut bounds = Self {
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        };
        for corner in corners {
            for axis in 0..3 {
                let at = corner.axis(axis).quick_enclosure();
                bounds.min[axis] = bounds.min[axis].min(at.least().next_down());
                bounds.max[axis] = bounds.max[axis].max(at.most().next_up());
            }
        }
        bounds.is_finite().then_some(bounds)
    }

    fn is_finite(&self) -> bool {
        self.min.iter().chain(&self.max).all(|c| c.is_finite())
    }

    /// How far from the viewpoint its points are at most.
    fn size(&self) -> f64 {
        (0..3)
            .map(|i| self.min[i].abs().max(self.max[i].abs()))
            .sum()
    }

    /// Where the ray from a base along w enters the box, in units of w; None if it does not. `inverse` is 1/w by
    /// components, and the base lies between `high` and `low`: the box is widened by their difference. The slack covers
    /// the roundings of the test itself, which are relative.
    #[inline(always)]
    pub fn enters(&self, low: [f64; 3], high: [f64; 3], inverse: [f64; 3]) -> Option<f64> {
        // None of these is a NaN, which f64::min takes three instructions more to look for.
        let (least, most) = (
            |a: f64, b: f64| if a < b { a } else { b },
            |a: f64, b: f64| if a > b { a } else { b },
        );
        let (mut near, mut far) = (0.0, f64::INFINITY);
        for i in 0..3 {
            let a = (self.min[i] - low[i]) * inverse[i];
            let b = (self.max[i] - high[i]) * inverse[i];
            near = most(near, least(a, b));
            far = least(far, most(a, b));
        }
        (near <= far * SLACK).then_some(near)
    }
}

impl Boxes {
    /// Around planes, quadrics and spheres of a scene.
    pub(super) fn new<R: Real>(
        scene: &Scene,
        scale: i32,
        planes: &[WorldPlane<R>],
        quadrics: &[Quadric<R>],
        spheres: &[WorldSphere<R>],
    ) -> Self {
        let planes: Vec<_> = planes
            .iter()
            .map(|plane| around_plane(scene, scale, plane))
            .collect();
        let quadrics: Vec<_> = quadrics.iter().map(around_quadric).collect();
        let spheres: Vec<_> = spheres.iter().map(around_sphere).collect();
        let all = planes.iter().chain(&quadrics).chain(&spheres);
        let size = all.flatten().map(Bounds::size).fold(0.0, f64::max);
        Self {
            planes,
            quadrics,
            spheres,
            size,
        }
    }
}

/// Around a rectangle or a triangle.
fn around_plane<R: Real>(scene: &Scene, scale: i32, plane: &WorldPlane<R>) -> Option<Bounds> {
    let view = scene.camera.viewpoint;
    match (&scene.objects[plane.object].shape, &plane.extent) {
        (Shape::Plane { point, .. }, Extent::Rectangle(rectangle)) => {
            let corner = (V3::exact(*point) - V3::exact(view)) * R::exact(two_to(-scale));
            let side = |i: usize| rectangle.rows[i] * rectangle.dimensions[i];
            let next = corner + side(0);
            Bounds::of_corners(&[corner, next, corner + side(1), next + side(1)])
        }
        (Shape::Triangle(triangle), _) => {
            Bounds::of_corners(&triangle::corners::<R>(triangle, view, scale))
        }
        (Shape::Plane { .. } | Shape::Sphere { .. } | Shape::Quadric(_), _) => None,
    }
}

fn around_sphere<R: Real>(sphere: &WorldSphere<R>) -> Option<Bounds> {
    let reach = V3::new(sphere.radius, sphere.radius, sphere.radius);
    Bounds::of_corners(&[sphere.center - reach, sphere.center + reach])
}

/// Around a quadric that is an ellipsoid, or cut on all sides.
fn around_quadric<R: Real>(quadric: &Quadric<R>) -> Option<Bounds> {
    let mut bounds = around_ellipsoid(quadric).unwrap_or(Bounds {
        min: [f64::NEG_INFINITY; 3],
        max: [f64::INFINITY; 3],
    });
    for (axis, [least, greatest]) in quadric.borders.iter().enumerate() {
        if let Some(least) = least {
            let least = least.quick_enclosure().least().next_down();
            bounds.min[axis] = bounds.min[axis].max(least);
        }
        if let Some(greatest) = greatest {
            let greatest = greatest.quick_enclosure().most().next_up();
            bounds.max[axis] = bounds.max[axis].min(greatest);
        }
    }
    bounds.is_finite().then_some(bounds)
}

/// Around a quadric that is an ellipsoid for certain.
///
/// With M the matrix of the second degree, m = −M⁻¹·slope/2 its middle and k what the left side is there, the surface
/// is vᵀMv = −k around m. Along axis i it reaches √(−k·(M⁻¹)ᵢᵢ), by Cauchy and Schwarz.
fn around_ellipsoid<R: Real>(quadric: &Quadric<R>) -> Option<Bounds> {
    let square = quadric.square?;
    let sign = if square[0].positive().ok()? {
        1.0
    } else {
        -1.0
    };
    let [a, b, c, d, e, f] = square.map(|c| c.times(sign));
    let [d, e, f] = [d, e, f].map(|c| c.times(0.5));
    let adjugate = [
        V3::new(b * c - f * f, e * f - d * c, d * f - e * b),
        V3::new(e * f - d * c, a * c - e * e, d * e - a * f),
        V3::new(d * f - e * b, d * e - a * f, a * b - d * d),
    ];
    let determinant = V3::new(a, d, e).dot(adjugate[0]);
    let certain = |number: R| number.positive() == Ok(true);
    if !(certain(a) && certain(adjugate[2].z) && certain(determinant)) {
        return None;
    }
    let slope = quadric.slope * R::exact(sign);
    let half = R::exact(-0.5) / determinant;
    let [x, y, z] = adjugate.map(|row| row.dot(slope) * half);
    let middle = V3::new(x, y, z);
    let depth = -(quadric.constant.times(sign) + slope.dot(middle).times(0.5));
    if !certain(depth) {
        return None;
    }
    let reach = |axis: usize| (depth * adjugate[axis].axis(axis) / determinant).sqrt();
    let reach = V3::new(reach(0), reach(1), reach(2));
    Bounds::of_corners(&[middle - reach, middle + reach])
}

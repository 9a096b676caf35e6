//! Where a plane ends, in positions from the viewpoint, and the directions of its sides.

use glam::DVec3;

use crate::real::rational::{Ratio, abs, cross, dot, exponent, ratio, ratio3, two_to};
use crate::real::{Real, Undecided, V3};
use crate::scene;

/// Where a plane ends: straight sides all around, or nowhere.
#[derive(Debug, Clone)]
pub enum Extent<R> {
    /// It has no end.
    Unbounded,
    /// It is a rectangle.
    Rectangle(Rectangle<R>),
    /// It is a triangle: what is within three sides.
    Triangle(Box<[HalfPlane<R>; 3]>),
}

/// What lies on one side of a line in a plane: p = row·P − origin is ≥ 0 for these points P.
#[derive(Debug, Clone)]
pub struct HalfPlane<R> {
    /// In the plane, perpendicular to the line; of any length.
    pub row: V3<R>,
    /// row·Q for the points Q of the line.
    pub origin: R,
}

/// The rectangle of a finite plane: p_i = rows\[i\]·P − origin\[i\] lies in [0, dimensions\[i\]] for i = 0 and 1.
#[derive(Debug, Clone)]
pub struct Rectangle<R> {
    /// Unit vectors along the sides: xdir projected onto the plane, and normal × that.
    pub rows: [V3<R>; 2],
    /// rows\[i\]·(Q − V).
    pub origin: [R; 2],
    /// Lengths of the sides, in units of 2^scale.
    pub dimensions: [R; 2],
}

impl<R: Real> Extent<R> {
    /// Prepares the end of a plane, positions from the viewpoint.
    pub fn new(
        camera: &scene::Camera,
        scale: i32,
        normal: DVec3,
        point: DVec3,
        extent: &scene::Extent,
    ) -> Self {
        match extent {
            scene::Extent::Unbounded => Self::Unbounded,
            scene::Extent::Rectangle(rectangle) => {
                Self::Rectangle(Rectangle::new(camera, scale, normal, point, rectangle))
            }
        }
    }
}

impl<R: Real> Rectangle<R> {
    /// Prepares a rectangle, positions from the viewpoint.
    pub fn new(
        camera: &scene::Camera,
        scale: i32,
        normal: DVec3,
        point: DVec3,
        rectangle: &scene::Rectangle,
    ) -> Self {
        let rows = rows(normal, rectangle.xdir);
        let unit = R::exact(two_to(-scale));
        let corner = (V3::exact(point) - V3::exact(camera.viewpoint)) * unit;
        Self {
            rows,
            origin: rows.map(|row| row.dot(corner)),
            dimensions: [
                R::exact(rectangle.dimensions.x) * unit,
                R::exact(rectangle.dimensions.y) * unit,
            ],
        }
    }

    /// Whether a point of the plane is within the sides; these belong to the rectangle.
    pub fn holds(&self, position: V3<R>) -> Result<bool, Undecided> {
        let coordinates = self.coordinates(position);
        for (p, length) in coordinates.into_iter().zip(self.dimensions) {
            if !p.non_negative()? || !(length - p).non_negative()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The coordinates of a point of the plane along the sides.
    pub fn coordinates(&self, position: V3<R>) -> [R; 2] {
        [
            self.rows[0].dot(position) - self.origin[0],
            self.rows[1].dot(position) - self.origin[1],
        ]
    }
}

/// A vector along the first side of a rectangle: (N·N)·xdir − (N·xdir)·N, which is rational.
fn across(n: &[Ratio; 3], x: &[Ratio; 3]) -> [Ratio; 3] {
    let (nn, nx) = (dot(n, n), dot(n, x));
    [0, 1, 2].map(|i| &x[i] * &nn - &n[i] * &nx)
}

/// Vectors along both sides of a rectangle, rational and of any length: the second is N × the first.
pub(super) fn along_sides(n: &[Ratio; 3], x: &[Ratio; 3]) -> [[Ratio; 3]; 2] {
    let first = across(n, x);
    let second = cross(n, &first);
    [first, second]
}

/// Unit vectors along the sides of a rectangle: R0 = unit(xdir − (N·xdir)N), R1 = N × R0, N of unit length.
pub fn rows<R: Real>(normal: DVec3, xdir: DVec3) -> [V3<R>; 2] {
    let across = across(&ratio3(normal), &ratio3(xdir));
    let largest = across
        .iter()
        .cloned()
        .map(abs)
        .fold(Ratio::ZERO, |a, b| if b > a { b } else { a });
    let [a, b, c] = across.map(|c| R::ratio(&(c / &largest)));
    let r0 = V3::new(a, b, c).unit();
    let unit_normal = shortened::<R>(normal).unit();
    [r0, unit_normal.cross(r0)]
}

/// A normal divided by its largest component, in absolute value.
pub fn shortened<R: Real>(normal: DVec3) -> V3<R> {
    let largest = ratio(normal.abs().max_element());
    let [x, y, z] = ratio3(normal).map(|c| R::ratio(&(c / &largest)));
    V3::new(x, y, z)
}

/// A vector times the power of two that brings its largest component, of which `near` tells the size, to 1 or next
/// above: so that squares stay within the range of f64.
pub(super) fn of_size_one<R: Real>(v: V3<R>, near: DVec3) -> V3<R> {
    let largest = near.abs().max_element();
    if largest == 0.0 || largest.is_infinite() {
        return v;
    }
    // In two steps, as one need not be an f64.
    let power = -exponent(largest);
    let half = power / 2;
    v * R::exact(two_to(half)) * R::exact(two_to(power - half))
}

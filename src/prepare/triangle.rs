//! Triangles made ready: planes with three sides. Fills what `plane` and `world_plane` declare.
//!
//! There may be a hundred thousand of them, so their numbers are not taken as rationals and rounded once, as those of
//! planes are, but computed in the number type from exact ones, with its bounds (docs/NUMERICS.md, section 12). What is
//! decided for a whole triangle is decided exactly: by f64 with bounds where these tell, by rationals where they do
//! not.

use std::cmp::Ordering;

use glam::DVec3;

use super::camera::{Camera, over_pixels};
use super::extent::{Extent, HalfPlane, of_size_one};
use super::plane::{Front, Plane, Side, Sides, Step};
use super::world_plane::{WorldPlane, low_light};
use crate::real::rational::{Ratio, abs, cross, dot, power_of_two, ratio3, sub, two_to};
use crate::real::{Bounded, Real, V3};
use crate::scene::{self, Light, Triangle};
use crate::settings::ViewParameters;

/// Which vertices each side runs between.
const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// (v2 − v1) × (v3 − v1) exactly, as the file gives the vertices.
pub(super) fn exact_normal(triangle: &Triangle) -> [Ratio; 3] {
    scene::triangle::normal(&triangle.vertices.map(|vertex| vertex.to_array()))
}

/// The axis that the triangle is perpendicular to, and the coordinate that all its points share, if there is one.
pub(super) fn flat_axis(triangle: &Triangle) -> Option<(usize, f64)> {
    let [v1, v2, v3] = triangle.vertices;
    (0..3)
        .find(|&i| v1[i] == v2[i] && v1[i] == v3[i])
        .map(|i| (i, v1[i]))
}

/// A vector along the normal (v2 − v1) × (v3 − v1), of size one or so, each component known to `KNOWN` of that.
fn normal<R: Real>(triangle: &Triangle) -> V3<R> {
    let edge = |to: usize| edge::<R>(triangle, 0, to);
    let computed = sized(sized(edge(1)).cross(sized(edge(2))));
    if is_known(computed) {
        return computed;
    }
    let exact = exact_normal(triangle);
    let largest = abs(exact[longest(&exact)].clone());
    let [x, y, z] = exact.map(|c| R::ratio(&(c / &largest)));
    V3::new(x, y, z)
}

/// The axis of the largest component.
fn longest(v: &[Ratio; 3]) -> usize {
    let size = v.clone().map(abs);
    (1..3).fold(0, |a, b| if size[b] > size[a] { b } else { a })
}

/// Whether the bounds of a vector of size one are so small that f32 loses more.
fn is_known<R: Real>(v: V3<R>) -> bool {
    [v.x, v.y, v.z].iter().all(|c| {
        let Bounded { error, .. } = c.quick_enclosure();
        // A NaN fails this comparison.
        error < KNOWN
    })
}

/// Directions and offsets are computed with bounds where these are smaller than this share, else exactly.
const KNOWN: f64 = 1.0 / (1_u64 << 40) as f64;

/// direction·P for the points P of the triangle's plane, from the viewpoint in units of 2^scale; `direction` is its
/// normal.
fn offset<R: Real>(triangle: &Triangle, viewpoint: DVec3, scale: i32, direction: V3<R>) -> R {
    let computed = direction.dot(corners::<R>(triangle, viewpoint, scale)[0]);
    let Bounded { value, error } = computed.quick_enclosure();
    if error < KNOWN * value.abs() {
        return computed;
    }
    // Near the plane of the viewpoint the sum has lost its bits: N·(v1 − V), by the component of N that is largest.
    let exact = exact_normal(triangle);
    let largest = longest(&exact);
    let toward = sub(&ratio3(triangle.vertices[0]), &ratio3(viewpoint));
    let along = dot(&exact, &toward) / &exact[largest] / power_of_two(scale);
    direction.axis(largest) * R::ratio(&along)
}

fn edge<R: Real>(triangle: &Triangle, from: usize, to: usize) -> V3<R> {
    V3::exact(triangle.vertices[to]) - V3::exact(triangle.vertices[from])
}

/// Times a power of two that brings it to size one or so.
fn sized<R: Real>(v: V3<R>) -> V3<R> {
    of_size_one(v, v.to_f64())
}

/// On which side of the triangle's plane a point lies: the sign of (v2 − v1) × (v3 − v1) · (point − v1).
fn side_of(triangle: &Triangle, point: DVec3) -> Ordering {
    let first = triangle.vertices[0];
    let toward = V3::<Bounded>::exact(point) - V3::exact(first);
    normal(triangle).dot(toward).sign().unwrap_or_else(|_| {
        let toward = sub(&ratio3(point), &ratio3(first));
        dot(&exact_normal(triangle), &toward).cmp(&Ratio::ZERO)
    })
}

/// Whether the normal that the file gives turns (v2 − v1) × (v3 − v1) over.
fn is_turned(triangle: &Triangle) -> bool {
    triangle.normal.is_some_and(|facing| {
        let along = normal::<Bounded>(triangle).dot(V3::exact(facing));
        let sign = along
            .sign()
            .unwrap_or_else(|_| dot(&exact_normal(triangle), &ratio3(facing)).cmp(&Ratio::ZERO));
        sign == Ordering::Less
    })
}

impl<R: Real> Plane<R> {
    /// Prepares a triangle; None if no ray through the screen can hit it.
    pub fn of_triangle(
        camera: &scene::Camera,
        prepared: &Camera<R>,
        view: ViewParameters,
        object: usize,
        triangle: &Triangle,
    ) -> Option<Self> {
        let turned = match side_of(triangle, camera.viewpoint) {
            // The viewpoint lies on its plane: t = 0 or none at all, a miss either way.
            Ordering::Equal => return None,
            Ordering::Less => false,
            Ordering::Greater => true,
        };
        let front = match front(camera, view, triangle) {
            Some(front) if front.never => return None,
            front => front.filter(|front| !front.always),
        };
        let corners = corners(triangle, camera.viewpoint, prepared.scale);
        let n = normal::<R>(triangle);
        // 1/s over (W.x, W.y, 1): N·W/k, with k = N·(v1 − V), which is not 0.
        let k = offset(triangle, camera.viewpoint, prepared.scale, n);
        let per_k = R::exact(1.0) / k;
        let form = |v: V3<R>| [v.x, v.y, -(v.z * prepared.distance)];
        let sides = EDGES.map(|[i, j]| {
            // N·(v1 − V) and det(v1 − V, v2 − V, v3 − V) are the same, up to a positive factor; seen from behind, the
            // vertices run the other way round.
            let side = sized(corners[i].cross(edge(triangle, i, j)));
            let side = if turned { -side } else { side };
            Side {
                form: form(side),
                step: side_step(camera, triangle, [i, j], turned, side),
            }
        });
        Some(Self {
            object,
            inverse: form(n * per_k),
            front_step: front.as_ref().and_then(|front| Step::of(&front.form)),
            front: front.map(|front| front.form.map(|f| R::ratio(&f))),
            sides: Sides::Triangle(Box::new(sides)),
        })
    }
}

/// The vertices, from the viewpoint in units of 2^scale.
pub(super) fn corners<R: Real>(triangle: &Triangle, viewpoint: DVec3, scale: i32) -> [V3<R>; 3] {
    let unit = R::exact(two_to(-scale));
    let corner = |vertex| (V3::exact(vertex) - V3::exact(viewpoint)) * unit;
    triangle.vertices.map(corner)
}

/// The rule H.z ≤ τ, for a triangle of which a vertex is before τ: it holds for all points between vertices that keep
/// it.
fn front(camera: &scene::Camera, view: ViewParameters, triangle: &Triangle) -> Option<Front> {
    let before = |vertex: &DVec3| vertex.z > view.screen_tolerance;
    triangle.vertices.iter().any(before).then(|| {
        let n = exact_normal(triangle);
        let v = ratio3(camera.viewpoint);
        let k = dot(&n, &sub(&ratio3(triangle.vertices[0]), &v));
        let [a, b, c] = [&n[0] / &k, &n[1] / &k, -(&n[2] * &v[2]) / &k];
        Front::new(camera, view, &a, &b, &c)
    })
}

/// A side that runs along a column or a row of pixels; `near` is the side as it was computed.
fn side_step<R: Real>(
    camera: &scene::Camera,
    triangle: &Triangle,
    [i, j]: [usize; 2],
    turned: bool,
    near: V3<R>,
) -> Option<Step> {
    let is_not_zero = |number: R| {
        let Bounded { value, error } = number.enclosure();
        // A NaN fails this comparison.
        value.abs() > error * Bounded::GROW
    };
    if is_not_zero(near.x) && is_not_zero(near.y) {
        return None;
    }
    let v = ratio3(camera.viewpoint);
    let [from, to] = [i, j].map(|i| sub(&ratio3(triangle.vertices[i]), &v));
    let side = if turned {
        cross(&to, &from)
    } else {
        cross(&from, &to)
    };
    let [x, y, z] = side;
    Step::of(&over_pixels(camera, &[x, y, -(z * &v[2])]))
}

impl<R: Real> WorldPlane<R> {
    /// Prepares a triangle of a lit scene.
    pub(super) fn of_triangle(
        view: DVec3,
        lights: &[Light],
        scale: i32,
        object: usize,
        triangle: &Triangle,
    ) -> Self {
        let corners = corners::<R>(triangle, view, scale);
        let n = normal::<R>(triangle);
        let extent = Extent::Triangle(Box::new(EDGES.map(|[i, j]| {
            let row = sized(n.cross(sized(edge(triangle, i, j))));
            // Both ends have the same, and the nearer one has it with fewer bits lost.
            let far = |k: usize| corners[k].to_f64().length_squared();
            let near = if far(j) < far(i) { j } else { i };
            HalfPlane {
                row,
                origin: row.dot(corners[near]),
            }
        })));
        let direction = if is_turned(triangle) { -n } else { n };
        let length = direction.dot(direction).sqrt();
        let constant = offset(triangle, view, scale, direction);
        let near = direction.to_f64();
        let (two, one) = (R::exact(2.0) / direction.dot(direction), R::exact(1.0));
        let mirror = |i: usize| {
            let row = direction * -(direction.axis(i) * two);
            row.with_axis(i, row.axis(i) + one)
        };
        let unit = R::exact(two_to(-scale));
        let first = triangle.vertices[0];
        Self {
            object,
            normal: direction * (one / length),
            offset: constant / length,
            direction,
            constant,
            mirror: [mirror(0), mirror(1), mirror(2)],
            fixed_coordinate: flat_axis(triangle)
                .map(|(axis, at)| (axis, (R::exact(at) - R::exact(view[axis])) * unit)),
            extent,
            lights_on_surface: lights_on_triangle(lights, triangle),
            low_light: low_light(view, lights, near, first).map(|light| {
                let above = V3::exact(lights[light].location) - V3::exact(first);
                (light, direction.dot(above * unit) / length)
            }),
        }
    }
}

/// The lights that lie in the triangle's plane exactly, ascending.
fn lights_on_triangle(lights: &[Light], triangle: &Triangle) -> Vec<usize> {
    let on = |light: &Light| side_of(triangle, light.location) == Ordering::Equal;
    (0..lights.len()).filter(|&i| on(&lights[i])).collect()
}

/// Whether all of the triangle is before τ.
pub(super) fn is_before(triangle: &Triangle, screen_tolerance: f64) -> bool {
    let mut vertices = triangle.vertices.iter();
    vertices.all(|vertex| vertex.z > screen_tolerance)
}

#[cfg(test)]
mod tests;

//! What one object answers to the ray of one pixel, and why, in exact arithmetic: the explanations of `plumb probe`.
//!
//! Beside the tracers, not part of them: it starts from the scene as the file has it and follows docs/SCENE.md with
//! rational numbers, so that it can tell a miss by a hair from a tangent, and a tie that f64 decides wrongly. A
//! rectangle's unit vectors are not rational; but which side of an edge a point is on, their squares tell.

use std::fmt;

use crate::prepare::camera::{origin, step};
use crate::real::rational::{Ratio, cross, dot, is_positive, is_zero, ratio, ratio3, sub};
use crate::scene::{Camera, Extent, Rectangle, Scene, Shape, Triangle};

use super::digits;

/// The ray of a pixel, as rational numbers: viewpoint + s·W goes through the pixel's world point at s = 1.
pub(super) struct ExactRay {
    viewpoint: [Ratio; 3],
    w: [Ratio; 3],
}

/// What an object answers, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HitOrMiss {
    /// It is hit.
    Hit,
    /// It is not.
    Miss(Reason),
}

/// Why an object is not hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reason {
    /// N·D = 0.
    Parallel,
    /// The plane contains the viewpoint: t = 0.
    ThroughViewpoint,
    /// t < 0.
    Behind,
    /// The plane is met at this z, above the screen tolerance.
    BeforeScreen(f64),
    /// The plane of a rectangle is met beside it.
    Outside {
        /// Along xdir (0), or along normal × xdir (1).
        side: usize,
        /// Where.
        at: f64,
        /// How long the side is.
        length: f64,
    },
    /// The plane of a triangle is met beside it, beyond the side between these vertices.
    BeyondEdge {
        /// Their numbers, from 1.
        vertices: [usize; 2],
    },
    /// The discriminant is negative.
    Passes,
    /// The discriminant is 0.
    Tangent,
    /// The viewpoint is in the sphere or on it.
    Inside,
}

impl Eq for Reason {}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parallel => f.write_str("the ray is parallel to it"),
            Self::ThroughViewpoint => f.write_str("the viewpoint lies on it"),
            Self::Behind => f.write_str("it is behind the viewpoint"),
            Self::BeforeScreen(z) => write!(f, "it is met in front of the screen, at z = {z}"),
            Self::Outside { side, at, length } => {
                let along = ["xdir", "normal × xdir"][*side];
                write!(
                    f,
                    "its plane is met outside the rectangle: at {} along {along}, where it reaches from 0 to {length}",
                    digits::short(*at)
                )
            }
            Self::BeyondEdge {
                vertices: [from, to],
            } => write!(
                f,
                "its plane is met outside the triangle: beyond the side from vertex{from} to vertex{to}"
            ),
            Self::Passes => f.write_str("the ray passes by"),
            Self::Tangent => f.write_str("the ray touches it, which is a miss"),
            Self::Inside => f.write_str("the viewpoint is inside it"),
        }
    }
}

impl ExactRay {
    /// The ray through pixel (x, y), counted from the bottom left, with fractions between pixels.
    pub(super) fn new(camera: &Camera, x: f64, y: f64) -> Self {
        let at = |i: usize, pixel: f64| {
            let (pixels, world) = (camera.pixeldim[i], camera.worlddim[i]);
            origin(pixels, world) + ratio(pixel) * step(pixels, world)
        };
        let viewpoint = ratio3(camera.viewpoint);
        let w = sub(&[at(0, x), at(1, y), Ratio::ZERO], &viewpoint);
        Self { viewpoint, w }
    }

    /// The pixel's world point.
    pub(super) fn world_point(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| (&self.viewpoint[i] + &self.w[i]).to_f64().value())
    }

    /// What the object of this number answers, under the screen tolerance τ.
    pub(super) fn ask(&self, scene: &Scene, object: usize, screen_tolerance: f64) -> HitOrMiss {
        match scene.objects[object].shape {
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                let (normal, point) = (ratio3(normal), ratio3(point));
                self.plane(&normal, &point, &extent, screen_tolerance)
            }
            Shape::Sphere { center, radius } => self.sphere(&ratio3(center), &ratio(radius)),
            Shape::Triangle(triangle) => self.triangle(&triangle, screen_tolerance),
            Shape::Quadric(_) => HitOrMiss::Miss(Reason::Passes),
        }
    }

    fn triangle(&self, triangle: &Triangle, screen_tolerance: f64) -> HitOrMiss {
        let vertices = triangle.vertices.map(ratio3);
        let edge = |from: usize, to: usize| sub(&vertices[to], &vertices[from]);
        let normal = cross(&edge(0, 1), &edge(0, 2));
        let hit = match self.plane_point(&normal, &vertices[0], screen_tolerance) {
            Ok(hit) => hit,
            Err(reason) => return HitOrMiss::Miss(reason),
        };
        let beyond = [(0, 1), (1, 2), (2, 0)].into_iter().find(|&(from, to)| {
            let inward = cross(&normal, &edge(from, to));
            let p = dot(&inward, &sub(&hit, &vertices[from]));
            !is_positive(&p) && !is_zero(&p)
        });
        beyond.map_or(HitOrMiss::Hit, |(from, to)| {
            HitOrMiss::Miss(Reason::BeyondEdge {
                vertices: [from + 1, to + 1],
            })
        })
    }

    fn plane(
        &self,
        normal: &[Ratio; 3],
        point: &[Ratio; 3],
        extent: &Extent,
        screen_tolerance: f64,
    ) -> HitOrMiss {
        let hit = match self.plane_point(normal, point, screen_tolerance) {
            Ok(hit) => hit,
            Err(reason) => return HitOrMiss::Miss(reason),
        };
        let outside = match extent {
            Extent::Unbounded => None,
            Extent::Rectangle(rectangle) => outside(rectangle, normal, &sub(&hit, point)),
        };
        outside.map_or(HitOrMiss::Hit, HitOrMiss::Miss)
    }

    /// Where the ray meets the plane, if that counts.
    fn plane_point(
        &self,
        normal: &[Ratio; 3],
        point: &[Ratio; 3],
        screen_tolerance: f64,
    ) -> Result<[Ratio; 3], Reason> {
        let along = dot(normal, &self.w);
        let ahead = dot(normal, &sub(point, &self.viewpoint));
        if is_zero(&along) {
            return Err(Reason::Parallel);
        }
        let s = ahead / along;
        if is_zero(&s) {
            return Err(Reason::ThroughViewpoint);
        }
        if !is_positive(&s) {
            return Err(Reason::Behind);
        }
        let hit = [0, 1, 2].map(|i| &self.viewpoint[i] + &self.w[i] * &s);
        if hit[2] > ratio(screen_tolerance) {
            return Err(Reason::BeforeScreen(hit[2].to_f64().value()));
        }
        Ok(hit)
    }

    fn sphere(&self, center: &[Ratio; 3], radius: &Ratio) -> HitOrMiss {
        let c = sub(center, &self.viewpoint);
        let power = dot(&c, &c) - radius * radius;
        if !is_positive(&power) {
            return HitOrMiss::Miss(Reason::Inside);
        }
        let along = dot(&c, &self.w);
        let discriminant = &along * &along - dot(&self.w, &self.w) * power;
        if is_zero(&discriminant) {
            return HitOrMiss::Miss(Reason::Tangent);
        }
        if !is_positive(&discriminant) {
            return HitOrMiss::Miss(Reason::Passes);
        }
        if is_positive(&along) {
            HitOrMiss::Hit
        } else {
            HitOrMiss::Miss(Reason::Behind)
        }
    }
}

/// Over which side of a rectangle a point of its plane lies, if over any; `v` leads there from its corner.
fn outside(rectangle: &Rectangle, normal: &[Ratio; 3], v: &[Ratio; 3]) -> Option<Reason> {
    // Along the sides, not of unit length: (N·N)·xdir − (N·xdir)·N, and N × that.
    let xdir = ratio3(rectangle.xdir);
    let (nn, nx) = (dot(normal, normal), dot(normal, &xdir));
    let first = [0, 1, 2].map(|i| &xdir[i] * &nn - &normal[i] * &nx);
    let second = cross(normal, &first);
    for (side, along) in [first, second].iter().enumerate() {
        let length = rectangle.dimensions[side];
        let (p, size2) = (dot(along, v), dot(along, along));
        let before = !is_positive(&p) && !is_zero(&p);
        if before || &p * &p > ratio(length) * ratio(length) * &size2 {
            let at = p.to_f64().value() / size2.to_f64().value().sqrt();
            return Some(Reason::Outside { side, at, length });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The answers of all objects to the middle pixel of a 3 × 3 picture, whose ray runs from (1, 1, 2) along −z.
    fn answers(objects: &str, screen_tolerance: f64) -> Vec<HitOrMiss> {
        let text = format!(
            "camera c {{ pixeldim 3 3 worlddim 2 2 viewpoint 1 1 2 }} material m {{ ambient 1 1 1 }} {objects}"
        );
        let scene = crate::scene::parse("test", text.as_bytes(), Path::new("")).unwrap();
        let ray = ExactRay::new(&scene.camera, 1.0, 1.0);
        assert_eq!(ray.world_point(), [1.0, 1.0, 0.0]);
        (0..scene.objects.len())
            .map(|i| ray.ask(&scene, i, screen_tolerance))
            .collect()
    }

    #[test]
    fn planes_answer_why() {
        let plane = |rest: &str| format!("plane p {{ material m {rest} }}");
        let objects = [
            plane("normal 0 0 1 point 0 0 -3"),
            plane("normal 0 1 0 point 0 0 0"),
            plane("normal 0 0 1 point 5 5 2"),
            plane("normal 0 0 1 point 0 0 3"),
            plane("normal 0 0 1 point 0 0 0.5"),
            plane("normal 0 0 1 point 0 0 0"),
        ];
        let expected = [
            HitOrMiss::Hit,
            HitOrMiss::Miss(Reason::Parallel),
            HitOrMiss::Miss(Reason::ThroughViewpoint),
            HitOrMiss::Miss(Reason::Behind),
            HitOrMiss::Miss(Reason::BeforeScreen(0.5)),
            HitOrMiss::Hit,
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
        assert_eq!(answers(&objects.join(" "), 0.5)[4], HitOrMiss::Hit);
    }

    #[test]
    fn rectangles_answer_why() {
        // The ray meets the plane at (1, 1, −3).
        let rectangle = |rest: &str| format!("fplane p {{ material m normal 0 0 7 {rest} }}");
        let objects = [
            rectangle("point 0 0 -3 xdir 2 0 9 dimensions 1 1"),
            rectangle("point 0 0 -3 xdir 2 0 9 dimensions 0.75 1"),
            rectangle("point 0 0 -3 xdir 1 0 0 dimensions 1 0.9999999999999999"),
            rectangle("point 0 2 -3 xdir 1 0 0 dimensions 1 1"),
            // Turned by 45 degrees: the corner is √2 away, and only the square of that is rational.
            rectangle("point 0 0 -3 xdir 1 1 0 dimensions 1.4142135623730951 1"),
            rectangle("point 0 0 -3 xdir 1 1 0 dimensions 1.414213562373095 1"),
        ];
        let outside = |side, at, length| HitOrMiss::Miss(Reason::Outside { side, at, length });
        let root = std::f64::consts::SQRT_2;
        let expected = [
            HitOrMiss::Hit,
            outside(0, 1.0, 0.75),
            outside(1, 1.0, 0.999_999_999_999_999_9),
            outside(1, -1.0, 1.0),
            HitOrMiss::Hit,
            outside(0, 98.0 / 4802.0_f64.sqrt(), root.next_down()),
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
    }

    #[test]
    fn triangles_answer_why() {
        // The ray meets the plane at (1, 1, −3).
        let triangle = |vertices: &str| {
            let [a, b, c] =
                <[&str; 3]>::try_from(vertices.split(", ").collect::<Vec<_>>()).unwrap();
            format!("triangle t {{ material m vertex1 {a} vertex2 {b} vertex3 {c} }}")
        };
        let objects = [
            triangle("0 0 -3, 3 0 -3, 0 3 -3"),
            triangle("0 3 -3, 3 0 -3, 0 0 -3"),
            triangle("1 1 -3, 3 0 -3, 0 -3 -3"),
            triangle("0 0 -3, 2 0 -3, 0 2 -3"),
            triangle("0 0 -3, 2 0 -3, 0 1.9999999999999998 -3"),
            triangle("0 2 -3, 2 2 -3, 1 4 -3"),
            triangle("0 0 3, 3 0 3, 0 3 3"),
        ];
        let beyond = |from, to| {
            HitOrMiss::Miss(Reason::BeyondEdge {
                vertices: [from, to],
            })
        };
        let expected = [
            HitOrMiss::Hit,
            HitOrMiss::Hit,
            HitOrMiss::Hit,
            HitOrMiss::Hit,
            beyond(2, 3),
            beyond(1, 2),
            HitOrMiss::Miss(Reason::Behind),
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
    }

    #[test]
    fn spheres_answer_why() {
        let sphere = |rest: &str| format!("sphere s {{ material m {rest} }}");
        let objects = [
            sphere("center 1 1 -5 radius 1"),
            sphere("center 2 1 -5 radius 1"),
            sphere("center 3 1 -5 radius 1"),
            sphere("center 1 1 5 radius 1"),
            sphere("center 1 1 1 radius 4"),
        ];
        let expected = [
            HitOrMiss::Hit,
            HitOrMiss::Miss(Reason::Tangent),
            HitOrMiss::Miss(Reason::Passes),
            HitOrMiss::Miss(Reason::Behind),
            HitOrMiss::Miss(Reason::Inside),
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
    }
}

//! What one object answers to the ray of one pixel, and why, in exact arithmetic: the explanations of `plumb probe`.
//!
//! Beside the tracers, not part of them: it starts from the scene as the file has it and follows docs/SCENE.md with
//! rational numbers, so that it can tell a miss by a hair from a tangent, and a tie that f64 decides wrongly. A
//! rectangle's unit vectors are not rational; but which side of an edge a point is on, their squares tell.

use crate::prepare::camera::{origin, step};
use crate::real::rational::{Ratio, cross, dot, is_positive, is_zero, ratio, ratio3, sub};
use crate::scene::{Camera, Extent, Rectangle, Scene, Shape, Triangle};

use super::answer::{HitOrMiss, Reason};
use super::quadric;

/// The ray of a pixel, as rational numbers: viewpoint + s·W goes through the pixel's world point at s = 1.
pub(super) struct ExactRay {
    viewpoint: [Ratio; 3],
    w: [Ratio; 3],
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
            Shape::Quadric(quadric) => {
                quadric::ask(&quadric, &self.viewpoint, &self.w, screen_tolerance)
            }
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
mod tests;

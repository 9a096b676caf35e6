//! What one object answers to the ray of one pixel, and why, in exact arithmetic: the explanations of `plumb probe`.
//!
//! Beside the tracers, not part of them: it starts from the scene as the file has it and follows docs/SCENE.md with
//! rational numbers, so that it can tell a miss by a hair from a tangent, and a tie that f64 decides wrongly.

use std::fmt;

use plumb::prepare::camera::{origin, step};
use plumb::prepare::exact::{Ratio, dot, is_positive, is_zero, ratio, ratio3, sub};
use plumb::scene::{Camera, Scene, Shape};

/// The ray of a pixel, as rational numbers: viewpoint + s·W goes through the pixel's world point at s = 1.
pub(crate) struct ExactRay {
    viewpoint: [Ratio; 3],
    w: [Ratio; 3],
}

/// What an object answers, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is hit.
    Hit,
    /// It is not.
    Miss(Reason),
}

/// Why an object is not hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Reason {
    /// N·D = 0.
    Parallel,
    /// The plane contains the viewpoint: t = 0.
    ThroughViewpoint,
    /// t < 0.
    Behind,
    /// The plane is met at this z, above the screen tolerance.
    BeforeScreen(f64),
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
            Self::Passes => f.write_str("the ray passes by"),
            Self::Tangent => f.write_str("the ray touches it, which is a miss"),
            Self::Inside => f.write_str("the viewpoint is inside it"),
        }
    }
}

impl ExactRay {
    /// The ray of pixel (x, y), counted from the bottom left.
    pub(crate) fn new(camera: &Camera, x: u32, y: u32) -> Self {
        let at = |i: usize, pixel: u32| {
            let (pixels, world) = (camera.pixeldim[i], camera.worlddim[i]);
            origin(pixels, world) + ratio(f64::from(pixel)) * step(pixels, world)
        };
        let viewpoint = ratio3(camera.viewpoint);
        let w = sub(&[at(0, x), at(1, y), Ratio::ZERO], &viewpoint);
        Self { viewpoint, w }
    }

    /// The pixel's world point.
    pub(crate) fn world_point(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| (&self.viewpoint[i] + &self.w[i]).to_f64().value())
    }

    /// What the object of this number answers, under the screen tolerance τ.
    pub(crate) fn ask(&self, scene: &Scene, object: usize, screen_tolerance: f64) -> Verdict {
        match scene.objects[object].shape {
            Shape::Plane { normal, point, .. } => {
                self.plane(&ratio3(normal), &ratio3(point), screen_tolerance)
            }
            Shape::Sphere { center, radius } => self.sphere(&ratio3(center), &ratio(radius)),
        }
    }

    fn plane(&self, normal: &[Ratio; 3], point: &[Ratio; 3], screen_tolerance: f64) -> Verdict {
        let along = dot(normal, &self.w);
        let ahead = dot(normal, &sub(point, &self.viewpoint));
        if is_zero(&along) {
            return Verdict::Miss(Reason::Parallel);
        }
        let s = ahead / along;
        if is_zero(&s) {
            return Verdict::Miss(Reason::ThroughViewpoint);
        }
        if !is_positive(&s) {
            return Verdict::Miss(Reason::Behind);
        }
        let z = &self.viewpoint[2] + &self.w[2] * s;
        if z > ratio(screen_tolerance) {
            return Verdict::Miss(Reason::BeforeScreen(z.to_f64().value()));
        }
        Verdict::Hit
    }

    fn sphere(&self, center: &[Ratio; 3], radius: &Ratio) -> Verdict {
        let c = sub(center, &self.viewpoint);
        let power = dot(&c, &c) - radius * radius;
        if !is_positive(&power) {
            return Verdict::Miss(Reason::Inside);
        }
        let along = dot(&c, &self.w);
        let discriminant = &along * &along - dot(&self.w, &self.w) * power;
        if is_zero(&discriminant) {
            return Verdict::Miss(Reason::Tangent);
        }
        if !is_positive(&discriminant) {
            return Verdict::Miss(Reason::Passes);
        }
        if is_positive(&along) {
            Verdict::Hit
        } else {
            Verdict::Miss(Reason::Behind)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The answers of all objects to the middle pixel of a 3 × 3 picture, whose ray runs from (1, 1, 2) along −z.
    fn answers(objects: &str, screen_tolerance: f64) -> Vec<Verdict> {
        let text = format!(
            "camera c {{ pixeldim 3 3 worlddim 2 2 viewpoint 1 1 2 }} material m {{ ambient 1 1 1 }} {objects}"
        );
        let scene = plumb::scene::parse("test", text.as_bytes(), Path::new("")).unwrap();
        let ray = ExactRay::new(&scene.camera, 1, 1);
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
            Verdict::Hit,
            Verdict::Miss(Reason::Parallel),
            Verdict::Miss(Reason::ThroughViewpoint),
            Verdict::Miss(Reason::Behind),
            Verdict::Miss(Reason::BeforeScreen(0.5)),
            Verdict::Hit,
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
        assert_eq!(answers(&objects.join(" "), 0.5)[4], Verdict::Hit);
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
            Verdict::Hit,
            Verdict::Miss(Reason::Tangent),
            Verdict::Miss(Reason::Passes),
            Verdict::Miss(Reason::Behind),
            Verdict::Miss(Reason::Inside),
        ];
        assert_eq!(answers(&objects.join(" "), 0.0), expected);
    }
}

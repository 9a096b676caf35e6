//! A sphere as rays from anywhere see it. The floor below `bvh`, `on_demand` and `world`.

use glam::DVec3;

use crate::real::V3;
use crate::real::rational::{dot, ratio, ratio3, sub};
use crate::scene::{Light, Scene};

/// A sphere.
#[derive(Debug, Clone)]
pub struct WorldSphere<R> {
    /// Index of the object.
    pub object: usize,
    /// Its center.
    pub center: V3<R>,
    /// Its radius.
    pub radius: R,
    /// Lights that lie on the sphere exactly, ascending.
    pub lights_on_surface: Vec<usize>,
}

/// The lights that lie on the sphere exactly, ascending.
pub(super) fn lights_on_sphere(scene: &Scene, center: DVec3, radius: f64) -> Vec<usize> {
    let on = |light: &Light| {
        let estimate = (light.location - center).length();
        (estimate - radius).abs() <= 1e-9 * (radius + light.location.length() + center.length())
            && {
                let d = sub(&ratio3(light.location), &ratio3(center));
                let r = ratio(radius);
                dot(&d, &d) == &r * &r
            }
    };
    (0..scene.lights.len())
        .filter(|&i| on(&scene.lights[i]))
        .collect()
}

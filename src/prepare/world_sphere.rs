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
        let size = radius + light.location.length() + center.length();
        let is_clear = estimate.is_finite() && (estimate - radius).abs() > 1e-9 * size + 1e-150;
        !is_clear && {
            let d = sub(&ratio3(light.location), &ratio3(center));
            let r = ratio(radius);
            dot(&d, &d) == &r * &r
        }
    };
    (0..scene.lights.len())
        .filter(|&i| on(&scene.lights[i]))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::prepare::Prepared;
    use crate::real::Bounded;
    use crate::scene::load_from;

    /// On a sphere of any size, the lamp on it is known; and the one next to it is not on it.
    #[test]
    fn lamps_lie_on_spheres_of_any_size() {
        for power in [-1070, -560, -538, -535, -530, -510, 0, 500, 520, 1000] {
            // In two steps, as one need not be an f64.
            let size = f64::from(power / 2).exp2() * f64::from(power - power / 2).exp2();
            let [one, three, four, five] = [1.0, 3.0, 4.0, 5.0].map(|n| n * size);
            let text = format!(
                "camera c {{ pixeldim 3 3 worlddim 1 1 viewpoint 0 0 1 }}
                 material a {{ ambient 1 1 1 }}
                 sphere s {{ material a center {four:?} 0 -{three:?} radius {five:?} }}
                 light on {{ location 0 0 0 emissivity 1 1 1 }}
                 light off {{ location 0 {one:?} 0 emissivity 1 1 1 }}"
            );
            let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
            let world = Prepared::<Bounded>::new(&scene, 0.0).world.unwrap();
            assert_eq!(world.spheres[0].lights_on_surface, [0], "2^{power}");
        }
    }
}

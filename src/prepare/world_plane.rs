//! A plane as rays from anywhere see it. The floor below `world`.

use glam::DVec3;

use super::extent::{Extent, shortened};
use crate::real::rational::{Ratio, dot, is_zero, power_of_two, ratio, ratio3, sub};
use crate::real::{Real, V3};
use crate::scene::{Light, Scene};

/// A plane, with its sides if it has any.
#[derive(Debug, Clone)]
pub struct WorldPlane<R> {
    /// Index of the object.
    pub object: usize,
    /// Unit normal.
    pub normal: V3<R>,
    /// normal · P for the points P of the plane.
    pub offset: R,
    /// The normal divided by its largest component: rational.
    pub direction: V3<R>,
    /// direction · P for the points P of the plane.
    pub constant: R,
    /// What turns a direction into its mirror image, by rows: I − 2·N·Nᵀ/(N·N), which is rational. Taken as a whole it
    /// does not let errors grow, as D − 2(D·N)N would: three times at each mirror.
    pub mirror: [V3<R>; 3],
    /// If the plane is perpendicular to an axis: which, and the coordinate that all its points share.
    pub fixed_coordinate: Option<(usize, R)>,
    /// Where it ends.
    pub extent: Extent<R>,
    /// Lights that lie in the plane exactly, ascending.
    pub lights_on_surface: Vec<usize>,
    /// The light that is nearest to the plane, if that is too near to be told from its location, and its height.
    pub low_light: Option<(usize, R)>,
}

impl<R: Real> WorldPlane<R> {
    /// Prepares a plane of a lit scene.
    pub(super) fn new(
        scene: &Scene,
        scale: i32,
        object: usize,
        normal: DVec3,
        point: DVec3,
        extent: Extent<R>,
    ) -> Self {
        let n = ratio3(normal);
        let from_viewpoint = sub(&ratio3(point), &ratio3(scene.camera.viewpoint));
        let unit = power_of_two(scale);
        // The direction alone counts: by its largest component a normal of any length stays within range.
        let direction: V3<R> = shortened(normal);
        let length = direction.dot(direction).sqrt();
        let largest = ratio(normal.abs().max_element());
        let offset = R::ratio(&(dot(&n, &from_viewpoint) / &largest / &unit));
        let axis = (0..3).find(|&axis| (0..3).all(|i| i == axis || is_zero(&n[i])));
        Self {
            object,
            normal: V3::new(
                direction.x / length,
                direction.y / length,
                direction.z / length,
            ),
            offset: offset / length,
            direction,
            constant: offset,
            mirror: mirror(&n),
            fixed_coordinate: axis.map(|axis| (axis, R::ratio(&(&from_viewpoint[axis] / &unit)))),
            extent,
            lights_on_surface: lights_on_plane(scene, normal, point),
            low_light: low_light(scene.camera.viewpoint, &scene.lights, normal, point).map(
                |light| {
                    let location = ratio3(scene.lights[light].location);
                    let height = dot(&n, &sub(&location, &ratio3(point)));
                    (light, R::ratio(&(height / &largest / &unit)) / length)
                },
            ),
        }
    }
}

/// The lights that lie in the plane exactly, ascending.
fn lights_on_plane(scene: &Scene, normal: DVec3, point: DVec3) -> Vec<usize> {
    let on = |light: &Light| {
        let light = light.location;
        // Most lights are far from most planes, and f64 is enough to say so.
        let estimate = normal.dot(light - point).abs();
        let size = normal.abs().dot(light.abs() + point.abs());
        (estimate <= 1e-9 * size || !estimate.is_normal())
            && is_zero(&dot(&ratio3(normal), &sub(&ratio3(light), &ratio3(point))))
    };
    (0..scene.lights.len())
        .filter(|&i| on(&scene.lights[i]))
        .collect()
}

/// Lights nearer to a plane than this share of their distance from the viewpoint lose too many bits in f32.
const LOW: f64 = 1.0 / 32.0;

/// The light that is nearest to the plane without lying in it, if it is nearer than `LOW`; of those that the GPU has
/// bits for.
pub(super) fn low_light(
    viewpoint: DVec3,
    lights: &[Light],
    normal: DVec3,
    point: DVec3,
) -> Option<usize> {
    let lights = lights.iter().map(|light| light.location);
    let heights = lights.map(|light| {
        let height = normal.dot(light - point).abs();
        let distance = (light - viewpoint).length();
        (height, height < LOW * normal.length() * distance)
    });
    (0..32)
        .zip(heights)
        .filter(|(_, (height, low))| *low && height.is_normal())
        .min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b))
        .map(|(light, _)| light)
}

/// The rows of I − 2·N·Nᵀ/(N·N).
fn mirror<R: Real>(n: &[Ratio; 3]) -> [V3<R>; 3] {
    let nn = dot(n, n);
    [0, 1, 2].map(|i| {
        let [x, y, z] = [0, 1, 2].map(|j| {
            let unit = ratio(if i == j { 1.0 } else { 0.0 });
            R::ratio(&(unit - ratio(2.0) * &n[i] * &n[j] / &nn))
        });
        V3::new(x, y, z)
    })
}

//! Where a primary ray hits, in world coordinates: what `--debug`, `probe` and `bench` tell of a hit that `trace`
//! found.

use glam::DVec3;

use super::camera::Ray;
use super::sphere::sphere_from_center;
use super::trace::Hit;
use crate::prepare::Prepared;
use crate::prepare::surface::flat_axis;
use crate::real::Real;
use crate::real::rational::two_to;
use crate::scene::{Scene, Shape};

/// Where a primary ray hits, in world coordinates.
///
/// On a plane perpendicular to an axis that coordinate is the plane's own, exactly; on a sphere the point is found from
/// the center, where a small sphere that is far away has its bits.
pub fn hit_point<R: Real>(
    scene: &Scene,
    prepared: &Prepared<R>,
    ray: &Ray<R>,
    hit: &Hit<R>,
) -> DVec3 {
    let unit = two_to(prepared.camera.scale);
    let along = || scene.camera.viewpoint + ray.w.to_f64() * (unit / hit.inverse.to_f64());
    let shape = &scene.objects[hit.object].shape;
    match *shape {
        Shape::Plane { .. } | Shape::Triangle(_) => {
            let mut at = along();
            if let Some((axis, coordinate)) = flat_axis(shape) {
                at[axis] = coordinate;
            }
            at
        }
        Shape::Quadric(_) => along(),
        Shape::Sphere { center, .. } => {
            let sphere = prepared.spheres.get(hit.index).copied();
            let sphere = sphere.or_else(|| prepared.make_sphere(hit.index));
            sphere.map_or_else(along, |sphere| {
                let camera = &prepared.camera;
                center + sphere_from_center(camera, &sphere, ray, hit.inverse).to_f64() * unit
            })
        }
    }
}

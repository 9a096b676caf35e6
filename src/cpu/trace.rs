//! Twin of `shaders/trace.wgsl`: the closest hit of a ray, and its colour.

use super::bvh::bvh_hits;
use super::camera::{Ray, camera_getdir, inverse_distance};
use super::plane::plane_hits;
use super::sphere::sphere_hits;
use super::surface::getamb;
use crate::prepare::Prepared;
use crate::real::{Real, Undecided, V3};

/// A hit of a primary ray.
#[derive(Debug, Clone, Copy)]
pub struct Hit<R> {
    /// 1/s: the larger, the nearer.
    pub inverse: R,
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the prepared plane or sphere.
    pub index: usize,
}

/// What a ray found: the hit and the colour it brings, (r, g, b) with 1 as bright as a byte goes.
#[derive(Debug, Clone, Copy)]
pub struct Traced<R> {
    /// The ray.
    pub ray: Ray<R>,
    /// The closest hit, if any.
    pub hit: Option<Hit<R>>,
    /// Ambient reflectivity at the hit; zero without.
    pub ambient: V3<R>,
    /// The colour.
    pub color: V3<R>,
}

/// The closest object that the ray hits; of equally near ones the first in the file.
pub fn find_closest_object<R: Real>(scene: &Prepared<R>, ray: &Ray<R>) -> Result<Option<Hit<R>>, Undecided> {
    let mut closest: Option<Hit<R>> = None;
    for (index, plane) in scene.planes.iter().enumerate() {
        if let Some(inverse) = plane_hits(plane, ray)? {
            nearer(&mut closest, Hit { inverse, object: plane.object, index })?;
        }
    }
    let mut treated = 0;
    if let Some(bvh) = &scene.bvh {
        bvh_hits(scene, bvh, ray, &mut closest)?;
        treated = bvh.len;
    }
    for (index, sphere) in scene.spheres.iter().enumerate().skip(treated) {
        if let Some(inverse) = sphere_hits(&scene.camera, sphere, ray)? {
            nearer(&mut closest, Hit { inverse, object: sphere.object, index })?;
        }
    }
    Ok(closest)
}

/// Takes `hit` if it is nearer than `closest`, or as near and first in the file.
pub(super) fn nearer<R: Real>(closest: &mut Option<Hit<R>>, hit: Hit<R>) -> Result<(), Undecided> {
    let takes = match closest {
        None => true,
        Some(best) => {
            let difference = hit.inverse - best.inverse;
            difference.positive()? || (hit.object < best.object && difference.non_negative()?)
        }
    };
    if takes {
        *closest = Some(hit);
    }
    Ok(())
}

/// Traces the ray through pixel (x, y), counted from the bottom left.
pub fn ray_trace<R: Real>(scene: &Prepared<R>, x: f64, y: f64) -> Result<Traced<R>, Undecided> {
    let ray = camera_getdir(&scene.camera, x, y);
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let Some(hit) = find_closest_object(scene, &ray)? else {
        return Ok(Traced { ray, hit: None, ambient: zero, color: zero });
    };
    let ambient = getamb(scene, &ray, &hit)?;
    let color = ambient * inverse_distance(&scene.camera, &ray, hit.inverse);
    Ok(Traced { ray, hit: Some(hit), ambient, color })
}

//! Where rays meet a sphere. Referee of `shaders/sphere.wgsl`.

use super::camera::{Ray, steps_from};
use crate::prepare::{Camera, Sphere, WorldSphere};
use crate::real::{Real, Undecided, V3};

/// 1/s of the nearer hit on the sphere, or None for a miss; a tangent ray misses.
#[inline]
pub fn sphere_hits<R: Real>(
    camera: &Camera<R>,
    sphere: &Sphere<R>,
    ray: &Ray<R>,
) -> Result<Option<R>, Undecided> {
    let along = sphere.toward.dot(ray.w);
    let disc = sphere_disc(camera, sphere, ray, along);
    if !disc.positive()? || !along.positive()? {
        return Ok(None);
    }
    Ok(Some(sphere.gain * (along + disc.sqrt())))
}

/// (r² − |perpendicular|²)·W·W / |C|²: > 0 where the ray's line meets the sphere.
#[inline]
fn sphere_disc<R: Real>(camera: &Camera<R>, sphere: &Sphere<R>, ray: &Ray<R>, along: R) -> R {
    match sphere_offset(camera, sphere, ray) {
        Some([u, v]) => {
            let e = sphere.toward;
            let turn = e.x * v - e.y * u;
            sphere.rho2 * ray.w2 - (e.z * e.z * (u * u + v * v) + turn * turn)
        }
        None => along * along - sphere.kappa2 * ray.w2,
    }
}

/// W − W_c on the screen: how far the ray passes from the projected center, if that is on the screen's side.
#[inline]
fn sphere_offset<R: Real>(camera: &Camera<R>, sphere: &Sphere<R>, ray: &Ray<R>) -> Option<[R; 2]> {
    let projected = sphere.projected.as_ref()?;
    let axis =
        |i: usize| steps_from(camera, i, ray.pixel[i], projected.anchor[i]) + projected.offset[i];
    Some([axis(0), axis(1)])
}

/// t of the nearer hit on the sphere for a ray from anywhere, of unit direction; None for a miss, and for a ray that
/// starts inside.
pub fn sphere_hits_from<R: Real>(
    sphere: &WorldSphere<R>,
    base: V3<R>,
    dir: V3<R>,
) -> Result<Option<R>, Undecided> {
    let to_center = sphere.center - base;
    let along = to_center.dot(dir);
    if !along.positive()? {
        return Ok(None);
    }
    let perpendicular = to_center - dir * along;
    let disc = sphere.radius * sphere.radius - perpendicular.dot(perpendicular);
    if !disc.positive()? {
        return Ok(None);
    }
    let t = along - disc.sqrt();
    Ok(t.positive()?.then_some(t))
}

/// H − C at the nearer hit, in units of 2^scale.
///
/// With U = W − W_c: H − C = s·U + (s/s_c − 1)·C, and s/s_c − 1 = −(|W_c|·(e·U + √disc) + U·U)/W·W, where s/s_c − 1 is
/// not taken as a difference: away from the limb the vector is as accurate, against the radius, for a sphere that is
/// small and far as for one that is near.
pub fn sphere_from_center<R: Real>(
    camera: &Camera<R>,
    sphere: &Sphere<R>,
    ray: &Ray<R>,
    inverse: R,
) -> V3<R> {
    let s = R::exact(1.0) / inverse;
    let along = sphere.toward.dot(ray.w);
    let center = sphere.toward * sphere.distance;
    let Some([u, v]) = sphere_offset(camera, sphere, ray) else {
        return ray.w * s - center;
    };
    let e = sphere.toward;
    let disc = sphere_disc(camera, sphere, ray, along);
    let to_center = camera.distance / -e.z;
    let nearer = -((to_center * (e.x * u + e.y * v + disc.sqrt()) + (u * u + v * v)) / ray.w2);
    V3::new(
        s * u + nearer * center.x,
        s * v + nearer * center.y,
        nearer * center.z,
    )
}

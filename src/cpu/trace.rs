//! The closest hit of a primary ray, and the colour that it brings, for which `tree` follows the rays that leave from
//! there. Referee of `shaders/closest.wgsl`, `point.wgsl` and `trace.wgsl`.

use super::camera::{Ray, camera_getdir, inverse_distance};
use super::plane::{on_plane, plane_hits};
use super::quadric::quadric_hits;
use super::sphere::{sphere_from_center, sphere_hits};
use super::surface::{Point, getamb};
use super::tree::Tree;
use crate::prepare::{Prepared, Surface};
use crate::real::{Bounded, Real, Undecided, V3};

pub use super::fault::Fault;
pub use super::observer::{Branch, RayKind, TraceObserver, Unmet, Unobserved};
pub use crate::settings::Limits;

/// A hit of a primary ray.
#[derive(Debug, Clone, Copy)]
pub struct Hit<R> {
    /// 1/s: the larger, the nearer.
    pub inverse: R,
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the prepared plane, quadric or sphere.
    pub index: usize,
}

/// The closest object that a primary ray hits; of equally near ones the first in the file.
#[inline]
pub fn find_closest_object<R: Real>(
    scene: &Prepared<R>,
    ray: &Ray<R>,
) -> Result<Option<Hit<R>>, Undecided> {
    let mut closest: Option<Hit<R>> = None;
    for (index, plane) in scene.planes.iter().enumerate() {
        let mark = R::mark();
        let hit = plane_hits(plane, ray, at_least(closest.as_ref()))?.map(|inverse| Hit {
            inverse,
            object: plane.object,
            index,
        });
        if !takes(scene, &mut closest, hit)? {
            R::release(mark);
        }
    }
    for (index, quadric) in scene.quadrics.iter().enumerate() {
        let mark = R::mark();
        let hit = quadric_hits(quadric, ray)?.map(|inverse| Hit {
            inverse,
            object: quadric.object,
            index,
        });
        if !takes(scene, &mut closest, hit)? {
            R::release(mark);
        }
    }
    let sphere = |closest: &mut Option<Hit<R>>, index: usize| -> Result<(), Undecided> {
        let mark = R::mark();
        let made;
        let sphere = match scene.spheres.get(index) {
            Some(sphere) => sphere,
            None => {
                made = scene.make_sphere(index);
                match &made {
                    Some(sphere) => sphere,
                    None => return Err(Undecided),
                }
            }
        };
        let hit = sphere_hits(&scene.camera, sphere, ray)?.map(|inverse| Hit {
            inverse,
            object: sphere.object,
            index,
        });
        if !takes(scene, closest, hit)? {
            R::release(mark);
        }
        Ok(())
    };
    let triangle = |closest: &mut Option<Hit<R>>, index: usize| -> Result<(), Undecided> {
        let mark = R::mark();
        let triangle = scene.triangle(index).ok_or(Undecided)?;
        let hit = plane_hits(&triangle, ray, at_least(closest.as_ref()))?.map(|inverse| Hit {
            inverse,
            object: triangle.object,
            index,
        });
        if !takes(scene, closest, hit)? {
            R::release(mark);
        }
        Ok(())
    };
    let Some(screen_grid) = &scene.screen_grid else {
        for index in 0..scene.sphere_count() {
            sphere(&mut closest, index)?;
        }
        return Ok(closest);
    };
    for &index in screen_grid.at(ray.pixel) {
        let index = index as usize;
        // The nearest come first: the others lie behind what is hit.
        if f64::from(screen_grid.max_inverse[index]) < at_least(closest.as_ref()) {
            break;
        }
        match index.checked_sub(scene.sphere_count()) {
            None => sphere(&mut closest, index)?,
            Some(index) => triangle(&mut closest, index)?,
        }
    }
    Ok(closest)
}

/// What 1/s of a hit has to be for it to matter beside the closest.
#[inline]
fn at_least<R: Real>(closest: Option<&Hit<R>>) -> f64 {
    closest.map_or(f64::NEG_INFINITY, |hit| {
        let Bounded { value, error } = hit.inverse.quick_enclosure();
        value - (error + value.abs() * f64::EPSILON) * Bounded::GROW
    })
}

/// Takes `hit`, if there is one, where it is nearer than `closest`, or as near and first in the file. Whether it did.
#[inline]
fn takes<R: Real>(
    scene: &Prepared<R>,
    closest: &mut Option<Hit<R>>,
    hit: Option<Hit<R>>,
) -> Result<bool, Undecided> {
    let Some(hit) = hit else {
        return Ok(false);
    };
    let takes = match closest {
        None => true,
        // Surfaces that coincide are met at the same place: a tie all over, which no digits tell.
        Some(best) if scene.groups[best.object] == scene.groups[hit.object] => {
            hit.object < best.object
        }
        Some(best) => {
            let difference = hit.inverse - best.inverse;
            difference.positive()? || (hit.object < best.object && difference.non_negative()?)
        }
    };
    if takes {
        *closest = Some(hit);
    }
    Ok(takes)
}

/// Where a primary ray hit.
pub fn locate<R: Real>(scene: &Prepared<R>, ray: &Ray<R>, hit: &Hit<R>) -> Point<R> {
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let object = hit.object;
    if scene.world.is_none() && matches!(scene.surfaces[object], Surface::Plain) {
        // Neither the surface nor a light asks where the hit is.
        return Point {
            object,
            position: zero,
            from_center: zero,
        };
    }
    let mut position = ray.w * (R::exact(1.0) / hit.inverse);
    if scene.is_quadric(object) {
        let quadric = scene.quadrics.get(hit.index);
        return Point {
            object,
            position,
            from_center: quadric.map_or(zero, |quadric| quadric.gradient(position)),
        };
    }
    if !scene.is_plane[object] {
        let sphere = scene.spheres.get(hit.index).copied();
        let sphere = sphere.or_else(|| scene.make_sphere(hit.index));
        return Point {
            object,
            position,
            from_center: sphere.map_or(zero, |sphere| {
                sphere_from_center(&scene.camera, &sphere, ray, hit.inverse)
            }),
        };
    }
    if let Some(plane) = scene
        .world
        .as_ref()
        .and_then(|world| world.plane_of(object))
    {
        position = on_plane(&plane, position);
    }
    Point {
        object,
        position,
        from_center: zero,
    }
}

/// What a ray found, and the colour it brings, (r, g, b) with 1 as bright as a byte goes.
#[derive(Debug, Clone, Copy)]
pub struct Traced<R> {
    /// The ray.
    pub ray: Ray<R>,
    /// The closest hit, if any.
    pub hit: Option<Hit<R>>,
    /// Ambient reflectivity at the hit; zero without.
    pub ambient: V3<R>,
    /// The colour; or somewhat less, by what rays bring that were not followed.
    pub color: V3<R>,
    /// How much less at most, by channels.
    pub open: [f64; 3],
}

/// Traces the ray through pixel (x, y), counted from the bottom left, with fractions between pixels.
pub fn ray_trace<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    x: f64,
    y: f64,
    observer: &mut impl TraceObserver<R>,
) -> Result<Traced<R>, Fault> {
    let ray = camera_getdir(&scene.camera, x, y);
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let hit = find_closest_object(scene, &ray)?;
    let Some(hit) = hit else {
        return Ok(Traced {
            ray,
            hit,
            ambient: zero,
            color: zero,
            open: [0.0; 3],
        });
    };
    let point = locate(scene, &ray, &hit);
    let ambient = getamb(scene, &point)?;
    let (color, open) = match &scene.world {
        // Without lights the notes' ambient tracer is all there is.
        None => {
            let color = ambient * inverse_distance(&scene.camera, &ray, hit.inverse);
            (color, [0.0; 3])
        }
        Some(world) => {
            let length = ray.w2.sqrt();
            let dir = ray.w * (R::exact(1.0) / length);
            let mut tree = Tree::new(scene, world, limits);
            tree.grow(dir, length / hit.inverse, &point, observer)?;
            (tree.color, tree.open)
        }
    };
    Ok(Traced {
        ray,
        hit: Some(hit),
        ambient,
        color,
        open,
    })
}

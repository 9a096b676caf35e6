//! What a ray from anywhere meets first. Referee of `shaders/world.wgsl`.

use super::bvh::{BoxRay, at_most, bvh_hits};
use super::plane::plane_hits_from;
use super::quadric::{Start, quadric_hits_from};
use super::sphere::sphere_hits_from;
use super::surface::Point;
use crate::prepare::boxes::{Bounds, SLACK};
use crate::prepare::{World, WorldPlane};
use crate::real::{Real, Undecided, V3};

/// A hit of a ray from anywhere.
#[derive(Debug, Clone, Copy)]
pub struct SecondaryHit<R> {
    /// Distance, in units of 2^scale.
    pub t: R,
    /// Where and on what.
    pub point: Point<R>,
}

/// What of the scene a ray sees.
#[derive(Debug, Clone, Copy)]
pub struct Range<R> {
    /// The group of surfaces that the ray left from, which it cannot meet.
    pub skip: Option<u32>,
    /// A shadow ray's light: hits count only before it.
    pub light: Option<Toward<R>>,
    /// Whether the ray goes on through what it meets: from there all of a quadric counts that lies ahead, of the one
    /// that the ray left too.
    pub through: bool,
}

/// The light that a shadow ray goes to.
#[derive(Debug, Clone, Copy)]
pub struct Toward<R> {
    /// Its number.
    pub number: usize,
    /// Its distance from the ray's base.
    pub distance: R,
}

/// The first object that the ray from `base` along the unit vector `dir` meets; of equally near ones the first in the
/// file.
pub fn closest_hit<R: Real>(
    world: &World<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
) -> Result<Option<SecondaryHit<R>>, Undecided> {
    let mut closest: Option<SecondaryHit<R>> = None;
    hits_from(world, base, dir, range, &mut |hit| {
        let takes = match &closest {
            None => true,
            // Surfaces that coincide are met at the same place.
            Some(best) if world.groups[best.point.object] == world.groups[hit.point.object] => {
                hit.point.object < best.point.object
            }
            Some(best) => {
                let difference = best.t - hit.t;
                difference.positive()?
                    || (hit.point.object < best.point.object && difference.non_negative()?)
            }
        };
        if takes {
            closest = Some(hit);
        }
        Ok(closest
            .as_ref()
            .map_or(f64::INFINITY, |best| at_most(best.t)))
    })?;
    Ok(closest)
}

/// Calls `take` with everything that the ray meets in range, in no order. `take` returns how far hits still matter;
/// below 0 it is told of no more of them.
pub fn hits_from<R: Real>(
    world: &World<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
    take: &mut impl FnMut(SecondaryHit<R>) -> Result<f64, Undecided>,
) -> Result<(), Undecided> {
    let passed_by = PassedBy::new(world, base, dir);
    let mut reach = planes_from(world, base, dir, range, &passed_by, take)?;
    if reach >= 0.0 {
        reach = quadrics_from(world, base, dir, range, (&passed_by, reach), take)?;
    }
    if reach < 0.0 {
        return Ok(());
    }
    let before_spheres = reach;
    let treated = world.sphere_tree.as_ref().map_or(0, |tree| tree.len);
    let mut sphere = |index: usize| -> Result<f64, Undecided> {
        let loose = index.checked_sub(treated);
        if loose.is_some_and(|loose| passed_by.any(&world.boxes.spheres, loose, reach)) {
            return Ok(reach);
        }
        let mark = R::mark();
        if reach >= 0.0
            && let Some(hit) = sphere_from(world, index, base, dir, range)?
        {
            reach = take(hit)?;
        } else {
            R::release(mark);
        }
        Ok(reach)
    };
    if let Some(bvh) = &world.sphere_tree {
        bvh_hits(bvh, base, dir, before_spheres, &mut sphere)?;
    }
    for index in treated..world.sphere_count() {
        sphere(index)?;
    }
    if reach >= 0.0
        && let Some(tree) = &world.triangle_tree
    {
        let loose = world.loose_planes();
        bvh_hits(tree, base, dir, reach, |index| {
            let mark = R::mark();
            let Some(plane) = world.plane(loose + index) else {
                return Err(Undecided);
            };
            if reach >= 0.0
                && let Some(hit) = plane_from(world, &plane, base, dir, range, reach)?
            {
                reach = take(hit)?;
            } else {
                R::release(mark);
            }
            Ok(reach)
        })?;
    }
    Ok(())
}

/// Calls `take` with every plane outside the tree that the ray meets in range, and returns how far hits still matter.
fn planes_from<R: Real>(
    world: &World<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
    passed_by: &PassedBy,
    take: &mut impl FnMut(SecondaryHit<R>) -> Result<f64, Undecided>,
) -> Result<f64, Undecided> {
    let light = range.light.as_ref();
    let mut reach = light.map_or(f64::INFINITY, |light| at_most(light.distance));
    for (place, plane) in world.planes[..world.loose_planes()].iter().enumerate() {
        if passed_by.any(&world.boxes.planes, place, reach) {
            continue;
        }
        let mark = R::mark();
        match plane_from(world, plane, base, dir, range, reach)? {
            Some(hit) => {
                reach = take(hit)?;
                if reach < 0.0 {
                    break;
                }
            }
            None => R::release(mark),
        }
    }
    Ok(reach)
}

/// Calls `take` with where the ray meets quadrics in range, and returns how far hits still matter.
fn quadrics_from<R: Real>(
    world: &World<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
    (passed_by, mut reach): (&PassedBy, f64),
    take: &mut impl FnMut(SecondaryHit<R>) -> Result<f64, Undecided>,
) -> Result<f64, Undecided> {
    for (place, quadric) in world.quadrics.iter().enumerate() {
        if passed_by.any(&world.boxes.quadrics, place, reach) {
            continue;
        }
        let left_from = range.skip == Some(world.groups[quadric.object]);
        if left_from && !range.through {
            continue;
        }
        let same_points = |group: u32| quadric.same_points.contains(&group);
        let start = Start {
            on_surface: left_from || range.skip.is_some_and(same_points),
            light_on_surface: range.ends_on(&quadric.lights_on_surface),
        };
        let mark = R::mark();
        let distance = range.light.map(|light| light.distance);
        let hits = quadric_hits_from(quadric, base, dir, start, distance)?;
        let mut any = false;
        for (t, position) in hits.into_iter().flatten() {
            if !range.reaches(t)? {
                break;
            }
            any = true;
            reach = take(SecondaryHit {
                t,
                point: Point {
                    object: quadric.object,
                    position,
                    from_center: quadric.gradient(position),
                },
            })?;
            if reach < 0.0 {
                return Ok(reach);
            }
            if !range.through {
                break;
            }
        }
        if !any {
            R::release(mark);
        }
    }
    Ok(reach)
}

/// Which boxes a ray passes by.
struct PassedBy(Option<BoxRay>);

impl PassedBy {
    #[inline]
    fn new<R: Real>(world: &World<R>, base: V3<R>, dir: V3<R>) -> Self {
        let size = world.boxes.size;
        let enclosures = |v: V3<R>| [v.x, v.y, v.z].map(Real::quick_enclosure);
        Self(if size > 0.0 {
            BoxRay::new(enclosures(base), enclosures(dir), size)
        } else {
            None
        })
    }

    /// Whether the ray surely meets nothing in the box of this place up to `reach`.
    #[inline(always)]
    fn any(&self, boxes: &[Option<Bounds>], place: usize, reach: f64) -> bool {
        let (Some(ray), Some(Some(bounds))) = (&self.0, boxes.get(place)) else {
            return false;
        };
        ray.enters(bounds).is_none_or(|near| near > reach * SLACK)
    }
}

/// The hit of the plane, if it is in range and not surely farther than `reach`.
fn plane_from<R: Real>(
    world: &World<R>,
    plane: &WorldPlane<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
    reach: f64,
) -> Result<Option<SecondaryHit<R>>, Undecided> {
    if range.skip == Some(world.groups[plane.object]) || range.ends_on(&plane.lights_on_surface) {
        return Ok(None);
    }
    let Some((t, position)) = plane_hits_from(plane, base, dir, world.highest, reach)? else {
        return Ok(None);
    };
    if !range.reaches(t)? {
        return Ok(None);
    }
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    Ok(Some(SecondaryHit {
        t,
        point: Point {
            object: plane.object,
            position,
            from_center: zero,
        },
    }))
}

/// The hit of the sphere of this place, if it is in range.
fn sphere_from<R: Real>(
    world: &World<R>,
    index: usize,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
) -> Result<Option<SecondaryHit<R>>, Undecided> {
    let made;
    let sphere = match world.spheres.get(index) {
        Some(sphere) => sphere,
        None => {
            made = world.make_sphere(index);
            match &made {
                Some(sphere) => sphere,
                None => return Err(Undecided),
            }
        }
    };
    if range.skip == Some(world.groups[sphere.object]) {
        return Ok(None);
    }
    if let Some(light) = &range.light
        && range.ends_on(&sphere.lights_on_surface)
    {
        // From outside, a light on the sphere is where the ray would enter it: at the light, not before.
        let to_light = world.lights[light.number].location - sphere.center;
        if !to_light.dot(dir).positive()? {
            return Ok(None);
        }
    }
    let Some(t) = sphere_hits_from(sphere, base, dir)? else {
        return Ok(None);
    };
    if !range.reaches(t)? {
        return Ok(None);
    }
    let position = base + dir * t;
    Ok(Some(SecondaryHit {
        t,
        point: Point {
            object: sphere.object,
            position,
            from_center: position - sphere.center,
        },
    }))
}

impl<R: Real> Range<R> {
    /// Whether a hit at this distance counts: a shadow ray's does before the light.
    fn reaches(&self, t: R) -> Result<bool, Undecided> {
        self.light
            .as_ref()
            .map_or(Ok(true), |light| (light.distance - t).positive())
    }

    /// Whether a shadow ray's light is among these, which lie on a surface. On a plane, they meet at the light, not
    /// before it, or not at all.
    fn ends_on(&self, lights_on_surface: &[usize]) -> bool {
        self.light
            .as_ref()
            .is_some_and(|light| lights_on_surface.binary_search(&light.number).is_ok())
    }
}

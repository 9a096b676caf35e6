//! Twin of `shaders/world.wgsl`: what a ray from anywhere meets first.

use super::bvh::bvh_hits;
use super::plane::plane_hits_from;
use super::sphere::sphere_hits_from;
use super::surface::Point;
use crate::prepare::World;
use crate::real::{Real, Undecided, V3};

/// A hit of a ray from anywhere.
#[derive(Debug, Clone, Copy)]
pub struct Met<R> {
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
    /// Hits count only beyond this.
    pub beyond: Option<R>,
    /// A shadow ray's light: hits count only before it.
    pub light: Option<Toward<R>>,
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
pub fn closest_from<R: Real>(
    world: &World<R>,
    base: V3<R>,
    dir: V3<R>,
    range: &Range<R>,
) -> Result<Option<Met<R>>, Undecided> {
    let mut closest: Option<Met<R>> = None;
    for plane in &world.planes {
        if range.skip == Some(world.groups[plane.object]) || ends_at(range, &plane.level) {
            continue;
        }
        if let Some((t, position)) = plane_hits_from(plane, base, dir, world.highest)? {
            let zero = V3::new(R::zero(), R::zero(), R::zero());
            let point = Point { object: plane.object, position, from_center: zero };
            nearer(&mut closest, Met { t, point }, range)?;
        }
    }
    let mut sphere = |index: usize| -> Result<f64, Undecided> {
        let sphere = &world.spheres[index];
        let skipped = range.skip == Some(world.groups[sphere.object]);
        // From outside, a light on the sphere is where the ray would enter it: at the light, not before.
        let entry = |light: usize| (world.lights[light].location - sphere.center).dot(dir).positive();
        let at_light = match &range.light {
            Some(light) if sphere.level.binary_search(&light.number).is_ok() => !entry(light.number)?,
            _ => false,
        };
        if !skipped
            && !at_light
            && let Some(t) = sphere_hits_from(sphere, base, dir)?
        {
            let position = base + dir * t;
            let from_center = position - sphere.center;
            nearer(&mut closest, Met { t, point: Point { object: sphere.object, position, from_center } }, range)?;
        }
        let limit = range.light.as_ref().map_or(f64::INFINITY, |light| light.distance.approx());
        Ok(closest.as_ref().map_or(limit, |met| met.t.approx()))
    };
    let mut treated = 0;
    if let Some(bvh) = &world.bvh {
        let reach = range.light.as_ref().map_or(f64::INFINITY, |light| light.distance.approx());
        bvh_hits(bvh, base.approx(), dir.approx(), reach, &mut sphere)?;
        treated = bvh.len;
    }
    for index in treated..world.spheres.len() {
        sphere(index)?;
    }
    Ok(closest)
}

/// Whether a shadow ray's light lies in the plane: then they meet at the light, not before it, or not at all.
fn ends_at<R>(range: &Range<R>, level: &[usize]) -> bool {
    range.light.as_ref().is_some_and(|light| level.binary_search(&light.number).is_ok())
}

/// Takes `met` if it is in range, and nearer than `closest` or as near and first in the file.
fn nearer<R: Real>(closest: &mut Option<Met<R>>, met: Met<R>, range: &Range<R>) -> Result<(), Undecided> {
    if let Some(beyond) = range.beyond
        && !(met.t - beyond).positive()?
    {
        return Ok(());
    }
    if let Some(light) = &range.light
        && !(light.distance - met.t).positive()?
    {
        return Ok(());
    }
    let takes = match closest {
        None => true,
        Some(best) => {
            let difference = best.t - met.t;
            difference.positive()? || (met.point.object < best.point.object && difference.non_negative()?)
        }
    };
    if takes {
        *closest = Some(met);
    }
    Ok(())
}

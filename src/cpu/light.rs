//! What a light brings to a hit point. Referee of `shaders/light.wgsl`.

use std::cmp::Ordering;

use super::bvh::at_most;
use super::surface::{Point, getdiff, tile_material};
use super::world::{Met, Range, Toward, hits_from};
use crate::prepare::{Light, Prepared, World};
use crate::real::rational::two_to;
use crate::real::{Real, Undecided, V3};

/// What a light does at a hit point.
#[derive(Debug, Clone, Copy)]
pub enum Lit<R> {
    /// It lies exactly there.
    AtLight,
    /// It lies behind the surface.
    FacesAway,
    /// The point is outside its cone.
    OutsideCone,
    /// An object, by its index, keeps it off.
    Shadowed(usize),
    /// It lights the point.
    Lit {
        /// The diffuse term.
        diffuse: V3<R>,
        /// The glint term.
        glint: V3<R>,
        /// The share of the light that came through what it had to pass.
        filter: V3<R>,
    },
}

/// The unit normal at a hit point, as the scene gives it or outward.
pub fn normal_at<R: Real>(world: &World<R>, is_plane: bool, point: &Point<R>) -> V3<R> {
    if is_plane {
        world.planes[world.places[point.object]].normal
    } else {
        point.from_center.unit()
    }
}

/// What light number `number` brings to a point with unit normal `normal`, seen by a ray from `base`.
pub fn light_term<R: Real>(
    scene: &Prepared<R>,
    world: &World<R>,
    number: usize,
    point: &Point<R>,
    normal: V3<R>,
    base: V3<R>,
) -> Result<Lit<R>, Undecided> {
    let light = &world.lights[number];
    let toward = light.location - point.position;
    let distance2 = toward.dot(toward);
    if !distance2.positive()? {
        return Ok(Lit::AtLight);
    }
    let distance = distance2.sqrt();
    let d = toward * (R::exact(1.0) / distance);
    let level = scene.is_plane[point.object]
        && world.planes[world.places[point.object]]
            .level
            .binary_search(&number)
            .is_ok();
    let across = toward.dot(normal);
    if level || !across.positive()? {
        return Ok(Lit::FacesAway);
    }
    if !in_cone(light, d)? {
        return Ok(Lit::OutsideCone);
    }
    let filter = match shadow(scene, world, point, d, Toward { number, distance })? {
        Ok(filter) => filter,
        Err(blocker) => return Ok(Lit::Shadowed(blocker)),
    };
    // c/dist, with c the cosine.
    let falloff = (across / distance2).times(two_to(-scene.camera.scale));
    let diffuse = getdiff(scene, point)?.each(light.emissivity).each(filter) * falloff;
    let glint = glint(scene, light, point, normal, base, d)?;
    Ok(Lit::Lit {
        diffuse,
        glint,
        filter,
    })
}

/// Whether a point is in the light's cone; `d` is the unit vector from the point to the light.
fn in_cone<R: Real>(light: &Light<R>, d: V3<R>) -> Result<bool, Undecided> {
    match &light.cone {
        None => Ok(true),
        Some((axis, cosine)) => (-axis.dot(d) - *cosine).positive(),
    }
}

/// The share of the light that reaches the point along `d`, or the object that keeps it off.
fn shadow<R: Real>(
    scene: &Prepared<R>,
    world: &World<R>,
    point: &Point<R>,
    d: V3<R>,
    light: Toward<R>,
) -> Result<Result<V3<R>, usize>, Undecided> {
    let range = Range {
        skip: Some(world.groups[point.object]),
        light: Some(light),
    };
    let reach = match &range.light {
        Some(light) if world.bvh.is_some() => at_most(light.distance),
        _ => f64::INFINITY,
    };
    let opaque = |object: usize| !scene.palette[scene.materials[object]].clear;
    let mut met = Vec::new();
    let mut dark = None;
    hits_from(world, point.position, d, &range, &mut |hit| {
        if !scene.any_clear {
            dark = Some(hit.point.object);
            return Ok(-1.0);
        }
        met.push(hit);
        Ok(reach)
    })?;
    if let Some(blocker) = dark {
        return Ok(Err(blocker));
    }
    let met = one_at_a_place(world, met)?;
    if let Some(blocker) = met
        .iter()
        .map(|point| point.object)
        .find(|&object| opaque(object))
    {
        return Ok(Err(blocker));
    }
    let one = R::exact(1.0);
    let mut filter = V3::new(one, one, one);
    for point in &met {
        let material = &scene.palette[scene.materials[point.object]];
        filter =
            filter.each(scene.palette[tile_material(scene, point)?].tint) * material.transparency;
    }
    Ok(Ok(filter))
}

/// Of surfaces met at the same place only the first in the file: seen from there the others are at t = 0, a miss.
fn one_at_a_place<R: Real>(
    world: &World<R>,
    mut met: Vec<Met<R>>,
) -> Result<Vec<Point<R>>, Undecided> {
    // Of coincident surfaces that is decided already.
    met.sort_unstable_by_key(|met| (world.groups[met.point.object], met.point.object));
    met.dedup_by_key(|met| world.groups[met.point.object]);
    // Nearly in order, so that putting them in order exactly takes one comparison each.
    met.sort_by(|a, b| a.t.approx().total_cmp(&b.t.approx()));
    let mut kept: Vec<Met<R>> = Vec::with_capacity(met.len());
    for next in met {
        let mut place = kept.len();
        loop {
            let order = match place.checked_sub(1) {
                Some(before) => (next.t - kept[before].t).sign()?,
                None => Ordering::Greater,
            };
            match order {
                Ordering::Less => place -= 1,
                Ordering::Greater => {
                    kept.insert(place, next);
                    break;
                }
                Ordering::Equal => {
                    let last = &mut kept[place - 1];
                    if next.point.object < last.point.object {
                        *last = next;
                    }
                    break;
                }
            }
        }
    }
    Ok(kept.into_iter().map(|met| met.point).collect())
}

/// The glint: specular ∘ E · (h·N)ⁿ, h the unit vector halfway between the ways back and to the light.
fn glint<R: Real>(
    scene: &Prepared<R>,
    light: &Light<R>,
    point: &Point<R>,
    normal: V3<R>,
    base: V3<R>,
    d: V3<R>,
) -> Result<V3<R>, Undecided> {
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let material = &scene.palette[scene.materials[point.object]];
    if material.shininess == 0.0 || !material.mirror {
        return Ok(zero);
    }
    let half = (base - point.position).unit() + d;
    let along = half.dot(normal);
    if !along.positive()? {
        return Ok(zero);
    }
    let cosine = along / half.dot(half).sqrt();
    Ok(material.specular.each(light.emissivity) * cosine.pow(material.shininess))
}

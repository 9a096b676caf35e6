//! What a light brings to a hit point. Referee of `shaders/light.wgsl`.

use std::cmp::Ordering;

use super::bvh::at_most;
use super::surface::{Point, getdiff, texel, tile_material};
use super::world::{Range, SecondaryHit, Toward, hits_from};
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
    /// It does not come to the point through its picture.
    OutsidePicture,
    /// An object, by its index, keeps it off.
    Shadowed(usize),
    /// It lights the point.
    Lit {
        /// The diffuse term.
        diffuse: V3<R>,
        /// The glint term.
        glint: V3<R>,
        /// The transmittance of what the light had to pass.
        transmittance: V3<R>,
    },
}

/// The unit normal at a hit point, as the scene gives it or outward.
pub fn normal_at<R: Real>(world: &World<R>, is_plane: bool, point: &Point<R>) -> V3<R> {
    let plane = if is_plane {
        world.plane_of(point.object)
    } else {
        None
    };
    plane.map_or_else(|| point.from_center.unit(), |plane| plane.normal)
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
    let in_surface = |lights: &[usize]| lights.binary_search(&number).is_ok();
    let light_in_plane = if scene.is_plane[point.object] {
        let plane = world.plane_of(point.object);
        plane.is_some_and(|plane| in_surface(&plane.lights_on_surface))
    } else {
        scene.is_quadric(point.object)
            && world.quadrics[world.places[point.object]].is_plane_with(number)
    };
    let across = toward.dot(normal);
    if light_in_plane || !across.positive()? {
        return Ok(Lit::FacesAway);
    }
    if !in_cone(light, toward, d)? {
        return Ok(Lit::OutsideCone);
    }
    let Some(emissivity) = emissivity(scene, world, number, point)? else {
        return Ok(Lit::OutsidePicture);
    };
    let transmittance = match shadow(scene, world, point, d, Toward { number, distance })? {
        Ok(transmittance) => transmittance,
        Err(blocker) => return Ok(Lit::Shadowed(blocker)),
    };
    // c/dist, with c the cosine.
    let falloff = (across / distance2).times(two_to(-scene.camera.scale));
    let diffuse = getdiff(scene, point)?.each(emissivity).each(transmittance) * falloff;
    let glint = glint(scene, emissivity, point, normal, base, d)?;
    Ok(Lit::Lit {
        diffuse,
        glint,
        transmittance,
    })
}

/// Whether a point is in the light's cone; `toward` is the vector from the point to the light, and `d` that of unit
/// length.
fn in_cone<R: Real>(light: &Light<R>, toward: V3<R>, d: V3<R>) -> Result<bool, Undecided> {
    let Some((axis, cosine)) = light.cone else {
        return Ok(true);
    };
    let along = -axis.dot(d);
    let Some(narrow) = light.narrow else {
        return (along - cosine).positive();
    };
    // The cosine of the cone is next to 1, and so is that of the points where it matters. With φ the angle at the
    // light, 1 − cos φ is compared instead, as sin² φ/(1 + cos φ), in which nothing cancels.
    if !along.positive()? {
        return Ok(false);
    }
    let across = axis.cross(toward);
    let square = across.dot(across);
    // On the axis, which is in every cone, this is 0, and that is never told from a small number by digits.
    if square.sign() == Ok(Ordering::Equal) {
        return Ok(true);
    }
    let off = square / (toward.dot(toward) * (R::exact(1.0) + along));
    Ok((off - narrow).sign()? == Ordering::Less)
}

/// How bright light number `number` is for this point: a projector's picture is passed once. None where the segment to
/// the point does not cross the picture.
fn emissivity<R: Real>(
    scene: &Prepared<R>,
    world: &World<R>,
    number: usize,
    point: &Point<R>,
) -> Result<Option<V3<R>>, Undecided> {
    let light = &world.lights[number];
    let Some(projector) = &light.projector else {
        return Ok(Some(light.emissivity));
    };
    let Some(reach) = projector.reach else {
        return Ok(None);
    };
    // A surface in the picture's plane is met where the segment ends, all over: no digits tell that.
    if world.picture_planes[number] == world.groups[point.object] {
        return Ok(None);
    }
    let beyond = projector.direction.dot(point.position) - projector.constant;
    if !beyond.positive()? {
        return Ok(None);
    }
    // f is reach over both; two numbers that are > 0 do not cancel.
    let along = reach / (reach + beyond);
    let crossing = light.location + (point.position - light.location) * along;
    if !projector.picture.rectangle.holds(crossing)? {
        return Ok(None);
    }
    let texel = texel(scene, &projector.picture, crossing)?;
    Ok(Some(light.emissivity.each(texel)))
}

/// The transmittance from the point to the light along `d`, or the object that keeps it off.
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
        through: scene.any_transparent,
    };
    let reach = at_most(light.distance);
    let opaque = |object: usize| !scene.palette[scene.materials[object]].transparent;
    let mut hits = Vec::new();
    let mut dark = None;
    hits_from(world, point.position, d, &range, &mut |hit| {
        if !scene.any_transparent {
            dark = Some(hit.point.object);
            return Ok(-1.0);
        }
        hits.push(hit);
        Ok(reach)
    })?;
    if let Some(blocker) = dark {
        return Ok(Err(blocker));
    }
    let hits = one_at_a_place(world, hits, point.object)?;
    if let Some(blocker) = hits
        .iter()
        .map(|point| point.object)
        .find(|&object| opaque(object))
    {
        return Ok(Err(blocker));
    }
    let one = R::exact(1.0);
    let mut transmittance = V3::new(one, one, one);
    for point in &hits {
        let material = &scene.palette[scene.materials[point.object]];
        transmittance = transmittance.each(scene.palette[tile_material(scene, point)?].tint)
            * material.transparency;
    }
    Ok(Ok(transmittance))
}

/// Keeps one surface for each place where surfaces are met, the first in the file: seen from there the others are at
/// t = 0, which is a miss. A quadric that the ray left last is not met again before another surface is; `left` is where
/// the ray comes from.
fn one_at_a_place<R: Real>(
    world: &World<R>,
    mut hits: Vec<SecondaryHit<R>>,
    left: usize,
) -> Result<Vec<Point<R>>, Undecided> {
    // Which of several coincident surfaces is met is decided once a scene.
    hits.sort_unstable_by_key(|hit| (world.groups[hit.point.object], hit.point.object));
    hits.dedup_by(|next, hit| {
        let [next, hit] = [next, hit].map(|hit| hit.point.object);
        next != hit && world.groups[next] == world.groups[hit]
    });
    // Sorting by f64 puts them nearly in order, so that the exact order takes one comparison each.
    hits.sort_by(|a, b| a.t.to_f64().total_cmp(&b.t.to_f64()));
    let mut places: Vec<Vec<SecondaryHit<R>>> = Vec::with_capacity(hits.len());
    for next in hits {
        let mut place = places.len();
        loop {
            let order = match place.checked_sub(1) {
                Some(before) => (next.t - places[before][0].t).sign()?,
                None => Ordering::Greater,
            };
            match order {
                Ordering::Less => place -= 1,
                Ordering::Greater => {
                    places.insert(place, vec![next]);
                    break;
                }
                Ordering::Equal => {
                    places[place - 1].push(next);
                    break;
                }
            }
        }
    }
    let mut left = left;
    let mut kept = Vec::with_capacity(places.len());
    for place in places {
        let points = place.iter().map(|hit| hit.point);
        let met = points.filter(|point| point.object != left);
        if let Some(first) = met.min_by_key(|point| point.object) {
            left = first.object;
            kept.push(first);
        }
    }
    Ok(kept)
}

/// The glint: specular ∘ E · (h·N)ⁿ, h the unit vector halfway between the ways back and to the light.
fn glint<R: Real>(
    scene: &Prepared<R>,
    emissivity: V3<R>,
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
    Ok(material.specular.each(emissivity) * cosine.pow(material.shininess))
}

//! The colour of a ray and of a pixel (docs/SCENE.md: "Rays", "The colour of a ray", "Bytes and samples").

use std::cell::Cell;
use std::cmp::Ordering;

use dashu_ratio::RBig;

use super::Fault;
use super::hits::Hit;
use super::real::{Real, Unresolved};
use super::vector::Vector;
use super::world::{Body, Form, Lamp, World};

/// Why a pixel has no bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failure {
    /// Neither many bits nor exact tests decide it.
    Unresolved,
    /// A sample needs more rays than it may.
    TooManyRays,
}

impl From<Unresolved> for Failure {
    fn from(_: Unresolved) -> Self {
        Self::Unresolved
    }
}

/// A ray and all that it meets.
struct Line {
    direction: Vector,
    /// Of the direction.
    length: Real,
    hits: Vec<Hit>,
    /// The path before its base.
    before: Real,
    /// How many mirrors are behind it.
    mirrors: u32,
}

/// What a ray has come by.
struct Way {
    before: Real,
    last: Option<usize>,
    mirrors: u32,
}

impl World<'_> {
    /// The bytes of column `x`, row `y` from the bottom; `jitter` has the offsets of every sample.
    pub(crate) fn pixel(&self, x: u32, y: u32, jitter: &[[RBig; 2]]) -> Result<[u8; 3], Failure> {
        let mut sum = Vector::all(0);
        for offsets in jitter {
            sum = &sum + &self.sample(x, y, offsets)?;
        }
        let full = Real::ratio(RBig::from(255) / RBig::from(jitter.len()));
        let mut bytes = [0; 3];
        let mut colour = sum.scale(&full);
        if self.rules.fault == Some(Fault::Rounds) {
            let half = &Real::integer(1) / &Real::integer(2);
            colour = &colour + &Vector([half.clone(), half.clone(), half]);
        }
        for (byte, value) in bytes.iter_mut().zip(&colour.0) {
            *byte = value.byte()?;
        }
        Ok(bytes)
    }

    fn sample(&self, x: u32, y: u32, offsets: &[RBig; 2]) -> Result<Vector, Failure> {
        let camera = &self.scene.camera;
        let place = |i: usize, n: u32| {
            let side = RBig::try_from(camera.worlddim[i]).expect("finite");
            match camera.pixeldim[i] {
                1 => side / RBig::from(2),
                count => side * (RBig::from(n) + &offsets[i]) / RBig::from(count - 1),
            }
        };
        let screen = Vector([
            Real::ratio(place(0, x)),
            Real::ratio(place(1, y)),
            Real::integer(0),
        ]);
        let direction = (&screen - &self.viewpoint).settled();
        let length = direction.dot(&direction).settled().sqrt();
        let rays = Cell::new(0);
        let way = Way {
            before: Real::integer(0),
            last: None,
            mirrors: 0,
        };
        self.trace(&self.viewpoint, direction, length, way, &rays)
    }

    /// The colour of a ray.
    fn trace(
        &self,
        base: &Vector,
        direction: Vector,
        length: Real,
        way: Way,
        rays: &Cell<u32>,
    ) -> Result<Vector, Failure> {
        if !self.within_path(&way.before)? {
            return Ok(Vector::all(0));
        }
        let line = Line {
            hits: self.hits(base, &direction, way.last, None)?,
            direction,
            length,
            before: way.before,
            mirrors: way.mirrors,
        };
        self.follow(&line, 0, way.last, base, rays)
    }

    /// Whether a ray that starts after this path is followed.
    fn within_path(&self, path: &Real) -> Result<bool, Unresolved> {
        Ok(match path.compare(&self.max_path)? {
            Ordering::Less => true,
            Ordering::Equal => self.rules.fault != Some(Fault::PathEnds),
            Ordering::Greater => false,
        })
    }

    /// The colour of what remains of a line from its hit number `next`; it comes from `base`, which is on `last`.
    fn follow(
        &self,
        line: &Line,
        next: usize,
        last: Option<usize>,
        base: &Vector,
        rays: &Cell<u32>,
    ) -> Result<Vector, Failure> {
        rays.set(rays.get() + 1);
        if rays.get() > self.rules.max_rays || line.mirrors > self.rules.max_mirrors {
            return Err(Failure::TooManyRays);
        }
        let rest = line.hits.iter().enumerate().skip(next);
        let Some((next, hit, object)) = rest
            .filter_map(|(i, hit)| Some((i, hit, hit.met(last)?)))
            .next()
        else {
            return Ok(Vector::all(0));
        };
        let body = &self.bodies[object];
        let stuff = self.stuff(body);
        let total = &line.before + &(&hit.along * &line.length);
        let share = &Real::integer(1) / &total;
        let mut colour = self.ambient(body, &hit.point)?;
        if self.lamps.is_empty() {
            return Ok(colour.scale(&share));
        }
        let normal = normal(body, &hit.point);
        for lamp in &self.lamps {
            if let Some(term) = self.light(lamp, object, &hit.point, base, &normal)? {
                colour = &colour + &term;
            }
        }
        colour = colour.scale(&share);
        let material = &self.scene.materials[body.object.material];
        if material.transparency != 0.0 {
            colour = colour.scale(&stuff.opacity);
            if self.within_path(&total)? {
                let tint = &self.tile(body, &hit.point)?.tint;
                let through = self.follow(line, next + 1, Some(object), &hit.point, rays)?;
                colour = &colour + &through.times(tint).scale(&stuff.transparency);
            }
        }
        if material.specular != glam::DVec3::ZERO && self.within_path(&total)? {
            // 2(U·N)N − U with U = −D: as long as D.
            let square = normal.dot(&normal);
            let turn = &(&Real::integer(2) * &line.direction.dot(&normal)) / &square;
            let mirrored = &line.direction - &normal.scale(&turn);
            let seen = self.trace(
                &hit.point,
                mirrored,
                line.length.clone(),
                Way {
                    before: total.clone(),
                    last: Some(object),
                    mirrors: line.mirrors + 1,
                },
                rays,
            )?;
            colour = &colour + &seen.times(&stuff.specular);
        }
        Ok(colour)
    }

    /// What a light adds to a hit seen from `base`: diffuse and glint.
    fn light(
        &self,
        lamp: &Lamp,
        object: usize,
        hit: &Vector,
        base: &Vector,
        normal: &Vector,
    ) -> Result<Option<Vector>, Failure> {
        let body = &self.bodies[object];
        let to_lamp = &lamp.location - hit;
        let facing = match &body.form {
            // N·H is N·Q, which needs no hit.
            Form::Plane { normal, point, .. } => (&lamp.location - point).dot(normal),
            Form::Sphere { .. } | Form::Quadric(_) => to_lamp.dot(normal),
        };
        // Also where the light is at the hit: then this is 0.
        if !facing.is_positive()? {
            return Ok(None);
        }
        let square = to_lamp.dot(&to_lamp);
        if let Some(cone) = &lamp.cone {
            let along = -&to_lamp.dot(&cone.axis);
            let edge = &cone.cosine * &(&square * &cone.square).sqrt();
            let inside = along.compare(&edge)?;
            let edge_lit = self.rules.fault == Some(Fault::ConeEdgeLit);
            if inside != Ordering::Greater && !(edge_lit && inside == Ordering::Equal) {
                return Ok(None);
            }
        }
        let Some(emissivity) = self.emissivity(lamp, object, hit)? else {
            return Ok(None);
        };
        let Some(transmittance) = self.shadow(hit, &to_lamp, &lamp.location, object)? else {
            return Ok(None);
        };
        // E·c/dist = E·(L·N)/(|N|·L·L)
        let size = normal.dot(normal).sqrt();
        let light = &facing / &(&size * &square);
        let mut term = self
            .diffuse(body, hit)?
            .times(&emissivity)
            .times(&transmittance)
            .scale(&light);
        let material = &self.scene.materials[body.object.material];
        if material.shininess != 0.0 && material.specular != glam::DVec3::ZERO {
            // With unit u = (base − H)/|base − H| and d = L/|L|: h·N = (u·N + d·N)/(|u + d|·|N|).
            let to_base = base - hit;
            let far = to_base.dot(&to_base).sqrt();
            let dist = square.sqrt();
            let both = &(&to_base.dot(normal) / &far) + &(&facing / &dist);
            if both.is_positive()? {
                let cosine = &to_base.dot(&to_lamp) / &(&far * &dist);
                let sum = (&Real::integer(2) + &(&Real::integer(2) * &cosine)).sqrt();
                let shine = (&both / &(&sum * &size)).power(material.shininess)?;
                let bare = self.rules.fault == Some(Fault::GlintWithoutPicture);
                let glint = self
                    .stuff(body)
                    .specular
                    .times(if bare { &lamp.emissivity } else { &emissivity })
                    .scale(&shine);
                term = &term + &glint;
            }
        }
        Ok(Some(term))
    }

    /// How bright a lamp is for a hit: a projector's light has to pass its picture, and takes its colour.
    fn emissivity(
        &self,
        lamp: &Lamp,
        object: usize,
        hit: &Vector,
    ) -> Result<Option<Vector>, Failure> {
        let Some(slide) = &lamp.slide else {
            return Ok(Some(lamp.emissivity.clone()));
        };
        // On the picture's own plane N·H is N·Q, which needs no hit: f = 1.
        if slide.carrier == Some(self.bodies[object].carrier) {
            return Ok(None);
        }
        let over = (&slide.point - &lamp.location).dot(&slide.normal).settled();
        let way = hit - &lamp.location;
        let under = way.dot(&slide.normal);
        // Where the segment is parallel to the plane f is not defined; where the lamp lies in it, f is 0.
        if over.is_zero()? || under.is_zero()? {
            return Ok(None);
        }
        let part = &over / &under;
        let end = part.compare(&Real::integer(1))?;
        let behind = self.rules.fault == Some(Fault::PictureBehind);
        if !part.is_positive()? || end != Ordering::Less && !behind {
            return Ok(None);
        }
        let crossing = &lamp.location + &way.scale(&part);
        if !self.within_sides(&slide.sides, &slide.point, &crossing)? {
            return Ok(None);
        }
        let texture = (slide.texture, slide.mode);
        let texel = self.texel(texture, &slide.sides, &slide.point, &crossing)?;
        Ok(Some(lamp.emissivity.times(&texel)))
    }

    /// What of a light comes from `to_lamp` away, colour by colour; nothing behind what is opaque.
    fn shadow(
        &self,
        from: &Vector,
        to_lamp: &Vector,
        lamp: &Vector,
        last: usize,
    ) -> Result<Option<Vector>, Failure> {
        let mut transmittance = Vector::all(1);
        let mut last = last;
        for blocker in self.hits(from, to_lamp, Some(last), Some(lamp))? {
            let Some(object) = blocker.met(Some(last)) else {
                continue;
            };
            last = object;
            let body = &self.bodies[object];
            if self.scene.materials[body.object.material].transparency == 0.0 {
                return Ok(None);
            }
            let tile = self.tile(body, &blocker.point)?;
            // E∘K·(k/max(K)) is E∘(k·K/max(K)).
            transmittance = transmittance
                .times(&tile.tint)
                .scale(&self.stuff(body).transparency);
        }
        Ok(Some(transmittance))
    }
}

/// The normal at a hit, of any length.
fn normal(body: &Body<'_>, hit: &Vector) -> Vector {
    match &body.form {
        Form::Plane { normal, .. } => normal.clone(),
        Form::Sphere { center, .. } => hit - center,
        Form::Quadric(quadric) => quadric.gradient(hit),
    }
}

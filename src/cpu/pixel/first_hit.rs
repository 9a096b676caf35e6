//! What the ray through a place on the screen hits first: for people who ask, and for what a picture shows where.

use glam::DVec3;

use super::ExactTracer;
use crate::cpu::camera::{camera_getdir, inverse_distance};
use crate::cpu::hit_point::hit_point;
use crate::cpu::trace::find_closest_object;
use crate::prepare::Prepared;
use crate::real::{Bounded, Real, Undecided};
use crate::scene::Scene;

/// What the ray through a place on the screen hits first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstHit {
    /// Index of the object in the scene.
    pub object: usize,
    /// How far that is from the viewpoint, in world units, and how far off this may be: infinite where the hit is
    /// presumed.
    pub t: Bounded,
    /// Where, in world coordinates.
    pub at: DVec3,
}

/// The first hit, computed in one number type. Plain f64 takes itself for exact.
fn first_hit<R: Real>(
    scene: &Scene,
    prepared: &Prepared<R>,
    [x, y]: [f64; 2],
) -> Result<Option<FirstHit>, Undecided> {
    let ray = camera_getdir(&prepared.camera, x, y);
    let hit = find_closest_object(prepared, &ray)?;
    Ok(hit.map(|hit| {
        let t = R::exact(1.0) / inverse_distance(&prepared.camera, &ray, hit.inverse);
        let Bounded { value, error } = t.enclosure();
        // The bound is kept low by its own roundings until it is used.
        let error = error * Bounded::GROW;
        FirstHit {
            object: hit.object,
            t: Bounded { value, error },
            at: hit_point(scene, prepared, &ray, &hit),
        }
    }))
}

impl ExactTracer<'_> {
    /// What the ray through (x, y) hits first, counted from the bottom left, with fractions between pixels, in the
    /// cheapest numbers that tell; undecided only where exact numbers and f64 both do not.
    pub fn first_hit(&self, at: [f64; 2]) -> Result<Option<FirstHit>, Undecided> {
        if let Ok(hit) = first_hit(self.scene, &self.bounded, at) {
            return Ok(hit);
        }
        if let (Ok(hit), _) = self.exactly(|scene| Ok(first_hit(self.scene, scene, at)?)) {
            return Ok(hit);
        }
        let presumed = first_hit(self.scene, self.plain(), at)?;
        let unknown = |hit: FirstHit| {
            let error = f64::INFINITY;
            FirstHit {
                t: Bounded { error, ..hit.t },
                ..hit
            }
        };
        Ok(presumed.map(unknown))
    }
}

//! The ray from the viewpoint, as `plumb probe` shows it: where it runs, what every object answers to it, what it hits.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::cpu::camera::{Ray, camera_getdir, inverse_distance};
use crate::cpu::hit_point::hit_point;
use crate::cpu::plane::plane_hits;
use crate::cpu::quadric::quadric_hits;
use crate::cpu::sphere::sphere_hits;
use crate::cpu::trace::{Hit, Traced};
use crate::prepare::Prepared;
use crate::real::{Real, Undecided};
use crate::scene::Scene;

use super::answer::HitOrMiss;
use super::digits::{components, full, line, triple};
use super::why::ExactRay;

/// With more objects than this only hits are listed.
const LISTED: usize = 50;

/// A ray from the viewpoint, as the tracer has it and as it is exactly.
pub(super) struct PrimaryRay<'a> {
    scene: &'a Scene,
    prepared: &'a Prepared<f64>,
    screen_tolerance: f64,
    ray: Ray<f64>,
    exact: ExactRay,
}

impl<'a> PrimaryRay<'a> {
    /// Through pixel (x, y), counted from the bottom left, with fractions between pixels.
    pub(super) fn new(
        scene: &'a Scene,
        prepared: &'a Prepared<f64>,
        screen_tolerance: f64,
        [x, y]: [f64; 2],
    ) -> Self {
        Self {
            scene,
            prepared,
            screen_tolerance,
            ray: camera_getdir(&prepared.camera, x, y),
            exact: ExactRay::new(&scene.camera, x, y),
        }
    }

    /// Shows where the ray runs.
    pub(super) fn ray(&self, to: &mut dyn Write) -> io::Result<()> {
        let viewpoint = self.scene.camera.viewpoint.to_array();
        line(to, "world point", triple(self.exact.world_point()))?;
        line(to, "ray from", triple(viewpoint))?;
        line(to, "direction", triple(direction(&self.ray)))
    }

    /// What every object answered, in the order of the file; misses too if there are few objects, or `all` is wanted.
    pub(super) fn objects(&self, traced: &Traced<f64>, all: bool) -> Result<String, Undecided> {
        let Self {
            scene,
            prepared,
            screen_tolerance,
            ..
        } = self;
        let mut text = String::new();
        let hits = self.hits()?;
        let objects = &scene.objects;
        let with_misses = all || objects.len() <= LISTED;
        let widest = |width: fn(&crate::scene::Object) -> usize| {
            objects.iter().map(width).max().unwrap_or(0).min(24)
        };
        let (names, entities) = (
            widest(|object| object.name.chars().count()),
            widest(|object| object.entity().len()),
        );
        let closest = traced.hit.map(|hit| hit.object);
        let missed = hits.iter().filter(|hit| hit.is_none()).count();
        let _ = writeln!(
            text,
            "objects      {}, {} hit",
            objects.len(),
            objects.len() - missed
        );
        for (index, (object, hit)) in objects.iter().zip(&hits).enumerate() {
            if hit.is_none() && !with_misses {
                continue;
            }
            let mark = if closest == Some(index) { "*" } else { " " };
            let _ = write!(
                text,
                "  {mark} {:<names$}  {:<entities$}  ",
                object.name,
                object.entity()
            );
            let verdict = self.exact.ask(scene, index, *screen_tolerance);
            let _ = match (hit, verdict) {
                (Some(hit), verdict) => {
                    let point = hit_point(scene, prepared, &traced.ray, hit);
                    let t = 1.0 / inverse_distance(&prepared.camera, &self.ray, hit.inverse);
                    let doubt = match verdict {
                        HitOrMiss::Hit => String::new(),
                        HitOrMiss::Miss(reason) => format!(" (in f64; exactly: miss, {reason})"),
                    };
                    writeln!(
                        text,
                        "hit   t = {}, at {}{doubt}",
                        full(t),
                        triple(point.to_array())
                    )
                }
                (None, HitOrMiss::Miss(reason)) => writeln!(text, "miss  {reason}"),
                (None, HitOrMiss::Hit) => writeln!(
                    text,
                    "miss  (in f64; exactly: hit, by less than f64 can tell)"
                ),
            };
        }
        if missed > 0 && !with_misses {
            let _ = writeln!(text, "    misses not listed: {missed} (--all lists them)");
        }
        Ok(text)
    }

    /// The hit of every object, or none.
    fn hits(&self) -> Result<Vec<Option<Hit<f64>>>, Undecided> {
        let mut hits = vec![None; self.scene.objects.len()];
        let planes = self.prepared.planes.iter().enumerate();
        for (index, plane) in planes.chain(self.prepared.triangles.iter().enumerate()) {
            let inverse = plane_hits(plane, &self.ray, f64::NEG_INFINITY)?;
            hits[plane.object] = inverse.map(|inverse| Hit {
                inverse,
                object: plane.object,
                index,
            });
        }
        for (index, quadric) in self.prepared.quadrics.iter().enumerate() {
            let inverse = quadric_hits(quadric, &self.ray)?;
            hits[quadric.object] = inverse.map(|inverse| Hit {
                inverse,
                object: quadric.object,
                index,
            });
        }
        for (index, sphere) in self.prepared.spheres.iter().enumerate() {
            let inverse = sphere_hits(&self.prepared.camera, sphere, &self.ray)?;
            hits[sphere.object] = inverse.map(|inverse| Hit {
                inverse,
                object: sphere.object,
                index,
            });
        }
        Ok(hits)
    }

    /// What the ray hits first.
    pub(super) fn closest(&self, traced: &Traced<f64>, to: &mut dyn Write) -> io::Result<()> {
        let Self {
            scene, prepared, ..
        } = self;
        let Some(hit) = &traced.hit else {
            return line(to, "hit", "nothing".to_owned());
        };
        let object = &scene.objects[hit.object];
        let point = hit_point(scene, prepared, &traced.ray, hit);
        let t = 1.0 / inverse_distance(&prepared.camera, &self.ray, hit.inverse);
        line(
            to,
            "hit",
            format!("{} at {}", object.name, triple(point.to_array())),
        )?;
        line(to, "ambient", triple(components(traced.ambient)))?;
        line(to, "path length", full(t))
    }
}

/// The direction of a ray, of unit length.
pub(super) fn direction<R: Real>(ray: &Ray<R>) -> [f64; 3] {
    let length = ray.w2.to_f64().sqrt();
    ray.w.to_f64().to_array().map(|w| w / length)
}

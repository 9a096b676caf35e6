//! The truth that ways are measured against: the certified picture comes from `measure`; here are what primary rays hit
//! and where, and how many rays there are.

use rayon::prelude::*;
use serde::Serialize;

use crate::cpu::camera::camera_getdir;
use crate::cpu::light::Lit;
use crate::cpu::surface::Point;
use crate::cpu::trace::{
    Branch, Fault, Limits, TraceObserver, Unmet, find_closest_object, ray_trace,
};
use crate::prepare::Prepared;
use crate::real::rational::two_to;
use crate::real::{Bounded, Real, V3};
use crate::scene::Scene;
use crate::settings::Settings;

/// Distances are compared for at most about so many pixels: rows at regular distances in larger pictures.
const MOST_HITS: u64 = 1 << 21;
/// Rays are counted for at most about so many.
const MOST_COUNTED: u64 = 1 << 16;

/// What a primary ray meets first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstObject {
    /// Nothing.
    Nothing,
    /// The object with this index in the scene.
    Object(u32),
    /// That is not certain, or not this way's to say.
    Unsure,
}

/// What a pixel sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelHit {
    /// What its ray meets first.
    pub object: FirstObject,
    /// How far away, in world units; where an object is met.
    pub t: f64,
}

/// The rows of a picture whose distances are compared, from the bottom: all of a small one.
#[must_use]
pub fn rows(scene: &Scene) -> Vec<u32> {
    some_rows(scene, MOST_HITS)
}

fn some_rows(scene: &Scene, most: u64) -> Vec<u32> {
    let [width, height] = scene.camera.pixeldim;
    let every = (u64::from(width) * u64::from(height)).div_ceil(most).max(1);
    // From the middle of the first stretch of rows, so that neither edge counts for more.
    let first = (every / 2).min(u64::from(height) - 1) as u32;
    (first..height)
        .step_by(usize::try_from(every).unwrap_or(usize::MAX))
        .collect()
}

/// What the pixels of these rows see, row by row, from the left; and how far t may be off.
#[must_use]
pub fn hits(scene: &Scene, settings: &Settings, rows: &[u32]) -> Vec<(PixelHit, f64)> {
    let prepared = Prepared::<Bounded>::new(scene, settings.view());
    first_hits(&prepared, scene, rows, |t| {
        (t.value, t.error * Bounded::GROW)
    })
}

/// The same in plain f64.
#[must_use]
pub fn plain_hits(scene: &Scene, settings: &Settings, rows: &[u32]) -> Vec<PixelHit> {
    let prepared = Prepared::<f64>::new(scene, settings.view());
    let hits = first_hits(&prepared, scene, rows, |t| (t, 0.0));
    hits.into_iter().map(|(seen, _)| seen).collect()
}

fn first_hits<R: Real>(
    prepared: &Prepared<R>,
    scene: &Scene,
    rows: &[u32],
    known: impl Fn(R) -> (f64, f64) + Sync,
) -> Vec<(PixelHit, f64)> {
    let unit = two_to(prepared.camera.scale);
    let pixel = |x: u32, y: u32| {
        let ray = camera_getdir(&prepared.camera, f64::from(x), f64::from(y));
        let (object, t, error) = match find_closest_object(prepared, &ray) {
            Err(_) => (FirstObject::Unsure, 0.0, 0.0),
            Ok(None) => (FirstObject::Nothing, 0.0, 0.0),
            Ok(Some(hit)) => {
                let (t, error) = known(ray.w2.sqrt() / hit.inverse);
                (
                    FirstObject::Object(hit.object as u32),
                    t * unit,
                    error * unit,
                )
            }
        };
        (PixelHit { object, t }, error)
    };
    let width = scene.camera.pixeldim[0];
    rows.par_iter()
        .flat_map_iter(|&y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect()
}

/// Rays a pixel, on average.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rays {
    /// All of them: 1 and the two below.
    pub all: f64,
    /// Mirror images, and what is seen through things.
    pub secondary: f64,
    /// Towards lights that face the surface.
    pub shadow: f64,
    /// Pixels that were counted.
    pub pixels: u64,
}

/// Counts the rays that the scene asks for, in plain f64: whole trees, even where a pixel is white already. Where a
/// pixel needs more than allowed, those counted until then.
#[must_use]
pub fn rays(scene: &Scene, settings: &Settings) -> Rays {
    let [width, height] = scene.camera.pixeldim;
    if scene.lights.is_empty() {
        return Rays {
            all: 1.0,
            secondary: 0.0,
            shadow: 0.0,
            pixels: u64::from(width) * u64::from(height),
        };
    }
    let prepared = Prepared::<f64>::new(scene, settings.view());
    let limits = Limits {
        enough: f64::INFINITY,
        faint: 0.0,
        ..settings.limits
    };
    let rows = some_rows(scene, MOST_COUNTED);
    let counted = rows
        .par_iter()
        .map(|&y| {
            let mut count = Count::default();
            for x in 0..width {
                let traced = ray_trace(&prepared, &limits, f64::from(x), f64::from(y), &mut count);
                // What was counted up to there stands.
                let _: Result<_, Fault> = traced;
            }
            count
        })
        .reduce(Count::default, |a, b| Count {
            secondary: a.secondary + b.secondary,
            shadow: a.shadow + b.shadow,
        });
    let pixels = u64::from(width) * rows.len() as u64;
    let [secondary, shadow] = [counted.secondary, counted.shadow].map(|n| n as f64 / pixels as f64);
    Rays {
        all: 1.0 + secondary + shadow,
        secondary,
        shadow,
        pixels,
    }
}

/// Counts rays other than primary ones.
#[derive(Debug, Default)]
struct Count {
    secondary: u64,
    shadow: u64,
}

impl TraceObserver<f64> for Count {
    fn missed(&mut self, number: u32, _: &Branch<f64>, why: Unmet) {
        self.secondary += u64::from(number > 0 && why == Unmet::Nothing);
    }

    fn met(&mut self, number: u32, _: &Branch<f64>, _: f64, _: &Point<f64>, _: V3<f64>) {
        self.secondary += u64::from(number > 0);
    }

    fn light(&mut self, _: usize, lit: &Lit<f64>) {
        self.shadow += u64::from(matches!(lit, Lit::Shadowed(_) | Lit::Lit { .. }));
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::load_from;

    fn scene(text: &str) -> Scene {
        load_from("scene", text.as_bytes(), Path::new(".")).unwrap()
    }

    const CAMERA: &str = "camera c { pixeldim 3 3 worlddim 2 2 viewpoint 1 1 1 }
        material m { ambient 1 1 1 diffuse 1 1 1 specular 0.5 }
        plane back { material m normal 0 0 1 point 0 0 -2 }";

    #[test]
    fn the_middle_pixel_is_three_away() {
        let scene = scene(CAMERA);
        let rows = rows(&scene);
        assert_eq!(rows, [0, 1, 2]);
        let hits = hits(&scene, &Settings::default(), &rows);
        let (middle, error) = hits[4];
        assert_eq!(middle.object, FirstObject::Object(0));
        assert!((middle.t - 3.0).abs() <= error && error < 1e-14);
        // The corner's ray is √3 times as long.
        assert!((hits[0].0.t - 27f64.sqrt()).abs() < 1e-14);
        let plain = plain_hits(&scene, &Settings::default(), &rows);
        assert_eq!(plain[4], middle);
    }

    #[test]
    fn large_pictures_are_sampled_by_rows() {
        let mut scene = scene(CAMERA);
        scene.camera.pixeldim = [4096, 4096];
        let rows = rows(&scene);
        assert_eq!(rows.len(), 512);
        assert_eq!(rows[..2], [4, 12]);
        scene.camera.pixeldim = [1_000_000, 3];
        assert_eq!(super::rows(&scene), [1]);
    }

    #[test]
    fn rays_are_counted_as_the_rules_have_them() {
        let dark = rays(&scene(CAMERA), &Settings::default());
        assert_eq!((dark.all, dark.pixels), (1.0, 9));
        // Two lights before the wall and one behind it; the wall is a mirror that shows nothing.
        let lamp = |z: i32| format!("light l {{ location 1 1 {z} emissivity 1 1 1 }}");
        let lit = scene(&[CAMERA, &lamp(-1), &lamp(0), &lamp(-3)].join("\n"));
        let lit = rays(&lit, &Settings::default());
        assert_eq!((lit.secondary, lit.shadow, lit.all), (1.0, 2.0, 4.0));
    }
}

//! `plumb probe`: one pixel explained, from its ray to its bytes, by the reference tracer in f64.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use plumb::cpu::camera::{Ray, camera_getdir, camera_setpix, inverse_distance};
use plumb::cpu::debug::hit_point;
use plumb::cpu::plane::plane_hits;
use plumb::cpu::sphere::sphere_hits;
use plumb::cpu::trace::{Hit, Limits, Traced, Unwatched, ray_trace};
use plumb::prepare::Prepared;
use plumb::real::{Undecided, V3};
use plumb::scene::Scene;

use super::args::PictureOptions;
use super::why::{ExactRay, Verdict};
use super::{Answer, say, source};

/// With more objects than this only hits are listed.
const LISTED: usize = 50;

/// What `plumb probe` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Prints the ray, what every object answered to it, and the colour, all as the CPU's reference tracer has it in f64. Why \
an object is missed is found in exact arithmetic; where that disagrees with f64 it says so. The closest hit is marked *.")]
pub(crate) struct Args {
    /// The scene file; `-` is stdin
    scene: PathBuf,
    /// Column, from 0 at the left
    #[arg(allow_negative_numbers = true)]
    x: i64,
    /// Row, from 0 at the bottom
    #[arg(allow_negative_numbers = true)]
    y: i64,
    #[command(flatten)]
    picture: PictureOptions,
    /// List misses too, however many objects there are (up to 50 they are listed anyway)
    #[arg(long)]
    all: bool,
}

/// Explains the pixel.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let mut scene = source::load(&args.scene)?;
    args.picture.apply(&mut scene);
    let name = source::name(&args.scene);
    let [width, height] = scene.camera.pixeldim;
    let inside = |at: i64, pixels: u32| u32::try_from(at).ok().filter(|at| *at < pixels);
    let (Some(x), Some(y)) = (inside(args.x, width), inside(args.y, height)) else {
        bail!(
            "there is no pixel ({}, {}): columns are 0 to {}, rows 0 to {} from the bottom",
            args.x,
            args.y,
            width - 1,
            height - 1
        );
    };
    let probe = Probe::new(&scene, args.picture.screen_tolerance, x, y);
    let text = probe
        .text(&name, args.all)
        .map_err(|_| anyhow!("pixel ({x}, {y}) is out of f64's range"))?;
    say::data(&text)?;
    Ok(Answer::Yes)
}

/// A pixel of a scene.
struct Probe<'a> {
    scene: &'a Scene,
    prepared: Prepared<f64>,
    screen_tolerance: f64,
    x: u32,
    y: u32,
    ray: Ray<f64>,
    exact: ExactRay,
}

impl<'a> Probe<'a> {
    fn new(scene: &'a Scene, screen_tolerance: f64, x: u32, y: u32) -> Self {
        let prepared = Prepared::new(scene, screen_tolerance);
        let ray = camera_getdir(&prepared.camera, f64::from(x), f64::from(y));
        let exact = ExactRay::new(&scene.camera, x, y);
        Self {
            scene,
            prepared,
            screen_tolerance,
            x,
            y,
            ray,
            exact,
        }
    }

    fn text(&self, name: &str, all: bool) -> Result<String, Undecided> {
        let [width, height] = self.scene.camera.pixeldim;
        let traced = ray_trace(&self.prepared, &Limits::default(), f64::from(self.x), f64::from(self.y), &mut Unwatched).map_err(|_| Undecided)?;
        let length = self.ray.w2.sqrt();
        let direction = self.ray.w.approx().to_array().map(|w| w / length);
        let mut text = String::new();
        let mut line = |what: &str, value: String| {
            let _ = writeln!(text, "{what:<13}{value}");
        };
        line(
            "scene",
            format!(
                "{name}, {width}×{height}, screen tolerance {}",
                self.screen_tolerance
            ),
        );
        line(
            "pixel",
            format!("({}, {}) from the bottom left", self.x, self.y),
        );
        line("world point", triple(self.exact.world_point()));
        line("ray from", triple(self.scene.camera.viewpoint.to_array()));
        line("direction", triple(direction));
        self.objects(&mut text, &traced, all)?;
        self.colour(&mut text, &traced)?;
        Ok(text)
    }

    /// What every object answered, in the order of the file.
    fn objects(&self, text: &mut String, traced: &Traced<f64>, all: bool) -> Result<(), Undecided> {
        let hits = self.hits()?;
        let objects = &self.scene.objects;
        let with_misses = all || objects.len() <= LISTED;
        let widest = |width: fn(&plumb::scene::Object) -> usize| {
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
            let verdict = self.exact.ask(self.scene, index, self.screen_tolerance);
            let _ = match (hit, verdict) {
                (Some(hit), verdict) => {
                    let point = hit_point(self.scene, &self.prepared, traced, hit);
                    let t = 1.0 / inverse_distance(&self.prepared.camera, &self.ray, hit.inverse);
                    let doubt = match verdict {
                        Verdict::Hit => String::new(),
                        Verdict::Miss(reason) => format!(" (in f64; exactly: miss, {reason})"),
                    };
                    writeln!(
                        text,
                        "hit   t = {}, at {}{doubt}",
                        digits(t),
                        triple(point.to_array())
                    )
                }
                (None, Verdict::Miss(reason)) => writeln!(text, "miss  {reason}"),
                (None, Verdict::Hit) => writeln!(
                    text,
                    "miss  (in f64; exactly: hit, by less than f64 can tell)"
                ),
            };
        }
        if missed > 0 && !with_misses {
            let _ = writeln!(text, "    misses not listed: {missed} (--all lists them)");
        }
        Ok(())
    }

    /// The hit of every object, or none.
    fn hits(&self) -> Result<Vec<Option<Hit<f64>>>, Undecided> {
        let mut hits = vec![None; self.scene.objects.len()];
        for (index, plane) in self.prepared.planes.iter().enumerate() {
            let inverse = plane_hits(plane, &self.ray)?;
            hits[plane.object] = inverse.map(|inverse| Hit {
                inverse,
                object: plane.object,
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

    /// From the closest hit to the bytes.
    fn colour(&self, text: &mut String, traced: &Traced<f64>) -> Result<(), Undecided> {
        let mut line = |what: &str, value: String| {
            let _ = writeln!(text, "{what:<13}{value}");
        };
        match &traced.hit {
            None => line("hit", "nothing".to_owned()),
            Some(hit) => {
                let object = &self.scene.objects[hit.object];
                let point = hit_point(self.scene, &self.prepared, traced, hit);
                let t = 1.0 / inverse_distance(&self.prepared.camera, &self.ray, hit.inverse);
                line(
                    "hit",
                    format!("{} at {}", object.name, triple(point.to_array())),
                );
                line("ambient", triple(components(traced.ambient)));
                line("path length", digits(t));
            }
        }
        line("colour", triple(components(traced.color)));
        let [r, g, b] = camera_setpix(traced.color)?;
        line("bytes", format!("{r} {g} {b}"));
        Ok(())
    }
}

fn components(v: V3<f64>) -> [f64; 3] {
    [v.x, v.y, v.z]
}

fn triple(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(digits);
    format!("({x}, {y}, {z})")
}

/// C's `%.17g` less trailing zeros: every digit that tells an f64 from its neighbours, and never "-0".
fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.16e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-5..17).contains(&power) {
        let decimals = (16 - power).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// Without zeros at the end of the fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_enough_and_not_more() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.25, "1.25"),
            (-4.0, "-4"),
            (0.1, "0.10000000000000001"),
            (1.0 / 3.0, "0.33333333333333331"),
            (100.0, "100"),
            (1e300, "1.0000000000000001e300"),
            (-2.5e-7, "-2.4999999999999999e-7"),
        ] {
            assert_eq!(digits(value), text, "{value:?}");
        }
        for value in [
            std::f64::consts::PI,
            1.0 / 7.0,
            6.02e23,
            1.6e-19,
            123_456.789,
        ] {
            assert_eq!(digits(value).parse(), Ok(value));
        }
    }
}

//! `plumb probe`: one pixel explained, from its rays to its bytes, by the reference tracer in f64.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use plumb::cpu::camera::{Ray, camera_getdir, camera_setpix, inverse_distance};
use plumb::cpu::debug::hit_point;
use plumb::cpu::pixel::{Jitter, Sampling, Stages};
use plumb::cpu::plane::plane_hits;
use plumb::cpu::sphere::sphere_hits;
use plumb::cpu::trace::{Fault, Hit, Limits, Traced, Unwatched, ray_trace};
use plumb::jitter;
use plumb::prepare::{Prepared, View};
use plumb::real::{Undecided, V3};
use plumb::render::PixelFault;
use plumb::scene::Scene;

use super::args::PictureOptions;
use super::digits::{components, full, short, triple};
use super::tree::Tree;
use super::why::{ExactRay, Verdict};
use super::{Answer, say, source};

/// With more objects than this only hits are listed.
const LISTED: usize = 50;
/// More samples than this are only counted.
const SHOWN_SAMPLES: usize = 200;

/// What `plumb probe` takes.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "See `plumb probe --help` for how to read the answer.",
    after_long_help = "\
EXAMPLES
  plumb probe scene.txt 100 40           the pixel 100 from the left, 40 from the bottom
  plumb probe scene.txt 100 40 --samples 16             its samples and their mean
  plumb probe scene.txt 100 40 --samples 16 --sample 3  and the rays of one of them

HOW TO READ IT
  Give the options that the picture was rendered with: the last line is its bytes. All else is what the CPU's
  reference tracer has in f64.

  objects   What every object answered to the ray from the viewpoint; the closest hit is marked *. Why an object is
            missed is found in exact arithmetic; where that disagrees with f64 it says so.

  rays      In a scene with lights: every ray, each below the one that it comes from. `primary` left the viewpoint,
            `through 3` went straight through what ray 3 met, `mirror in 3` is the mirror image seen there. Of each:
            what it met, where, and at which distance t; its weight, which is what its colour counts for; the path,
            which is the sum of the distances so far; the ambient reflectivity there; and for each light

              diffuse  what the light adds: diffuse reflectivity ∘ its emissivity ∘ filter · cosine / distance
              glint    the highlight, if there is one
              filter   the share of light that comes through transparent objects in between, if there are any

            or why it adds nothing. Then the ray adds to the colour

              weight ∘ (ambient + all diffuse + all glints) · (1 − transparency) / path

            (∘ is channel by channel). Numbers in the tree have nine digits, which tell an f32 from its neighbours.

  colour    The sum of what the rays add, or the mean of the samples; 1 is full brightness. Then 255 times that, and
            the bytes: cut off, not rounded."
)]
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
    /// With --samples: show the rays of this one, counted from 0
    #[arg(long, value_name = "I")]
    sample: Option<u32>,
    /// Show everything: misses of more than 50 objects, more than 200 rays or samples, each of more than 50 lights
    #[arg(long)]
    all: bool,
}

/// Explains the pixel.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let samples = args.picture.samples;
    match args.sample {
        Some(_) if samples == 1 => {
            bail!("--sample picks one of several samples: say with --samples how many there are")
        }
        Some(sample) if sample >= samples => {
            bail!("--sample {sample}: there are {samples} samples, counted from 0")
        }
        _ => {}
    }
    let mut scene = source::load(&args.scene)?;
    args.picture.apply(&mut scene);
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
    args.picture.check(&scene)?;
    let probe = Probe::new(&scene, args, x, y);
    let name = source::name(&args.scene);
    let mut ended = Ok(());
    say::stream(|to| {
        ended = probe.write(&name, to)?;
        Ok(())
    })?;
    match ended {
        Ok(()) => Ok(Answer::Yes),
        // What was shown up to there is what one wants to see of such a pixel.
        Err(Fault::TooManyRays) => {
            let max_rays = probe.limits.max_rays;
            Err(PixelFault { x, y, max_rays }.into())
        }
        Err(Fault::Undecided) => Err(anyhow!("pixel ({x}, {y}) is out of f64's range")),
    }
}

/// A pixel of a scene.
struct Probe<'a> {
    scene: &'a Scene,
    view: View,
    prepared: Prepared<f64>,
    picture: &'a PictureOptions,
    limits: Limits,
    jitter: Jitter,
    all: bool,
    chosen: Option<u32>,
    x: u32,
    y: u32,
}

/// How the explanation of a pixel ends: if not in a fault of writing, perhaps in one of the tracer's.
type Ended = io::Result<Result<(), Fault>>;

impl<'a> Probe<'a> {
    fn new(scene: &'a Scene, args: &'a Args, x: u32, y: u32) -> Self {
        let settings = args.picture.settings();
        let view = View::new(settings.screen_tolerance, settings.samples);
        Self {
            scene,
            view,
            prepared: Prepared::new(scene, view),
            picture: &args.picture,
            limits: settings.sample_limits(),
            jitter: settings.sampling(scene.camera.pixeldim[0], y + 1),
            all: args.all,
            chosen: args.sample,
            x,
            y,
        }
    }

    fn write(&self, name: &str, to: &mut dyn Write) -> Ended {
        let [width, height] = self.scene.camera.pixeldim;
        let tolerance = self.picture.screen_tolerance;
        line(
            to,
            "scene",
            format!("{name}, {width}×{height}, screen tolerance {tolerance}"),
        )?;
        line(
            to,
            "pixel",
            format!("({}, {}) from the bottom left", self.x, self.y),
        )?;
        let row = self.jitter.row(self.y);
        let columns = width as usize;
        let sampling = self.jitter.pixel(row.as_deref(), columns, self.x as usize);
        let color = match self.offsets(sampling) {
            None => self.one([0.0; 2], to)?,
            Some(offsets) => self.several(&offsets, to)?,
        };
        let color = match color {
            Ok(color) => color,
            Err(fault) => return Ok(Err(fault)),
        };
        line(to, "colour", triple(components(color)))?;
        if self.prepared.world.is_some() || self.picture.samples > 1 {
            line(
                to,
                "times 255",
                triple(components(color).map(|c| 255.0 * c)),
            )?;
        }
        // As rendering has them, whatever it does to be sure of them.
        let stages = Stages::new(self.scene, self.view);
        let bytes = match stages.trace(&self.limits, sampling, self.x, self.y) {
            Ok((_, bytes)) => bytes,
            Err(_) => return Ok(Err(Fault::TooManyRays)),
        };
        let [r, g, b] = bytes;
        let doubt = match camera_setpix(color) {
            Ok(same) if same == bytes => String::new(),
            Ok([r, g, b]) => format!(" (f64 alone: {r} {g} {b})"),
            Err(Undecided) => " (f64 alone cannot tell)".to_owned(),
        };
        line(to, "bytes", format!("{r} {g} {b}{doubt}"))?;
        Ok(Ok(()))
    }

    /// The offsets of the samples, if there are several.
    fn offsets(&self, sampling: Sampling<'_>) -> Option<Vec<[f64; 2]>> {
        let hash = |sample| jitter::hash(self.x, self.y, sample);
        match sampling {
            Sampling::Once => None,
            Sampling::Hash(samples) => Some((0..samples).map(hash).collect()),
            Sampling::Given(offsets) => Some(offsets.to_vec()),
        }
    }

    /// Shows the chosen sample, then what each brings; returns their mean.
    fn several(
        &self,
        offsets: &[[f64; 2]],
        to: &mut dyn Write,
    ) -> io::Result<Result<V3<f64>, Fault>> {
        if let Some(sample) = self.chosen {
            let offset = offsets[sample as usize];
            line(
                to,
                "sample",
                format!("{sample} of {}, {}", offsets.len(), place(offset)),
            )?;
            match self.one(offset, to)? {
                Ok(color) => line(to, "brings", triple(components(color)))?,
                Err(fault) => return Ok(Err(fault)),
            }
        }
        line(
            to,
            "samples",
            format!(
                "{}, spread by {}",
                offsets.len(),
                self.picture.jitter.meaning()
            ),
        )?;
        let mut sum = V3::new(0.0, 0.0, 0.0);
        for (sample, offset) in offsets.iter().enumerate() {
            let traced = self.trace(*offset);
            if self.all || sample < SHOWN_SAMPLES || traced.is_err() {
                let brings = match &traced {
                    Ok(traced) => triple(components(traced.color)),
                    Err(Fault::TooManyRays) => {
                        format!("needs more than {} rays", self.limits.max_rays)
                    }
                    Err(Fault::Undecided) => "out of f64's range".to_owned(),
                };
                writeln!(to, "  {sample:>5}  {}  {brings}", place(*offset))?;
            }
            match traced {
                Ok(traced) => sum = sum + traced.color,
                Err(fault) => return Ok(Err(fault)),
            }
        }
        if !self.all && offsets.len() > SHOWN_SAMPLES {
            let more = offsets.len() - SHOWN_SAMPLES;
            writeln!(to, "    … and {more} more (--all lists them)")?;
        }
        if self.chosen.is_none() {
            writeln!(to, "    (--sample I shows the rays of sample I)")?;
        }
        let n = offsets.len() as f64;
        Ok(Ok(V3::new(sum.x / n, sum.y / n, sum.z / n)))
    }

    /// Traces the sample that is so far from the middle of the pixel.
    fn trace(&self, [a, b]: [f64; 2]) -> Result<Traced<f64>, Fault> {
        let (x, y) = (f64::from(self.x) + a, f64::from(self.y) + b);
        ray_trace(&self.prepared, &self.limits, x, y, &mut Unwatched)
    }

    /// Shows all about one sample, and returns its colour.
    fn one(&self, [a, b]: [f64; 2], to: &mut dyn Write) -> io::Result<Result<V3<f64>, Fault>> {
        let (x, y) = (f64::from(self.x) + a, f64::from(self.y) + b);
        let ray = camera_getdir(&self.prepared.camera, x, y);
        let sight = Sight {
            probe: self,
            exact: ExactRay::new(&self.scene.camera, x, y),
            ray,
        };
        let length = ray.w2.sqrt();
        let direction = ray.w.approx().to_array().map(|w| w / length);
        line(to, "world point", triple(sight.exact.world_point()))?;
        line(
            to,
            "ray from",
            triple(self.scene.camera.viewpoint.to_array()),
        )?;
        line(to, "direction", triple(direction))?;
        // The primary ray is traced once for what it hits, and once more for the tree, whose rays may be too many.
        let first = Limits {
            max_path: 0.0,
            ..self.limits
        };
        let traced = match ray_trace(&self.prepared, &first, x, y, &mut Unwatched) {
            Ok(traced) => traced,
            Err(fault) => return Ok(Err(fault)),
        };
        let objects = match sight.objects(&traced) {
            Ok(text) => text,
            Err(undecided) => return Ok(Err(undecided.into())),
        };
        to.write_all(objects.as_bytes())?;
        sight.closest(&traced, to)?;
        if self.prepared.world.is_none() || traced.hit.is_none() {
            return Ok(Ok(traced.color));
        }
        line(
            to,
            "rays",
            format!(
                "up to a path of {}, and at most {} of them",
                self.limits.max_path, self.limits.max_rays
            ),
        )?;
        let max_path = self.limits.max_path;
        let mut tree = Tree::new(self.scene, &self.prepared, max_path, self.all, to);
        let traced = ray_trace(&self.prepared, &self.limits, x, y, &mut tree);
        tree.finish()?;
        Ok(traced.map(|traced| traced.color))
    }
}

/// A ray from the viewpoint, as the tracer has it and as it is exactly.
struct Sight<'a> {
    probe: &'a Probe<'a>,
    ray: Ray<f64>,
    exact: ExactRay,
}

impl Sight<'_> {
    /// What every object answered, in the order of the file.
    fn objects(&self, traced: &Traced<f64>) -> Result<String, Undecided> {
        let Probe {
            scene,
            prepared,
            picture,
            all,
            ..
        } = self.probe;
        let mut text = String::new();
        let hits = self.hits()?;
        let objects = &scene.objects;
        let with_misses = *all || objects.len() <= LISTED;
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
            let verdict = self.exact.ask(scene, index, picture.screen_tolerance);
            let _ = match (hit, verdict) {
                (Some(hit), verdict) => {
                    let point = hit_point(scene, prepared, traced, hit);
                    let t = 1.0 / inverse_distance(&prepared.camera, &self.ray, hit.inverse);
                    let doubt = match verdict {
                        Verdict::Hit => String::new(),
                        Verdict::Miss(reason) => format!(" (in f64; exactly: miss, {reason})"),
                    };
                    writeln!(
                        text,
                        "hit   t = {}, at {}{doubt}",
                        full(t),
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
        Ok(text)
    }

    /// The hit of every object, or none.
    fn hits(&self) -> Result<Vec<Option<Hit<f64>>>, Undecided> {
        let mut hits = vec![None; self.probe.scene.objects.len()];
        for (index, plane) in self.probe.prepared.planes.iter().enumerate() {
            let inverse = plane_hits(plane, &self.ray)?;
            hits[plane.object] = inverse.map(|inverse| Hit {
                inverse,
                object: plane.object,
                index,
            });
        }
        for (index, sphere) in self.probe.prepared.spheres.iter().enumerate() {
            let inverse = sphere_hits(&self.probe.prepared.camera, sphere, &self.ray)?;
            hits[sphere.object] = inverse.map(|inverse| Hit {
                inverse,
                object: sphere.object,
                index,
            });
        }
        Ok(hits)
    }

    /// What the ray hits first.
    fn closest(&self, traced: &Traced<f64>, to: &mut dyn Write) -> io::Result<()> {
        let Probe {
            scene, prepared, ..
        } = self.probe;
        let Some(hit) = &traced.hit else {
            return line(to, "hit", "nothing".to_owned());
        };
        let object = &scene.objects[hit.object];
        let point = hit_point(scene, prepared, traced, hit);
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

/// A line with its heading.
fn line(to: &mut dyn Write, what: &str, value: String) -> io::Result<()> {
    writeln!(to, "{what:<13}{value}")
}

/// Where in its pixel a sample is.
fn place([a, b]: [f64; 2]) -> String {
    format!("at ({}, {})", short(a), short(b))
}

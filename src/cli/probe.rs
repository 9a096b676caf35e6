//! `plumb probe`: one pixel explained, from its rays to its bytes, by the reference tracer in f64.

use std::io::{self, Write};
use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use plumb::certify::verdict::meaning;
use plumb::cpu::camera::camera_setpix;
use plumb::cpu::pixel::Stages;
use plumb::cpu::trace::{Fault, Limits, Traced, Unwatched, ray_trace};
use plumb::gpu::single::Single;
use plumb::jitter;
use plumb::jitter::{Jitter, Sampling};
use plumb::prepare::{Prepared, View};
use plumb::real::{Undecided, V3};
use plumb::render::PixelFault;
use plumb::scene::Scene;
use serde_json::json;

use super::args::PictureOptions;
use super::digits::{components, line, short, short_triple, triple};
use super::sight::Sight;
use super::tree::Tree;
use super::verdict::{self, Verdict};
use super::{Answer, SOFTWARE, say, source};

/// More samples than this are only counted.
const SHOWN_SAMPLES: usize = 200;

const HOW_TO_READ: &str = "\
EXAMPLES
  plumb probe scene.txt 100 40                the pixel in column 100, row 40
  plumb probe scene.txt 100 40 --samples 16   its samples, and their mean
  plumb probe scene.txt 100 40 --samples 16 --sample 3
                                              and the rays of one of them

HOW TO READ IT
  Give the options that the picture was rendered with: the bytes are those of
  the certified picture. All above them is what the CPU's reference tracer has
  in f64.

  objects  What every object answered to the ray from the viewpoint; the closest
           hit is marked *. Why an object is missed is found in exact arithmetic;
           where that disagrees with f64 it says so.

  rays     In a scene with lights: every ray, below the one that it comes from.
           `primary` left the viewpoint, `through 3` went straight through what
           ray 3 met, `mirror in 3` is the mirror image seen there. Of each: what
           it met and where, at which distance t; its weight, which is how much
           it counts; the path, the sum of the distances up to there; the ambient
           reflectivity. Then what each light adds

             diffuse  reflectivity ∘ emissivity ∘ filter · cosine / distance
             glint    the highlight, where there is one
             filter   the share of light that comes through transparent things

           or why it adds nothing. With all that the ray adds to the colour

             weight ∘ (ambient + diffuse + glint) · (1 − transparency) / path

           where ∘ is channel by channel. Numbers there have nine digits, which
           tell an f32 from its neighbours.

  colour   The sum of what the rays add, or the mean of the samples; 1 is full
           brightness. Then 255 times that; then the bytes, which are cut off,
           not rounded.

  decided by  What the CPU needed to be sure of the bytes: f64 with error bounds,
           intervals of many bits, exact arithmetic.

  f64      255 times the colour in f64, and how far off that may be: the first
           thing that the CPU tries.

  GPU      Whether the GPU is sure of the bytes by itself, or in doubt; then the
           CPU decides. Below, 255 times its colour in f32, and its bound: a byte
           is sure where no whole number is as near.";

/// What `plumb probe` takes.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "See `plumb probe --help` for how to read the answer.",
    after_long_help = HOW_TO_READ
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
    /// Print the outcome alone, as JSON: value, bytes, what decided them, what the GPU says
    #[arg(long, conflicts_with_all = ["all", "sample"])]
    json: bool,
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
    if args.json {
        say::data(&probe.json(&name)?)?;
        return Ok(Answer::Yes);
    }
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
        let decided = match stages.trace(&self.limits, sampling, self.x, self.y) {
            Ok(decided) => decided,
            Err(_) => return Ok(Err(Fault::TooManyRays)),
        };
        let bytes = decided.bytes;
        let [r, g, b] = bytes;
        let doubt = match camera_setpix(color) {
            Ok(same) if same == bytes => String::new(),
            Ok([r, g, b]) => format!(" (f64 alone: {r} {g} {b})"),
            Err(Undecided) => " (f64 alone cannot tell)".to_owned(),
        };
        line(to, "bytes", format!("{r} {g} {b}{doubt}"))?;
        line(to, "decided by", meaning(decided.stage).to_owned())?;
        let rough = stages.rough(&self.limits, sampling, self.x, self.y);
        line(
            to,
            "f64",
            rough.map_or_else(
                || "leaves open what the rays meet".to_owned(),
                |v| within(v.map(|c| 255.0 * c.value), v.map(|c| 255.0 * c.error)),
            ),
        )?;
        line(to, "GPU", self.gpu().to_string())?;
        if let Some(Single { value, error }) = self.single() {
            line(
                to,
                "GPU's f32",
                within(value.map(f64::from), error.map(f64::from)),
            )?;
        }
        Ok(Ok(()))
    }

    /// The same in short, for programs.
    fn json(&self, name: &str) -> Result<String> {
        let [width, height] = self.scene.camera.pixeldim;
        let row = self.jitter.row(self.y);
        let sampling = self
            .jitter
            .pixel(row.as_deref(), width as usize, self.x as usize);
        let stages = Stages::new(self.scene, self.view);
        let decided = stages.trace(&self.limits, sampling, self.x, self.y)?;
        let rough = stages.rough(&self.limits, sampling, self.x, self.y);
        let value = json!({
            "software": SOFTWARE,
            "scene": name,
            "size": [width, height],
            "pixel": [self.x, self.y],
            "value": decided.value,
            "bytes": decided.bytes,
            "decided": decided.stage.name(),
            "f64": rough.map(|v| json!({
                "value": v.map(|c| c.value),
                "bound": v.map(|c| c.error),
            })),
            "gpu": self.gpu().to_string(),
            "f32": self.single().map(|Single { value, error }| json!({
                "value": value.map(|c| f64::from(c) / 255.0),
                "bound": error.map(|c| f64::from(c) / 255.0),
            })),
        });
        Ok(format!("{value:#}\n"))
    }

    /// What the GPU has to say of the pixel.
    fn gpu(&self) -> Verdict {
        verdict::ask(self.scene, &self.picture.settings(), self.x, self.y)
    }

    /// What it has before it quantises, and how far off it may be; of a single sample.
    fn single(&self) -> Option<Single> {
        let settings = self.picture.settings();
        (settings.samples == 1)
            .then(|| verdict::value(self.scene, &settings, self.x, self.y))
            .flatten()
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
        let tolerance = self.picture.screen_tolerance;
        let sight = Sight::new(self.scene, &self.prepared, tolerance, [x, y]);
        sight.ray(to)?;
        // The primary ray is traced once for what it hits, and once more for the tree, whose rays may be too many.
        let first = Limits {
            max_path: 0.0,
            ..self.limits
        };
        let traced = match ray_trace(&self.prepared, &first, x, y, &mut Unwatched) {
            Ok(traced) => traced,
            Err(fault) => return Ok(Err(fault)),
        };
        let objects = match sight.objects(&traced, self.all) {
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

/// 255 times a colour, and its bound.
fn within(value: [f64; 3], bound: [f64; 3]) -> String {
    let bound = bound.map(|b| format!("{b:.1e}"));
    format!(
        "{} times 255, off by at most ({})",
        short_triple(value),
        bound.join(", ")
    )
}

/// Where in its pixel a sample is.
fn place([a, b]: [f64; 2]) -> String {
    format!("at ({}, {})", short(a), short(b))
}

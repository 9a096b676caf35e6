//! `plumb probe`: one pixel explained, from its rays to its bytes, by the reference tracer in f64. The library's
//! [`Probe`] does; here are its arguments, and what is printed.

use std::path::PathBuf;

use anyhow::{Result, bail};
use plumb::gpu::adapters;
use plumb::gpu::single::Single;
use plumb::probe::{AskGpu, Facts, GpuVerdict, Options, Probe};
use plumb::render::Settings;
use plumb::scene::Scene;
use serde_json::json;

use super::args::PictureOptions;
use super::values::{pixel, whole};
use super::{Answer, SOFTWARE, cache, say, source};

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

  f64      255 v, v being the colour in f64, and how far off that may be: the
           first thing that the CPU tries.

  GPU      Whether the GPU is sure of the bytes by itself, or in doubt; then the
           CPU decides. Below, 255 v of its colour in f32, and its bound: a byte
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
    #[arg(allow_negative_numbers = true, value_parser = pixel)]
    x: i64,
    /// Row, from 0 at the bottom
    #[arg(allow_negative_numbers = true, value_parser = pixel)]
    y: i64,
    #[command(flatten)]
    picture: PictureOptions,
    /// With --samples: show the rays of this one, counted from 0
    #[arg(long, value_name = "I", value_parser = whole(0..=u32::MAX))]
    sample: Option<u32>,
    /// Show everything: misses of more than 50 objects, more than 200 rays or samples, each of more than 50 lights
    #[arg(long)]
    all: bool,
    /// Print the outcome alone, as JSON: value, bytes, what decided them, what the GPU says
    #[arg(
        long,
        conflicts_with_all = ["all", "sample"],
        long_help = "\
Print the outcome alone, as JSON. Colours are red, green, blue, and 1 is full brightness.

  value     the f32 nearest to the exact colour, which an EXR picture holds
  bytes     the certified picture's, and `decided`: what the CPU needed for them
  f64       the colour in f64, and how far off that may be
  gpu       whether the GPU is sure of the bytes
  f32       the colour in the GPU's f32, and how far off that may be"
    )]
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
    let settings = Settings {
        cache: cache::folder(),
        ..args.picture.settings()
    };
    let gpu = adapters::shared(settings.adapter.as_deref());
    let probe = Probe::new(&scene, &settings, gpu.as_deref());
    let name = source::name(&args.scene);
    if args.json {
        let facts = probe.facts([x, y], AskGpu::ValueAndVerdict)?;
        say::data(&json(&name, &scene, &facts)?)?;
        return Ok(Answer::Yes);
    }
    let options = Options {
        all: args.all,
        sample: args.sample,
        gpu: AskGpu::ValueAndVerdict,
    };
    let mut ended = Ok(());
    say::stream(|to| {
        ended = probe.write(&name, [x, y], options, to)?;
        Ok(())
    })?;
    // What was shown up to there is what one wants to see of a pixel that needs too many rays.
    ended?;
    Ok(Answer::Yes)
}

/// The outcome, for programs.
fn json(name: &str, scene: &Scene, facts: &Facts) -> Result<String> {
    let decided = facts.decided?;
    let value = json!({
        "software": SOFTWARE,
        "scene": name,
        "size": scene.camera.pixeldim,
        "pixel": facts.pixel,
        "value": decided.value,
        "bytes": decided.bytes,
        "decided": decided.by.name(),
        "f64": facts.enclosure.map(|v| json!({
            "value": v.map(|c| c.value),
            "bound": v.map(|c| c.error),
        })),
        "gpu": facts.verdict.as_ref().map(GpuVerdict::to_string),
        "f32": facts.single.map(|Single { value, error }| json!({
            "value": value.map(|c| f64::from(c) / 255.0),
            "bound": error.map(|c| f64::from(c) / 255.0),
        })),
    });
    Ok(format!("{value:#}\n"))
}

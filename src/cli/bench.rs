//! `plumb bench`: every way to render a scene, its error against its time.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use plumb::bench::measure::Unmeasured;
use plumb::bench::{Asked, BenchError, bench, plot, table};
use plumb::files::is_same_file;
use plumb::image::{Document, Target};
use plumb::render;
use plumb::scene::Scene;

use super::progress::Progress;
use super::values::{size, whole};
use super::{Answer, SOFTWARE, cache, say, source};

/// More pixels than this would fill memory: several pictures are held at a time.
const MOST_PIXELS: u64 = 100_000_000;

/// What `plumb bench` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
WAYS
  GPU certified  plumb render: f32 with error bounds on the GPU, the CPU for the
                 pixels that the GPU is not sure of
  GPU fast       plumb render --precision fast: the GPU's f32 as it comes
  CPU certified  plumb render --backend cpu: f64 with error bounds, in the end
                 exact; its picture is the truth that the others are held against
  CPU plain f64  the same tracer without bounds
  f32 b²−4ac     a textbook's shader whose scene is prepared in f64 on the host:
                 the notes' quadratic formula where plumb takes the perpendicular
  f32 naive      the same with nothing prepared: the scene's numbers in f32
The last three are there to be compared with, and cannot be rendered with. The
textbook's two ask every object for every ray, and stop at 1,000 spheres.

ERRORS
  wrong pixels, the worst channel and the RMS, in bytes, against the certified
  picture; the error of the distance t along primary rays that see the right
  object, in units in the last place of f32; pixels that see another object;
  pixels that the GPU left to the CPU.

TIMES
  kernel  the dispatches, by the GPU's own clock where it has one, of a shader
          that is compiled and has run; on the CPU the tracing
  frame   from the scene to the bytes: preparing, compiling, tracing, reading back
  cold    plumb render as a process of its own, seen from outside, with all caches
          of shaders and devices empty (XDG_CACHE_HOME and what drivers ask for
          lead to a new folder); the system's cache of files stays as it is
  warm    the same once more, with the caches that the run before has left
Medians and spreads are of --repeat runs, after one that does not count; of
processes there are three at most. Close other programs, and look at the spread.

EXAMPLES
  plumb bench scenes/notes/walls.txt
  plumb bench scenes/hard/sphere_tiny_far.txt scenes/gallery/ring.txt --plot error.svg
  plumb bench scene.txt --size 3840x2160 --repeat 9 --json > scene.json

What cannot be done (no GPU, too many spheres) is said in its place, and is no
failure: exit 0.")]
pub(crate) struct Args {
    /// Scene files
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Columns and rows of the pictures, in place of the scenes' pixeldim
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Measured runs of each kind, 1 to 1000
    #[arg(
        long,
        value_name = "N",
        default_value_t = 5,
        value_parser = whole(1..=1000)
    )]
    repeat: u32,
    /// Print exact figures as JSON, every run among them, in place of the tables
    #[arg(long)]
    json: bool,
    /// Draw it too: time across, error up, a panel a scene
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<PathBuf>,
}

/// Measures the scenes.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    // All arguments are checked first, before anything takes time.
    let target = args
        .plot
        .as_ref()
        .map(|out| target(out, args))
        .transpose()?;
    let scenes = args
        .scenes
        .iter()
        .map(|path| scene(path, args))
        .collect::<Result<_>>()?;
    let document = target.map(|target| Document::open(&target)).transpose()?;
    let asked = Asked {
        scenes,
        repeat: args.repeat,
        software: SOFTWARE.to_owned(),
        program: std::env::current_exe().context("cannot find plumb itself")?,
        cache: cache::folder(),
    };
    let mut progress = Progress::new(asked.steps(), true);
    let measured = bench(&asked, &mut || progress.add(1));
    progress.clear();
    let report = measured.map_err(explain)?;
    if let Some(document) = document {
        document.write(plot::plot(&report).as_bytes())?;
    }
    if args.json {
        say::data(&(serde_json::to_string_pretty(&report)? + "\n"))?;
    } else {
        say::data(&table::table(&report))?;
    }
    Ok(Answer::Yes)
}

/// The error, with what would mend it.
fn explain(error: BenchError) -> anyhow::Error {
    match error.source {
        Unmeasured::Failed(render::Error::TooManyRays(_)) => {
            anyhow!(
                "{error}. plumb bench takes the limits as they are, and cannot measure this scene"
            )
        }
        _ => anyhow!("{error}"),
    }
}

/// A scene at its final size, with its name and its file.
fn scene(path: &Path, args: &Args) -> Result<(String, PathBuf, Scene)> {
    if source::is_stdin(path) {
        bail!("plumb bench reads a scene more than once: save it to a file, and name that");
    }
    let mut scene = source::load(path)?;
    if let Some(size) = args.size {
        scene.camera.pixeldim = size;
    }
    let [width, height] = scene.camera.pixeldim;
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        bail!(
            "{}: pictures of {width} × {height} pixels are compared whole, and {MOST_PIXELS} pixels are the most: give \
            a smaller --size",
            path.display()
        );
    }
    Ok((source::name(path), path.to_owned(), scene))
}

/// Where the plot goes.
fn target(out: &Path, args: &Args) -> Result<Target> {
    let is_svg = out
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if !is_svg {
        bail!(
            "cannot draw {}: a plot is SVG, so its name must end in .svg",
            out.display()
        );
    }
    if args.scenes.iter().any(|scene| is_same_file(out, scene)) {
        bail!(
            "{} is one of the scenes: give the plot another name",
            out.display()
        );
    }
    Ok(Target::from_argument(out.as_os_str()))
}

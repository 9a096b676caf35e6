//! The command line: what the arguments mean, which job they ask for, and how the job's end becomes an exit code.
//!
//! Nothing here knows how to trace or to write a picture: each subcommand's file turns its arguments into calls of the
//! library and says what came out. Data goes to stdout, talk to stderr (`say`).

mod args;
mod bench;
mod cache;
mod check;
mod compare;
mod completions;
mod destination;
mod doctor;
mod dump;
mod end;
mod inherited;
mod join;
mod many;
mod outputs;
mod parts;
mod picture;
mod place;
mod preview;
mod probe;
mod progress;
mod render;
mod say;
mod slurm;
mod source;
mod summary;
mod targets;
mod values;

use std::env;
use std::path::Path;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

use args::RenderOptions;

/// What `--version` and the reports call the program.
pub(crate) const SOFTWARE: &str = concat!("plumb ", env!("CARGO_PKG_VERSION"));

/// The version with the commit it was built from.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("PLUMB_COMMIT"), ")");

/// Exit codes, in the order of the help.
const DONE: u8 = 0;
const NO: u8 = 1;
const FAILED: u8 = 2;
/// 128 + SIGINT, as a shell reports it; a SIGTERM looks the same from here.
const INTERRUPTED: u8 = 130;

const LONG_ABOUT: &str = "\
plumb is a ray tracer on the GPU: a scene file in, a picture out. Without a GPU the same tracer runs on the CPU.

Without a command, plumb is a filter, as in the course notes: it reads a scene from stdin, lists the model on stderr \
and writes the picture to stdout as PPM.";

const AFTER_HELP: &str =
    "See `plumb --help` for examples and the scene language, `plumb COMMAND --help` for a command.";

const AFTER_LONG_HELP: &str = "\
EXAMPLES
  plumb render scenes/notes/walls.txt   a picture, walls.ppm, in this folder
  plumb render scene.txt -o out.png --size 1920x1080
  plumb < scene.txt > picture.ppm       the notes' own usage
  plumb render scene.txt --samples 16   smooth edges
  plumb check scenes/*/*.txt            every error of every file
  plumb probe scene.txt 100 40          why a pixel is what it is (y upwards)
  plumb compare a.ppm b.png             are they the same, and if not, where?
  plumb render scene.txt -o big.png --size 100000x100000 --resume
                                        goes on where it was stopped
  plumb slurm scene.txt -o big.png --parts 64 > big.sh
                                        the same on a cluster (docs/CLUSTER.md)
  plumb doctor                          which GPU would be used, and why
  plumb bench scene.txt --plot out.svg  what each way to render it costs, in time
                                        and in error

THE SCENE LANGUAGE
  A scene is a list of blocks, each a type, a name and attributes; # starts a
  comment. The screen is the rectangle from (0, 0, 0) to worlddim, seen from
  the viewpoint; x goes right, y up, z towards you.

      camera   cam   { pixeldim 640 480   worlddim 8 6   viewpoint 4 3 6 }
      material green { ambient 0 5 0 }
      plane    wall  { material green   normal 3 0 1   point 0 0 0 }
      sphere   ball  { material green   center 4 2 -5   radius 2 }
      light    lamp  { location 4 6 2   emissivity 2 2 2 }

  Without lights a colour is the material's ambient reflectivity over the
  distance. With lights there are diffuse light, shadows and glints, mirror
  images (specular), and what is seen through things (transparency).

  Types: camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane,
  light, spotlight, projector, texture, texplane. A material is defined before it
  is used; there is one camera; everything else comes in any order.
  docs/SCENE.md has every attribute with its limits, scenes/ has examples.

EXIT CODES
  0   done
  1   done, and the answer is no: pictures differ (compare), no adapter that can
      be used or trusted (doctor), bytes presumed and not proven (--strict), parts
      missing or wrong (join)
  2   bad input or failure; what is wrong is on stderr
  130 ended by Ctrl-C or SIGTERM; no unfinished file remains

ENVIRONMENT
  PLUMB_ADAPTER   part of the name of the GPU adapter to use, where --adapter
                  gives none
  RUST_LOG        what the GPU's library may say on stderr: RUST_LOG=wgpu=warn
  NO_COLOR        no colours
  XDG_CACHE_HOME  where plumb/ remembers adapters that passed the self-test
                  (~/.cache otherwise; safe to delete)";

/// A ray tracer on the GPU for the scene language of a university course.
#[derive(Debug, Parser)]
#[command(
    name = "plumb",
    version = VERSION,
    long_about = LONG_ABOUT,
    after_help = AFTER_HELP,
    after_long_help = AFTER_LONG_HELP,
    override_usage = "plumb <COMMAND>\n       plumb [OPTIONS] < SCENE > PICTURE.ppm",
    args_conflicts_with_subcommands = true,
    max_term_width = 120
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(
        flatten,
        next_help_heading = "Options of the filter use (those of `plumb render`)"
    )]
    filter: RenderOptions,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render scenes into pictures: PPM, PNG or EXR
    Render(render::Args),
    /// Make a picture of its parts, which `plumb render --part` has made; exit 1 if some are missing
    Join(join::Args),
    /// Print the script by which a Slurm cluster makes a picture in parts, or many pictures; or submit it
    Slurm(slurm::Args),
    /// Tell every error of scene files, without touching a GPU
    Check(check::Args),
    /// Print what a scene becomes on its way to the GPU
    Dump(dump::Args),
    /// Explain one pixel: its rays, what they met, what the lights add, its colour
    Probe(probe::Args),
    /// Show a scene in a window that follows its file, and change it there
    Preview(preview::Args),
    /// Compare two pictures; exit 1 if they differ
    Compare(compare::Args),
    /// Measure every way to render scenes: the error against the time
    Bench(bench::Args),
    /// List the GPU adapters, and which one would be used and why
    Doctor(doctor::Args),
    /// Print a completion script for a shell
    Completions(completions::Args),
}

/// How a job ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Done.
    Yes,
    /// Done, and the answer is no.
    No,
    /// The input is bad, as was told already.
    Bad,
    /// There was nothing to do; the help says what there could be.
    Nothing,
}

/// Runs the program, and ends it.
pub(crate) fn main() -> ! {
    end::process(run())
}

/// Runs the program; returns its exit code.
fn run() -> u8 {
    // The GPU's library tells of failures as errors that we print ourselves; the rest only who asks wants to read.
    let quiet = env_logger::Env::default().default_filter_or("error,wgpu=off,naga=off");
    env_logger::Builder::from_env(quiet).init();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    inherited::on_signals(interrupted);
    let ended = match cli.command {
        None => render::filter(&cli.filter),
        Some(Command::Render(args)) => many::run(&args),
        Some(Command::Join(args)) => join::run(&args),
        Some(Command::Slurm(args)) => slurm::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Dump(args)) => dump::run(&args),
        Some(Command::Probe(args)) => probe::run(&args),
        Some(Command::Preview(args)) => preview::run(&args),
        Some(Command::Compare(args)) => compare::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
        Some(Command::Doctor(args)) => doctor::run(&args),
        Some(Command::Completions(args)) => completions::run(&args),
    };
    match ended {
        Ok(Answer::Yes) => DONE,
        Ok(Answer::No) => NO,
        Ok(Answer::Bad) => FAILED,
        Ok(Answer::Nothing) => {
            say::talk(&Cli::command().render_help().to_string());
            FAILED
        }
        Err(error) if say::is_broken_pipe(&error) => DONE,
        Err(error) => {
            say::error(&error);
            FAILED
        }
    }
}

/// Ctrl-C, SIGTERM or SIGHUP: nothing half done remains.
fn interrupted() {
    plumb::image::remove_unfinished();
    if progress::is_shown() {
        // The shell's prompt gets a line of its own.
        say::talk("\n");
    }
    end::now(INTERRUPTED)
}

/// What clap ends with: a help text or a version on stdout, or a usage error on stderr.
fn usage(error: &clap::Error) -> u8 {
    // Where even this cannot be printed (a closed pipe), the exit code is all that is left to say.
    let printed = error.print();
    if !error.use_stderr() {
        return match printed {
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => FAILED,
            _ => DONE,
        };
    }
    if matches!(
        error.kind(),
        ErrorKind::InvalidSubcommand | ErrorKind::UnknownArgument
    ) {
        // `plumb scene.txt` is what everybody types first.
        let first = env::args_os()
            .nth(1)
            .filter(|first| Path::new(first).is_file());
        if let Some(scene) = first {
            say::talk(&format!(
                "\n  tip: to render a scene: plumb render {}\n",
                Path::new(&scene).display()
            ));
        }
    }
    FAILED
}

/// The whole command, for completions.
pub(crate) fn command() -> clap::Command {
    Cli::command()
}

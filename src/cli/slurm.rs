//! `plumb slurm`: the job script by which a cluster makes a picture in parts, or many pictures. plumb does not
//! schedule; Slurm does.

mod quote;
mod script;

use std::collections::HashMap;
use std::env;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use clap::parser::ValueSource;
use clap::{ArgMatches, Args as _};
use plumb::image::{Format, check_size};
use plumb::parts::{Cut, Work};

use super::args::RenderOptions;
use super::destination::Destination;
use super::parts::{folder_of, refuse_lost};
use super::values::{parts as parts_value, whole};
use super::{Answer, say, source};
use script::{Script, What};

/// What `plumb slurm` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
The script does all there is to do: run by bash it submits a job array, and behind it a job that joins the parts; run \
by Slurm it makes a part. A part that fails is put back into the queue, for another node perhaps. What is missing in \
the end, `bash SCRIPT missing` submits again, and that alone.

The script runs where it was written: in this folder, with this plumb, on a file system that all nodes see. Nodes may \
be of any kind, with a GPU or without: all make the same bytes. docs/CLUSTER.md tells more.

EXAMPLES
  plumb slurm scene.txt -o big.png --size 100000x100000 --parts 256 > big.sh
  bash big.sh                            submits it
  bash big.sh missing                    submits what is missing after all
  plumb slurm scene.txt -o big.png --parts 64 --submit -- --partition=long
  plumb slurm shots/*.txt -o 'film/{}.png' --frames --gpus-per-task 1 --submit")]
pub(crate) struct Args {
    /// The scene file; with --frames, as many as there are pictures
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    render: RenderOptions,
    /// Parts of the picture, each a task of the job array; with --frames, tasks that share the scenes (1000 at most
    /// without)
    #[arg(long, value_name = "N", value_parser = parts_value, required_unless_present = "frames")]
    parts: Option<u32>,
    /// A picture of each scene, in place of parts of one: -o names them, with {} for the scene's name
    #[arg(long)]
    frames: bool,
    /// The folder of the parts; OUT.parts without
    #[arg(long, value_name = "DIR", conflicts_with = "frames")]
    parts_in: Option<PathBuf>,
    /// Remove the parts when the picture is whole
    #[arg(long, conflicts_with = "frames")]
    remove: bool,
    /// GPUs of a task; the job that joins takes none
    #[arg(long, value_name = "N", value_parser = whole(1..=64))]
    gpus_per_task: Option<u32>,
    /// Tasks that may run at the same time; as many as Slurm lets without
    #[arg(long, value_name = "N", value_parser = whole(1..=1_000_000))]
    at_once: Option<u32>,
    /// How often a task that failed is put back into the queue
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = whole(0..=100))]
    retries: u32,
    /// Write the script into this folder too, and submit it with sbatch
    #[arg(long)]
    submit: bool,
    /// Options for sbatch, behind --
    #[arg(last = true, value_name = "SBATCH OPTIONS")]
    sbatch: Vec<OsString>,
}

/// Tasks that a job array has at most where Slurm was not told otherwise (MaxArraySize is 1001).
const TASKS: u32 = 1000;

/// What stands for the scene's name in those of pictures.
const NAME: &str = "{}";

/// Writes the script, or submits it.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let Some(output) = args
        .render
        .output
        .as_deref()
        .filter(|output| *output != "-")
    else {
        bail!("pictures of a cluster are files: name them with -o");
    };
    for option in &args.sbatch {
        check_option(option)?;
    }
    let what = if args.frames {
        frames(args, output)?
    } else {
        picture(args, output)?
    };
    let script = Script {
        name: job_name(what.output()),
        plumb: env::current_exe().context("cannot tell where plumb is")?,
        folder: env::current_dir().context("cannot tell which folder this is")?,
        options: options(),
        threads: args.render.threads.is_none(),
        gpus: args.gpus_per_task,
        at_once: args.at_once,
        retries: args.retries,
        sbatch: args.sbatch.clone(),
        what,
    };
    let text = script.text();
    if args.submit {
        return submit(&script.name, &text);
    }
    say::stream(|stdout| stdout.write_all(&text))?;
    Ok(Answer::Yes)
}

/// One picture in parts. What would fail on every node fails here.
fn picture(args: &Args, output: &Path) -> Result<What> {
    let [scene] = &args.scenes[..] else {
        bail!("the parts of a picture are of one scene; --frames makes a picture of each");
    };
    let parts = args.parts.unwrap_or(1);
    let mut loaded = load(scene)?;
    args.render.picture.apply(&mut loaded);
    let target = Destination::of(Some(output)).target(Some(scene))?;
    let output = target.path();
    let format = Format::from_path(output)?;
    let settings = args.render.settings(&loaded, format.wants_values())?;
    super::parts::refuse(&args.render)?;
    let [width, height] = loaded.camera.pixeldim;
    let rows = settings.rows_of(height);
    check_size(format, width, rows.len() as u32)?;
    Cut::new(rows, &Work::even(), parts)?;
    target.identity()?;
    let folder = args.parts_in.clone();
    let folder = folder.unwrap_or_else(|| folder_of(output));
    refuse_lost(&folder)?;
    if settings.values && args.gpus_per_task.is_some() {
        say::note(
            "the values of an EXR are computed on the CPU: the tasks' GPUs will have nothing to do",
        );
    }
    if parts > TASKS {
        say::note(&format!(
            "{parts} parts are more tasks than a job array has unless the cluster allows more: `scontrol show config | \
             grep MaxArraySize` tells; {TASKS} always go"
        ));
    }
    Ok(What::Parts {
        scene: scene.clone(),
        output: output.to_owned(),
        folder,
        parts,
        remove: args.remove,
    })
}

/// A picture of each scene.
fn frames(args: &Args, output: &Path) -> Result<What> {
    let destination = Destination::of(Some(output));
    if let Destination::Name(_) = destination {
        bail!(
            "with --frames -o names many pictures: put {NAME} where the scene's name goes, as in 'film/{NAME}.png'"
        );
    }
    if args.render.verdicts.is_some() {
        bail!("--verdicts names one picture, and there are many: leave it out");
    }
    let mut known = HashMap::new();
    let mut pictures = Vec::new();
    for scene in &args.scenes {
        load(scene)?;
        let target = destination.target(Some(scene))?;
        Format::from_path(target.path())?;
        target.identity()?;
        let picture = target.path().to_owned();
        if let Some(other) = known.insert(picture.clone(), scene) {
            let (other, scene, picture) = (other.display(), scene.display(), picture.display());
            bail!("{other} and {scene} would both become {picture}");
        }
        pictures.push((scene.clone(), picture));
    }
    let frames = u32::try_from(pictures.len()).unwrap_or(u32::MAX);
    Ok(What::Frames {
        pictures,
        output: output.to_owned(),
        tasks: args.parts.unwrap_or(TASKS).min(frames),
    })
}

fn load(scene: &Path) -> Result<plumb::scene::Scene> {
    if source::is_stdin(scene) {
        bail!("the nodes read the scene from a file that all of them see: name one");
    }
    source::load(scene)
}

/// Refuses options of sbatch that are the script's own, or that a line of it cannot hold.
fn check_option(option: &OsStr) -> Result<()> {
    let Some(text) = option
        .to_str()
        .filter(|text| !text.contains(['\n', '\r', '\'']))
    else {
        bail!(
            "{} cannot stand in a line of a job script",
            option.display()
        );
    };
    if text.starts_with("--array") || text.starts_with("-a") {
        bail!(
            "the script itself tells sbatch the array: --at-once says how many tasks may run at the same time"
        );
    }
    if text.starts_with("--wrap") {
        bail!("--wrap is another script: leave it out");
    }
    Ok(())
}

/// The options of rendering that were given, as they were given, but for -o.
fn options() -> Vec<OsString> {
    let matches = super::command().try_get_matches_from(env::args_os());
    let Ok(matches) = matches else {
        return Vec::new();
    };
    let given = matches.subcommand_matches("slurm");
    given.map(given_options).unwrap_or_default()
}

fn given_options(matches: &ArgMatches) -> Vec<OsString> {
    let all = RenderOptions::augment_args(clap::Command::new("render"));
    let mut given = Vec::new();
    for arg in all.get_arguments() {
        let id = arg.get_id().as_str();
        let (Some(long), Some(ValueSource::CommandLine)) =
            (arg.get_long(), matches.value_source(id))
        else {
            continue;
        };
        if long == "output" {
            continue;
        }
        if !arg.get_action().takes_values() {
            given.push(format!("--{long}").into());
            continue;
        }
        for value in matches.get_raw(id).into_iter().flatten() {
            let mut option = OsString::from(format!("--{long}="));
            option.push(value);
            given.push(option);
        }
    }
    given
}

/// What Slurm calls the job: the picture's name, as far as it is plain.
fn job_name(output: &Path) -> String {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || "._-".contains(c) {
            c
        } else {
            '_'
        }
    };
    let name: String = stem.replace(NAME, "frames").chars().map(plain).collect();
    if name.starts_with(['-', '.']) {
        format!("plumb{name}")
    } else {
        name
    }
}

/// Writes the script into this folder, and runs it.
fn submit(name: &str, text: &[u8]) -> Result<Answer> {
    let path = PathBuf::from(format!("{name}.sh"));
    let shown = path.display();
    let old = fs::read(&path).ok();
    if old.as_ref().is_some_and(|old| !script::is_ours(old)) {
        bail!("{shown} is there, and is not one of plumb's scripts: it is left alone");
    }
    fs::write(&path, text).with_context(|| format!("cannot write {shown}"))?;
    let replaces = if old.is_some_and(|old| old != text) {
        ", in place of another one of that name"
    } else {
        ""
    };
    say::note(&format!("the script is {shown}{replaces}"));
    let status = Command::new("bash").arg(&path).status();
    let status = status.context("cannot run bash")?;
    if !status.success() {
        bail!(
            "not all of it was submitted. Where sbatch refused an option, the same command with another one writes \
             {shown} anew; where there is no sbatch, `bash {shown}` is for where there is"
        );
    }
    say::note(&format!(
        "when these jobs have ended, `bash {shown} missing` submits what is missing, if anything is"
    ));
    Ok(Answer::Yes)
}

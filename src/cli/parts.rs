//! `plumb render --part` and `--resume`: pictures made in parts, here and elsewhere, now and later.

mod lock;
mod picture;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};

use super::Answer;
use super::args::{PrecisionName, RenderOptions};
use super::render::RenderCommand;
use super::values::{Share, share};
use picture::Picture;

/// Which parts of a picture are made, and where they lie.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct PartOptions {
    /// Only part K of N, from 1 at the top, as a file of its own for `plumb join`; one that is there and right is kept
    #[arg(
        long,
        value_name = "K/N",
        value_parser = share,
        conflicts_with = "resume",
        long_help = "\
Only part K of N of the picture, from 1 at the top, as a file of its own in the folder of --parts-in: whole there, or \
not there. `plumb join` makes the picture of all parts. A part that is there and right is not made again.

Parts are cut such that each is about as much work, which every machine finds out by itself and alike; so parts can be \
made anywhere, in any order, on whatever there is. docs/CLUSTER.md shows it with Slurm and others."
    )]
    part: Option<Share>,
    /// Make the picture in parts by itself, and go on where an earlier run was stopped
    #[arg(
        long,
        long_help = "\
Make the picture in parts, and join them when all are there. Whatever ends the program (Ctrl-C, a full disk, a power \
cut), the same command goes on behind the last part that was whole. The parts lie in the folder of --parts-in, take as \
much space again as the picture, and are removed when the picture is whole."
    )]
    resume: bool,
    /// The folder of the parts; OUT.parts without
    #[arg(long, value_name = "DIR")]
    parts_in: Option<PathBuf>,
}

/// What is to be made in parts.
pub(crate) struct Job<'a> {
    /// One part, or all that are missing, and the picture of them.
    part: Option<Share>,
    folder: Option<&'a Path>,
}

impl PartOptions {
    /// What is to be made in parts, if anything.
    pub(crate) fn job(&self) -> Result<Option<Job<'_>>> {
        let folder = self.parts_in.as_deref();
        let job = |part| Ok(Some(Job { part, folder }));
        match (self.part, self.resume) {
            (Some(part), _) => job(Some(part)),
            (None, true) => job(None),
            (None, false) if folder.is_some() => {
                bail!("--parts-in is where --part and --resume have their parts: give one of them")
            }
            (None, false) => Ok(None),
        }
    }
}

/// The folder of a picture's parts, if none is named: `picture.png.parts`.
pub(crate) fn folder_of(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".parts");
    name.into()
}

/// Refuses a folder of parts that lies in none: where a disk is missing on a node, its parts would be made elsewhere.
pub(crate) fn refuse_lost(folder: &Path) -> Result<()> {
    let above = folder
        .parent()
        .filter(|above| !above.as_os_str().is_empty());
    match above.filter(|above| !above.is_dir()) {
        Some(above) => bail!(
            "cannot make the folder {}: the folder {} does not exist",
            folder.display(),
            above.display()
        ),
        None => Ok(()),
    }
}

/// Makes the folder of the parts, unless it is there.
fn make(folder: &Path) -> Result<()> {
    refuse_lost(folder)?;
    match fs::create_dir(folder) {
        // Other parts are made at the same time.
        Err(_) if folder.is_dir() => Ok(()),
        made => made.with_context(|| format!("cannot make the folder {}", folder.display())),
    }
}

/// Refuses what parts cannot have.
pub(crate) fn refuse(options: &RenderOptions) -> Result<()> {
    if options.precision == PrecisionName::Fast {
        bail!(
            "--precision fast gives other bytes on every device, so its parts would not fit together: leave it out"
        );
    }
    if options.verdicts.is_some() || options.shown().is_some() {
        bail!("--verdicts and --debug are of pictures that are made in one piece: leave them out");
    }
    Ok(())
}

/// Makes a part, or all and the picture of them.
pub(crate) fn run(command: &RenderCommand<'_>, job: &Job<'_>) -> Result<Answer> {
    let start = Instant::now();
    let picture = Picture::new(command, job)?;
    let folder = picture.folder.path();
    make(folder)?;
    match job.part {
        Some(part) => picture.part(part.number, start),
        None => picture.resume(start),
    }
}

//! Why a picture cannot be written: what `target`, `sink` and `output` have to say, in sentences for the user.

use std::io;
use std::path::PathBuf;

use super::{Format, Target};
use crate::files::reason;

/// Why a picture cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The name does not tell a format.
    #[error("cannot tell the format of {}: its name must end in .ppm, .png or .exr", .path.display())]
    UnknownEnding {
        /// The name as given.
        path: PathBuf,
    },
    /// The target is a folder, or its name asks for one.
    #[error("cannot write {}: it is the name of a folder", .path.display())]
    Folder {
        /// The name as given.
        path: PathBuf,
    },
    /// The folder that the file would lie in is missing.
    #[error("cannot write {}: the folder {} does not exist", .path.display(), .folder.display())]
    MissingFolder {
        /// The name as given.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The system does not let us open the target.
    #[error("cannot write {}: {}", .path.display(), reason(.source))]
    Open {
        /// The name as given.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The system does not let us create a file in the target's folder, where every picture is written first.
    #[error("cannot write {}: no file can be made in {}: {}", .path.display(), .folder.display(), reason(.source))]
    Create {
        /// The name as given.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The format cannot hold a picture of this size.
    #[error("a picture of {width} × {rows} pixels cannot be written as {format}: {problem}")]
    Size {
        /// Columns.
        width: u32,
        /// Rows to be written.
        rows: u32,
        /// The format asked for.
        format: Format,
        /// What would be too large.
        problem: String,
    },
    /// A key or a text that not every format can hold.
    #[error("cannot write the metadata {key:?}: {problem}")]
    Metadata {
        /// The key of the entry.
        key: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// Fewer rows came than were announced, or an earlier write failed.
    #[error("the picture for {target} is not whole: {written} of {rows} rows were written")]
    Unfinished {
        /// Where it was to go.
        target: Target,
        /// Rows that were written.
        written: u32,
        /// Rows that were announced.
        rows: u32,
    },
    /// Writing failed.
    #[error("writing {target} failed: {}", reason(.source))]
    Write {
        /// Where it was to go.
        target: Target,
        /// What the system says; [`io::ErrorKind::BrokenPipe`] if the reader went away.
        source: io::Error,
    },
}

impl OutputError {
    /// Whether the only thing that happened is that the reader of a pipe went away.
    #[must_use]
    pub fn is_broken_pipe(&self) -> bool {
        match self {
            Self::Open { source, .. } | Self::Write { source, .. } => {
                source.kind() == io::ErrorKind::BrokenPipe
            }
            _ => false,
        }
    }
}

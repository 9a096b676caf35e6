//! A file or a stream to the bytes of a scene, within bounds: the step before text → lex → parse → [`Scene`].

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::model::Scene;
use super::names::nearest;
use super::parse::parse;
use crate::diagnostic::Diagnostics;
use crate::files::{self, is_same_file};

/// The most bytes that a scene may have.
pub const MAX_FILE: u64 = 256 << 20;

/// The most names in a folder that are searched for the file that was meant.
const MAX_ENTRIES: usize = 1_000;

/// Why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// Its file could not be read.
    #[error("{}: {}{}", path.display(), reason(source), hint.as_deref().unwrap_or_default())]
    Io {
        /// The file, or the name of the stream.
        path: PathBuf,
        /// Why.
        source: io::Error,
        /// What may have been meant, in parentheses after a space.
        hint: Option<String>,
    },
    /// It is larger than [`MAX_FILE`].
    #[error("{}: too large for a scene: more than {} MiB", path.display(), MAX_FILE >> 20)]
    TooLarge {
        /// The file, or the name of the stream.
        path: PathBuf,
    },
    /// It is no scene, or one with mistakes.
    #[error(transparent)]
    Scene(#[from] Diagnostics),
}

/// Loads a scene from a file. Textures are relative to the folder of the file.
///
/// # Errors
/// When the file cannot be read, is too large, or is not a scene without mistakes.
pub fn load(path: &Path) -> Result<Scene, LoadError> {
    load_with_text(path).map(|(scene, _)| scene)
}

/// The same with the text, in which [`places`](super::places()) tells where everything stands.
///
/// # Errors
/// As [`load`].
pub fn load_with_text(path: &Path) -> Result<(Scene, Vec<u8>), LoadError> {
    let bytes = read_file(path)?;
    let scene = parse(&path.to_string_lossy(), &bytes, folder_of(path))?;
    Ok((scene, bytes))
}

/// The folder that the names of a scene's textures start at: that of its file, or the current one for a stream.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !files::is_stream(path) => folder,
        _ => Path::new(""),
    }
}

/// The bytes of a file that is perhaps a scene.
///
/// # Errors
/// When it cannot be read, or is too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, LoadError> {
    let fail = |source: io::Error| {
        // Some systems refuse to open a directory with a reason that misleads.
        let source = if path.is_dir() {
            io::ErrorKind::IsADirectory.into()
        } else {
            source
        };
        let hint = if source.kind() == io::ErrorKind::NotFound {
            hint(path)
        } else {
            None
        };
        LoadError::Io {
            path: path.to_owned(),
            source,
            hint,
        }
    };
    let file = File::open(path).map_err(fail)?;
    let metadata = file.metadata().map_err(fail)?;
    if metadata.is_dir() {
        return Err(fail(io::ErrorKind::IsADirectory.into()));
    }
    let too_large = || LoadError::TooLarge {
        path: path.to_owned(),
    };
    if metadata.len() > MAX_FILE {
        return Err(too_large());
    }
    read(file, metadata.len())
        .map_err(fail)?
        .ok_or_else(too_large)
}

/// Loads a scene from a stream, which diagnostics call `name` (as `<stdin>`). Textures are relative to `folder`.
///
/// # Errors
/// When the stream fails, is too long, or is not a scene without mistakes.
pub fn load_from(name: &str, input: impl Read, folder: &Path) -> Result<Scene, LoadError> {
    load_from_with_text(name, input, folder).map(|(scene, _)| scene)
}

/// The same with the text.
///
/// # Errors
/// As [`load_from`].
pub fn load_from_with_text(
    name: &str,
    input: impl Read,
    folder: &Path,
) -> Result<(Scene, Vec<u8>), LoadError> {
    let path = || PathBuf::from(name);
    let bytes = read(input, 0).map_err(|source| LoadError::Io {
        path: path(),
        source,
        hint: None,
    })?;
    let bytes = bytes.ok_or_else(|| LoadError::TooLarge { path: path() })?;
    let scene = parse(name, &bytes, folder)?;
    Ok((scene, bytes))
}

/// Reads everything, or nothing where there is more than a scene may have. Memory grows with what arrives.
fn read(input: impl Read, expected: u64) -> io::Result<Option<Vec<u8>>> {
    // One byte more than expected, so that the end is found without growing.
    let mut bytes = Vec::with_capacity(expected.min(MAX_FILE) as usize + 1);
    input.take(MAX_FILE + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= MAX_FILE).then_some(bytes))
}

/// Why it cannot be read.
fn reason(source: &io::Error) -> String {
    match source.kind() {
        io::ErrorKind::IsADirectory => String::from("is a directory, not a scene"),
        _ => files::reason(source),
    }
}

impl Scene {
    /// Whether the scene was made from the file `path`, so that nothing may be written there: what that file is, for
    /// people. `file` is the scene's own, if it has one.
    pub fn is_made_from(&self, file: Option<&Path>, path: &Path) -> Option<String> {
        if file.is_some_and(|file| is_same_file(file, path)) {
            return Some("the scene itself".into());
        }
        let mut textures = self.textures.iter();
        let texture = textures.find(|texture| is_same_file(path, &texture.path))?;
        Some(format!("the scene's texture `{}`", texture.name))
    }
}

/// The file that was perhaps meant by one that is not there.
fn hint(path: &Path) -> Option<String> {
    let mut candidates = Vec::new();
    if path.is_relative() {
        candidates.push(Path::new("scenes").join(path));
    }
    candidates.push(PathBuf::from(format!("{}.txt", path.display())));
    if path.is_relative() {
        candidates.push(PathBuf::from(format!("scenes/{}.txt", path.display())));
    }
    let found = candidates
        .into_iter()
        .find(|candidate| candidate.is_file())
        .or_else(|| neighbour(path))?;
    Some(format!(" (did you mean {}?)", found.display()))
}

/// The file in the same folder whose name is nearest.
fn neighbour(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let parent = path.parent()?;
    let folder = if parent.as_os_str().is_empty() {
        Path::new(".")
    } else {
        parent
    };
    let entries = folder
        .read_dir()
        .ok()?
        .take(MAX_ENTRIES)
        .filter_map(Result::ok);
    let files: Vec<String> = entries
        .filter(|entry| entry.path().is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    let meant = nearest(name.as_bytes(), files.iter().map(String::as_bytes))?;
    Some(parent.join(std::str::from_utf8(meant).ok()?))
}

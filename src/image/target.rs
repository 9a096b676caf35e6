//! What a name stands for: stdout, a file to come, a file that is there, a link to one, a device or a pipe.
//!
//! Answers before anything is written; `sink` does the writing.

use std::ffi::OsStr;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::{Format, OutputError};
use crate::files::{Identity, identity, is_same_file};

/// Links followed before they are called a loop, as Linux does.
const MAX_LINKS: usize = 40;

/// Where a picture goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Standard output, as it is.
    Stdout,
    /// A name: of a file (there already or not), of a link, of a device, of a named pipe.
    Path(PathBuf),
}

impl Target {
    /// The target that an argument of the command line means: `-` is stdout, everything else a path.
    #[must_use]
    pub fn from_argument(argument: &OsStr) -> Self {
        if argument == "-" {
            Self::Stdout
        } else {
            Self::Path(argument.into())
        }
    }

    /// The format that is meant when none is asked for: by the ending; PPM for stdout, and for a device or pipe whose
    /// name has no known ending.
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`] for any other name.
    pub fn format(&self) -> Result<Format, OutputError> {
        match self {
            Self::Path(path) if !self.is_stdout() => {
                Format::from_path(path).or_else(|unknown| match fs::metadata(path) {
                    Ok(found) if !found.is_file() && !found.is_dir() => Ok(Format::Ppm),
                    _ => Err(unknown),
                })
            }
            _ => Ok(Format::Ppm),
        }
    }

    /// Whether what goes to one of them would be in the way of what goes to the other: one file, that is there or to
    /// come.
    pub fn is_same(&self, other: &Self) -> bool {
        let (a, b) = (self.path(), other.path());
        let end = |path: &Path| match find(path) {
            Ok(Found::Nothing(end) | Found::File(end, _)) => Some(end),
            Ok(Found::Special) | Err(_) => None,
        };
        a == b || is_same_file(a, b) || matches!((end(a), end(b)), (Some(a), Some(b)) if a == b)
    }

    /// What tells the file that is written from all others, whether it is there or to come; none for a stream, which
    /// may take one picture after the other.
    ///
    /// # Errors
    /// If it cannot be written: it is a folder, or lies in one that is missing.
    pub fn identity(&self) -> Result<Option<Identity>, OutputError> {
        if self.is_stdout() {
            return Ok(None);
        }
        Ok(match find(self.path())? {
            Found::Nothing(end) => Some(Identity::Name(end)),
            Found::File(end, _) => identity(&end),
            Found::Special => None,
        })
    }

    /// A name of it; stdout has one on most systems, which leads to the file that it was redirected to.
    pub fn path(&self) -> &Path {
        match self {
            Self::Path(path) if !self.is_stdout() => path,
            _ => Path::new("/dev/stdout"),
        }
    }

    /// Whether this is stdout, by one of the names that systems give it: if it was redirected to a file then that name
    /// leads to the file, which must be written to where it stands, not replaced.
    pub fn is_stdout(&self) -> bool {
        match self {
            Self::Stdout => true,
            Self::Path(path) => {
                cfg!(unix)
                    && ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]
                        .iter()
                        .any(|name| path == Path::new(name))
            }
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stdout => f.write_str("stdout"),
            Self::Path(path) => path.display().fmt(f),
        }
    }
}

/// What was found under a name.
#[derive(Debug)]
pub(super) enum Found {
    /// Nothing yet: the file to create, its folder without links.
    Nothing(PathBuf),
    /// A regular file: its own name, without links.
    File(PathBuf, fs::Metadata),
    /// A device, a named pipe: to be opened and written through.
    Special,
}

/// Looks up what `path` stands for, through links, whether they lead to something or not yet.
pub(super) fn find(path: &Path) -> Result<Found, OutputError> {
    let failed = |source| OutputError::Open {
        path: path.to_owned(),
        source,
    };
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(OutputError::Folder {
            path: path.to_owned(),
        }),
        Ok(found) if found.is_file() => {
            Ok(Found::File(fs::canonicalize(path).map_err(failed)?, found))
        }
        Ok(_) => Ok(Found::Special),
        Err(error) if error.kind() == io::ErrorKind::NotFound => find_nothing(path),
        Err(error) => Err(failed(error)),
    }
}

/// The file that writing to `path`, where nothing is found, would create: where a dangling link leads to, or itself.
fn find_nothing(path: &Path) -> Result<Found, OutputError> {
    let mut end = path.to_owned();
    for _ in 0..MAX_LINKS {
        // A folder that is missing is answered below, by its name.
        if !fs::symlink_metadata(&end).is_ok_and(|found| found.is_symlink()) {
            return create_in_folder(path, &end);
        }
        let next = fs::read_link(&end).map_err(|source| OutputError::Open {
            path: path.to_owned(),
            source,
        })?;
        // A relative link counts from the folder it lies in; joining an absolute one replaces the whole.
        end = end.parent().unwrap_or(Path::new("")).join(next);
    }
    let source = io::Error::other("too many links, one after the other");
    Err(OutputError::Open {
        path: path.to_owned(),
        source,
    })
}

/// `end` with its folder resolved, which must be there.
fn create_in_folder(path: &Path, end: &Path) -> Result<Found, OutputError> {
    // `file_name` overlooks a separator at the end, and a file must not get a name that asked for a folder.
    let ends_in_separator = end
        .as_os_str()
        .as_encoded_bytes()
        .last()
        .is_some_and(|&last| std::path::is_separator(char::from(last)));
    let Some(name) = end.file_name().filter(|_| !ends_in_separator) else {
        return Err(OutputError::Folder {
            path: path.to_owned(),
        });
    };
    let folder = match end.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match fs::canonicalize(folder) {
        Ok(folder) => Ok(Found::Nothing(folder.join(name))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(OutputError::MissingFolder {
            path: path.to_owned(),
            folder: folder.to_owned(),
        }),
        Err(source) => Err(OutputError::Open {
            path: path.to_owned(),
            source,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dash_is_stdout_and_stdout_is_ppm() {
        assert_eq!(Target::from_argument(OsStr::new("-")), Target::Stdout);
        assert_eq!(Target::Stdout.format().unwrap(), Format::Ppm);
        assert_eq!(
            Target::from_argument(OsStr::new("./-")),
            Target::Path("./-".into())
        );
        assert!(Target::Path("./-".into()).format().is_err());
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_ppm_unless_their_name_says_otherwise() {
        assert_eq!(
            Target::Path("/dev/null".into()).format().unwrap(),
            Format::Ppm
        );
        assert_eq!(
            Target::Path("/dev/stdout".into()).format().unwrap(),
            Format::Ppm
        );
    }

    #[test]
    fn a_name_that_asks_for_a_folder_is_no_file() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            folder.path().to_owned(),
            folder.path().join("new/"),
            folder.path().join(".."),
        ] {
            assert!(
                matches!(find(&name), Err(OutputError::Folder { .. })),
                "{}",
                name.display()
            );
        }
        assert!(matches!(
            find(Path::new("")),
            Err(OutputError::Folder { .. })
        ));
    }

    #[test]
    fn a_missing_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let message = find(&folder.path().join("none/there.ppm"))
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("none") && message.contains("does not exist"),
            "{message}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn two_names_of_a_file_to_come_are_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let target = |name: &str| Target::Path(folder.path().join(name));
        std::os::unix::fs::symlink("a", folder.path().join("link")).unwrap();
        for (name, same) in [("a", true), ("./a", true), ("link", true), ("b", false)] {
            assert_eq!(target("a").is_same(&target(name)), same, "{name}");
        }
        assert!(!target("a").is_same(&Target::Stdout));
    }

    #[cfg(unix)]
    #[test]
    fn dangling_links_lead_to_the_file_they_name() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().canonicalize().unwrap();
        fs::create_dir(folder.join("sub")).unwrap();
        symlink("sub/b", folder.join("a")).unwrap();
        symlink("../c", folder.join("sub/b")).unwrap();
        assert!(
            matches!(find(&folder.join("a")), Ok(Found::Nothing(end)) if end == folder.join("c"))
        );
        symlink("loop", folder.join("loop")).unwrap();
        assert!(matches!(
            find(&folder.join("loop")),
            Err(OutputError::Open { .. })
        ));
    }
}

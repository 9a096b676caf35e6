//! Files where their names mislead: whether two names lead to one file; and what the system says when it refuses one,
//! in words for people.
//!
//! On the lowest floor: `scene` reads files, `image` writes them.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What tells a file from all others, whatever names lead to it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Identity {
    /// Of one that is there: the numbers of its device and of its place there.
    Numbers(u64, u64),
    /// Of one that is to come, or where the system tells no such numbers: its name without links. Hard links are not
    /// seen there.
    Name(PathBuf),
}

/// The identity of the regular file that a name leads to, through links of either kind; none if there is none.
pub fn identity(path: &Path) -> Option<Identity> {
    let found = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some(Identity::Numbers(found.dev(), found.ino()))
    }
    #[cfg(not(unix))]
    {
        let _ = found;
        fs::canonicalize(path).ok().map(Identity::Name)
    }
}

/// Whether both names lead to one regular file that is there: what is written to one of them destroys the other.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    identity(a).is_some_and(|a| identity(b) == Some(a))
}

/// Whether a name is one that systems and shells give to a stream, as `/dev/stdin` and what `<(…)` becomes: it says
/// nothing of a folder or a file.
pub fn is_stream(path: &Path) -> bool {
    let streams = ["/dev/stdin", "/dev/fd", "/proc/self/fd"];
    cfg!(unix) && streams.iter().any(|stream| path.starts_with(stream))
}

/// Why the system refuses, in words that are the same on every system where the reason is a common one, and without
/// its number.
pub(crate) fn reason(refusal: &io::Error) -> String {
    // The library of temporary files puts their names into its errors, and they are none of the user's.
    let inner = refusal.get_ref().and_then(|error| error.source());
    let refusal = inner
        .and_then(|error| error.downcast_ref())
        .unwrap_or(refusal);
    match refusal.kind() {
        io::ErrorKind::NotFound => String::from("there is no such file"),
        io::ErrorKind::PermissionDenied => String::from("permission denied"),
        io::ErrorKind::IsADirectory => String::from("it is a directory"),
        io::ErrorKind::StorageFull => String::from("there is no space left"),
        _ => {
            let text = refusal.to_string();
            let end = text.rfind(" (os error ").unwrap_or(text.len());
            text[..end].to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn links_of_either_kind_lead_to_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("a"), "a").unwrap();
        fs::write(path("b"), "a").unwrap();
        fs::hard_link(path("a"), path("hard")).unwrap();
        std::os::unix::fs::symlink("hard", path("soft")).unwrap();
        for name in ["a", "hard", "soft", "./a"] {
            assert!(is_same_file(&path("a"), &path(name)), "{name}");
            assert!(is_same_file(&path(name), &path("soft")), "{name}");
        }
        for name in ["b", "none", "."] {
            assert!(!is_same_file(&path("a"), &path(name)), "{name}");
        }
        // Devices and pipes are written through, and hold nothing that could be lost.
        let device = Path::new("/dev/null");
        assert!(!is_same_file(device, device));
    }

    #[test]
    fn reasons_are_plain() {
        assert_eq!(
            reason(&io::ErrorKind::PermissionDenied.into()),
            "permission denied"
        );
        let folder = tempfile::tempdir().unwrap();
        let refusal = tempfile::tempfile_in(folder.path().join("none")).unwrap_err();
        assert_eq!(reason(&refusal), "there is no such file");
        let strange = reason(&io::Error::from_raw_os_error(40));
        assert!(!strange.contains("os error"), "{strange}");
    }
}

//! Files where their names mislead: whether two names lead to one file; and what the system says when it refuses one,
//! in words for people.
//!
//! On the lowest floor: `scene` reads files, `image` writes them.

use std::fs;
use std::io;
use std::path::Path;

/// Whether both names lead to one regular file that is there, through links of either kind: what is written to one of
/// them destroys the other.
#[cfg(unix)]
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |found: &fs::Metadata| (found.dev(), found.ino());
    matches!((fs::metadata(a), fs::metadata(b)), (Ok(a), Ok(b)) if a.is_file() && place(&a) == place(&b))
}

/// Whether both names lead to one file that is there. Hard links are not seen here.
#[cfg(not(unix))]
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
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

//! What files beside a target are called, and what killed processes have left of them.

use std::ffi::OsString;
use std::path::Path;
use std::{fs, io};

/// What every file beside begins with.
const BESIDE: &str = ".plumb-";

/// The longest name that is told in the name of a file beside: names have 255 bytes on most systems.
const MOST_TOLD: usize = 200;

/// What the name of a file beside `end` begins with; letters and digits by chance follow.
pub(super) fn prefix(end: &Path) -> OsString {
    let mut prefix = OsString::from(BESIDE);
    let name = end.file_name().filter(|name| name.len() <= MOST_TOLD);
    if let Some(name) = name {
        prefix.push(name);
        prefix.push("-");
    }
    prefix
}

/// Removes the files beside that processes which were killed outright have left in a folder, of the names that
/// `is_ours`. Those of processes that still write are removed too, so nobody else may be writing them.
///
/// # Errors
/// If the folder cannot be read; a file that cannot be removed stays.
pub fn remove_left(folder: &Path, is_ours: &dyn Fn(&str) -> bool) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let told = name
            .to_str()
            .and_then(|name| name.strip_prefix(BESIDE)?.rsplit_once('-'));
        if told.is_some_and(|(name, _)| is_ours(name)) {
            // It is in nobody's way.
            let _ = fs::remove_file(entry.path());
        }
    }
    Ok(())
}

//! Where the user's system keeps what may be deleted at any time, and what programs remember.

use std::env;
use std::path::PathBuf;

/// plumb's folder there; none where the system does not say.
pub(crate) fn folder() -> Option<PathBuf> {
    let caches = if cfg!(windows) {
        variable("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        variable("XDG_CACHE_HOME").or_else(|| home().map(|home| home.join(".cache")))
    };
    caches.map(|caches| caches.join("plumb"))
}

/// plumb's folder of what it remembers; none where the system does not say.
#[cfg(feature = "preview")]
pub(crate) fn state() -> Option<PathBuf> {
    let states = if cfg!(windows) {
        variable("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Application Support"))
    } else {
        variable("XDG_STATE_HOME").or_else(|| home().map(|home| home.join(".local/state")))
    };
    states.map(|states| states.join("plumb"))
}

/// An absolute path, which alone counts there.
fn variable(name: &str) -> Option<PathBuf> {
    env::var_os(name)
        .map(PathBuf::from)
        .filter(|path| path.is_absolute())
}

fn home() -> Option<PathBuf> {
    variable("HOME")
}

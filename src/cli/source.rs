//! Where a scene comes from on the command line: a file, or stdin.

use std::io::{self, BufRead};
use std::path::Path;

use anyhow::{Context, Result};
use plumb::scene::{self, Scene};

/// What errors and reports call stdin.
pub(crate) const STDIN: &str = "<stdin>";

/// Whether the argument means stdin.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// What errors and reports call the scene.
pub(crate) fn name(path: &Path) -> String {
    if is_stdin(path) {
        STDIN.to_owned()
    } else {
        path.display().to_string()
    }
}

/// The file that the scene comes from: its own, or what stdin was redirected from, where there is a name for that.
pub(crate) fn file(path: Option<&Path>) -> Option<&Path> {
    path.or(cfg!(unix).then_some(Path::new("/dev/stdin")))
}

/// Loads the scene from the file, or from stdin.
pub(crate) fn load(path: &Path) -> Result<Scene> {
    load_with_text(path).map(|(scene, _)| scene)
}

/// The same with its text.
pub(crate) fn load_with_text(path: &Path) -> Result<(Scene, Vec<u8>)> {
    if is_stdin(path) {
        let stdin = io::stdin().lock();
        Ok(scene::load_from_with_text(STDIN, stdin, Path::new(""))?)
    } else {
        Ok(scene::load_with_text(path)?)
    }
}

/// What may surprise in the picture of a scene with this text.
pub(crate) fn remarks(scene: &Scene, text: &[u8], screen_tolerance: f64) -> Vec<String> {
    let places = scene::places(text);
    scene::remarks(scene, screen_tolerance, &scene::lines_of(text, &places))
}

/// The scene on stdin and its text, or none if nothing is piped in. Its textures are looked for from the current
/// folder.
pub(crate) fn load_stdin() -> Result<Option<(Scene, Vec<u8>)>> {
    let mut stdin = io::stdin().lock();
    if stdin.fill_buf().context("cannot read stdin")?.is_empty() {
        return Ok(None);
    }
    let loaded = scene::load_from_with_text(STDIN, stdin, Path::new(""))?;
    Ok(Some(loaded))
}

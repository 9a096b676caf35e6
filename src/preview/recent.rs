//! The scenes that were opened last, kept in a file of the user's: one absolute path a line, the last one first.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::image::{Document, Target};

/// Scenes that are kept.
const MOST: usize = 12;

/// Bytes that are read of the file: as long as so many paths can be on any system.
const MOST_BYTES: u64 = MOST as u64 * 32_768;

/// The list, and where it is kept.
#[derive(Debug, Default)]
pub(super) struct Recent {
    file: Option<PathBuf>,
    scenes: Vec<PathBuf>,
}

impl Recent {
    /// What is kept in a file; what cannot be read is an empty list.
    pub(super) fn read(file: Option<PathBuf>) -> Self {
        let scenes = file.as_deref().map(read).unwrap_or_default();
        Self { file, scenes }
    }

    /// The scenes, the last one first.
    pub(super) fn scenes(&self) -> &[PathBuf] {
        &self.scenes
    }

    /// A scene was opened. The list is written anew, whole or not at all; that it cannot be is no reason to disturb
    /// anybody.
    pub(super) fn opened(&mut self, scene: &Path) {
        let Ok(scene) = std::path::absolute(scene) else {
            return;
        };
        // Another window may have written it meanwhile.
        if let Some(file) = &self.file {
            self.scenes = read(file);
        }
        self.scenes.retain(|known| *known != scene);
        self.scenes.insert(0, scene);
        self.scenes.truncate(MOST);
        if let Some(file) = &self.file
            && let Err(error) = write(file, &self.scenes)
        {
            log::info!("{}: not written: {error}", file.display());
        }
    }
}

fn read(file: &Path) -> Vec<PathBuf> {
    let mut text = Vec::new();
    let read = File::open(file).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut text));
    if read.is_err() {
        return Vec::new();
    }
    let text = String::from_utf8_lossy(&text);
    let paths = text.lines().map(Path::new);
    let mut scenes: Vec<PathBuf> = Vec::new();
    for path in paths.filter(|path| path.is_absolute()) {
        if !scenes.iter().any(|known| known == path) {
            scenes.push(path.to_owned());
        }
    }
    scenes.truncate(MOST);
    scenes
}

fn write(file: &Path, scenes: &[PathBuf]) -> Result<(), String> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    }
    let mut text = String::new();
    // A name that is no text, or takes more than a line, is not kept: it could not be read again.
    let names = scenes.iter().filter_map(|scene| scene.to_str());
    for name in names.filter(|name| !name.contains(['\n', '\r'])) {
        text.push_str(name);
        text.push('\n');
    }
    let target = Target::Path(file.to_owned());
    let written = Document::open(&target).and_then(|document| document.write(text.as_bytes()));
    written.map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_scenes_are_kept_once_each() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("state/plumb/recent");
        let scene = |i: usize| folder.path().join(format!("scene {i}.txt"));
        let mut recent = Recent::read(Some(file.clone()));
        assert!(recent.scenes().is_empty());
        for i in (0..20).chain([15]) {
            recent.opened(&scene(i));
        }
        let expected: Vec<_> = [15, 19, 18, 17, 16, 14, 13, 12, 11, 10, 9, 8]
            .map(scene)
            .into();
        assert_eq!(recent.scenes(), expected);
        assert_eq!(Recent::read(Some(file.clone())).scenes(), expected);
        // Nothing but the list is left beside it.
        assert_eq!(fs::read_dir(file.parent().unwrap()).unwrap().count(), 1);
        // Another window's scene is not forgotten.
        let mut other = Recent::read(Some(file.clone()));
        recent.opened(&scene(100));
        other.opened(&scene(101));
        assert_eq!(other.scenes()[..3], [scene(101), scene(100), scene(15)]);
    }

    #[test]
    fn a_damaged_list_is_no_trouble() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("recent");
        fs::write(&file, b"\xFF\xFE\n\nrelative.txt\n/a\n/a\n/b\r\n").unwrap();
        let scenes = Recent::read(Some(file.clone()));
        assert_eq!(scenes.scenes(), [Path::new("/a"), Path::new("/b")]);
        fs::write(&file, "/long".repeat(1 << 20)).unwrap();
        assert!(Recent::read(Some(file)).scenes().len() <= 1);
        // A folder in its place, and nowhere at all.
        let mut nowhere = Recent::read(Some(folder.path().to_owned()));
        nowhere.opened(Path::new("/a"));
        assert_eq!(nowhere.scenes().len(), 1);
        let mut nowhere = Recent::read(None);
        nowhere.opened(Path::new("/a"));
        assert_eq!(nowhere.scenes(), [Path::new("/a")]);
    }
}

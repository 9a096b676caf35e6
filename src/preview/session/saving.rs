//! Changes on their way into the file.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Version;
use crate::edit::Changes;
use crate::image::{Document, Target as File};

/// Changes to be written into the file. Takes as long as reading it: not for the window's thread.
#[derive(Debug)]
pub(in crate::preview) struct Saving {
    pub(super) path: PathBuf,
    /// What the file is, as far as is known.
    pub(super) file: Arc<Vec<u8>>,
    /// What the changes are on top of.
    pub(super) origin: Arc<Vec<u8>>,
    pub(super) changes: Changes,
    /// How many of them the file does not have.
    pub(super) count: usize,
}

impl Saving {
    /// The file.
    pub(in crate::preview) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the changes into the file, touching nothing else in it. A file that was changed meanwhile is not touched.
    /// `expect` is told what is going to be written. What the file is now, and what was done, in a sentence.
    ///
    /// # Errors
    /// Why not, in a sentence; then the file is as it was.
    pub(in crate::preview) fn run(
        self,
        expect: impl FnOnce(Arc<Vec<u8>>, Changes),
    ) -> Result<(Version, String), String> {
        let Self {
            path,
            file,
            origin,
            changes,
            count,
        } = self;
        let written = changes
            .write(&origin)
            .map_err(|error| format!("not saved: {error}"))?;
        let now = fs::read(&path).map_err(|error| format!("not saved: {error}"))?;
        if now != *file {
            return Err(
                "not saved: somebody else has just written the file; its text is read, and then it can be saved again"
                    .into(),
            );
        }
        // Who watches the file may see it before this returns.
        let written = Arc::new(written);
        expect(Arc::clone(&written), changes);
        let target = File::Path(path.clone());
        Document::open(&target)
            .and_then(|document| document.write(&written))
            .map_err(|error| format!("not saved: {error}"))?;
        let name = path.file_name().unwrap_or(path.as_os_str());
        let name = name.to_string_lossy();
        let said = match count {
            1 => format!("saved a change into {name}"),
            count => format!("saved {count} changes into {name}"),
        };
        Ok((Version::read(&path, Arc::unwrap_or_clone(written)), said))
    }
}

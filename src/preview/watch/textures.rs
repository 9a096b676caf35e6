//! Watching the textures of a scene: their files are looked at, and what stands in them is the parser's affair.
//!
//! The folder of a texture is not listened to, as that of the scene is: there may be many, and a look costs a
//! microsecond each.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use super::Stamp;
use crate::scene::{EntityId, Places, places};

/// Between two looks. What is found twice in a row counts, so a texture is read a tenth of a second after it was
/// written.
const LOOK: Duration = Duration::from_millis(50);

/// A file, and what was found there when it was about to be read.
type Seen = (PathBuf, Option<Stamp>);

/// Tells when one of the textures was written, until it is dropped.
#[derive(Debug, Clone)]
pub(in crate::preview) struct TextureWatch {
    files: Sender<Vec<Seen>>,
}

impl TextureWatch {
    /// Watches nothing yet. `tell` runs on a thread of its own.
    ///
    /// # Errors
    /// When there can be no thread.
    pub(in crate::preview) fn new(
        mut tell: impl FnMut() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (files, receiver) = mpsc::channel::<Vec<Seen>>();
        thread::Builder::new()
            .name("textures".into())
            .spawn(move || {
                let mut looks = Looks::default();
                loop {
                    let next = if looks.files.is_empty() {
                        receiver.recv().map_err(|_| RecvTimeoutError::Disconnected)
                    } else {
                        receiver.recv_timeout(LOOK)
                    };
                    match next {
                        Ok(files) => looks.turn_to(files),
                        Err(RecvTimeoutError::Timeout) => {
                            if looks.look(Stamp::of) {
                                tell();
                            }
                        }
                        Err(RecvTimeoutError::Disconnected) => return,
                    }
                }
            })?;
        Ok(Self { files })
    }

    /// Watches these, and no others. They are looked at now, and not when the thread comes to it: whoever reads them
    /// after this misses nothing that is written later.
    pub(in crate::preview) fn turn_to(&self, files: Vec<PathBuf>) {
        // The thread ends only with this.
        let _ = self.files.send(seen(files));
    }
}

/// The files of the textures that a text names, whether they are there or not, and whether it is a good one or not.
pub(in crate::preview) fn textures(text: &[u8], folder: &Path) -> Vec<PathBuf> {
    let places: Places = places(text);
    let mut files = Vec::new();
    for index in 0.. {
        let Some(place) = places.of(text, EntityId::Texture(index)) else {
            break;
        };
        let name = place
            .given("filename")
            .and_then(|given| text.get(given.values.first()?.clone()));
        if let Some(name) = name {
            let path = folder.join(&*String::from_utf8_lossy(name));
            if !files.contains(&path) {
                files.push(path);
            }
        }
    }
    files
}

fn seen(files: Vec<PathBuf>) -> Vec<Seen> {
    let stamped = |path: PathBuf| {
        let stamp = Stamp::of(&path);
        (path, stamp)
    };
    files.into_iter().map(stamped).collect()
}

/// What was found at each look.
#[derive(Debug, Default)]
struct Looks {
    files: Vec<File>,
}

#[derive(Debug)]
struct File {
    path: PathBuf,
    /// What was read last, as far as is known.
    known: Option<Stamp>,
    /// What was found last.
    found: Option<Stamp>,
}

impl Looks {
    /// From now on these. Those that were watched before go on from what is known of them: one that was written between
    /// being read and being watched would be missed otherwise.
    fn turn_to(&mut self, files: Vec<Seen>) {
        let mut old = std::mem::take(&mut self.files);
        for (path, found) in files {
            let before = old.iter().position(|file| file.path == path);
            let file = before.map(|index| old.swap_remove(index));
            self.files.push(file.unwrap_or_else(|| File {
                path,
                known: found.clone(),
                found,
            }));
        }
    }

    /// Whether one of them is another than the one that is known, and stayed so since the last look.
    fn look(&mut self, stamp: impl Fn(&Path) -> Option<Stamp>) -> bool {
        let mut written = false;
        for file in &mut self.files {
            let found = stamp(&file.path);
            if found == file.found && found != file.known {
                file.known.clone_from(&found);
                written = true;
            }
            file.found = found;
        }
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_files_are_those_that_the_text_names() {
        let text = b"camera c { pixeldim 1 1 worlddim 1 1 viewpoint 0 0 1 }
            texture a { filename pictures/a.ppm } texture b { filename /b.ppm } texture c { filename pictures/a.ppm }
            material oops { ambient }";
        assert_eq!(
            textures(text, Path::new("here")),
            [
                PathBuf::from("here/pictures/a.ppm"),
                PathBuf::from("/b.ppm")
            ]
        );
        assert!(textures(b"camera c {", Path::new("")).is_empty());
    }

    /// What is written after a file was looked at is news, however late the list comes to the thread.
    #[test]
    fn what_is_written_before_it_is_watched_counts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ppm");
        let files = seen(vec![path.clone()]);
        fs::write(&path, [0; 9]).unwrap();
        let mut looks = Looks::default();
        looks.turn_to(files);
        let look = |looks: &mut Looks| looks.look(Stamp::of);
        assert!(!look(&mut looks));
        assert!(look(&mut looks) && !look(&mut looks));
    }

    #[test]
    fn what_stays_written_counts_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ppm");
        let mut looks = Looks::default();
        let look = |looks: &mut Looks| looks.look(Stamp::of);
        looks.turn_to(seen(vec![path.clone()]));
        assert!(!look(&mut looks) && !look(&mut looks));
        // It appears, and while it grows it does not count.
        for length in 1..4 {
            fs::write(&path, vec![0; length]).unwrap();
            assert!(!look(&mut looks));
        }
        assert!(look(&mut looks));
        assert!(!look(&mut looks));
        // The same list again forgets nothing.
        fs::write(&path, [0; 9]).unwrap();
        assert!(!look(&mut looks));
        looks.turn_to(seen(vec![path.clone()]));
        assert!(look(&mut looks));
        // It goes.
        fs::remove_file(&path).unwrap();
        assert!(!look(&mut looks));
        assert!(look(&mut looks));
        looks.turn_to(Vec::new());
        fs::write(&path, [0; 9]).unwrap();
        assert!(!look(&mut looks) && !look(&mut looks));
    }
}

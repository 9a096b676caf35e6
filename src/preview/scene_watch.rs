//! Watching a scene: its file, and those of its textures. From what [`watch`](super::watch) finds to news for the
//! [`session`](super::session), read and parsed.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::session::News;
use super::watch::{News as Found, TextureWatch, Watcher, read, textures};

/// Tells of the scene until it is dropped.
#[derive(Debug)]
pub(super) struct SceneWatch {
    _file: Watcher,
    _textures: TextureWatch,
}

/// Reads, parses and tells: one at a time, so that what is told last is what was read last.
struct Teller<F> {
    path: PathBuf,
    tell: Mutex<F>,
}

impl<F: FnMut(News)> Teller<F> {
    fn tell(&self, found: impl FnOnce() -> Found) {
        let mut tell = self.tell.lock().unwrap_or_else(PoisonError::into_inner);
        tell(News::read(&self.path, found()));
    }
}

impl SceneWatch {
    /// Starts to watch. `tell` is called first with what there is, then whenever the file or a texture was written, on
    /// threads of its own, one at a time.
    ///
    /// # Errors
    /// When there can be no threads.
    pub(super) fn new(path: &Path, tell: impl FnMut(News) + Send + 'static) -> io::Result<Self> {
        let teller = Arc::new(Teller {
            path: path.to_owned(),
            tell: Mutex::new(tell),
        });
        let again = Arc::clone(&teller);
        let pictures = TextureWatch::new(move || again.tell(|| read(&again.path)))?;
        let watched = pictures.clone();
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let file = Watcher::new(path, move |found| {
            if let Found::Text(text) = &found {
                // Before it is parsed: a texture that is written meanwhile is read again.
                watched.turn_to(textures(text, &folder));
            }
            teller.tell(|| found);
        })?;
        Ok(Self {
            _file: file,
            _textures: pictures,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::sync::mpsc;
    use std::time::Duration;

    const SCENE: &str = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
        texture t { filename t.ppm }";

    #[test]
    fn a_texture_that_is_written_is_news() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.txt");
        fs::write(&path, SCENE).unwrap();
        let (sender, news) = mpsc::channel();
        let watch = SceneWatch::new(&path, move |news| {
            let News::Version(version) = news else {
                panic!("{news:?}");
            };
            let texel = |parsed: crate::preview::session::Parsed| {
                parsed.scene.textures[0].texels.rgb.clone()
            };
            sender.send(version.parsed.map(texel).ok()).unwrap();
        })
        .unwrap();
        let next = || news.recv_timeout(Duration::from_secs(20)).unwrap();
        // It is not there yet.
        assert_eq!(next(), None);
        let write = |rgb: &[u8; 3]| {
            let bytes = [b"P6 1 1 255\n", &rgb[..]].concat();
            let beside = folder.path().join("beside");
            fs::write(&beside, bytes).unwrap();
            fs::rename(&beside, folder.path().join("t.ppm")).unwrap();
        };
        for rgb in [[1, 2, 3], [3, 2, 1]] {
            write(&rgb);
            assert_eq!(next(), Some(rgb.to_vec()));
        }
        drop(watch);
    }
}

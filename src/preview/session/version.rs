//! Versions of the scene's file, as they are read, and the one that changes lie on.

use std::path::Path;
use std::sync::Arc;

use super::Mistakes;
use crate::preview::watch;
use crate::scene::{self, Places, Scene};

/// A version of the file, read and parsed.
#[derive(Debug)]
pub(in crate::preview) struct Version {
    /// Its text.
    pub(in crate::preview) text: Vec<u8>,
    /// The scene, or its mistakes as they are printed.
    pub(in crate::preview) parsed: Result<Parsed, Mistakes>,
}

/// A version of the file without mistakes.
#[derive(Debug, Clone)]
pub(in crate::preview) struct Parsed {
    /// The scene as the file has it.
    pub(in crate::preview) scene: Arc<Scene>,
    /// Where everything stands in the text.
    pub(in crate::preview) places: Arc<Places>,
}

impl Version {
    /// Parses a text. Takes as long as that takes: not for the window's thread.
    pub(in crate::preview) fn read(path: &Path, text: Vec<u8>) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let parsed = scene::parse(&path.display().to_string(), &text, folder)
            .map(|scene| Parsed {
                scene: Arc::new(scene),
                places: Arc::new(scene::places(&text)),
            })
            .map_err(|mistakes| Mistakes {
                count: mistakes.total(),
                text: mistakes.render(false),
            });
        Self { text, parsed }
    }
}

/// What is known of the file.
#[derive(Debug)]
pub(in crate::preview) enum News {
    /// It was written.
    Version(Version),
    /// It is not there any more.
    Gone,
    /// It cannot be read.
    Unreadable(String),
}

impl News {
    /// From what the watcher tells.
    pub(in crate::preview) fn read(path: &Path, news: watch::News) -> Self {
        match news {
            watch::News::Text(text) => Self::Version(Version::read(path, text)),
            watch::News::Gone => Self::Gone,
            watch::News::Unreadable(why) => Self::Unreadable(why),
        }
    }
}

/// A version of the file that came from elsewhere.
#[derive(Debug)]
pub(super) struct Origin {
    pub(super) scene: Arc<Scene>,
    pub(super) text: Arc<Vec<u8>>,
    /// The same scene, of the size that was asked for.
    pub(super) sized: Arc<Scene>,
}

impl Origin {
    pub(super) fn new(scene: Arc<Scene>, text: Arc<Vec<u8>>, size: Option<[u32; 2]>) -> Self {
        let mut sized = Arc::clone(&scene);
        if let Some(size) = size
            && size != sized.camera.pixeldim
        {
            Arc::make_mut(&mut sized).camera.pixeldim = size;
        }
        Self { scene, text, sized }
    }

    /// With the textures of another version that has the same text but for numbers.
    pub(super) fn set_textures(&mut self, from: &Scene) -> bool {
        let is_new = self.scene.textures != from.textures;
        if is_new {
            for scene in [&mut self.scene, &mut self.sized] {
                Arc::make_mut(scene).textures.clone_from(&from.textures);
            }
        }
        is_new
    }
}

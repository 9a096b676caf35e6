//! The scene file and what is changed on top of it: what the window shows, without the window.
//!
//! Takes what the watcher tells and what the user does; says what is to be rendered, and writes changes into the file.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::watch;
use crate::edit::{Changes, Target, Value};
use crate::image::{Document, Target as File};
use crate::scene::{self, EntityId, Object, Places, Scene, Surface};

/// A version of the file, read and parsed.
#[derive(Debug)]
pub(super) struct Version {
    /// Its text.
    pub(super) text: Vec<u8>,
    /// The scene, or its mistakes as they are printed.
    pub(super) parsed: Result<Parsed, String>,
}

/// A version of the file without mistakes.
#[derive(Debug, Clone)]
pub(super) struct Parsed {
    /// The scene as the file has it.
    pub(super) scene: Arc<Scene>,
    /// Where everything stands in the text.
    pub(super) places: Arc<Places>,
}

impl Version {
    /// Parses a text. Takes as long as that takes: not for the window's thread.
    pub(super) fn read(path: &Path, text: Vec<u8>) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let parsed = scene::parse(&path.display().to_string(), &text, folder)
            .map(|scene| Parsed {
                scene: Arc::new(scene),
                places: Arc::new(scene::places(&text)),
            })
            .map_err(|mistakes| mistakes.render(false));
        Self { text, parsed }
    }
}

/// What is known of the file.
#[derive(Debug)]
pub(super) enum News {
    /// It was written.
    Version(Version),
    /// It is not there any more.
    Gone,
    /// It cannot be read.
    Unreadable(String),
}

impl News {
    /// From what the watcher tells.
    pub(super) fn read(path: &Path, news: watch::News) -> Self {
        match news {
            watch::News::Text(text) => Self::Version(Version::read(path, text)),
            watch::News::Gone => Self::Gone,
            watch::News::Unreadable(why) => Self::Unreadable(why),
        }
    }
}

/// Where something stands in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    /// Its line, from 1.
    pub(super) line: usize,
    /// Its text.
    pub(super) text: String,
}

/// The type and the name of an entity, as the file says them.
pub(super) fn title(scene: &Scene, entity: EntityId) -> Option<(&'static str, &str)> {
    match entity {
        EntityId::Camera => Some(("camera", &scene.camera.name)),
        EntityId::Object(i) => scene.objects.get(i).map(|it| (it.entity(), &*it.name)),
        EntityId::Material(i) => scene.materials.get(i).map(|it| ("material", &*it.name)),
        EntityId::Light(i) => scene.lights.get(i).map(|it| (it.entity(), &*it.name)),
        EntityId::Texture(i) => scene.textures.get(i).map(|it| ("texture", &*it.name)),
    }
}

/// Whether an object is this entity, or made of it.
pub(super) fn shows(scene: &Scene, object: usize, entity: EntityId) -> bool {
    let Some(Object {
        material, surface, ..
    }) = scene.objects.get(object)
    else {
        return false;
    };
    match entity {
        EntityId::Object(i) => i == object,
        EntityId::Material(i) => {
            *material == i
                || match surface {
                    Surface::Tiled { altmaterial, .. } => *altmaterial == i,
                    Surface::Plain | Surface::Procedural { .. } | Surface::Textured { .. } => false,
                }
        }
        EntityId::Texture(i) => match surface {
            Surface::Textured { texture, .. } => *texture == i,
            Surface::Plain | Surface::Procedural { .. } | Surface::Tiled { .. } => false,
        },
        // Cameras and lights are not seen in the picture.
        EntityId::Camera | EntityId::Light(_) => false,
    }
}

/// Why what is shown is not what the file says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The file has mistakes: as they are printed.
    Mistakes(String),
    /// The file is not there.
    Gone,
    /// The file cannot be read.
    Unreadable(String),
}

/// The file, its last good version, and what is changed on top of that.
#[derive(Debug)]
pub(super) struct Session {
    /// The file.
    pub(super) path: PathBuf,
    /// Columns and rows of the picture, in place of the file's.
    size: Option<[u32; 2]>,
    /// The last version without mistakes, and its text.
    good: Option<(Parsed, Arc<Vec<u8>>)>,
    /// What is rendered: that version, of the size that was asked for.
    sized: Option<Arc<Scene>>,
    /// What is changed on top of it.
    changes: Changes,
    /// What is wrong with the file now.
    pub(super) trouble: Option<Trouble>,
    /// What became of changes and saving, for the user to read.
    pub(super) said: Vec<String>,
}

impl Session {
    /// Of a file of which nothing is known yet.
    pub(super) fn new(path: PathBuf, size: Option<[u32; 2]>) -> Self {
        Self {
            path,
            size,
            good: None,
            sized: None,
            changes: Changes::default(),
            trouble: None,
            said: Vec::new(),
        }
    }

    /// The file's name without its folder.
    pub(super) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// The last good version.
    pub(super) fn good(&self) -> Option<&Parsed> {
        self.good.as_ref().map(|(parsed, _)| parsed)
    }

    /// Where something stands in the file.
    pub(super) fn source(&self, entity: EntityId) -> Option<Source> {
        let (parsed, text) = self.good.as_ref()?;
        let span = parsed.places.of(text, entity)?.span;
        Some(Source {
            line: scene::line(text, span.start).0,
            text: String::from_utf8_lossy(text.get(span)?).into_owned(),
        })
    }

    /// What is to be rendered: a scene, and what is changed on top of it.
    pub(super) fn wanted(&self) -> Option<(&Arc<Scene>, &Changes)> {
        self.sized.as_ref().map(|scene| (scene, &self.changes))
    }

    /// What is changed on top of the file.
    pub(super) fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Something happened to the file. Whether there is something else to be rendered.
    pub(super) fn news(&mut self, news: News) -> bool {
        match news {
            News::Gone => self.trouble = Some(Trouble::Gone),
            News::Unreadable(why) => self.trouble = Some(Trouble::Unreadable(why)),
            News::Version(Version {
                parsed: Err(mistakes),
                ..
            }) => self.trouble = Some(Trouble::Mistakes(mistakes)),
            News::Version(Version {
                text,
                parsed: Ok(parsed),
            }) => {
                self.trouble = None;
                return self.take(parsed, text);
            }
        }
        false
    }

    /// Takes a version over. Whether there is something else to be rendered.
    fn take(&mut self, parsed: Parsed, text: Vec<u8>) -> bool {
        let mut same = false;
        let changed_before = self.changes.clone();
        if let Some((old, _)) = &self.good {
            same = old.scene == parsed.scene;
            let dropped = self.changes.rebase(&old.scene, &parsed.scene);
            self.said.extend(dropped.iter().map(ToString::to_string));
        }
        same &= changed_before == self.changes;
        if !same {
            let mut sized = Arc::clone(&parsed.scene);
            if let Some(size) = self.size
                && size != sized.camera.pixeldim
            {
                Arc::make_mut(&mut sized).camera.pixeldim = size;
            }
            self.sized = Some(sized);
        }
        self.good = Some((parsed, Arc::new(text)));
        !same
    }

    /// How many changes there are besides the viewpoint, which one changes by looking around.
    pub(super) fn to_be_lost(&self) -> usize {
        let looks = self.changes.get(Target::Viewpoint).is_some();
        self.changes.len() - usize::from(looks)
    }

    /// A value as it is shown: the change, else what the file has.
    pub(super) fn value(&self, target: Target) -> Option<Value> {
        let (scene, changes) = self.wanted()?;
        changes.get(target).or_else(|| target.value_in(scene))
    }

    /// Changes a value on top of the file; to what the file has is no change. What the scene language does not allow is
    /// said, and changes nothing. Whether there is something else to be rendered.
    pub(super) fn set(&mut self, target: Target, value: Value) -> bool {
        let Some(scene) = &self.sized else {
            return false;
        };
        let before = self.changes.get(target);
        if target.value_in(scene) == Some(value) {
            self.changes.remove(target);
        } else if let Err(refused) = self.changes.set(target, value) {
            self.said.push(refused.to_string());
        }
        before != self.changes.get(target)
    }

    /// Back to what the file has, of this or of everything. Whether there is something else to be rendered.
    pub(super) fn discard(&mut self, target: Option<Target>) -> bool {
        let before = self.changes.clone();
        match target {
            Some(target) => {
                self.changes.remove(target);
            }
            None => self.changes.clear(),
        }
        before != self.changes
    }

    /// What it takes to write all changes into the file.
    ///
    /// # Errors
    /// Why that cannot be, in a sentence.
    pub(super) fn saving(&self) -> Result<Saving, String> {
        match &self.trouble {
            None => {}
            Some(Trouble::Mistakes(_)) => {
                return Err("not saved: the file has a mistake; mend that first".into());
            }
            Some(Trouble::Gone) => return Err("not saved: the file is gone".into()),
            Some(Trouble::Unreadable(why)) => return Err(format!("not saved: {why}")),
        }
        let Some((_, text)) = &self.good else {
            return Err("not saved: there is no scene yet".into());
        };
        if self.changes.is_empty() {
            return Err("nothing is changed".into());
        }
        Ok(Saving {
            path: self.path.clone(),
            text: Arc::clone(text),
            changes: self.changes.clone(),
        })
    }
}

/// Changes on their way into the file. Takes as long as reading it: not for the window's thread.
#[derive(Debug)]
pub(super) struct Saving {
    path: PathBuf,
    text: Arc<Vec<u8>>,
    changes: Changes,
}

impl Saving {
    /// Writes the changes into the file, touching nothing else in it. A file that was changed meanwhile is not touched.
    /// What the file is now, and what was done, in a sentence.
    ///
    /// # Errors
    /// Why not, in a sentence; then the file is as it was.
    pub(super) fn run(self) -> Result<(Version, String), String> {
        let Self {
            path,
            text,
            changes,
        } = self;
        let now = fs::read(&path).map_err(|error| format!("not saved: {error}"))?;
        if now != *text {
            return Err("not saved: the file has just been written; try again".into());
        }
        let written = changes
            .write(&text)
            .map_err(|error| format!("not saved: {error}"))?;
        let target = File::Path(path.clone());
        Document::open(&target)
            .and_then(|document| document.write(&written))
            .map_err(|error| format!("not saved: {error}"))?;
        let name = path.file_name().unwrap_or(path.as_os_str());
        let name = name.to_string_lossy();
        let said = match changes.len() {
            1 => format!("saved a change into {name}"),
            count => format!("saved {count} changes into {name}"),
        };
        Ok((Version::read(&path, written), said))
    }
}

#[cfg(test)]
mod tests;

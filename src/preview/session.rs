//! The scene file and what is changed on top of it: what the window shows, without the window.
//!
//! Takes what the watcher tells and what the user does; says what is to be rendered, and writes changes into the file.

mod rendered;
mod report;
mod saving;
mod version;

use std::path::PathBuf;
use std::sync::Arc;

pub(super) use saving::Saving;
pub(super) use version::{News, Parsed, Version};

use super::rendering::Rendering;
use super::undo::{self, Direction, History, Step};
use crate::edit::{Changes, Refused, Target, Value};
use crate::scene::{self, EntityId, Scene};
use version::Origin;

/// Where something stands in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    /// Its line, from 1.
    pub(super) line: usize,
    /// Its text.
    pub(super) text: String,
}

/// The mistakes of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mistakes {
    /// How many there are.
    pub(super) count: usize,
    /// They as they are printed.
    pub(super) text: String,
}

/// Why what is shown is not what the file says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The file has mistakes.
    Mistakes(Mistakes),
    /// The file is not there.
    Gone,
    /// The file cannot be read.
    Unreadable(String),
}

/// The file, its last good version, and what is changed on top of that.
///
/// Changes lie on top of the text as it was when it last came from elsewhere, its origin; what is saved is changes that
/// the file has too. So that text is what is saved again once all changes are undone, byte for byte.
#[derive(Debug)]
pub(super) struct Session {
    /// The file.
    pub(super) path: PathBuf,
    /// Columns and rows of the picture, in place of the file's.
    size: Option<[u32; 2]>,
    /// How the picture is rendered.
    rendering: Rendering,
    /// The last version without mistakes, and its text.
    good: Option<(Parsed, Arc<Vec<u8>>)>,
    /// What changes are on top of: that version, or the one that it was made from by saving them.
    origin: Option<Origin>,
    /// What is changed on top of the origin.
    changes: Changes,
    /// What of it the file has.
    saved: Changes,
    /// What is being written into the file: that text, and the changes in it.
    writing: Option<(Arc<Vec<u8>>, Changes)>,
    /// What was changed before, and what was undone.
    history: History,
    /// Raised when entities may have other indices than before.
    pub(super) generation: u64,
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
            rendering: Rendering::default(),
            good: None,
            origin: None,
            changes: Changes::new(),
            saved: Changes::new(),
            writing: None,
            history: History::default(),
            generation: 0,
            trouble: None,
            said: Vec::new(),
        }
    }

    /// The file's name without its folder.
    pub(super) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// The file's last version without mistakes.
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
        self.origin
            .as_ref()
            .map(|origin| (&origin.sized, &self.changes))
    }

    /// What the file does not have.
    pub(super) fn unsaved(&self) -> Changes {
        match &self.origin {
            Some(origin) => self.changes.beyond(&self.saved, &origin.scene),
            None => Changes::new(),
        }
    }

    /// Whether the file has another value there.
    pub(super) fn is_changed(&self, target: Target) -> bool {
        self.value(target) != self.value_in_file(target)
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
        let writing = self.writing.take();
        let (Some((old, old_text)), Some(origin)) = (&self.good, &mut self.origin) else {
            let text = Arc::new(text);
            let scene = Arc::clone(&parsed.scene);
            self.origin = Some(Origin::new(scene, Arc::clone(&text), self.size));
            self.good = Some((parsed, text));
            self.report_file("file");
            return true;
        };
        if let Some((_, saved)) = writing.filter(|(written, _)| **written == text) {
            // This is what was saved here, on top of the same origin.
            let is_new = origin.set_textures(&parsed.scene);
            self.saved = saved;
            self.history.end_step();
            self.good = Some((parsed, Arc::new(text)));
            self.report_file("saved");
            return is_new;
        }
        if **old_text == text {
            let is_new = origin.set_textures(&parsed.scene);
            self.good = Some((parsed, Arc::new(text)));
            return is_new;
        }
        let unsaved = self.changes.beyond(&self.saved, &origin.scene);
        let scenes = [&*old.scene, &*parsed.scene];
        let (mut kept, mut lost) = (unsaved.clone(), unsaved.clone());
        let dropped = kept.rebase(scenes[0], scenes[1]);
        self.said.extend(dropped.iter().map(ToString::to_string));
        Changes::rebase_earlier([&mut lost].into_iter(), scenes[0], scenes[1]);
        self.history.rebase(&self.saved, &origin.scene, scenes);
        if lost != kept {
            // What the file took away can be brought back.
            self.history.record(lost, Step::Alone);
        }
        let same = old.scene == parsed.scene && unsaved == kept;
        let text = Arc::new(text);
        let scene = Arc::clone(&parsed.scene);
        *origin = Origin::new(scene, Arc::clone(&text), self.size);
        self.good = Some((parsed, text));
        (self.changes, self.saved) = (kept, Changes::new());
        self.generation += 1;
        self.report_file("file");
        !same
    }

    /// How many changes there are besides the viewpoint, which one changes by looking around.
    pub(super) fn to_be_lost(&self) -> usize {
        let unsaved = self.unsaved();
        let looks = unsaved.get(Target::VIEWPOINT).is_some();
        unsaved.len() - usize::from(looks)
    }

    /// A value as it is shown: the change, else what the file has.
    pub(super) fn value(&self, target: Target) -> Option<Value> {
        let origin = self.origin.as_ref()?;
        let change = self.changes.get(target);
        change.or_else(|| target.value_in(&origin.scene))
    }

    /// A value as the file has it.
    pub(super) fn value_in_file(&self, target: Target) -> Option<Value> {
        let origin = self.origin.as_ref()?;
        let saved = self.saved.get(target);
        saved.or_else(|| target.value_in(&origin.scene))
    }

    /// Why a value cannot be changed although the language lets it.
    pub(super) fn is_fixed(&self, target: Target) -> Option<&'static str> {
        let is_size = target == Target::new(EntityId::Camera, "pixeldim");
        (is_size && self.size.is_some()).then_some("--size counts, and not the file's pixeldim")
    }

    /// Whether a value may be there, beside what else is changed.
    pub(super) fn allows(&self, target: Target, value: Value) -> bool {
        let mut changes = self.changes.clone();
        let origin = self.origin.as_ref();
        origin.is_some_and(|origin| changes.set(&origin.scene, target, value).is_ok())
    }

    /// Changes a value on top of the file; to what the file has is no change. What the scene language does not allow is
    /// said, and changes nothing. Whether there is something else to be rendered.
    pub(super) fn set(&mut self, target: Target, value: Value, step: Step) -> bool {
        if let Some(why) = self.is_fixed(target) {
            self.said.push(why.into());
            return false;
        }
        self.change(step, |changes, scene| {
            if target.value_in(scene) == Some(value) {
                changes.reset(scene, target).map(|_| ())
            } else {
                changes.set(scene, target, value)
            }
        })
    }

    /// Back to what the file has, of this or of everything. Whether there is something else to be rendered.
    pub(super) fn discard(&mut self, target: Option<Target>) -> bool {
        let Some(target) = target else {
            let saved = self.saved.clone();
            return self.change(Step::Alone, |changes, _| {
                *changes = saved;
                Ok(())
            });
        };
        match self.value_in_file(target) {
            Some(value) => self.set(target, value, Step::Alone),
            None => false,
        }
    }

    /// Changes something, as a step that can be undone, or a part of one.
    fn change(
        &mut self,
        step: Step,
        change: impl FnOnce(&mut Changes, &Scene) -> Result<(), Refused>,
    ) -> bool {
        let Some(origin) = &self.origin else {
            return false;
        };
        let before = self.changes.clone();
        if let Err(refused) = change(&mut self.changes, &origin.scene) {
            self.said.push(refused.to_string());
        }
        let is_new = before != self.changes;
        if is_new {
            let continues = self.history.record(before, step);
            self.report(if continues { "changed on" } else { "changed" });
        }
        is_new
    }

    /// Takes the last step back, or forward again. Whether there is something else to be rendered.
    pub(super) fn step_back(&mut self, direction: Direction) -> bool {
        let Some(changes) = self.history.go(direction, &self.changes) else {
            self.said.push(direction.nothing().into());
            return false;
        };
        let before = std::mem::replace(&mut self.changes, changes);
        if let Some(origin) = &self.origin {
            let differs = before.beyond(&self.changes, &origin.scene);
            let what = undo::described(&differs, &origin.scene);
            self.said.push(format!("{} {what}", direction.done()));
        }
        self.report(direction.done());
        true
    }

    /// Whether there is something to be taken back, or forward again.
    pub(super) fn can_step(&self, direction: Direction) -> bool {
        self.history.can_go(direction, &self.changes)
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
        let (Some((_, text)), Some(origin)) = (&self.good, &self.origin) else {
            return Err("not saved: there is no scene yet".into());
        };
        let count = self.unsaved().len();
        if count == 0 {
            return Err("nothing is changed".into());
        }
        Ok(Saving {
            path: self.path.clone(),
            file: Arc::clone(text),
            origin: Arc::clone(&origin.text),
            changes: self.changes.clone(),
            count,
        })
    }

    /// This text is about to be written into the file, with these changes.
    pub(super) fn expect(&mut self, text: Arc<Vec<u8>>, changes: Changes) {
        self.writing = Some((text, changes));
    }

    /// What was expected is in the file, or will not be. If the file was heard of meanwhile, that counts.
    pub(super) fn finish_saving(&mut self, version: Option<Version>) -> bool {
        match (version, &self.writing) {
            (Some(version), Some((text, _))) if **text == version.text => {
                self.news(News::Version(version))
            }
            _ => {
                self.writing = None;
                false
            }
        }
    }
}

#[cfg(test)]
mod tests;

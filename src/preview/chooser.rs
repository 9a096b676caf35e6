//! Which scene to open, or where a new one is to be: its path, typed, completed, or picked from what is in the folder.
//!
//! This dialog is the window's own, so it is there on every desktop; "Browse…" asks for the desktop's.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Align2, Context, Key, Modifiers, RichText, Ui};

/// Entries of a folder that are looked at.
const MOST_ENTRIES: usize = 10_000;

/// What the path is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// A scene that is there.
    Open,
    /// One that is not there yet.
    New,
}

/// The dialog.
#[derive(Debug)]
pub(super) struct Chooser {
    /// What for.
    pub(super) purpose: Purpose,
    /// The path as it is typed.
    text: String,
    /// Why what was entered is not taken.
    pub(super) trouble: Option<String>,
    /// Whether the desktop's dialog was asked for and has not answered.
    pub(super) browsing: bool,
    /// The folder that was read last, and the names in it; those of folders end in `/`.
    entries: (PathBuf, Vec<String>),
    /// Whether the field has to be given the keyboard, and its cursor be put behind the text.
    fresh: bool,
}

/// What came of a frame of it.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// Nothing yet.
    Open,
    /// To close it.
    Cancel,
    /// To ask the desktop's dialog.
    Browse,
    /// This path.
    Path(PathBuf),
}

impl Chooser {
    /// Begins in a folder; a new scene has a name to begin with.
    pub(super) fn new(purpose: Purpose, folder: &Path) -> Self {
        let mut text = folder.display().to_string();
        if !text.is_empty() && !text.ends_with('/') {
            text.push('/');
        }
        if purpose == Purpose::New {
            text.push_str("scene.txt");
        }
        Self {
            purpose,
            text,
            trouble: None,
            browsing: false,
            entries: (PathBuf::new(), Vec::new()),
            fresh: true,
        }
    }

    /// Shows it.
    pub(super) fn show(&mut self, context: &Context) -> Choice {
        let title = match self.purpose {
            Purpose::Open => "Open a scene",
            Purpose::New => "A new scene",
        };
        let mut open = true;
        let mut choice = Choice::Open;
        egui::Window::new(title)
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
            .show(context, |ui| choice = self.inside(ui));
        if open && !context.input(|input| input.key_pressed(Key::Escape)) {
            choice
        } else {
            Choice::Cancel
        }
    }

    fn inside(&mut self, ui: &mut Ui) -> Choice {
        let mut choice = Choice::Open;
        ui.set_max_width((ui.ctx().content_rect().width() - 60.0).min(560.0));
        let hint = match self.purpose {
            Purpose::Open => "Its path; Tab completes it:",
            Purpose::New => "Where it is to be. It gets a ball, a floor and a lamp to begin with:",
        };
        let label = ui.label(hint);
        let id = ui.scope_id().with("path");
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        if has_focus && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Tab)) {
            self.complete();
        }
        let field = egui::TextEdit::singleline(&mut self.text)
            .id(id)
            .lock_focus(true)
            .desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label.id);
        if field.changed() {
            self.trouble = None;
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if std::mem::take(&mut self.fresh) {
            field.request_focus();
            let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
            let end = egui::text::CCursor::new(self.text.chars().count());
            let range = egui::text::CCursorRange::one(end);
            state.cursor.set_char_range(Some(range));
            state.store(ui.ctx(), id);
        }
        if let Some(trouble) = &self.trouble {
            let color = ui.visuals().error_fg_color;
            ui.add(egui::Label::new(RichText::new(trouble).color(color)).wrap());
        }
        if let Some(picked) = self.list(ui) {
            choice = picked;
        }
        ui.horizontal(|ui| {
            let verb = match self.purpose {
                Purpose::Open => "Open",
                Purpose::New => "Create",
            };
            if ui.button(verb).clicked() || entered {
                choice = self.enter();
            }
            let browse = egui::Button::new("Browse…");
            let browse = ui.add_enabled(!self.browsing, browse).on_hover_text(
                "the desktop's own dialog; it needs xdg-desktop-portal or zenity on Linux",
            );
            if browse.clicked() {
                choice = Choice::Browse;
            }
            if ui.button("Cancel").clicked() {
                choice = Choice::Cancel;
            }
        });
        choice
    }

    /// What is in the folder and begins with what is typed.
    fn list(&mut self, ui: &mut Ui) -> Option<Choice> {
        let (folder, matching) = self.matching();
        let mut picked = None;
        egui::ScrollArea::vertical()
            .id_salt("entries")
            .max_height((ui.ctx().content_rect().height() - 190.0).clamp(40.0, 240.0))
            .auto_shrink([false, true])
            .show(ui, |ui| {
                for name in &matching {
                    if ui.selectable_label(false, name).clicked() {
                        picked = Some(format!("{folder}{name}"));
                    }
                }
            });
        self.text = picked?;
        self.trouble = None;
        self.fresh = true;
        let is_file = !self.text.ends_with('/') && self.purpose == Purpose::Open;
        is_file.then(|| self.enter())
    }

    /// The folder as it is typed, and the names in it that go on as what is typed behind it.
    fn matching(&mut self) -> (String, Vec<String>) {
        let end = self.text.rfind('/').map_or(0, |slash| slash + 1);
        let (folder, begun) = self.text.split_at(end);
        let path = expanded(folder);
        let path = if path.as_os_str().is_empty() {
            PathBuf::from(".")
        } else {
            path
        };
        if self.entries.0 != path {
            self.entries = (path.clone(), read(&path));
        }
        let shown = |name: &&String| {
            name.starts_with(begun) && (begun.starts_with('.') || !name.starts_with('.'))
        };
        let names = self.entries.1.iter().filter(shown).cloned().collect();
        (folder.to_owned(), names)
    }

    /// Goes on with what is typed as far as all names agree.
    fn complete(&mut self) {
        let (folder, matching) = self.matching();
        let mut matching = matching.into_iter();
        let Some(mut common) = matching.next() else {
            return;
        };
        for name in matching {
            let same = common.chars().zip(name.chars()).take_while(|(a, b)| a == b);
            let length = same.map(|(a, _)| a.len_utf8()).sum();
            common.truncate(length);
        }
        let completed = format!("{folder}{common}");
        if completed.len() > self.text.len() {
            self.text = completed;
        }
        self.fresh = true;
    }

    /// Takes the path, if it can be.
    fn enter(&mut self) -> Choice {
        self.fresh = true;
        let path = expanded(self.text.trim());
        let trouble = match self.purpose {
            _ if path.as_os_str().is_empty() => "say a path".to_owned(),
            Purpose::Open if path.is_dir() => {
                if !self.text.ends_with('/') {
                    self.text.push('/');
                }
                return Choice::Open;
            }
            Purpose::Open if path.exists() => return Choice::Path(path),
            Purpose::Open => format!("there is no file {}", path.display()),
            Purpose::New if path.exists() => {
                format!(
                    "{} is there already; a new scene takes no other's place",
                    path.display()
                )
            }
            Purpose::New => return Choice::Path(path),
        };
        self.trouble = Some(trouble);
        Choice::Open
    }
}

/// The path that is meant: `~/` is the user's home.
fn expanded(text: &str) -> PathBuf {
    match (text.strip_prefix("~/"), std::env::home_dir()) {
        (Some(rest), Some(home)) => home.join(rest),
        _ => PathBuf::from(text),
    }
}

/// The names in a folder, sorted, folders first and with a `/`; none where it cannot be read.
fn read(folder: &Path) -> Vec<String> {
    let Ok(entries) = folder.read_dir() else {
        return Vec::new();
    };
    let names = entries.take(MOST_ENTRIES).flatten().filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        let is_folder = entry.path().is_dir();
        Some((!is_folder, if is_folder { name + "/" } else { name }))
    });
    let mut names: Vec<_> = names.collect();
    names.sort();
    names.into_iter().map(|(_, name)| name).collect()
}

#[cfg(test)]
mod tests;

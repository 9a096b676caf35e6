//! Another scene in the same window: opened, dropped on it, or begun.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Align2, Context, FontId};

use super::App;
use super::events::Event;
use crate::preview::chooser::{Choice, Chooser, Purpose};
use crate::preview::scene_watch::SceneWatch;
use crate::preview::selection::Selection;
use crate::preview::session::Session;
use crate::preview::start::Start;
use crate::preview::viewport::Viewport;

/// What a new scene is.
const TEMPLATE: &str = include_str!("../template.txt");

impl App {
    /// Asks for a path.
    pub(super) fn choose(&mut self, purpose: Purpose) {
        let folder = match self.options.path.as_deref().and_then(Path::parent) {
            Some(folder) => folder.to_owned(),
            None => PathBuf::new(),
        };
        self.chooser = Some(Chooser::new(purpose, &folder));
    }

    /// What the start page wants.
    pub(super) fn start(&mut self, start: Start) {
        match start {
            Start::Open => self.choose(Purpose::Open),
            Start::New => self.choose(Purpose::New),
            Start::Scene(path) => self.open(path),
        }
    }

    /// Shows the dialog that asks for a path, and does what comes of it.
    pub(super) fn show_chooser(&mut self, context: &Context) {
        let Some(chooser) = &mut self.chooser else {
            return;
        };
        let purpose = chooser.purpose;
        match chooser.show(context) {
            Choice::Open => {}
            Choice::Cancel => self.chooser = None,
            Choice::Browse => {
                chooser.browsing = true;
                self.browse(purpose);
            }
            Choice::Path(path) => self.chosen(purpose, path),
        }
    }

    /// Asks for a path in the desktop's own dialog.
    fn browse(&mut self, purpose: Purpose) {
        let folder = self.options.path.as_deref().and_then(Path::parent);
        let mut dialog = rfd::AsyncFileDialog::new();
        if let Some(folder) = folder.and_then(|folder| fs::canonicalize(folder).ok()) {
            dialog = dialog.set_directory(folder);
        }
        let teller = self.teller.clone();
        // Some systems want it begun on this thread; it is waited for on another, which is not waited for at the end.
        let ask = async move {
            match purpose {
                Purpose::Open => dialog.set_title("Open a scene").pick_file().await,
                Purpose::New => {
                    let dialog = dialog.set_title("A new scene").set_file_name("scene.txt");
                    dialog.save_file().await
                }
            }
        };
        let ask = Box::pin(ask);
        let asked = std::thread::Builder::new()
            .name("browse".into())
            .spawn(move || {
                let path = pollster::block_on(ask).map(|file| file.path().to_owned());
                teller.tell(Event::Browsed(purpose, path));
            });
        if let Err(error) = asked {
            self.say(format!("the desktop's dialog cannot be asked: {error}"));
        }
    }

    /// What the desktop's dialog said.
    pub(super) fn browsed(&mut self, purpose: Purpose, path: Option<PathBuf>) {
        // The dialog may have been closed meanwhile; then the answer is not wanted any more.
        let Some(chooser) = self.chooser.as_mut().filter(|it| it.purpose == purpose) else {
            return;
        };
        chooser.browsing = false;
        match path {
            Some(path) => self.chosen(purpose, path),
            None => {
                chooser.trouble = Some(
                    "the desktop's dialog gave no file; where there is none (xdg-desktop-portal or zenity), this \
                     field does"
                        .to_owned(),
                );
            }
        }
    }

    fn chosen(&mut self, purpose: Purpose, path: PathBuf) {
        let made = match purpose {
            Purpose::Open => Ok(()),
            Purpose::New => create(&path),
        };
        match (made, &mut self.chooser) {
            (Ok(()), _) => {
                self.chooser = None;
                self.open(path);
            }
            (Err(why), Some(chooser)) => chooser.trouble = Some(why),
            (Err(why), None) => self.say(why),
        }
    }

    /// Opens a scene, once changes to this one are saved or given up.
    pub(super) fn open(&mut self, path: PathBuf) {
        self.leaving.ask();
        self.next = Some(path);
    }

    /// Takes a file that is dropped on the window, and says so while one hovers over it.
    pub(super) fn take_dropped(&mut self, context: &Context) {
        let (dropped, hovers) = context.input(|input| {
            let dropped = input.raw.dropped_files.first();
            let dropped = dropped.map(|file| file.path().to_owned());
            (dropped, !input.raw.hovered_files.is_empty())
        });
        if let Some(path) = dropped
            && !self.leaving.asks()
        {
            self.chooser = None;
            self.open(path);
        }
        if hovers {
            let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop"));
            let painter = context.layer_painter(layer);
            let rect = context.content_rect();
            painter.rect_filled(rect, 0.0, egui::Color32::from_black_alpha(160));
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                "drop the scene to open it",
                FontId::proportional(22.0),
                egui::Color32::WHITE,
            );
        }
    }

    /// Turns to another scene. What belongs to the one before is forgotten.
    pub(super) fn turn_to(&mut self, path: PathBuf) {
        let mut session = Session::new(path.clone(), self.options.size);
        {
            let mut state = self.shared.lock();
            session.render_as(state.session.rendering());
            state.session = session;
            self.since = state.wished;
        }
        self.picture = None;
        self.failed = None;
        self.panel = Default::default();
        self.side.selection = Selection::default();
        (self.seen, self.outlined, self.asked) = (None, None, None);
        (self.over, self.clicked, self.grabbed) = (None, None, None);
        self.hinted = None;
        self.hints.take(Vec::new());
        self.showing.viewport = Viewport::Fit;
        self.showing.outlined = None;
        log::info!("opened {}", path.display());
        self.recent.opened(&path);
        match self.watching(&path) {
            Ok(watch) => self.watch = Some(watch),
            Err(error) => self.say(format!("{} is not followed: {error}", path.display())),
        }
        self.options.path = Some(path);
    }

    /// Follows a scene's file, and its textures.
    pub(super) fn watching(&self, path: &Path) -> std::io::Result<SceneWatch> {
        let (shared, teller) = (self.shared.clone(), self.teller.clone());
        let of = path.to_owned();
        SceneWatch::new(path, move |news| {
            // What is rendered now wakes the window when it is there.
            if !shared.news_of(&of, news) {
                teller.tell(Event::File);
            }
        })
    }
}

/// Writes a scene to begin with, where no file is yet.
fn create(path: &Path) -> Result<(), String> {
    let refused =
        |error: std::io::Error| format!("{}: {}", path.display(), crate::files::reason(&error));
    let mut file = fs::File::create_new(path).map_err(refused)?;
    file.write_all(TEMPLATE.as_bytes()).map_err(refused)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{lines_of, parse, places, remarks};

    #[test]
    fn a_new_scene_is_a_good_one_and_takes_no_other_ones_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new.txt");
        create(&path).unwrap();
        let text = fs::read(&path).unwrap();
        let scene = parse("new.txt", &text, Path::new("")).unwrap();
        let places = places(&text);
        assert!(remarks(&scene, 0.0, &lines_of(&text, &places)).is_empty());
        fs::write(&path, "mine").unwrap();
        assert!(create(&path).is_err());
        assert_eq!(fs::read(&path).unwrap(), b"mine");
        let nowhere = folder.path().join("none/new.txt");
        let why = create(&nowhere).unwrap_err();
        assert!(why.ends_with("there is no such file"), "{why}");
    }
}

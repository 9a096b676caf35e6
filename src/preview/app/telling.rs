//! What the window tells: its title, and the status line, with what is being done.

use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Ui};

use super::App;
use crate::preview::status::{self, Line};
use crate::preview::{picture, session};

/// What is said stays in the status line for so long.
const SAID: Duration = Duration::from_secs(12);

/// Figures that change are drawn anew so often.
const FIGURES: Duration = Duration::from_millis(250);

impl App {
    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.said = Some((text.into(), Instant::now()));
    }

    /// Pictures a second, while they come one after the other.
    pub(super) fn frames(&mut self) -> Option<f64> {
        let now = Instant::now();
        self.came
            .retain(|came| now - *came < Duration::from_secs(1));
        let (first, last) = (*self.came.first()?, *self.came.last()?);
        let count = self.came.len();
        (count > 4 && now - last < Duration::from_millis(300))
            .then(|| (count - 1) as f64 / (last - first).as_secs_f64())
    }

    pub(super) fn set_title(&mut self, context: &Context) {
        let kind = self.picture.as_ref().map(status::kind).unwrap_or_default();
        let state = self.shared.lock();
        let session = &state.session;
        let star = if session.unsaved().is_empty() {
            ""
        } else {
            "*"
        };
        let mut title = match session.name() {
            name if name.is_empty() => "plumb".to_owned(),
            name => format!("{name}{star} – plumb"),
        };
        if let Some(trouble) = &session.trouble {
            title.push_str(match trouble {
                session::Trouble::Mistakes(it) if it.count > 1 => " – mistakes",
                session::Trouble::Mistakes(_) => " – mistake",
                session::Trouble::Gone => " – gone",
                session::Trouble::Unreadable(_) => " – cannot be read",
            });
        } else if !kind.is_empty() {
            title.push_str(&format!(" – {kind}"));
        }
        drop(state);
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    pub(super) fn status(&mut self, ui: &mut Ui) {
        let frames = self.frames();
        let said = self.said.as_ref().filter(|(_, when)| when.elapsed() < SAID);
        let picture = self.picture.as_ref();
        let state = self.shared.lock();
        let rendering = state.session.rendering().options();
        let trouble = state.session.trouble.is_some();
        drop(state);
        let size = picture.map_or([1, 1], |picture| picture.scene.camera.pixeldim);
        let scale = f64::from(ui.ctx().pixels_per_point());
        let placed = self.area.map(|rect| {
            self.showing
                .viewport
                .place(picture::area(rect, scale), size)
        });
        let line = Line {
            doing: self.doing(),
            zoom: placed.map_or(1.0, |placed| placed.zoom),
            frames,
            pixel: self.over.and_then(|pixel| {
                let bytes = picture.and_then(|picture| picture::bytes(picture, pixel));
                Some((pixel, bytes?))
            }),
            rendering,
            trouble,
            said: said.map(|(text, _)| text.clone()),
        };
        if line.doing.is_some() || frames.is_some() || said.is_some() {
            // The line is drawn again soon, so that its figures do not stand still.
            ui.ctx().request_repaint_after(FIGURES);
        }
        if status::show(ui, picture, &line) {
            self.help_open = true;
        }
    }

    /// What is being done, if anything.
    pub(super) fn doing(&self) -> Option<String> {
        self.options.path.as_ref()?;
        let state = self.shared.lock();
        if state.wished == 0 {
            // Nothing is wished for while there is no scene; what is wrong with the file is said elsewhere.
            return state
                .session
                .trouble
                .is_none()
                .then(|| "reading the scene".into());
        }
        let shown = self.picture.as_ref().map(|picture| picture.number);
        let behind = shown != Some(state.wished) && self.failed.is_none();
        let words = self.worker.progress.doing().words();
        words.or_else(|| behind.then(|| "rendering next".into()))
    }
}

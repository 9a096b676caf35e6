//! What other threads tell the window: pictures, answers, what became of a file.

use std::path::PathBuf;
use std::sync::mpsc::Sender;
use std::time::Instant;

use eframe::egui::Context;

use super::App;
use crate::preview::chooser::Purpose;
use crate::preview::inspect::Answer;
use crate::preview::{status, worker};

/// What other threads tell the window.
pub(super) enum Event {
    /// Something is to be said, or to be shown of the file.
    File,
    Rendered(worker::News),
    Inspected(Answer),
    Saved(Result<String, String>),
    /// What the desktop's file dialog gave.
    Browsed(Purpose, Option<PathBuf>),
}

/// Tells the window, and wakes it.
#[derive(Clone)]
pub(super) struct Teller {
    pub(super) events: Sender<Event>,
    pub(super) context: Context,
}

impl Teller {
    pub(super) fn tell(&self, event: Event) {
        // A window that is closed has nobody to tell.
        if self.events.send(event).is_ok() {
            self.context.request_repaint();
        }
    }
}

impl App {
    /// Takes what other threads tell.
    pub(super) fn listen(&mut self) {
        while let Ok(event) = self.events.try_recv() {
            match event {
                Event::File => {}
                Event::Rendered(worker::News::Picture(picture)) if picture.number <= self.since => {
                }
                Event::Rendered(worker::News::Picture(picture)) => {
                    self.failed = None;
                    self.came.push(Instant::now());
                    log::info!(
                        "{} after {:.1} ms: {}",
                        status::kind(&picture),
                        1e3 * picture.seconds,
                        status::figures(&picture)
                    );
                    self.picture = Some(*picture);
                }
                Event::Rendered(worker::News::Failed { number, why }) => {
                    if number == self.shared.lock().wished && number > self.since {
                        self.failed = Some(why);
                    }
                }
                Event::Rendered(worker::News::Rests(number)) => self.rests = number,
                Event::Browsed(purpose, path) => self.browsed(purpose, path),
                Event::Inspected(answer) => self.answered(answer),
                Event::Saved(saved) => {
                    if saved.is_err() {
                        // There is something to be read first.
                        self.leaving.stop_saving();
                    }
                    let (Ok(text) | Err(text)) = saved;
                    self.say(text);
                }
            }
        }
        let said = std::mem::take(&mut self.shared.lock().session.said);
        said.into_iter().for_each(|text| self.say(text));
    }
}

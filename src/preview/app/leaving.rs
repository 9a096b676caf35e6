//! What is asked before the window closes, or turns to another scene: the same, whichever way that comes about.

use eframe::egui::{self, Context};

use super::App;
use crate::preview::overlay;

/// Whether the window is to be closed.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) enum Leaving {
    /// It is not.
    #[default]
    No,
    /// Somebody wants it closed.
    Wanted,
    /// Whether changes are to be lost is being asked.
    Asking,
    /// Changes are being saved, then it closes.
    Saving,
    /// Nothing is left to be lost.
    Agreed,
}

impl Leaving {
    /// Somebody wants the window closed.
    pub(super) fn ask(&mut self) {
        if *self == Self::No {
            *self = Self::Wanted;
        }
    }

    /// Whether a question is on the screen.
    pub(super) fn asks(self) -> bool {
        matches!(self, Self::Asking | Self::Saving)
    }

    /// Saving failed: it stays open.
    pub(super) fn stop_saving(&mut self) {
        if *self == Self::Saving {
            *self = Self::No;
        }
    }
}

impl App {
    /// Asks before changes are lost. Keys, the window's frame and whatever else closes it end up here.
    pub(super) fn leave(&mut self, context: &Context) {
        if context.input(|input| input.viewport().close_requested())
            && self.leaving != Leaving::Agreed
        {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.next = None;
            self.leaving.ask();
        }
        if self.leaving == Leaving::No {
            return;
        }
        let lost = self.shared.lock().session.to_be_lost();
        match self.leaving {
            Leaving::Wanted => {
                // What is typed into a field is a change too, once the field is left.
                match context.memory(|memory| memory.focused()) {
                    Some(field) => context.memory_mut(|memory| memory.surrender_focus(field)),
                    None if lost > 0 => self.leaving = Leaving::Asking,
                    None => self.leaving = Leaving::Agreed,
                }
                context.request_repaint();
            }
            Leaving::Asking => {
                let name = self.shared.lock().session.name();
                match overlay::leaving(context, lost, &name, self.next.is_some()) {
                    Some(overlay::Leaving::Save) => {
                        self.leaving = Leaving::Saving;
                        self.save_changes();
                    }
                    Some(overlay::Leaving::Lose) => {
                        log::info!("closed without {lost} changes");
                        self.leaving = Leaving::Agreed;
                    }
                    Some(overlay::Leaving::Stay) => self.leaving = Leaving::No,
                    None => {}
                }
            }
            Leaving::Saving if lost == 0 => self.leaving = Leaving::Agreed,
            Leaving::Saving | Leaving::No | Leaving::Agreed => {}
        }
        if self.leaving == Leaving::Agreed {
            match self.next.take() {
                Some(path) => {
                    self.leaving = Leaving::No;
                    self.turn_to(path);
                }
                None => context.send_viewport_cmd(egui::ViewportCommand::Close),
            }
        }
    }
}

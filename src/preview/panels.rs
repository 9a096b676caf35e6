//! Which panels are open: as the user wants it, and as the window has room for it where nobody said.

use eframe::egui::Vec2;

use super::{inspector, side};

/// The panels beside and below the picture.
#[derive(Debug, Default)]
pub(super) struct Panels {
    side: Option<bool>,
    inspector: Option<bool>,
    /// The window's size, in points.
    pub(super) room: Vec2,
}

impl Panels {
    /// Whether the lists are open: without a word about it, where they leave most of the width to the picture.
    pub(super) fn side(&self) -> bool {
        self.side.unwrap_or(self.room.x > 2.0 * side::WIDTH)
    }

    /// Whether the inspector is, likewise.
    pub(super) fn inspector(&self) -> bool {
        let half = self.room.y > 2.0 * inspector::HEIGHT;
        self.inspector.unwrap_or(half)
    }

    pub(super) fn toggle_side(&mut self) {
        self.side = Some(!self.side());
    }

    pub(super) fn toggle_inspector(&mut self) {
        self.inspector = Some(!self.inspector());
    }

    /// The most that a panel may take of a length, so that most is the picture's.
    pub(super) fn most(length: f32) -> f32 {
        0.45 * length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_window_is_the_pictures() {
        let mut panels = Panels {
            room: Vec2::new(420.0, 300.0),
            ..Panels::default()
        };
        assert_eq!((panels.side(), panels.inspector()), (false, false));
        // Whoever asks gets them nonetheless, and still has them when the window grows.
        panels.toggle_side();
        assert_eq!((panels.side(), panels.inspector()), (true, false));
        panels.room = Vec2::new(1200.0, 900.0);
        assert_eq!((panels.side(), panels.inspector()), (true, true));
        panels.toggle_side();
        panels.toggle_inspector();
        assert_eq!((panels.side(), panels.inspector()), (false, false));
    }
}

//! Why a picture may surprise: the remarks that `plumb check` makes, in a panel below the picture.

use eframe::egui::{self, RichText, Ui};

use super::panels::Panels;

/// What is shown, and whether the user has read it.
#[derive(Debug, Default)]
pub(super) struct Hints {
    told: Vec<String>,
    closed: bool,
}

impl Hints {
    /// Takes what there is to be told now. What was closed comes back only if it is something else.
    pub(super) fn take(&mut self, told: Vec<String>) {
        if self.told != told {
            self.closed = false;
            self.told = told;
        }
    }

    /// Whether there is something to be read.
    pub(super) fn is_open(&self) -> bool {
        !self.told.is_empty() && !self.closed
    }

    /// Shows them.
    pub(super) fn show(&mut self, ui: &mut Ui, room: egui::Vec2) {
        ui.horizontal_top(|ui| {
            let close = ui.small_button("×").on_hover_text("close the hints");
            self.closed |= close.clicked();
            egui::ScrollArea::vertical()
                .id_salt("hints")
                .max_height(0.5 * Panels::most(room.y))
                .auto_shrink([false, true])
                .show(ui, |ui| {
                    // One below the other, though the button stands beside them.
                    ui.vertical(|ui| {
                        for hint in &self.told {
                            let color = ui.visuals().warn_fg_color;
                            ui.add(egui::Label::new(RichText::new(hint).color(color)).wrap());
                        }
                    });
                });
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn hints_stand_one_below_the_other() {
        let mut hints = Hints::default();
        hints.take(vec!["it is dark ".repeat(20), "it is late".into()]);
        let mut harness = Harness::builder().with_size([400.0, 300.0]).build_ui_state(
            |ui, hints: &mut Hints| hints.show(ui, egui::vec2(800.0, 600.0)),
            hints,
        );
        harness.run();
        let [first, second] =
            ["it is dark", "it is late"].map(|hint| harness.get_by_label_contains(hint).rect());
        assert!(first.right() <= 400.0 && first.height() > 30.0, "{first}");
        assert!(second.top() >= first.bottom(), "{first} {second}");
    }

    #[test]
    fn hints_are_closed_until_there_are_others() {
        let mut hints = Hints::default();
        assert!(!hints.is_open());
        hints.take(vec!["it is dark".into()]);
        let mut harness = Harness::new_ui_state(
            |ui, hints: &mut Hints| {
                if hints.is_open() {
                    hints.show(ui, egui::vec2(800.0, 600.0));
                }
            },
            hints,
        );
        harness.run();
        harness.get_by_label("it is dark");
        harness.get_by_label("×").click();
        harness.run();
        assert!(harness.query_by_label("it is dark").is_none());
        harness.state_mut().take(vec!["it is dark".into()]);
        assert!(!harness.state().is_open());
        harness.state_mut().take(vec!["it is darker".into()]);
        harness.run();
        harness.get_by_label("it is darker");
        harness.state_mut().take(Vec::new());
        assert!(!harness.state().is_open());
    }
}

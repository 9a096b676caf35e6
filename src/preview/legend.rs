//! What the colours of verdicts mean, over the picture's lower left corner.

use eframe::egui::{self, Color32, RichText, Sense, Ui, Vec2};

use crate::certify::verdict::{color, meaning};
use crate::frame::DecidedBy;

/// Shows the legend in an area of the window. What is sure is dimmed, the picture shines through.
pub(super) fn show(ui: &Ui, area: egui::Rect) {
    let corner = area.left_bottom() + egui::vec2(8.0, -8.0);
    egui::Area::new(egui::Id::unique("legend"))
        .pivot(egui::Align2::LEFT_BOTTOM)
        .fixed_pos(corner)
        .constrain_to(area)
        .interactable(false)
        .order(egui::Order::Middle)
        .show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.label(RichText::new("decided by").small().strong());
                for by in DecidedBy::ALL {
                    ui.horizontal(|ui| entry(ui, by));
                }
            });
        });
}

fn entry(ui: &mut Ui, by: DecidedBy) {
    let height = ui.text_style_height(&egui::TextStyle::Small);
    let (rect, _) = ui.allocate_exact_size(Vec2::new(1.5 * height, height), Sense::hover());
    let [r, g, b] = color(by);
    ui.painter()
        .rect_filled(rect, 0.0, Color32::from_rgb(r, g, b));
    let dimmed = match by {
        DecidedBy::Gpu | DecidedBy::Single => " (the picture, dimmed)",
        DecidedBy::Double
        | DecidedBy::Bounded
        | DecidedBy::Pairs
        | DecidedBy::Multiprecision
        | DecidedBy::Exact
        | DecidedBy::Presumed => "",
    };
    let text = format!("{}{dimmed}", meaning(by));
    ui.add(egui::Label::new(RichText::new(text).small()).extend());
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn every_verdict_is_in_the_legend() {
        let mut harness = Harness::new_ui(|ui| show(ui, ui.max_rect()));
        harness.run_steps(3);
        for by in DecidedBy::ALL {
            harness.get_by_label_contains(meaning(by));
        }
    }
}

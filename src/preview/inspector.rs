//! The panel below the picture: a pixel explained, as `plumb probe` does it. What one wants to know comes first; the
//! rest is folded.

mod sections;

use eframe::egui::{self, RichText, Ui};

use sections::Sections;

/// Height of the panel when it is opened first, in points.
pub(super) const HEIGHT: f32 = 190.0;

/// Width of the names of what is told, in points.
const NAMES: f32 = 72.0;

/// What the panel shows.
#[derive(Debug, Default)]
pub(super) struct Panel {
    /// The pixel that is held, if one is: column, and row from the bottom.
    pub(super) held: Option<[u32; 2]>,
    /// What was explained last: the number of the picture's wish, the pixel, the text.
    pub(super) explained: Option<(u64, [u32; 2], String)>,
}

/// Shows the panel. `wanted` is the pixel it is about, and what decided it, as the picture has it. Whether a pixel that
/// is held is to be let go.
pub(super) fn show(
    ui: &mut Ui,
    panel: &Panel,
    wanted: Option<[u32; 2]>,
    verdict: Option<&str>,
) -> bool {
    let mut let_go = false;
    ui.horizontal_wrapped(|ui| match (wanted, panel.held) {
        (None, _) => {
            ui.label("Move over the picture to have a pixel explained; click to hold it.");
        }
        (Some([x, y]), held) => {
            ui.label(RichText::new(format!("pixel ({x}, {y})")).strong());
            if held.is_some() {
                let_go = ui.small_button("let go (Esc)").clicked();
            } else {
                ui.weak("click to hold it");
            }
        }
    });
    egui::ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            let explained = panel.explained.as_ref();
            let text = explained.filter(|(_, pixel, _)| Some(*pixel) == wanted);
            match text {
                Some((.., text)) => explained_pixel(ui, &Sections::of(text), verdict),
                None if wanted.is_some() => {
                    ui.weak("…");
                }
                None => {}
            }
        });
    let_go
}

fn explained_pixel(ui: &mut Ui, sections: &Sections<'_>, verdict: Option<&str>) {
    for (name, value) in &sections.first {
        // In the picture it may have been the GPU that decided.
        let picture = verdict.filter(|_| *name == "decided by");
        let value = RichText::new(picture.unwrap_or(value)).monospace().strong();
        ui.horizontal_top(|ui| {
            let height = ui.text_style_height(&egui::TextStyle::Body);
            ui.allocate_ui(egui::vec2(NAMES, height), |ui| {
                ui.set_min_width(NAMES);
                ui.label(*name);
            });
            ui.add(egui::Label::new(value).wrap());
        });
    }
    for line in &sections.trouble {
        ui.add(egui::Label::new(*line).wrap());
    }
    let folded = |ui: &mut Ui, title: String, id: &str, lines: &[&str]| {
        if lines.is_empty() {
            return;
        }
        egui::CollapsingHeader::new(title)
            .id_salt(id)
            .show(ui, |ui| {
                for line in lines {
                    ui.add(egui::Label::new(RichText::new(*line).monospace()).wrap());
                }
            });
    };
    let count = sections.hits.len();
    folded(ui, format!("Hits ({count})"), "hits", &sections.hits);
    let title = format!("Misses ({})", sections.missed);
    folded(ui, title, "misses", &sections.misses);
    folded(ui, "Rays and lights".to_owned(), "rays", &sections.rays);
    folded(
        ui,
        "The ray, and how sure".to_owned(),
        "rest",
        &sections.rest,
    );
}

#[cfg(test)]
mod tests;

//! The panel below the picture: a pixel explained, as `plumb probe` does it.

use eframe::egui::{self, RichText, Ui};

/// Height of the panel when it is opened first, in points.
pub(super) const HEIGHT: f32 = 190.0;

/// What the panel shows.
#[derive(Debug, Default)]
pub(super) struct Panel {
    /// The pixel that is held, if one is: column, and row from the bottom.
    pub(super) held: Option<[u32; 2]>,
    /// What was explained last: the number of the picture's wish, the pixel, the text.
    pub(super) explained: Option<(u64, [u32; 2], String)>,
}

/// Shows the panel. `wanted` is the pixel it is about, and what decided it, as the picture has it. Whether a pixel that is
/// held is to be let go.
pub(super) fn show(
    ui: &mut Ui,
    panel: &Panel,
    wanted: Option<[u32; 2]>,
    verdict: Option<&str>,
) -> bool {
    let mut let_go = false;
    ui.horizontal(|ui| match (wanted, panel.held) {
        (None, _) => {
            ui.label("Move over the picture to have a pixel explained; click to hold it.");
        }
        (Some([x, y]), held) => {
            ui.label(RichText::new(format!("pixel ({x}, {y})")).strong());
            if let Some(verdict) = verdict {
                ui.label(format!("decided by {verdict}"));
            }
            if held.is_some() {
                let_go = ui.small_button("let go (Esc)").clicked();
            } else {
                ui.weak("click to hold it");
            }
        }
    });
    egui::ScrollArea::both()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            let text = panel.explained.as_ref();
            let text = text.filter(|(_, pixel, _)| Some(*pixel) == wanted);
            match text {
                Some((.., text)) => {
                    ui.add(egui::Label::new(RichText::new(text).monospace()).extend());
                }
                None if wanted.is_some() => {
                    ui.weak("…");
                }
                None => {}
            }
        });
    let_go
}

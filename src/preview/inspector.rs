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

/// Shows the panel. `wanted` is the pixel it is about, and what decided it, as the picture has it. Whether a pixel that
/// is held is to be let go.
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

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    struct Shown {
        panel: Panel,
        over: Option<[u32; 2]>,
        let_go: bool,
    }

    fn shown(panel: Panel, over: Option<[u32; 2]>) -> Harness<'static, Shown> {
        let mut harness = Harness::new_ui_state(
            |ui, shown: &mut Shown| {
                let wanted = shown.panel.held.or(shown.over);
                shown.let_go |= show(ui, &shown.panel, wanted, Some("the GPU, which is sure"));
            },
            Shown {
                panel,
                over,
                let_go: false,
            },
        );
        harness.run();
        harness
    }

    // This text has every character that `plumb probe` prints; few fonts have all of them.
    const TEXT: &str = "weight ∘ (ambient + diffuse) · 1 ± 2 × 3 … 640×480 ≤ ≥ √ — − ÷ ²";

    #[test]
    fn a_pixel_is_explained_once_that_is_known() {
        let explained = Some((1, [3, 4], TEXT.to_owned()));
        let panel = Panel {
            held: None,
            explained,
        };
        let mut harness = shown(panel, Some([3, 4]));
        harness.get_by_label("pixel (3, 4)");
        harness.get_by_label("decided by the GPU, which is sure");
        harness.get_by_label(TEXT);
        // The explanation at hand belongs to another pixel.
        harness.state_mut().over = Some([5, 4]);
        harness.run();
        harness.get_by_label("pixel (5, 4)");
        assert!(harness.query_by_label(TEXT).is_none());
    }

    #[test]
    fn a_pixel_that_is_held_can_be_let_go() {
        let panel = Panel {
            held: Some([3, 4]),
            explained: None,
        };
        let mut harness = shown(panel, Some([7, 7]));
        harness.get_by_label("pixel (3, 4)");
        harness.get_by_label("let go (Esc)").click();
        harness.run();
        assert!(harness.state().let_go);
    }
}

//! What the window shows while there is no scene: how to come to one.

use std::path::{Path, PathBuf};

use eframe::egui::{self, RichText, Ui};

/// What the user wants.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Start {
    /// A scene that is there.
    Open,
    /// A new one.
    New,
    /// This one.
    Scene(PathBuf),
}

/// Shows the page; `recent` are the scenes that were opened last.
pub(super) fn show(ui: &mut Ui, recent: &[PathBuf]) -> Option<Start> {
    let mut start = None;
    egui::Frame::new()
        .inner_margin(egui::Margin::same(24))
        .show(ui, |ui| {
            egui::ScrollArea::vertical()
                .auto_shrink([false, false])
                .show(ui, |ui| {
                    ui.heading("plumb");
                    ui.label(
                        "A scene in a window that follows its file, whatever you edit it with.",
                    );
                    ui.add_space(12.0);
                    ui.horizontal_wrapped(|ui| {
                        if ui.button("Open a scene… (Ctrl+O)").clicked() {
                            start = Some(Start::Open);
                        }
                        if ui.button("New scene… (Ctrl+N)").clicked() {
                            start = Some(Start::New);
                        }
                    });
                    ui.label("Or drop a scene's file on the window.");
                    ui.add_space(12.0);
                    if !recent.is_empty() {
                        ui.label(RichText::new("Opened last").strong());
                    }
                    for scene in recent {
                        ui.horizontal_wrapped(|ui| {
                            let name = scene.file_name().unwrap_or(scene.as_os_str());
                            if ui.link(name.to_string_lossy()).clicked() {
                                start = Some(Start::Scene(scene.clone()));
                            }
                            let folder = scene.parent().unwrap_or(Path::new(""));
                            ui.weak(folder.display().to_string());
                        });
                    }
                });
        });
    start
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn the_ways_to_a_scene_are_shown() {
        let recent = PathBuf::from("/home/me/scenes/room.txt");
        for (label, wanted) in [
            ("Open a scene… (Ctrl+O)", Start::Open),
            ("New scene… (Ctrl+N)", Start::New),
            ("room.txt", Start::Scene(recent.clone())),
        ] {
            let scenes = [recent.clone()];
            let mut harness = Harness::new_ui_state(
                move |ui, start: &mut Option<Start>| {
                    *start = start.take().or(show(ui, &scenes));
                },
                None,
            );
            harness.run();
            harness.get_by_label("/home/me/scenes");
            harness.get_by_label(label).click();
            harness.run();
            assert_eq!(*harness.state(), Some(wanted));
        }
    }
}

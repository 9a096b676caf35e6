//! The panel beside the picture: the view, what was changed, and the lists of objects, materials and lights.
//!
//! Says what the user wants done; [`app`](super::app) does it.

use eframe::egui::{self, RichText, Ui};

use super::entities::title;
use super::properties;
use super::selection::{Selection, made_of};
use super::session::{Session, Source};
use super::undo::Direction;
use super::wanted::Wanted;
use crate::scene::{EntityId, NumberRow, Scene};

/// Width of the panel when it is opened first, in points.
pub(super) const WIDTH: f32 = 270.0;

/// Height for what was clicked, in points.
const SELECTED: f32 = 250.0;

/// Height of a list, in points.
const LIST: f32 = 150.0;

/// What the panel remembers.
#[derive(Debug, Default)]
pub(super) struct Side {
    /// What was clicked.
    pub(super) selection: Selection,
    /// What is under the cursor in a list.
    pub(super) hovered: Option<EntityId>,
}

/// Shows the panel.
pub(super) fn show(ui: &mut Ui, side: &mut Side, session: &Session) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    side.hovered = None;
    // A panel is as wide as what was in it last, and at first there is little.
    ui.set_min_width(ui.available_width());
    let Some(scene) = session.good().map(|good| &good.scene) else {
        ui.weak("Nothing to show yet.");
        return wanted;
    };
    side.selection.follow(scene);
    // The panel opens below the lists, so that they stay where they are when something is clicked.
    if let Some(entity) = side.selection.entity() {
        egui::Panel::bottom("selected")
            .resizable(true)
            .default_size(SELECTED)
            .show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .id_salt("selected")
                    .auto_shrink([false, false])
                    .show(ui, |ui| {
                        selected(ui, entity, session, &mut side.selection, &mut wanted);
                    });
            });
    }
    egui::ScrollArea::vertical()
        .id_salt("lists")
        .auto_shrink([false, false])
        .show(ui, |ui| {
            view(ui, session, scene, &mut wanted);
            changes(ui, session, &mut wanted);
            ui.separator();
            lists(ui, side, scene);
            // Below, so that the lists stay where they are when it is opened.
            rendering(ui, session, scene, &mut wanted);
        });
    wanted
}

/// The camera: the viewpoint, and the rest where it is asked for.
fn view(ui: &mut Ui, session: &Session, scene: &Scene, wanted: &mut Vec<Wanted>) {
    let camera = EntityId::Camera;
    let is_viewpoint = |row: &NumberRow| row.name() == "viewpoint";
    properties::show(ui, session, scene, camera, is_viewpoint, wanted);
    egui::CollapsingHeader::new("screen")
        .id_salt("screen")
        .show(ui, |ui| {
            properties::show(ui, session, scene, camera, |row| !is_viewpoint(row), wanted);
        });
    ui.horizontal(|ui| {
        if ui
            .small_button("copy camera")
            .on_hover_text("the camera as it is shown, as a block for a scene file (C)")
            .clicked()
        {
            wanted.push(Wanted::CopyCamera);
        }
        if ui
            .small_button("save picture…")
            .on_hover_text("certified (P)")
            .clicked()
        {
            wanted.push(Wanted::SavePicture);
        }
    });
}

/// How the picture is rendered, which the file does not say.
fn rendering(ui: &mut Ui, session: &Session, scene: &Scene, wanted: &mut Vec<Wanted>) {
    egui::CollapsingHeader::new("rendering")
        .id_salt("rendering")
        .show(ui, |ui| {
            let before = session.rendering();
            let after = before.show(ui, scene.camera.worlddim.x);
            if after != before {
                wanted.push(Wanted::Render(after));
            }
        });
}

/// What was changed on top of the file, and what may become of it.
fn changes(ui: &mut Ui, session: &Session, wanted: &mut Vec<Wanted>) {
    let count = session.unsaved().len();
    let steps = [Direction::Undo, Direction::Redo].map(|way| session.can_step(way));
    if steps != [false; 2] {
        ui.horizontal(|ui| {
            for (can, text, key, want) in [
                (steps[0], "undo", "Ctrl+Z", Wanted::Undo),
                (steps[1], "redo", "Ctrl+Shift+Z", Wanted::Redo),
            ] {
                let button = egui::Button::new(text).small();
                if ui.add_enabled(can, button).on_hover_text(key).clicked() {
                    wanted.push(want);
                }
            }
        });
    }
    if count == 0 {
        return;
    }
    ui.separator();
    let text = match count {
        1 => String::from("1 change, not in the file"),
        count => format!("{count} changes, not in the file"),
    };
    ui.label(
        RichText::new(text)
            .strong()
            .color(ui.visuals().warn_fg_color),
    );
    ui.horizontal(|ui| {
        if ui
            .button("save")
            .on_hover_text(
                "writes the numbers into the file, and touches nothing else in it (Ctrl+S)",
            )
            .clicked()
        {
            wanted.push(Wanted::Save);
        }
        if ui
            .button("discard")
            .on_hover_text("back to the file")
            .clicked()
        {
            wanted.push(Wanted::Discard);
        }
    });
}

/// What was clicked: its numbers, and where it stands in the file.
fn selected(
    ui: &mut Ui,
    entity: EntityId,
    session: &Session,
    selection: &mut Selection,
    wanted: &mut Vec<Wanted>,
) {
    let Some(scene) = session.good().map(|good| &good.scene) else {
        return;
    };
    if let Some((kind, name)) = title(scene, entity) {
        ui.label(RichText::new(format!("{kind} {name}")).strong());
    }
    links(ui, scene, entity, selection);
    properties::show(ui, session, scene, entity, |_| true, wanted);
    if let Some(Source { line, text }) = session.source(entity) {
        ui.label(format!("{}, line {line}", session.name()));
        egui::Frame::group(ui.style()).show(ui, |ui| {
            egui::ScrollArea::vertical()
                .id_salt("source")
                .max_height(180.0)
                .show(ui, |ui| {
                    ui.add(egui::Label::new(RichText::new(text).monospace()).wrap());
                });
        });
    }
}

/// What the entity is made of: names that lead there.
fn links(ui: &mut Ui, scene: &Scene, entity: EntityId, selection: &mut Selection) {
    for (attribute, to) in made_of(scene, entity) {
        let Some((_, name)) = title(scene, to) else {
            continue;
        };
        ui.horizontal(|ui| {
            ui.label(attribute);
            if ui.link(name).clicked() {
                selection.select(scene, Some(to));
            }
        });
    }
}

/// The lists of objects, materials and lights.
fn lists(ui: &mut Ui, side: &mut Side, scene: &Scene) {
    type Made = fn(usize) -> EntityId;
    let kinds: [(&str, usize, Made); 4] = [
        ("Objects", scene.objects.len(), EntityId::Object),
        ("Materials", scene.materials.len(), EntityId::Material),
        ("Lights", scene.lights.len(), EntityId::Light),
        ("Textures", scene.textures.len(), EntityId::Texture),
    ];
    for (title, count, entity) in kinds {
        if count == 0 {
            continue;
        }
        let selected = side.selection.to_be_shown();
        let shown = selected.and_then(|it| (0..count).find(|index| entity(*index) == it));
        let header = egui::CollapsingHeader::new(format!("{title} ({count})"))
            .id_salt(title)
            .default_open(true)
            .open(shown.map(|_| true))
            .show(ui, |ui| list(ui, side, scene, title, count, entity, shown));
        if shown.is_some() {
            header.header_response.scroll_to_me(Some(egui::Align::TOP));
        }
    }
    side.selection.was_shown();
}

fn list(
    ui: &mut Ui,
    side: &mut Side,
    scene: &Scene,
    kind: &str,
    count: usize,
    entity: fn(usize) -> EntityId,
    shown: Option<usize>,
) {
    let height = ui.text_style_height(&egui::TextStyle::Button) + 2.0;
    let mut area = egui::ScrollArea::vertical()
        .id_salt(kind)
        .max_height(LIST)
        .auto_shrink([false, true]);
    if let Some(index) = shown {
        // In the middle of the list.
        let row = height + ui.spacing().item_spacing.y;
        let offset = (index as f32 + 0.5) * row - 0.5 * LIST;
        area = area.vertical_scroll_offset(offset.max(0.0));
    }
    area.show_rows(ui, height, count, |ui, rows| {
        for entity in rows.map(entity) {
            let Some((kind, name)) = title(scene, entity) else {
                continue;
            };
            let is_selected = side.selection.entity() == Some(entity);
            let row = egui::Button::selectable(is_selected, format!("{name}  ({kind})")).truncate();
            let row = ui.add(row);
            if row.hovered() {
                side.hovered = Some(entity);
            }
            if row.clicked() {
                side.selection.click(scene, entity);
            }
        }
    });
}

#[cfg(test)]
mod tests;

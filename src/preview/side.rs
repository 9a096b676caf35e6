//! The panel beside the picture: the view, what was changed, and the lists of objects, materials and lights.
//!
//! Says what the user wants done; [`app`](super::app) does it.

use eframe::egui::{self, RichText, Ui};

use super::session::{Session, Source, title};
use super::values::{neat, short};
use crate::edit::{Measure, Reflectivity, Target, Value};
use crate::scene::{EntityId, Scene, Shape, Surface};

/// Width of the panel when it is opened first, in points.
pub(super) const WIDTH: f32 = 270.0;

/// Height for what was clicked, in points.
const SELECTED: f32 = 250.0;

/// What the user wants done.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wanted {
    /// A value changed, on top of the file.
    Set(Target, Value),
    /// The file's value again.
    Reset(Target),
    /// The file's values again, all of them.
    Discard,
    /// The changes written into the file.
    Save,
    /// The camera's block copied.
    CopyCamera,
    /// The picture saved.
    SavePicture,
}

/// What the panel remembers.
#[derive(Debug, Default)]
pub(super) struct Side {
    /// What was clicked.
    pub(super) selected: Option<EntityId>,
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
    // Names that no longer exist are not kept.
    side.selected = side
        .selected
        .filter(|entity| title(scene, *entity).is_some());
    // The panel opens below the lists, so that they stay where they are when something is clicked.
    if let Some(entity) = side.selected {
        egui::Panel::bottom("selected")
            .resizable(true)
            .default_size(SELECTED)
            .show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .id_salt("selected")
                    .auto_shrink([false, false])
                    .show(ui, |ui| selected(ui, entity, session, scene, &mut wanted));
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
        });
    wanted
}

/// The viewpoint.
fn view(ui: &mut Ui, session: &Session, scene: &Scene, wanted: &mut Vec<Wanted>) {
    ui.label(RichText::new("Viewpoint").strong());
    let speed = scene.camera.worlddim.x / 200.0;
    ui.horizontal(|ui| {
        drags(
            ui,
            session,
            Target::Viewpoint,
            ["x", "y", "z"],
            speed,
            wanted,
        )
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

/// What was changed on top of the file, and what may become of it.
fn changes(ui: &mut Ui, session: &Session, wanted: &mut Vec<Wanted>) {
    let count = session.changes().len();
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
    scene: &Scene,
    wanted: &mut Vec<Wanted>,
) {
    if let Some((kind, name)) = title(scene, entity) {
        ui.label(RichText::new(format!("{kind} {name}")).strong());
    }
    match entity {
        EntityId::Material(i) => {
            for reflectivity in Reflectivity::ALL {
                let target = Target::Material(i, reflectivity);
                sliders(ui, session, target, ["r", "g", "b"], wanted);
            }
        }
        EntityId::Light(i) => {
            sliders(ui, session, Target::Light(i), ["r", "g", "b"], wanted);
        }
        EntityId::Object(i) => object(ui, session, scene, i, wanted),
        EntityId::Camera | EntityId::Texture(_) => {}
    }
    if let Some(Source { line, text }) = session.source(entity) {
        ui.label(format!("{}, line {line}", session.name()));
        egui::Frame::group(ui.style()).show(ui, |ui| {
            egui::ScrollArea::both()
                .id_salt("source")
                .max_height(140.0)
                .show(ui, |ui| {
                    ui.add(egui::Label::new(RichText::new(text).monospace().small()).extend());
                });
        });
    }
}

fn object(ui: &mut Ui, session: &Session, scene: &Scene, i: usize, wanted: &mut Vec<Wanted>) {
    let Some(object) = scene.objects.get(i) else {
        return;
    };
    match object.shape {
        Shape::Sphere { .. } => {
            let speed = scene.camera.worlddim.x / 200.0;
            ui.horizontal(|ui| {
                ui.label("center");
                drags(
                    ui,
                    session,
                    Target::Sphere(i, Measure::Center),
                    ["x", "y", "z"],
                    speed,
                    wanted,
                );
            });
            sliders(
                ui,
                session,
                Target::Sphere(i, Measure::Radius),
                [""],
                wanted,
            );
        }
        Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => {}
    }
    let material = |index: usize| scene.materials.get(index).map_or("", |m| m.name.as_str());
    let mut text = format!("material {}", material(object.material));
    match object.surface {
        Surface::Tiled { altmaterial, .. } => {
            text.push_str(&format!(", altmaterial {}", material(altmaterial)));
        }
        Surface::Plain | Surface::Procedural { .. } | Surface::Textured { .. } => {}
    }
    ui.label(text);
}

/// Numbers to be dragged or typed.
fn drags<const N: usize>(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    names: [&str; N],
    speed: f64,
    wanted: &mut Vec<Wanted>,
) {
    let Some(value) = session.value(target) else {
        return;
    };
    let mut numbers = value.numbers().to_vec();
    let mut touched = false;
    for (name, number) in names.iter().zip(&mut numbers) {
        let drag = egui::DragValue::new(number)
            .speed(speed)
            .max_decimals(12)
            .custom_formatter(|number, _| short(number))
            .prefix(format!("{name} "));
        if ui.add(drag).changed() {
            *number = neat(*number, 50.0 * speed);
            touched = true;
        }
    }
    reset(ui, session, target, wanted);
    if touched {
        wanted.extend(value_of(&numbers).map(|value| Wanted::Set(target, value)));
    }
}

/// A slider for each number.
fn sliders<const N: usize>(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    names: [&str; N],
    wanted: &mut Vec<Wanted>,
) {
    let Some(value) = session.value(target) else {
        return;
    };
    let mut numbers = value.numbers().to_vec();
    // The slider goes up to twice the file's value, whatever the value is now, so that its range does not move while it
    // is dragged.
    let file = session.good().and_then(|good| target.value_in(&good.scene));
    let largest = file.map_or(0.0, |file| {
        file.numbers().iter().copied().fold(0.0, f64::max)
    });
    let most = if largest > 0.0 { 2.0 * largest } else { 1.0 };
    ui.horizontal(|ui| {
        ui.label(target.attribute());
        reset(ui, session, target, wanted);
    });
    let mut touched = false;
    for (name, number) in names.iter().zip(&mut numbers) {
        let slider = egui::Slider::new(number, 0.0..=most)
            .clamping(egui::SliderClamping::Never)
            .max_decimals(12)
            .custom_formatter(|number, _| short(number))
            .text(*name);
        if ui.add(slider).changed() {
            *number = neat(*number, most);
            touched = true;
        }
    }
    if touched {
        wanted.extend(value_of(&numbers).map(|value| Wanted::Set(target, value)));
    }
}

fn value_of(numbers: &[f64]) -> Option<Value> {
    match *numbers {
        [number] => Some(number.into()),
        [x, y, z] => Some([x, y, z].into()),
        _ => None,
    }
}

/// A button that brings the file's value back, where there is a change.
fn reset(ui: &mut Ui, session: &Session, target: Target, wanted: &mut Vec<Wanted>) {
    if session.changes().get(target).is_some()
        && ui
            .small_button("reset")
            .on_hover_text("as the file has it")
            .clicked()
    {
        wanted.push(Wanted::Reset(target));
    }
}

/// The lists of objects, materials and lights.
fn lists(ui: &mut Ui, side: &mut Side, scene: &Scene) {
    type Made = fn(usize) -> EntityId;
    let kinds: [(&str, usize, Made); 3] = [
        ("Objects", scene.objects.len(), EntityId::Object),
        ("Materials", scene.materials.len(), EntityId::Material),
        ("Lights", scene.lights.len(), EntityId::Light),
    ];
    for (title, count, entity) in kinds {
        if count == 0 {
            continue;
        }
        egui::CollapsingHeader::new(format!("{title} ({count})"))
            .id_salt(title)
            .default_open(true)
            .show(ui, |ui| list(ui, side, scene, title, count, entity));
    }
}

fn list(
    ui: &mut Ui,
    side: &mut Side,
    scene: &Scene,
    kind: &str,
    count: usize,
    entity: fn(usize) -> EntityId,
) {
    let height = ui.text_style_height(&egui::TextStyle::Button) + 2.0;
    egui::ScrollArea::vertical()
        .id_salt(kind)
        .max_height(150.0)
        .auto_shrink([false, true])
        .show_rows(ui, height, count, |ui, rows| {
            for entity in rows.map(entity) {
                let Some((kind, name)) = title(scene, entity) else {
                    continue;
                };
                let is_selected = side.selected == Some(entity);
                let row =
                    egui::Button::selectable(is_selected, format!("{name}  ({kind})")).truncate();
                let row = ui.add(row);
                if row.hovered() {
                    side.hovered = Some(entity);
                }
                if row.clicked() {
                    side.selected = (!is_selected).then_some(entity);
                }
            }
        });
}

#[cfg(test)]
mod tests;

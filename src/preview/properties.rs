//! The numbers of an entity, to be dragged or typed: a row for each attribute of the language's table, with its limits
//! and units. So whatever an entity has can be changed, and what is changed is marked.

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::session::Session;
use super::values::{neat, short};
use super::wanted::Wanted;
use crate::edit::{Target, Value};
use crate::scene::{self, Bounds, EntityId, NumberRow, Quantity, Scene};

/// Names of three numbers, in a place, a direction or a vector.
const AXES: &[&str] = &["x", "y", "z"];

/// The coefficients of an equation of degree two, as docs/SCENE.md has them.
const COEFFICIENTS: &[&str] = &["x²", "y²", "z²", "xy", "xz", "yz", "x", "y", "z", "="];

/// Shows all numbers of an entity that have a place in `which`.
pub(super) fn show(
    ui: &mut Ui,
    session: &Session,
    scene: &Scene,
    entity: EntityId,
    which: impl Fn(&NumberRow) -> bool,
    wanted: &mut Vec<Wanted>,
) {
    for row in scene::number_rows(scene, entity).filter(|row| which(row)) {
        let target = Target::new(entity, row.name());
        // Each has its own name for egui: what is half typed into one is not taken for another's.
        ui.push_id(target, |ui| {
            attribute(ui, session, scene, target, &row, wanted)
        });
    }
}

/// What the numbers of an attribute are called.
fn names(row: &NumberRow) -> &'static [&'static str] {
    match (row.quantity(), row.count()) {
        (Quantity::Colour, _) => &["r", "g", "b"],
        (Quantity::Pixels, _) => &["columns", "rows"],
        (Quantity::Coefficients, _) => COEFFICIENTS,
        (_, 1) => &[""],
        (_, 2) => &["width", "height"],
        _ => AXES,
    }
}

/// What stands behind a number.
fn unit(row: &NumberRow) -> &'static str {
    match row.quantity() {
        Quantity::Degrees => "°",
        Quantity::Pixels => " px",
        _ => "",
    }
}

/// What a number changes by for each point that the mouse is dragged.
fn speed(row: &NumberRow, scene: &Scene, number: f64) -> f64 {
    match row.quantity() {
        Quantity::Place | Quantity::Length => scene.camera.worlddim.x / 200.0,
        Quantity::Direction | Quantity::Number | Quantity::Colour if row.bounds(0).most <= 1.0 => {
            0.005
        }
        Quantity::Direction => 0.01,
        Quantity::Colour | Quantity::Number | Quantity::Coefficients => {
            number.abs().max(1.0) / 100.0
        }
        Quantity::Degrees => 0.25,
        Quantity::Pixels => 1.0,
        Quantity::Choice => 0.05,
    }
}

fn attribute(
    ui: &mut Ui,
    session: &Session,
    scene: &Scene,
    target: Target,
    row: &NumberRow,
    wanted: &mut Vec<Wanted>,
) {
    let set = |value| Wanted::Set(target, value);
    let fixed = session.is_fixed(target);
    let value = match fixed {
        Some(_) => session.value_in_file(target),
        None => session.value(target),
    };
    ui.horizontal(|ui| {
        let name = ui.label(row.name());
        name.on_hover_text(format!("{}: {}", row.name(), row.wording()));
        if value == Some(Value::LEFT_OUT) {
            ui.weak("not given");
            let add = ui.small_button("add");
            if add.on_hover_text("numbers to begin with").clicked() {
                wanted.extend(beginning(session, scene, target, row).map(set));
            }
        } else if row.may_be_left_out() && ui.small_button("leave out").clicked() {
            wanted.push(set(Value::LEFT_OUT));
        }
        if session.is_changed(target)
            && ui
                .small_button("reset")
                .on_hover_text("as the file has it")
                .clicked()
        {
            wanted.push(Wanted::Reset(target));
        }
        if let Some(why) = fixed {
            ui.weak(why);
        }
    });
    let Some(value) = value.filter(|value| *value != Value::LEFT_OUT) else {
        return;
    };
    let mut numbers = value.numbers().to_vec();
    let changed = ui.add_enabled_ui(fixed.is_none(), |ui| {
        if !row.choices().is_empty() {
            return choice(ui, row, &mut numbers[0]);
        }
        let slides = row.quantity() == Quantity::Colour || row.bounds(0).most <= 1.0;
        if slides && !row.is_whole() {
            let file = session.value_in_file(target);
            sliders(ui, row, file, &mut numbers)
        } else {
            drags(ui, row, scene, &mut numbers)
        }
    });
    if changed.inner {
        wanted.extend(Value::new(&numbers).map(set));
    }
}

/// Numbers to begin with for what may be left out: a direction along an axis; a place in the middle of the screen, or,
/// where that is not allowed, as far below or above another place of the entity as the screen is wide.
fn beginning(session: &Session, scene: &Scene, target: Target, row: &NumberRow) -> Option<Value> {
    let width = scene.camera.worlddim.x;
    let middle = (scene.camera.worlddim / 2.0).extend(0.0);
    let candidates = match row.quantity() {
        Quantity::Direction => DVec3::AXES.to_vec(),
        _ => {
            let others = scene::number_rows(scene, target.entity());
            let others = others.filter(|other| other.quantity() == Quantity::Place);
            let others =
                others.filter_map(|it| session.value(Target::new(target.entity(), it.name())));
            let aside = [-width, width].map(DVec3::splat);
            let others = others.filter_map(|value| value.vector());
            let others = others.flat_map(|place| aside.map(|by| place + by));
            [middle].into_iter().chain(others).collect()
        }
    };
    let mut candidates = candidates.into_iter().map(Value::from);
    candidates.find(|value| session.allows(target, *value))
}

/// Numbers to be dragged or typed, three in a line.
fn drags(ui: &mut Ui, row: &NumberRow, scene: &Scene, numbers: &mut [f64]) -> bool {
    let mut touched = false;
    let named = names(row).iter().zip(numbers).enumerate();
    let mut named: Vec<_> = named.collect();
    for line in named.chunks_mut(3) {
        ui.horizontal(|ui| {
            for (index, (name, number)) in line {
                let before = **number;
                let speed = speed(row, scene, before);
                let prefix = match **name {
                    "" => String::new(),
                    name => format!("{name} "),
                };
                let drag = egui::DragValue::new(*number)
                    .speed(speed)
                    .max_decimals(12)
                    // What is half typed is no number yet.
                    .update_while_editing(false)
                    .custom_formatter(|number, _| short(number))
                    .custom_parser(parser(before))
                    .prefix(prefix)
                    .suffix(unit(row));
                let drag = ui.add(drag).on_hover_text(row.wording());
                if drag.changed() {
                    touched = true;
                    if drag.dragged() || drag.drag_stopped() {
                        // A hand does not feel where a limit is. What is typed is taken as it is, or refused.
                        **number = within(neat(**number, 50.0 * speed), row.bounds(*index), speed);
                    }
                    if row.is_whole() {
                        **number = number.round();
                    }
                }
            }
        });
    }
    touched
}

/// Reads what was typed. Labels have fewer digits than numbers may have: who leaves one as it is changes nothing.
fn parser(before: f64) -> impl Fn(&str) -> Option<f64> {
    move |text| {
        let text = text.trim().trim_end_matches(['°', 'p', 'x', ' ']);
        if text == short(before) {
            return Some(before);
        }
        text.replace('−', "-").parse().ok()
    }
}

/// The nearest number within bounds; where they leave out the least, a step above it.
fn within(number: f64, bounds: Bounds, step: f64) -> f64 {
    let least = if bounds.above_least && number <= bounds.least {
        bounds.least + step
    } else {
        bounds.least
    };
    number.max(least).min(bounds.most)
}

/// A slider for each number.
fn sliders(ui: &mut Ui, row: &NumberRow, file: Option<Value>, numbers: &mut [f64]) -> bool {
    // The slider goes up to twice the file's value, whatever the value is now, so that its range does not move while it
    // is dragged.
    let file = file.as_ref().map_or(&[][..], |file| file.numbers());
    let largest = file.iter().copied().fold(0.0, f64::max);
    let twice = if largest > 0.0 { 2.0 * largest } else { 1.0 };
    let most = twice.min(f64::MAX).min(row.bounds(0).most);
    let mut touched = false;
    for (name, number) in names(row).iter().zip(numbers) {
        let before = *number;
        let slider = egui::Slider::new(number, 0.0..=most)
            .clamping(egui::SliderClamping::Never)
            .max_decimals(12)
            .update_while_editing(false)
            .custom_formatter(|number, _| short(number))
            .custom_parser(parser(before))
            .text(*name);
        let slider = ui.add(slider).on_hover_text(row.wording());
        if slider.changed() {
            touched = true;
            if slider.dragged() || slider.drag_stopped() {
                *number = within(neat(*number, most), row.bounds(0), 0.0);
            }
        }
    }
    touched
}

/// One of several, each with its word.
fn choice(ui: &mut Ui, row: &NumberRow, number: &mut f64) -> bool {
    let choices = row.choices();
    let label = |index: usize| match choices.get(index) {
        Some(word) => format!("{index}: {word}"),
        None => index.to_string(),
    };
    let mut chosen = *number as usize;
    egui::ComboBox::from_id_salt(row.name())
        .selected_text(label(chosen))
        .show_ui(ui, |ui| {
            for index in 0..choices.len() {
                ui.selectable_value(&mut chosen, index, label(index));
            }
        });
    let touched = chosen != *number as usize;
    *number = chosen as f64;
    touched
}

#[cfg(test)]
mod tests;

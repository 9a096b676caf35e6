//! The panel without a window: what is listed, what clicking and dragging ask for.

use std::path::Path;

use eframe::egui;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::edit::{Target, Value};
use crate::preview::session::{News, Version};
use crate::preview::undo::Step;

const SCENE: &str = "\
camera cam { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 5 0 0 }
material gray { ambient 2 2 2 }
sphere ball { material red  center 4 3 -5  radius 2.5 }
plane floor { material gray  normal 0 1 0  point 0 -1 0 }
light lamp { location 4 5 -2  emissivity 3 3 3 }
quadric cone { material red coefficients 1 -0.25 1 0 0 0 -8 2 10 -37 lower -9 0 -9 upper 9 4 9 }
triangle tri { material gray v0 0 0 -4 v1 1 0 -4 v2 0 1 -4 }
spotlight spot { location 0 5 0 emissivity 1 1 1 point 0 0 -5 theta 30 }
pplane waves { material gray normal 0 0 1 point 0 0 -20 shader 0 }
";

struct Panel {
    side: Side,
    session: Session,
    wanted: Vec<Wanted>,
}

fn panel() -> Harness<'static, Panel> {
    let mut session = Session::new("room.txt".into(), None);
    let version = Version::read(Path::new("room.txt"), SCENE.into());
    assert!(session.news(News::Version(version)));
    let state = Panel {
        side: Side::default(),
        session,
        wanted: Vec::new(),
    };
    Harness::builder()
        .with_size([300.0, 1200.0])
        .build_ui_state(
            |ui, panel: &mut Panel| {
                for wanted in show(ui, &mut panel.side, &panel.session) {
                    if let Wanted::Set(target, value) = wanted {
                        panel.session.set(target, value, Step::Alone);
                    }
                    panel.wanted.push(wanted);
                }
            },
            state,
        )
}

#[test]
fn everything_with_a_name_is_listed_and_can_be_clicked() {
    let mut panel = panel();
    for (label, entity) in [
        ("ball  (sphere)", EntityId::Object(0)),
        ("floor  (plane)", EntityId::Object(1)),
        ("red  (material)", EntityId::Material(0)),
        ("cone  (quadric)", EntityId::Object(2)),
        ("tri  (triangle)", EntityId::Object(3)),
        ("lamp  (light)", EntityId::Light(0)),
    ] {
        panel.get_by_label(label).click();
        panel.run_steps(3);
        assert_eq!(panel.state().side.selection.entity(), Some(entity));
        let [kind, name] = [entity]
            .map(|entity| {
                title(&panel.state().session.good().unwrap().scene, entity)
                    .map(|(kind, name)| (kind.to_owned(), name.to_owned()))
                    .unwrap()
            })
            .map(|(kind, name)| [kind, name])[0]
            .clone();
        // Its numbers, and where it stands.
        panel.get_by_label(&format!("{kind} {name}"));
        let line = 1 + SCENE
            .lines()
            .position(|line| line.contains(&format!("{name} {{")))
            .unwrap();
        panel.get_by_label(&format!("room.txt, line {line}"));
    }
    // Once more lets go of it.
    panel.get_by_label("lamp  (light)").click();
    panel.run_steps(3);
    assert_eq!(panel.state().side.selection.entity(), None);
    assert!(panel.state().wanted.is_empty());
}

#[test]
fn what_is_under_the_cursor_is_told() {
    let mut panel = panel();
    panel.get_by_label("gray  (material)").hover();
    panel.run_steps(3);
    assert_eq!(panel.state().side.hovered, Some(EntityId::Material(1)));
    panel.remove_cursor();
    panel.run_steps(3);
    assert_eq!(panel.state().side.hovered, None);
}

/// Drags what has this label by so many points to the right.
fn drag(panel: &mut Harness<'_, Panel>, rect: egui::Rect, by: f32) {
    let from = rect.center();
    panel.hover_at(from);
    panel.run_steps(3);
    panel.drag_at(from);
    panel.run_steps(3);
    panel.hover_at(from + egui::vec2(by, 0.0));
    panel.run_steps(3);
    panel.drop_at(from + egui::vec2(by, 0.0));
    panel.run_steps(3);
}

#[test]
fn numbers_are_dragged_and_become_changes_that_can_be_saved_or_discarded() {
    let mut panel = panel();
    assert!(panel.query_by_label("save").is_none());
    // The viewpoint is the first number of the panel.
    let x = panel
        .get_all_by_role(egui::accesskit::Role::SpinButton)
        .next()
        .unwrap()
        .rect();
    drag(&mut panel, x, 40.0);
    let value = panel.state().session.value(Target::VIEWPOINT).unwrap();
    let [x, y, z] = *value.numbers() else {
        panic!("{value:?}");
    };
    assert!(x > 4.1 && [y, z] == [3.0, 6.0], "{value:?}");
    // As a person would write it.
    assert!(x.to_string().len() <= 7, "{x}");
    panel.get_by_label("1 change, not in the file");
    panel.state_mut().wanted.clear();
    panel.get_by_label("save").click();
    panel.run_steps(3);
    panel.get_by_label("discard").click();
    panel.run_steps(3);
    panel.get_by_label("reset").click();
    panel.run_steps(3);
    let wanted = [
        Wanted::Save,
        Wanted::Discard,
        Wanted::Reset(Target::VIEWPOINT),
    ];
    assert_eq!(panel.state().wanted, wanted);
}

#[test]
fn sliders_change_colours() {
    let mut panel = panel();
    panel.get_by_label("red  (material)").click();
    panel.run_steps(3);
    let red = panel
        .get_all_by_role(egui::accesskit::Role::Slider)
        .next()
        .unwrap()
        .rect();
    drag(&mut panel, red, -20.0);
    let target = Target::new(EntityId::Material(0), "ambient");
    let value = panel.state().session.value(target).unwrap();
    assert!(
        value.numbers()[0] < 5.0 && value.numbers()[1..] == [0.0, 0.0],
        "{value:?}"
    );
    assert!(
        panel
            .state()
            .wanted
            .iter()
            .all(|wanted| matches!(wanted, Wanted::Set(t, _) if *t == target))
    );
    // The handle does not flee: the range is that of the file's value.
    let after = panel
        .get_all_by_role(egui::accesskit::Role::Slider)
        .next()
        .unwrap()
        .rect();
    assert_eq!(after.width(), red.width());
}

/// The numbers that the panel of the selected entity has.
fn rows_of(panel: &mut Harness<'_, Panel>, label: &str) -> Vec<String> {
    panel.get_by_label(label).click();
    panel.run_steps(3);
    let entity = panel.state().side.selection.entity().unwrap();
    let scene = &panel.state().session.good().unwrap().scene;
    let rows = crate::scene::number_rows(scene, entity);
    let names: Vec<_> = rows.map(|row| row.name().to_owned()).collect();
    for name in &names {
        assert!(panel.query_all_by_label(name).next().is_some(), "{name}");
    }
    names
}

#[test]
fn every_entity_has_a_panel_of_all_its_numbers() {
    let mut panel = panel();
    let known: [(&str, &[&str]); 6] = [
        ("cone  (quadric)", &["coefficients", "lower", "upper"]),
        (
            "tri  (triangle)",
            &["vertex1", "vertex2", "vertex3", "normal", "point"],
        ),
        ("floor  (plane)", &["normal", "point"]),
        (
            "spot  (spotlight)",
            &["location", "emissivity", "point", "theta"],
        ),
        ("waves  (pplane)", &["normal", "point", "shader"]),
        (
            "red  (material)",
            &[
                "ambient",
                "diffuse",
                "specular",
                "shininess",
                "transparency",
            ],
        ),
    ];
    for (label, names) in known {
        assert_eq!(rows_of(&mut panel, label), names);
    }
}

#[test]
fn what_is_left_out_can_be_added_and_left_out_again() {
    let mut panel = panel();
    panel.get_by_label("tri  (triangle)").click();
    panel.run_steps(3);
    let rows = ["normal", "point"].map(|name| Target::new(EntityId::Object(3), name));
    for row in rows {
        assert_eq!(
            panel.state().session.value(row),
            Some(Value::LEFT_OUT),
            "{row:?}"
        );
        panel.get_all_by_label("add").next().unwrap().click();
        panel.run_steps(3);
        let value = panel.state().session.value(row).unwrap();
        assert_eq!(value.numbers().len(), 3, "{row:?}");
    }
    assert_eq!(panel.state().session.unsaved().len(), 2);
    for row in rows {
        panel.get_all_by_label("leave out").next().unwrap().click();
        panel.run_steps(3);
        assert_eq!(
            panel.state().session.value(row),
            Some(Value::LEFT_OUT),
            "{row:?}"
        );
    }
    assert!(panel.state().session.unsaved().is_empty());
    // A quadric's box has its other corner beside it.
    panel.get_by_label("cone  (quadric)").click();
    panel.run_steps(3);
    let [lower, upper] = ["lower", "upper"].map(|name| Target::new(EntityId::Object(2), name));
    for (row, number) in [(lower, 0), (upper, 1)] {
        panel
            .get_all_by_label("leave out")
            .nth(number)
            .unwrap()
            .click();
        panel.run_steps(3);
        panel.get_by_label("add").click();
        panel.run_steps(3);
        let value = panel.state().session.value(row).unwrap();
        assert_eq!(value.numbers().len(), 3, "{row:?}");
    }
}

#[test]
fn what_a_thing_is_made_of_is_a_link() {
    let mut panel = panel();
    panel.get_by_label("floor  (plane)").click();
    panel.run_steps(3);
    panel.get_by_label("gray").click();
    panel.run_steps(4);
    let selected = panel.state().side.selection.entity();
    assert_eq!(selected, Some(EntityId::Material(1)));
    panel.get_by_label("material gray");
}

/// Numbers are typed: click, type, Enter.
fn type_into(panel: &mut Harness<'_, Panel>, index: usize, text: &str) {
    panel
        .get_all_by_role(egui::accesskit::Role::SpinButton)
        .nth(index)
        .unwrap()
        .click();
    panel.run_steps(4);
    if !text.is_empty() {
        panel.event(egui::Event::Text(text.into()));
        panel.run_steps(2);
    }
    panel.key_press(egui::Key::Enter);
    panel.run_steps(4);
}

#[test]
fn numbers_are_typed_and_refused_as_the_language_has_it() {
    let mut panel = panel();
    // The first three are the viewpoint; what is half typed changes nothing.
    type_into(&mut panel, 2, "7.25");
    let viewpoint = |panel: &Harness<'_, Panel>| {
        panel
            .state()
            .session
            .value(Target::VIEWPOINT)
            .unwrap()
            .vector()
            .unwrap()
            .z
    };
    assert_eq!(viewpoint(&panel), 7.25);
    assert_eq!(panel.state().wanted.len(), 1, "{:?}", panel.state().wanted);
    type_into(&mut panel, 2, "-1");
    assert_eq!(viewpoint(&panel), 7.25);
    let said = panel.state().session.said.last().unwrap();
    assert!(said.contains("in front of the screen"), "{said}");
    // A number with more digits than its label is not rounded by looking at it.
    let third = Value::from([4.0, 3.0, 1.0 / 3.0]);
    panel
        .state_mut()
        .session
        .set(Target::VIEWPOINT, third, Step::Alone);
    panel.run_steps(3);
    type_into(&mut panel, 2, "");
    assert_eq!(viewpoint(&panel), 1.0 / 3.0);
}

#[test]
fn dragged_numbers_stay_within_their_limits() {
    let mut panel = panel();
    panel.get_by_label("ball  (sphere)").click();
    panel.run_steps(3);
    let radius = Target::new(EntityId::Object(0), "radius");
    // The panel below is laid out first: the center's three, then this.
    let number = panel
        .get_all_by_role(egui::accesskit::Role::SpinButton)
        .nth(3)
        .unwrap()
        .rect();
    drag(&mut panel, number, -280.0);
    let value = panel.state().session.value(radius).unwrap().numbers()[0];
    assert!(value > 0.0 && value < 0.1, "{value}");
    assert!(
        panel.state().session.said.is_empty(),
        "{:?}",
        panel.state().session.said
    );
}

#[test]
fn lists_scroll_to_what_is_selected_elsewhere() {
    let mut text = String::from(SCENE);
    for i in 0..300 {
        text.push_str(&format!(
            "sphere s{i} {{ material red center 0 0 -5 radius 1 }}\n"
        ));
    }
    let mut panel = panel();
    let version = Version::read(Path::new("room.txt"), text.into());
    panel.state_mut().session.news(News::Version(version));
    panel.run_steps(3);
    assert!(panel.query_by_label("s250  (sphere)").is_none());
    let scene = panel.state().session.good().unwrap().scene.clone();
    let index = scene
        .objects
        .iter()
        .position(|it| it.name == "s250")
        .unwrap();
    panel
        .state_mut()
        .side
        .selection
        .select(&scene, Some(EntityId::Object(index)));
    panel.run_steps(6);
    panel.get_by_label("s250  (sphere)");
    panel.get_by_label("sphere s250");
    // It can be scrolled away again.
    assert_eq!(panel.state().side.selection.to_be_shown(), None);
}

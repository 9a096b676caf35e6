//! The panel without a window: what is listed, what clicking and dragging ask for.

use std::path::Path;

use eframe::egui;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::preview::session::{News, Version};

const SCENE: &str = "\
camera cam { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 5 0 0 }
material gray { ambient 2 2 2 }
sphere ball { material red  center 4 3 -5  radius 2.5 }
plane floor { material gray  normal 0 1 0  point 0 -1 0 }
light lamp { location 4 5 -2  emissivity 3 3 3 }
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
                        panel.session.set(target, value);
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
        ("lamp  (light)", EntityId::Light(0)),
    ] {
        panel.get_by_label(label).click();
        panel.run_steps(3);
        assert_eq!(panel.state().side.selected, Some(entity));
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
    assert_eq!(panel.state().side.selected, None);
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
    let value = panel.state().session.value(Target::Viewpoint).unwrap();
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
        Wanted::Reset(Target::Viewpoint),
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
    let target = Target::Material(0, Reflectivity::Ambient);
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

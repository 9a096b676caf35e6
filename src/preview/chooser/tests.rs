use std::fs;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use tempfile::TempDir;

use super::*;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["room.txt", "rooms.txt", "wood.ppm", ".hidden"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    fs::create_dir_all(folder.path().join("scenes/deep")).unwrap();
    folder
}

fn showing(purpose: Purpose, folder: &Path) -> Harness<'static, (Chooser, Choice)> {
    let mut harness = Harness::builder().with_size([800.0, 600.0]).build_ui_state(
        |ui, (chooser, choice): &mut (Chooser, Choice)| {
            if *choice == Choice::Open {
                *choice = chooser.show(ui.ctx());
            }
        },
        (Chooser::new(purpose, folder), Choice::Open),
    );
    harness.run_steps(4);
    harness
}

fn typed(harness: &mut Harness<'_, (Chooser, Choice)>, text: &str) {
    harness.event(egui::Event::Text(text.into()));
    harness.run_steps(3);
}

fn pressed(harness: &mut Harness<'_, (Chooser, Choice)>, key: Key) {
    harness.key_press(key);
    harness.run_steps(4);
}

#[test]
fn a_path_is_typed_and_completed() {
    let folder = folder();
    let mut harness = showing(Purpose::Open, folder.path());
    typed(&mut harness, "r");
    assert!(harness.query_by_label("wood.ppm").is_none());
    pressed(&mut harness, Key::Tab);
    let text = |harness: &Harness<'_, (Chooser, Choice)>| {
        let text = harness.state().0.text.clone();
        text[folder.path().to_str().unwrap().len()..].to_owned()
    };
    // As far as both go; and again changes nothing.
    assert_eq!(text(&harness), "/room");
    pressed(&mut harness, Key::Tab);
    assert_eq!(text(&harness), "/room");
    typed(&mut harness, "s");
    pressed(&mut harness, Key::Tab);
    assert_eq!(text(&harness), "/rooms.txt");
    pressed(&mut harness, Key::Enter);
    let chosen = Choice::Path(folder.path().join("rooms.txt"));
    assert_eq!(harness.state().1, chosen);
}

#[test]
fn what_is_in_the_folder_is_clicked() {
    let folder = folder();
    let mut harness = showing(Purpose::Open, folder.path());
    assert!(harness.query_by_label(".hidden").is_none());
    harness.get_by_label("scenes/").click();
    harness.run_steps(4);
    harness.get_by_label("deep/");
    assert_eq!(harness.state().1, Choice::Open);
    assert!(harness.state().0.text.ends_with("/scenes/"));
    let mut harness = showing(Purpose::Open, folder.path());
    harness.get_by_label("room.txt").click();
    harness.run_steps(4);
    let chosen = Choice::Path(folder.path().join("room.txt"));
    assert_eq!(harness.state().1, chosen);
}

#[test]
fn what_is_not_there_is_not_opened_and_what_is_there_is_not_made() {
    let folder = folder();
    let mut harness = showing(Purpose::Open, folder.path());
    typed(&mut harness, "nothing.txt");
    pressed(&mut harness, Key::Enter);
    harness.get_by_label_contains("there is no file");
    assert_eq!(harness.state().1, Choice::Open);
    pressed(&mut harness, Key::Escape);
    assert_eq!(harness.state().1, Choice::Cancel);

    let mut harness = showing(Purpose::New, folder.path());
    harness.get_by_label("Create").click();
    harness.run_steps(4);
    let chosen = Choice::Path(folder.path().join("scene.txt"));
    assert_eq!(harness.state().1, chosen);
    fs::write(folder.path().join("scene.txt"), "").unwrap();
    let mut harness = showing(Purpose::New, folder.path());
    pressed(&mut harness, Key::Enter);
    harness.get_by_label_contains("is there already");
    assert_eq!(harness.state().1, Choice::Open);
    harness.get_by_label("Browse…").click();
    harness.run_steps(4);
    assert_eq!(harness.state().1, Choice::Browse);
}

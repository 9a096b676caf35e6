//! The pictures of the window in docs/PREVIEW.md.
//!
//! ```sh
//! cargo test --release --features preview --test preview -- --ignored shots
//! ```

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::common;
use crate::program::Program;
use crate::window::{File, open};
use crate::x11::{Display, keys};

/// Waits until the picture is certified and nothing moves.
fn rest(program: &mut Program<'_>) {
    program.wait("a certified picture", |window| {
        window.title().contains("certified").then_some(())
    });
    std::thread::sleep(Duration::from_millis(1500));
}

fn save(program: &Program<'_>, name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/preview");
    fs::create_dir_all(&folder).unwrap();
    let shot = program.window.screenshot().unwrap();
    // As few colours as a small file takes.
    let path = folder.join(name);
    shot.save(&path).unwrap();
}

#[test]
#[ignore = "writes the pictures of the documentation"]
fn shots() {
    let display = Display::start(1400, 900);
    // A copy, which can be written into.
    let scene = |name: &str| File::new(&fs::read_to_string(common::scenes().join(name)).unwrap());
    let size = ["--size", "600x400"];

    let mut program = open(
        &display,
        &common::scenes().join("lit/mirror_and_glass.txt"),
        &size,
    );
    program.window.resize(900, 640);
    rest(&mut program);
    // The sphere in the list, which is outlined, and a pixel that is held.
    program.window.click(700, 181);
    program.window.click(380, 190);
    rest(&mut program);
    save(&program, "inspector.png");
    program.window.key('v'.into(), &[]);
    program.window.key(keys::ESCAPE, &[]);
    rest(&mut program);
    save(&program, "verdicts.png");
    program.close();

    let file = scene("gallery/molecule.txt");
    let mut program = open(&display, &file.path, &size);
    program.window.resize(900, 640);
    rest(&mut program);
    program.window.click(700, 165);
    rest(&mut program);
    save(&program, "gallery.png");
    let broken = file.read().replacen("radius", "radios", 1);
    file.write(&broken);
    program.wait("the mistake", |window| {
        window.title().contains("mistake").then_some(())
    });
    std::thread::sleep(Duration::from_millis(700));
    save(&program, "mistake.png");
    program.close();

    small_window(&display);
    progress(&display);
    start_page(&display);
    hints(&display);
}

/// The same scene in a window of 420 by 300.
fn small_window(display: &Display) {
    let path = common::scenes().join("lit/mirror_and_glass.txt");
    let mut program = open(display, &path, &[]);
    program.window.resize(420, 300);
    rest(&mut program);
    save(&program, "small.png");
    program.close();
}

/// A slow scene, while its certified picture is made.
fn progress(display: &Display) {
    let path = common::scenes().join("showcase.txt");
    let mut program = open(display, &path, &["--size", "1920x1080", "--samples", "16"]);
    program.window.resize(900, 640);
    program.window.move_to(5, 5);
    program.wait("a first picture", |window| {
        window.title().contains("fast").then_some(())
    });
    // Not at the very beginning.
    std::thread::sleep(Duration::from_secs(8));
    save(&program, "progress.png");
    program.close();
}

fn start_page(display: &Display) {
    let file = File::new("");
    let state = file.beside("state/plumb");
    fs::create_dir_all(&state).unwrap();
    let scenes = ["/home/me/scenes/room.txt", "/home/me/scenes/tower/top.txt"];
    fs::write(state.join("recent"), scenes.join("\n")).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_plumb"));
    command.arg("preview");
    command.env("XDG_STATE_HOME", file.beside("state"));
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    let program = Program::start(display, command);
    program.window.focus();
    program.window.resize(700, 420);
    std::thread::sleep(Duration::from_secs(3));
    save(&program, "start.png");
    program.window.key('o'.into(), &[keys::CONTROL]);
    std::thread::sleep(Duration::from_millis(500));
    program.window.key('a'.into(), &[keys::CONTROL]);
    program.window.type_text("scenes/");
    std::thread::sleep(Duration::from_secs(1));
    save(&program, "open.png");
    program.close();
}

fn hints(display: &Display) {
    let file = File::new(
        "camera cam { pixeldim 400 300  worlddim 8 6  viewpoint 4 3 6 }
material wall { ambient 1 1 1  diffuse 4 4 4 }
plane back { material wall  normal 0 0 1  point 0 0 -9 }
sphere shade { material wall  center 4 3 -4  radius 2 }
light lamp { location 4 4 -4  emissivity 3 3 3 }
triangle lost { material wall  vertex1 1 9 -1  vertex2 2 9 -1  vertex3 2 10 -1 }
",
    );
    let mut program = open(display, &file.path, &[]);
    program.window.resize(900, 640);
    program.window.move_to(5, 5);
    rest(&mut program);
    save(&program, "hints.png");
    program.close();
}

#[test]
#[ignore = "writes the pictures of the documentation"]
fn shots_of_what_is_changed() {
    let display = Display::start(1400, 900);
    let shot = |scene: &str, at: (i32, i32), over: (i32, i32), name: &str| {
        let file = File::new(&fs::read_to_string(common::scenes().join(scene)).unwrap());
        let mut program = open(&display, &file.path, &["--size", "600x400"]);
        program.window.resize(900, 700);
        rest(&mut program);
        program.window.click(at.0, at.1);
        // A click is where the mouse is in the window's next frame.
        std::thread::sleep(Duration::from_millis(700));
        program.window.move_to(over.0, over.1);
        rest(&mut program);
        // What explains the pixel comes when it is there.
        std::thread::sleep(Duration::from_secs(3));
        save(&program, name);
        program.close();
    };
    // The first spotlight of the list.
    shot(
        "lit/spotlight_stage.txt",
        (700, 366),
        (5, 5),
        "spotlight.png",
    );
    // A chessman, by a click on it.
    shot(
        "gallery/quadric_chess.txt",
        (265, 290),
        (5, 5),
        "quadric.png",
    );
}

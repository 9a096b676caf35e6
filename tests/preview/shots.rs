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
        (300, 260),
        (5, 5),
        "quadric.png",
    );
}

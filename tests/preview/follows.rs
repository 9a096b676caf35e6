//! The window shows the rendered bytes, and follows the file whatever is done to it.

use std::fs;

use plumb::gpu::adapters;

use crate::program::Program;
use crate::window::{
    File, ROOM, SIZE, close, command, find, is_below, open, picture, small, wait_for_picture,
};
use crate::x11::Display;

#[test]
fn the_pixels_on_the_screen_are_the_rendered_bytes() {
    let display = Display::start(1400, 900);
    let size = format!("{}x{}", SIZE[0], SIZE[1]);
    // Software renders where it is named; else the CPU does so without it.
    let named = adapters::find(None).unwrap().get_info().name;
    for (name, options) in [
        ("notes/walls.txt", &[][..]),
        ("lit/mirror_and_glass.txt", &[]),
        ("lit/mirror_and_glass.txt", &["--adapter", &named]),
        ("lit/painting_room.txt", &["--adapter", &named]),
    ] {
        let (path, scene) = small(name);
        let mut command = command(&path, &[&["--size", &size], options].concat());
        command.env("RUST_LOG", "error,plumb=info");
        let mut program = Program::start(&display, command);
        program.window.focus();
        program.wait(name, |window| {
            window.title().contains("certified").then_some(())
        });
        wait_for_picture(&mut program, name, &picture(&scene));
        let ended = program.close();
        assert_eq!(ended.status.code(), Some(0));
        let by_device = ended.said.contains("decided on the CPU");
        assert!(by_device || options.is_empty(), "{}", ended.said);
    }
}

#[test]
fn on_a_fine_screen_the_picture_has_the_pixels_of_the_screen() {
    let display = Display::start(1800, 1400);
    let file = File::new(ROOM);
    for scale in ["1.5", "2"] {
        let mut command = command(&file.path, &[]);
        command.env("WINIT_X11_SCALE_FACTOR", scale);
        let mut program = Program::start(&display, command);
        program.window.focus();
        program.wait(scale, |window| {
            window.title().contains("certified").then_some(())
        });
        program.window.key('1'.into(), &[]);
        wait_for_picture(&mut program, scale, &file.picture(ROOM));
        close(program);
    }
}

#[test]
fn the_window_follows_the_file() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    // Written over.
    let blue = ROOM.replace("5.0 1 0", "0 1 5");
    file.write(&blue);
    wait_for_picture(&mut program, "the file written over", &file.picture(&blue));
    // Written beside, and renamed over it.
    let large = blue.replace("radius 2.5", "radius 3.5");
    let beside = file.beside("room.txt.new");
    fs::write(&beside, &large).unwrap();
    fs::rename(&beside, &file.path).unwrap();
    wait_for_picture(&mut program, "the file renamed over", &file.picture(&large));
    // Empty for a moment, then written twice.
    let small = blue.replace("radius 2.5", "radius 1.25");
    file.write("");
    file.write(&small);
    file.write(&small);
    wait_for_picture(
        &mut program,
        "the file after an empty moment",
        &file.picture(&small),
    );
    // Gone, and there again.
    fs::remove_file(&file.path).unwrap();
    program.wait("the file's end", |window| {
        window.title().contains("gone").then_some(())
    });
    file.write(ROOM);
    wait_for_picture(
        &mut program,
        "the file that is there again",
        &file.picture(ROOM),
    );
    close(program);
}

#[test]
fn a_mistake_keeps_the_last_good_picture() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    let good = file.picture(ROOM);
    let at = wait_for_picture(&mut program, "the first picture", &good);
    file.write(&ROOM.replace("radius 2.5", "radios 2.5"));
    program.wait("the mistake", |window| {
        let shot = window.screenshot()?;
        // The mistake lies over it, and the rest stays.
        let covered = find(&shot, &good).is_none();
        (window.title().contains("mistake") && covered && is_below(&shot, &good, at)).then_some(())
    });
    let mended = ROOM.replace("radius 2.5", "radius 2");
    file.write(&mended);
    wait_for_picture(&mut program, "the mended file", &file.picture(&mended));
    assert!(!program.window.title().contains("mistake"));
    close(program);
}

#[test]
fn a_file_that_begins_with_a_mistake_is_shown_once_it_is_mended() {
    let display = Display::start(1400, 900);
    let file = File::new(&ROOM.replace('}', ""));
    let mut program = open(&display, &file.path, &[]);
    program.wait("the mistake", |window| {
        window.title().contains("mistake").then_some(())
    });
    file.write(ROOM);
    program.wait("the picture", |window| {
        window.title().contains("certified").then_some(())
    });
    // There was no telling how large the picture would be, so there may be room for twice as large.
    program.window.key('1'.into(), &[]);
    wait_for_picture(&mut program, "the mended file", &file.picture(ROOM));
    close(program);
}

/// Memory that a thousand pictures may cost: buffers on their way back, what the driver keeps. One picture and its
/// buffers are 1.2 MB, so a leak of every tenth would be seen.
const GROWTH_KIB: u64 = 30 * 1024;

#[test]
fn a_thousand_edits_leave_the_memory_as_it_is() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    let edit = |i: u32| ROOM.replace("5.0 1 0", &format!("5.0 {}.{:03} 0", i / 1000, i % 1000));
    let mut before = 0;
    for i in 0..1000 {
        let text = edit(i);
        file.write(&text);
        if i % 20 == 19 {
            // Not all are rendered: the newest wins.
            wait_for_picture(&mut program, "an edit", &file.picture(&text));
        }
        if i == 199 {
            before = program.memory();
        }
    }
    let after = program.memory();
    println!("{before} KiB after 200 edits, {after} KiB after 1,000");
    assert!(
        after < before + GROWTH_KIB,
        "{before} KiB after 200 edits, {after} KiB after 1,000"
    );
    close(program);
}

//! How one comes to a scene: the page without one, another scene in the same window, a new one; which display it opens
//! on; and what is shown anew because something other than the scene's file was written.

use std::fs;
use std::path::Path;

use image::RgbImage;

use crate::edits::{radius, with_a_smaller_ball};
use crate::program::Program;
use crate::window::{File, ROOM, close, command, open, wait_for_picture};
use crate::x11::{Display, keys};

/// What is in front of the picture's file in the title.
fn wait_for_title(program: &mut Program<'_>, start: &str) {
    program.wait(start, |window| {
        window.title().starts_with(start).then_some(())
    });
}

/// Shows the picture pixel for pixel, whatever size the window has for it.
fn one_to_one(program: &mut Program<'_>) {
    program.window.resize(1300, 880);
    program.wait("its picture", |window| {
        window.title().contains("certified").then_some(())
    });
    program.window.key('1'.into(), &[]);
}

/// Types a path in place of what the dialog has, once it is there.
fn choose(program: &mut Program<'_>, path: &Path) {
    std::thread::sleep(std::time::Duration::from_millis(500));
    program.window.key('a'.into(), &[keys::CONTROL]);
    program.window.type_text(path.to_str().unwrap());
    program.window.type_text("\n");
}

#[test]
fn a_window_without_a_scene_leads_to_one() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let state = file.beside("state");
    let mut command = command(&file.path, &[]);
    command.env("XDG_STATE_HOME", &state);
    let mut alone = std::process::Command::new(command.get_program());
    alone.arg("preview");
    for (name, value) in command.get_envs() {
        alone.env(name, value.unwrap());
    }
    let mut program = Program::start(&display, alone);
    program.window.focus();
    wait_for_title(&mut program, "plumb");
    program.window.key('o'.into(), &[keys::CONTROL]);
    choose(&mut program, &file.path);
    wait_for_title(&mut program, "room.txt");
    one_to_one(&mut program);
    wait_for_picture(&mut program, "the scene", &file.picture(ROOM));
    // It follows the file that was opened.
    let other = ROOM.replace("ambient 5.0 1 0", "ambient 1 5 0");
    file.write(&other);
    wait_for_picture(&mut program, "the saved scene", &file.picture(&other));
    close(program);
    let recent = fs::read_to_string(state.join("plumb/recent")).unwrap();
    assert_eq!(
        recent.lines().collect::<Vec<_>>(),
        [file.path.to_str().unwrap()]
    );
}

#[test]
fn another_scene_takes_the_place_of_the_one_before() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first scene", &file.picture(ROOM));
    let text = ROOM.replace("radius 2.5", "radius 1");
    let other = file.beside("other.txt");
    fs::write(&other, &text).unwrap();
    program.window.key('o'.into(), &[keys::CONTROL]);
    choose(&mut program, &other);
    wait_for_picture(&mut program, "the second scene", &file.picture(&text));
    wait_for_title(&mut program, "other.txt");
    // The first one is not followed any more, the second one is.
    file.write(&ROOM.replace("radius 2.5", "radius 0.1"));
    let text = text.replace("radius 1", "radius 3");
    fs::write(&other, &text).unwrap();
    wait_for_picture(
        &mut program,
        "the second scene, saved",
        &file.picture(&text),
    );
    // A new one, in the same folder, by the name that is proposed.
    program.window.key('n'.into(), &[keys::CONTROL]);
    std::thread::sleep(std::time::Duration::from_millis(500));
    program.window.type_text("\n");
    wait_for_title(&mut program, "scene.txt");
    one_to_one(&mut program);
    let new = fs::read_to_string(file.beside("scene.txt")).unwrap();
    wait_for_picture(&mut program, "the new scene", &file.picture(&new));
    close(program);
}

#[test]
fn a_texture_that_is_saved_is_shown() {
    let display = Display::start(1400, 900);
    let text = "camera cam { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
        material m { ambient 5 5 5 } texture t { filename t.ppm }
        texplane p { material m normal 0 0 1 point 0 0 -1 xdir 1 0 0 dimensions 8 6 texname t mode 0 }";
    let file = File::new(text);
    let write = |texels: [u8; 6]| {
        let bytes = [b"P6 2 1 255\n", &texels[..]].concat();
        fs::write(file.beside("t.ppm"), bytes).unwrap();
    };
    write([255, 0, 0, 0, 255, 0]);
    let mut program = open(&display, &file.path, &[]);
    let first = file.picture(text);
    wait_for_picture(&mut program, "the picture", &first);
    write([0, 0, 255, 9, 99, 200]);
    let second = file.picture(text);
    assert_ne!(first, second);
    wait_for_picture(&mut program, "the new texture", &second);
    // One that is missing is a mistake, until it is there again.
    fs::remove_file(file.beside("t.ppm")).unwrap();
    program.wait("the mistake", |window| {
        window.title().contains("mistake").then_some(())
    });
    write([255, 0, 0, 0, 255, 0]);
    program.wait("the end of the mistake", |window| {
        window.title().contains("certified").then_some(())
    });
    wait_for_picture(&mut program, "the picture again", &first);
    close(program);
}

#[test]
fn a_dead_wayland_display_is_left_aside() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    for dead in ["wayland-dead", "/nowhere/wayland-0"] {
        let mut command = command(&file.path, &[]);
        command.env("WAYLAND_DISPLAY", dead);
        let mut program = Program::start(&display, command);
        wait_for_picture(&mut program, "the picture", &file.picture(ROOM));
        close(program);
    }
}

/// At 50 % each pixel of the window is the mean of four.
#[test]
fn below_its_size_the_picture_is_filtered() {
    let display = Display::start(1400, 900);
    let text = "camera cam { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
        material a { ambient 5 5 5 } material b { ambient 1 0 0 }
        tiled_plane p { material a altmaterial b normal 0 1 0 point 0 0 0 dimension 0.1 0.1 }";
    let file = File::new(text);
    let mut program = open(&display, &file.path, &[]);
    let whole = file.picture(text);
    wait_for_picture(&mut program, "the picture", &whole);
    // 75 %, then 50 %.
    program.window.key('-'.into(), &[]);
    program.window.key('-'.into(), &[]);
    let half = RgbImage::from_fn(160, 120, |x, y| {
        let pixels = [(0, 0), (1, 0), (0, 1), (1, 1)]
            .map(|(dx, dy)| whole.get_pixel(2 * x + dx, 2 * y + dy).0);
        image::Rgb([0, 1, 2].map(|c| {
            let sum: u32 = pixels.iter().map(|pixel| u32::from(pixel[c])).sum();
            ((sum + 2) / 4) as u8
        }))
    });
    let near = |shot: &RgbImage, x: u32, y: u32| {
        half.enumerate_pixels().all(|(c, r, pixel)| {
            let shown = shot.get_pixel(x + c, y + r).0;
            // A half may be rounded either way.
            (0..3).all(|i| shown[i].abs_diff(pixel.0[i]) <= 1)
        })
    };
    program.wait_for("the mean", |shot| {
        let (width, height) = shot.dimensions();
        let places = (0..=height - 120).flat_map(|y| (0..=width - 160).map(move |x| (x, y)));
        places.into_iter().any(|(x, y)| near(shot, x, y))
    });
    close(program);
}

#[test]
fn ten_mistakes_are_called_so_and_the_picture_under_them_is_not_certified() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the picture", &file.picture(ROOM));
    file.write(
        &ROOM
            .replace("ambient", "ambiant")
            .replace("normal", "normul"),
    );
    program.wait("the mistakes", |window| {
        let title = window.title();
        (title.ends_with("mistakes") && !title.contains("certified")).then_some(())
    });
    close(program);
}

/// Where nothing is but the window's ground, which a question over the window makes darker.
fn corner(shot: &RgbImage) -> u32 {
    shot.get_pixel(3, 3).0.map(u32::from).iter().sum()
}

/// Whether there is a button that has the keyboard: it has a bright line around it, and nothing else has one so long.
/// (A file that is held over the window makes that darker, too, as a question does.)
fn has_the_keyboard(shot: &RgbImage) -> bool {
    let is_bright = |pixel: &image::Rgb<u8>| pixel.0.iter().all(|channel| *channel > 200);
    shot.rows().any(|row| {
        let row: Vec<_> = row.map(is_bright).collect();
        row.windows(60).any(|run| run.iter().all(|bright| *bright))
    })
}

#[test]
fn a_file_that_is_dropped_is_opened_and_says_so_before() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first scene", &file.picture(ROOM));
    let text = ROOM.replace("radius 2.5", "radius 1");
    let other = file.beside("other.txt");
    fs::write(&other, &text).unwrap();
    let before = program.wait("a screenshot", |window| window.screenshot());
    let dragged = program.window.drag_over(&other);
    program.wait_for("what a drop would do", |shot| {
        corner(shot) < corner(&before)
    });
    dragged.drop_it();
    wait_for_title(&mut program, "other.txt");
    wait_for_picture(&mut program, "the dropped scene", &file.picture(&text));
    close(program);
}

#[test]
fn another_scene_is_opened_only_once_it_is_agreed_what_becomes_of_changes() {
    let display = Display::start(1400, 900);
    let text = ROOM.replace("radius 2.5", "radius 1");
    // By the dialog, then by a drop; what is answered is the number of the button, or that it is left.
    for (way, answer) in [("o", 0), ("drop", 1), ("drop", 2)] {
        let file = File::new(ROOM);
        let other = file.beside("other.txt");
        fs::write(&other, &text).unwrap();
        let (mut program, _) = with_a_smaller_ball(&display, &file);
        program.window.move_to(5, 5);
        program.wait("the smaller ball", |window| {
            window.title().ends_with("certified").then_some(())
        });
        let before = program.wait("a screenshot", |window| window.screenshot());
        if way == "o" {
            program.window.key('o'.into(), &[keys::CONTROL]);
            choose(&mut program, &other);
        } else {
            program.window.drag_over(&other).drop_it();
        }
        program.wait_for("the question", has_the_keyboard);
        if answer == 0 {
            program.window.key(keys::ESCAPE, &[]);
            program.wait_for("its end", |shot| corner(shot) == corner(&before));
            assert!(program.window.title().starts_with("room.txt*"));
            assert_eq!(file.read(), ROOM);
            program.window.key('z'.into(), &[keys::CONTROL]);
            program.wait("the undone change", |window| {
                (!window.title().contains('*')).then_some(())
            });
        } else {
            // The keyboard is at the first button.
            for _ in 1..answer {
                program.window.key(keys::TAB, &[]);
            }
            program.window.key(' '.into(), &[]);
            wait_for_title(&mut program, "other.txt");
            wait_for_picture(&mut program, "the other scene", &file.picture(&text));
            // Saved before, or lost as was agreed.
            assert_eq!(radius(&file.read()) < 2.5, answer == 1, "{}", file.read());
            assert_eq!(fs::read_to_string(&other).unwrap(), text);
        }
        close(program);
    }
}

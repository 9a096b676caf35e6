//! What is changed in the window: selected by a click, dragged by a handle, undone, saved, never lost without a
//! question.

use std::process::Command;
use std::time::Duration;

use image::{Rgb, RgbImage};
use plumb::cpu::pixel::ExactTracer;
use plumb::render::Settings;
use plumb::scene::Scene;

use crate::common;
use crate::program::Program;
use crate::window::{File, ROOM, SIZE, close, command, open, small, wait_for_picture};
use crate::x11::{Display, LEFT, keys};

/// Where the handles of [`ROOM`]'s ball are in its picture: the center is seen through the middle of the screen, and
/// rays touch the ball whose tangent is 2.5 / √(11² − 2.5²), of which 6 units are to the screen, 319 pixels 8 units.
const CENTER: (i32, i32) = (160, 120);
const EDGE: (i32, i32) = (216, 120);

/// Opens a window whose log tells what is selected.
fn open_telling<'d>(display: &'d Display, file: &std::path::Path, size: &str) -> Program<'d> {
    let mut command = command(file, &["--size", size]);
    command.env("RUST_LOG", "error,plumb=info,wgpu_core=warn");
    let program = Program::start(display, command);
    program.window.focus();
    program
}

/// Clicks the ball of the room, whose picture is there, until its handles are seen.
fn select_ball(program: &mut Program<'_>, (x, y): (u32, u32)) {
    program
        .window
        .click(x as i32 + CENTER.0 + 20, y as i32 + CENTER.1 + 30);
    let white = |shot: &RgbImage, (dx, dy): (i32, i32)| {
        *shot.get_pixel(x + dx as u32, y + dy as u32) == Rgb([255; 3])
    };
    program.wait_for("the handles", |shot| {
        white(shot, CENTER) && white(shot, EDGE)
    });
}

/// Waits until the window is at rest, with the picture of a text but for what is drawn over the ball.
fn wait_for_text(program: &mut Program<'_>, file: &File, text: &str, (x, y): (u32, u32)) {
    let picture = file.picture(text);
    program.wait("the picture at rest", |window| {
        let shot = window.screenshot()?;
        let mut corner = (0..60).flat_map(|row| (0..60).map(move |column| (column, row)));
        let seen = corner
            .all(|(c, r)| shot.get_pixel_checked(x + c, y + r) == Some(picture.get_pixel(c, r)));
        (seen && window.title().contains("certified")).then_some(())
    });
    std::thread::sleep(Duration::from_millis(400));
}

/// As a hand drags: not all between two frames.
pub(crate) fn drag(program: &Program<'_>, from: (i32, i32), to: (i32, i32)) {
    program.window.move_to(from.0, from.1);
    program.window.press(LEFT);
    for step in 1..=10 {
        std::thread::sleep(Duration::from_millis(40));
        let part = |from: i32, to: i32| from + (to - from) * step / 10;
        program
            .window
            .move_to(part(from.0, to.0), part(from.1, to.1));
    }
    program.window.release(LEFT);
}

/// Drags the edge of the ball by so many pixels.
fn drag_edge(program: &mut Program<'_>, (x, y): (u32, u32), from: i32, by: i32) {
    let at = (x as i32 + EDGE.0 + from, y as i32 + EDGE.1);
    drag(program, at, (at.0 + by, at.1));
    program.wait("the change", |window| {
        window.title().contains('*').then_some(())
    });
}

/// The window on the room, whose ball was selected and made smaller by its edge; and where the picture stands.
pub(crate) fn with_a_smaller_ball<'d>(
    display: &'d Display,
    file: &File,
) -> (Program<'d>, (u32, u32)) {
    let mut program = open(display, &file.path, &[]);
    let place = wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    select_ball(&mut program, place);
    drag_edge(&mut program, place, 0, -20);
    (program, place)
}

/// The radius of the ball in a text.
pub(crate) fn radius(text: &str) -> f64 {
    let radius = text.split("radius ").nth(1).unwrap();
    radius.split(' ').next().unwrap().parse().unwrap()
}

fn save(program: &Program<'_>) {
    program.window.key('s'.into(), &[keys::CONTROL]);
}

fn undo(program: &Program<'_>) {
    program.window.key('z'.into(), &[keys::CONTROL]);
}

fn redo(program: &Program<'_>) {
    program
        .window
        .key('z'.into(), &[keys::CONTROL, keys::SHIFT]);
}

#[test]
fn a_handle_is_dragged_in_one_step_and_undone_to_the_byte() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let (mut program, place) = with_a_smaller_ball(&display, &file);
    assert_eq!(file.read(), ROOM);
    save(&program);
    let small = program.wait("the saved radius", |_| {
        Some(file.read()).filter(|text| text != ROOM)
    });
    // The ray 20 pixels nearer to the middle passes the center at this distance.
    let tangent = (f64::from(EDGE.0 - CENTER.0) - 20.0) * (8.0 / 319.0) / 6.0;
    let wanted = 11.0 * tangent / (1.0 + tangent * tangent).sqrt();
    assert!((radius(&small) - wanted).abs() < 0.05, "{small} {wanted}");
    assert_eq!(
        small,
        ROOM.replace("radius 2.5", &format!("radius {}", radius(&small)))
    );
    undo(&program);
    save(&program);
    program.wait("the text as it was", |_| {
        (file.read() == ROOM).then_some(())
    });
    redo(&program);
    save(&program);
    program.wait("the text again", |_| (file.read() == small).then_some(()));
    wait_for_text(&mut program, &file, &small, place);
    // The middle moves it aside.
    let middle = (place.0 as i32 + CENTER.0, place.1 as i32 + CENTER.1);
    drag(&program, middle, (middle.0 + 40, middle.1));
    save(&program);
    let moved = program.wait("the saved center", |_| {
        Some(file.read()).filter(|text| *text != small)
    });
    assert!(
        moved.contains(" 3 -5  radius") && !moved.contains("center 4 "),
        "{moved}"
    );
    program.window.key(keys::ESCAPE, &[]);
    program.window.move_to(5, 5);
    wait_for_picture(&mut program, "the moved ball", &file.picture(&moved));
    close(program);
}

#[test]
fn every_way_to_close_asks_before_changes_are_lost() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    type Way = fn(&Program<'_>);
    let ways: [(&str, Way); 3] = [
        ("Ctrl+Q", |program| {
            program.window.key('q'.into(), &[keys::CONTROL])
        }),
        ("Ctrl+W", |program| {
            program.window.key('w'.into(), &[keys::CONTROL])
        }),
        ("the window's frame", |program| {
            program.window.ask_to_close()
        }),
    ];
    for (name, way) in ways {
        let mut program = open(&display, &file.path, &[]);
        let place = wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
        select_ball(&mut program, place);
        drag_edge(&mut program, place, 0, -20);
        program.window.move_to(5, 5);
        program.wait(name, |window| {
            window.title().contains("certified").then_some(())
        });
        let before = program.wait("a screenshot", |window| window.screenshot());
        // Twice: it asks again, and a question that is there stays the only one.
        for _ in 0..2 {
            way(&program);
            way(&program);
            // Everything behind the question is darker.
            let asked = |shot: &RgbImage| {
                let corner =
                    |shot: &RgbImage| shot.get_pixel(3, 3).0.map(u32::from).iter().sum::<u32>();
                shot.dimensions() == before.dimensions() && corner(shot) < corner(&before)
            };
            program.wait_for(&format!("{name}: the question"), asked);
            std::thread::sleep(Duration::from_millis(300));
            program.wait_for(&format!("{name}: the question"), asked);
            program.window.key(keys::ESCAPE, &[]);
            program.wait_for("the question's end", |shot| !asked(shot));
        }
        assert_eq!(file.read(), ROOM, "{name}");
        // With nothing to be lost there is no question.
        undo(&program);
        program.wait("the undone change", |window| {
            (!window.title().contains('*')).then_some(())
        });
        way(&program);
        let ended = program.end();
        assert_eq!((&*ended.said, ended.status.code()), ("", Some(0)), "{name}");
    }
}

#[test]
fn what_somebody_else_writes_is_not_written_over() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let (mut program, place) = with_a_smaller_ball(&display, &file);
    // The window is held up while somebody saves, and Ctrl+S is struck: it hears of both at once.
    let signal = |signal: &str, program: &Program<'_>| {
        let number = program.number().to_string();
        assert!(
            Command::new("kill")
                .args([signal, &number])
                .status()
                .unwrap()
                .success()
        );
    };
    let theirs = ROOM.replace("2 2 2", "3 2 1");
    signal("-STOP", &program);
    save(&program);
    file.write(&theirs);
    signal("-CONT", &program);
    let start = std::time::Instant::now();
    let both = loop {
        let text = file.read();
        assert!(text.contains("3 2 1"), "what they wrote is lost: {text}");
        if text != theirs {
            break text;
        }
        assert!(start.elapsed().as_secs() < 60, "it is never saved");
        // It said that it did not save: it is asked again.
        std::thread::sleep(Duration::from_millis(500));
        save(&program);
    };
    assert_eq!(
        both,
        theirs.replace("2.5 }", &format!("{} }}", radius(&both)))
    );
    // Now the same number: theirs counts, and ours can be brought back.
    drag_edge(&mut program, place, -20, -10);
    let again = both.replace(&format!("radius {}", radius(&both)), "radius 4");
    file.write(&again);
    program.wait("theirs", |window| {
        (!window.title().contains('*')).then_some(())
    });
    save(&program);
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(file.read(), again);
    undo(&program);
    program.wait("ours", |window| window.title().contains('*').then_some(()));
    save(&program);
    let ours = program.wait("ours in the file", |_| {
        Some(file.read()).filter(|text| *text != again)
    });
    assert!(radius(&ours) < radius(&both), "{ours}");
    close(program);
}

#[test]
fn what_is_clicked_in_the_gallery_is_selected() {
    let display = Display::start(1400, 900);
    let size = format!("{}x{}", SIZE[0], SIZE[1]);
    let mut clicks = 0;
    for entry in std::fs::read_dir(common::scenes().join("gallery")).unwrap() {
        let name = format!("gallery/{}", entry.unwrap().file_name().display());
        if !name.ends_with(".txt") {
            continue;
        }
        let (path, scene) = small(&name);
        let mut program = open_telling(&display, &path, &size);
        program.window.resize(1100, 800);
        program.wait(&name, |window| {
            window.title().contains("certified").then_some(())
        });
        program.window.key('1'.into(), &[]);
        let good = crate::window::picture(&scene);
        let mut place = wait_for_picture(&mut program, &name, &good);
        // What surprises in it is told a moment later, and takes room below it.
        let (x, y) = loop {
            std::thread::sleep(Duration::from_millis(500));
            let now = wait_for_picture(&mut program, &name, &good);
            if std::mem::replace(&mut place, now) == now {
                break now;
            }
        };
        for (pixel, object) in one_pixel_each(&scene) {
            let [column, row] = pixel;
            let at = (x + column, y + SIZE[1] - 1 - row);
            let before = program
                .said()
                .lines()
                .filter(|line| line.contains("selected"))
                .count();
            program.window.click(at.0 as i32, at.1 as i32);
            // What is known of the program is only what it says.
            let start = std::time::Instant::now();
            let told = loop {
                let said = program.said();
                let selected: Vec<_> = said
                    .lines()
                    .filter(|line| line.contains("selected"))
                    .collect();
                if selected.len() > before {
                    break selected[selected.len() - 1].to_owned();
                }
                assert!(
                    start.elapsed().as_secs() < 60,
                    "{name}: nothing is selected at {pixel:?}"
                );
                std::thread::sleep(Duration::from_millis(10));
            };
            let wanted = object.map_or("selected nothing ".to_owned(), |index| {
                let object = &scene.objects[index];
                format!("selected {} {}", object.entity(), object.name)
            });
            assert!(
                told.ends_with(&wanted),
                "{name}, {pixel:?}: {told}, not {wanted}"
            );
            clicks += 1;
            // Else the next click on the same place would let go; and handles are in the way.
            program.window.key(keys::ESCAPE, &[]);
        }
        assert_eq!(program.close().status.code(), Some(0));
    }
    println!("{clicks} clicks");
    assert!(clicks > 60, "{clicks}");
}

/// A pixel of each object that is seen, and one where none is: inside, so that it does not matter to which side of a
/// border a pixel belongs.
fn one_pixel_each(scene: &Scene) -> Vec<([u32; 2], Option<usize>)> {
    let exact_tracer = ExactTracer::new(scene, Settings::default().view());
    let seen = |x: u32, y: u32| {
        let hit = exact_tracer.first_hit([f64::from(x), f64::from(y)]);
        hit.ok().flatten().map(|hit| hit.object)
    };
    let mut found: Vec<([u32; 2], Option<usize>)> = Vec::new();
    for y in (4..SIZE[1] - 4).step_by(5) {
        for x in (4..SIZE[0] - 4).step_by(5) {
            let object = seen(x, y);
            let around = [
                (x - 2, y - 2),
                (x + 2, y - 2),
                (x - 2, y + 2),
                (x + 2, y + 2),
            ];
            let inside = around.iter().all(|&(x, y)| seen(x, y) == object);
            if inside && found.iter().all(|(_, other)| *other != object) {
                found.push(([x, y], object));
            }
        }
    }
    found
}

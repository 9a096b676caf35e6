//! How long it takes from saving the file to the picture on the screen, and how many pictures a second a drag shows.
//! Measures, and asserts nothing about time: run it alone, on a machine that does nothing else.
//!
//! ```sh
//! PLUMB_PREVIEW_SCENE=scene.txt cargo test --release --features preview --test preview -- --ignored --nocapture times
//! ```

use std::path::PathBuf;
use std::time::{Duration, Instant};

use plumb::edit::{Changes, Target};
use plumb::scene::load;

use crate::common;
use crate::program::Program;
use crate::window::{File, command, picture, wait_for_picture};
use crate::x11::{Display, LEFT};

const SIZE: [u32; 2] = [960, 540];
const SAVES: usize = 40;
const DRAG: Duration = Duration::from_secs(5);

#[test]
#[ignore = "measures"]
fn times() {
    let path = std::env::var_os("PLUMB_PREVIEW_SCENE").map_or_else(
        || common::scenes().join("gallery/spheres_over_tiles.txt"),
        PathBuf::from,
    );
    let text = std::fs::read(&path).unwrap();
    let scene = load(&path).unwrap();
    // The same scene from two viewpoints.
    let mut changes = Changes::new();
    let mut other = scene.camera.viewpoint;
    other.x += scene.camera.worlddim.x / 8.0;
    changes.set(&scene, Target::VIEWPOINT, other).unwrap();
    let texts =
        [text.clone(), changes.write(&text).unwrap()].map(|text| String::from_utf8(text).unwrap());
    let file = File::new(&texts[0]);
    let pictures = texts.each_ref().map(|text| {
        file.write(text);
        let mut scene = load(&file.path).unwrap();
        scene.camera.pixeldim = SIZE;
        picture(&scene)
    });
    file.write(&texts[0]);
    let display = Display::start(1500, 1000);
    let size = format!("{}x{}", SIZE[0], SIZE[1]);
    let mut command = command(&file.path, &["--size", &size]);
    command.env("RUST_LOG", "error,plumb=info");
    let mut program = Program::start(&display, command);
    let (x, y) = wait_for_picture(&mut program, "the first picture", &pictures[0]);
    // A pixel that tells them apart, in the last rows that are rendered.
    let [width, height] = SIZE;
    let (column, row) = (0..height)
        .rev()
        .flat_map(|row| (0..width).map(move |column| (column, row)))
        .find(|&(c, r)| {
            let [a, b] = pictures.each_ref().map(|picture| picture.get_pixel(c, r).0);
            a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 8)
        })
        .unwrap();
    let mut seconds = Vec::new();
    for i in 1..=SAVES {
        // Certified by then, and at rest.
        std::thread::sleep(Duration::from_millis(700));
        let wanted = pictures[i % 2].get_pixel(column, row).0;
        let start = Instant::now();
        file.write(&texts[i % 2]);
        loop {
            let seen = program.window.pixel(x + column, y + row);
            if seen.is_some_and(|seen| seen.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 2)) {
                break;
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "nothing came: {}",
                program.said()
            );
        }
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    let at = |part: f64| 1e3 * seconds[((seconds.len() - 1) as f64 * part) as usize];
    println!(
        "{}, {size}: from saving to the picture on the screen, {SAVES} saves: median {:.0} ms, 95 % below {:.0} ms, least {:.0} ms, most {:.0} ms",
        path.display(),
        at(0.5),
        at(0.95),
        at(0.0),
        at(1.0)
    );
    std::thread::sleep(Duration::from_secs(1));
    let shown = |program: &Program<'_>| {
        let said = program.said();
        let pictures = said.lines().filter(|line| line.contains(" after "));
        (
            pictures.clone().count(),
            pictures
                .filter(|line| line.contains("of the resolution"))
                .count(),
        )
    };
    let before = shown(&program);
    let from = (x as i32 + 200, y as i32 + 200);
    program.window.move_to(from.0, from.1);
    program.window.press(LEFT);
    let start = Instant::now();
    let mut step = 0;
    while start.elapsed() < DRAG {
        step += 1;
        program
            .window
            .move_to(from.0 + step * 5 % 300, from.1 + step * 3 % 100);
        // As a mouse tells, 125 times a second.
        std::thread::sleep(Duration::from_millis(8));
    }
    let elapsed = start.elapsed().as_secs_f64();
    let after = shown(&program);
    program.window.release(LEFT);
    println!(
        "dragging for {elapsed:.1} s: {:.1} pictures/s, {:.0} % of them in full resolution",
        (after.0 - before.0) as f64 / elapsed,
        100.0 - 100.0 * (after.1 - before.1) as f64 / (after.0 - before.0).max(1) as f64
    );
    assert_eq!(program.close().status.code(), Some(0));
}

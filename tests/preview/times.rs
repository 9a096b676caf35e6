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
use crate::program::{Program, cpu_seconds_of_children};
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

/// The scene whose pictures take long.
fn showcase() -> PathBuf {
    std::env::var_os("PLUMB_PREVIEW_SCENE")
        .map_or_else(|| common::scenes().join("showcase.txt"), PathBuf::from)
}

/// So many keys are struck while a picture is rendered.
const KEYS: usize = 200;

/// From striking a key to what it does being on the screen, while a picture is rendered that takes long.
#[test]
#[ignore = "measures"]
fn times_from_input_to_screen() {
    let path = showcase();
    let display = Display::start(1500, 1000);
    let options = ["--size", "1920x1080", "--samples", "16"];
    let mut command = command(&path, &options);
    command.env("RUST_LOG", "error,plumb=info");
    let mut program = Program::start(&display, command);
    program.wait("a first picture", |window| {
        window.title().contains("fast").then_some(())
    });
    program.window.focus();
    // The margin of the panel on the right, which a key opens and closes.
    let (x, y) = (program.window.size().0 - 3, 60);
    let look = |program: &mut Program<'_>| program.wait("a pixel", |window| window.pixel(x, y));
    let open = look(&mut program);
    program.window.key('o'.into(), &[]);
    let closed = program.wait("no panel", |window| {
        window.pixel(x, y).filter(|seen| *seen != open)
    });
    let mut seconds = Vec::new();
    let mut random = 1_u64;
    while seconds.len() < KEYS && !program.window.title().contains("certified") {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        std::thread::sleep(Duration::from_millis(20 + (random >> 33) % 100));
        // The mouse is on the picture, and is moved now and then.
        let at = (random >> 40) as i32;
        program.window.move_to(100 + at % 300, 100 + at / 300 % 300);
        let wanted = [open, closed][seconds.len() % 2];
        let start = Instant::now();
        program.window.key('o'.into(), &[]);
        while program.window.pixel(x, y) != Some(wanted) {
            assert!(
                start.elapsed() < Duration::from_secs(120),
                "{}",
                program.said()
            );
            std::thread::sleep(Duration::from_micros(500));
        }
        seconds.push(start.elapsed().as_secs_f64());
    }
    let count = seconds.len();
    seconds.sort_by(f64::total_cmp);
    let at = |part: f64| 1e3 * seconds[((count - 1) as f64 * part).round() as usize];
    println!(
        "{}: {count} keys while it is rendered: median {:.0} ms, 90 % below {:.0} ms, 99 % below {:.0} ms, most {:.0} ms",
        path.display(),
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
    assert_eq!(program.close().status.code(), Some(0));
}

/// What the first pictures cost where nothing moves, in the window and on the command line.
#[test]
#[ignore = "measures"]
fn times_of_the_first_pictures() {
    let path = showcase();
    let display = Display::start(1500, 1000);
    let size = ["--size", "1920x1080"];
    let mut command = command(&path, &size);
    command.env("RUST_LOG", "error,plumb=info");
    let start = Instant::now();
    let mut program = Program::start(&display, command);
    for kind in ["fast", "certified"] {
        program.wait(kind, |window| window.title().contains(kind).then_some(()));
        println!(
            "{}: {} after {:.1} s, {:.1} CPU-seconds",
            path.display(),
            program.window.title(),
            start.elapsed().as_secs_f64(),
            program.cpu_seconds()
        );
    }
    print!("{}", program.said());
    assert_eq!(program.close().status.code(), Some(0));
    let folder = tempfile::tempdir().unwrap();
    for backend in ["auto", "gpu"] {
        let (start, before) = (Instant::now(), cpu_seconds_of_children());
        let mut alone = std::process::Command::new(env!("CARGO_BIN_EXE_plumb"));
        alone.arg("render").arg(&path).args(size);
        alone.args(["--backend", backend, "-o"]);
        let done = alone.arg(folder.path().join("out.ppm")).output().unwrap();
        assert!(done.status.success(), "{done:?}");
        println!(
            "on the command line, --backend {backend}: certified after {:.1} s, {:.1} CPU-seconds",
            start.elapsed().as_secs_f64(),
            cpu_seconds_of_children() - before
        );
    }
}

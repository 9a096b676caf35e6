//! What the hands do: keys, mouse, and what becomes of the file.

use image::{Rgb, RgbImage};
use plumb::certify::DecidedBy;
use plumb::certify::verdict::color;
use plumb::gpu::adapters;
use plumb::render::{Backend, Settings, render};

use crate::program::Program;
use crate::window::{
    File, ROOM, SIZE, close, command, find, open, picture, small, wait_for_picture,
};
use crate::x11::{Display, LEFT, MIDDLE, RIGHT, keys};

/// The picture is at this place, and a moment later still is.
fn stays(program: &mut Program<'_>, picture: &RgbImage, place: (u32, u32)) {
    for _ in 0..10 {
        std::thread::sleep(std::time::Duration::from_millis(30));
        let found = program.wait("a screenshot", |window| window.screenshot());
        assert_eq!(find(&found, picture), Some(place));
    }
}

#[test]
fn the_picture_is_moved_by_the_other_buttons_and_stays_there() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    let good = file.picture(ROOM);
    let (x, y) = wait_for_picture(&mut program, "the first picture", &good);
    for (button, by) in [(RIGHT, (40, 24)), (MIDDLE, (-60, -36))] {
        let (from, to) = ((x as i32 + 100, y as i32 + 100), (by.0, by.1));
        program.window.move_to(from.0, from.1);
        program.window.press(button);
        for step in 1..=4 {
            program
                .window
                .move_to(from.0 + to.0 * step / 4, from.1 + to.1 * step / 4);
            std::thread::sleep(std::time::Duration::from_millis(30));
        }
        let dragged = program.wait("the moved picture", |window| {
            find(&window.screenshot()?, &good).filter(|place| *place != (x, y))
        });
        program.window.release(button);
        let place = |from: u32, by: i32| (from as i32 + by) as u32;
        let wanted = if button == RIGHT {
            (place(x, 40), place(y, 24))
        } else {
            (place(x, -20), place(y, -12))
        };
        program.wait("the picture where it was let go", |window| {
            (find(&window.screenshot()?, &good)? == wanted).then_some(())
        });
        stays(&mut program, &good, wanted);
        assert!(dragged != (x, y));
    }
    assert_eq!(file.read(), ROOM);
    close(program);
}

#[test]
fn the_viewpoint_is_moved_and_written_into_the_file() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    let (x, y) = wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    let (x, y) = (x as i32, y as i32);
    // 40 pixels are a unit of the world.
    program.window.move_to(x + 100, y + 100);
    program.window.press(LEFT);
    for step in 1..=10 {
        program
            .window
            .move_to(x + 100 + 4 * step, y + 100 + 2 * step);
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let moved =
        |viewpoint: &str| ROOM.replace("viewpoint 4 3 6", &format!("viewpoint {viewpoint}"));
    let dragged = moved("5 2.5 6");
    let picture = file.picture(&dragged);
    let place = wait_for_picture(&mut program, "the drag", &picture);
    assert_eq!(place, (x as u32, y as u32));
    program.window.release(LEFT);
    stays(&mut program, &picture, place);
    // The file is as it was until it is saved.
    assert_eq!(file.read(), ROOM);
    program.window.key('s'.into(), &[keys::CONTROL]);
    program.wait("the saved viewpoint", |_| {
        (file.read() == dragged).then_some(())
    });
    // An arrow is a fortieth of the screen's width.
    program.window.key(keys::RIGHT, &[]);
    program.window.key(keys::UP, &[]);
    program.window.key(keys::UP, &[keys::SHIFT]);
    let stepped = moved("5.2 2.72 6");
    wait_for_picture(&mut program, "steps", &file.picture(&stepped));
    // Back to the file's.
    program.window.key('r'.into(), &[]);
    wait_for_picture(&mut program, "the reset", &file.picture(&dragged));
    assert_eq!(file.read(), dragged);
    // The wheel moves it away from the screen and back; how far a step goes, the file tells.
    program.window.move_to(x + 100, y + 100);
    program.window.wheel(-1);
    program.wait("the wheel", |window| {
        window.title().contains('*').then_some(())
    });
    program.window.key('s'.into(), &[keys::CONTROL]);
    let text = program.wait("the saved distance", |_| {
        Some(file.read()).filter(|text| *text != dragged)
    });
    let z = text.split("viewpoint 5 2.5 ").nth(1).unwrap();
    let z: f64 = z.split_whitespace().next().unwrap().parse().unwrap();
    assert!(z > 6.2, "{z}");
    wait_for_picture(&mut program, "the wheel's picture", &file.picture(&text));
    close(program);
}

#[test]
fn the_camera_is_copied_as_a_block() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    program.window.key(keys::RIGHT, &[]);
    let text = ROOM.replace("viewpoint 4 3 6", "viewpoint 4.2 3 6");
    wait_for_picture(&mut program, "the step", &file.picture(&text));
    program.window.key('c'.into(), &[]);
    let block = program.wait("the clipboard", |_| display.clipboard());
    // In place of the file's camera it makes the same picture.
    let camera = ROOM
        .lines()
        .find(|line| line.starts_with("camera"))
        .unwrap();
    let pasted = ROOM.replace(camera, &block);
    assert_eq!(file.picture(&pasted), file.picture(&text), "{block}");
    close(program);
}

#[test]
fn pixels_are_enlarged_up_to_64_times() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    let good = file.picture(ROOM);
    let (x, y) = wait_for_picture(&mut program, "the first picture", &good);
    // A pixel of the ball's edge, and its neighbour.
    let (column, row) = (160, 120);
    let at = (x as i32 + column, y as i32 + row);
    program.window.move_to(at.0, at.1);
    for _ in 0..20 {
        program.window.key('+'.into(), &[]);
    }
    // What was under the cursor stays there, 64 times as large: its left edge is at the cursor.
    let wanted = |c: u32, r: u32| *good.get_pixel(c, r);
    program.wait_for("pixels as large as 64", |shot| {
        let cell = |dx: i32, dy: i32| {
            // Next to the corner of the cell, away from the numbers.
            let at = (at.0 + 64 * dx + 3, at.1 + 64 * dy + 3);
            *shot.get_pixel(at.0 as u32, at.1 as u32)
        };
        (-2..=2).all(|dx| {
            (-2..=2).all(|dy| {
                let (c, r) = (column + dx, row + dy);
                cell(dx, dy) == wanted(c as u32, r as u32)
            })
        })
    });
    program.window.key('f'.into(), &[]);
    wait_for_picture(&mut program, "the whole picture again", &good);
    close(program);
}

#[test]
fn what_decided_each_pixel_is_painted_over_the_picture() {
    let display = Display::start(1400, 900);
    // A scene with borders on pixels, which take exact arithmetic.
    let (path, scene) = small("hard/tied_lines.txt");
    // Named, or the CPU may render in place of software, and decide otherwise.
    let named = adapters::find(None).unwrap().get_info().name;
    let settings = Settings {
        verdicts: true,
        backend: Backend::Gpu,
        ..Settings::default()
    };
    let mut verdicts = Vec::new();
    render(&scene, &settings, &mut |band| {
        verdicts.extend(band.verdicts.clone().unwrap());
        Ok(())
    })
    .unwrap();
    assert!(
        verdicts.contains(&DecidedBy::Exact),
        "nothing to be painted"
    );
    let size = format!("{}x{}", SIZE[0], SIZE[1]);
    let options = ["--size", &size, "--adapter", &named];
    let mut program = open(&display, &path, &options);
    let good = picture(&scene);
    wait_for_picture(&mut program, "a picture", &good);
    // So large that the legend lies beside the picture, not on it.
    program.window.key('1'.into(), &[]);
    program.window.resize(1400, 900);
    // The lists are at the new right edge when that was drawn.
    program.wait_for("the room", |shot| {
        shot.dimensions() == (1400, 900) && shot.get_pixel(1397, 897).0 != [0; 3]
    });
    let (x, y) = wait_for_picture(&mut program, "the picture", &good);
    program.window.key('v'.into(), &[]);
    program.wait_for("the verdicts", |shot| {
        let mut pixels = verdicts.iter().enumerate();
        pixels.all(|(i, by)| {
            let (c, r) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
            let found = shot.get_pixel(x + c, y + r);
            if *by != DecidedBy::Gpu {
                return *found == Rgb(color(*by));
            }
            // Sure pixels step back.
            let dim = |channel: usize| {
                let byte = f64::from(good.get_pixel(c, r).0[channel]);
                0.3 * byte + 0.3 * f64::from(color(*by)[channel])
            };
            (0..3).all(|i| (dim(i) - f64::from(found.0[i])).abs() <= 1.0)
        })
    });
    program.window.key('v'.into(), &[]);
    wait_for_picture(&mut program, "the picture again", &good);
    close(program);
}

#[test]
fn the_picture_is_saved_as_render_writes_it() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    for name in ["saved.png", "saved.exr"] {
        let to = file.beside(name);
        program.window.key('p'.into(), &[]);
        // In place of the name that is proposed.
        std::thread::sleep(std::time::Duration::from_millis(300));
        program.window.key('a'.into(), &[keys::CONTROL]);
        program.window.type_text(&format!("{}\n", to.display()));
        let other = file.beside(&format!("rendered-{name}"));
        let rendered = std::process::Command::new(env!("CARGO_BIN_EXE_plumb"))
            .args(["render", "--quiet"])
            .arg(&file.path)
            .arg("-o")
            .arg(&other)
            .status()
            .unwrap();
        assert!(rendered.success());
        program.wait(name, |_| to.exists().then_some(()));
        assert!(
            std::fs::read(&to).unwrap() == std::fs::read(&other).unwrap(),
            "{name} is another file than `plumb render` writes"
        );
    }
    close(program);
}

/// A scene that takes the GPU of a CPU a while.
#[test]
fn a_storm_of_sizes_is_survived_while_a_slow_scene_renders() {
    let display = Display::start(1400, 900);
    let (path, mut scene) = small("lit/mirror_and_glass.txt");
    scene.camera.pixeldim = [400, 300];
    let options = ["--size", "400x300", "--samples", "64"];
    let mut program = open(&display, &path, &options);
    for i in 0..60_u32 {
        let part = |most: u32, by: u32| 500 + (i * by) % (most - 500);
        program.window.resize(part(1400, 97), part(900, 61));
        if i % 7 == 0 {
            // Something else to be rendered, too.
            program.window.key(keys::LEFT, &[]);
            program.window.key(keys::RIGHT, &[]);
        }
        std::thread::sleep(std::time::Duration::from_millis(15));
    }
    program.window.resize(1000, 800);
    let mut rgb = Vec::new();
    let settings = Settings {
        samples: 64,
        ..Settings::default()
    };
    render(&scene, &settings, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    })
    .unwrap();
    let right = RgbImage::from_raw(400, 300, rgb).unwrap();
    wait_for_picture(&mut program, "the picture after the storm", &right);
    assert_eq!(program.window.size(), (1000, 800));
    close(program);
}

/// Frames after a change of the size keep all others from the device. One that ends the program waits for them.
#[test]
fn it_can_be_closed_just_after_its_size_changed() {
    let display = Display::start(1400, 900);
    let (path, _) = small("lit/mirror_and_glass.txt");
    for i in 0..8_u32 {
        // It takes seconds, so that it renders whenever it is closed.
        let options = ["--size", "800x600", "--samples", "256"];
        let program = open(&display, &path, &options);
        program.window.resize(700 + 50 * i, 600);
        std::thread::sleep(std::time::Duration::from_millis(100 * u64::from(i)));
        close(program);
    }
}

#[test]
fn the_window_ends_by_its_key_too() {
    let display = Display::start(1400, 900);
    let file = File::new(ROOM);
    let mut program = open(&display, &file.path, &[]);
    wait_for_picture(&mut program, "the first picture", &file.picture(ROOM));
    program.window.key('q'.into(), &[keys::CONTROL]);
    let ended = program.end();
    assert_eq!((&*ended.said, ended.status.code()), ("", Some(0)));
}

#[test]
fn without_a_display_or_a_gpu_it_says_what_else_there_is() {
    let file = File::new(ROOM);
    let said = |change: &dyn Fn(&mut std::process::Command)| {
        let mut command = command(&file.path, &[]);
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command.env_remove("WAYLAND_SOCKET");
        change(&mut command);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty());
        String::from_utf8(output.stderr).unwrap()
    };
    let alone = said(&|_| ());
    assert!(alone.contains("plumb render SCENE"), "{alone}");
    let blind = said(&|command| {
        command.env("VK_DRIVER_FILES", "/dev/null");
        command.env("VK_ICD_FILENAMES", "/dev/null");
    });
    assert!(blind.contains("mesa-vulkan-drivers"), "{blind}");
}

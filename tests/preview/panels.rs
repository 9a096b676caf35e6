//! What is selected in the panel: the handles that lights have in the picture, and how the picture is rendered.

use std::thread;
use std::time::Duration;

use image::{Rgb, RgbImage};
use plumb::render::{Backend, Band, Settings, render};
use plumb::scene::{Beam, Scene, load};

use crate::edits::drag;
use crate::program::Program;
use crate::window::{File, close, open, wait_for_picture};
use crate::x11::{Display, keys};

/// A wall, of which the lights' handles stand out.
const LIT: &str = "\
camera cam { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
material dull { ambient 2 0 0  diffuse 0.5 0.5 0.5 }
plane wall { material dull  normal 0 0 1  point 0 0 -6 }
light lamp { location 4.0 3 -2  emissivity 3 3 3 }   # in the middle
spotlight spot { location 2 3.0 -2  emissivity 3 0 0  point 2 4 -6  theta 20 }
";

/// Where the handles are in its picture: 319 pixels are 8 units, 239 are 6, and what lies behind the screen is nearer
/// to the middle.
const LAMP: (i32, i32) = (160, 120);
const SPOT: (i32, i32) = (100, 120);
const AIM: (i32, i32) = (120, 100);

/// Between a click and what it does being on the screen.
const SEEN: Duration = Duration::from_millis(250);

/// Clicks a line of the lists, whose first one is 0, and waits for these handles.
fn select(program: &mut Program<'_>, line: i32, (x, y): (i32, i32), handles: &[(i32, i32)]) {
    let width = program.window.size().0 as i32;
    program.window.click(width - 200, 113 + 23 * line);
    program.wait_for("the handles", |shot| {
        handles
            .iter()
            .all(|(dx, dy)| *shot.get_pixel((x + dx) as u32, (y + dy) as u32) == Rgb([255; 3]))
    });
}

/// Drags a handle of what is selected by so many pixels, and saves. What the file has then.
fn drag_and_save(
    program: &mut Program<'_>,
    file: &File,
    from: (i32, i32),
    by: (i32, i32),
) -> Scene {
    let before = file.read();
    drag(program, from, (from.0 + by.0, from.1 + by.1));
    program.wait("the change", |window| {
        window.title().contains('*').then_some(())
    });
    program.window.key('s'.into(), &[keys::CONTROL]);
    program.wait("the saved change", |_| {
        (file.read() != before).then_some(())
    });
    load(&file.path).unwrap()
}

#[test]
fn lights_are_moved_and_spotlights_are_aimed_by_their_handles() {
    let display = Display::start(1400, 900);
    // So much a pixel is at this z, to the right and up.
    let near = |found: glam::DVec3, from: [f64; 3], by: (i32, i32)| {
        let aside = |pixels: i32, step: f64| f64::from(pixels) * step * (6.0 - from[2]) / 6.0;
        let [dx, dy] = [aside(by.0, 8.0 / 319.0), -aside(by.1, 6.0 / 239.0)];
        let wanted = glam::DVec3::new(from[0] + dx, from[1] + dy, from[2]);
        assert!((found - wanted).length() < 0.03, "{found} {wanted}");
    };
    let aim = |scene: &Scene| match &scene.lights[1].beam {
        Beam::Cone(cone) => cone.point,
        _ => panic!("a spotlight is one"),
    };
    type Drag<'a> = (
        (i32, i32),
        [f64; 3],
        (i32, i32),
        &'a dyn Fn(&Scene) -> glam::DVec3,
    );
    let lamp: [Drag<'_>; 1] = [(LAMP, [4.0, 3.0, -2.0], (32, -16), &|scene| {
        scene.lights[0].location
    })];
    let spot: [Drag<'_>; 2] = [
        (AIM, [2.0, 4.0, -6.0], (20, 30), &aim),
        (SPOT, [2.0, 3.0, -2.0], (-24, 8), &|scene| {
            scene.lights[1].location
        }),
    ];
    // Behind the lists of an object and a material.
    for (line, drags) in [(5, &lamp[..]), (6, &spot)] {
        let file = File::new(LIT);
        let mut program = open(&display, &file.path, &[]);
        let place = wait_for_picture(&mut program, "the picture", &file.picture(LIT));
        let place = (place.0 as i32, place.1 as i32);
        let handles: Vec<_> = drags.iter().map(|drag| drag.0).collect();
        select(&mut program, line, place, &handles);
        for (handle, from, by, of) in drags {
            let at = (place.0 + handle.0, place.1 + handle.1);
            let scene = drag_and_save(&mut program, &file, at, *by);
            near(of(&scene), *from, *by);
        }
        for _ in drags {
            program.window.key('z'.into(), &[keys::CONTROL]);
        }
        program.window.key('s'.into(), &[keys::CONTROL]);
        program.wait("the text as it was", |_| (file.read() == LIT).then_some(()));
        close(program);
    }
}

/// A ball over a mirror, before a wall.
const MIRROR: &str = "\
camera cam { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 5 1 0 }
material gray { ambient 2 2 2 }
material mirror { ambient 0 0 1  specular 0.5 0.5 0.5 }
sphere ball { material red  center 4 3 -4  radius 1.5 }
plane floor { material mirror  normal 0 1 0  point 0 0 0 }
plane wall { material gray  normal 0 0 1  point 0 0 -9 }
light lamp { location 4 5 -1  emissivity 2 2 2 }
";

/// Its picture with these settings.
fn rendered(file: &File, settings: &Settings) -> RgbImage {
    let mut scene = load(&file.path).unwrap();
    scene.camera.pixeldim = crate::window::SIZE;
    let settings = Settings {
        backend: Backend::Cpu,
        ..settings.clone()
    };
    let mut rgb = Vec::new();
    let mut take = |band: &Band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    };
    render(&scene, &settings, &mut take).unwrap();
    let [width, height] = scene.camera.pixeldim;
    RgbImage::from_raw(width, height, rgb).unwrap()
}

#[test]
fn samples_tolerance_and_longest_path_are_set_in_the_window() {
    let display = Display::start(1400, 900);
    let file = File::new(MIRROR);
    let mut program = open(&display, &file.path, &[]);
    program.window.resize(1000, 850);
    program.wait("the picture", |window| {
        window.title().ends_with("certified").then_some(())
    });
    program.window.key('1'.into(), &[]);
    let mut settings = Settings::default();
    wait_for_picture(&mut program, "the picture", &rendered(&file, &settings));
    // The last line of the panel that can be clicked opens the settings.
    let left = 1000 - 255;
    let panel = |program: &mut Program<'_>| {
        program.window.move_to(5, 5);
        thread::sleep(SEEN);
        let shot = program.wait("a screenshot", |window| window.screenshot());
        image::imageops::crop_imm(&shot, left as u32, 0, 240, 800).to_image()
    };
    let closed = panel(&mut program);
    let mut row = 800;
    while panel(&mut program) == closed {
        row -= 8;
        assert!(row > 150, "the settings are not found");
        program.window.click(left + 10, row);
    }
    let typed = |program: &Program<'_>, line: i32, text: &str| {
        program.window.click(left + 135, row + 16 + 23 * line);
        thread::sleep(SEEN);
        program.window.key('a'.into(), &[keys::CONTROL]);
        program.window.type_text(text);
        program.window.type_text("\n");
    };
    typed(&program, 0, "4");
    settings.samples = 4;
    wait_for_picture(&mut program, "four samples", &rendered(&file, &settings));
    // How they are spread is a line more.
    typed(&program, 2, "-7");
    settings.screen_tolerance = -7.0;
    wait_for_picture(&mut program, "the tolerance", &rendered(&file, &settings));
    typed(&program, 3, "13");
    let longest = rendered(&file, &settings);
    settings.limits.max_path = 13.0;
    let shorter = rendered(&file, &settings);
    assert_ne!(longest, shorter);
    wait_for_picture(&mut program, "the longest path", &shorter);
    // It is not in the file, and nothing to be lost.
    assert_eq!(file.read(), MIRROR);
    close(program);
}

//! What the tests of `plumb preview` share: the program on a scene of its own, the pictures that it should show, and
//! where in a screenshot they are.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use image::{Rgb, RgbImage};
use plumb::render::{Backend, Band, Settings, render};
use plumb::scene::{Scene, load};
use tempfile::TempDir;

use crate::common;
use crate::program::Program;
use crate::x11::Display;

/// Columns and rows of the pictures: the window shows them pixel for pixel.
pub(crate) const SIZE: [u32; 2] = [320, 240];

/// A room that tests write into.
pub(crate) const ROOM: &str = "\
# Some words that have to stay.
camera cam { pixeldim 320 240  worlddim 8 6  viewpoint 4 3 6 }
material red   { ambient 5.0 1 0 }   # warm
material gray  { ambient 2 2 2 }
sphere ball { material red  center 4 3 -5  radius 2.5 }
plane floor { material gray  normal 0 1 0  point 0 -1 0 }
plane wall  { material gray  normal 0 0 1  point 0 0 -9 }
";

/// A scene's file in a folder of its own.
pub(crate) struct File {
    folder: TempDir,
    /// The file.
    pub(crate) path: PathBuf,
}

impl File {
    pub(crate) fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.txt");
        fs::write(&path, text).unwrap();
        Self { folder, path }
    }

    /// Its name in its folder.
    pub(crate) fn name(&self) -> &str {
        self.path.file_name().unwrap().to_str().unwrap()
    }

    /// Another name in the same folder.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, text: &str) {
        fs::write(&self.path, text).unwrap();
    }

    pub(crate) fn read(&self) -> String {
        fs::read_to_string(&self.path).unwrap()
    }

    /// What the picture of a scene with this text is.
    pub(crate) fn picture(&self, text: &str) -> RgbImage {
        let other = self.beside("expected.txt");
        fs::write(&other, text).unwrap();
        picture(&load(&other).unwrap())
    }
}

/// The scene's picture, by the CPU.
pub(crate) fn picture(scene: &Scene) -> RgbImage {
    let settings = Settings {
        backend: Backend::Cpu,
        ..Settings::default()
    };
    let mut rgb = Vec::new();
    let mut take = |band: &Band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    };
    render(scene, &settings, &mut take).unwrap();
    let [width, height] = scene.camera.pixeldim;
    RgbImage::from_raw(width, height, rgb).unwrap()
}

/// A scene of ours, as large as the tests' pictures.
pub(crate) fn small(name: &str) -> (PathBuf, Scene) {
    let path = common::scenes().join(name);
    let mut scene = common::read(&path);
    scene.camera.pixeldim = SIZE;
    (path, scene)
}

/// `plumb preview`, with everything on stderr that should not be.
pub(crate) fn command(scene: &Path, options: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plumb"));
    command.arg("preview").arg(scene).args(options);
    // What was opened last is none of the user's who runs the tests.
    command.env("XDG_STATE_HOME", std::env::temp_dir().join("plumb-tests"));
    command.env("RUST_LOG", "error,plumb=warn,wgpu_core=warn");
    command
}

/// Its window, with the keyboard.
pub(crate) fn open<'d>(display: &'d Display, scene: &Path, options: &[&str]) -> Program<'d> {
    let program = Program::start(display, command(scene, options));
    program.window.focus();
    program
}

/// Waits until the picture is shown, every pixel of it; where.
pub(crate) fn wait_for_picture(
    program: &mut Program<'_>,
    what: &str,
    picture: &RgbImage,
) -> (u32, u32) {
    program.wait(what, |window| find(&window.screenshot()?, picture))
}

/// Closes the window: nothing was said, the exit code is 0.
pub(crate) fn close(program: Program<'_>) {
    let ended = program.close();
    assert_eq!(ended.said, "");
    assert_eq!(ended.status.code(), Some(0));
}

/// Where a picture is in a screenshot, all its pixels equal.
pub(crate) fn find(shot: &RgbImage, picture: &RgbImage) -> Option<(u32, u32)> {
    let (width, height) = picture.dimensions();
    let [across, down] = [
        shot.width().checked_sub(width)?,
        shot.height().checked_sub(height)?,
    ];
    let line = |image: &RgbImage, x: u32, y: u32| {
        let start = 3 * (y as usize * image.width() as usize + x as usize);
        start..start + 3 * width as usize
    };
    let same = |x: u32, y: u32, row: u32| {
        shot.as_raw()[line(shot, x, y + row)] == picture.as_raw()[line(picture, 0, row)]
    };
    // The middle row is the one that the fewest places have.
    let places = (0..=down).flat_map(|y| (0..=across).map(move |x| (x, y)));
    places
        .filter(|&(x, y)| same(x, y, height / 2))
        .find(|&(x, y)| (0..height).all(|row| same(x, y, row)))
}

/// Whether the picture is there, but for what lies over its upper left part, as an error does.
pub(crate) fn is_below(shot: &RgbImage, picture: &RgbImage, (x, y): (u32, u32)) -> bool {
    let (width, height) = picture.dimensions();
    let mut pixels = (height * 3 / 4..height).flat_map(|row| (0..width).map(move |c| (c, row)));
    pixels.all(|(c, row)| shot.get_pixel_checked(x + c, y + row) == Some(picture.get_pixel(c, row)))
}

#[test]
fn a_picture_is_found_only_where_every_pixel_is_right() {
    let picture = RgbImage::from_fn(7, 5, |x, y| Rgb([x as u8, y as u8, 9]));
    let mut shot = RgbImage::from_pixel(30, 20, Rgb([1, 2, 3]));
    assert_eq!(find(&shot, &picture), None);
    image::imageops::replace(&mut shot, &picture, 11, 4);
    assert_eq!(find(&shot, &picture), Some((11, 4)));
    assert!(is_below(&shot, &picture, (11, 4)));
    for (x, y) in [(11, 4), (17, 8), (14, 6)] {
        let mut shot = shot.clone();
        shot.get_pixel_mut(x, y).0[2] += 1;
        assert_eq!(find(&shot, &picture), None, "({x}, {y})");
        assert_eq!(is_below(&shot, &picture, (11, 4)), y < 7, "({x}, {y})");
    }
    assert_eq!(find(&picture, &shot), None);
}

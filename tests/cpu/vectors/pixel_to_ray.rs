//! The ray through a pixel, by camera and screen.

use super::*;

const VIEWPOINT: DVec3 = vec(4.0, 3.0, 6.0);

fn two_digits(v: DVec3) -> [String; 3] {
    v.to_array().map(|x| format!("{x:.2}"))
}

/// World point and direction of a pixel, as plumb's camera has them.
fn plumb(pixeldim: [u32; 2], x: f64, y: f64) -> (DVec3, DVec3) {
    let camera = Camera::<f64>::new(&scene::Camera {
        name: "c".into(),
        pixeldim,
        worlddim: DVec2::new(8.0, 6.0),
        viewpoint: VIEWPOINT,
    });
    let w = camera_getdir(&camera, x, y).w;
    let w = vec(w.x, w.y, w.z) * 2.0_f64.powi(camera.scale);
    (VIEWPOINT + w, w.normalize())
}

/// 8 · 639/640 is 7.9875, which the notes round up; what `{:.3}` makes of the f64 next to such a tie is chance.
fn assert_printed_7_988(x: f64) {
    assert!((x - 7.9875).abs() < 1e-14, "{x}");
    assert_eq!((x * 1000.0).round() / 1000.0, 7.988);
}

#[test]
fn by_the_first_formula() {
    let world = vec(8.0 * 100.0 / 640.0, 6.0 * 40.0 / 480.0, 0.0);
    assert_eq!(world, vec(1.25, 0.5, 0.0));
    let direction = world - VIEWPOINT;
    assert_eq!(direction, vec(-2.75, -2.5, -6.0));
    assert_eq!(format!("{:.2}", direction.length()), "7.06");
    assert_eq!(
        two_digits(direction.normalize()),
        ["-0.39", "-0.35", "-0.85"]
    );
    assert_printed_7_988(8.0 * 639.0 / 640.0);
}

#[test]
fn by_the_second_formula_and_plumb() {
    let (world, direction) = plumb([640, 480], 100.0, 40.0);
    assert_close(world, vec(8.0 * 100.0 / 639.0, 6.0 * 40.0 / 479.0, 0.0));
    assert!(
        world.x > 1.25 && world.y > 0.5,
        "slightly larger than the nice numbers"
    );
    assert_eq!(two_digits(direction), ["-0.39", "-0.35", "-0.85"]);
    assert!(direction.z < 0.0);
    assert_close(plumb([640, 480], 639.0, 479.0).0, vec(8.0, 6.0, 0.0));
    assert_close(plumb([640, 480], 0.0, 0.0).0, DVec3::ZERO);
}

#[test]
fn one_pixel_more_makes_the_numbers_nice() {
    let (world, direction) = plumb([641, 481], 100.0, 40.0);
    assert_eq!(world, vec(1.25, 0.5, 0.0));
    assert_eq!(direction, vec(-2.75, -2.5, -6.0).normalize());
    assert_printed_7_988(plumb([641, 481], 639.0, 0.0).0.x);
    // And the image has a centre pixel.
    assert_eq!(plumb([641, 481], 320.0, 240.0).0, vec(4.0, 3.0, 0.0));
}

//! The pixels that scenes state themselves, as `#= x y r g b` with (0, 0) at the bottom left: worked out by hand, or
//! derived from exact arithmetic. Where f64 cannot decide such a pixel (an exact tie, or nearly one), it is not asked.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use plumb::cpu::camera::camera_setpix;
use plumb::cpu::trace::ray_trace;
use plumb::prepare::Prepared;
use plumb::real::{Bounded, Undecided};

/// The stated pixels of a scene file.
fn stated(text: &str) -> Vec<[u32; 5]> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("#="));
    lines.map(|line| {
        let numbers: Vec<u32> = line.split_whitespace().map(|n| n.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    })
    .collect()
}

/// The bytes of a pixel where f64 with error bounds is sure of them.
fn bounded(scene: &Prepared<Bounded>, x: u32, y: u32) -> Result<[u8; 3], Undecided> {
    camera_setpix(ray_trace(scene, f64::from(x), f64::from(y))?.color)
}

#[test]
fn stated_pixels_are_rendered() {
    let (mut sure, mut undecided) = (0, 0);
    for path in common::good_scenes() {
        let stated = stated(&std::fs::read_to_string(&path).unwrap());
        if stated.is_empty() {
            continue;
        }
        let scene = common::read(&path);
        let f64s = Prepared::<f64>::new(&scene, 0.0);
        let bounds = Prepared::<Bounded>::new(&scene, 0.0);
        for [x, y, r, g, b] in stated {
            let want = [r, g, b].map(|byte| u8::try_from(byte).unwrap());
            let Ok(certain) = bounded(&bounds, x, y) else {
                undecided += 1;
                continue;
            };
            sure += 1;
            let name = path.file_name().unwrap().display().to_string();
            assert_eq!(certain, want, "{name}: pixel ({x}, {y}) with bounds");
            let plain = camera_setpix(ray_trace(&f64s, f64::from(x), f64::from(y)).unwrap().color).unwrap();
            assert_eq!(plain, want, "{name}: pixel ({x}, {y}) in f64");
        }
    }
    println!("{sure} stated pixels sure in f64, {undecided} not");
    // A bound that is never sure would pass everything above.
    assert!(sure > 200, "only {sure} of {} stated pixels are sure in f64", sure + undecided);
}

#[test]
fn a_wrong_statement_is_noticed() {
    let scene = common::read(&common::scenes().join("known/wall_head_on.txt"));
    let bounds = Prepared::<Bounded>::new(&scene, 0.0);
    let lines = stated(&std::fs::read_to_string(common::scenes().join("known/wall_head_on.txt")).unwrap());
    let [x, y, r, g, b] = lines[0];
    let off_by_one = [(r ^ 1) as u8, g as u8, b as u8];
    assert_ne!(bounded(&bounds, x, y), Ok(off_by_one));
}

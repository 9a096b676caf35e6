//! The pixels that scenes state themselves, as `#= x y r g b` with (0, 0) at the bottom left: worked out by hand, or
//! derived from exact arithmetic. The CPU has to give them all; f64 with bounds alone gives most, and never a wrong
//! one.

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::Limits;
use plumb::frame::DecidedBy;
use plumb::jitter::Sampling;
use plumb::prepare::ViewParameters;

use crate::common;

/// The stated pixels of a scene file.
fn stated(text: &str) -> Vec<[u32; 5]> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("#="));
    lines
        .map(|line| {
            let numbers: Vec<u32> = line
                .split_whitespace()
                .map(|n| n.parse().unwrap())
                .collect();
            numbers.try_into().unwrap()
        })
        .collect()
}

#[test]
fn stated_pixels_are_rendered() {
    let (mut sure, mut all) = (0, 0);
    for path in common::good_scenes() {
        let stated = stated(&std::fs::read_to_string(&path).unwrap());
        if stated.is_empty() {
            continue;
        }
        let name = path.file_name().unwrap().display().to_string();
        let scene = common::read(&path);
        let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
        for [x, y, r, g, b] in stated {
            let want = [r, g, b].map(|byte| u8::try_from(byte).unwrap());
            all += 1;
            let decided = exact_tracer
                .trace(&Limits::default(), Sampling::Once, x, y)
                .unwrap();
            assert_eq!(decided.bytes, want, "{name}: pixel ({x}, {y})");
            assert_ne!(decided.by, DecidedBy::Presumed, "{name}: pixel ({x}, {y})");
            sure += usize::from(decided.by == DecidedBy::Bounded);
        }
    }
    println!("{all} stated pixels, f64 is sure of {sure}");
    // Bounds that are never sure would pass everything above.
    assert!(
        sure * 4 > all,
        "f64 is sure of only {sure} of {all} stated pixels"
    );
}

#[test]
fn a_wrong_statement_is_noticed() {
    let path = common::scenes().join("known/sphere_5_12_13.txt");
    let scene = common::read(&path);
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let [x, y, r, g, b] = stated(&std::fs::read_to_string(&path).unwrap())[0];
    let decided = exact_tracer
        .trace(&Limits::default(), Sampling::Once, x, y)
        .unwrap();
    assert_ne!(decided.bytes, [(r ^ 1) as u8, g as u8, b as u8]);
}

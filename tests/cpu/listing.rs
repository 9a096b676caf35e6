//! The notes' debugging output: their printed sample, digit for digit, and the formats to the letter.

use std::path::Path;

use plumb::cpu::debug::{Shown, list_pixels};
use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::Limits;
use plumb::prepare::Prepared;
use plumb::scene::{self, Scene};

/// As the notes print it: with the blanks of the formats squeezed, and without the word `HIT:`.
const SAMPLE: &str = "\
PIX 21 16 - leftwall ( 1.3, 1.4, -4.0)
PIX 22 16 - leftwall ( 1.5, 1.3, -4.4)
PIX 23 16 - leftwall ( 1.6, 1.2, -4.8)
PIX 24 16 - leftwall ( 1.8, 1.0, -5.3)
PIX 25 16 - leftwall ( 2.0, 0.8, -5.9)
PIX 26 16 - leftwall ( 2.2, 0.6, -6.5)
PIX 27 16 - leftwall ( 2.4, 0.4, -7.2)
PIX 28 16 - leftwall ( 2.7, 0.2, -8.0)
PIX 29 16 - floor ( 3.0, 0.0, -8.5)
PIX 30 16 - floor ( 3.4, 0.0, -8.5)
PIX 31 16 - floor ( 3.8, 0.0, -8.5)
PIX 32 16 - floor ( 4.2, 0.0, -8.5)
PIX 33 16 - floor ( 4.6, 0.0, -8.5)
PIX 34 16 - floor ( 5.0, 0.0, -8.5)
PIX 35 16 - rightwall ( 5.3, 0.2, -8.0)
PIX 36 16 - rightwall ( 5.6, 0.4, -7.2)
PIX 37 16 - rightwall ( 5.8, 0.6, -6.5)
PIX 38 16 - rightwall ( 6.0, 0.8, -5.9)
PIX 39 16 - rightwall ( 6.2, 1.0, -5.3)
PIX 40 16 - rightwall ( 6.4, 1.2, -4.8)
";

/// The same as the notes' formats `\nPIX %4d %4d - ` and `%-12s HIT:(%5.1f, %5.1f, %5.1f)` print it.
const SAMPLE_TO_THE_LETTER: &str = "
PIX   21   16 - leftwall     HIT:(  1.3,   1.4,  -4.0)
PIX   22   16 - leftwall     HIT:(  1.5,   1.3,  -4.4)
PIX   23   16 - leftwall     HIT:(  1.6,   1.2,  -4.8)
PIX   24   16 - leftwall     HIT:(  1.8,   1.0,  -5.3)
PIX   25   16 - leftwall     HIT:(  2.0,   0.8,  -5.9)
PIX   26   16 - leftwall     HIT:(  2.2,   0.6,  -6.5)
PIX   27   16 - leftwall     HIT:(  2.4,   0.4,  -7.2)
PIX   28   16 - leftwall     HIT:(  2.7,   0.2,  -8.0)
PIX   29   16 - floor        HIT:(  3.0,   0.0,  -8.5)
PIX   30   16 - floor        HIT:(  3.4,   0.0,  -8.5)
PIX   31   16 - floor        HIT:(  3.8,   0.0,  -8.5)
PIX   32   16 - floor        HIT:(  4.2,   0.0,  -8.5)
PIX   33   16 - floor        HIT:(  4.6,   0.0,  -8.5)
PIX   34   16 - floor        HIT:(  5.0,   0.0,  -8.5)
PIX   35   16 - rightwall    HIT:(  5.3,   0.2,  -8.0)
PIX   36   16 - rightwall    HIT:(  5.6,   0.4,  -7.2)
PIX   37   16 - rightwall    HIT:(  5.8,   0.6,  -6.5)
PIX   38   16 - rightwall    HIT:(  6.0,   0.8,  -5.9)
PIX   39   16 - rightwall    HIT:(  6.2,   1.0,  -5.3)
PIX   40   16 - rightwall    HIT:(  6.4,   1.2,  -4.8)";

const ALL: Shown = Shown {
    pix: true,
    hit: true,
    drgb: true,
    irgb: true,
    offset: true,
};
const NONE: Shown = Shown {
    pix: false,
    hit: false,
    drgb: false,
    irgb: false,
    offset: false,
};

fn parse(text: &str) -> Scene {
    scene::parse("test", text.as_bytes(), Path::new("")).unwrap()
}

fn listing(scene: &Scene, rows: std::ops::Range<u32>, shown: Shown) -> String {
    let mut listed = Vec::new();
    list_pixels(
        scene,
        &Prepared::new(scene, 0.0),
        &ExactTracer::new(scene, 0.0.into()),
        &Limits::default(),
        rows,
        shown,
        &mut listed,
    )
    .unwrap();
    String::from_utf8(listed).unwrap()
}

fn debug_scene() -> Scene {
    scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/notes/debug.txt")).unwrap()
}

#[test]
fn the_notes_sample_is_reproduced_digit_for_digit() {
    let listed = listing(
        &debug_scene(),
        16..17,
        Shown {
            pix: true,
            hit: true,
            ..NONE
        },
    );
    // The listing begins with a line end, so its first line is empty, and column 21 is the 22nd after it.
    let lines: Vec<&str> = listed.split('\n').skip(1).collect();
    assert_eq!(lines.len(), 64);
    let sample = &lines[21..=40];
    assert_eq!(format!("\n{}", sample.join("\n")), SAMPLE_TO_THE_LETTER);
    let squeezed: String = sample
        .iter()
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            words.join(" ").replace("HIT:", "") + "\n"
        })
        .collect();
    assert_eq!(squeezed, SAMPLE);
}

/// A wall at z = 0 seen head on from (1, 1, 2), 3 × 3 pixels over 2 × 2: the middle pixel is 2 away.
const WALL: &str = "
    camera c { pixeldim 3 3 worlddim 2 2 viewpoint 1 1 2 }
    material m { ambient 1 0.5 4 }
    plane wall { material m normal 0 0 1 point 7 7 0 }";

#[test]
fn every_part_has_the_notes_format() {
    let scene = parse(WALL);
    let middle = |shown| {
        let listed = listing(&scene, 1..2, Shown { pix: true, ..shown });
        let line = listed.split('\n').nth(2).unwrap().to_owned();
        line.strip_prefix("PIX    1    1 - ").unwrap().to_owned()
    };
    assert_eq!(middle(NONE), "");
    assert_eq!(
        middle(Shown { hit: true, ..NONE }),
        "wall         HIT:(  1.0,   1.0,   0.0)"
    );
    assert_eq!(
        middle(Shown { drgb: true, ..NONE }),
        "wall         DRGB:( 0.50,  0.25,  2.00)"
    );
    // 127.5 is cut, not rounded, and 510 is held at 255, as in the picture.
    assert_eq!(
        middle(Shown { irgb: true, ..NONE }),
        " IRGB:(  127,    63,   255)"
    );
    assert_eq!(
        middle(Shown {
            offset: true,
            ..NONE
        }),
        "OFF:       4"
    );
    assert_eq!(
        middle(ALL),
        "wall         HIT:(  1.0,   1.0,   0.0)wall         DRGB:( 0.50,  0.25,  2.00) IRGB:(  127,    63,   255)OFF:       4"
    );
}

#[test]
fn only_pix_begins_a_line() {
    let listed = listing(
        &parse(WALL),
        0..3,
        Shown {
            offset: true,
            ..NONE
        },
    );
    let offsets = [6, 7, 8, 3, 4, 5, 0, 1, 2];
    assert_eq!(
        listed,
        offsets.map(|offset| format!("OFF: {offset:7}")).concat()
    );
}

#[test]
fn the_bottom_row_comes_first_and_offsets_count_from_the_top() {
    let listed = listing(
        &parse(WALL),
        1..3,
        Shown {
            pix: true,
            offset: true,
            ..NONE
        },
    );
    let expected = "
PIX    0    1 - OFF:       3
PIX    1    1 - OFF:       4
PIX    2    1 - OFF:       5
PIX    0    2 - OFF:       0
PIX    1    2 - OFF:       1
PIX    2    2 - OFF:       2";
    assert_eq!(listed, expected);
}

#[test]
fn a_pixel_without_a_hit_lists_pix_only() {
    let scene = parse(
        "camera c { pixeldim 2 1 worlddim 2 2 viewpoint 1 1 2 }
         material m { ambient 1 1 1 }
         sphere a_name_longer_than_twelve { material m center 0 1 -1 radius 0.5 }",
    );
    let listed = listing(&scene, 0..1, ALL);
    let lines: Vec<&str> = listed.split('\n').collect();
    assert_eq!(lines.len(), 3);
    assert!(
        lines[1].starts_with("PIX    0    0 - a_name_longer_than_twelve HIT:("),
        "{}",
        lines[1]
    );
    assert_eq!(lines[2], "PIX    1    0 - ");
}

#[test]
fn there_is_no_minus_zero() {
    // The floor is seen from below and from afar: y of the hit is 0 by the plane, x runs from just below 0.
    let scene = parse(
        "camera c { pixeldim 41 9 worlddim 0.2 1 viewpoint 0.1 -1 2 }
         material m { ambient 1 1 1 }
         plane floor { material m normal 0 1 0 point 0 0 0 }
         plane tilted { material m normal 1e-3 0.5 1 point 0 0 -0.01 }",
    );
    let listed = listing(&scene, 0..9, ALL);
    assert!(listed.contains("HIT:("));
    for zero in ["-0.0,", "-0.0)", "-0.00"] {
        assert!(!listed.contains(zero), "{listed}");
    }
}

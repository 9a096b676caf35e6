//! Kinds of extreme scenes, each made from a number: the same scene everywhere.

use std::fmt::Write as _;

use super::chance::Random;
use super::lamps::{lanterns, spots, stuff};

/// What is tried of a kind.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) text: String,
    pub(super) samples: u32,
    pub(super) course: bool,
    pub(super) max_path: f64,
}

/// The kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SurfaceKind {
    /// An ordinary scene, all lengths times one power of ten.
    Scaled,
    /// A scene of one size, with some numbers of any other.
    Mixed,
    /// Mirrors and panes behind each other, with gaps of any width.
    Chain,
    /// Several samples as the course spread them, over fine patterns.
    Course,
    /// Spotlights of angles next to 0, 90 and 180 degrees.
    Spots,
    /// Materials and lights whose products leave all ranges.
    Stuff,
    /// Projectors whose pictures are of any size, at any place.
    Lanterns,
}

pub(super) const KINDS: [SurfaceKind; 7] = [
    SurfaceKind::Scaled,
    SurfaceKind::Mixed,
    SurfaceKind::Chain,
    SurfaceKind::Course,
    SurfaceKind::Spots,
    SurfaceKind::Stuff,
    SurfaceKind::Lanterns,
];

/// Exponents of ten around which something gives way: f64's end, that of its squares, that of its subnormals, and
/// f32's.
pub(super) const EXPONENTS: [i32; 24] = [
    -323, -320, -310, -307, -300, -200, -163, -161, -155, -150, -100, -60, -45, -38, -30, -20, -12,
    12, 20, 38, 60, 150, 154, 300,
];

/// How numbers of a scene are written.
struct Numbers {
    /// All lengths are of this power of ten.
    size: i32,
    /// Once in so many times, one of another.
    odd: u64,
}

impl Numbers {
    fn length(&self, random: &mut Random, low: i32, high: i32) -> String {
        let number = random.place(low, high);
        if self.odd > 0 && random.once_in(self.odd) {
            return any_size(random, number);
        }
        scaled(number, self.size)
    }

    fn point(&self, random: &mut Random) -> String {
        let [x, y, z] =
            [(-2, 10), (-2, 8), (-10, -1)].map(|(low, high)| self.length(random, low, high));
        format!("{x} {y} {z}")
    }

    fn positive(&self, random: &mut Random, low: i32, high: i32) -> String {
        let text = self.length(random, low, high);
        let text = text.trim_start_matches('-');
        // What is too small to be told from 0 is one of the smallest.
        let value: f64 = text.parse().unwrap();
        if value > 0.0 {
            text.to_owned()
        } else {
            "5e-324".to_owned()
        }
    }

    fn normal(&self, random: &mut Random) -> String {
        let axes = [
            "0 1 0",
            "0 -1 0",
            "1 0 0",
            "-1 0 0",
            "0 0 1",
            "1 0 1",
            "1 2 2",
            "0 3 4",
            "-0.3 0.1 0.7",
        ];
        if self.odd > 0 && random.once_in(self.odd) {
            let [a, b] = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            return format!(
                "{} {} {}",
                any_size(random, a),
                any_size(random, b),
                scaled(1.0, random.one(&EXPONENTS))
            );
        }
        random.one(&axes).to_owned()
    }
}

/// The number times a power of ten, as text: f64 need not have it.
pub(super) fn scaled(number: f64, exponent: i32) -> String {
    let text = format!("{number:e}");
    match text.split_once('e') {
        Some((digits, own)) if number != 0.0 => {
            format!("{digits}e{}", own.parse::<i32>().unwrap() + exponent)
        }
        _ => "0".to_owned(),
    }
}

/// A number of some size, or 0.
pub(super) fn any_size(random: &mut Random, number: f64) -> String {
    if random.once_in(8) {
        return "0".to_owned();
    }
    scaled(number, random.one(&EXPONENTS))
}

/// The scene of a kind and number.
pub(super) fn case(kind: SurfaceKind, number: u64) -> Case {
    let mut random = Random::new(number * 64 + kind as u64);
    let random = &mut random;
    let mut case = Case {
        text: String::new(),
        samples: 1,
        course: false,
        max_path: 20.0,
    };
    match kind {
        SurfaceKind::Scaled => {
            let size = random.one(&EXPONENTS).clamp(-300, 290);
            case.text = things(random, &Numbers { size, odd: 0 }, size);
            case.max_path = 20.0 * 10_f64.powi(size);
        }
        SurfaceKind::Mixed => {
            let size = random.one(&[0, 0, 0, -60, 60, -155, -300, 150]);
            let odd = random.one(&[3, 6, 12, 25]);
            case.text = things(random, &Numbers { size, odd }, size);
            case.max_path = 20.0 * 10_f64.powi(size);
        }
        SurfaceKind::Chain => chain(random, &mut case),
        SurfaceKind::Course => {
            case.samples = random.one(&[2, 3]);
            case.course = true;
            case.text = fine(random);
        }
        SurfaceKind::Spots => case.text = spots(random),
        SurfaceKind::Lanterns => case.text = lanterns(random),
        SurfaceKind::Stuff => {
            case.text = stuff(random);
            case.max_path = random.one(&[20.0, 40.0]);
        }
    }
    case
}

/// A camera that looks at things of that size.
pub(super) fn camera(random: &mut Random, size: i32) -> String {
    let eye = random.one(&[
        "4e 3e 4e",
        "4e 3e 1e",
        "1e 2e 5e",
        "0e 0e 3e",
        "3.7e 2.9e 7.3e",
    ]);
    let pixels = random.one(&["5 4", "7 5", "4 4", "6 1"]);
    let text = format!("camera c {{ pixeldim {pixels} worlddim 8e 6e viewpoint {eye} }}\n");
    text.replace("e ", &format!("e{size} "))
}

/// Some objects and perhaps lights.
fn things(random: &mut Random, numbers: &Numbers, size: i32) -> String {
    let mut text = camera(random, size);
    for name in ["a", "b", "m", "k"] {
        let colour = |random: &mut Random| {
            let c = [0; 3].map(|_| scaled(random.one(&[0.0, 0.5, 1.0, 3.0, 9.0]), size));
            c.join(" ")
        };
        let (ambient, diffuse) = (colour(random), colour(random));
        let more = match name {
            "m" => "specular 0.5 shininess 4",
            "k" => "transparency 0.5",
            _ => "",
        };
        writeln!(
            text,
            "material {name} {{ ambient {ambient} diffuse {diffuse} {more} }}"
        )
        .unwrap();
    }
    for _ in 0..1 + random.below(4) {
        let material = random.one(&["a", "b", "a", "b", "m", "k"]);
        let (point, normal) = (numbers.point(random), numbers.normal(random));
        match random.below(8) {
            0..3 => {
                let radius = numbers.positive(random, 1, 4);
                writeln!(text, "sphere s {{ material {material} center {point} radius {radius} }}")
            }
            3..5 => writeln!(text, "plane p {{ material {material} normal {normal} point {point} }}"),
            5 => {
                let [d, e] = [0; 2].map(|_| numbers.positive(random, 1, 3));
                writeln!(
                    text,
                    "tiled_plane t {{ material {material} altmaterial b normal {normal} point {point} dimension {d} {e} }}"
                )
            }
            6 => {
                let [d, e] = [0; 2].map(|_| numbers.positive(random, 1, 8));
                let (normal, xdir) = random.one(&[("0 0 1", "1 0 0"), ("1 0 1", "0 1 0"), ("0 1 0", "1 0 0.5")]);
                writeln!(
                    text,
                    "fplane f {{ material {material} normal {normal} point {point} xdir {xdir} dimensions {d} {e} }}"
                )
            }
            _ => writeln!(text, "pplane q {{ material {material} normal {normal} point {point} shader {} }}", random.below(3)),
        }
        .unwrap();
    }
    for _ in 0..random.one(&[0_u64, 0, 1, 2]) {
        let location = numbers.point(random);
        let bright = scaled(random.one(&[1.0, 3.0]), 0);
        writeln!(
            text,
            "light l {{ location {location} emissivity {bright} {bright} 1 }}"
        )
        .unwrap();
    }
    text
}

/// Mirrors and panes one behind another.
fn chain(random: &mut Random, case: &mut Case) {
    let gap = random.one(&[1.0, 2.5, 0.25, 1e-3, 1e-9, 1e-20, 1e-100, 1e-300]);
    let specular = random.one(&["0", "0.5", "1e-3", "1e-20", "1e-200", "0.5 1e-30 1", "1e12"]);
    // Of thousands of bounces each has its price in exact numbers, where something behind them all is tied.
    let (transparency, axis) = if gap < 0.1 {
        let transparency = random.one(&["0", "0.5", "1e-3", "1e-30"]);
        (transparency, random.one(&["0 0 1", "0 1 0"]))
    } else {
        let transparency = random.one(&["0", "0.5", "1e-3", "1e-30", "1e-300", "1"]);
        (transparency, random.one(&["0 0 1", "0 1 0", "1 0 0.25"]))
    };
    let mut text = camera(random, 0);
    writeln!(
        text,
        "material m {{ ambient 1 0.5 2 diffuse 2 1 0.5 specular {specular} transparency {transparency} }}
         material wall {{ ambient 2 1 9 diffuse 1e3 4 1 }}"
    )
    .unwrap();
    let count = 2 + random.below(4);
    for i in 0..count {
        let at = -1.0 - gap * i as f64;
        let at = if axis == "0 1 0" {
            format!("0 {at:?} 0")
        } else {
            format!("0 0 {at:?}")
        };
        let turned = if i % 2 == 1 && random.once_in(2) {
            "-"
        } else {
            ""
        };
        let axis = if turned == "-" {
            axis.replace('1', "-1").replace("0.25", "-0.25")
        } else {
            axis.to_owned()
        };
        writeln!(text, "plane p {{ material m normal {axis} point {at} }}").unwrap();
    }
    text += "plane w { material wall normal 0.1 0.2 1 point 0 0 -9 }\n";
    let bright = random.one(&["3", "1e12", "1e-12", "1e200"]);
    writeln!(
        text,
        "light l {{ location 3 4 {} emissivity {bright} {bright} 2 }}",
        random.one(&["1", "-1.5", "-7"])
    )
    .unwrap();
    case.text = text;
    case.max_path = random.one(&[20.0, 12.0, 60.0]);
}

/// Patterns finer than a sample's place is known.
fn fine(random: &mut Random) -> String {
    let size = random.one(&["1e-13", "3e-14", "2e-15", "1e-16", "1e-3", "0.3"]);
    let mut text = camera(random, 0);
    let normal = random.one(&["0 0 1", "0 1 0", "1 0 2", "1 1 1"]);
    let depth = random.one(&["-4", "-0.75", "-1e3", "-1e6"]);
    writeln!(
        text,
        "material a {{ ambient 9e2 0 7 }} material b {{ ambient 0 9e2 7 }}
         tiled_plane t {{ material a altmaterial b normal {normal} point 0.5 -0.5 {depth} dimension {size} {size} {} }}
         sphere s {{ material b center {} {} -3 radius {} }}",
        random.one(&["", "xdir 1 0.5 0.25"]),
        random.place(0, 8),
        random.place(0, 6),
        random.one(&["0.5", "1e-6", "1"])
    )
    .unwrap();
    if random.once_in(3) {
        text += "light l { location 2 5 1 emissivity 2 2 2 }\n";
    }
    text
}

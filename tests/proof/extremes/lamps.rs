//! Kinds of scenes whose lights and materials are extreme.

use std::fmt::Write as _;

use super::chance::Random;
use super::kinds::{EXPONENTS, any_size, camera, scaled};

/// Spotlights that light hardly anything, or hardly anything not.
pub(super) fn spots(random: &mut Random) -> String {
    let mut text = camera(random, 0);
    text += "material a { ambient 1 1 1 diffuse 4 5 6 }\n";
    let normal = random.one(&["0 0 1", "0 1 1", "1 0 2"]);
    writeln!(
        text,
        "plane p {{ material a normal {normal} point 0 -1 -4 }}"
    )
    .unwrap();
    if random.once_in(2) {
        writeln!(
            text,
            "sphere s {{ material a center 4 3 -3 radius {} }}",
            random.one(&["1", "0.5"])
        )
        .unwrap();
    }
    for _ in 0..1 + random.below(2) {
        let theta = match random.below(5) {
            0 => format!("{:?}", random.one(&[1e-3, 0.046875, 0.75, 1e-8, 3e-17])),
            1 => scaled(random.between(1.0, 9.0), random.one(&EXPONENTS).min(-12)),
            2 => format!("{:?}", 180.0 - random.one(&[1e-3, 1e-8, 1e-12, 3e-14, 0.0])),
            3 => format!(
                "{:?}",
                90.0 + random.one(&[1e-8, -1e-8, 1.5e-14, -1.5e-14, 0.0])
            ),
            _ => format!("{:?}", random.between(1e-9, 180.0)),
        };
        let at = random.one(&["4 3 0", "4 3 4", "4 3 9", "2 3 1", "4 1.5 2"]);
        let to = random.one(&["4 3 -4", "4 3 -1", "2 1 -3", "4 3 20", "6 4.5 -4"]);
        writeln!(
            text,
            "spotlight l {{ location {at} emissivity 9 8 7 point {to} theta {theta} }}"
        )
        .unwrap();
    }
    text
}

/// Projectors whose pictures are as small or large, as near or far, as numbers are.
pub(super) fn lanterns(random: &mut Random) -> String {
    let mut text = camera(random, 0);
    text += "texture t { filename textures/texels.ppm }
             material a { ambient 1 1 1 diffuse 4 5 6 specular 0.5 shininess 3 }\n";
    let wall = random.one(&["0 0 1", "0 1 1", "1 0 2"]);
    writeln!(text, "plane p {{ material a normal {wall} point 0 -1 -4 }}").unwrap();
    if random.once_in(2) {
        text += "sphere s { material a center 4 3 -3 radius 1 }\n";
    }
    for _ in 0..1 + random.below(2) {
        let mut point = |middle: [f64; 3], odd: u64| {
            let c = middle.map(|near| {
                let number = near + random.one(&[0.0, 0.0, 0.5, -0.25]);
                match random.below(odd) {
                    0 => any_size(random, number),
                    // Next to the middle, by far less than f64 tells beside it.
                    1 => format!("{:?}", number + random.one(&[1e-9, -1e-15, 1e-300])),
                    _ => format!("{number:?}"),
                }
            });
            c.join(" ")
        };
        let (location, corner) = (point([4.0, 3.0, 2.0], 12), point([3.0, 2.0, 1.0], 5));
        let (normal, xdir) = random.one(&[
            ("0 0 1", "1 0 0"),
            ("0 0 -1e-200", "1 1e-9 0"),
            ("0 1 1", "1 0 0"),
            ("1e300 2e300 3e300", "1 0 1e-30"),
            ("1 0 1e-12", "0 3e-320 0"),
        ]);
        let mut side = || match random.below(3) {
            0 => scaled(random.between(1.0, 9.0), random.one(&EXPONENTS)),
            _ => format!("{:?}", random.one(&[0.5, 2.0, 4.0, 30.0])),
        };
        let dimensions = [side(), side()].join(" ");
        let mode = random.below(2);
        writeln!(
            text,
            "projector l {{ location {location} emissivity 9 8 7 normal {normal} point {corner} xdir {xdir} \
             dimensions {dimensions} texname t mode {mode} }}"
        )
        .unwrap();
    }
    text
}

/// Materials of any size.
pub(super) fn stuff(random: &mut Random) -> String {
    let mut text = camera(random, 0);
    for name in ["a", "b", "c"] {
        let colour = |random: &mut Random| {
            let c = [0; 3].map(|_| {
                let number = random.between(0.1, 9.0);
                if random.once_in(2) {
                    any_size(random, number)
                } else {
                    format!("{number:?}")
                }
            });
            c.join(" ")
        };
        let share = match random.below(4) {
            0 => "0.5".to_owned(),
            1 => scaled(random.between(1.0, 9.0), random.one(&EXPONENTS).min(-12)),
            _ => "0".to_owned(),
        };
        let specular = if random.once_in(2) {
            colour(random)
        } else {
            "0".to_owned()
        };
        let (ambient, diffuse) = (colour(random), colour(random));
        let shininess = random.one(&[
            "0", "1", "30", "0.3", "1e-9", "1e-300", "1e3", "1e19", "1e300",
        ]);
        writeln!(
            text,
            "material {name} {{ ambient {ambient} diffuse {diffuse} specular {specular} shininess {shininess} transparency {share} }}"
        )
        .unwrap();
    }
    text += "plane w { material a normal 0 0 1 point 0 0 -6 }\nplane f { material b normal 0 1 0 point 0 -1 0 }\n";
    let radius = random.one(&["1", "1.5"]);
    writeln!(
        text,
        "sphere s {{ material c center 4 2 -3 radius {radius} }}"
    )
    .unwrap();
    let number = random.between(0.1, 9.0);
    let bright = any_size(random, number);
    writeln!(
        text,
        "light l {{ location 2 5 -1 emissivity {bright} 3 1 }}"
    )
    .unwrap();
    if random.once_in(2) {
        let bright = any_size(random, 1.0);
        writeln!(text, "light l {{ location 5 1 2 emissivity 1 {bright} 3 }}").unwrap();
    }
    text
}

//! Scenes made so that rounding must fail: things touch, graze and coincide exactly, or miss that by a hair.
//!
//! Coordinates come from few round numbers, so that they meet by themselves; `motifs` place the rest.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use super::motifs::objects;

/// A scene in parts, each a few entities as text, so that a failing one shrinks part by part.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    camera: String,
    materials: Vec<String>,
    objects: Vec<String>,
    lamps: Vec<String>,
    /// τ.
    pub(crate) tolerance: f64,
    pub(crate) max_path: f64,
    pub(crate) samples: u32,
    pub(crate) course: bool,
}

impl Plan {
    /// The scene as text.
    pub(crate) fn text(&self) -> String {
        let textures = "texture texels { filename textures/texels.ppm }\n\
                        texture window { filename textures/window.ppm }\n";
        format!(
            "# screen tolerance {:?}, max path {:?}, samples {}, course {}\n{}{}{textures}{}{}",
            self.tolerance,
            self.max_path,
            self.samples,
            self.course,
            self.camera,
            self.materials.concat(),
            self.objects.concat(),
            self.lamps.concat()
        )
    }
}

/// Materials of every scene.
const MATERIALS: [&str; 7] = ["m0", "m1", "m2", "m3", "m4", "mirror", "pane"];

/// A scene and how to look at it.
pub(crate) fn plan() -> impl Strategy<Value = Plan> {
    let looks = (
        prop_oneof![6 => Just(0.0), 1 => Just(0.01), 1 => Just(-2.0), 1 => Just(0.5)],
        prop_oneof![5 => Just(20.0), 1 => Just(10.0), 1 => Just(7.5), 1 => Just(40.0)],
        prop_oneof![6 => Just(1_u32), 1 => Just(2), 1 => Just(3)],
        any::<bool>(),
    );
    (
        camera(),
        materials(),
        vec(objects(), 1..6),
        prop_oneof![1 => vec(lamp(), 0..1), 3 => vec(lamp(), 1..4)],
        looks,
    )
        .prop_map(|(camera, materials, objects, lamps, looks)| Plan {
            camera,
            materials,
            objects,
            lamps,
            tolerance: looks.0,
            max_path: looks.1,
            samples: looks.2,
            course: looks.3,
        })
}

fn camera() -> impl Strategy<Value = String> {
    (
        select(vec!["9 7", "17 13", "25 19", "24 18", "13 9"]),
        select(vec![
            "4 3 6", "4 3 4", "4 3 3", "4 0 6", "1 2 5", "4 3 12", "-2 3 2.5",
        ]),
    )
        .prop_map(|(size, eye)| {
            format!("camera eye {{ pixeldim {size} worlddim 8 6 viewpoint {eye} }}\n")
        })
}

fn materials() -> impl Strategy<Value = Vec<String>> {
    let ambient = || select(vec!["0", "1", "2", "3", "6", "0.5", "9"]);
    let diffuse = || select(vec!["0", "1", "5", "9", "2.5"]);
    let one = (
        [ambient(), ambient(), ambient()],
        [diffuse(), diffuse(), diffuse()],
        prop_oneof![7 => Just("0"), 1 => Just("0.5"), 1 => Just("1"), 1 => Just("0.9 0.5 0.25")],
        select(vec!["0", "1", "2", "5", "30", "0.5", "7.25", "0.1"]),
        prop_oneof![7 => Just("0"), 1 => Just("0.5"), 1 => Just("0.25"), 1 => Just("1")],
    )
        .prop_map(|(a, d, specular, shininess, transparency)| {
            format!(
                "{{ ambient {} diffuse {} specular {specular} shininess {shininess} transparency {transparency} }}\n",
                a.join(" "),
                d.join(" ")
            )
        });
    vec(one, 5).prop_map(|bodies| {
        let mut all: Vec<String> = bodies
            .iter()
            .zip(MATERIALS)
            .map(|(body, name)| format!("material {name} {body}"))
            .collect();
        all.push(String::from(
            "material mirror { ambient 0.5 0.5 0.5 diffuse 1 1 1 specular 0.75 shininess 4 }\n",
        ));
        all.push(String::from(
            "material pane { ambient 0.5 0 0.25 diffuse 3 6 4 transparency 0.75 }\n",
        ));
        all
    })
}

/// The name of a material.
pub(super) fn material() -> impl Strategy<Value = &'static str> {
    select(&MATERIALS[..])
}

/// A number moved by nothing, mostly, or by a hair.
pub(super) fn nearly(number: f64, hair: u8) -> f64 {
    match hair {
        // The f64 next to 0 is another matter: scenes/hard has it.
        0 | 1 if number == 0.0 => 2_f64.powi(-55),
        0 => number.next_up(),
        1 => number.next_down(),
        2 => number + 2_f64.powi(-25),
        3 => number - 2_f64.powi(-25),
        4 => number + 2_f64.powi(-51),
        _ => number,
    }
}

/// A hair or, mostly, none.
pub(super) fn hair() -> impl Strategy<Value = u8> {
    0_u8..40
}

/// A coordinate: half a whole number, mostly.
pub(super) fn place(low: i32, high: i32) -> BoxedStrategy<f64> {
    prop_oneof![
        10 => (2 * low..=2 * high, hair()).prop_map(|(n, hair)| nearly(f64::from(n) / 2.0, hair)),
        10 => (low..=high).prop_map(f64::from),
        1 => (10 * low..=10 * high).prop_map(|n| f64::from(n) / 10.0),
        2 => f64::from(low)..f64::from(high),
    ]
    .boxed()
}

/// A point or a direction.
pub(super) type Point = [f64; 3];

pub(super) fn show(p: Point) -> String {
    format!("{:?} {:?} {:?}", p[0], p[1], p[2])
}

pub(super) fn point() -> impl Strategy<Value = Point> {
    [place(-2, 10), place(-3, 7), place(-12, 1)]
}

pub(super) fn normal() -> impl Strategy<Value = Point> {
    prop_oneof![
        6 => select(vec![
            [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0],
            [0.0, 0.0, 3.0], [0.0, 0.1, 0.0], [0.0, 0.0, -1.0],
        ]),
        4 => select(vec![
            [3.0, 0.0, 1.0], [-3.0, 0.0, 1.0], [0.0, 3.0, 4.0], [1.0, 2.0, 2.0], [1.0, 1.0, 1.0],
            [0.1, 0.2, 0.3], [0.0, 1.0, 1e-3], [-2.0, 1.0, 5.0],
        ]),
        1 => [-1.0..1.0, -1.0..1.0, 0.1..1.0],
    ]
}

pub(super) fn radius() -> impl Strategy<Value = f64> {
    (select(vec![0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 0.1]), hair()).prop_map(|(r, h)| nearly(r, h))
}

pub(super) fn plane(kind: &str, material: &str, normal: Point, point: Point, more: &str) -> String {
    let (normal, point) = (show(normal), show(point));
    format!("{kind} o {{ material {material} normal {normal} point {point} {more} }}\n")
}

pub(super) fn ball(kind: &str, material: &str, center: Point, radius: f64, more: &str) -> String {
    let center = show(center);
    format!("{kind} o {{ material {material} center {center} radius {radius:?} {more} }}\n")
}

pub(super) fn light(location: Point) -> String {
    let location = show(location);
    format!("light l {{ location {location} emissivity 6 9 5 }}\n")
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn moved(p: Point, by: Point, times: f64) -> Point {
    [0, 1, 2].map(|i| p[i] + times * by[i])
}

/// A light or a spotlight, often at angles whose cosines are roots.
fn lamp() -> BoxedStrategy<String> {
    let bright = || select(vec!["0", "3", "9", "5.5"]);
    let theta = select(vec![
        "30", "45", "60", "90", "180", "120", "135", "15", "22.5", "36", "20", "33.3", "1e-3",
    ]);
    let somewhere = || {
        prop_oneof![
            6 => point().boxed(),
            1 => select(vec![[4.0, 3.0, 6.0], [4.0, 3.0, 4.0], [4.0, 3.0, 3.0]]).boxed(),
        ]
    };
    let aims = vec![
        [0.0, 0.0, -1.0],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, -1.0],
        [1.0, 1.0, 0.0],
        [0.0, 3.0, -4.0],
        [1.0, -2.0, -2.0],
    ];
    (somewhere(), [bright(), bright(), bright()], theta, select(aims), any::<bool>())
        .prop_map(|(at, e, theta, aim, spot)| {
            let (location, e) = (show(at), e.join(" "));
            if spot {
                let point = show(moved(at, aim, 2.0));
                format!(
                    "spotlight l {{ location {location} emissivity {e} point {point} theta {theta} }}\n"
                )
            } else {
                format!("light l {{ location {location} emissivity {e} }}\n")
            }
        })
        .boxed()
}

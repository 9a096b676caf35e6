//! Scenes made so that rounding must fail: things touch, graze and coincide exactly, or miss that by a hair.
//!
//! Coordinates come from few round numbers, so that they meet by themselves; motifs place the rest: twins, tangents, lamps
//! in ceilings, paintings on walls, mirrors face to face.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

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

fn material() -> impl Strategy<Value = &'static str> {
    select(&MATERIALS[..])
}

/// A number moved by nothing, mostly, or by a hair.
fn nearly(number: f64, hair: u8) -> f64 {
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
fn hair() -> impl Strategy<Value = u8> {
    0_u8..40
}

/// A coordinate: half a whole number, mostly.
fn place(low: i32, high: i32) -> BoxedStrategy<f64> {
    prop_oneof![
        10 => (2 * low..=2 * high, hair()).prop_map(|(n, hair)| nearly(f64::from(n) / 2.0, hair)),
        10 => (low..=high).prop_map(f64::from),
        1 => (10 * low..=10 * high).prop_map(|n| f64::from(n) / 10.0),
        2 => f64::from(low)..f64::from(high),
    ]
    .boxed()
}

type Point = [f64; 3];

fn show(p: Point) -> String {
    format!("{:?} {:?} {:?}", p[0], p[1], p[2])
}

fn point() -> impl Strategy<Value = Point> {
    [place(-2, 10), place(-3, 7), place(-12, 1)]
}

fn normal() -> impl Strategy<Value = Point> {
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

fn radius() -> impl Strategy<Value = f64> {
    (select(vec![0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 0.1]), hair()).prop_map(|(r, h)| nearly(r, h))
}

fn plane(kind: &str, material: &str, normal: Point, point: Point, more: &str) -> String {
    let (normal, point) = (show(normal), show(point));
    format!("{kind} o {{ material {material} normal {normal} point {point} {more} }}\n")
}

fn ball(kind: &str, material: &str, center: Point, radius: f64, more: &str) -> String {
    let center = show(center);
    format!("{kind} o {{ material {material} center {center} radius {radius:?} {more} }}\n")
}

fn light(location: Point) -> String {
    let location = show(location);
    format!("light l {{ location {location} emissivity 6 9 5 }}\n")
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn moved(p: Point, by: Point, times: f64) -> Point {
    [0, 1, 2].map(|i| p[i] + times * by[i])
}

/// Objects: one, or some placed together.
fn objects() -> BoxedStrategy<String> {
    prop_oneof![
        4 => (material(), normal(), point()).prop_map(|(m, n, p)| plane("plane", m, n, p, "")),
        4 => (material(), point(), radius()).prop_map(|(m, c, r)| ball("sphere", m, c, r, "")),
        2 => shaded(),
        2 => tiles(),
        3 => rectangles(),
        2 => twin_planes(),
        2 => twin_balls(),
        3 => tangents(),
        2 => touching(),
        1 => facing(),
        3 => lamps_on_things(),
    ]
    .boxed()
}

/// Procedural surfaces.
fn shaded() -> BoxedStrategy<String> {
    prop_oneof![
        (material(), normal(), point(), 0..3).prop_map(|(m, n, p, s)| plane(
            "pplane",
            m,
            n,
            p,
            &format!("shader {s}")
        )),
        (material(), point(), radius()).prop_map(|(m, c, r)| ball("psphere", m, c, r, "shader 0")),
    ]
    .boxed()
}

/// Tiles whose edges run through pixels.
fn tiles() -> BoxedStrategy<String> {
    let size = || {
        select(vec![
            "0.5",
            "1",
            "2",
            "3",
            "0.1",
            "0.25",
            "0.3",
            "2.8284271247461903",
        ])
    };
    let xdir = select(vec![
        "",
        "xdir 1 0 0",
        "xdir 1 1 1",
        "xdir 3 4 5",
        "xdir 1 2 0.5",
    ]);
    (
        material(),
        material(),
        normal(),
        point(),
        [size(), size()],
        xdir,
    )
        .prop_filter(
            "xdir must not be parallel to the normal",
            |(_, _, n, .., x)| {
                !(x.contains("1 1 1") && n[0] == n[1] && n[1] == n[2]
                    || x.contains("1 0 0") && n[1] == 0.0 && n[2] == 0.0)
            },
        )
        .prop_map(|(m, alt, n, p, size, xdir)| {
            let more = format!("altmaterial {alt} dimension {} {xdir}", size.join(" "));
            plane("tiled_plane", m, n, p, &more)
        })
        .boxed()
}

/// A rectangle of a wall, floor or slanted plane; a painting on a wall; panes in a row.
fn rectangles() -> BoxedStrategy<String> {
    let size = || select(vec!["1", "2", "4", "1.5", "8", "2.8284271247461903"]);
    let frames = select(vec![
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 2.0], [1.0, 1.0, 0.0]),
        ([0.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
        ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ([3.0, 0.0, 4.0], [0.0, 1.0, 0.0]),
        ([0.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
        ([1.0, 2.0, 2.0], [2.0, 1.0, -2.0]),
        ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
    ]);
    (
        [material(), material()],
        frames,
        point(),
        [size(), size()],
        0..6,
        select(vec!["texels", "window"]),
        0..2,
    )
        .prop_map(|([m, wall], (n, x), p, size, kind, texture, mode)| {
            let extent = format!("xdir {} dimensions {}", show(x), size.join(" "));
            let painting = format!("{extent} texname {texture} mode {mode}");
            let behind = moved(p, n, -1.0);
            match kind {
                0 | 1 => plane("fplane", m, n, p, &extent),
                2 => plane("texplane", m, n, p, &painting),
                // On its wall, before it in the file; after it, it is not seen.
                3 => plane("texplane", m, n, p, &painting) + &plane("plane", wall, n, p, ""),
                4 => plane("plane", wall, n, p, "") + &plane("texplane", m, n, p, &painting),
                _ => {
                    plane("fplane", "pane", n, p, &extent)
                        + &plane("fplane", "pane", n, behind, &extent)
                }
            }
        })
        .boxed()
}

/// One plane twice, by another normal and another point of it, or a hair apart.
fn twin_planes() -> BoxedStrategy<String> {
    (
        [material(), material()],
        normal(),
        point(),
        select(vec![1.0, 2.0, -1.0, 0.5, -4.0]),
        hair(),
    )
        .prop_map(|([m, other], n, p, scale, hair)| {
            let along = cross(n, [1.0, 2.0, -1.0]);
            let mut q = moved(p, along, 1.0);
            q[2] = nearly(q[2], hair);
            plane("plane", m, n, p, "") + &plane("plane", other, n.map(|c| c * scale), q, "")
        })
        .boxed()
}

/// Two balls in one place, or nearly.
fn twin_balls() -> BoxedStrategy<String> {
    (
        [material(), material()],
        point(),
        radius(),
        [hair(), hair()],
        any::<bool>(),
    )
        .prop_map(|([m, other], c, r, hairs, first)| {
            let mut d = c;
            d[0] = nearly(d[0], hairs[0]);
            let twin = ball("sphere", other, d, nearly(r, hairs[1]), "");
            let one = ball("sphere", m, c, r, "");
            if first { one + &twin } else { twin + &one }
        })
        .boxed()
}

/// A ball that rays through a column or a row of pixels touch, or miss by a hair.
fn tangents() -> BoxedStrategy<String> {
    (
        material(),
        place(-6, 6),
        place(-12, -1),
        radius(),
        hair(),
        any::<bool>(),
        any::<bool>(),
    )
        .prop_map(|(m, across, deep, r, hair, upright, negative)| {
            let off = if negative { -r } else { r };
            // Rays of the column (or row) through the viewpoints' (4, 3) lie in a plane; the ball touches it.
            let c = if upright {
                [4.0 + off, across, deep]
            } else {
                [across, 3.0 + off, deep]
            };
            ball("sphere", m, c, nearly(r, hair), "")
        })
        .boxed()
}

/// A ball that lies on a floor, stands at a wall, or touches another.
fn touching() -> BoxedStrategy<String> {
    ([material(), material()], point(), radius(), 0..3, hair())
        .prop_map(|([m, other], c, r, kind, hair)| {
            let near = nearly(r, hair);
            let more = match kind {
                0 => plane("plane", other, [0.0, 1.0, 0.0], [0.0, c[1] - near, 0.0], ""),
                1 => plane("plane", other, [1.0, 0.0, 0.0], [c[0] - near, 0.0, 0.0], ""),
                _ => ball(
                    "sphere",
                    other,
                    [c[0] + 3.0 * near, c[1], c[2] + 4.0 * near],
                    4.0 * r,
                    "",
                ),
            };
            ball("sphere", m, c, r, "") + &more
        })
        .boxed()
}

/// Mirrors face to face.
fn facing() -> BoxedStrategy<String> {
    (
        place(-2, 1),
        place(5, 10),
        any::<bool>(),
        select(vec![0.0, 0.25]),
    )
        .prop_map(|(low, high, sideways, tilt)| {
            let (n, m, p, q) = if sideways {
                (
                    [1.0, 0.0, tilt],
                    [-1.0, 0.0, 0.0],
                    [low, 0.0, 0.0],
                    [high, 0.0, 0.0],
                )
            } else {
                (
                    [0.0, 1.0, tilt],
                    [0.0, -1.0, 0.0],
                    [0.0, low, 0.0],
                    [0.0, high, 0.0],
                )
            };
            plane("plane", "mirror", n, p, "") + &plane("plane", "mirror", m, q, "")
        })
        .boxed()
}

/// A lamp in a ceiling, on a ball, in a ball, at a painting.
fn lamps_on_things() -> BoxedStrategy<String> {
    (material(), normal(), point(), radius(), 0..5)
        .prop_map(|(m, n, p, r, kind)| {
            let along = cross(n, [0.0, 1.0, -3.0]);
            match kind {
                0 => {
                    plane("plane", m, [0.0, -1.0, 0.0], p, "")
                        + &light(moved(p, [1.0, 0.0, -2.0], 1.0))
                }
                1 => plane("plane", m, n, p, "") + &light(moved(p, along, 1.0)),
                2 => ball("sphere", m, p, r, "") + &light(moved(p, [0.0, 1.0, 0.0], r)),
                3 => ball("sphere", m, p, 5.0 * r, "") + &light(moved(p, [0.0, 3.0, 4.0], r)),
                _ => ball("sphere", m, p, r, "") + &light(p),
            }
        })
        .boxed()
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

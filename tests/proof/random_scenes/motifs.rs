//! Objects placed together so that they tie or nearly do: twins, tangents, lamps in ceilings and on balls, paintings on
//! walls, mirrors face to face. `strategy` puts a few of them into a scene.

use proptest::prelude::*;
use proptest::sample::select;

use super::quadrics::quadrics;
use super::strategy::{
    Point, ball, cross, hair, light, material, moved, nearly, normal, place, plane, point, radius,
    show,
};
use super::triangles;

/// Objects: one, or some placed together.
pub(super) fn objects() -> BoxedStrategy<String> {
    prop_oneof![
        4 => (material(), normal(), point()).prop_map(|(m, n, p)| plane("plane", m, n, p, "")),
        4 => (material(), point(), radius()).prop_map(|(m, c, r)| ball("sphere", m, c, r, "")),
        2 => shaded(),
        2 => tiles(),
        3 => rectangles(),
        4 => triangles::objects(),
        2 => twin_planes(),
        2 => twin_balls(),
        3 => tangents(),
        2 => touching(),
        1 => facing(),
        3 => lamps_on_things(),
        4 => room(),
        2 => slanted_mirror(),
        4 => quadrics(),
        2 => lantern(),
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
    (
        [material(), material()],
        frame(),
        point(),
        [side(), side()],
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

/// A rectangle's side.
fn side() -> impl Strategy<Value = &'static str> {
    select(vec!["1", "2", "4", "1.5", "8", "2.8284271247461903"])
}

/// A rectangle's normal and xdir.
fn frame() -> impl Strategy<Value = (Point, Point)> {
    select(vec![
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 2.0], [1.0, 1.0, 0.0]),
        ([0.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
        ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ([3.0, 0.0, 4.0], [0.0, 1.0, 0.0]),
        ([0.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
        ([1.0, 2.0, 2.0], [2.0, 1.0, -2.0]),
        ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
    ])
}

/// A projector before a wall that is as far behind the picture, so that borders of texels meet pixels; before one that
/// the picture lies in; in its own picture's plane, or a hair off it; before nothing of its own.
fn lantern() -> BoxedStrategy<String> {
    (
        material(),
        frame(),
        point(),
        [side(), side()],
        (0..4, hair()),
        select(vec![1.0, 2.0, 4.0, -1.0, 0.0]),
        (select(vec!["texels", "window"]), 0..2),
    )
        .prop_map(|(m, (n, x), p, size, (kind, hair), away, (texture, mode))| {
            let location = moved(moved(p, x, 0.5), n, nearly(away, hair));
            let behind = moved(p, n, -nearly(away, hair));
            let [normal, location, xdir, corner] = [n, location, x, p].map(show);
            let lantern = format!(
                "projector l {{ location {location} emissivity 9 6 7 normal {normal} point {corner} xdir {xdir} \
                 dimensions {} texname {texture} mode {mode} }}\n",
                size.join(" ")
            );
            let wall = match kind {
                0 | 1 => plane("plane", m, n, behind, ""),
                2 => plane("plane", m, n, p, ""),
                _ => String::new(),
            };
            wall + &lantern
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

/// A room with walls at whole numbers and a lamp somewhere in its ceiling.
fn room() -> BoxedStrategy<String> {
    (
        [material(), material(), material()],
        [0_i32..3, 5..8, 4..14, 0..9],
        hair(),
        any::<bool>(),
    )
        .prop_map(
            |([floor, ceiling, back], [low, high, deep, lamp], hair, tiled)| {
                let [low, high, deep, lamp] = [-low, high, -deep, lamp].map(f64::from);
                let kind = if tiled { "tiled_plane" } else { "plane" };
                let tiles = if tiled {
                    "altmaterial m0 dimension 1 2"
                } else {
                    ""
                };
                plane(kind, floor, [0.0, 1.0, 0.0], [0.0, low, 0.0], tiles)
                    + &plane(
                        "plane",
                        ceiling,
                        [0.0, -2.0, 0.0],
                        [1.0, nearly(high, hair), -3.0],
                        "",
                    )
                    + &plane("plane", back, [0.0, 0.0, 1.0], [0.0, 0.0, deep], "")
                    + &light([lamp, high, deep / 2.0])
            },
        )
        .boxed()
}

/// A mirror at half a right angle, which sends rays along the axes, and something in their way.
fn slanted_mirror() -> BoxedStrategy<String> {
    (
        material(),
        place(-10, -2),
        place(1, 9),
        radius(),
        select(vec!["mirror", "m0", "m1"]),
        any::<bool>(),
    )
        .prop_map(|(m, deep, away, r, mirror, up)| {
            let (n, wall, at) = if up {
                (
                    [0.0, 1.0, 1.0],
                    [0.0, -1.0, 0.0],
                    [4.0 + r, 3.0 + away, deep],
                )
            } else {
                (
                    [-1.0, 0.0, 1.0],
                    [1.0, 0.0, 0.0],
                    [4.0 - away, 3.0 + r, deep],
                )
            };
            plane("plane", mirror, n, [4.0, 3.0, deep], "")
                + &ball("sphere", m, at, r, "")
                + &plane(
                    "pplane",
                    "m2",
                    wall,
                    moved([4.0, 3.0, deep], wall, -away - 2.0),
                    "shader 2",
                )
        })
        .boxed()
}

//! Triangles placed so that they tie: alone, with sides in common, on walls and floors, around a point, as a field of
//! many. Beside `motifs`, of which they are a part.

use proptest::prelude::*;
use proptest::sample::select;

use super::strategy::{
    Point, cross, hair, material, moved, nearly, normal, place, plane, point, show,
};

/// One, or some placed together.
pub(super) fn objects() -> BoxedStrategy<String> {
    prop_oneof![
        4 => alone(),
        2 => with_a_side_in_common(),
        2 => on_a_plane(),
        2 => around_a_point(),
        1 => field(),
    ]
    .boxed()
}

fn triangle(kind: &str, material: &str, [a, b, c]: [Point; 3], more: &str) -> String {
    let [a, b, c] = [a, b, c].map(show);
    format!("{kind} o {{ material {material} vertex1 {a} vertex2 {b} vertex3 {c} {more} }}\n")
}

/// Three points that are surely not in a line.
fn corners() -> impl Strategy<Value = [Point; 3]> {
    [point(), point(), point()].prop_filter("they are no triangle", |[a, b, c]| {
        let n = cross(moved(*b, *a, -1.0), moved(*c, *a, -1.0));
        n.iter().any(|n| n.abs() > 1e-6)
    })
}

/// Of any kind, its front to either side.
fn alone() -> BoxedStrategy<String> {
    (material(), corners(), 0..6, any::<bool>())
        .prop_map(|(m, vertices, kind, turned)| {
            let [a, b, c] = vertices;
            let mut n = cross(moved(b, a, -1.0), moved(c, a, -1.0));
            if turned {
                n = n.map(|n| -n);
            }
            match kind {
                0..3 => triangle("ptriangle", m, vertices, &format!("shader {kind}")),
                3 => triangle("triangle", m, vertices, &format!("normal {}", show(n))),
                _ => triangle("triangle", m, vertices, ""),
            }
        })
        .boxed()
}

/// Two with a side in common, in a plane or not, given the same way round or not.
fn with_a_side_in_common() -> BoxedStrategy<String> {
    ([material(), material()], corners(), hair(), 0..3)
        .prop_map(|([m, other], [a, b, c], hair, kind)| {
            let mut d = [0, 1, 2].map(|i| b[i] + c[i] - a[i]);
            d[2] = nearly(d[2], hair);
            let second = match kind {
                0 => [c, b, d],
                1 => [b, d, c],
                _ => [d, b, c],
            };
            triangle("triangle", m, [a, b, c], "") + &triangle("triangle", other, second, "")
        })
        .boxed()
}

/// On a plane, before or after it in the file, or a hair off it.
fn on_a_plane() -> BoxedStrategy<String> {
    (
        [material(), material()],
        normal(),
        point(),
        select(vec![0.5, 1.0, 2.0, 3.0]),
        hair(),
        any::<bool>(),
    )
        .prop_map(|([m, wall], n, p, size, hair, first)| {
            let along = cross(n, [1.0, 2.0, -1.0]);
            let across = cross(n, along);
            let mut c = moved(p, across, size);
            c[2] = nearly(c[2], hair);
            let on = triangle("triangle", m, [p, moved(p, along, size), c], "");
            let plane = plane("plane", wall, n, p, "");
            if first { on + &plane } else { plane + &on }
        })
        .boxed()
}

/// A fan around a point through which a ray may run, flat or as a cone.
fn around_a_point() -> BoxedStrategy<String> {
    (
        [material(), material()],
        place(-1, 9),
        place(-1, 7),
        place(-8, 0),
        select(vec![0.0, 1.0, -2.0]),
        select(vec![1.0, 2.0, 3.0]),
    )
        .prop_map(|(materials, x, y, z, high, size)| {
            let ring: [[f64; 2]; 8] = [
                [1.0, 0.0],
                [1.0, 1.0],
                [0.0, 1.0],
                [-1.0, 1.0],
                [-1.0, 0.0],
                [-1.0, -1.0],
                [0.0, -1.0],
                [1.0, -1.0],
            ];
            let at = |i: usize| {
                let [a, b] = ring[i % 8];
                [x + size * a, y + size * b, z - high]
            };
            let fan = (0..8).map(|i| {
                let vertices = [[x, y, z], at(i), at(i + 1)];
                triangle("triangle", materials[i % 2], vertices, "")
            });
            fan.collect()
        })
        .boxed()
}

/// Two for each square of a field of heights: enough for cells of the screen and a tree.
fn field() -> BoxedStrategy<String> {
    (
        [material(), material()],
        place(-3, 2),
        select(vec![0.5, 1.0, 1.5]),
        proptest::collection::vec(select(vec![0.0, 0.0, 0.5, 1.0]), 42),
    )
        .prop_map(|(materials, low, size, heights)| {
            let at = |i: usize, j: usize| {
                let x = size * i as f64 + 1.0;
                [x, low + heights[7 * j + i], -size * j as f64]
            };
            let squares = (0..5).flat_map(|j| (0..6).map(move |i| (i, j)));
            let pair = |(i, j): (usize, usize)| {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangle("triangle", materials[(i + j) % 2], [a, b, c], "")
                    + &triangle("triangle", materials[i % 2], [a, c, d], "")
            };
            squares.map(pair).collect()
        })
        .boxed()
}

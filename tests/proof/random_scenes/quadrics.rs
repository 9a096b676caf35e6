//! Quadrics of all kinds, cut or whole; spheres, planes and other quadrics in the same place; lamps on them, panes in
//! them.

use proptest::prelude::*;
use proptest::sample::select;

use super::strategy::{
    Point, ball, hair, light, material, moved, nearly, normal, plane, point, radius, show,
};

/// The coefficients of Σ squares[i]·(x[i] − center[i])² + mixed terms without their center = right.
fn around(squares: [f64; 3], mixed: [f64; 3], center: Point, right: f64) -> [f64; 10] {
    let [d, e, f] = mixed;
    let [x, y, z] = center;
    let slope = [
        -2.0 * squares[0] * x - d * y - e * z,
        -2.0 * squares[1] * y - d * x - f * z,
        -2.0 * squares[2] * z - e * x - f * y,
    ];
    let at_center = squares[0] * x * x
        + squares[1] * y * y
        + squares[2] * z * z
        + d * x * y
        + e * x * z
        + f * y * z;
    let [a, b, c] = squares;
    let [g, h, i] = slope;
    [a, b, c, d, e, f, g, h, i, right - at_center]
}

fn quadric(material: &str, coefficients: [f64; 10], more: &str) -> String {
    let numbers = coefficients.map(|c| format!("{c:?}")).join(" ");
    format!("quadric o {{ material {material} coefficients {numbers} {more} }}\n")
}

/// A box around a point that cuts some sides of what is there.
fn cut(center: Point, sides: [f64; 6]) -> String {
    let side = |i: usize| [0, 1, 2].map(|axis| center[axis] + sides[i + axis]);
    format!("lower {} upper {}", show(side(0)), show(side(3)))
}

/// Squares of a shape, and the right side for a size r of it.
fn shapes() -> impl Strategy<Value = ([f64; 3], f64)> {
    select(vec![
        ([1.0, 1.0, 1.0], 1.0),
        ([1.0, 4.0, 0.25], 1.0),
        ([1.0, 0.0, 1.0], 1.0),
        ([0.0, 1.0, 2.0], 1.0),
        ([1.0, -1.0, 1.0], 0.0),
        ([1.0, 1.0, -0.25], 0.0),
        ([1.0, -0.5, 1.0], 1.0),
        ([-1.0, -1.0, 1.0], 1.0),
        ([0.0, 0.0, 1.0], 1.0),
        ([0.0, 0.0, 1.0], 0.0),
        ([1.0, -1.0, 0.0], 0.0),
        ([1.0, 1.0, 1.0], -1.0),
        ([1.0, 1e-4, 1.0], 1.0),
    ])
}

/// One quadric, or several things of which one is a quadric.
pub(super) fn quadrics() -> BoxedStrategy<String> {
    prop_oneof![
        4 => alone(),
        2 => twins(),
        1 => paraboloids(),
        1 => flat(),
        1 => lamps(),
        1 => glass(),
    ]
    .boxed()
}

fn mixed() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        3 => Just([0.0; 3]),
        1 => select(vec![[1.0, 0.0, 0.0], [0.0, -1.0, 0.5], [0.5, 0.25, -2.0]]),
    ]
}

fn sides() -> impl Strategy<Value = Option<[f64; 6]>> {
    prop_oneof![
        2 => Just(None),
        1 => select(vec![
            [-9.0, -9.0, -9.0, 9.0, 1.0, 9.0],
            [-9.0, 0.0, -9.0, 9.0, 9.0, 9.0],
            [-9.0, -9.0, -9.0, 9.0, 9.0, 0.0],
            [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0],
            [-2.0, 0.0, -2.0, 0.0, 2.0, 2.0],
        ]).prop_map(Some),
    ]
}

fn alone() -> BoxedStrategy<String> {
    (
        material(),
        shapes(),
        mixed(),
        point(),
        radius(),
        sides(),
        0..9,
    )
        .prop_map(|(m, (squares, one), mixed, c, r, sides, kind)| {
            let more = sides.map_or(String::new(), |sides| cut(c, sides));
            let text = quadric(m, around(squares, mixed, c, one * r * r), &more);
            match kind {
                0..3 => text.replacen("quadric", "pquadric", 1).replacen(
                    " }\n",
                    &format!(" shader {kind} }}\n"),
                    1,
                ),
                _ => text,
            }
        })
        .boxed()
}

/// The same points twice: a quadric and one of other coefficients, or a ball.
fn twins() -> BoxedStrategy<String> {
    (
        [material(), material()],
        shapes(),
        point(),
        radius(),
        (select(vec![-1.0, 2.0, -0.5, 1.0]), any::<bool>(), hair()),
        [sides(), sides()],
    )
        .prop_map(
            |([m, other], (squares, one), c, r, (factor, first, hair), sides)| {
                let [more, others] = sides.map(|s| s.map_or(String::new(), |sides| cut(c, sides)));
                let numbers = around(squares, [0.0; 3], c, one * r * r);
                let mut again = numbers.map(|n| n * factor);
                again[9] = nearly(again[9], hair);
                let is_ball = squares == [1.0; 3] && one > 0.0;
                let twin = if is_ball {
                    ball("sphere", other, c, r, "")
                } else {
                    quadric(other, again, &others)
                };
                let text = quadric(m, numbers, &more);
                if first { text + &twin } else { twin + &text }
            },
        )
        .boxed()
}

/// A paraboloid or a saddle along an axis.
fn paraboloids() -> BoxedStrategy<String> {
    (
        material(),
        point(),
        0..3_usize,
        select(vec![
            [1.0, 1.0],
            [1.0, -1.0],
            [0.25, 2.0],
            [1.0, 0.0],
            [-1.0, -0.5],
        ]),
        select(vec![1.0, -2.0, 0.5]),
        sides(),
    )
        .prop_map(|(m, c, axis, [a, b], slope, sides)| {
            let mut squares = [a, b, b];
            squares[axis] = 0.0;
            squares[(axis + 1) % 3] = a;
            let mut numbers = around(squares, [0.0; 3], c, slope * c[axis]);
            numbers[6 + axis] += slope;
            let more = sides.map_or(String::new(), |sides| cut(c, sides));
            quadric(m, numbers, &more)
        })
        .boxed()
}

/// A plane as a quadric, with the plane itself before or behind it in the file, or not.
fn flat() -> BoxedStrategy<String> {
    ([material(), material()], normal(), point(), sides(), 0..3)
        .prop_map(|([m, other], n, p, sides, kind)| {
            let at = n[0] * p[0] + n[1] * p[1] + n[2] * p[2];
            let [x, y, z] = n;
            let more = sides.map_or(String::new(), |sides| cut(p, sides));
            let text = quadric(m, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, x, y, z, at], &more);
            let wall = plane("plane", other, n, p, "");
            match kind {
                0 => text + &wall,
                1 => wall + &text,
                _ => text,
            }
        })
        .boxed()
}

/// A lamp on a quadric, or in its middle.
fn lamps() -> BoxedStrategy<String> {
    (material(), shapes(), point(), radius(), 0..4_usize)
        .prop_map(|(m, (squares, one), c, r, kind)| {
            let at = match kind {
                3 => c,
                axis => {
                    let mut along = [0.0; 3];
                    along[axis] = 1.0;
                    moved(c, along, r)
                }
            };
            quadric(m, around(squares, [0.0; 3], c, one * r * r), "") + &light(at)
        })
        .boxed()
}

/// A pane through the middle of a quadric of glass: what is behind the pane is met again.
fn glass() -> BoxedStrategy<String> {
    (material(), shapes(), normal(), point(), radius())
        .prop_map(|(m, (squares, one), n, c, r)| {
            quadric("pane", around(squares, [0.0; 3], c, one * r * r), "")
                + &plane("plane", "pane", n, c, "")
                + &plane("plane", m, [0.0, 0.0, 1.0], [0.0, 0.0, -15.0], "")
        })
        .boxed()
}

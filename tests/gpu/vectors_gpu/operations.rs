//! The notes' vector operations in WGSL.

use super::*;

#[test]
fn directions_between_two_points() {
    let [to, back, length] = answers(
        &[[8.0, 6.0, 5.0], [3.0, 2.0, 0.0]],
        [
            "return b - a;",
            "return a - b;",
            "return vec3f(length(b - a), 0.0, 0.0);",
        ],
    );
    assert_eq!(to, vec(-5.0, -4.0, -5.0));
    assert_eq!(back, vec(5.0, 4.0, 5.0));
    assert_eq!(format!("{:.2}", length.x), "8.12");
}

#[test]
fn sum_difference_multiple() {
    let [sum, difference, multiple] = answers(
        &[
            [3.0, 4.0, 5.0],
            [1.0, 2.0, 6.0],
            [1.0, 2.0, 3.0],
            [3.0, 0.0, 0.0],
        ],
        ["return a + b;", "return a - b;", "return d.x * c;"],
    );
    assert_eq!(sum, vec(4.0, 6.0, 11.0));
    assert_eq!(difference, vec(2.0, 2.0, -1.0));
    assert_eq!(multiple, vec(3.0, 6.0, 9.0));
}

#[test]
fn dot_and_length() {
    let [found] = answers(
        &[[2.0, 3.0, 4.0], [3.0, 2.0, 1.0], [3.0, 4.0, 5.0]],
        ["return vec3f(dot(a, b), dot(c, c), length(c));"],
    );
    assert_eq!([found.x, found.y], [16.0, 50.0]);
    assert!((found.z - 50.0_f64.sqrt()).abs() < 1e-5);
}

#[test]
fn the_driver_prints_what_the_notes_show() {
    let [difference, numbers, scaled, unit] = answers(
        &[[3.0, 4.0, 5.0], [4.0, -1.0, 2.0]],
        [
            "return b - a;",
            "return vec3f(dot(a, b), length(a), 0.0);",
            "return 1.0 / length(a) * a;",
            "return unit(a);",
        ],
    );
    assert_eq!(prn(difference), "   1.000  -5.000  -3.000");
    assert_eq!(prn(numbers), "  18.000   7.071   0.000");
    assert_eq!(prn(scaled), "   0.424   0.566   0.707");
    assert_eq!(prn(unit), "   0.424   0.566   0.707");
}

#[test]
fn cross() {
    let [found, axes] = answers(
        &[
            [1.0, 1.0, 1.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
        ],
        ["return cross(a, b);", "return cross(c, d);"],
    );
    assert_eq!(found, vec(1.0, 0.0, -1.0));
    assert_eq!(axes, DVec3::Y, "Z x X = Y");
}

#[test]
fn project() {
    let [onto_floor, across] = answers(
        &[
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 1.0],
            [3.0, 4.0, 5.0],
            [4.0, -1.0, 2.0],
        ],
        [
            "return project(a, b);",
            "return vec3f(dot(unit(c), project(unit(c), d)), 0.0, 0.0);",
        ],
    );
    assert_eq!(onto_floor, vec(1.0, 0.0, 1.0));
    assert!(across.x.abs() < 1e-6, "the projection lies in the plane");
}

#[test]
fn reflect() {
    let [off_floor, straight, sum, built_in] = answers(
        &[
            [1.0, -1.0, 0.0],
            [0.0, 1.0, 0.0],
            [-4.0, 1.0, -2.0],
            [3.0, 4.0, 5.0],
        ],
        [
            "return reflect_ray(unit(a), b);",
            "return reflect_ray(-b, b);",
            // U + V − 2N cos T
            "let n = unit(d); let u = -unit(c); return u + reflect_ray(unit(c), n) - 2.0 * n * dot(u, n);",
            // WGSL's own has the same sign.
            "return reflect_ray(unit(c), unit(d)) - reflect(unit(c), unit(d));",
        ],
    );
    assert_eq!(prn(off_floor), "   0.707   0.707   0.000");
    assert_eq!(straight, DVec3::Y);
    for nothing in [sum, built_in] {
        assert!(nothing.abs().max_element() < 1e-6, "{nothing}");
    }
}

#[test]
fn matrix_times_vector() {
    let [by_rows, by_columns] = answers(
        &[
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, -2.0],
        ],
        ["return rows(a, b, c) * d;", "return mat3x3f(a, b, c) * d;"],
    );
    assert_eq!(by_rows, vec(1.0, -1.0, -2.0));
    assert_ne!(by_columns, by_rows, "rows are not columns");
}

#[test]
fn transpose() {
    let [r0, r1, r2] = answers(
        &[[1.0, 3.0, 2.0], [1.0, 2.0, -2.0], [-2.0, 0.0, 1.0]],
        [
            "return row(transpose(rows(a, b, c)), 0u);",
            "return row(transpose(rows(a, b, c)), 1u);",
            "return row(transpose(rows(a, b, c)), 2u);",
        ],
    );
    assert_eq!(
        [r0, r1, r2],
        [vec(1.0, 1.0, -2.0), vec(3.0, 2.0, 0.0), vec(2.0, -2.0, 1.0)]
    );
}

#[test]
fn rotation_there_and_back() {
    let found = answers(
        &[[1.0, 1.0, 1.0], [1.0, 0.0, 1.0]],
        [
            "return unit(a);",
            "return unit(b);",
            "return row(rotation(a, b), 0u);",
            "return row(rotation(a, b), 1u);",
            "return row(rotation(a, b), 2u);",
            "return rotation(a, b) * unit(a);",
            "return rotation(a, b) * unit(b);",
            "let m = rotation(a, b); return transpose(m) * (m * unit(a));",
            "let m = rotation(a, b); return transpose(m) * (m * unit(b));",
        ],
    );
    let expected = [
        "   0.577   0.577   0.577",
        "   0.707   0.000   0.707",
        "   0.707   0.000  -0.707",
        "   0.000   1.000   0.000",
        "   0.707   0.000   0.707",
        "   0.000   0.577   0.816",
        "   0.000   0.000   1.000",
        "   0.577   0.577   0.577",
        "   0.707   0.000   0.707",
    ];
    assert_eq!(found.map(prn), expected);
}

#[test]
fn output_and_input_may_be_the_same() {
    let [unit, cross, project, reflect, product, difference] = answers(
        &[
            [3.0, 4.0, 5.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [1.0, 1.0, 1.0],
        ],
        [
            "var v = a; v = unit(v); return v;",
            "var v = c; v = cross(d, v); return v;",
            "var v = d; v = project(b, v); return v;",
            "var v = c; v = reflect_ray(v, b); return v;",
            "var v = a; v = rows(b, d, c) * v; return v;",
            "var v = d; v = a - v; return v;",
        ],
    );
    assert_eq!(prn(unit), "   0.424   0.566   0.707");
    assert_eq!(cross, vec(1.0, 0.0, -1.0));
    assert_eq!(project, vec(1.0, 0.0, 1.0));
    assert_eq!(reflect, DVec3::Y);
    assert_eq!(product, vec(4.0, 12.0, -4.0));
    assert_eq!(difference, vec(2.0, 3.0, 4.0));
}

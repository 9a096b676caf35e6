//! Every shape answers why a ray hits it, or why not.

use std::path::Path;

use super::*;

/// The answers of all objects to the middle pixel of a 3 × 3 picture, whose ray runs from (1, 1, 2) along −z.
fn answers(objects: &str, screen_tolerance: f64) -> Vec<HitOrMiss> {
    let text = format!(
        "camera c {{ pixeldim 3 3 worlddim 2 2 viewpoint 1 1 2 }} material m {{ ambient 1 1 1 }} {objects}"
    );
    let scene = crate::scene::parse("test", text.as_bytes(), Path::new("")).unwrap();
    let ray = ExactRay::new(&scene.camera, 1.0, 1.0);
    assert_eq!(ray.world_point(), [1.0, 1.0, 0.0]);
    (0..scene.objects.len())
        .map(|i| ray.ask(&scene, i, screen_tolerance))
        .collect()
}

#[test]
fn planes_answer_why() {
    let plane = |rest: &str| format!("plane p {{ material m {rest} }}");
    let objects = [
        plane("normal 0 0 1 point 0 0 -3"),
        plane("normal 0 1 0 point 0 0 0"),
        plane("normal 0 0 1 point 5 5 2"),
        plane("normal 0 0 1 point 0 0 3"),
        plane("normal 0 0 1 point 0 0 0.5"),
        plane("normal 0 0 1 point 0 0 0"),
    ];
    let expected = [
        HitOrMiss::Hit,
        HitOrMiss::Miss(Reason::Parallel),
        HitOrMiss::Miss(Reason::ThroughViewpoint),
        HitOrMiss::Miss(Reason::Behind),
        HitOrMiss::Miss(Reason::BeforeScreen(0.5)),
        HitOrMiss::Hit,
    ];
    assert_eq!(answers(&objects.join(" "), 0.0), expected);
    assert_eq!(answers(&objects.join(" "), 0.5)[4], HitOrMiss::Hit);
}

#[test]
fn rectangles_answer_why() {
    // The ray meets the plane at (1, 1, −3).
    let rectangle = |rest: &str| format!("fplane p {{ material m normal 0 0 7 {rest} }}");
    let objects = [
        rectangle("point 0 0 -3 xdir 2 0 9 dimensions 1 1"),
        rectangle("point 0 0 -3 xdir 2 0 9 dimensions 0.75 1"),
        rectangle("point 0 0 -3 xdir 1 0 0 dimensions 1 0.9999999999999999"),
        rectangle("point 0 2 -3 xdir 1 0 0 dimensions 1 1"),
        // Turned by 45 degrees: the corner is √2 away, and only the square of that is rational.
        rectangle("point 0 0 -3 xdir 1 1 0 dimensions 1.4142135623730951 1"),
        rectangle("point 0 0 -3 xdir 1 1 0 dimensions 1.414213562373095 1"),
    ];
    let outside = |side, at, length| HitOrMiss::Miss(Reason::Outside { side, at, length });
    let root = std::f64::consts::SQRT_2;
    let expected = [
        HitOrMiss::Hit,
        outside(0, 1.0, 0.75),
        outside(1, 1.0, 0.999_999_999_999_999_9),
        outside(1, -1.0, 1.0),
        HitOrMiss::Hit,
        outside(0, 98.0 / 4802.0_f64.sqrt(), root.next_down()),
    ];
    assert_eq!(answers(&objects.join(" "), 0.0), expected);
}

#[test]
fn triangles_answer_why() {
    // The ray meets the plane at (1, 1, −3).
    let triangle = |vertices: &str| {
        let [a, b, c] = <[&str; 3]>::try_from(vertices.split(", ").collect::<Vec<_>>()).unwrap();
        format!("triangle t {{ material m vertex1 {a} vertex2 {b} vertex3 {c} }}")
    };
    let objects = [
        triangle("0 0 -3, 3 0 -3, 0 3 -3"),
        triangle("0 3 -3, 3 0 -3, 0 0 -3"),
        triangle("1 1 -3, 3 0 -3, 0 -3 -3"),
        triangle("0 0 -3, 2 0 -3, 0 2 -3"),
        triangle("0 0 -3, 2 0 -3, 0 1.9999999999999998 -3"),
        triangle("0 2 -3, 2 2 -3, 1 4 -3"),
        triangle("0 0 3, 3 0 3, 0 3 3"),
    ];
    let beyond = |from, to| {
        HitOrMiss::Miss(Reason::BeyondEdge {
            vertices: [from, to],
        })
    };
    let expected = [
        HitOrMiss::Hit,
        HitOrMiss::Hit,
        HitOrMiss::Hit,
        HitOrMiss::Hit,
        beyond(2, 3),
        beyond(1, 2),
        HitOrMiss::Miss(Reason::Behind),
    ];
    assert_eq!(answers(&objects.join(" "), 0.0), expected);
}

#[test]
fn quadrics_answer_why() {
    let quadric = |rest: &str| format!("quadric q {{ material m coefficients {rest} }}");
    let objects = [
        // (z + 3)² = 1 about (1, 1): a ball.
        quadric("1 1 1 0 0 0 -2 -2 6 -10"),
        quadric("1 1 1 0 0 0 -2 -2 6 -10 upper 9 9 -2.5"),
        quadric("1 1 1 0 0 0 -2 -2 6 -10 upper 9 0.5 9"),
        // The viewpoint is inside.
        quadric("1 1 1 0 0 0 -2 -2 6 20"),
        quadric("1 1 1 0 0 0 -4 -2 6 -13"),
        quadric("1 1 1 0 0 0 -6 -2 6 -18"),
        quadric("1 1 1 0 0 0 -2 -2 -10 -26"),
        quadric("0 0 0 0 0 0 0 1 0 3"),
        quadric("0 0 0 0 0 0 0 0 2 1"),
    ];
    let cut = HitOrMiss::Miss(Reason::CutAway { axis: 1, at: 1.0 });
    let expected = [
        HitOrMiss::Hit,
        HitOrMiss::Hit,
        cut,
        HitOrMiss::Hit,
        HitOrMiss::Miss(Reason::Tangent),
        HitOrMiss::Miss(Reason::Passes),
        HitOrMiss::Miss(Reason::Behind),
        HitOrMiss::Miss(Reason::Parallel),
        HitOrMiss::Miss(Reason::BeforeScreen(0.5)),
    ];
    assert_eq!(answers(&objects.join(" "), 0.0), expected);
}

#[test]
fn spheres_answer_why() {
    let sphere = |rest: &str| format!("sphere s {{ material m {rest} }}");
    let objects = [
        sphere("center 1 1 -5 radius 1"),
        sphere("center 2 1 -5 radius 1"),
        sphere("center 3 1 -5 radius 1"),
        sphere("center 1 1 5 radius 1"),
        sphere("center 1 1 1 radius 4"),
    ];
    let expected = [
        HitOrMiss::Hit,
        HitOrMiss::Miss(Reason::Tangent),
        HitOrMiss::Miss(Reason::Passes),
        HitOrMiss::Miss(Reason::Behind),
        HitOrMiss::Miss(Reason::Inside),
    ];
    assert_eq!(answers(&objects.join(" "), 0.0), expected);
}

//! A quadric that is a sphere or a plane gives the sphere's or plane's bytes, and a factor changes nothing.

use std::path::Path;

use plumb::render::Backend;
use plumb::scene::parse;

use crate::common;

/// A picture of some entities.
fn picture(entities: &str) -> Vec<u8> {
    let text = format!(
        "camera c {{ pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }}
         material red {{ ambient 6 2 1 diffuse 5 4 3 specular 0.3 shininess 20 }}
         material glass {{ ambient 1 2 4 diffuse 2 5 6 transparency 0.6 }}
         material gray {{ ambient 2 2 2 diffuse 4 4 4 specular 0.2 }}
         {entities}"
    );
    let scene = parse("test", text.as_bytes(), Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    common::picture(&scene, &common::on(Backend::Cpu)).0
}

const LAMP: &str = "light l { location 7 6 3 emissivity 4 5 6 }";
const FLOOR: &str = "plane floor { material gray normal 0 1 0 point 0 -1 0 }";

/// |X − C|² = r² times a factor.
fn ball(material: &str, [x, y, z]: [f64; 3], radius: f64, factor: f64) -> String {
    let right = radius * radius - x * x - y * y - z * z;
    let numbers = [
        1.0,
        1.0,
        1.0,
        0.0,
        0.0,
        0.0,
        -2.0 * x,
        -2.0 * y,
        -2.0 * z,
        right,
    ];
    let numbers = numbers.map(|n| format!("{:?}", n * factor)).join(" ");
    format!("quadric q {{ material {material} coefficients {numbers} }}")
}

#[test]
fn a_quadric_that_is_a_sphere_gives_its_bytes() {
    for light in ["", LAMP] {
        for center in [[4.0, 2.5, -5.0], [3.25, 3.0, -2.5]] {
            let [x, y, z] = center;
            let sphere = format!("sphere s {{ material red center {x} {y} {z} radius 1.5 }}");
            let want = picture(&format!("{sphere} {FLOOR} {light}"));
            for factor in [1.0, 0.25, 3.0] {
                let quadric = ball("red", center, 1.5, factor);
                let found = picture(&format!("{quadric} {FLOOR} {light}"));
                assert!(found == want, "{center:?} times {factor} {light}");
                // In one place the first counts.
                let both = picture(&format!(
                    "{quadric} sphere s {{ material gray center {x} {y} {z} radius 1.5 }} {FLOOR} {light}"
                ));
                assert!(both == want, "{center:?} before a sphere {light}");
            }
            let other = ball("gray", center, 1.5, 1.0);
            let both = picture(&format!("{sphere} {other} {FLOOR} {light}"));
            assert!(both == want, "{center:?} behind a sphere {light}");
        }
    }
}

#[test]
fn a_quadric_that_is_a_plane_gives_its_bytes() {
    for light in ["", LAMP, "light l { location 4 -1 -3 emissivity 4 5 6 }"] {
        for (normal, point, numbers) in [
            ("0 1 0", "0 -1 0", "0 2 0 -2"),
            ("0 0 3", "1 2 -8.5", "0 0 1 -8.5"),
            ("3 0 1", "0 0 0", "1.5 0 0.5 0"),
            ("1 2 2", "2 1 -7", "0.5 1 1 -5"),
        ] {
            for material in ["gray", "glass"] {
                let ball = "sphere s { material red center 4 1 -5 radius 1 }";
                let plane =
                    format!("plane p {{ material {material} normal {normal} point {point} }}");
                let quadric = format!(
                    "quadric p {{ material {material} coefficients 0 0 0 0 0 0 {numbers} }}"
                );
                let want = picture(&format!("{plane} {ball} {light}"));
                let found = picture(&format!("{quadric} {ball} {light}"));
                assert!(found == want, "{normal} {material} {light}");
                let both = picture(&format!("{quadric} {plane} {ball} {light}"));
                assert!(both == want, "{normal} {material} twice {light}");
            }
        }
    }
}

/// A pane is met once where a ball of glass is met twice: the quadric's far side is not hit, as it was left as a whole.
#[test]
fn glass_that_is_a_quadric_is_glass() {
    let sphere = "sphere s { material glass center 4 2.5 -5 radius 1.5 }";
    let quadric = ball("glass", [4.0, 2.5, -5.0], 1.5, 1.0);
    let [want, found] = [sphere, &quadric].map(|glass| picture(&format!("{glass} {FLOOR} {LAMP}")));
    assert!(found == want);
}

//! One scene for each way in which extreme numbers made a wrong byte that was called certain.

use plumb::render::{SamplePattern, Settings};

use super::{cpu, picture, scene};
use crate::oracle::{self, Rules, differences};

/// Every pixel is decided, and as the oracle has it.
fn certified(text: &str, settings: &Settings) {
    certified_by(text, settings, &Rules::from(settings));
}

fn certified_by(text: &str, settings: &Settings, rules: &Rules) {
    let scene = scene(text);
    let answer = oracle::picture(&scene, rules);
    let rgb = picture(&scene, settings).unwrap();
    let found: Vec<_> = differences(&scene, &answer, &rgb).collect();
    assert!(found.is_empty(), "{text}\n{}", found.join("\n"));
    assert!(answer.pixels.iter().all(Result::is_ok), "{text}");
}

/// x + a − anchor is not exact where a has 53 bits: tiles of 10⁻¹⁴ tell.
#[test]
fn the_courses_places_are_not_rounded_again() {
    let settings = Settings {
        samples: 2,
        jitter: SamplePattern::Course,
        ..cpu()
    };
    for size in ["3e-14", "2e-15"] {
        let text = format!(
            "camera c {{ pixeldim 19 11 worlddim 9 5 viewpoint 4.5 2.5 3 }}
             material a {{ ambient 9 0 0 }} material b {{ ambient 0 9 0 }}
             tiled_plane p {{ material a altmaterial b normal 0 0 1 point 0 0 -6 dimension {size} {size} xdir 0 1 0 }}"
        );
        certified(&text, &settings);
    }
    // A sphere has an anchor of its own.
    let text = "camera c { pixeldim 19 11 worlddim 9 5 viewpoint 4.5 2.5 3 }
                material a { ambient 9e12 0 0 }
                sphere s { material a center 0.7 0.9 -6e4 radius 7000 }";
    certified(text, &settings);
}

/// Spheres whose distance from the viewpoint has a square that is subnormal, or none.
#[test]
fn spheres_are_kept_where_squares_underflow() {
    // The viewpoint lies outside by a hair, and subnormal squares say inside.
    for (exponent, x, y, radius) in [
        (-161, 5.036, 2.489, 5.6172),
        (-161, 2.368, 2.002, 3.10061),
        (-162, 2.71, 4.545, 5.2824),
        (-163, 4.37, 5.11, 6.7237),
        (-310, 4.37, 5.11, 6.7237),
    ] {
        let text = format!(
            "camera c {{ pixeldim 7 5 worlddim 8 6 viewpoint 0 0 2 }}
             material a {{ ambient 3 0 0 }} material b {{ ambient 0 3 0 }}
             sphere s {{ material a center {x}e{exponent} {y}e{exponent} 2 radius {radius}e{exponent} }}
             plane p {{ material b normal 0 0 1 point 0 0 -1 }}"
        );
        certified(&text, &cpu());
    }
}

/// On the axis of a cone all angles are lit, however near to 1 their cosines are; beside it the angle decides.
#[test]
fn narrow_cones_are_told_from_their_axes() {
    for theta in [
        "0.5",
        "0.046875",
        "1e-3",
        "1e-17",
        "7e-181",
        "5e-324",
        // Those that roots would make, many of them.
        "0x1.8p-12",
        "0x1.8p-40",
        "0x1.2p-300",
        "0x1.8p-599",
        "0x1.8p-1073",
    ] {
        for at in ["4 3 0", "4 3 2", "2 1.5 -1"] {
            let text = format!(
                "camera c {{ pixeldim 9 7 worlddim 8 6 viewpoint 4 3 4 }}
                 material a {{ ambient 1 1 1 diffuse 4 4 4 }}
                 plane p {{ material a normal 0 0 1 point 0 0 -4 }}
                 spotlight l {{ location {at} emissivity 9 9 9 point 4 3 -3 theta {theta} }}"
            );
            certified(&text, &cpu());
        }
    }
}

/// The axis' own length has a square that is none, or too large.
#[test]
fn cones_may_be_aimed_from_next_to_the_lamp() {
    for (from, to) in [
        ("1e-200", "3e-200"),
        ("5e-324", "1e-323"),
        ("-1e300", "1e300"),
        ("-1.7e308", "1.7e308"),
    ] {
        let text = format!(
            "camera c {{ pixeldim 5 5 worlddim 4 4 viewpoint 0.1 0.1 2 }}
             material a {{ ambient 1 1 1 diffuse 4 4 4 }}
             plane p {{ material a normal 0 0 1 point 0 0 -4 }}
             spotlight l {{ location {from} 0 0 emissivity 9 9 9 point {to} 0 -1e-200 theta 90 }}"
        );
        certified(&text, &cpu());
    }
}

/// A path along which the weight falls below all that f32 or f64 hold goes on nowhere that counts: neither does it take
/// rays without end, nor is there an error.
#[test]
fn faint_rays_are_neither_followed_nor_counted() {
    let mut settings = cpu();
    settings.limits.max_path = 1e9;
    let mut rules = Rules::from(&settings);
    rules.max_path = 60.0;
    for specular in ["3e-9", "1e-300", "0.01 1e-20 0"] {
        let text = format!(
            "camera c {{ pixeldim 9 7 worlddim 4 3 viewpoint 2 1.5 4 }}
             material m {{ ambient 1 1 1 specular {specular} shininess 3 }}
             plane a {{ material m normal 0 1 0 point 0 -0.5 0 }}
             plane b {{ material m normal 0 -1 0 point 0 3.5 0 }}
             light l {{ location 2 1 -2 emissivity 3 2 1 }}"
        );
        certified_by(&text, &settings, &rules);
    }
}

/// Tiles so small that a point's index has more digits than f64 has exponents.
#[test]
fn indices_of_a_thousand_bits_are_decided() {
    for size in ["1e-290 1e-300", "1e-307 3e-320", "5e-324 5e-324"] {
        let text = format!(
            "camera c {{ pixeldim 5 5 worlddim 4 4 viewpoint 1 1 2 }}
             material a {{ ambient 9 0 0 }} material b {{ ambient 0 9 0 }}
             tiled_plane p {{ material a altmaterial b normal 1 2 4 point 0 0 -4 dimension {size} }}
             tiled_plane q {{ material a altmaterial b normal 1 0 1 point -2 0 -4 dimension {size} xdir 1 1 0 }}"
        );
        certified(&text, &cpu());
    }
}

/// A glint's power of a cosine next to 1, by an exponent next to 0: next to 1, and below it.
#[test]
fn powers_are_told_from_one() {
    for shininess in ["1e-290", "1e-303", "5e-324"] {
        // Where the ray is 5 long the value is 2/5 + 2/5·cⁿ, c < 1: next to 204/255, and below.
        let text = format!(
            "camera c {{ pixeldim 9 1 worlddim 6 2 viewpoint 3 1 2 }}
             material a {{ ambient 2 2 2 specular 2 shininess {shininess} }}
             plane p {{ material a normal 0 0 1 point 0 0 -2 }}
             light l {{ location 3 1 0 emissivity 1 1 1 }}"
        );
        certified(&text, &cpu());
    }
}

/// A pane takes so little from a byte on its border that rays behind it have to be followed however faint they are.
#[test]
fn the_faintest_ray_may_decide_a_byte() {
    let text = "camera c { pixeldim 7 5 worlddim 8 6 viewpoint 4 3 1 }
                material m { ambient 1 0.5 2 diffuse 2 1 0.5 transparency 1e-300 }
                material wall { ambient 2 1 9 diffuse 1e3 4 1 }
                plane p { material m normal 0 0 1 point 0 0 -1 }
                plane w { material wall normal 0.1 0.2 1 point 0 0 -9 }
                light l { location 3 4 -1.5 emissivity 3 3 2 }";
    let mut settings = cpu();
    settings.limits.max_path = 12.0;
    certified(text, &settings);
}

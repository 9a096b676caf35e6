//! One scene for each way in which extreme numbers made a wrong byte that was called certain.

use plumb::render::{Backend, SamplePattern, Settings};

use super::{cpu, picture, scene};
use crate::common;
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

/// The same on the CPU and on the GPU, up to this z.
fn certified_on_both(text: &str, screen_tolerance: f64) {
    certified_on_both_to(text, screen_tolerance, 20.0);
}

/// The same with a longest path.
fn certified_on_both_to(text: &str, screen_tolerance: f64, max_path: f64) {
    for backend in [Backend::Cpu, Backend::Gpu] {
        let mut settings = Settings {
            screen_tolerance,
            ..common::on(backend)
        };
        settings.limits.max_path = max_path;
        certified(text, &settings);
    }
}

/// A border of a quadric beyond all positions cuts away all or nothing, by the side on which it is.
#[test]
fn borders_beyond_all_positions_are_borders() {
    let quadric = |borders: &str, light: &str| {
        format!(
            "camera c {{ pixeldim 20 15 worlddim 8 6 viewpoint 4 3 6 }}
             material a {{ ambient 5 1 1 diffuse 4 4 4 }} material b {{ ambient 1 5 1 diffuse 4 4 4 }}
             quadric q {{ material a coefficients 1 1 1 0 0 0 -8 -6 10 -49 {borders} }}
             plane back {{ material b normal 0 0 1 point 0 0 -9 }} {light}"
        )
    };
    let lamp = "light l { location 4 5 3 emissivity 4 4 4 }";
    for light in ["", lamp] {
        for borders in [
            "lower 1e20 -99 -99 upper 2e20 99 99",
            "lower -1e300 -99 -99 upper -1e20 99 99",
            "lower -1e20 -99 -99 upper 1e300 99 99",
        ] {
            certified_on_both(&quadric(borders, light), 0.0);
        }
        // All that is seen is in front of that.
        certified_on_both(&quadric("", light), -1e25);
    }
}

/// The sides of a triangle may be farther apart than any number of a record.
#[test]
fn triangles_end_nowhere_but_at_their_sides() {
    let text = "camera c { pixeldim 20 15 worlddim 0.03 0.02 viewpoint 0.015 0.01 0.0234375 }
        material a { ambient 0.2 0.2 0.2 diffuse 8192 8192 8192 }
        material b { ambient 1 1 1 diffuse 1 1 1 }
        plane floor { material a normal 0 1 0 point 0 -0.015625 0 }
        triangle far { material b vertex1 10307921510.4 -15461882265.6 -12025908428.8
            vertex2 10307921510.4 -15461882265.6 5153960755.2 vertex3 10307921510.4 42949672960 -3435973836.8 }
        light l { location 10995116277.76 10995116277.76 -3435973836.8 emissivity 8000 8000 8000 }";
    certified_on_both(text, 0.0);
}

/// Of a triangle with a far vertex f64 knows its sides less well, and so does what is made of them.
#[test]
fn sides_to_far_vertices_are_where_they_are() {
    for far in ["1e12", "1e14", "1e15", "1e18"] {
        let text = format!(
            "camera c {{ pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }}
             material a {{ ambient 0.2 0.2 0.2 diffuse 10 10 10 }} material b {{ ambient 1 1 1 diffuse 1 1 1 }}
             plane floor {{ material a normal 0 1 0 point 0 -1 0 }}
             triangle far {{ material b vertex1 1.1 12 -6 vertex2 3 12 -4.2 vertex3 {far} 12 -{far} }}
             light l {{ location 4.3 32 -5 emissivity 80 80 80 }}"
        );
        certified_on_both(&text, 0.0);
    }
}

/// Where hits before the screen count, a quadric may be met next to the viewpoint: it is as bright as it is there, and
/// nearer than what is farther.
#[test]
fn quadrics_next_to_the_viewpoint_are_seen() {
    let camera = "camera c { pixeldim 20 15 worlddim 8 6 viewpoint 4 3 4 }";
    let alone = format!(
        "{camera} material a {{ ambient 1.09e-12 1.27e-12 1.18e-12 }}
         quadric q {{ material a coefficients 0 0 0 0 0 0 0 0 1 3.999999999998181 }}"
    );
    certified_on_both(&alone, 10.0);
    let beside = format!(
        "{camera} material a {{ ambient 1e-12 1e-12 1e-12 }} material b {{ ambient 0 0 1e-12 }}
         plane p {{ material a normal 1 0 0 point 4.00000000000047 0 0 }}
         quadric q {{ material b coefficients 0 0 0 0 0 0 0 0 1 3.9999999999991 }}"
    );
    certified_on_both(&beside, 10.0);
}

/// Adjoints of quadrics whose numbers f32 takes for 0, far away: whether they are hit hangs on them.
#[test]
fn flushed_adjoints_are_counted() {
    let hit = "camera c { pixeldim 20 15 worlddim 8 6 viewpoint -17179869184.0 0 1 }
         material a { ambient 1e10 5e9 1e9 }
         quadric q { material a coefficients 1 -4.1359030627651384e-25 8.077935669463161e-28 0 0 0 0
             -1.3877787807814457e-17 0 5.820766091346741e-11 }";
    let missed = "camera c { pixeldim 20 15 worlddim 8 6 viewpoint -17179869184.0 0 1 }
         material a { ambient 1e10 5e9 1e9 }
         quadric q { material a coefficients 1 4.1359030627651384e-25 8.077935669463161e-28 0 0 0 0
             1.3877787807814457e-17 0 -5.820766091346741e-11 }";
    for text in [hit, missed] {
        certified_on_both(text, 1e12);
    }
}

/// f64 knows hits that are farther away than any that f32 knows: what stands for no border is farther still.
#[test]
fn far_hits_are_within_no_border() {
    let cone = "camera c { pixeldim 20 15 worlddim 2.842170943040401e-14 2.842170943040401e-14 viewpoint 0 0
             1.9073486328125e-06 }
         material m { ambient 0 0 0 specular 30 30 30 }
         material a { ambient 4e9 2e9 1e9 }
         plane wall { material m normal 1 0 0.41421363220428187 point 0 0 -1048576.0 }
         quadric q { material a coefficients 1 1 -1 0 0 0 0 0 1.1444091796875e-05
             3.2741809263825417e-11 }
         light l { location 1 1 1 emissivity 0 0 0 }";
    let sliver = "camera c { pixeldim 20 15 worlddim 1.862645149230957e-09 5.684341886080802e-14 viewpoint -8.0
             -1.9073486328125e-06 1.9073486328125e-06 }
         material m { ambient 0 0 0 specular 30 30 30 }
         material a { ambient 4e9 2e9 1e9 }
         plane wall { material m normal 0 0 1 point -8.0 -1.9073486328125e-06 -1048575.9999980927 }
         triangle t { material a vertex1 -8.0 1048576.1249980927 -1572863.9999980927 vertex2 -8.0
             1048576.1249980927 524288.0000019073 vertex3 17592186044408.0 1048576.1249980927
             -1048575.9999980927 }
         light l { location 1 1 1 emissivity 0 0 0 }";
    for text in [cone, sliver] {
        certified_on_both_to(text, 0.0, 1e30);
    }
}

/// What may be anywhere on a ray is not too far away to be seen, however oblique the ray is.
#[test]
fn what_may_be_near_is_not_dark() {
    let text = "camera c { pixeldim 20 15 worlddim 4398046511104.0 4398046511104.0 viewpoint
             -1.1279676740211232e+24 0 1099511627776.0 }
         material a { ambient 9.747722856775856e-13 9.747722856775856e-13 9.747722856775856e-13 }
         quadric q { material a coefficients 0 0 0 0 0 0 0 1 0 1.3234889800848443e-23 }";
    certified_on_both(text, 1e15);
}

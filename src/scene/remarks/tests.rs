use std::path::Path;

use super::*;
use crate::scene::{parse, places};

const CAMERA: &str = "camera c { pixeldim 41 31 worlddim 8 6 viewpoint 4 3 6 }\n";
const MATERIAL: &str = "material m { ambient 1 1 1 }\n";

fn of(text: &str) -> Vec<String> {
    of_all(&format!("{CAMERA}{text}"), 0.0)
}

fn of_all(text: &str, tolerance: f64) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let scene = parse("test", text.as_bytes(), &folder).unwrap();
    let places = places(text.as_bytes());
    remarks(&scene, tolerance, &lines_of(text.as_bytes(), &places))
}

/// What is told of objects of a material with ambient.
fn of_objects(objects: &str) -> Vec<String> {
    of(&format!("{MATERIAL}{objects}"))
}

const NONE: [&str; 0] = [];

#[test]
fn a_scene_as_it_is_meant_gets_none() {
    let wall = "material m { ambient 1 1 1 } plane p { material m normal 0 0 1 point 0 0 -1 }";
    assert_eq!(of(wall), NONE);
}

#[test]
fn without_lines_names_alone_are_told() {
    let text = format!("{CAMERA}{MATERIAL}sphere s {{ material m center 4 3 6 radius 1 }}");
    let scene = parse("test", text.as_bytes(), Path::new("")).unwrap();
    assert_eq!(
        remarks(&scene, 0.0, &|_| None),
        ["the viewpoint is inside sphere `s`: a ray that starts in a sphere does not meet it"]
    );
}

#[test]
fn black_pictures_are_foretold() {
    assert_eq!(of(""), ["there are no objects: the picture is black"]);
    let wall = "material m { diffuse 1 1 1 } plane p { material m normal 0 0 1 point 0 0 -1 }";
    let told = "so only ambient counts, and `m` (line 2) has none: what is made of it is black";
    assert_eq!(of(wall), [format!("there is no light, {told}")]);
    let lit = |emissivity: &str| {
        of(&format!(
            "{wall} light l {{ location 0 0 0 emissivity {emissivity} }}"
        ))
    };
    assert_eq!(lit("1 1 1"), NONE);
    assert_eq!(lit("0 0 0.001"), NONE);
    assert_eq!(
        lit("0 0 0"),
        [format!(
            "no light shines, as the emissivity of each is 0, {told}"
        )]
    );
}

#[test]
fn lights_that_nothing_answers_are_told() {
    let of_material = |material: &str| {
        of(&format!(
            "material m {{ {material} }} material other {{ diffuse 1 1 1 }}
             plane p {{ material m normal 0 0 1 point 0 0 -1 }} light l {{ location 0 0 0 emissivity 1 1 1 }}"
        ))
    };
    assert_eq!(
        of_material("ambient 1 1 1 specular 1 1 1"),
        [
            "nothing is lit: `m` (line 2) has neither diffuse nor a glint (specular and shininess), so lights change \
          nothing"
        ]
    );
    assert_eq!(
        of_material("ambient 1 1 1 specular 1 1 1 shininess 2"),
        NONE
    );
    assert_eq!(of_material("ambient 1 1 1 diffuse 0 0 0.1"), NONE);
    // Tiles have two materials.
    let tiles = "material m { ambient 1 1 1 } material n { diffuse 1 1 1 }
        tiled_plane p { material m altmaterial n normal 0 0 1 point 0 0 -1 dimension 1 1 }
        light l { location 0 0 0 emissivity 1 1 1 }";
    assert_eq!(of(tiles), NONE);
}

#[test]
fn projectors_that_light_nothing_are_told() {
    let of = |location: &str| {
        of(&format!(
            "texture t {{ filename textures/texels.ppm }} material m {{ diffuse 1 1 1 }}
             plane p {{ material m normal 0 0 1 point 0 0 -4 }}
             projector l {{ location {location} emissivity 1 1 1 normal 1 2 3 point 3 2 1 xdir 1 0 0
                 dimensions 1 1 texname t mode 0 }}"
        ))
    };
    assert_eq!(of("0 0 3.333"), NONE);
    assert_eq!(
        of("1 3 1"),
        ["no light of `l` (line 4) passes its picture: its location lies in the picture's plane"]
    );
}

#[test]
fn names_that_stand_twice_are_told() {
    let twice = "material m { ambient 1 1 1 } material m { ambient 2 2 2 } \
                 plane p { material m normal 0 0 1 point 0 0 -1 }";
    assert_eq!(
        of(twice),
        ["`m` (line 2) is the name of more than one material: the first counts"]
    );
}

#[test]
fn a_viewpoint_in_a_sphere_is_told() {
    let sphere =
        |at: &str| of_objects(&format!("sphere s {{ material m center {at} radius 2.5 }}"));
    let told = [
        "the viewpoint is inside sphere `s` (line 3): a ray that starts in a sphere does not meet it",
    ];
    assert_eq!(sphere("4 3 5"), told);
    // On it, and a hair beside it.
    assert_eq!(sphere("4 3 3.5"), told);
    assert_eq!(sphere("4 3 3.4999999999999996"), NONE);
    // A quadric is seen from inside.
    let quadric = "quadric q { material m coefficients 1 1 1 0 0 0 -8 -6 -10 -14 }";
    assert_eq!(of_objects(quadric), NONE);
}

#[test]
fn a_viewpoint_in_a_plane_is_told() {
    let plane = |point: &str| {
        of_objects(&format!(
            "plane p {{ material m normal 1 2 3 point {point} }}"
        ))
    };
    assert_eq!(
        plane("28 0 0"),
        ["the viewpoint lies in the plane of plane `p` (line 3): no ray from there meets it"]
    );
    assert_eq!(plane("27.999999999999996 0 0"), NONE);
}

#[test]
fn what_is_behind_the_viewpoint_is_told() {
    let told = |kind: &str| {
        [format!(
            "{kind} `o` (line 3) lies behind the viewpoint, and not on the picture"
        )]
    };
    for (kind, z) in [
        ("sphere o { material m center 4 3 Z radius 1 }", 7.0),
        (
            "triangle o { material m vertex1 4 3 Z vertex2 5 3 20 vertex3 4 4 20 }",
            6.0,
        ),
        ("plane o { material m normal 0 0 1 point 0 0 Z }", 6.0),
        (
            "fplane o { material m normal 0 1 0 point 4 1 Z xdir 1 0 0 dimensions 2 -3 }",
            6.0,
        ),
        (
            "quadric o { material m coefficients 1 0 0 0 0 0 -8 0 0 0 lower -1 -1 Z upper 9 9 9 }",
            6.0,
        ),
    ] {
        let kind = kind.replace("dimensions 2 -3", "dimensions 2 3");
        // The second side of that rectangle goes to smaller z.
        let first = kind.split(' ').next().unwrap();
        let at = |z: f64| of_objects(&kind.replace('Z', &z.to_string()));
        let more = if first == "fplane" { 3.0 } else { 0.0 };
        assert_eq!(at(z + more + 0.001), told(first), "{kind}");
        let near = at(z + more - 0.001);
        assert_ne!(near, told(first), "{kind}");
        // A sphere is then around the viewpoint, all else before the screen.
        let next = if first == "sphere" {
            "the viewpoint is inside"
        } else {
            "before the screen"
        };
        assert!(near[0].contains(next), "{kind}: {near:?}");
    }
}

#[test]
fn what_is_before_the_screen_is_told() {
    for kind in [
        "triangle o { material m vertex1 4 3 Z vertex2 5 3 4 vertex3 4 4 4 }",
        "plane o { material m normal 0 0 1 point 0 0 Z }",
        "quadric o { material m coefficients 1 1 1 0 0 0 -8 -6 0 0 lower -1 -1 Z }",
    ] {
        let first = kind.split(' ').next().unwrap();
        let at = |z: &str, tolerance: f64| {
            let text = format!("{CAMERA}{MATERIAL}{}", kind.replace('Z', z));
            of_all(&text, tolerance)
        };
        assert_eq!(at("0", 0.0), NONE, "{kind}");
        let told = |most: &str| {
            [format!(
                "{first} `o` (line 3) lies before the screen, and not on the picture: all but spheres is seen only \
                 where z ≤ {most}"
            )]
        };
        assert_eq!(at("0.01", 0.0), told("0"), "{kind}");
        assert_eq!(at("0.01", 0.02), NONE, "{kind}");
        assert_eq!(at("0.03", 0.02), told("0.02"), "{kind}");
    }
    // A sphere is seen there.
    assert_eq!(
        of_objects("sphere o { material m center 4 3 2 radius 1 }"),
        NONE
    );
}

/// The screen's edges as seen from the viewpoint: at z = −6 half a screen more to each side, and half a pixel.
#[test]
fn what_is_beside_the_screen_is_told() {
    let told = |kind: &str, side: &str| {
        [format!(
            "{kind} `o` (line 3) lies {side} what is seen through the screen, and not on the picture"
        )]
    };
    // Half a pixel is 0.1 on the screen, and twice that there.
    for (side, [x, y], [dx, dy]) in [
        ("above", [4.0_f64, 9.2_f64], [0.0_f64, 1.0_f64]),
        ("below", [4.0, -3.2], [0.0, -1.0]),
        ("to the left of", [-4.2, 3.0], [-1.0, 0.0]),
        ("to the right of", [12.2, 3.0], [1.0, 0.0]),
    ] {
        for by in [0.001, -0.001] {
            let (x, y) = (x + by * dx, y + by * dy);
            // A triangle that is nearest to what is seen with this corner, and a box.
            let (far_x, far_y) = (x + 5.0 * dx, y + 5.0 * dy);
            let triangle = format!(
                "triangle o {{ material m vertex1 {x} {y} -6 vertex2 {far_x} {far_y} -6 vertex3 {far_x} {far_y} -5 }}"
            );
            let (least, most) = ([x.min(far_x), y.min(far_y)], [x.max(far_x), y.max(far_y)]);
            let cut = format!(
                "quadric o {{ material m coefficients 1 0 0 0 0 0 0 0 0 9 lower {} {} -6 upper {} {} -5 }}",
                least[0] - dy.abs(),
                least[1] - dx.abs(),
                most[0] + dy.abs(),
                most[1] + dx.abs()
            );
            for (kind, text) in [("triangle", triangle), ("quadric", cut)] {
                let found = of_objects(&text);
                if by > 0.0 {
                    assert_eq!(found, told(kind, side), "{text}");
                } else {
                    assert_eq!(found, NONE, "{text}");
                }
            }
        }
    }
    // A ball, whose distance from the slanted plane through the upper edge counts: (y − 3)·6 − (6 − z)·3.1 over its
    // length.
    let far = (6.0_f64 * 6.0 + 3.1 * 3.1).sqrt();
    for by in [0.001, -0.001] {
        let y = 3.0 + (12.0 * 3.1 + far) / 6.0 + by;
        let sphere = of_objects(&format!(
            "sphere o {{ material m center 4 {y} -6 radius 1 }}"
        ));
        let ellipsoid = of_objects(&format!(
            "quadric o {{ material m coefficients -4 -4 -4 0 0 0 32 {} -48 {} }}",
            8.0 * y,
            // −4 (r² − 4² − y² − 6²)
            -4.0 * (1.0 - 16.0 - y * y - 36.0)
        ));
        if by > 0.0 {
            assert_eq!(sphere, told("sphere", "above"));
        } else {
            assert_eq!(sphere, NONE);
            assert_eq!(ellipsoid, NONE);
        }
    }
    let high = "quadric o { material m coefficients 1 1 1 0 0 0 -8 -40 12 -451 }";
    assert_eq!(of_objects(high), told("quadric", "above"));
}

#[test]
fn where_there_are_mirrors_what_is_beside_the_screen_may_be_meant() {
    let ball =
        "sphere o { material m center 4 3 9 radius 1 } light l { location 0 0 0 emissivity 1 1 1 }";
    let of = |mirror: &str| of(&format!("material m {{ diffuse 1 1 1 {mirror} }}\n{ball}"));
    assert_eq!(of("specular 0.1"), NONE);
    assert_eq!(
        of(""),
        ["sphere `o` (line 3) lies behind the viewpoint, and not on the picture"]
    );
}

#[test]
fn many_objects_are_one_remark() {
    let ball = |i: i32| {
        format!(
            "sphere s{i} {{ material m center 4 3 {} radius 1 }}\n",
            9 + i
        )
    };
    let balls = |count: i32| of_objects(&(0..count).map(ball).collect::<String>());
    assert_eq!(
        balls(4),
        [
            "sphere `s0` (line 3), sphere `s1` (line 4), sphere `s2` (line 5) and one other lie behind the viewpoint, \
          and not on the picture"
        ]
    );
    assert!(balls(9)[0].contains("and 6 others lie"), "{:?}", balls(9));
}

#[test]
fn lights_in_balls_are_told() {
    let of = |ball: &str, transparency: &str| {
        of(&format!(
            "material m {{ ambient 1 1 1 diffuse 1 1 1 transparency {transparency} }}
             plane wall {{ material m normal 0 0 1 point 0 0 -9 }}
             {ball}
             light lamp {{ location 4 3 -5 emissivity 1 1 1 }}"
        ))
    };
    let told = |kind: &str| {
        [format!(
            "light `lamp` (line 5) is inside {kind} `b` (line 4), and lights nothing outside it"
        )]
    };
    let sphere = |x: &str| format!("sphere b {{ material m center {x} 3 -5 radius 1 }}");
    assert_eq!(of(&sphere("4.5"), "0"), told("sphere"));
    assert_eq!(of(&sphere("4.999999999999999"), "0"), told("sphere"));
    assert_eq!(of(&sphere("5"), "0"), NONE);
    // Glass lets it out.
    assert_eq!(of(&sphere("4.5"), "0.1"), NONE);
    // The same as a quadric; turned inside out; a little smaller than what it takes; cut open.
    let quadric = |numbers: &str| format!("quadric b {{ material m coefficients {numbers} }}");
    assert_eq!(
        of(&quadric("1 1 1 0 0 0 -9 -6 10 -53.25"), "0"),
        told("quadric")
    );
    assert_eq!(
        of(&quadric("-1 -1 -1 0 0 0 9 6 -10 53.25"), "0"),
        told("quadric")
    );
    assert_eq!(of(&quadric("1 1 1 0 0 0 -9 -6 10 -54.0001"), "0"), NONE);
    assert_eq!(
        of(&quadric("1 1 1 0 0 0 -9 -6 10 -53.25 upper 9 9 -5"), "0"),
        NONE
    );
}

//! Lit scenes that ask for trouble: each ends soon, with a picture or with what is wrong; none hangs or is cut
//! silently.

use std::fs;
use std::time::{Duration, Instant};

use super::desk::{Desk, ppm};

/// What a scene may take on two cores, several tests at a time.
const SOON: Duration = Duration::from_secs(60);

const CAMERA: &str = "camera cam { pixeldim 24 18 worlddim 8 6 viewpoint 4 3.1 6 }\n";
const MATERIALS: &str = "\
material grey { ambient 1 1 1 diffuse 3 3 3 }
material shiny { ambient 1 1 1 diffuse 3 3 3 specular 0.5 shininess 10 }
material mirror { ambient 0.1 0.1 0.1 diffuse 0.1 0.1 0.1 specular 1 }
material glass { ambient 0.1 0.2 0.1 diffuse 0.5 1 0.5 transparency 0.9 }
";
const ROOM: &str = "\
plane wall { material grey normal 0 0 1 point 0 0 -8 }
plane floor { material shiny normal 0 1 0 point 0 0 0 }
sphere ball { material shiny center 4 2 -4 radius 1.5 }
";

/// A light.
fn light(number: usize, location: &str, emissivity: f64) -> String {
    format!(
        "light l{number} {{ location {location} emissivity {emissivity} {emissivity} {emissivity} }}\n"
    )
}

/// Bytes of the picture of a scene, the same from both tracers but for few pixels.
#[track_caller]
fn renders(objects: &str, options: &[&str]) -> Vec<u8> {
    let desk = Desk::new();
    desk.write("scene.txt", &[CAMERA, MATERIALS, objects].concat());
    let start = Instant::now();
    let [gpu, cpu] = ["gpu", "cpu"].map(|backend| {
        let args = ["render", "scene.txt", "--backend", backend, "-o", "-", "-q"];
        let ran = desk.run(&[&args[..], options].concat()).ends(0);
        assert_eq!(ran.stderr, "");
        ppm(&ran.stdout).2.to_vec()
    });
    let took = start.elapsed();
    assert!(took < SOON, "it took {took:?}");
    let pairs = gpu.chunks_exact(3).zip(cpu.chunks_exact(3));
    let differ = pairs.filter(|(a, b)| a != b).count();
    // A pixel on an edge may go either way in f32.
    assert!(differ <= 2, "{differ} of {} pixels differ", cpu.len() / 3);
    cpu
}

/// A scene that is refused, at once.
#[track_caller]
fn is_refused(objects: &str, words: &[&str]) {
    let desk = Desk::new();
    for (name, bytes) in [
        ("empty.ppm", &b"P6 0 0 255\n"[..]),
        ("huge.ppm", b"P6 65536 65536 255\n0123456789"),
        ("short.ppm", b"P6 2 2 255\n01234567890"),
    ] {
        fs::write(desk.path(name), bytes).unwrap();
    }
    desk.write("scene.txt", &[CAMERA, MATERIALS, objects].concat());
    let start = Instant::now();
    for backend in ["gpu", "cpu"] {
        desk.run(&["render", "scene.txt", "--backend", backend])
            .fails_with(words);
    }
    desk.run(&["check", "scene.txt"]).fails_with(words);
    assert!(start.elapsed() < Duration::from_secs(10));
    assert!(!desk.names().contains(&"scene.ppm".to_owned()));
}

/// How bright a picture is.
fn brightness(bytes: &[u8]) -> u64 {
    bytes.iter().map(|&byte| u64::from(byte)).sum()
}

#[test]
fn a_light_may_be_anywhere() {
    let lit = |location: &str| renders(&[ROOM, &light(0, location, 3.0)].concat(), &[]);
    let dark = lit("4 -5 -20");
    // In the ball, which lets no light out.
    assert_eq!(lit("4 2 -4"), dark);
    // On the ball, on the floor, on the wall, where the two meet, and where the viewpoint is.
    for location in ["4 3.5 -4", "4 0 -1", "2 5 -8", "4 3.1 6"] {
        assert!(brightness(&lit(location)) > brightness(&dark), "{location}");
    }
    assert_eq!(lit("4 0 -8"), dark);
}

#[test]
fn numbers_at_their_ends_make_a_picture() {
    let lit = |lights: &str| renders(&[ROOM, lights].concat(), &[]);
    let spot = |theta: &str| {
        format!("spotlight s {{ location 4 5 -1 emissivity 3 3 3 point 4 0 -4 theta {theta} }}")
    };
    let whole = lit(&light(0, "4 5 -1", 3.0));
    assert_eq!(lit(&spot("180")), whole);
    assert!(brightness(&lit(&spot("1e-300"))) < brightness(&whole));
    lit(&[light(0, "1e308 1e308 1e308", 1.0), light(1, "4 3 5", 1e308)].concat());
    lit(&[
        light(0, "4 3 1e-320", 1e-308),
        light(1, "4 2.9999 -8", 1e-320),
    ]
    .concat());
}

#[test]
fn what_makes_no_sense_is_refused() {
    for theta in ["0", "200", "-1", "nan"] {
        let spot = format!(
            "spotlight s {{ location 4 5 -1 emissivity 3 3 3 point 4 0 -4 theta {theta} }}"
        );
        is_refused(&[ROOM, &spot].concat(), &["scene.txt:9:67"]);
    }
    is_refused(
        "spotlight s { location 4 5 -1 emissivity 3 3 3 point 4 5 -1 theta 20 }",
        &["`point` must differ from `location`"],
    );
    let rectangle =
        "fplane p { material grey normal 0 0 2 point 0 0 -2 xdir 0 0 -7 dimensions 1 1 }";
    is_refused(rectangle, &["`xdir` must not be parallel to `normal`"]);
    for (file, words) in [
        ("empty.ppm", "has no pixels: it is 0 x 0"),
        ("huge.ppm", "12884901888 bytes, and there are 10"),
        ("short.ppm", "12 bytes, and there are 11"),
        ("none.ppm", "there is no such file"),
    ] {
        is_refused(
            &format!("texture t {{ filename {file} }}"),
            &["scene.txt:6:22", words],
        );
    }
}

#[test]
fn ten_thousand_lights() {
    // Over the whole room, some of them behind it or in the ball, all of them weak.
    let place = |i: usize| {
        let along = |step: usize, size: f64| (i * step % 10_000) as f64 / 10_000.0 * size;
        format!(
            "{} {} {}",
            along(37, 8.0),
            along(7_919, 6.0),
            along(113, 12.0) - 9.0
        )
    };
    let lights: String = (0..10_000).map(|i| light(i, &place(i), 0.001)).collect();
    let bytes = renders(&[ROOM, &lights].concat(), &["--size", "12x9"]);
    assert!(brightness(&bytes) > 0);
}

#[test]
fn a_chain_of_a_thousand_panes() {
    let panes: String = (1..=1000)
        .map(|i| {
            let z = -0.01 * f64::from(i);
            format!("fplane p{i} {{ material glass normal 0 0 1 point 0 0 {z} xdir 1 0 0 dimensions 8 6 }}\n")
        })
        .collect();
    let wall = "plane wall { material grey normal 0 0 1 point 0 0 -11 }\n";
    let lights = [light(0, "4 3 -10.5", 3.0), light(1, "4 3 5", 3.0)].concat();
    // A picture of few pixels: rays in its middle go through all the panes, and from each of them on to the lights;
    // those beside it meet the wall alone, and look from there through all panes at once. Neighbours on the GPU, they
    // do not share one count of steps.
    renders(&[&panes, wall, &lights].concat(), &["--size", "8x6"]);
}

#[test]
fn a_hall_of_mirrors_without_end() {
    // A corridor: a ray is thrown from side to side until its path is as long as asked for.
    let walls = "\
plane left { material mirror normal 1 0 0 point -1 0 0 }
plane right { material mirror normal -1 0 0 point 9 0 0 }
plane floor { material mirror normal 0 1 0 point 0 -1 0 }
plane ceiling { material mirror normal 0 -1 0 point 0 7 0 }
";
    let hall = [walls, &light(0, "4 3 -1", 3.0)].concat();
    let options = ["--size", "8x6", "--max-path"];
    renders(&hall, &[&options[..], &["1000"]].concat());
    let many = ["1e5", "--max-rays", "1000000"];
    renders(&hall, &[&options[..], &many[..]].concat());
    let desk = Desk::new();
    desk.write("scene.txt", &[CAMERA, MATERIALS, &hall].concat());
    for backend in ["gpu", "cpu"] {
        let args = [
            "render",
            "scene.txt",
            "--backend",
            backend,
            "--max-path",
            "1e6",
        ];
        desk.run(&args)
            .fails_with(&["needs more than 65536 rays", "--max-path"]);
    }
}

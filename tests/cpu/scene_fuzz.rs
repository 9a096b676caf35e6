//! The parser meets random bytes, random tokens and damaged scenes: it answers, and never panics.

use std::path::Path;

use plumb::scene::{self, Scene};
use proptest::prelude::*;

const SCENE: &str = "camera cam { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 }
material green { ambient 0 5 0 diffuse 1 1 1 specular 0.5 shininess 20 transparency 0.25 }
material red { ambient 0x1.8p1 0 0 } # comment
plane wall { material green normal 3 0 1 point 0 0 0 }
sphere ball { material red center 1 2 -3 radius 1.5 }
tiled_plane tiles { material green normal 0 1 0 point 0 0 0 altmaterial red dimension 2 3 xdir 1 1 0 }
pplane p { material green normal 0 1 0 point 0 0 0 shader 1 }
psphere q { material green center 0 0 -5 radius 1 shader 0 }
fplane f { material green normal 0 0 1 point 2 1 -5 xdir 1 0 0 dimensions 4 3 }
light l { location 4 3 3 emissivity 10 10 10 }
spotlight s { location 0 4 0 emissivity 10 0 0 theta 15 point 4 0 -3 }
";

const WORDS: &[&str] = &[
    "camera",
    "material",
    "plane",
    "sphere",
    "tiled_plane",
    "pplane",
    "psphere",
    "fplane",
    "light",
    "spotlight",
    "texture",
    "texplane",
    "tilled_plane",
    "quadric",
    "pixeldim",
    "worlddim",
    "viewpoint",
    "ambient",
    "diffuse",
    "specular",
    "normal",
    "point",
    "center",
    "radius",
    "altmaterial",
    "dimension",
    "dimensions",
    "xdir",
    "shader",
    "texname",
    "mode",
    "filename",
    "location",
    "emissivity",
    "theta",
    "green",
    "red",
    "{",
    "}",
    "{",
    "}",
    "0",
    "1",
    "-1",
    "2.5",
    "1e999",
    "nan",
    "0x1p-3",
    "#",
    "\n",
    "\r\n",
    "5abc",
    "\u{FEFF}",
    "ä",
    "\0",
    ".",
    "/",
];

fn parse(text: &[u8]) -> Option<Scene> {
    match scene::parse("fuzz", text, Path::new("/nonexistent")) {
        Ok(scene) => Some(scene),
        Err(diagnostics) => {
            let text = diagnostics.render(false);
            assert!(
                text.starts_with("error: ") && text.ends_with('\n'),
                "{text}"
            );
            assert!(text.len() < 200_000, "{} bytes", text.len());
            assert!(diagnostics.total() > 0);
            assert!(
                !text.chars().any(|c| c.is_control() && c != '\n'),
                "{text:?}"
            );
            diagnostics.render(true);
            diagnostics.to_json();
            None
        }
    }
}

/// The scene that its own listing, with braces put back, gives.
fn read_back(scene: &Scene) -> Scene {
    let mut out = Vec::new();
    scene::list_model(scene, &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let entities = text
        .trim_end()
        .split("\n\n")
        .map(|entity| entity.replacen('\n', " {\n", 1) + "}\n");
    scene::parse(
        "listing",
        entities.collect::<String>().as_bytes(),
        Path::new(""),
    )
    .unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        parse(&bytes);
    }

    #[test]
    fn random_tokens(words in prop::collection::vec(prop::sample::select(WORDS), 0..60), glue in any::<bool>()) {
        parse(words.join(if glue { "" } else { " " }).as_bytes());
        parse(format!("{SCENE}{}", words.join(" ")).as_bytes());
    }

    #[test]
    fn damaged_scenes(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..6_u8, prop::sample::select(WORDS)), 1..5)
    ) {
        let mut tokens: Vec<&str> = SCENE.split(' ').collect();
        for (index, edit, word) in edits {
            // An edit may cut everything off.
            if tokens.is_empty() {
                break;
            }
            let at = index.index(tokens.len());
            match edit {
                0 => { tokens.remove(at); }
                1 => tokens.insert(at, word),
                2 => tokens[at] = word,
                3 => {
                    let next = (at + 1) % tokens.len();
                    tokens.swap(at, next);
                }
                4 => tokens.truncate(at.max(1)),
                _ => tokens.insert(at, tokens[at]),
            }
        }
        if let Some(scene) = parse(tokens.join(" ").as_bytes()) {
            prop_assert_eq!(read_back(&scene), scene);
        }
    }

    #[test]
    fn damaged_bytes(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..5)) {
        let mut bytes = SCENE.as_bytes().to_vec();
        for (index, byte) in edits {
            *index.get_mut(&mut bytes) = byte;
        }
        parse(&bytes);
    }

    #[test]
    fn numbers_read_as_the_standard_library_reads_them(value in any::<f64>()) {
        prop_assume!(value.is_finite());
        for text in [format!("{value}"), format!("{value:e}"), format!("{value:?}")] {
            let scene = format!(
                "camera c {{ pixeldim 1 1 worlddim 1 1 viewpoint 0 0 1 }} light l {{ location {text} 0 0 emissivity 0 0 0 }}"
            );
            let scene = parse(scene.as_bytes()).unwrap();
            prop_assert_eq!(scene.lights[0].location.x.to_bits(), (value + 0.0).to_bits());
            prop_assert_eq!(read_back(&scene), scene);
        }
    }

    #[test]
    fn hexadecimal_numbers_round_as_decimal_ones_do(mantissa in any::<u64>(), scale in -1140..960_i32) {
        let text = format!("0x{mantissa:x}p{scale}");
        let scene = format!(
            "camera c {{ pixeldim 1 1 worlddim 1 1 viewpoint 0 0 1 }} light l {{ location {text} 0 0 emissivity 0 0 0 }}"
        );
        let read = parse(scene.as_bytes()).unwrap().lights[0].location.x;
        // Rounded to 53 bits once by the conversion, exact afterwards unless the result is subnormal.
        let rounded = mantissa as f64;
        if rounded == 0.0 || scale >= -1021 {
            let half = scale / 2;
            prop_assert_eq!(read, rounded * 2_f64.powi(half) * 2_f64.powi(scale - half));
        } else {
            prop_assert!((read - rounded * 2_f64.powi(-600) * 2_f64.powi(scale + 600)).abs() <= f64::from_bits(1));
        }
    }
}

#[test]
fn the_whole_scene_is_good_and_reads_back() {
    let scene = parse(SCENE.as_bytes()).unwrap();
    assert_eq!(read_back(&scene), scene);
}

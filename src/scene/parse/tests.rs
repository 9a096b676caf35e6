//! Whether many objects are read at once or one by one changes nothing: not the scene, and no word of a complaint.

use std::fs;

use proptest::prelude::*;

use super::*;

const HEAD: &str = "camera cam { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 }
material green { ambient 0 5 0 }
material material { ambient 1 1 1 } material 7 { ambient 2 2 2 }
";

/// Objects in every class and many spellings; some have mistakes.
const OBJECTS: &[&str] = &[
    "sphere ball { material green center 1 2 -3 radius 1.5 }",
    "sphere ball{radius 1e-2 center +.5 -0 0x1.8p1 material 7}",
    "sphere\nball\n{\nmaterial green\ncenter 12.3456789 -0.000125 123456789012345678901234567890e-9\nradius 7\n}\n",
    "sphere s { material green center 1 2 3 # } comment { radius 2\n radius 1 }",
    "sphere s { material green center 1 2 3 radius 0 }",
    "sphere s { material material radius 1 center 1 2 3 }",
    "sphere s { material center center 1 2 3 radius 1 }",
    "sphere s { center 1 2 3 radius 1 }",
    "sphere s { material green radius 1 2 center 1 2 3 }",
    "sphere s { material green radius 1 center 1 2 3 } radius 2 }",
    "psphere q { material green center 0 0 -5 radius 1 shader 0 }",
    "psphere q { material green center 0 0 -5 radius 1 shader 0.5 }",
    "plane wall { material green normal 3 0 1 point 0 0 0 }",
    "plane wall { material green normal 0 -0 0 point 0 0 0 }",
    "plane material { material material normal 3 0 1 point 0 0 0 }",
    "pplane p { material green normal 0 1 0 point 0 0 0 shader 1 }",
    "tiled_plane t { material green normal 0 1 0 point 0 0 0 altmaterial 7 dimension 2 3 xdir 1 1 0 }",
    "tiled_plane t { material green normal 0 1 0 point 0 0 0 altmaterial 7 dimensions 2 3 }",
    "tiled_plane t { material green normal 0 1 0 point 0 0 0 altmaterial 7 dimension 2 3 xdir 0 1 0 }",
    "fplane f { material green normal 0 0 1 point 2 1 -5 xdir 1 0 0 dimensions 4 3 }",
    "triangle t { material green vertex1 0 0 -1 vertex2 1 0 -1 vertex3 0 1 -1 }",
    "tri t { material green v0 0 0 -1 v1 1 0 -1 v2 0 1 -1 normal 0 0 -1 }",
    "triangle t { material green v1 0 0 -1 v2 1 0 -1 v3 0 1 -1 point 1 2 3 }",
    "triangle t { v2 1 0 -1 v1 0 0 -1 v3 0 1 -1 material green }",
    "triangle t { v2 1 0 -1 v1 0 0 -1 v0 0 1 -1 material green }",
    "triangle t { material green vertex1 0 0 -1 v2 1 0 -1 vertex3 0 1 -1 }",
    "triangle t { material green v1 0 0 0 v2 1 1 1 v3 2 2 2 }",
    "ptriangle t { material green point1 0 0 -1 point2 1 0 -1 point3 0 1 -1 shader 0 }",
    "quadric q { material green coefficients 1 1 1 0 0 0 0 0 0 1 lower -1 -1 -9 upper 1 1 -2 }",
    "quadric q { material green coefficients 1 1 1 0 0 0 0 0 0 1 lower 1 1 -9 upper 1 1 -2 }",
    "light l { location 4 3 3 emissivity 10 10 10 }",
    "material late { ambient 1 2 3 }",
    "# } { a comment } sphere s {\n",
];

const WORDS: &[&str] = &[
    "sphere",
    "material",
    "green",
    "center",
    "radius",
    "{",
    "}",
    "1",
    "-2.5",
    "=",
    ":",
    ",",
    "1,5",
    "<1,2,3>",
    "#",
    "\n",
    "light",
    "sfere",
    "late",
    "nan",
    "inf",
    "1e999",
    "0x",
    "\u{A0}",
    "1\u{A0}2",
    "vertex1",
    "v1",
    "\u{2212}1",
    "99999999999999999999",
    "9007199254740993",
    "0.1",
    ".",
    "normal",
    "point",
    "cam",
];

/// What becomes of a text: its scene, or all that is said about it.
fn told(text: &str, starts: Starts) -> Result<Scene, (String, usize)> {
    let folder = Some(Path::new("/nonexistent"));
    read("scene", text.as_bytes(), folder, starts)
        .map_err(|wrong| (wrong.render(false), wrong.total()))
}

fn compare(text: &str) {
    let one_by_one = told(text, Starts::default());
    for parallel in [false, true] {
        let together = told(text, Starts::found(text.as_bytes(), parallel));
        assert_eq!(together, one_by_one, "{text}");
    }
}

/// How many objects of a text without mistakes are not left to the parser, and how many it has.
fn taken(text: &str) -> (usize, usize) {
    let mut parser = Parser::new(text.as_bytes(), None);
    let mut starts = Starts::found(text.as_bytes(), false);
    let mut taken = 0;
    while parser.window[0].kind != TokenKind::End {
        let before = parser.assembly.objects.len();
        parser.objects(&mut starts);
        taken += parser.assembly.objects.len() - before;
        parser.entity();
    }
    assert!(parser.errors.is_empty(), "{text}");
    (taken, parser.assembly.objects.len())
}

#[test]
fn objects_without_mistakes_are_taken_together() {
    let right = |object: &&&str| {
        !object.starts_with('#') && {
            let text = format!("{HEAD}{object}");
            told(&text, Starts::default()).is_ok_and(|scene| !scene.objects.is_empty())
        }
    };
    let right: Vec<_> = OBJECTS.iter().filter(right).collect();
    assert!(right.len() > 15, "{}", right.len());
    for object in right {
        let text = format!("{HEAD}{}", format!("{object}\n").repeat(20));
        // A word that could be read otherwise is the parser's: it has the whole row of them.
        let odd = object.contains("material material");
        assert_eq!(taken(&text), (if odd { 0 } else { 19 }, 20), "{object}");
        compare(&text);
    }
}

#[test]
fn every_scene_of_ours_is_read_alike() {
    let mut count = 0;
    for folder in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes")).unwrap() {
        let Ok(scenes) = fs::read_dir(folder.unwrap().path()) else {
            continue;
        };
        for scene in scenes {
            let Ok(text) = fs::read_to_string(scene.unwrap().path()) else {
                continue;
            };
            compare(&text);
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn a_long_text_is_read_by_all_and_what_is_wrong_in_it_is_said_alike() {
    let sphere = |n: usize| {
        format!("sphere s{n} {{ material green center {n}.25 -{n} 3e1 radius 0.{n} }}\n")
    };
    let mut text = String::from(HEAD);
    text.extend((1..30_000).map(sphere));
    assert!(text.len() > super::super::bulk::MANY);
    let scene = parse("scene", text.as_bytes(), Path::new("")).unwrap();
    assert_eq!(scene.objects.len(), 29_999);
    assert_eq!(Ok(scene), told(&text, Starts::default()));
    let wrong = text.replacen("radius 0.29000 ", "radius -1 ", 1);
    assert_ne!(text, wrong);
    let said = |starts| told(&wrong, starts).unwrap_err();
    assert_eq!(said(Starts::of(wrong.as_bytes())), said(Starts::default()));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2_000, ..ProptestConfig::default() })]

    #[test]
    fn random_and_damaged_scenes_are_read_alike(
        objects in prop::collection::vec(prop::sample::select(OBJECTS), 1..12),
        edits in prop::collection::vec(
            (any::<prop::sample::Index>(), 0..4_u8, prop::sample::select(WORDS)),
            0..4,
        ),
        lines in any::<bool>(),
    ) {
        let text = format!("{HEAD}{}", objects.join(if lines { "\n" } else { " " }));
        let mut tokens: Vec<&str> = text.split(' ').collect();
        for (index, edit, word) in edits {
            let at = index.index(tokens.len());
            match edit {
                0 => drop(tokens.remove(at)),
                1 => tokens[at] = word,
                2 => tokens.insert(at, word),
                _ => tokens.swap(at, 0),
            }
        }
        compare(&tokens.join(" "));
    }
}

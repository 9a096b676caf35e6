//! Pictures in parts, without a cluster: `--part` and `plumb join`.

use std::fs;

use super::desk::{Desk, LIT, Ran, scenes};

const PART: &str = "a.png.parts/a.2-of-3.plumbpart";

/// Makes a part of a scene's picture.
#[track_caller]
fn part(desk: &Desk, scene: &str, output: &str, part: &str, options: &[&str]) -> Ran {
    let args = [
        "render",
        scene,
        "-o",
        output,
        "--part",
        part,
        "--backend",
        "cpu",
    ];
    desk.run(&[&args[..], options].concat()).ends(0)
}

/// A desk with three parts of a picture.
fn parts(output: &str, options: &[&str]) -> Desk {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    for number in ["2/3", "3/3", "1/3"] {
        part(&desk, "lit.txt", output, number, options);
    }
    desk
}

/// Whatever is asked for, the picture of parts is the file that is rendered in one piece, to the byte.
#[test]
fn parts_are_joined_into_the_same_file() {
    for (output, options) in [
        ("a.png", &[][..]),
        ("a.ppm", &["--samples", "3", "--jitter", "course"]),
        ("a.exr", &["--rows", "4..27"]),
        (
            "a.png",
            &[
                "--samples",
                "2",
                "--screen-tolerance",
                "0.1",
                "--size",
                "31x17",
            ],
        ),
    ] {
        let desk = parts(output, options);
        let joined = desk.run(&["join", output, "--remove"]).ends(0);
        assert!(joined.stderr.contains(", 3 parts, "), "{}", joined.stderr);
        let whole = format!("whole.{}", &output[2..]);
        let args = ["render", "lit.txt", "-o", &whole, "--backend", "cpu"];
        desk.run(&[&args[..], options].concat()).ends(0);
        assert_eq!(desk.read(output), desk.read(&whole), "{output} {options:?}");
        let mut names = vec![
            output.to_owned(),
            "lit.txt".into(),
            "room.txt".into(),
            whole,
        ];
        names.sort();
        assert_eq!(desk.names(), names);
    }
}

/// The values of an EXR are the CPU's: it is not advised what parts cannot have.
#[test]
fn parts_with_values_are_made_without_a_word() {
    let desk = Desk::new();
    let made = desk
        .run(&["render", "room.txt", "-o", "a.exr", "--part", "1/3"])
        .ends(0);
    assert!(!made.stderr.contains("--precision"), "{}", made.stderr);
    assert_eq!(made.stderr.lines().count(), 1, "{}", made.stderr);
}

/// Stdout and devices get nothing before all is known to be right.
#[test]
fn streams_get_a_picture_that_is_right_or_nothing() {
    let desk = parts("a.png", &[]);
    desk.run(&["render", "lit.txt", "-o", "whole.ppm", "--backend", "cpu"])
        .ends(0);
    let join = ["join", "-", "--parts-in", "a.png.parts"];
    assert_eq!(desk.run(&join).ends(0).stdout, desk.read("whole.ppm"));
    desk.run(&["join", "/dev/null", "--parts-in", "a.png.parts"])
        .ends(0);
    desk.run(&["join", "/dev/full", "--parts-in", "a.png.parts"])
        .fails_with(&["no space left"]);
    let mut bytes = desk.read(PART);
    let last = bytes.len() - 150;
    bytes[last] ^= 4;
    fs::write(desk.path(PART), bytes).unwrap();
    assert_eq!(desk.run(&join).ends(1).text(), "2\n");
    assert_eq!(desk.run(&["join", "a.png"]).ends(1).text(), "2\n");
    assert!(!desk.path("a.png").exists());
}

/// A part is made again where it is not right, and only there.
#[test]
fn a_part_that_is_right_is_kept() {
    let desk = parts("a.png", &[]);
    let good = desk.read(PART);
    let render = |options: &[&str]| part(&desk, "lit.txt", "a.png", "2/3", options);
    let kept = render(&[]);
    assert!(
        kept.stderr.contains("is there and right"),
        "{}",
        kept.stderr
    );
    let json = render(&["--json"]).text();
    assert!(json.contains("\"made\": false"), "{json}");
    // Every byte counts: where it is another, the part is another.
    for at in (0..good.len())
        .step_by(good.len() / 25)
        .chain([good.len() - 1])
    {
        let mut bytes = good.clone();
        bytes[at] ^= 0x10;
        fs::write(desk.path(PART), &bytes).unwrap();
        let made = render(&[]);
        assert!(
            made.stderr.contains("; it is made again"),
            "{at}: {}",
            made.stderr
        );
        assert_eq!(desk.read(PART), good, "{at}");
    }
    for (bytes, why) in [
        (&good[..good.len() - 1], "cut short"),
        (&good[..40], "cut short"),
        (&[][..], "cut short"),
        (&[&good[..], b"x"].concat(), "too long"),
        (&[b'x'; 4000], "no part of a picture"),
    ] {
        fs::write(desk.path(PART), bytes).unwrap();
        let made = render(&[]);
        assert!(made.stderr.contains(why), "{}", made.stderr);
        assert_eq!(desk.read(PART), good);
    }
    // Another scene, other settings.
    let names = LIT
        .replace("material glass", "# a comment\nmaterial glass")
        .replace("stone", "rock");
    desk.write("lit.txt", &names);
    let kept = render(&[]);
    assert!(
        kept.stderr.contains("is there and right"),
        "{}",
        kept.stderr
    );
    for options in [
        &["--samples", "2"][..],
        &["--max-path", "3"],
        &["--rows", "1.."],
    ] {
        let made = render(options);
        assert!(
            made.stderr.contains("of another picture"),
            "{}",
            made.stderr
        );
        assert_ne!(desk.read(PART), good);
        render(&[]);
    }
    desk.write("lit.txt", &LIT.replace("radius 0.7", "radius 0.71"));
    let made = render(&[]);
    assert!(
        made.stderr.contains("of another picture"),
        "{}",
        made.stderr
    );
    // Parts of two scenes: all are named, as only the scene tells which is wanted.
    let told = desk.run(&["join", "a.png"]).ends(1);
    assert_eq!(told.text(), "1-3\n");
    assert!(
        told.stderr.contains("parts of 2 pictures"),
        "{}",
        told.stderr
    );
}

/// What a texture's file holds is a part of the scene.
#[test]
fn a_texture_is_a_part_of_the_scene() {
    let desk = Desk::new();
    let picture = "texture wood { filename wood.ppm }\n\
        texplane frame { material grey normal 0 0 1 point 2 2 -2 xdir 1 0 0 dimensions 2 1 texname wood mode 0 }\n";
    desk.write("framed.txt", &[super::desk::ROOM, picture].concat());
    for (texels, made) in [(b"abcdef", true), (b"abcdef", false), (b"abcdeg", true)] {
        fs::write(
            desk.path("wood.ppm"),
            [&b"P6 2 1 255\n"[..], texels].concat(),
        )
        .unwrap();
        let told = part(&desk, "framed.txt", "a.ppm", "1/2", &[]).stderr;
        assert_eq!(told.contains("is there and right"), !made, "{told}");
    }
}

/// The list of what is missing is what `--array` takes.
#[test]
fn what_is_missing_is_listed() {
    let desk = Desk::new();
    desk.run(&["join", "a.ppm"])
        .fails_with(&["no parts of this picture", "--parts"]);
    let join = ["join", "a.ppm", "--parts", "20"];
    assert_eq!(desk.run(&join).ends(1).text(), "1-20\n");
    for number in ["1/20", "2/20", "5/20", "17/20", "20/20"] {
        part(&desk, "room.txt", "a.ppm", number, &[]);
    }
    let told = desk.run(&["join", "a.ppm"]).ends(1);
    assert_eq!(told.text(), "3-4,6-16,18-19\n");
    assert!(!desk.path("a.ppm").exists());
    let last = |told: &Ran| told.stderr.lines().last().unwrap().to_owned();
    assert_eq!(
        last(&told),
        "plumb: a.ppm is not made: 15 parts are to be made, of 20"
    );
    // Who only asks wants no picture.
    let told = desk.run(&["join", "a.ppm", "--check"]).ends(1);
    assert_eq!(last(&told), "plumb: 15 parts are to be made, of 20");
    // Parts of another cut beside them.
    part(&desk, "room.txt", "a.ppm", "1/2", &[]);
    desk.run(&["join", "a.ppm"])
        .fails_with(&["into 2 and 20 parts", "--parts"]);
    let told = desk.run(&["join", "a.ppm", "--parts", "2"]).ends(1);
    assert_eq!(told.text(), "2\n");
    assert!(
        told.stderr.contains("this part is not in a.ppm.parts: 2\n"),
        "{}",
        told.stderr
    );
    // Bytes are no values.
    part(&desk, "room.txt", "a.ppm", "2/2", &[]);
    desk.run(&["join", "a.exr", "--parts", "2", "--parts-in", "a.ppm.parts"])
        .fails_with(&["the parts have bytes"]);
    desk.run(&["join", "a.png", "--parts", "2", "--parts-in", "a.ppm.parts"])
        .ends(0);
}

#[test]
fn what_parts_cannot_have_is_refused() {
    let desk = Desk::new();
    let render =
        |options: &[&str]| desk.run(&[&["render", "room.txt", "-o", "a.png"], options].concat());
    for (options, words) in [
        (
            &["--part", "1/31"][..],
            &["31 parts are too many for a picture of 30 rows"][..],
        ),
        (&["--part", "0/3"], &["like 3/16"]),
        (&["--part", "1/3", "--resume"], &["cannot be used with"]),
        (&["--parts-in", "x"], &["--part and --resume"]),
        (
            &["--part", "1/3", "--precision", "fast"],
            &["other bytes on every device"],
        ),
        (&["--resume", "--verdicts", "v.png"], &["in one piece"]),
        (&["--resume", "-o", "-"], &[]),
        (
            &["--part", "1/3", "--parts-in", "room.txt"],
            &["cannot make the folder"],
        ),
        // On a node where a disk is missing, parts must not be made elsewhere.
        (
            &["--part", "1/3", "--parts-in", "nowhere/parts"],
            &["the folder nowhere does not exist"],
        ),
    ] {
        render(options).fails_with(words);
    }
    desk.run(&["render", "room.txt", "-o", "nowhere/a.png", "--part", "1/3"])
        .fails_with(&[
            "cannot make the folder",
            "the folder nowhere does not exist",
        ]);
    desk.run(&["render", "room.txt", "-o", "-", "--part", "1/2"])
        .fails_with(&["give one with -o"]);
    assert_eq!(desk.names(), ["room.txt"]);
}

/// The bytes of some pictures: where they are others, the rules are others, and `parts::RULES` has to be raised.
#[test]
fn the_rules_have_a_version() {
    use sha2::{Digest, Sha256};
    assert_eq!(plumb::parts::RULES, 1);
    let desk = Desk::new();
    let mut hash = Sha256::new();
    for scene in [
        "notes/walls.txt",
        "notes/tiles.txt",
        "notes/procedural.txt",
        "hard/everything_at_once.txt",
    ] {
        let path = scenes().join(scene);
        let args = [
            "render",
            path.to_str().unwrap(),
            "-o",
            "-",
            "--size",
            "40x30",
            "--samples",
            "2",
        ];
        hash.update(
            desk.run(&[&args[..], &["--backend", "cpu"]].concat())
                .ends(0)
                .stdout,
        );
    }
    let hash: String = hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    assert_eq!(
        hash, "9d0b421a3d053acca0e140acd9db896d1e79928e68cb1a97df7ff9c1ce4b13ad",
        "the rules have changed"
    );
}

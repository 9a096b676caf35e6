//! What the options of `plumb render` change, and which of their values are refused.

use std::fs;

use sha2::{Digest, Sha256};

use super::desk::{Desk, ROOM, ppm, scenes};
use super::lit::rendered;

#[test]
fn the_size_is_in_place_of_pixeldim() {
    let desk = Desk::new();
    let picture = desk
        .run(&[
            "render",
            "room.txt",
            "-o",
            "-",
            "--size",
            "7x5",
            "--backend",
            "cpu",
        ])
        .ends(0);
    assert_eq!((ppm(&picture.stdout).0, ppm(&picture.stdout).1), (7, 5));
    desk.write("small.txt", &ROOM.replace("pixeldim 40 30", "pixeldim 7 5"));
    let small = desk
        .run(&["render", "small.txt", "-o", "-", "--backend", "cpu"])
        .ends(0);
    assert_eq!(picture.stdout, small.stdout);
    assert!(
        desk.run(&["dump", "room.txt", "--size", "7x5"])
            .ends(0)
            .text()
            .contains("7  5")
    );
    let (a, b) = (
        desk.run(&["probe", "room.txt", "6", "4", "--size", "7x5"]),
        desk.run(&["probe", "small.txt", "6", "4"]),
    );
    assert_eq!(a.ends(0).text().replace("room", "small"), b.ends(0).text());
}

#[test]
fn rows_glued_together_are_the_whole() {
    let desk = Desk::new();
    let render = |rows: &[&str]| {
        let args = [&["render", "room.txt", "-o", "-", "--backend", "cpu"], rows].concat();
        desk.run(&args).ends(0).stdout
    };
    let whole = render(&[]);
    let mut glued = Vec::new();
    for (rows, height) in [("17..", 13), ("16..17", 1), ("..16", 16)] {
        let piece = render(&["--rows", rows]);
        let (width, rows, bytes) = ppm(&piece);
        assert_eq!((width, rows), (40, height));
        glued.extend_from_slice(bytes);
    }
    assert_eq!(ppm(&whole).2, glued);
}

#[test]
fn option_values_that_make_no_sense_are_refused_with_the_mend() {
    let desk = Desk::new();
    let cases: [(&[&str], &str); 28] = [
        (&["--rows", "0..31"], "at most 30"),
        (&["--rows", "5..5"], "less than B"),
        (&["--rows", "5"], "like 0..120"),
        (&["--rows", "30.."], "at most 29"),
        (&["--rows", ".."], "like 0..120"),
        (&["--size", "640"], "like 640x480"),
        (&["--band-rows", "0"], "a whole number from 1 to"),
        (&["--band-rows", "x"], "a whole number from 1 to"),
        (&["--precision", "exact"], "certified, fast"),
        (&["--precision", "fast", "--strict"], "--strict"),
        (&["--backend", "gpu", "-o", "a.exr"], "--precision fast"),
        (
            &["--precision", "fast", "--verdicts", "a.png"],
            "decides none",
        ),
        (&["--verdicts", "a.exr"], ".png or .ppm"),
        (&["--verdicts", "a.gif"], ".png or .ppm"),
        (&["--verdicts", "-"], ".png or .ppm"),
        (&["--verdicts", "room.ppm"], "the picture itself"),
        (&["--size", "0x1"], "1 to 1000000"),
        (&["--size", "1000001x1"], "1 to 1000000"),
        (&["--threads", "0"], "from 1"),
        (&["--threads", "many"], "from 1"),
        (&["--samples", "many"], "a whole number from 1 to 65536"),
        (&["--screen-tolerance", "nan"], "finite"),
        (&["--backend", "cuda"], "auto, gpu, cpu"),
        (&["--backend", "cpu", "--adapter", "x"], "--backend cpu"),
        (&["--debug", "pix,hot"], "hit"),
        (&["-o", "a.jpg"], ".png"),
        (&["-o", "missing/a.ppm"], "does not exist"),
        (&["-o", "missing/"], "mkdir -p missing/"),
    ];
    for (args, mend) in cases {
        desk.run(&[&["render", "room.txt"], args].concat())
            .fails_with(&[mend]);
    }
    assert_eq!(desk.names(), ["room.txt"]);
}

#[test]
fn the_scene_is_not_overwritten() {
    let desk = Desk::new();
    fs::rename(desk.path("room.txt"), desk.path("room.ppm")).unwrap();
    desk.run(&["render", "room.ppm"])
        .fails_with(&["the scene itself"]);
    desk.run(&["render", "room.ppm", "-o", "./room.ppm"])
        .fails_with(&["the scene itself"]);
    assert_eq!(desk.read("room.ppm"), ROOM.as_bytes());
}

#[test]
fn the_report_is_json_and_knows_the_hash() {
    let desk = Desk::new();
    let ran = desk
        .run(&[
            "render",
            "room.txt",
            "--backend",
            "cpu",
            "--json",
            "--rows",
            "3..10",
        ])
        .ends(0);
    assert_eq!(ran.stderr, "");
    let json: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    let hash: String = Sha256::digest(desk.read("room.ppm"))
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    assert_eq!(json["sha256"], hash);
    assert_eq!(
        (&json["scene"], &json["output"]),
        (&"room.txt".into(), &"room.ppm".into())
    );
    assert_eq!(
        (&json["backend"], &json["rows"]),
        (&"cpu".into(), &serde_json::json!([3, 10]))
    );
    assert_eq!(json["bytes"], desk.read("room.ppm").len());
    // With the picture on stdout the report is on stderr, alone.
    let ran = desk.pipe(&["--backend", "cpu", "--json"], ROOM).ends(0);
    let json: serde_json::Value = serde_json::from_str(&ran.stderr).unwrap();
    assert_eq!(json["output"], "stdout");
    assert_eq!(ppm(&ran.stdout).1, 30);
}

#[test]
fn a_png_tells_what_changes_its_bytes_and_nothing_else() {
    let desk = Desk::new();
    let render = |out: &str, scene: &str| {
        desk.run(&[
            "render",
            scene,
            "--backend",
            "cpu",
            "-o",
            out,
            "--rows",
            "1..9",
            "--size",
            "20x10",
        ])
        .ends(0);
        desk.read(out)
    };
    fs::create_dir(desk.path("sub")).unwrap();
    desk.write("sub/room.txt", ROOM);
    let png = render("a.png", "room.txt");
    assert_eq!(png, render("b.png", "sub/room.txt"));
    let has = |text: &str| {
        png.windows(text.len())
            .any(|window| window == text.as_bytes())
    };
    for text in [
        "Software\0",
        concat!("plumb ", env!("CARGO_PKG_VERSION")),
        "plumb:scene",
        "room.txt",
        "20x10",
        "1..9",
        "plumb:precision",
        "certified",
    ] {
        assert!(has(text), "{text}");
    }
    assert!(!has("sub/"));
}

#[test]
fn the_debug_listing_is_on_stderr_and_keeps_to_the_rows() {
    let desk = Desk::new();
    let scene = scenes().join("notes/debug.txt");
    let args = [
        "render",
        scene.to_str().unwrap(),
        "--backend",
        "cpu",
        "--debug",
        "pix,hit",
        "--rows",
        "16..17",
        "-o",
        "-",
        "-q",
    ];
    let ran = desk.run(&args).ends(0);
    assert_eq!(ppm(&ran.stdout).1, 1);
    let lines: Vec<&str> = ran.stderr.split('\n').collect();
    assert_eq!((lines.len(), lines[0], lines[65]), (66, "", ""));
    assert_eq!(
        lines[22],
        "PIX   21   16 - leftwall     HIT:(  1.3,   1.4,  -4.0)"
    );
    assert_eq!(
        lines[41],
        "PIX   40   16 - rightwall    HIT:(  6.4,   1.2,  -4.8)"
    );
}

#[test]
fn values_of_the_options_about_light_are_checked() {
    let (desk, picture) = rendered(&[]);
    let cases: [(&[&str], &str); 12] = [
        (&["--samples", "0"], "from 1 to 65536"),
        (&["--samples", "65537"], "from 1 to 65536"),
        (&["--samples", "4.5"], "from 1 to 65536"),
        (&["--jitter", "blue"], "hash, course"),
        (&["--max-path", "-1"], "0 or more"),
        (&["--max-path", "nan"], "0 or more"),
        (&["--max-path", "inf"], "0 or more"),
        (&["--max-path", "far"], "like 20"),
        (&["--max-rays", "0"], "--max-rays"),
        (&["--max-rays", "4294967296"], "from 1 to 4294967295"),
        (
            &["--samples", "2", "--debug", "pix"],
            "leave one of them out",
        ),
        (
            &[
                "--samples",
                "65536",
                "--jitter",
                "course",
                "--size",
                "1000000x1",
            ],
            "--jitter hash",
        ),
    ];
    for (args, mend) in cases {
        desk.run(&[&["render", "lit.txt", "-o", "a.ppm"], args].concat())
            .fails_with(&[mend]);
    }
    for (path, same) in [("20.0", true), ("1e6", true), ("1e300", true), ("0", false)] {
        let args = ["render", "lit.txt", "--backend", "cpu", "-o", "-", "-q"];
        let ran = desk
            .run(&[&args[..], &["--max-path", path]].concat())
            .ends(0);
        assert_eq!(same, ran.stdout == picture, "{path}");
    }
    assert_eq!(desk.names(), ["lit.txt", "room.txt"]);
}

#[test]
fn reports_say_what_of_the_light_changes_the_bytes() {
    let (desk, _) = rendered(&[]);
    let report = |scene: &str, options: &[&str]| -> serde_json::Value {
        let args = ["render", scene, "--backend", "cpu", "--json", "-o", "a.png"];
        let ran = desk.run(&[&args[..], options].concat()).ends(0);
        serde_json::from_slice(&ran.stdout).unwrap()
    };
    let in_png = |text: &str| {
        let png = desk.read("a.png");
        png.windows(text.len()).any(|part| part == text.as_bytes())
    };
    let json = report("lit.txt", &["--samples", "2", "--max-path", "7.5"]);
    assert_eq!(
        (&json["samples"], &json["jitter"]),
        (&2.into(), &"hash".into())
    );
    assert_eq!(json["max_path"], 7.5);
    assert!(in_png("plumb:samples\u{0}2") && in_png("plumb:jitter\u{0}hash"));
    assert!(in_png("plumb:max-path\u{0}7.5") && !in_png("max-rays"));
    // What has no say in the picture is not told.
    let json = report("room.txt", &["--jitter", "course"]);
    let nothing = &serde_json::Value::Null;
    assert_eq!((&json["jitter"], &json["max_path"]), (nothing, nothing));
    assert!(!in_png("plumb:jitter") && !in_png("plumb:max-path"));
}

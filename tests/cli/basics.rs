//! What everybody meets first: version, help, completions, where picture and talk go, the filter use.

use std::fs;

use super::desk::{Desk, ROOM, ppm};

#[test]
fn the_version_names_the_commit() {
    let ran = Desk::new().run(&["--version"]).ends(0);
    let text = ran.text();
    let commit = text
        .strip_prefix(concat!("plumb ", env!("CARGO_PKG_VERSION"), " ("))
        .unwrap();
    assert!(
        commit
            .strip_suffix(")\n")
            .is_some_and(|commit| commit.len() >= 7),
        "{text}"
    );
    assert_eq!(ran.stderr, "");
}

#[test]
fn help_teaches() {
    let desk = Desk::new();
    let text = desk.run(&["--help"]).ends(0).text();
    for word in [
        "EXAMPLES",
        "EXIT CODES",
        "THE SCENE LANGUAGE",
        "docs/SCENE.md",
        "plumb < scene.txt > picture.ppm",
    ] {
        assert!(text.contains(word), "no {word:?} in {text}");
    }
    for command in [
        "render",
        "check",
        "dump",
        "probe",
        "compare",
        "bench",
        "doctor",
        "completions",
    ] {
        let help = desk.run(&[command, "--help"]).ends(0);
        assert!(help.text().contains("Usage: plumb"), "{command}");
        assert_eq!(help.stderr, "");
    }
}

#[test]
fn completions_for_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = Desk::new().run(&["completions", shell]).ends(0).text();
        assert!(
            text.contains("plumb") && text.contains("screen-tolerance"),
            "{shell}"
        );
    }
    Desk::new()
        .run(&["completions", "tcsh"])
        .fails_with(&["bash", "zsh"]);
}

#[test]
fn quiet_is_quiet() {
    let ran = Desk::new()
        .run(&["render", "room.txt", "--backend", "cpu", "--quiet"])
        .ends(0);
    assert_eq!((ran.text(), ran.stderr), (String::new(), String::new()));
}

#[test]
fn a_dash_is_stdout() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu"])
        .ends(0);
    let file = desk.read("room.ppm");
    for args in [
        ["render", "room.txt", "-o", "-"],
        ["render", "room.txt", "-o", "/dev/stdout"],
    ] {
        let ran = desk
            .run(&[&args[..], &["--backend", "cpu"]].concat())
            .ends(0);
        assert_eq!(ran.stdout, file);
    }
    assert_eq!(desk.names(), ["room.ppm", "room.txt"]);
    // A scene on stdin has no name to give: its picture goes to stdout.
    assert_eq!(
        desk.pipe(&["render", "-", "--backend", "cpu"], ROOM)
            .ends(0)
            .stdout,
        file
    );
}

#[test]
fn the_scenes_name_names_the_picture_which_lies_here() {
    let desk = Desk::new();
    fs::create_dir(desk.path("sub")).unwrap();
    fs::rename(desk.path("room.txt"), desk.path("sub/room.v2.txt")).unwrap();
    let ran = desk
        .run(&[
            "render",
            "sub/room.v2.txt",
            "--backend",
            "cpu",
            "--threads",
            "1",
        ])
        .ends(0);
    assert_eq!(desk.names(), ["room.v2.ppm", "sub"]);
    let (width, height, bytes) = (40, 30, desk.read("room.v2.ppm"));
    assert_eq!(ppm(&bytes).0, width);
    assert_eq!(ppm(&bytes).2.len(), 3 * width as usize * height);
    assert_eq!(ran.text(), "");
    assert!(
        ran.stderr
            .starts_with("room.v2.ppm: 40×30, CPU, 1 thread, "),
        "{}",
        ran.stderr
    );
    assert_eq!(ran.stderr.lines().count(), 1);
}

#[test]
fn the_filter_lists_the_model_and_writes_the_picture() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu"])
        .ends(0);
    let ran = desk.pipe(&["--backend", "cpu"], ROOM).ends(0);
    assert_eq!(ran.stdout, desk.read("room.ppm"));
    let listing = desk.run(&["dump", "room.txt"]).ends(0).text();
    assert!(
        listing.starts_with("camera") && listing.contains("tiled_plane"),
        "{listing}"
    );
    assert!(ran.stderr.starts_with(&listing), "{}", ran.stderr);
    let quiet = desk
        .pipe(&["--backend", "cpu", "--quiet", "--size", "8x6"], ROOM)
        .ends(0);
    assert_eq!(quiet.stderr, "");
    assert_eq!(ppm(&quiet.stdout).0, 8);
}

#[test]
fn the_filter_without_input_helps() {
    let desk = Desk::new();
    desk.run(&[]).fails_with(&["Usage: plumb", "render"]);
    desk.run(&["--quiet"]).fails_with(&["Usage: plumb"]);
    desk.pipe(&[], "\n").fails_with(&["<stdin>:", "no camera"]);
    assert_eq!(desk.names(), ["room.txt"]);
}

#[test]
fn a_scene_in_place_of_a_command_is_understood() {
    Desk::new()
        .run(&["room.txt"])
        .fails_with(&["room.txt", "plumb render room.txt"]);
}

#[test]
fn a_picture_behind_the_scene_is_understood() {
    Desk::new()
        .run(&["render", "room.txt", "out.png"])
        .fails_with(&["out.png", "-o out.png"]);
}

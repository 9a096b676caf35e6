//! The program as it is used: what it reads, what it prints where, which exit code it ends with, what it leaves behind.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use sha2::{Digest, Sha256};
use tempfile::TempDir;

/// A room with a wall, a sphere and tiles; small, and no two rows alike.
const ROOM: &str = "\
camera cam { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
material green { ambient 0 5 0 }
material red { ambient 6 1 1 }
material grey { ambient 3 3 3 }
plane wall { material green normal 3 0 1 point 0 0 0 }
tiled_plane floor { material grey normal 0 1 0 point 0 -0.2 0 altmaterial red dimension 1.5 1.5 }
sphere ball { material red center 5 3 -4 radius 2 }
";

/// The same with what is not rendered yet.
const LIT: &str = "light lamp { location 4 5 1 emissivity 1 1 1 }\n";

/// A folder of its own, with a scene in it, in which the program runs.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn new() -> Self {
        let desk = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        desk.write("room.txt", ROOM);
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plumb"));
        command
            .args(args)
            .current_dir(self.folder.path())
            .env_remove("RUST_LOG")
            .stdin(Stdio::null());
        command
    }

    fn run(&self, args: &[&str]) -> Ran {
        Ran::new(args, self.command(args).output().unwrap())
    }

    fn pipe(&self, args: &[&str], input: &str) -> Ran {
        let mut command = self.command(args);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(input.as_bytes())
            .unwrap();
        Ran::new(args, child.wait_with_output().unwrap())
    }

    /// Names of all there is, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// How a run ended.
struct Ran {
    args: String,
    code: Option<i32>,
    stdout: Vec<u8>,
    stderr: String,
}

impl Ran {
    fn new(args: &[&str], output: Output) -> Self {
        let stderr = String::from_utf8(output.stderr).unwrap();
        Self {
            args: args.join(" "),
            code: output.status.code(),
            stdout: output.stdout,
            stderr,
        }
    }

    #[track_caller]
    fn ends(self, code: i32) -> Self {
        assert_eq!(
            self.code,
            Some(code),
            "plumb {}: {}",
            self.args,
            self.stderr
        );
        self
    }

    /// Failed as it should: exit 2, nothing on stdout, these words on stderr.
    #[track_caller]
    fn fails_with(self, words: &[&str]) {
        let ran = self.ends(2);
        assert_eq!(ran.text(), "", "plumb {}", ran.args);
        for word in words {
            assert!(
                ran.stderr.contains(word),
                "plumb {}: no {word:?} in {}",
                ran.args,
                ran.stderr
            );
        }
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(&self.stdout).into_owned()
    }
}

/// Header and bytes of a PPM.
fn ppm(bytes: &[u8]) -> (u32, u32, &[u8]) {
    let end = bytes.iter().position(|&byte| byte == b'\n').unwrap();
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let words: Vec<&str> = header.split(' ').collect();
    assert_eq!((words[0], words[3]), ("P6", "255"), "{header}");
    (
        words[1].parse().unwrap(),
        words[2].parse().unwrap(),
        &bytes[end + 1..],
    )
}

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

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
    for (rows, height) in [("17..30", 13), ("16..17", 1), ("0..16", 16)] {
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
    let cases: [(&[&str], &str); 14] = [
        (&["--rows", "0..31"], "at most 30"),
        (&["--rows", "5..5"], "less than B"),
        (&["--rows", "5"], "like 0..120"),
        (&["--size", "640"], "like 640x480"),
        (&["--size", "0x1"], "1 to 1000000"),
        (&["--size", "1000001x1"], "1 to 1000000"),
        (&["--threads", "0"], "from 1"),
        (&["--screen-tolerance", "nan"], "finite"),
        (&["--backend", "cuda"], "auto, gpu, cpu"),
        (&["--backend", "cpu", "--adapter", "x"], "--backend cpu"),
        (&["--debug", "pix,hot"], "hit"),
        (&["-o", "a.jpg"], ".png"),
        (&["-o", "missing/a.ppm"], "does not exist"),
        (&["-o", "."], "folder"),
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
fn errors_name_their_place_and_leave_nothing() {
    let desk = Desk::new();
    desk.write(
        "bad.txt",
        &ROOM.replace("material red center", "material rde center"),
    );
    let place = ["error", "bad.txt:7:24", "did you mean `red`", "^"];
    desk.run(&["render", "bad.txt"]).fails_with(&place);
    desk.run(&["render", "bad.txt", "-o", "-"])
        .fails_with(&place);
    desk.run(&["probe", "bad.txt", "1", "1"]).fails_with(&place);
    desk.run(&["dump", "bad.txt"]).fails_with(&place);
    desk.pipe(&[], &String::from_utf8(desk.read("bad.txt")).unwrap())
        .fails_with(&["<stdin>:7:24"]);
    desk.run(&["render", "none.txt"])
        .fails_with(&["plumb: error: none.txt: there is no such file"]);
    desk.run(&["render", "."]).fails_with(&["directory"]);
    assert_eq!(desk.names(), ["bad.txt", "room.txt"]);
}

#[test]
fn what_is_not_rendered_yet_says_so() {
    let desk = Desk::new();
    desk.write("lit.txt", &(ROOM.to_owned() + LIT));
    let words = ["plumb: error: lit.txt: not rendered yet", "lamp"];
    desk.run(&["render", "lit.txt"]).fails_with(&words);
    desk.run(&["render", "lit.txt", "-o", "-"])
        .fails_with(&words);
    desk.run(&["probe", "lit.txt", "0", "0"]).fails_with(&words);
    assert_eq!(
        desk.run(&["check", "lit.txt"]).ends(0).text(),
        "lit.txt: ok (3 objects, 1 light, 40×30)\n"
    );
    assert_eq!(desk.names(), ["lit.txt", "room.txt"]);
}

#[test]
fn check_tells_every_error_of_every_file() {
    let desk = Desk::new();
    desk.write(
        "bad.txt",
        &ROOM
            .replace("radius 2", "radius -2")
            .replace("0 5 0", "0 x 0"),
    );
    let ran = desk
        .run(&["check", "bad.txt", "room.txt", "none.txt"])
        .ends(2);
    assert_eq!(ran.text(), "room.txt: ok (3 objects, 0 lights, 40×30)\n");
    for place in ["bad.txt:2:28", "bad.txt:7:49", "none.txt"] {
        assert!(ran.stderr.contains(place), "{place}: {}", ran.stderr);
    }
    let ran = desk
        .run(&["check", "--json", "bad.txt", "room.txt", "none.txt"])
        .ends(2);
    assert_eq!(ran.stderr, "");
    let json: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(json[0]["ok"], false);
    assert_eq!(json[0]["errors"].as_array().unwrap().len(), 2);
    assert_eq!(
        (
            &json[0]["errors"][0]["line"],
            &json[0]["errors"][0]["column"]
        ),
        (&2.into(), &28.into())
    );
    assert_eq!(
        (&json[1]["ok"], &json[1]["objects"]),
        (&true.into(), &3.into())
    );
    assert_eq!(json[2]["errors"][0]["line"], serde_json::Value::Null);
    assert_eq!(
        desk.pipe(&["check", "-"], ROOM).ends(0).text(),
        "<stdin>: ok (3 objects, 0 lights, 40×30)\n"
    );
}

#[test]
fn compare_finds_a_difference_of_one_and_equality() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "a.ppm"])
        .ends(0);
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "b.png"])
        .ends(0);
    let same = desk.run(&["compare", "a.ppm", "b.png"]).ends(0);
    assert!(
        same.text().contains("are the same: 40×30"),
        "{}",
        same.text()
    );
    let mut bytes = desk.read("a.ppm");
    // Green of pixel (3, 28): the second row from the top.
    let at = bytes.len() - 3 * 40 * 30 + 3 * (40 + 3) + 1;
    bytes[at] ^= 1;
    fs::write(desk.path("c.ppm"), &bytes).unwrap();
    let differ = desk
        .run(&["compare", "a.ppm", "c.ppm", "--diff", "d.png"])
        .ends(1)
        .text();
    assert!(
        differ.contains("1 of 1200 (0.0833 %)") && differ.contains("green at (3, 28)"),
        "{differ}"
    );
    assert!(differ.contains("1 apart"), "{differ}");
    assert_eq!(
        plumb::image::read(&desk.path("d.png")).unwrap().rgb[3 * 43..3 * 44],
        [0, 128, 0]
    );
    let json = desk.run(&["compare", "a.ppm", "c.ppm", "--json"]).ends(1);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(
        (&json["same"], &json["comparison"]["different"]),
        (&false.into(), &1.into())
    );
    assert_eq!(json["comparison"]["worst"]["y"], 28);
}

#[test]
fn compare_answers_no_for_sizes_and_fails_for_what_is_no_picture() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "a.ppm"])
        .ends(0);
    desk.run(&[
        "render",
        "room.txt",
        "--backend",
        "cpu",
        "-o",
        "b.ppm",
        "--rows",
        "0..29",
    ])
    .ends(0);
    let sizes = desk
        .run(&["compare", "a.ppm", "b.ppm", "--diff", "d.ppm"])
        .ends(1);
    assert!(sizes.text().contains("40×30 and 40×29"), "{}", sizes.text());
    desk.run(&["compare", "a.ppm", "room.txt"])
        .fails_with(&["plumb: error: cannot read room.txt"]);
    desk.run(&["compare", "a.ppm", "none.ppm"])
        .fails_with(&["none.ppm"]);
    desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "d.exr"])
        .fails_with(&[".png"]);
    desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "b.ppm"])
        .fails_with(&["one of the pictures"]);
    assert_eq!(desk.names(), ["a.ppm", "b.ppm", "room.txt"]);
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
    ] {
        assert!(has(text), "{text}");
    }
    assert!(!has("sub/"));
}

#[test]
fn probe_agrees_with_the_picture() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu"])
        .ends(0);
    let picture = desk.read("room.ppm");
    let bytes = ppm(&picture).2;
    for (x, y) in [
        (0, 0),
        (39, 29),
        (0, 29),
        (25, 15),
        (12, 7),
        (20, 1),
        (33, 4),
    ] {
        let text = desk
            .run(&["probe", "room.txt", &x.to_string(), &y.to_string()])
            .ends(0)
            .text();
        let at = 3 * ((29 - y) * 40 + x);
        let expected = format!(
            "bytes        {} {} {}",
            bytes[at],
            bytes[at + 1],
            bytes[at + 2]
        );
        assert!(
            text.lines().any(|line| line == expected),
            "({x}, {y}): no {expected:?} in {text}"
        );
        let marked = text.lines().filter(|line| line.starts_with("  * ")).count();
        assert_eq!(
            marked,
            usize::from(!text.contains("hit          nothing")),
            "{text}"
        );
        for object in ["wall", "floor", "ball"] {
            assert!(text.contains(object), "{text}");
        }
    }
    desk.run(&["probe", "room.txt", "40", "0"])
        .fails_with(&["columns are 0 to 39"]);
    desk.run(&["probe", "room.txt", "0", "-1"])
        .fails_with(&["rows 0 to 29"]);
}

#[test]
fn probe_lists_only_hits_of_many_objects() {
    let desk = Desk::new();
    let spheres: String = (0..60)
        .map(|i| format!("sphere s{i} {{ material red center {i} 40 -4 radius 0.1 }}\n"))
        .collect();
    desk.write("many.txt", &(ROOM.to_owned() + &spheres));
    let text = desk.run(&["probe", "many.txt", "5", "5"]).ends(0).text();
    assert!(
        text.contains("objects      63, ") && !text.contains(" miss ") && text.contains("--all"),
        "{text}"
    );
    let all = desk
        .run(&["probe", "many.txt", "5", "5", "--all"])
        .ends(0)
        .text();
    assert_eq!(
        all.matches("the ray passes by").count(),
        61 - all.matches("ball  sphere  hit").count(),
        "{all}"
    );
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
fn dump_shows_every_stage() {
    let desk = Desk::new();
    for (stage, word) in [
        ("model", "tiled_plane"),
        ("features", "plane"),
        ("buffers", "records"),
        ("wgsl", "@compute"),
    ] {
        let ran = desk.run(&["dump", "room.txt", "--stage", stage]).ends(0);
        assert!(ran.text().contains(word), "{stage}: {}", ran.text());
        assert_eq!(ran.stderr, "");
    }
}

/// Runs with the reader of stdout gone after the first bytes.
fn with_deaf_reader(desk: &Desk, args: &[&str]) -> (Option<i32>, String) {
    let mut child = desk
        .command(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 2];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn a_broken_pipe_ends_quietly() {
    let desk = Desk::new();
    let render = [
        "render",
        "room.txt",
        "-o",
        "-",
        "--size",
        "1500x1500",
        "--backend",
        "cpu",
    ];
    assert_eq!(with_deaf_reader(&desk, &render), (Some(0), String::new()));
    let materials: String = (0..5000)
        .map(|i| format!("material m{i} {{ ambient 1 1 1 }}\n"))
        .collect();
    desk.write("many.txt", &(materials + ROOM));
    assert_eq!(
        with_deaf_reader(&desk, &["dump", "many.txt"]),
        (Some(0), String::new())
    );
}

#[cfg(unix)]
#[test]
fn devices_are_written_through() {
    use std::os::unix::fs::FileTypeExt;
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "/dev/null"])
        .ends(0);
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert_eq!(desk.names(), ["room.txt"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "/dev/full"])
        .fails_with(&["/dev/full"]);
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    for args in [
        &["render", "room.txt", "--backend", "cpu", "-o", "-"][..],
        &["dump", "room.txt"],
        &["--version"],
    ] {
        let output = desk.command(args).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_nothing_behind() {
    use std::thread::sleep;
    use std::time::{Duration, Instant};
    for signal in ["-INT", "-TERM"] {
        let desk = Desk::new();
        let args = [
            "render",
            "room.txt",
            "--backend",
            "cpu",
            "--size",
            "30000x30000",
            "-o",
            "big.ppm",
        ];
        let mut child = desk.command(&args).stderr(Stdio::piped()).spawn().unwrap();
        let start = Instant::now();
        while desk.names().len() < 2 {
            assert!(
                start.elapsed() < Duration::from_secs(20),
                "no file is being written"
            );
            sleep(Duration::from_millis(5));
        }
        sleep(Duration::from_millis(50));
        let sent = Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status()
            .unwrap();
        assert!(sent.success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(desk.names(), ["room.txt"], "{signal}");
    }
}

/// Needs an adapter, and fails without one: a GPU that is not tested is not known to work.
#[test]
fn the_gpu_renders_what_the_cpu_renders() {
    let desk = Desk::new();
    let scene = scenes().join("notes/walls.txt");
    let scene = scene.to_str().unwrap();
    let ran = desk
        .run(&[
            "render",
            scene,
            "--backend",
            "gpu",
            "-o",
            "gpu.ppm",
            "--json",
        ])
        .ends(0);
    let json: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(json["backend"], "gpu");
    desk.run(&["render", scene, "--backend", "cpu", "-o", "cpu.ppm"])
        .ends(0);
    let compared = desk.run(&["compare", "gpu.ppm", "cpu.ppm", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    assert!(
        json["comparison"]["percent"].as_f64().unwrap() < 0.05,
        "{json}"
    );
}

/// Needs an adapter, and fails without one.
#[test]
fn doctor_names_the_adapter_that_is_used() {
    let desk = Desk::new();
    let text = desk.run(&["doctor"]).ends(0).text();
    assert!(
        text.contains("plumb renders on ") && text.contains("driver") && text.contains("CPU, "),
        "{text}"
    );
    let json: serde_json::Value =
        serde_json::from_slice(&desk.run(&["doctor", "--json"]).ends(0).stdout).unwrap();
    let name = json["adapters"][json["chosen"].as_u64().unwrap() as usize]["name"]
        .as_str()
        .unwrap();
    let part = name.split(' ').next().unwrap().to_uppercase();
    let args = ["render", "room.txt", "--adapter", &part, "--json"];
    let report: serde_json::Value =
        serde_json::from_slice(&desk.run(&args).ends(0).stdout).unwrap();
    assert!(
        report["adapter"].as_str().unwrap().contains(name),
        "{report}"
    );
    desk.run(&["render", "room.txt", "--adapter", "no such adapter"])
        .fails_with(&["no such adapter", name]);
}

/// The loader is told to find no driver at all.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_cpu_renders_and_says_so() {
    let desk = Desk::new();
    let run = |args: &[&str]| {
        let mut command = desk.command(args);
        command
            .env("VK_DRIVER_FILES", "/nonexistent.json")
            .env("VK_ICD_FILENAMES", "/nonexistent.json");
        Ran::new(args, command.output().unwrap())
    };
    let doctor = run(&["doctor"]).ends(1).text();
    assert!(
        doctor.contains("plumb renders on the CPU") && doctor.contains("mesa-vulkan-drivers"),
        "{doctor}"
    );
    run(&["render", "room.txt", "--backend", "gpu", "-o", "-"])
        .fails_with(&["no GPU adapter", "mesa-vulkan-drivers"]);
    let auto = run(&["render", "room.txt"]).ends(0);
    assert_eq!(
        auto.stderr
            .lines()
            .filter(|line| line.contains("so the CPU renders"))
            .count(),
        1,
        "{}",
        auto.stderr
    );
    assert!(
        auto.stderr.contains("mesa-vulkan-drivers"),
        "{}",
        auto.stderr
    );
    assert_eq!(ppm(&desk.read("room.ppm")).1, 30);
    assert_eq!(run(&["render", "room.txt", "--quiet"]).ends(0).stderr, "");
}

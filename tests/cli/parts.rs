//! Pictures in parts, without a cluster: `--part`, `plumb join`, `--resume`.

use std::fs;
use std::process::Stdio;
use std::time::Duration;

use super::desk::{Desk, LIT, scenes};

const PART: &str = "a.png.parts/a.2-of-3.plumbpart";

/// A desk with three parts of a picture.
fn parts(output: &str, options: &[&str]) -> Desk {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    for part in ["2/3", "3/3", "1/3"] {
        let args = [
            "render",
            "lit.txt",
            "-o",
            output,
            "--part",
            part,
            "--backend",
            "cpu",
        ];
        desk.run(&[&args[..], options].concat()).ends(0);
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
    let render = [
        "render",
        "lit.txt",
        "-o",
        "a.png",
        "--part",
        "2/3",
        "--backend",
        "cpu",
    ];
    let kept = desk.run(&render).ends(0);
    assert!(
        kept.stderr.contains("is there and right"),
        "{}",
        kept.stderr
    );
    let json = desk
        .run(&[&render[..], &["--json"]].concat())
        .ends(0)
        .text();
    assert!(json.contains("\"made\": false"), "{json}");
    // Every byte counts: where it is another, the part is another.
    for at in (0..good.len())
        .step_by(good.len() / 25)
        .chain([good.len() - 1])
    {
        let mut bytes = good.clone();
        bytes[at] ^= 0x10;
        fs::write(desk.path(PART), &bytes).unwrap();
        let made = desk.run(&render).ends(0);
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
        let made = desk.run(&render).ends(0);
        assert!(made.stderr.contains(why), "{}", made.stderr);
        assert_eq!(desk.read(PART), good);
    }
    // Another scene, other settings.
    let names = LIT
        .replace("material glass", "# a comment\nmaterial glass")
        .replace("stone", "rock");
    desk.write("lit.txt", &names);
    let kept = desk.run(&render).ends(0);
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
        let made = desk.run(&[&render[..], options].concat()).ends(0);
        assert!(
            made.stderr.contains("of another picture"),
            "{}",
            made.stderr
        );
        assert_ne!(desk.read(PART), good);
        desk.run(&render).ends(0);
    }
    desk.write("lit.txt", &LIT.replace("radius 0.7", "radius 0.71"));
    let made = desk.run(&render).ends(0);
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
    let render = [
        "render",
        "framed.txt",
        "-o",
        "a.ppm",
        "--part",
        "1/2",
        "--backend",
        "cpu",
    ];
    for (texels, made) in [(b"abcdef", true), (b"abcdef", false), (b"abcdeg", true)] {
        fs::write(
            desk.path("wood.ppm"),
            [&b"P6 2 1 255\n"[..], texels].concat(),
        )
        .unwrap();
        let told = desk.run(&render).ends(0).stderr;
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
    for part in ["1/20", "2/20", "5/20", "17/20", "20/20"] {
        desk.run(&[
            "render",
            "room.txt",
            "-o",
            "a.ppm",
            "--part",
            part,
            "--backend",
            "cpu",
        ])
        .ends(0);
    }
    let told = desk.run(&["join", "a.ppm"]).ends(1);
    assert_eq!(told.text(), "3-4,6-16,18-19\n");
    assert!(
        !desk.path("a.ppm").exists() && told.stderr.contains("is not made"),
        "{}",
        told.stderr
    );
    // Parts of another cut beside them.
    desk.run(&[
        "render",
        "room.txt",
        "-o",
        "a.ppm",
        "--part",
        "1/2",
        "--backend",
        "cpu",
    ])
    .ends(0);
    desk.run(&["join", "a.ppm"])
        .fails_with(&["into 2 and 20 parts", "--parts"]);
    assert_eq!(
        desk.run(&["join", "a.ppm", "--parts", "2"]).ends(1).text(),
        "2\n"
    );
    // Bytes are no values.
    desk.run(&[
        "render",
        "room.txt",
        "-o",
        "a.ppm",
        "--part",
        "2/2",
        "--backend",
        "cpu",
    ])
    .ends(0);
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
    ] {
        render(options).fails_with(words);
    }
    desk.run(&["render", "room.txt", "-o", "-", "--part", "1/2"])
        .fails_with(&["give one with -o"]);
    let large = [
        "render",
        "room.txt",
        "-o",
        "a.exr",
        "--size",
        "20000x20000",
        "--part",
        "1/2",
    ];
    desk.run(&large).fails_with(&["kept in memory"]);
    assert_eq!(desk.names(), ["room.txt"]);
}

/// Whenever it is killed, the same command goes on with what there is, and the picture is the same file.
#[cfg(unix)]
#[test]
fn a_killed_rendering_goes_on() {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    let options = ["--backend", "cpu", "--size", "320x240", "--samples", "20"];
    let args = |output| [&["render", "lit.txt", "-o", output][..], &options].concat();
    let resume = [&args("a.png")[..], &["--resume"]].concat();
    // By chance, but the same at every run.
    let mut state = 7_u64;
    let (mut kills, mut kept) = (0, 0);
    while kills < 20 {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let mut command = desk.command(&resume);
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(5 + (state >> 33) % 150));
        child.kill().unwrap();
        kills += usize::from(!child.wait().unwrap().success());
        // One that came to its end is begun again.
        if desk.path("a.png").exists() {
            fs::remove_file(desk.path("a.png")).unwrap();
        }
        let there = fs::read_dir(desk.path("a.png.parts"));
        let whole =
            |name: &std::ffi::OsStr| name.to_str().is_some_and(|name| name.starts_with("a."));
        kept = there.map_or(0, |there| {
            there
                .filter(|part| whole(&part.as_ref().unwrap().file_name()))
                .count()
        });
    }
    let told = desk.run(&resume).ends(0).stderr;
    assert_eq!(
        told.contains(&format!("{kept} of")),
        kept > 0,
        "{kept}: {told}"
    );
    desk.run(&args("whole.png")).ends(0);
    assert_eq!(desk.read("a.png"), desk.read("whole.png"));
    assert_eq!(desk.names(), ["a.png", "lit.txt", "room.txt", "whole.png"]);
}

/// A disk that is full costs a part; what is in the way of a picture is told.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_a_part() {
    let desk = Desk::new();
    let options = "--backend cpu --size 400x3000 --samples 16";
    let line = |limit: &str, output: &str, more: &str| {
        format!(
            "trap '' XFSZ; ulimit -f {limit}; exec {} render room.txt -o {output} {options} {more}",
            env!("CARGO_BIN_EXE_plumb")
        )
    };
    let shell = |line: &str| {
        let mut shell = std::process::Command::new("bash");
        shell
            .args(["-c", line])
            .current_dir(desk.folder.path())
            .output()
            .unwrap()
    };
    // Parts fit, the picture does not.
    let full = shell(&line("2000", "a.ppm", "--resume"));
    let told = String::from_utf8_lossy(&full.stderr);
    assert_eq!(full.status.code(), Some(2), "{told}");
    assert!(told.contains("writing a.ppm failed"), "{told}");
    assert!(!desk.path("a.ppm").exists());
    let parts = fs::read_dir(desk.path("a.ppm.parts")).unwrap().count();
    assert!(parts > 1);
    // Now there is room.
    let told = shell(&line("unlimited", "a.ppm", "--resume"));
    let told = String::from_utf8_lossy(&told.stderr).into_owned();
    assert!(told.contains(" 0 of them made now"), "{told}");
    shell(&line("unlimited", "whole.ppm", ""));
    assert_eq!(desk.read("a.ppm"), desk.read("whole.ppm"));
    // Not even a part fits: nothing of it is left.
    let full = shell(&line("1", "b.ppm", "--part 1/3"));
    assert_eq!(full.status.code(), Some(2));
    assert_eq!(fs::read_dir(desk.path("b.ppm.parts")).unwrap().count(), 0);
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

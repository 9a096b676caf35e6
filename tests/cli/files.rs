//! Files that must not be lost, and streams that lead nowhere: what is refused before a picture is written over it or
//! into it; and where textures are looked for.

use std::fs;

use super::desk::{Desk, ROOM, ppm};

/// A room with a picture on its wall.
fn textured(desk: &Desk) -> &'static str {
    let picture = "texture wood { filename wood.ppm }\n\
        texplane frame { material grey normal 0 0 1 point 2 2 -2 xdir 1 0 0 dimensions 2 1 texname wood mode 0 }\n";
    desk.write("framed.txt", &[ROOM, picture].concat());
    fs::write(desk.path("wood.ppm"), WOOD).unwrap();
    "framed.txt"
}

const WOOD: &[u8] = b"P6 2 1 255\n\xC8\x64\x32\x32\x64\xC8";

/// A picture that is written over what its scene was read from destroys it, by whatever name it is called.
#[cfg(unix)]
#[test]
fn what_a_scene_is_made_from_is_not_overwritten_through_a_link() {
    use std::os::unix::fs::symlink;
    let desk = Desk::new();
    let scene = textured(&desk);
    let before = [desk.read(scene), WOOD.to_vec()];
    for (of, what) in [
        (scene, "the scene itself"),
        ("wood.ppm", "the scene's texture `wood`"),
    ] {
        fs::hard_link(desk.path(of), desk.path("hard.ppm")).unwrap();
        symlink("hard.ppm", desk.path("soft.png")).unwrap();
        for link in ["hard.ppm", "soft.png"] {
            let render = ["render", scene, "--backend", "cpu"];
            let picture = [&render[..], &["-o", link]].concat();
            desk.run(&picture).fails_with(&[link, what]);
            let verdicts = [&render[..], &["-o", "a.ppm", "--verdicts", link]].concat();
            desk.run(&verdicts).fails_with(&[link, what]);
        }
        for name in ["hard.ppm", "soft.png"] {
            fs::remove_file(desk.path(name)).unwrap();
        }
    }
    assert_eq!([desk.read(scene), desk.read("wood.ppm")], before);
    assert_eq!(desk.names(), ["framed.txt", "room.txt", "wood.ppm"]);
}

/// Likewise where the scene comes from stdin, or the picture goes to stdout: both may be that file.
#[cfg(target_os = "linux")]
#[test]
fn streams_that_are_the_scenes_file_are_seen() {
    let desk = Desk::new();
    desk.write("room.ppm", ROOM);
    let room = || fs::File::open(desk.path("room.ppm")).unwrap();
    let onto = || {
        fs::OpenOptions::new()
            .append(true)
            .open(desk.path("room.ppm"))
    };
    for args in [&["-o", "room.ppm"][..], &["render", "-", "-o", "room.ppm"]] {
        let mut command = desk.command(&[args, &["--backend", "cpu"]].concat());
        let output = command.stdin(room()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(told.contains("room.ppm is the scene itself"), "{told}");
    }
    let mut command = desk.command(&["render", "room.ppm", "-o", "-", "--backend", "cpu"]);
    let output = command.stdout(onto().unwrap()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(desk.read("room.ppm"), ROOM.as_bytes());
}

#[cfg(unix)]
#[test]
fn pictures_to_compare_are_not_overwritten_through_a_link() {
    let desk = Desk::new();
    fs::write(desk.path("a.ppm"), WOOD).unwrap();
    fs::write(desk.path("b.ppm"), b"P6 2 1 255\nabcdef").unwrap();
    fs::hard_link(desk.path("b.ppm"), desk.path("d.ppm")).unwrap();
    desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "d.ppm"])
        .fails_with(&["d.ppm is one of the pictures"]);
    assert_eq!(desk.read("b.ppm"), b"P6 2 1 255\nabcdef");
}

#[test]
fn the_picture_and_its_verdicts_are_two_files() {
    let desk = Desk::new();
    for verdicts in ["a.ppm", "./a.ppm"] {
        let args = ["render", "room.txt", "-o", "a.ppm", "--verdicts", verdicts];
        desk.run(&args).fails_with(&["the picture itself"]);
    }
    assert_eq!(desk.names(), ["room.txt"]);
}

/// The runtime opens /dev/null in place of a stream that is closed, and all that is written there would be lost.
#[cfg(target_os = "linux")]
#[test]
fn a_stdout_that_is_closed_is_told() {
    let desk = Desk::new();
    for command in [
        "render room.txt -o - --backend cpu",
        "render - --backend cpu < room.txt",
        "check room.txt",
        "dump room.txt",
    ] {
        let program = env!("CARGO_BIN_EXE_plumb");
        let shell = |ending: &str| {
            let mut shell = std::process::Command::new("sh");
            shell.args(["-c", &format!("exec {program} {command} {ending}")]);
            shell.current_dir(desk.folder.path()).output().unwrap()
        };
        let closed = shell(">&-");
        let told = String::from_utf8(closed.stderr).unwrap();
        assert_eq!(closed.status.code(), Some(2), "{command}: {told}");
        assert!(told.contains("stdout: it is closed"), "{told}");
        assert!(!told.contains("40×30"), "{told}");
        // Who throws everything away gets nothing, and no complaint.
        for thrown in ["> /dev/null", "1<> /dev/null"] {
            assert_eq!(shell(thrown).status.code(), Some(0), "{command}");
        }
    }
}

/// `script` runs a command on a terminal of its own.
#[cfg(target_os = "linux")]
#[test]
fn no_picture_is_poured_onto_a_terminal() {
    let desk = Desk::new();
    for command in [
        "render room.txt -o -",
        "render room.txt -o /dev/stdout",
        "render - < room.txt",
        "-o - < room.txt",
        "< room.txt",
        "compare room.ppm room.ppm --diff -",
    ] {
        let line = format!("{} {command}", env!("CARGO_BIN_EXE_plumb"));
        let mut script = std::process::Command::new("script");
        script.args(["-qec", &line, "/dev/null"]);
        let output = script.current_dir(desk.folder.path()).output().unwrap();
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(
            told.contains("would go to the terminal"),
            "{command}: {told}"
        );
        assert!(!told.contains("P6"), "{command}: {told}");
        assert_eq!(output.status.code(), Some(2), "{command}");
    }
}

#[test]
fn a_texture_that_is_not_there_was_looked_for_somewhere() {
    let desk = Desk::new();
    textured(&desk);
    fs::create_dir(desk.path("sub")).unwrap();
    fs::rename(desk.path("framed.txt"), desk.path("sub/framed.txt")).unwrap();
    let path = if cfg!(windows) {
        "sub\\wood.ppm"
    } else {
        "sub/wood.ppm"
    };
    desk.run(&["check", "sub/framed.txt"])
        .fails_with(&["there is no such file", &format!("looked for at `{path}`")]);
    fs::remove_file(desk.path("wood.ppm")).unwrap();
    let scene = String::from_utf8(desk.read("sub/framed.txt")).unwrap();
    desk.pipe(&["check", "-"], &scene)
        .fails_with(&["looked for at `wood.ppm`, in the current folder"]);
}

/// A stream by one of the names that shells give it has no folder either: `/dev/fd/wood.ppm` is nobody's texture.
#[cfg(unix)]
#[test]
fn textures_of_a_stream_lie_in_the_current_folder() {
    let desk = Desk::new();
    let scene = fs::read_to_string(desk.path(textured(&desk))).unwrap();
    desk.run(&["render", "framed.txt", "--backend", "cpu"])
        .ends(0);
    for name in ["-", "/dev/stdin", "/dev/fd/0"] {
        let args = ["render", name, "--backend", "cpu", "-o", "-", "-q"];
        let ran = desk.pipe(&args, &scene).ends(0);
        assert_eq!(ran.stdout, desk.read("framed.ppm"), "{name}");
    }
    // Nor has it a name that would be the picture's.
    desk.pipe(&["render", "/dev/fd/0"], &scene)
        .fails_with(&["give one with -o"]);
}

/// Netpbm's rules, for what is laid on walls and for what is compared: one white space ends the header.
#[test]
fn a_ppm_with_more_than_its_pixels_is_read_and_told() {
    let desk = Desk::new();
    let scene = textured(&desk);
    let dos = [&b"P6\r\n2 1\r\n255\r\n"[..], &WOOD[11..]].concat();
    let more = [WOOD, b"\n"].concat();
    fs::write(desk.path("same.ppm"), &more).unwrap();
    for (bytes, told) in [
        (&dos, "header that ends with CR LF"),
        (&more, "goes on behind its pixels"),
    ] {
        fs::write(desk.path("wood.ppm"), bytes).unwrap();
        let note = desk.run(&["check", scene]).ends(0).text();
        assert!(
            note.contains("note: texture `wood.ppm`") && note.contains(told),
            "{note}"
        );
        let rendered = desk.run(&["render", scene, "--backend", "cpu"]).ends(0);
        assert!(rendered.stderr.contains(told), "{}", rendered.stderr);
        let compared = desk.run(&["compare", "wood.ppm", "same.ppm"]);
        assert!(compared.stderr.contains(told), "{}", compared.stderr);
    }
    // White space of every kind, and comments wherever they may stand; no remark.
    fs::write(
        desk.path("wood.ppm"),
        [&b"P6\x0B2# two\n\x0C1 255\r"[..], &WOOD[11..]].concat(),
    )
    .unwrap();
    fs::write(desk.path("same.ppm"), WOOD).unwrap();
    assert_eq!(
        desk.run(&["compare", "wood.ppm", "same.ppm"])
            .ends(0)
            .stderr,
        ""
    );
    let note = desk.run(&["check", scene]).ends(0).text();
    assert_eq!(note.lines().count(), 1, "{note}");
    desk.run(&["render", scene, "--backend", "cpu"]).ends(0);
    let framed = desk.read("framed.ppm");
    assert_eq!(ppm(&framed).0, 40);
}

/// No name of ours, no path of the machine that built it, no number of the system.
#[cfg(target_os = "linux")]
#[test]
fn refusals_are_without_insides() {
    let desk = Desk::new();
    let render = [
        "render",
        "room.txt",
        "--backend",
        "cpu",
        "-o",
        "/proc/a.ppm",
    ];
    let ran = desk.run(&render).ends(2);
    assert!(
        ran.stderr.contains("cannot write /proc/a.ppm"),
        "{}",
        ran.stderr
    );
    for inside in [".plumb-", "os error"] {
        assert!(!ran.stderr.contains(inside), "{}", ran.stderr);
    }
    let full = ["render", "room.txt", "--backend", "cpu", "-o", "/dev/full"];
    desk.run(&full)
        .fails_with(&["writing /dev/full failed: there is no space left"]);
}

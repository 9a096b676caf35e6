//! Many pictures in one run: the same bytes as one by one, in order; what is wrong with one of them, or with all.

use std::fs;
use std::process::Stdio;

use serde_json::Value;

use super::desk::{Desk, LIT, ROOM, ppm};

/// A desk with some scenes that differ, a folder for pictures, and the pictures of the scenes alone.
fn desk() -> (Desk, Vec<Vec<u8>>) {
    let desk = Desk::new();
    fs::create_dir(desk.path("in")).unwrap();
    fs::create_dir(desk.path("out")).unwrap();
    let texts = [
        ROOM.to_owned(),
        LIT.to_owned(),
        ROOM.replace("center 5 3 -4", "center 4 2 -3"),
        ROOM.replace("pixeldim 40 30", "pixeldim 31 47"),
    ];
    let alone = NAMES.iter().zip(texts).map(|(name, text)| {
        desk.write(name, &text);
        let ran = desk.run(&["render", name, "-o", "-", "--backend", "cpu"]);
        ran.ends(0).stdout
    });
    let alone = alone.collect();
    (desk, alone)
}

const NAMES: [&str; 4] = ["in/1.txt", "in/2.txt", "in/3.a.txt", "in/4.txt"];

/// Renders these on the CPU, with these arguments.
fn args<'a>(scenes: &[&'a str], others: &[&'a str]) -> Vec<&'a str> {
    [&["render"], scenes, &["--backend", "cpu"], others].concat()
}

#[test]
fn each_picture_is_as_it_is_alone() {
    let (desk, alone) = desk();
    for (output, pictures) in [
        (
            &["-o", "out"][..],
            ["out/1.ppm", "out/2.ppm", "out/3.a.ppm", "out/4.ppm"],
        ),
        (
            &["-o", "out/"],
            ["out/1.ppm", "out/2.ppm", "out/3.a.ppm", "out/4.ppm"],
        ),
        (&[], ["1.ppm", "2.ppm", "3.a.ppm", "4.ppm"]),
        (
            &["-o", "out/{}-{}.ppm"],
            [
                "out/1-1.ppm",
                "out/2-2.ppm",
                "out/3.a-3.a.ppm",
                "out/4-4.ppm",
            ],
        ),
    ] {
        let ran = desk.run(&args(&NAMES, output)).ends(0);
        assert_eq!(ran.text(), "");
        // What is said comes in the order of the scenes, and all together in the end.
        let lines: Vec<&str> = ran.stderr.lines().collect();
        for (line, picture) in lines.iter().zip(pictures) {
            assert!(line.starts_with(&format!("{picture}: ")), "{}", ran.stderr);
        }
        assert!(
            lines[4].starts_with("4 pictures, ") && lines.len() == 5,
            "{}",
            ran.stderr
        );
        for (picture, alone) in pictures.iter().zip(&alone) {
            assert!(desk.read(picture) == *alone, "{picture}");
            fs::remove_file(desk.path(picture)).unwrap();
        }
    }
    assert_eq!(desk.run(&args(&NAMES, &["-q"])).ends(0).stderr, "");
}

/// On devices, and with the GPU's own numbers.
#[test]
fn each_picture_is_as_it_is_alone_on_devices() {
    let (desk, alone) = desk();
    for others in [&["--backend", "gpu"][..], &["--precision", "fast"]] {
        let alone = if others[0] == "--backend" {
            alone.clone()
        } else {
            let alone = |name: &&str| {
                let args = [&["render", name, "-o", "-"], others].concat();
                desk.run(&args).ends(0).stdout
            };
            NAMES.iter().map(alone).collect()
        };
        let run = [&["render"], &NAMES[..], &["-o", "out/{}.ppm"], others].concat();
        desk.run(&run).ends(0);
        for (name, alone) in ["1", "2", "3.a", "4"].iter().zip(&alone) {
            assert!(desk.read(&format!("out/{name}.ppm")) == *alone, "{name}");
        }
    }
}

/// A pattern that matches one scene means the same as one that matches several.
#[test]
fn one_scene_goes_into_a_folder_too() {
    let (desk, alone) = desk();
    for output in ["out", "out/", "out/{}.ppm"] {
        desk.run(&args(&NAMES[1..2], &["-o", output])).ends(0);
        assert!(desk.read("out/2.ppm") == alone[1], "{output}");
        fs::remove_file(desk.path("out/2.ppm")).unwrap();
    }
    desk.run(&args(
        &NAMES[..2],
        &["-o", "out/{}.png", "--verdicts", "out/{}-why.png"],
    ))
    .ends(0);
    for name in ["1", "1-why", "2", "2-why"] {
        let bytes = desk.read(&format!("out/{name}.png"));
        assert!(bytes.starts_with(b"\x89PNG"), "{name}");
    }
}

#[test]
fn stdout_takes_one_picture_after_the_other() {
    let (desk, alone) = desk();
    let ran = desk.run(&args(&NAMES, &["-o", "-", "--json"])).ends(0);
    assert!(ran.stdout == alone.concat());
    // Reports are all there is on stderr then.
    let reports: Vec<Value> = ran
        .stderr
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let names: Vec<&str> = reports
        .iter()
        .map(|r| r["scene"].as_str().unwrap())
        .collect();
    assert_eq!(names, NAMES);
}

/// Of a scene that is wrong it is told, and the others are made.
#[test]
fn a_wrong_scene_does_not_stop_the_others() {
    let (desk, alone) = desk();
    desk.write("in/3.a.txt", "camera c { pixeldim 3 }");
    let scenes = [NAMES[0], "in/none.txt", NAMES[2], NAMES[3]];
    let ran = desk.run(&args(&scenes, &["-o", "out/"])).ends(2);
    for words in [
        "in/none.txt",
        "in/3.a.txt:1:",
        "2 of 4 pictures, without in/none.txt, in/3.a.txt, ",
    ] {
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
    assert!(desk.read("out/1.ppm") == alone[0] && desk.read("out/4.ppm") == alone[3]);
    assert_eq!(fs::read_dir(desk.path("out")).unwrap().count(), 2);
    // Silently, errors are told all the same.
    let quiet = desk.run(&args(&scenes, &["-o", "out/", "-q"])).ends(2);
    assert!(quiet.stderr.contains("in/3.a.txt:1:") && !quiet.stderr.contains("pictures"));
    // What is found while it is rendered names the scene.
    let ran = desk
        .run(&args(
            &[NAMES[0], NAMES[1]],
            &["-o", "out/", "--max-rays", "1"],
        ))
        .ends(2);
    assert!(
        ran.stderr.contains("plumb: error: in/2.txt: "),
        "{}",
        ran.stderr
    );
    assert!(
        ran.stderr.contains("1 of 2 pictures, without in/2.txt"),
        "{}",
        ran.stderr
    );
}

#[test]
fn json_has_a_line_for_each_picture() {
    let (desk, _) = desk();
    let scenes = [NAMES[0], "in/none.txt", NAMES[3]];
    let ran = desk.run(&args(&scenes, &["-o", "out/", "--json"])).ends(2);
    let lines: Vec<Value> = ran
        .text()
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[0]["output"], "out/1.ppm");
    assert_eq!(lines[0]["width"], 40);
    assert_eq!(lines[0]["sha256"].as_str().unwrap().len(), 64);
    assert_eq!(lines[1]["scene"], "in/none.txt");
    assert!(lines[1]["error"].as_str().unwrap().contains("in/none.txt"));
    assert_eq!(lines[2]["height"], 47);
    // Each line has what the report of one picture has, which is a text of several lines.
    let one = desk
        .run(&args(&NAMES[..1], &["-o", "out/", "--json"]))
        .ends(0)
        .text();
    assert!(one.starts_with("{\n  \"software\""), "{one}");
    let one: Value = serde_json::from_str(&one).unwrap();
    let keys = |value: &Value| {
        value
            .as_object()
            .unwrap()
            .keys()
            .cloned()
            .collect::<Vec<_>>()
    };
    assert_eq!(keys(&one), keys(&lines[0]));
    assert_eq!(one["sha256"], lines[0]["sha256"]);
}

/// What would be regretted is refused before anything is rendered.
#[test]
fn what_cannot_be_is_refused_before_anything_is_rendered() {
    let (desk, _) = desk();
    desk.write("1.txt", ROOM);
    let before = desk.names();
    for (scenes, others, words) in [
        (
            &["in/1.txt", "1.txt"][..],
            &["-o", "out"][..],
            &["in/1.txt and 1.txt would both become out/1.ppm"][..],
        ),
        (&["1.txt", "./1.txt"], &[], &["would both become 1.ppm"]),
        (
            &["in/1.txt", "in/2.txt"],
            &["-o", "a.ppm"],
            &["would both become a.ppm", "a folder, or a name with {}"],
        ),
        (
            &["in/1.txt", "in/2.txt"],
            &["-o", "none/"],
            &["there is no folder none/", "mkdir -p none/"],
        ),
        (
            &["in/1.txt", "in/2.txt"],
            &["-o", "none/{}.png"],
            &["the folder none does not exist"],
        ),
        (
            &["in/1.txt", "picture.png"],
            &[],
            &["to name the picture: -o picture.png"],
        ),
        (&["in/1.txt", "-"], &["-o", "out"], &["it is a folder"]),
        (
            &["in/1.txt", "-"],
            &["-o", "{}.ppm"],
            &["no name to stand for {}"],
        ),
        (
            &["in/1.txt", "in/2.txt"],
            &["--debug", "pix"],
            &["give one scene"],
        ),
        (
            &["in/1.txt", "in/2.txt"],
            &["--verdicts", "why.ppm"],
            &["would both become why.ppm"],
        ),
        (
            &["in/1.txt", "in/2.txt"],
            &["-o", "in/{}.txt"],
            &["in/1.txt would be overwritten"],
        ),
    ] {
        desk.run(&args(scenes, others)).fails_with(words);
    }
    assert_eq!(desk.names(), before);
    assert_eq!(fs::read_dir(desk.path("out")).unwrap().count(), 0);
}

/// Two names of one file, by a link.
#[cfg(unix)]
#[test]
fn links_do_not_hide_that_two_pictures_are_one_file() {
    let (desk, _) = desk();
    std::os::unix::fs::symlink("1.ppm", desk.path("out/2.ppm")).unwrap();
    desk.run(&args(&NAMES[..2], &["-o", "out"]))
        .fails_with(&["in/1.txt and in/2.txt would both become out/2.ppm"]);
    fs::remove_file(desk.path("out/2.ppm")).unwrap();
    fs::write(desk.path("out/1.ppm"), b"old").unwrap();
    fs::hard_link(desk.path("out/1.ppm"), desk.path("out/2.ppm")).unwrap();
    desk.run(&args(&NAMES[..2], &["-o", "out"]))
        .fails_with(&["would both become"]);
    assert_eq!(desk.read("out/2.ppm"), b"old");
}

/// A texture that the run itself writes might be the old one or the new one.
#[test]
fn a_texture_that_the_run_writes_is_refused() {
    let (desk, alone) = desk();
    fs::write(desk.path("in/1.ppm"), b"P6 2 1 255\nabcdef").unwrap();
    let textured = "texture wood { filename 1.ppm }\n\
        texplane frame { material grey normal 0 0 1 point 2 2 -2 xdir 1 0 0 dimensions 2 1 texname wood mode 0 }\n";
    desk.write("in/5.txt", &[ROOM, textured].concat());
    let ran = desk
        .run(&args(&["in/5.txt", "in/1.txt"], &["-o", "in"]))
        .ends(2);
    let words = "in/5.txt: its texture `wood` is the picture of in/1.txt in this run";
    assert!(ran.stderr.contains(words), "{}", ran.stderr);
    assert!(desk.read("in/1.ppm") == alone[0]);
}

/// Behind a picture that is not whole a reader would take the next one for the rest of it.
#[test]
fn a_stream_that_is_cut_off_is_not_written_on() {
    let (desk, alone) = desk();
    // Only pixels of the ball, in the middle, need several rays.
    let scenes = [NAMES[0], NAMES[1], NAMES[2], NAMES[3]];
    let ran = desk.run(&args(
        &scenes,
        &["-o", "-", "--max-rays", "2", "--band-rows", "1"],
    ));
    let ran = ran.ends(2);
    assert!(
        ran.stderr.contains("in/2.txt: ") && ran.stderr.contains("no others can follow"),
        "{}",
        ran.stderr
    );
    assert!(ran.stdout.starts_with(&alone[0]) && alone[..2].concat().starts_with(&ran.stdout));
    assert!(ran.stdout.len() > alone[0].len());
}

/// A reader that has seen enough is no failure.
#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_ends_the_run() {
    let (desk, _) = desk();
    let mut many = args(&[], &["-o", "-"]);
    many.extend(NAMES.iter().cycle().take(200));
    let line = format!(
        "\"$0\" {} --size 200x150 | head -c 100000 | wc -c; exit ${{PIPESTATUS[0]}}",
        many.join(" ")
    );
    let mut shell = std::process::Command::new("bash");
    shell.args(["-c", &line, env!("CARGO_BIN_EXE_plumb")]);
    let output = shell.current_dir(desk.folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "100000");
    assert!(!String::from_utf8_lossy(&output.stderr).contains("error"));
}

/// Ctrl-C in the middle: whole pictures, and nothing else.
#[cfg(unix)]
#[test]
fn what_is_interrupted_leaves_whole_pictures() {
    let (desk, _) = desk();
    let names: Vec<String> = (0..300).map(|n| format!("in/f{n}.txt")).collect();
    for name in &names {
        desk.write(name, &LIT.replace("pixeldim 40 30", "pixeldim 400 300"));
    }
    let scenes: Vec<&str> = names.iter().map(String::as_str).collect();
    let out = desk.path("out");
    let pictures = || {
        let entries = fs::read_dir(&out).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        names.collect::<Vec<_>>()
    };
    let mut command = desk.command(&args(&scenes, &["-o", "out/", "-q"]));
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    while pictures()
        .iter()
        .filter(|name| name.ends_with(".ppm"))
        .count()
        < 3
    {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let signal = ["-INT".to_owned(), child.id().to_string()];
    assert!(
        std::process::Command::new("kill")
            .args(signal)
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let made = pictures();
    assert!(made.len() < names.len());
    for name in made {
        let bytes = fs::read(out.join(&name)).unwrap();
        let (width, height, rgb) = ppm(&bytes);
        assert_eq!(
            (width, height, rgb.len()),
            (400, 300, 3 * 400 * 300),
            "{name}"
        );
    }
}

/// No more scenes are read than are worked on: one that is written, one that is rendered, one that is next.
#[cfg(target_os = "linux")]
#[test]
fn scenes_wait_in_their_files_and_not_in_memory() {
    use std::io::Read;
    use std::os::unix::fs::OpenOptionsExt;

    let (desk, alone) = desk();
    let fifo = desk.path("in/fifo.txt");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&fifo)
            .status()
            .unwrap()
            .success()
    );
    let names = [NAMES[0], NAMES[2], NAMES[0], "in/fifo.txt", NAMES[2]];
    let size = ["-o", "-", "-q", "--size", "400x300"];
    let mut command = desk.command(&args(&names, &size));
    let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
    // Nobody reads the first picture, so it stays the one that is written.
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let open = |flags| {
        fs::OpenOptions::new()
            .write(true)
            .custom_flags(flags)
            .open(&fifo)
    };
    let nobody = open(libc::O_NONBLOCK).unwrap_err();
    assert_eq!(nobody.raw_os_error(), Some(libc::ENXIO));
    let mut stdout = child.stdout.take().unwrap();
    let reader = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        stdout.read_to_end(&mut bytes).unwrap();
        bytes
    });
    // It waits until somebody reads.
    std::io::Write::write_all(&mut open(0).unwrap(), ROOM.as_bytes()).unwrap();
    let bytes = reader.join().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let one = bytes.len() / 5;
    assert!(bytes[..one] == bytes[2 * one..3 * one] && bytes[..one] == bytes[3 * one..4 * one]);
    assert!(bytes[..one] != bytes[one..2 * one] && bytes.len() == 5 * one && one > alone[0].len());
}

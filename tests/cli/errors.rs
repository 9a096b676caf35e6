//! Bad scenes: what is said, where, with which exit code, and that nothing is left behind.

use super::desk::{Desk, ROOM};

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
    let told = "room.txt: ok (3 objects, 0 lights, 40×30)\n3 files: 1 good, 2 bad\n";
    assert_eq!(ran.text(), told);
    // An empty line stands between what is said of one file and of the next.
    assert!(
        ran.stderr.contains("\n\nplumb: error: none.txt"),
        "{}",
        ran.stderr
    );
    assert!(!ran.stderr.starts_with('\n') && ran.stderr.ends_with("file\n\n"));
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

/// Names hold what they like, escape sequences too.
#[cfg(unix)]
#[test]
fn control_characters_of_names_do_not_reach_the_terminal() {
    let desk = Desk::new();
    let twice = "material \u{1b}[31m { ambient 1 1 1 }\nmaterial \u{1b}[31m { ambient 1 1 1 }\n";
    desk.write("\u{1b}[2Jgood.txt", &[ROOM, twice].concat());
    desk.write("\u{1b}[2Jbad.txt", "camera");
    let names = ["\u{1b}[2Jgood.txt", "\u{1b}[2Jbad.txt", "\u{1b}[2Jnone.txt"];
    for args in [
        ["check", names[0], names[1], names[2]],
        ["render", names[0], "--backend", "cpu"],
        ["compare", names[0], names[1], "--json"],
        ["compare", names[2], names[1], "--json"],
    ] {
        let ran = desk.run(&args);
        assert!(!ran.text().contains('\u{1b}'), "{}", ran.text());
        assert!(!ran.stderr.contains('\u{1b}'), "{}", ran.stderr);
    }
    // Programs get the name as it is.
    let json = desk.run(&["check", "--json", names[0]]).ends(0);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(json[0]["file"], names[0]);
}

/// How to get the window where it was not built.
#[cfg(not(feature = "preview"))]
#[test]
fn without_its_feature_preview_says_how_to_get_it() {
    let desk = Desk::new();
    let ways = ["--features preview", "plumb render SCENE"];
    desk.run(&["preview", "room.txt"]).fails_with(&ways);
}

/// Where the library that opens windows was built is nobody's business.
#[cfg(all(feature = "preview", target_os = "linux"))]
#[test]
fn without_a_display_there_is_no_window() {
    let desk = Desk::new();
    let mut command = desk.command(&["preview", "room.txt"]);
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(display);
    }
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(
        told.contains("no window can be opened") && told.contains("plumb render"),
        "{told}"
    );
    assert!(
        !told.contains(".rs") && !told.contains("os error"),
        "{told}"
    );
}

#[cfg(feature = "preview")]
#[test]
fn preview_refuses_what_is_no_file_before_it_opens_a_window() {
    let desk = Desk::new();
    desk.run(&["preview", "none.txt"])
        .fails_with(&["none.txt: there is no such file"]);
    desk.run(&["preview", "-"]).fails_with(&["stdin"]);
    desk.run(&["preview", "."]).fails_with(&["directory"]);
    let wide = [
        "preview",
        "room.txt",
        "--size",
        "1000000x10",
        "--samples",
        "999",
        "--jitter",
        "course",
    ];
    desk.run(&wide).fails_with(&["--jitter hash"]);
}

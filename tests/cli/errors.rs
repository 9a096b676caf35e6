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

/// How to get the window where it was not built.
#[cfg(not(feature = "preview"))]
#[test]
fn without_its_feature_preview_says_how_to_get_it() {
    let desk = Desk::new();
    let ways = ["--features preview", "plumb render SCENE"];
    desk.run(&["preview", "room.txt"]).fails_with(&ways);
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

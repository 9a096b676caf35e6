//! Many mistakes in one text, and what the report of them looks like.

use std::io::Write;
use std::path::Path;

use expect_test::expect;
use plumb::scene;

use super::{check, check_rest};

#[test]
fn every_mistake_is_reported_at_once() {
    check(
        "camera cam\n{\n  pixeldim 640\n  worlddim 8 x\n  viewpoint 4 3 -6\n}\nmaterial green { ambint 0 5 0 }\nplane wall\n{\n  material gren\n  normal 0 0 0\n  point 0 0\n}\nlight l { location 0 0 0 }\n",
        expect![[r#"
            error: `pixeldim` takes 2 numbers, found 1
              --> scene.txt:3:3
              |
            3 |   pixeldim 640
              |   ^^^^^^^^^^^^ too few

            error: `x` is not a number
              --> scene.txt:4:14
              |
            4 |   worlddim 8 x
              |              ^

            error: `viewpoint` must be in front of the screen: its z greater than 0
              --> scene.txt:5:17
              |
            5 |   viewpoint 4 3 -6
              |                 ^^

            error: `material` has no attribute `ambint`
              --> scene.txt:7:18
              |
            7 | material green { ambint 0 5 0 }
              |                  ^^^^^^
              |
              = help: did you mean `ambient`?

            error: there is no material `gren`
               --> scene.txt:10:12
               |
            10 |   material gren
               |            ^^^^
               |
               = help: did you mean `green`?

            error: `normal` must be a direction, not 0 0 0
               --> scene.txt:11:10
               |
            11 |   normal 0 0 0
               |          ^^^^^

            error: `point` takes 3 numbers, found 2
               --> scene.txt:12:3
               |
            12 |   point 0 0
               |   ^^^^^^^^^ too few

            error: this `light` lacks `emissivity`
               --> scene.txt:14:1
               |
            14 | light l { location 0 0 0 }
               | ^^^^^^^
               |
               = help: add `emissivity 5 5 5`, for example
        "#]],
    );
}

#[test]
fn a_hundred_errors_are_printed_and_the_rest_counted() {
    let text = "sphere a { }\n".repeat(250);
    let diagnostics = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap_err();
    assert_eq!(
        (diagnostics.total(), diagnostics.messages().count()),
        (251, 100)
    );
    assert!(
        diagnostics
            .render(false)
            .ends_with("error: scene.txt: and 151 more\n")
    );
    assert_eq!(diagnostics.to_json().as_array().unwrap().len(), 100);
}

#[test]
fn a_million_errors_take_no_time() {
    let text = "a{}".repeat(1_000_000);
    let diagnostics = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap_err();
    assert_eq!(diagnostics.messages().count(), 100);
}

#[test]
fn a_file_of_one_token_gives_one_short_message() {
    for token in ["x", "7", "#", "{", "}"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.txt");
        let mut file = std::fs::File::create(&path).unwrap();
        // 100 MB where it is one token.
        let count = if matches!(token, "{" | "}") {
            10_000
        } else {
            1_000
        };
        for _ in 0..count {
            file.write_all(
                token
                    .repeat(if count == 1_000 { 100_000 } else { 1 })
                    .as_bytes(),
            )
            .unwrap();
        }
        let text = scene::load(&path).unwrap_err().to_string();
        assert!(text.len() < 100_000, "{token}: {} bytes", text.len());
        assert!(text.contains("error: "), "{text}");
    }
}

#[test]
fn json_has_the_same_errors() {
    let text = "camera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }\nspere b { }\n";
    let diagnostics = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap_err();
    expect![[r#"
        [
          {
            "column": 1,
            "file": "scene.txt",
            "help": "did you mean `sphere`?",
            "line": 2,
            "message": "there is no entity `spere`"
          }
        ]"#]]
    .assert_eq(&serde_json::to_string_pretty(&diagnostics.to_json()).unwrap());
}

#[test]
fn colours() {
    check_rest(
        "material a { ambient 5 }\nmaterial b { diffuse 5 5 }\nmaterial c { color 1 0 0 }\nlight l { location 0 0 0 colour 1 1 1 }",
        expect![[r#"
            error: `ambient` takes 3 numbers, found 1
              --> scene.txt:3:14
              |
            3 | material a { ambient 5 }
              |              ^^^^^^^^^ too few
              |
              = help: a colour is red, green, blue: `5 5 5`

            error: `diffuse` takes 3 numbers, found 2
              --> scene.txt:4:14
              |
            4 | material b { diffuse 5 5 }
              |              ^^^^^^^^^^^ too few
              |
              = help: a colour is red, green, blue

            error: `material` has no attribute `color`
              --> scene.txt:5:14
              |
            5 | material c { color 1 0 0 }
              |              ^^^^^
              |
              = help: colour is `ambient` and `diffuse`, each red, green, blue

            error: `light` has no attribute `colour`
              --> scene.txt:6:26
              |
            6 | light l { location 0 0 0 colour 1 1 1 }
              | -------                  ^^^^^^
              | |                         
              | this `light` lacks `emissivity`
              |
              = help: colour is `emissivity`: red, green, blue
        "#]],
    );
}

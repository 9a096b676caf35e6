//! Texts that are not plain: bytes that are no UTF-8, control characters, long lines, line ends of other systems.

use std::path::Path;

use expect_test::expect;
use plumb::scene;

use super::{CAMERA, GREEN, check};

#[test]
fn bytes_that_are_not_utf8() {
    check(
        [CAMERA.as_bytes(), b"material gr\xFCn { ambient 0 -5 0 }"].concat(),
        expect![[r#"
            error: this text is not UTF-8: byte 0xFC cannot stand here
              --> scene.txt:2:12
              |
            2 | material gr�n { ambient 0 -5 0 }
              |            ^
              |
              = help: save it as UTF-8; it may be Latin-1 or Windows-1252

            error: `ambient` must be 0 or more
              --> scene.txt:2:27
              |
            2 | material gr�n { ambient 0 -5 0 }
              |                           ^^
        "#]],
    );
    check(
        [b"\x80\x81\x82 { } garbage".as_slice(), CAMERA.as_bytes()].concat(),
        expect![[r#"
            error: this text is not UTF-8: byte 0x80 cannot stand here
              --> scene.txt:1:1
              |
            1 | ��� { } garbagecamera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }
              | ^
              |
              = help: save it as UTF-8; it may be Latin-1 or Windows-1252
        "#]],
    );
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    check(
        "camera\x1B[31m cam { }",
        expect![[r#"
            error: there is no entity `camera\u{1b}[31m`
              --> scene.txt:1:1
              |
            1 | camera�[31m cam { }
              | ^^^^^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, projector, texture, texplane, triangle, ptriangle, quadric, pquadric

            error: this scene has no camera
              --> scene.txt:1:20
              |
            1 | camera�[31m cam { }
              |                    ^
              |
              = help: a scene needs `camera name { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }`, for example
        "#]],
    );
}

#[test]
fn lines_are_cut() {
    check(
        format!(
            "{CAMERA}{}material m {{ ambient 0 0 -1 }}{}",
            GREEN.trim().repeat(20),
            GREEN.trim().repeat(20)
        ),
        expect![[r#"
            error: `ambient` must be 0 or more
              --> scene.txt:2:666
              |
            2 | ...0 }material green { ambient 0 5 0 }material m { ambient 0 0 -1 }material green { ambient 0 5 0 }material green { ambient 0 5 0 }material green { ambient 0 5 0 }...
              |                                                                ^^
        "#]],
    );
    check(
        format!("{CAMERA}{}", "ä".repeat(100_000)),
        expect![[r#"
            error: there is no entity `ääääääääääääääääääääääääääääääääääääääää...`
              --> scene.txt:2:1
              |
            2 | ääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääääää...
              | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, projector, texture, texplane, triangle, ptriangle, quadric, pquadric
        "#]],
    );
}

#[test]
fn line_ends_of_other_systems() {
    check(
        "camera cam {\r\n  pixeldim 640 480\r\n  worlddim 8 6\r\n  viewpoint 4 3 0\r\n}\r\n",
        expect![[r#"
            error: `viewpoint` must be in front of the screen: its z greater than 0
              --> scene.txt:4:17
              |
            4 |   viewpoint 4 3 0
              |                 ^
        "#]],
    );
    check(
        "camera cam {\r  pixeldim 640 480\r  worlddim 8 6\r  viewpoint 4 3 0\r}\r",
        expect![[r#"
            error: `viewpoint` must be in front of the screen: its z greater than 0
              --> scene.txt:4:17
              |
            4 |   viewpoint 4 3 0
              |                 ^
        "#]],
    );
}

#[test]
fn line_ends_and_byte_order_marks_are_no_mistakes() {
    let text = format!("\u{FEFF}{CAMERA}{GREEN}# the end\n");
    let scene = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap();
    let other = scene::parse(
        "scene.txt",
        text.replace('\n', "\r\n").as_bytes(),
        Path::new(""),
    )
    .unwrap();
    assert_eq!(scene, other);
}

//! The exact text of what is said about each wrong scene: message, place, line, caret and mend.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::Write;
use std::path::Path;

use expect_test::{Expect, expect};
use plumb::scene::{self, LoadError};

/// A camera on line 1.
const CAMERA: &str = "camera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }\n";
/// A material on line 2.
const GREEN: &str = "material green { ambient 0 5 0 }\n";

/// The diagnostics of a scene, as they are printed.
fn complaints(text: impl AsRef<[u8]>) -> String {
    match scene::parse("scene.txt", text.as_ref(), Path::new("")) {
        Ok(scene) => format!("no complaint: {scene:?}"),
        Err(diagnostics) => diagnostics.render(false),
    }
}

/// Checks what is said about a text.
fn check(text: impl AsRef<[u8]>, expected: Expect) {
    expected.assert_eq(&complaints(text));
}

/// Checks what is said about lines behind a camera and a material `green`.
fn check_rest(text: &str, expected: Expect) {
    check(format!("{CAMERA}{GREEN}{text}"), expected);
}

/// Checks what is said about a texture whose file holds these bytes.
fn check_texture(bytes: &[u8], expected: Expect) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wood.ppm"), bytes).unwrap();
    let text = format!("{CAMERA}texture wood {{ filename wood.ppm }}\n");
    let diagnostics = scene::parse("scene.txt", text.as_bytes(), folder.path()).unwrap_err();
    expected.assert_eq(&diagnostics.render(false));
}

#[test]
fn unknown_entity() {
    check_rest(
        "teapot utah { size 3 }\nsphere ball { material green center 0 0 0 radius 0 }",
        expect![[r#"
            error: there is no entity `teapot`
              --> scene.txt:3:1
              |
            3 | teapot utah { size 3 }
              | ^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane

            error: `radius` must be greater than 0
              --> scene.txt:4:50
              |
            4 | sphere ball { material green center 0 0 0 radius 0 }
              |                                                  ^
        "#]],
    );
    check_rest(
        "spere ball { material green center 0 0 0 radius 1 }",
        expect![[r#"
            error: there is no entity `spere`
              --> scene.txt:3:1
              |
            3 | spere ball { material green center 0 0 0 radius 1 }
              | ^^^^^
              |
              = help: did you mean `sphere`?
        "#]],
    );
    check_rest(
        "tilled_plane floor { material green }",
        expect![[r#"
        error: there is no entity `tilled_plane`
          --> scene.txt:3:1
          |
        3 | tilled_plane floor { material green }
          | ^^^^^^^^^^^^
          |
          = help: did you mean `tiled_plane`?
    "#]],
    );
    check_rest(
        "Plane floor { material green }",
        expect![[r#"
        error: there is no entity `Plane`
          --> scene.txt:3:1
          |
        3 | Plane floor { material green }
          | ^^^^^
          |
          = help: did you mean `plane`?
    "#]],
    );
}

#[test]
fn unsupported_entity() {
    check_rest(
        "quadric cone { a 1 }\ntriangle t { }\nprojector p { }\nrevsurf r { }",
        expect![[r#"
            error: `quadric` is not supported
              --> scene.txt:3:1
              |
            3 | quadric cone { a 1 }
              | ^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane

            error: `triangle` is not supported
              --> scene.txt:4:1
              |
            4 | triangle t { }
              | ^^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane

            error: `projector` is not supported
              --> scene.txt:5:1
              |
            5 | projector p { }
              | ^^^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane

            error: `revsurf` is not supported
              --> scene.txt:6:1
              |
            6 | revsurf r { }
              | ^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane
        "#]],
    );
}

#[test]
fn unknown_attribute() {
    check_rest(
        "sphere ball { material green centre 0 0 0 radius 1 }",
        expect![[r#"
            error: `sphere` has no attribute `centre`
              --> scene.txt:3:30
              |
            3 | sphere ball { material green centre 0 0 0 radius 1 }
              |                              ^^^^^^
              |
              = help: did you mean `center`?
        "#]],
    );
    check_rest(
        "sphere ball { material green center 0 0 0 radius 1 emissivity 1 2 3 }",
        expect![[r#"
            error: `sphere` has no attribute `emissivity`
              --> scene.txt:3:52
              |
            3 | sphere ball { material green center 0 0 0 radius 1 emissivity 1 2 3 }
              |                                                    ^^^^^^^^^^
              |
              = help: `emissivity` belongs to light, spotlight; `sphere` has `material`, `center`, `radius`
        "#]],
    );
    check_rest(
        "plane wall { material green direction 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: `plane` has no attribute `direction`
              --> scene.txt:3:29
              |
            3 | plane wall { material green direction 0 0 1 point 0 0 0 }
              | ----------                  ^^^^^^^^^
              | |                            
              | this `plane` lacks `normal`
              |
              = help: `plane` has `material`, `normal`, `point`
        "#]],
    );
    check_rest(
        "fplane wall { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimension 1 1 }",
        expect![[r#"
            error: `fplane` has no attribute `dimension`
              --> scene.txt:3:66
              |
            3 | fplane wall { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimension 1 1 }
              |                                                                  ^^^^^^^^^
              |
              = help: did you mean `dimensions`?
        "#]],
    );
}

#[test]
fn too_few_or_too_many_values() {
    check_rest(
        "plane wall { material green normal 0 0 point 0 0 0 }",
        expect![[r#"
            error: `normal` takes 3 numbers, found 2
              --> scene.txt:3:29
              |
            3 | plane wall { material green normal 0 0 point 0 0 0 }
              |                             ^^^^^^^^^^ too few
        "#]],
    );
    check_rest(
        "plane wall { material green normal 0 0 1 point 0 0 0 0 }",
        expect![[r#"
            error: `point` takes 3 numbers, found 4
              --> scene.txt:3:54
              |
            3 | plane wall { material green normal 0 0 1 point 0 0 0 0 }
              |                                                      ^ too many
        "#]],
    );
    check_rest(
        "plane wall { material green normal point 0 0 0 }",
        expect![[r#"
            error: `normal` takes 3 numbers, found 0
              --> scene.txt:3:29
              |
            3 | plane wall { material green normal point 0 0 0 }
              |                             ^^^^^^ too few
        "#]],
    );
    check_rest(
        "plane wall { material normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: `material` takes a name, found none
              --> scene.txt:3:14
              |
            3 | plane wall { material normal 0 0 1 point 0 0 0 }
              |              ^^^^^^^^
        "#]],
    );
    check_rest(
        "plane wall { material light green normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: `material` takes one name
              --> scene.txt:3:29
              |
            3 | plane wall { material light green normal 0 0 1 point 0 0 0 }
              |                             ^^^^^ more than one word
              |
              = help: names hold no white space
        "#]],
    );
    check_rest(
        "material m { specular 1 2 }",
        expect![[r#"
        error: `specular` takes 1 or 3 numbers, found 2
          --> scene.txt:3:14
          |
        3 | material m { specular 1 2 }
          |              ^^^^^^^^^^^^ too few
    "#]],
    );
}

#[test]
fn not_a_number() {
    check_rest(
        "plane wall { material green normal 0 x 1 point 0 5abc 0 }",
        expect![[r#"
            error: `x` is not a number
              --> scene.txt:3:38
              |
            3 | plane wall { material green normal 0 x 1 point 0 5abc 0 }
              |                                      ^

            error: `5abc` is not a number
              --> scene.txt:3:50
              |
            3 | plane wall { material green normal 0 x 1 point 0 5abc 0 }
              |                                                  ^^^^
        "#]],
    );
    check_rest(
        "sphere ball { material green center 0 nan -inf radius 1e999 }",
        expect![[r#"
            error: `nan` is not a finite number
              --> scene.txt:3:39
              |
            3 | sphere ball { material green center 0 nan -inf radius 1e999 }
              |                                       ^^^

            error: `-inf` is not a finite number
              --> scene.txt:3:43
              |
            3 | sphere ball { material green center 0 nan -inf radius 1e999 }
              |                                           ^^^^

            error: `1e999` is too large a number: the largest is about 1.8e308
              --> scene.txt:3:55
              |
            3 | sphere ball { material green center 0 nan -inf radius 1e999 }
              |                                                       ^^^^^
        "#]],
    );
    check_rest(
        "sphere ball { material green center 0 0x1.g 1,5 radius 0x }",
        expect![[r#"
            error: `0x1.g` is not a number
              --> scene.txt:3:39
              |
            3 | sphere ball { material green center 0 0x1.g 1,5 radius 0x }
              |                                       ^^^^^

            error: `1,5` is not a number
              --> scene.txt:3:45
              |
            3 | sphere ball { material green center 0 0x1.g 1,5 radius 0x }
              |                                             ^^^
              |
              = help: numbers have a decimal point, and white space between them

            error: `0x` is not a number
              --> scene.txt:3:56
              |
            3 | sphere ball { material green center 0 0x1.g 1,5 radius 0x }
              |                                                        ^^
        "#]],
    );
}

#[test]
fn a_float_where_an_integer_belongs() {
    check(
        "camera cam { pixeldim 640.0 4e2 worlddim 8 6 viewpoint 4 3 6 }",
        expect![[r#"
            error: `640.0` is not a whole number
              --> scene.txt:1:23
              |
            1 | camera cam { pixeldim 640.0 4e2 worlddim 8 6 viewpoint 4 3 6 }
              |                       ^^^^^
              |
              = help: write 640

            error: `4e2` is not a whole number
              --> scene.txt:1:29
              |
            1 | camera cam { pixeldim 640.0 4e2 worlddim 8 6 viewpoint 4 3 6 }
              |                             ^^^
              |
              = help: write 400
        "#]],
    );
    check(
        format!("{CAMERA}{GREEN}pplane p {{ material green normal 0 0 1 point 0 0 0 shader 0x1 }}"),
        expect![[r#"
            error: `0x1` is not a whole number
              --> scene.txt:3:59
              |
            3 | pplane p { material green normal 0 0 1 point 0 0 0 shader 0x1 }
              |                                                           ^^^
              |
              = help: write 1
        "#]],
    );
}

#[test]
fn missing_opening_brace() {
    check_rest(
        "plane wall material green normal 0 0 1 point 0 0 0 }\nsphere ball { material green center 0 0 0 radius 0 }",
        expect![[r#"
            error: missing `{` after `plane` `wall`
              --> scene.txt:3:12
              |
            3 | plane wall material green normal 0 0 1 point 0 0 0 }
              |            ^^^^^^^^ expected `{` before it
              |
              = help: an entity is written `type name { attributes }`

            error: `radius` must be greater than 0
              --> scene.txt:4:50
              |
            4 | sphere ball { material green center 0 0 0 radius 0 }
              |                                                  ^
        "#]],
    );
    check_rest(
        "plane wall }",
        expect![[r#"
        error: expected `{` after `plane`, found `}`
          --> scene.txt:3:12
          |
        3 | plane wall }
          | -----      ^
          | |           
          | this entity
          |
          = help: an entity is written `type name { attributes }`
    "#]],
    );
    check_rest(
        "plane",
        expect![[r#"
        error: expected a name after `plane`, found the end of the file
          --> scene.txt:3:6
          |
        3 | plane
          | -----^
          | |    
          | this entity
          |
          = help: an entity is written `type name { attributes }`
    "#]],
    );
    check_rest(
        "plane { material green normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: this `plane` has no name
              --> scene.txt:3:7
              |
            3 | plane { material green normal 0 0 1 point 0 0 0 }
              |       ^ expected a name before it
              |
              = help: an entity is written `type name { attributes }`
        "#]],
    );
    check_rest(
        "plane left wall { material green normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: a name is one word
              --> scene.txt:3:12
              |
            3 | plane left wall { material green normal 0 0 1 point 0 0 0 }
              |            ^^^^ expected `{`, found another word
              |
              = help: perhaps `left_wall`
        "#]],
    );
}

#[test]
fn missing_closing_brace() {
    check_rest(
        "plane wall { material green normal 0 0 1 point 0 0 0\nsphere ball { material green center 0 0 0 radius 0 }",
        expect![[r#"
            error: missing `}` at the end of the block of this `plane`
              --> scene.txt:4:1
              |
            3 | plane wall { material green normal 0 0 1 point 0 0 0
              | ---------- its block starts here
            4 | sphere ball { material green center 0 0 0 radius 0 }
              | ^^^^^^ expected `}` before it
              |
              = help: add `}`

            error: `radius` must be greater than 0
              --> scene.txt:4:50
              |
            4 | sphere ball { material green center 0 0 0 radius 0 }
              |                                                  ^
        "#]],
    );
    check_rest(
        "plane wall { material green normal 0 0 1 point 0 0 0\nmaterial red { ambient 1 0 0 }",
        expect![[r#"
            error: missing `}` at the end of the block of this `plane`
              --> scene.txt:4:1
              |
            3 | plane wall { material green normal 0 0 1 point 0 0 0
              | ---------- its block starts here
            4 | material red { ambient 1 0 0 }
              | ^^^^^^^^ expected `}` before it
              |
              = help: add `}`
        "#]],
    );
}

#[test]
fn stray_braces() {
    check_rest(
        "}",
        expect![[r#"
        error: `}` closes nothing: no block is open here
          --> scene.txt:3:1
          |
        3 | }
          | ^
          |
          = help: remove it, or see whether a block before it ends too early
    "#]],
    );
    check_rest(
        "{ normal 0 0 1 }",
        expect![[r#"
        error: `{` opens a block of no entity
          --> scene.txt:3:1
          |
        3 | { normal 0 0 1 }
          | ^
          |
          = help: an entity is written `type name { attributes }`
    "#]],
    );
    check_rest(
        "plane wall { { material green normal 0 0 1 point 0 0 0 } }",
        expect![[r#"
            error: `{` cannot stand inside the block of a `plane`
              --> scene.txt:3:14
              |
            3 | plane wall { { material green normal 0 0 1 point 0 0 0 } }
              |              ^
              |
              = help: remove it
        "#]],
    );
    check_rest(
        "plane wall { material green } normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: `}` ends the block of this `plane` too early
              --> scene.txt:3:29
              |
            3 | plane wall { material green } normal 0 0 1 point 0 0 0 }
              |                             ^
              |
              = help: remove it
        "#]],
    );
}

#[test]
fn end_of_file_inside_a_block() {
    check_rest(
        "plane wall { material green normal 0 0 1\n",
        expect![[r#"
        error: the file ends inside the block of this `plane`
          --> scene.txt:3:41
          |
        3 | plane wall { material green normal 0 0 1
          | ----------                              ^ expected `}`
          | |                                       
          | its block starts here
          |
          = help: add `}`
    "#]],
    );
    check_rest(
        "plane wall {",
        expect![[r#"
        error: the file ends inside the block of this `plane`
          --> scene.txt:3:13
          |
        3 | plane wall {
          | ----------  ^ expected `}`
          | |           
          | its block starts here
          |
          = help: add `}`
    "#]],
    );
}

#[test]
fn missing_attribute() {
    check_rest(
        "plane wall { material green point 0 0 0 }",
        expect![[r#"
            error: this `plane` lacks `normal`
              --> scene.txt:3:1
              |
            3 | plane wall { material green point 0 0 0 }
              | ^^^^^^^^^^
              |
              = help: add `normal 0 1 0`, for example
        "#]],
    );
    check_rest(
        "plane wall { }",
        expect![[r#"
            error: this `plane` lacks `material`, `normal`, `point`
              --> scene.txt:3:1
              |
            3 | plane wall { }
              | ^^^^^^^^^^
              |
              = help: add `material name`, `normal 0 1 0`, `point 0 0 0`, for example
        "#]],
    );
    check_rest(
        "material m { }",
        expect![[r#"
        error: this `material` has no attributes
          --> scene.txt:3:1
          |
        3 | material m { }
          | ^^^^^^^^^^
          |
          = help: give at least one of `ambient`, `diffuse`, `specular`, `shininess`, `transparency`
    "#]],
    );
}

#[test]
fn repeated_attribute() {
    check_rest(
        "plane wall { material green normal 0 0 1 point 0 0 0 normal 0 0 1 }",
        expect![[r#"
            error: `normal` is given twice
              --> scene.txt:3:54
              |
            3 | plane wall { material green normal 0 0 1 point 0 0 0 normal 0 0 1 }
              |                             ------------             ^^^^^^
              |                             |                         
              |                             first given here
              |
              = help: remove one of them
        "#]],
    );
    check_rest(
        "tiled_plane floor {\n  material green normal 0 1 0 point 0 0 0 altmaterial green\n  dimension 1 1\n  dimensions 2 2\n}",
        expect![[r#"
            error: `dimensions` is given twice
              --> scene.txt:6:3
              |
            5 |   dimension 1 1
              |   ------------- first given here
            6 |   dimensions 2 2
              |   ^^^^^^^^^^
              |
              = help: remove one of them
        "#]],
    );
}

#[test]
fn material_used_before_it_is_defined() {
    check_rest(
        "plane wall { material red normal 0 0 1 point 0 0 0 }\n\n\nmaterial red { ambient 1 0 0 }",
        expect![[r#"
            error: material `red` is used before it is defined
              --> scene.txt:3:23
              |
            3 | plane wall { material red normal 0 0 1 point 0 0 0 }
              |                       ^^^
              .
            6 | material red { ambient 1 0 0 }
              |          --- defined here
              |
              = help: `red` is defined later, at line 6; move it before its use
        "#]],
    );
}

#[test]
fn unknown_material_and_texture() {
    check_rest(
        "plane wall { material gren normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: there is no material `gren`
              --> scene.txt:3:23
              |
            3 | plane wall { material gren normal 0 0 1 point 0 0 0 }
              |                       ^^^^
              |
              = help: did you mean `green`?
        "#]],
    );
    check_rest(
        "plane wall { material blue normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: there is no material `blue`
              --> scene.txt:3:23
              |
            3 | plane wall { material blue normal 0 0 1 point 0 0 0 }
              |                       ^^^^
              |
              = help: define material `blue` before this
        "#]],
    );
    check_rest(
        "texplane t { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 texname wood mode 0 }",
        expect![[r#"
            error: there is no texture `wood`
              --> scene.txt:3:88
              |
            3 | texplane t { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 texname wood mode 0 }
              |                                                                                        ^^^^
              |
              = help: no texture is defined before this
        "#]],
    );
}

#[test]
fn an_unknown_material_that_was_misspelt_is_one_mistake() {
    check_rest(
        "materail red { ambient 1 0 0 }\nplane wall { material red normal 0 0 1 point 0 0 0 }",
        expect![[r#"
            error: there is no entity `materail`
              --> scene.txt:3:1
              |
            3 | materail red { ambient 1 0 0 }
              | ^^^^^^^^
              |
              = help: did you mean `material`?
        "#]],
    );
}

#[test]
fn no_camera() {
    check(
        GREEN,
        expect![[r#"
        error: this scene has no camera
          --> scene.txt:1:33
          |
        1 | material green { ambient 0 5 0 }
          |                                 ^
          |
          = help: a scene needs `camera name { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }`, for example
    "#]],
    );
    check(
        "",
        expect![[r#"
        error: this scene is empty: it has no camera
          --> scene.txt:1:1
          |
        1 | 
          | ^
          |
          = help: a scene needs `camera name { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }`, for example
    "#]],
    );
    check(
        " # nothing\n",
        expect![[r#"
        error: this scene is empty: it has no camera
          --> scene.txt:1:11
          |
        1 |  # nothing
          |           ^
          |
          = help: a scene needs `camera name { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }`, for example
    "#]],
    );
    check(
        "camrea cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }",
        expect![[r#"
            error: there is no entity `camrea`
              --> scene.txt:1:1
              |
            1 | camrea cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }
              | ^^^^^^
              |
              = help: did you mean `camera`?
        "#]],
    );
}

#[test]
fn two_cameras() {
    check_rest(
        "camera other { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }",
        expect![[r#"
            error: a second camera
              --> scene.txt:3:1
              |
            1 | camera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }
              | ---------- the first camera is here
              .
            3 | camera other { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }
              | ^^^^^^^^^^^^ a scene has exactly one
              |
              = help: remove one of them
        "#]],
    );
}

#[test]
fn camera_limits() {
    check(
        "camera cam { pixeldim 0 480 worlddim 8 6 viewpoint 4 3 6 }",
        expect![[r#"
            error: `pixeldim` must be 1 to 1,000,000
              --> scene.txt:1:23
              |
            1 | camera cam { pixeldim 0 480 worlddim 8 6 viewpoint 4 3 6 }
              |                       ^
        "#]],
    );
    check(
        "camera cam { pixeldim -640 -480 worlddim 8 6 viewpoint 4 3 6 }",
        expect![[r#"
            error: `pixeldim` must be 1 to 1,000,000
              --> scene.txt:1:23
              |
            1 | camera cam { pixeldim -640 -480 worlddim 8 6 viewpoint 4 3 6 }
              |                       ^^^^^^^^^
        "#]],
    );
    check(
        "camera cam { pixeldim 640 1000000000000 worlddim 0 6 viewpoint 4 3 -6 }",
        expect![[r#"
            error: `pixeldim` must be 1 to 1,000,000
              --> scene.txt:1:27
              |
            1 | camera cam { pixeldim 640 1000000000000 worlddim 0 6 viewpoint 4 3 -6 }
              |                           ^^^^^^^^^^^^^

            error: `worlddim` must be greater than 0
              --> scene.txt:1:50
              |
            1 | camera cam { pixeldim 640 1000000000000 worlddim 0 6 viewpoint 4 3 -6 }
              |                                                  ^

            error: `viewpoint` must be in front of the screen: its z greater than 0
              --> scene.txt:1:68
              |
            1 | camera cam { pixeldim 640 1000000000000 worlddim 0 6 viewpoint 4 3 -6 }
              |                                                                    ^^
        "#]],
    );
    check(
        "camera cam { pixeldim 99999999999999999999999 1000001 worlddim 8 6 viewpoint 4 3 0 }",
        expect![[r#"
            error: `pixeldim` must be 1 to 1,000,000
              --> scene.txt:1:23
              |
            1 | camera cam { pixeldim 99999999999999999999999 1000001 worlddim 8 6 viewpoint 4 3 0 }
              |                       ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^

            error: `viewpoint` must be in front of the screen: its z greater than 0
              --> scene.txt:1:82
              |
            1 | camera cam { pixeldim 99999999999999999999999 1000001 worlddim 8 6 viewpoint 4 3 0 }
              |                                                                                  ^
        "#]],
    );
}

#[test]
fn normal_of_no_length() {
    check_rest(
        "plane wall { material green normal 0 -0 1e-999 point 0 0 0 }",
        expect![[r#"
            error: `normal` must be a direction, not 0 0 0
              --> scene.txt:3:36
              |
            3 | plane wall { material green normal 0 -0 1e-999 point 0 0 0 }
              |                                    ^^^^^^^^^^^
        "#]],
    );
}

#[test]
fn radius_and_dimension_and_shader() {
    check_rest(
        "sphere ball { material green center 0 0 0 radius 0 }\nsphere ball { material green center 0 0 0 radius -1 }\nfplane f { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 0 1 }\ntiled_plane f { material green normal 0 0 1 point 0 0 0 altmaterial green dimension 0 0 }",
        expect![[r#"
            error: `radius` must be greater than 0
              --> scene.txt:3:50
              |
            3 | sphere ball { material green center 0 0 0 radius 0 }
              |                                                  ^

            error: `radius` must be greater than 0
              --> scene.txt:4:50
              |
            4 | sphere ball { material green center 0 0 0 radius -1 }
              |                                                  ^^

            error: `dimensions` must be greater than 0
              --> scene.txt:5:74
              |
            5 | fplane f { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 0 1 }
              |                                                                          ^

            error: `dimension` must be greater than 0
              --> scene.txt:6:85
              |
            6 | tiled_plane f { material green normal 0 0 1 point 0 0 0 altmaterial green dimension 0 0 }
              |                                                                                     ^^^
        "#]],
    );
    check_rest(
        "pplane p { material green normal 0 0 1 point 0 0 0 shader 99 }\npsphere p { material green center 0 0 1 radius 1 shader 1 }\npplane p { material green normal 0 0 1 point 0 0 0 shader -1 }",
        expect![[r#"
            error: `shader` must be 0 to 2
              --> scene.txt:3:59
              |
            3 | pplane p { material green normal 0 0 1 point 0 0 0 shader 99 }
              |                                                           ^^

            error: `shader` must be 0, the only one there is
              --> scene.txt:4:57
              |
            4 | psphere p { material green center 0 0 1 radius 1 shader 1 }
              |                                                         ^

            error: `shader` must be 0 to 2
              --> scene.txt:5:59
              |
            5 | pplane p { material green normal 0 0 1 point 0 0 0 shader -1 }
              |                                                           ^^
        "#]],
    );
}

#[test]
fn material_limits() {
    check_rest(
        "material a { transparency 1.5 ambient 0 -1 0 }\nmaterial b { diffuse -1 0 -1 specular -1 shininess -2 }",
        expect![[r#"
            error: `transparency` must be 0 to 1
              --> scene.txt:3:27
              |
            3 | material a { transparency 1.5 ambient 0 -1 0 }
              |                           ^^^

            error: `ambient` must be 0 or more
              --> scene.txt:3:41
              |
            3 | material a { transparency 1.5 ambient 0 -1 0 }
              |                                         ^^

            error: `diffuse` must be 0 or more
              --> scene.txt:4:22
              |
            4 | material b { diffuse -1 0 -1 specular -1 shininess -2 }
              |                      ^^   -- and this one

            error: `specular` must be 0 or more
              --> scene.txt:4:39
              |
            4 | material b { diffuse -1 0 -1 specular -1 shininess -2 }
              |                                       ^^

            error: `shininess` must be 0 or more
              --> scene.txt:4:52
              |
            4 | material b { diffuse -1 0 -1 specular -1 shininess -2 }
              |                                                    ^^
        "#]],
    );
}

#[test]
fn light_limits() {
    check_rest(
        "spotlight s { location 0 4 0 emissivity 1 1 1 theta 0 point 4 0 -3 }\nspotlight s { location 0 4 0 emissivity 1 1 1 theta 200 point 4 0 -3 }\nlight l { location 0 0 0 emissivity 1 1 -1 }",
        expect![[r#"
            error: `theta` must be greater than 0 and at most 180 (degrees)
              --> scene.txt:3:53
              |
            3 | spotlight s { location 0 4 0 emissivity 1 1 1 theta 0 point 4 0 -3 }
              |                                                     ^

            error: `theta` must be greater than 0 and at most 180 (degrees)
              --> scene.txt:4:53
              |
            4 | spotlight s { location 0 4 0 emissivity 1 1 1 theta 200 point 4 0 -3 }
              |                                                     ^^^

            error: `emissivity` must be 0 or more
              --> scene.txt:5:41
              |
            5 | light l { location 0 0 0 emissivity 1 1 -1 }
              |                                         ^^
        "#]],
    );
    check_rest(
        "spotlight s { location 0 4 0 emissivity 1 1 1 theta 15 point 0 4 0 }",
        expect![[r#"
            error: `point` must differ from `location`: the two give the direction of the light
              --> scene.txt:3:56
              |
            3 | spotlight s { location 0 4 0 emissivity 1 1 1 theta 15 point 0 4 0 }
              |               --------------                           ^^^^^^^^^^^
              |               |                                         
              |               `location` is given here
        "#]],
    );
}

#[test]
fn xdir_along_the_normal() {
    check_rest(
        "fplane f { material green normal 0.1 0.2 0.3 point 0 0 0 xdir -0.2 -0.4 -0.6 dimensions 1 1 }",
        expect![[r#"
            error: `xdir` must not be parallel to `normal`: it is projected onto the plane
              --> scene.txt:3:58
              |
            3 | fplane f { material green normal 0.1 0.2 0.3 point 0 0 0 xdir -0.2 -0.4 -0.6 dimensions 1 1 }
              |                           ------------------             ^^^^^^^^^^^^^^^^^^^
              |                           |                               
              |                           `normal` is given here
        "#]],
    );
    check_rest(
        "tiled_plane f { material green normal 0 0 1 point 0 0 0 xdir 0 0 0 altmaterial green dimension 1 1 }",
        expect![[r#"
            error: `xdir` must be a direction, not 0 0 0
              --> scene.txt:3:62
              |
            3 | tiled_plane f { material green normal 0 0 1 point 0 0 0 xdir 0 0 0 altmaterial green dimension 1 1 }
              |                                                              ^^^^^
        "#]],
    );
}

#[test]
fn texplane_mode() {
    check_rest(
        "texplane t { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 mode 2 }",
        expect![[r#"
            error: this `texplane` lacks `texname`
              --> scene.txt:3:1
              |
            3 | texplane t { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 mode 2 }
              | ^^^^^^^^^^
              |
              = help: add `texname name`, for example

            error: `mode` must be 0 or 1
              --> scene.txt:3:85
              |
            3 | texplane t { material green normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 mode 2 }
              |                                                                                     ^
        "#]],
    );
}

#[test]
fn texture_files() {
    check_texture(
        b"P6 65536 65536 255\n0123456789",
        expect![[r#"
        error: texture `wood.ppm`: ends early: 65536 x 65536 texels are 12884901888 bytes, and there are 10
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
    "#]],
    );
    check_texture(
        b"P6 2 2 255\n0123456789",
        expect![[r#"
        error: texture `wood.ppm`: ends early: 2 x 2 texels are 12 bytes, and there are 10
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
    "#]],
    );
    check_texture(
        b"P6 0 0 255\n",
        expect![[r#"
        error: texture `wood.ppm`: has no texels: it is 0 x 0
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
    "#]],
    );
    check_texture(
        b"P6 1 1 65535\nabcdef",
        expect![[r#"
        error: texture `wood.ppm`: has maxval 65535; it must be 255
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"P3 1 1 255\n1 2 3",
        expect![[r#"
        error: texture `wood.ppm`: is a text PPM (P3), not a binary one (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"hello",
        expect![[r#"
        error: texture `wood.ppm`: is no picture that is known, not a binary PPM (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"",
        expect![[r#"
        error: texture `wood.ppm`: is empty
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"\x89PNG\r\n\x1A\n",
        expect![[r#"
        error: texture `wood.ppm`: is a PNG picture, not a binary PPM (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
}

#[test]
fn missing_texture_file() {
    check(
        format!(
            "{CAMERA}texture wood {{ filename no/such/wood.ppm }}\ntexture none {{ filename }}"
        ),
        expect![[r#"
            error: texture `no/such/wood.ppm`: there is no such file
              --> scene.txt:2:25
              |
            2 | texture wood { filename no/such/wood.ppm }
              |                         ^^^^^^^^^^^^^^^^

            error: `filename` takes a file name, found none
              --> scene.txt:3:16
              |
            3 | texture none { filename }
              |                ^^^^^^^^
        "#]],
    );
}

#[test]
fn other_files() {
    check(
        b"\xFF\xD8\xFF\xE0\0\x10JFIF",
        expect![[r#"
        error: this is a JPEG picture, not a scene
          --> scene.txt:1:1
          |
        1 | ������JFIF
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"\x89PNG\r\n\x1A\n\0",
        expect![[r#"
        error: this is a PNG picture, not a scene
          --> scene.txt:1:1
          |
        1 | �PNG
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"P6 1 1 255\nabc",
        expect![[r#"
        error: this is a PPM picture, not a scene
          --> scene.txt:1:1
          |
        1 | P6 1 1 255
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"\xFF\xFEc\0a\0",
        expect![[r#"
        error: this text is encoded in UTF-16; a scene is UTF-8
          --> scene.txt:1:1
          |
        1 | ��c�a�
          | ^
          |
          = help: save it as UTF-8
    "#]],
    );
    check(
        b"c\0a\0m\0",
        expect![[r#"
        error: this is not a scene: it holds a NUL byte
          --> scene.txt:1:2
          |
        1 | c�a�m�
          |  ^ the first one
          |
          = help: a scene is a text file in UTF-8; this may be UTF-16, or no text at all
    "#]],
    );
}

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
          = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane

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
          = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane
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
fn mistakes_that_look_like_others() {
    // A number too few, and the next attribute misspelt.
    check_rest(
        "plane wall { material green normal 0 0\nnormall 0 0 1 point 0 0 0 }",
        expect![[r#"
        error: `normal` takes 3 numbers, found 2
          --> scene.txt:3:29
          |
        3 | plane wall { material green normal 0 0
          |                             ^^^^^^^^^^ too few

        error: `plane` has no attribute `normall`
          --> scene.txt:4:1
          |
        4 | normall 0 0 1 point 0 0 0 }
          | ^^^^^^^
          |
          = help: did you mean `normal`?
    "#]],
    );
    // The type of an entity left out: what refers to it is not complained about.
    check_rest(
        "red { ambient 1 1 1 }\nplane wall { material red normal 0 0 1 point 0 0 0 }",
        expect![[r#"
        error: there is no entity `red`
          --> scene.txt:3:1
          |
        3 | red { ambient 1 1 1 }
          | ^^^
          |
          = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, texture, texplane
    "#]],
    );
    // A second `}` after a whole entity.
    check_rest(
        "material a { ambient 1 1 1 } }\nmaterial b { ambient 1 1 -1 }",
        expect![[r#"
        error: `}` closes nothing: no block is open here
          --> scene.txt:3:30
          |
        3 | material a { ambient 1 1 1 } }
          |                              ^
          |
          = help: remove it, or see whether a block before it ends too early

        error: `ambient` must be 0 or more
          --> scene.txt:4:26
          |
        4 | material b { ambient 1 1 -1 }
          |                          ^^
    "#]],
    );
    // An entity type without name and block before a whole entity.
    check_rest(
        "plane\nsphere ball { material green center 0 0 0 radius 0 }",
        expect![[r#"
            error: expected a name after `plane`, found `sphere`
              --> scene.txt:4:1
              |
            3 | plane
              | ----- this entity
            4 | sphere ball { material green center 0 0 0 radius 0 }
              | ^^^^^^
              |
              = help: an entity is written `type name { attributes }`

            error: `radius` must be greater than 0
              --> scene.txt:4:50
              |
            4 | sphere ball { material green center 0 0 0 radius 0 }
              |                                                  ^
        "#]],
    );
    // Neither name nor `{`.
    check_rest(
        "sphere center 0 0 0 radius 1 material green }",
        expect![[r#"
        error: this `sphere` has no name and no `{`
          --> scene.txt:3:8
          |
        3 | sphere center 0 0 0 radius 1 material green }
          |        ^^^^^^ expected a name and `{` before it
          |
          = help: an entity is written `type name { attributes }`
    "#]],
    );
    // A directory as a texture.
    check_rest(
        "texture wood { filename . }",
        expect![[r#"
        error: texture `.`: is a directory, not a picture
          --> scene.txt:3:25
          |
        3 | texture wood { filename . }
          |                         ^
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
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| {
        let text = scene::load(&folder.path().join(name))
            .unwrap_err()
            .to_string();
        text.replace(&folder.path().display().to_string(), "FOLDER")
            .replace('\\', "/")
    };
    std::fs::write(folder.path().join("gallery.txt"), CAMERA).unwrap();
    expect!["FOLDER/galery.txt: there is no such file (did you mean FOLDER/gallery.txt?)"]
        .assert_eq(&message("galery.txt"));
    expect!["FOLDER/gallery: there is no such file (did you mean FOLDER/gallery.txt?)"]
        .assert_eq(&message("gallery"));
    expect!["FOLDER/nothing-like-it: there is no such file"].assert_eq(&message("nothing-like-it"));
    std::fs::create_dir(folder.path().join("inner")).unwrap();
    expect!["FOLDER/inner: is a directory, not a scene"].assert_eq(&message("inner"));
    std::fs::File::create(folder.path().join("large"))
        .unwrap()
        .set_len(scene::MAX_FILE + 1)
        .unwrap();
    expect!["FOLDER/large: too large for a scene: more than 256 MiB"].assert_eq(&message("large"));
}

#[cfg(unix)]
#[test]
fn a_file_without_permission() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("secret.txt");
    std::fs::write(&path, CAMERA).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o0)).unwrap();
    match scene::load(&path) {
        // The superuser may read everything.
        Ok(_) => assert!(std::fs::read(&path).is_ok()),
        Err(error) => assert!(
            error.to_string().ends_with("secret.txt: permission denied"),
            "{error}"
        ),
    }
}

#[test]
fn a_stream_is_bounded() {
    let error = scene::load_from("<stdin>", std::io::repeat(b' '), Path::new("")).unwrap_err();
    assert!(matches!(error, LoadError::TooLarge { .. }));
    expect!["<stdin>: too large for a scene: more than 256 MiB"].assert_eq(&error.to_string());
    let error = scene::load_from("<stdin>", &b"}"[..], Path::new("")).unwrap_err();
    assert!(error.to_string().contains("<stdin>:1:1"), "{error}");
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

#[test]
fn spaces_of_a_word_processor() {
    check(
        "camera cam { pixeldim\u{A0}640 480 worlddim 8\u{A0}6 \u{A0}viewpoint 4 3 6 }",
        expect![[r#"
            error: there is a no-break space (U+00A0) in `pixeldim 640`
              --> scene.txt:1:22
              |
            1 | camera cam { pixeldim 640 480 worlddim 8 6  viewpoint 4 3 6 }
              |                      ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in `8 6`
              --> scene.txt:1:41
              |
            1 | camera cam { pixeldim 640 480 worlddim 8 6  viewpoint 4 3 6 }
              |                                         ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in ` viewpoint`
              --> scene.txt:1:44
              |
            1 | camera cam { pixeldim 640 480 worlddim 8 6  viewpoint 4 3 6 }
              |                                            ^
              |
              = help: use a plain space
        "#]],
    );
    check(
        "\u{FEFF}\u{A0}camera\u{2003}cam { pixeldim 0 }\nmaterial\u{A0}red { ambient 1 0 0 }\nsphere s { material red\ncenter 0 0 0 \u{A0}radius\u{A0}1 }\u{A0}",
        expect![[r#"
            error: there is a no-break space (U+00A0) in ` camera cam`
              --> scene.txt:1:1
              |
            1 |  camera cam { pixeldim 0 }
              | ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in `material red`
              --> scene.txt:2:9
              |
            2 | material red { ambient 1 0 0 }
              |         ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in ` radius 1`
              --> scene.txt:4:14
              |
            4 | center 0 0 0  radius 1 } 
              |              ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in ` `
              --> scene.txt:4:25
              |
            4 | center 0 0 0  radius 1 } 
              |                         ^
              |
              = help: use a plain space
        "#]],
    );
    check_rest(
        "sphere\u{A0}ball { radius 0 }\nplane wall { material\u{202F}green normal 0 0 1\u{A0}point 0 0 0 }",
        expect![[r#"
            error: there is a no-break space (U+00A0) in `sphere ball`
              --> scene.txt:3:7
              |
            3 | sphere ball { radius 0 }
              |       ^
              |
              = help: use a plain space

            error: there is a narrow no-break space (U+202F) in `material green`
              --> scene.txt:4:22
              |
            4 | plane wall { material green normal 0 0 1 point 0 0 0 }
              |                      ^
              |
              = help: use a plain space

            error: there is a no-break space (U+00A0) in `1 point`
              --> scene.txt:4:41
              |
            4 | plane wall { material green normal 0 0 1 point 0 0 0 }
              |                                         ^
              |
              = help: use a plain space
        "#]],
    );
}

#[test]
fn dashes_for_minus_signs() {
    check_rest(
        "plane wall { material green normal −3 –.5 —1 point 0 0 0 }",
        expect![[r#"
            error: `−3` is not a number
              --> scene.txt:3:36
              |
            3 | plane wall { material green normal −3 –.5 —1 point 0 0 0 }
              |                                    ^^
              |
              = help: `−` is U+2212; write -3

            error: `–.5` is not a number
              --> scene.txt:3:39
              |
            3 | plane wall { material green normal −3 –.5 —1 point 0 0 0 }
              |                                       ^^^
              |
              = help: `–` is U+2013; write -.5

            error: `—1` is not a number
              --> scene.txt:3:43
              |
            3 | plane wall { material green normal −3 –.5 —1 point 0 0 0 }
              |                                           ^^
              |
              = help: `—` is U+2014; write -1
        "#]],
    );
}

#[test]
fn comments_of_other_languages() {
    check_rest(
        "// the { left } wall\nplane wall { material green // not red\nnormal 0 0 1 /* to\nus */ point 0 0 0 ← here\n}\n/* more */",
        expect![[r#"
            error: there is no entity `//`
              --> scene.txt:3:1
              |
            3 | // the { left } wall
              | ^^
              |
              = help: comments begin with `#`

            error: `plane` has no attribute `//`
              --> scene.txt:4:29
              |
            4 | plane wall { material green // not red
              |                             ^^
              |
              = help: comments begin with `#`

            error: `plane` has no attribute `/*`
              --> scene.txt:5:14
              |
            5 | normal 0 0 1 /* to
              |              ^^
              |
              = help: comments begin with `#`

            error: `plane` has no attribute `←`
              --> scene.txt:6:19
              |
            6 | us */ point 0 0 0 ← here
              |                   ^
              |
              = help: comments begin with `#`

            error: there is no entity `/*`
              --> scene.txt:8:1
              |
            8 | /* more */
              | ^^
              |
              = help: comments begin with `#`
        "#]],
    );
}

#[test]
fn numbers_with_something_around_them() {
    check_rest(
        "plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }\npplane p { material green normal 0 0 1 point 0 0 0 shader 1; }",
        expect![[r#"
            error: `(0` is not a number
              --> scene.txt:3:36
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                    ^^
              |
              = help: write the number alone, like 0

            error: `0;` is not a number
              --> scene.txt:3:39
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                       ^^
              |
              = help: write the number alone, like 0

            error: `1)` is not a number
              --> scene.txt:3:42
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                          ^^
              |
              = help: write the number alone, like 1

            error: `1/3` is not a number
              --> scene.txt:3:51
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                                   ^^^
              |
              = help: write a quotient as a decimal number

            error: `[0]` is not a number
              --> scene.txt:3:55
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                                       ^^^
              |
              = help: write the number alone, like 0

            error: `0;x` is not a number
              --> scene.txt:3:59
              |
            3 | plane wall { material green normal (0 0; 1) point 1/3 [0] 0;x }
              |                                                           ^^^

            error: `1;` is not a whole number
              --> scene.txt:4:59
              |
            4 | pplane p { material green normal 0 0 1 point 0 0 0 shader 1; }
              |                                                           ^^
              |
              = help: write the number alone, like 1
        "#]],
    );
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

//! What stands behind an attribute: too few values, too many, no numbers; and attributes that are missing or repeated.

use expect_test::expect;

use super::{CAMERA, GREEN, check, check_rest};

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

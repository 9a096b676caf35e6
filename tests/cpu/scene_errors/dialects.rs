//! Scenes of other languages: vectors with punctuation, and the course's older language, which has no names.

use expect_test::expect;

use super::{check, check_rest, complaints};

/// One mistake, one message, whatever the brackets and wherever there are spaces.
#[test]
fn vectors_with_punctuation() {
    check(
        "camera cam { pixeldim 640, 480 worlddim 8 6 viewpoint <4,3,4> }",
        expect![[r#"
            error: `pixeldim` takes 2 numbers, found `640, 480`
              --> scene.txt:1:23
              |
            1 | camera cam { pixeldim 640, 480 worlddim 8 6 viewpoint <4,3,4> }
              |                       ^^^^^^^^
              |
              = help: no commas: write `640 480`

            error: `viewpoint` takes 3 numbers, found `<4,3,4>`
              --> scene.txt:1:55
              |
            1 | camera cam { pixeldim 640, 480 worlddim 8 6 viewpoint <4,3,4> }
              |                                                       ^^^^^^^
              |
              = help: no angle brackets or commas: write `4 3 4`
        "#]],
    );
    check_rest(
        "plane wall { material green normal < 0 , 0, 1 > point (0 0 0) }\nsphere ball { material green center [1,2,3 ] radius 0 }",
        expect![[r#"
            error: `normal` takes 3 numbers, found `< 0 , 0, 1 >`
              --> scene.txt:3:36
              |
            3 | plane wall { material green normal < 0 , 0, 1 > point (0 0 0) }
              |                                    ^^^^^^^^^^^^
              |
              = help: no angle brackets or commas: write `0 0 1`

            error: `point` takes 3 numbers, found `(0 0 0)`
              --> scene.txt:3:55
              |
            3 | plane wall { material green normal < 0 , 0, 1 > point (0 0 0) }
              |                                                       ^^^^^^^
              |
              = help: no parentheses: write `0 0 0`

            error: `center` takes 3 numbers, found `[1,2,3 ]`
              --> scene.txt:4:37
              |
            4 | sphere ball { material green center [1,2,3 ] radius 0 }
              |                                     ^^^^^^^^
              |
              = help: no brackets or commas: write `1 2 3`

            error: `radius` must be greater than 0
              --> scene.txt:4:53
              |
            4 | sphere ball { material green center [1,2,3 ] radius 0 }
              |                                                     ^
        "#]],
    );
    check_rest(
        "material m { ambient <1,2> diffuse 1,5 }",
        expect![[r#"
        error: `ambient` takes 3 numbers, found `<1,2>`
          --> scene.txt:3:22
          |
        3 | material m { ambient <1,2> diffuse 1,5 }
          |                      ^^^^^
          |
          = help: no angle brackets or commas: write `1 2`

        error: `diffuse` takes 3 numbers, found 1
          --> scene.txt:3:28
          |
        3 | material m { ambient <1,2> diffuse 1,5 }
          |                            ^^^^^^^^^^^ too few
          |
          = help: a colour is red, green, blue

        error: `1,5` is not a number
          --> scene.txt:3:36
          |
        3 | material m { ambient <1,2> diffuse 1,5 }
          |                                    ^^^
          |
          = help: numbers have a decimal point, and white space between them
    "#]],
    );
}

/// What is no vector is none: numbers alone, decimal commas, names.
#[test]
fn numbers_with_other_marks_are_told_as_before() {
    check_rest(
        "sphere s { material green center 1,5 2 3 radius (5) }",
        expect![[r#"
            error: `1,5` is not a number
              --> scene.txt:3:34
              |
            3 | sphere s { material green center 1,5 2 3 radius (5) }
              |                                  ^^^
              |
              = help: numbers have a decimal point, and white space between them

            error: `(5)` is not a number
              --> scene.txt:3:49
              |
            3 | sphere s { material green center 1,5 2 3 radius (5) }
              |                                                 ^^^
              |
              = help: write the number alone, like 5
        "#]],
    );
}

/// Signs between an attribute and its values, and behind them.
#[test]
fn values_with_signs() {
    check_rest(
        "plane wall { material = green normal = 0 0 1 point : 0 0 0 }\nsphere s { material green; center 1 2 3 radius 1; }",
        expect![[r#"
            error: `=` cannot stand behind `material`
              --> scene.txt:3:23
              |
            3 | plane wall { material = green normal = 0 0 1 point : 0 0 0 }
              |                       ^
              |
              = help: remove it

            error: `=` cannot stand behind `normal`
              --> scene.txt:3:38
              |
            3 | plane wall { material = green normal = 0 0 1 point : 0 0 0 }
              |                                      ^
              |
              = help: remove it

            error: `:` cannot stand behind `point`
              --> scene.txt:3:52
              |
            3 | plane wall { material = green normal = 0 0 1 point : 0 0 0 }
              |                                                    ^
              |
              = help: remove it

            error: there is no material `green;`
              --> scene.txt:4:21
              |
            4 | sphere s { material green; center 1 2 3 radius 1; }
              |                     ^^^^^^
              |
              = help: write `green`: white space ends a name

            error: `1;` is not a number
              --> scene.txt:4:48
              |
            4 | sphere s { material green; center 1 2 3 radius 1; }
              |                                                ^^
              |
              = help: write the number alone, like 1
        "#]],
    );
    // A name may be any of these signs.
    let named = "material = { ambient 1 1 1 }\nplane p { material = normal 0 0 1 point 0 0 -1 }";
    let told = complaints([super::CAMERA, named].concat());
    assert!(told.starts_with("no complaint"), "{told}");
}

#[test]
fn the_older_language_is_recognised() {
    check(
        "640 480   columns, rows\n8 6\n4 3 6\n\n13 wall\n0 5 0\n",
        expect![[r#"
            error: this looks like the course's older language, without names: plumb reads the one with names
              --> scene.txt:1:1
              |
            1 | 640 480   columns, rows
              | ^^^
              |
              = help: a scene begins like this one, scenes/notes/walls.txt:
                camera cam1
                {
                  pixeldim 640 480
                  worlddim 8 6
                  viewpoint 4 3 6
                }
                material green
                {
                  ambient 0 5 0
                }
        "#]],
    );
    // Whatever else is in it: its numbers mean something by their order alone, so nothing else is said.
    for text in ["10\n4 3 6 {", "# a comment\n\n1 2", "  -1.5 wall", "1"] {
        let told = complaints(text);
        assert!(told.contains("the course's older language"), "{told}");
        assert_eq!(told.matches("error:").count(), 1, "{told}");
    }
    // A number too many in a scene with names.
    let told = complaints("5 camera cam { pixeldim 6 4 worlddim 8 6 viewpoint 4 3 6 }");
    assert!(told.contains("there is no entity `5`"), "{told}");
}

/// Light cannot be taken away: what to write, and why.
#[test]
fn negative_colours_are_told_what_to_write() {
    check_rest(
        "material m { ambient 7 -3 6 }",
        expect![[r#"
            error: `ambient` must be 0 or more
              --> scene.txt:3:24
              |
            3 | material m { ambient 7 -3 6 }
              |                        ^^
              |
              = help: write `7 0 6`: light is added, and never taken away
        "#]],
    );
}

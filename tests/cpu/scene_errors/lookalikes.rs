//! Mistakes that look like others, and the habits of other programs: spaces, dashes, comments, numbers with a unit.

use expect_test::expect;

use super::{check, check_rest};

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
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, projector, texture, texplane, triangle, ptriangle, quadric, pquadric
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

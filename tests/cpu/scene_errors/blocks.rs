//! Braces that are missing or too many, and texts that end inside a block.

use expect_test::expect;

use super::check_rest;

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

//! Numbers that are numbers, and still no scene: no camera, no size, no direction.

use expect_test::expect;

use super::{GREEN, check, check_rest};

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
            error: `shader` must be 0 (tiles), 1 (angle) or 2 (blocks)
              --> scene.txt:3:59
              |
            3 | pplane p { material green normal 0 0 1 point 0 0 0 shader 99 }
              |                                                           ^^

            error: `shader` must be 0 (angle), the only one there is
              --> scene.txt:4:57
              |
            4 | psphere p { material green center 0 0 1 radius 1 shader 1 }
              |                                                         ^

            error: `shader` must be 0 (tiles), 1 (angle) or 2 (blocks)
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
              |
              = help: write `0 0 0`: light is added, and never taken away

            error: `diffuse` must be 0 or more
              --> scene.txt:4:22
              |
            4 | material b { diffuse -1 0 -1 specular -1 shininess -2 }
              |                      ^^   -- and this one
              |
              = help: write `0 0 0`: light is added, and never taken away

            error: `specular` must be 0 or more
              --> scene.txt:4:39
              |
            4 | material b { diffuse -1 0 -1 specular -1 shininess -2 }
              |                                       ^^
              |
              = help: write `0`: light is added, and never taken away

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
              |
              = help: write `1 1 0`: light is added, and never taken away
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

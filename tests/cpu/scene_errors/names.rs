//! Kinds, attributes and names that nobody knows, or that come too late.

use expect_test::expect;

use super::check_rest;

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
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, projector, texture, texplane, triangle, ptriangle, quadric, pquadric

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
        "revsurf r { }",
        expect![[r#"
            error: `revsurf` is not supported
              --> scene.txt:3:1
              |
            3 | revsurf r { }
              | ^^^^^^^
              |
              = help: the entities are camera, material, plane, sphere, tiled_plane, pplane, psphere, fplane, light, spotlight, projector, texture, texplane, triangle, ptriangle, quadric, pquadric
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
              = help: `emissivity` belongs to light, spotlight, projector; `sphere` has `material`, `center`, `radius`
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

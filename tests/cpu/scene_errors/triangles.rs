//! Triangles: the ways in which people spelt them, and what is wrong with three points.

use std::path::Path;

use expect_test::expect;
use plumb::scene::{self, Shape, list_model};

use super::{CAMERA, GREEN, check_rest};

/// The model listing of lines behind the camera and the material, without those two.
fn listed(text: &str) -> String {
    let text = format!("{CAMERA}{GREEN}{text}");
    let scene = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap();
    let mut listing = Vec::new();
    list_model(&scene, &mut listing).unwrap();
    let listing = String::from_utf8(listing).unwrap();
    listing[listing.find("triangle").unwrap()..].to_owned()
}

#[test]
fn all_spellings_are_listed_alike() {
    let expected = listed(
        "triangle t { material green vertex1 0 0 0 vertex2 8 0 -1 vertex3 4 6 -2 normal 0 0 1 point 9 9 9 }",
    );
    assert!(
        expected.contains("vertex3     4.0  6.0  -2.0"),
        "{expected}"
    );
    for rest in [
        "point1 0 0 0 point2 8 0 -1 point3 4 6 -2",
        "v1 0 0 0 v2 8 0 -1 v3 4 6 -2",
        "v0 0 0 0 v1 8 0 -1 v2 4 6 -2",
        // In any order: what `v1` and `v2` are is known by the third.
        "v1 8 0 -1 v2 4 6 -2 v0 0 0 0",
        "v2 8 0 -1 v1 0 0 0 v3 4 6 -2",
    ] {
        for kind in ["tri", "triangle"] {
            let text = format!("{kind} t {{ point 9 9 9 {rest} normal 0 0 1 material green }}");
            assert_eq!(listed(&text), expected, "{text}");
        }
    }
    // A name is not an attribute, whatever it looks like.
    let named = "material v0 { ambient 1 1 1 } tri t { material v0 v1 0 0 0 v2 8 0 -1 v3 4 6 -2 }";
    assert!(listed(named).contains("vertex1     0.0  0.0  0.0"));
}

#[test]
fn what_is_not_given_is_not_listed() {
    let listing = listed(
        "ptriangle t { material green vertex1 0 0 0 vertex2 8 0 -1 vertex3 4 6 -2 shader 1 }",
    );
    assert!(
        !listing.contains("normal") && !listing.contains("point"),
        "{listing}"
    );
    assert!(listing.contains("shader"), "{listing}");
}

#[test]
fn a_point_has_no_meaning() {
    let text = format!(
        "{CAMERA}{GREEN}tri t {{ material green v0 0 0 0 v1 8 0 -1 v2 4 6 -2 point 7 7 7 }}"
    );
    let scene = scene::parse("scene.txt", text.as_bytes(), Path::new("")).unwrap();
    let Shape::Triangle(triangle) = scene.objects[0].shape else {
        panic!("no triangle")
    };
    assert_eq!(triangle.point, Some([7.0; 3].into()));
    assert_eq!(triangle.normal, None);
}

#[test]
fn two_ways_of_spelling() {
    check_rest(
        "triangle t { material green vertex1 0 0 0 point2 8 0 -1 v3 4 6 -2 }",
        expect![[r#"
            error: `point2` beside `vertex1`: an entity is spelt in one way
              --> scene.txt:3:43
              |
            3 | triangle t { material green vertex1 0 0 0 point2 8 0 -1 v3 4 6 -2 }
              |                             -------       ^^^^^^
              |                             |              
              |                             spelt in another way here
              |
              = help: write `vertex2`

            error: `v3` beside `vertex1`: an entity is spelt in one way
              --> scene.txt:3:57
              |
            3 | triangle t { material green vertex1 0 0 0 point2 8 0 -1 v3 4 6 -2 }
              |                             -------                     ^^
              |                             |                            
              |                             spelt in another way here
              |
              = help: write `vertex3`
        "#]],
    );
}

#[test]
fn one_vertex_in_two_spellings() {
    check_rest(
        "triangle t { material green v0 0 0 0 v1 8 0 -1 vertex2 8 0 -2 v2 4 6 -2 }",
        expect![[r#"
            error: `vertex2` is given twice
              --> scene.txt:3:48
              |
            3 | triangle t { material green v0 0 0 0 v1 8 0 -1 vertex2 8 0 -2 v2 4 6 -2 }
              |                                      --------- ^^^^^^^
              |                                      |          
              |                                      first given here
              |
              = help: remove one of them
        "#]],
    );
}

#[test]
fn a_line_is_no_triangle() {
    check_rest(
        "triangle t { material green vertex1 0 0 0 vertex2 1 2 -1 vertex3 3 6 -3 }",
        expect![[r#"
            error: `vertex3` must not lie in a line with `vertex1` and `vertex2`: they are no triangle
              --> scene.txt:3:58
              |
            3 | triangle t { material green vertex1 0 0 0 vertex2 1 2 -1 vertex3 3 6 -3 }
              |                             ------------- -------------- ^^^^^^^^^^^^^^
              |                             |             |               
              |                             |             `vertex2` is given here
              |                             `vertex1` is given here
        "#]],
    );
}

#[test]
fn a_normal_in_the_plane() {
    check_rest(
        "tri t { material green v0 0 0 0 v1 1 0 0 v2 0 1 0 normal 3 4 0 }",
        expect![[r#"
            error: `normal` must not lie in the plane of the triangle: it says which side is the front
              --> scene.txt:3:51
              |
            3 | tri t { material green v0 0 0 0 v1 1 0 0 v2 0 1 0 normal 3 4 0 }
              |                        -------- -------- -------- ^^^^^^^^^^^^
              |                        |        |        |         
              |                        |        |        `vertex3` is given here
              |                        |        `vertex2` is given here
              |                        `vertex1` is given here
        "#]],
    );
}

#[test]
fn a_vertex_is_missing() {
    check_rest(
        "tri t { material green v0 0 0 0 v1 1 0 0 }",
        expect![[r#"
        error: this `triangle` lacks `vertex3`
          --> scene.txt:3:1
          |
        3 | tri t { material green v0 0 0 0 v1 1 0 0 }
          | ^^^^^
          |
          = help: add `vertex3 0 1 0`, for example
    "#]],
    );
}

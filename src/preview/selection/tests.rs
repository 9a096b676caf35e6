//! Tests of what stays selected when the scene changes, and of what things are made of.

use super::*;
use crate::scene::parse_text;

const SCENE: &str = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
material red { ambient 1 1 1 }
material blue { ambient 1 1 1 }
sphere ball { material red center 1 2 3 radius 1 }
tiled_plane floor { material blue altmaterial red normal 0 1 0 point 0 0 0 dimension 1 1 }
";

fn scene(text: &str) -> Scene {
    parse_text("test", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn what_is_selected_is_followed_through_the_file() {
    let old = scene(SCENE);
    let mut selection = Selection::default();
    selection.select(&old, Some(EntityId::Object(0)));
    assert_eq!(selection.to_be_shown(), Some(EntityId::Object(0)));
    selection.was_shown();
    assert_eq!(selection.to_be_shown(), None);
    let other = "sphere other { material red center 1 2 3 radius 1 }\n";
    let moved = SCENE.replace("sphere ball", &(other.to_owned() + "sphere ball"));
    selection.follow(&scene(&moved));
    assert_eq!(selection.entity(), Some(EntityId::Object(1)));
    selection.follow(&scene(&moved.replace("ball", "globe")));
    assert_eq!(selection.entity(), None);
    // Once more lets go of it.
    selection.click(&old, EntityId::Material(1));
    assert_eq!(
        (selection.entity(), selection.to_be_shown()),
        (Some(EntityId::Material(1)), None)
    );
    selection.click(&old, EntityId::Material(1));
    assert_eq!(selection.entity(), None);
    selection.select(&old, Some(EntityId::Light(0)));
    assert_eq!(selection.entity(), None);
}

#[test]
fn what_things_are_made_of_is_told() {
    let scene = scene(SCENE);
    let [red, blue] = [0, 1].map(EntityId::Material);
    assert_eq!(made_of(&scene, EntityId::Object(0)), [("material", red)]);
    assert_eq!(
        made_of(&scene, EntityId::Object(1)),
        [("material", blue), ("altmaterial", red)]
    );
    assert!(made_of(&scene, red).is_empty() && made_of(&scene, EntityId::Object(7)).is_empty());
}

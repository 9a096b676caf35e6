//! Tests of the steps alone: how many are kept, and how they are told. What they do is tested with the session.

use super::*;
use crate::scene::{EntityId, parse_text};

const SCENE: &str = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
material red { ambient 1 1 1 }
sphere ball { material red center 1 2 3 radius 1 }";

const RADIUS: Target = Target::new(EntityId::Object(0), "radius");

fn with_radius(scene: &Scene, radius: f64) -> Changes {
    let mut changes = Changes::new();
    changes.set(scene, RADIUS, radius).unwrap();
    changes
}

#[test]
fn a_thousand_steps_are_kept() {
    let scene = parse_text("test", SCENE.as_bytes()).unwrap();
    let mut history = History::default();
    for i in 0..STEPS + 100 {
        history.record(with_radius(&scene, 2.0 + i as f64), Step::Alone);
    }
    let mut now = with_radius(&scene, 1.5);
    let mut count = 0;
    while let Some(before) = history.go(Direction::Undo, &now) {
        now = before;
        count += 1;
    }
    assert_eq!((count, &now), (STEPS, &with_radius(&scene, 102.0)));
    assert!(!history.can_go(Direction::Undo, &now) && history.can_go(Direction::Redo, &now));
}

#[test]
fn a_step_that_changes_nothing_is_none() {
    let scene = parse_text("test", SCENE.as_bytes()).unwrap();
    let (one, two) = (with_radius(&scene, 2.0), with_radius(&scene, 3.0));
    let mut history = History::default();
    history.record(one.clone(), Step::Alone);
    history.record(two.clone(), Step::Alone);
    // Dragged away and back.
    assert_eq!(history.go(Direction::Undo, &two), Some(one.clone()));
    assert_eq!(history.go(Direction::Undo, &one), None);
}

#[test]
fn what_was_undone_is_told() {
    let scene = parse_text("test", SCENE.as_bytes()).unwrap();
    let mut changes = with_radius(&scene, 2.0);
    assert_eq!(described(&changes, &scene), "radius of sphere ball");
    changes.set(&scene, Target::VIEWPOINT, [1.0; 3]).unwrap();
    assert_eq!(
        described(&changes, &scene),
        "viewpoint of camera c, and 1 more"
    );
}

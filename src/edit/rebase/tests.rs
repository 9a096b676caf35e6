//! Tests of changes whose file is edited under them.

use super::*;
use crate::scene::parse_text;

const CAMERA: &str = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }\n";
const RED: &str = "material red { ambient 1 1 1 diffuse 2 2 2 }\n";
const BALL: &str = "sphere ball { material red center 1 2 3 radius 1 }\n";
const LAMP: &str = "light lamp { location 0 0 0 emissivity 1 1 1 }\n";

fn scene(parts: &[&str]) -> Scene {
    parse_text("test", parts.concat().as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// Changes of everything in a scene of the four above.
fn changes() -> Changes {
    let scene = &scene(&[CAMERA, RED, BALL, LAMP]);
    let mut changes = Changes::new();
    changes
        .set(scene, Target::VIEWPOINT, [1.0, 1.0, 1.0])
        .unwrap();
    changes
        .set(
            scene,
            Target::new(EntityId::Material(0), "diffuse"),
            [0.5; 3],
        )
        .unwrap();
    changes
        .set(scene, Target::new(EntityId::Object(0), "center"), [7.0; 3])
        .unwrap();
    changes
        .set(scene, Target::new(EntityId::Object(0), "radius"), 7.0)
        .unwrap();
    changes
        .set(
            scene,
            Target::new(EntityId::Light(0), "emissivity"),
            [9.0; 3],
        )
        .unwrap();
    changes
}

/// What remains of [`changes`], and what is said, when the file becomes this.
fn after(new: &[&str]) -> (Vec<Target>, Vec<String>) {
    let (old, new) = (scene(&[CAMERA, RED, BALL, LAMP]), scene(new));
    let mut changes = changes();
    let dropped = changes.rebase(&old, &new);
    for (target, value) in changes.iter() {
        assert_ne!(target.value_in(&new), Some(value));
    }
    let targets = changes.iter().map(|(target, _)| target).collect();
    (targets, dropped.iter().map(Dropped::to_string).collect())
}

fn all() -> Vec<Target> {
    changes().iter().map(|(target, _)| target).collect()
}

#[test]
fn what_does_not_touch_a_change_leaves_it() {
    let other = "material red2 { ambient 1 1 1 }\nsphere ball2 { material red2 center 0 0 0 radius 1 }\n\
                 light lamp2 { location 0 0 0 emissivity 1 1 1 }";
    assert_eq!(after(&[CAMERA, RED, BALL, LAMP]), (all(), vec![]));
    assert_eq!(after(&[BALL_AND_ALL, other]), (all(), vec![]));
    // Other attributes of the same entities, and the camera's name.
    let renamed = CAMERA
        .replace("camera c", "camera d")
        .replace("4 3 w", "5 4 w");
    let (red, lamp) = (RED.replace('1', "3"), LAMP.replace("0 0 0", "1 1 1"));
    assert_eq!(after(&[&renamed, &red, BALL, &lamp]), (all(), vec![]));
}

/// The same scene in another order.
const BALL_AND_ALL: &str = "light lamp { location 0 0 0 emissivity 1 1 1 } material red { ambient 1 1 1 diffuse 2 2 2 }\n\
    sphere ball { radius 1.0 material red center 1 2 3 } camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }\n";

#[test]
fn changes_move_with_their_entities() {
    let other = "material blue { ambient 1 1 1 diffuse 2 2 2 }\nsphere globe { material blue center 1 2 3 radius 1 }\n\
                 spotlight lamp { location 0 0 0 emissivity 1 1 1 point 1 1 1 theta 5 }\n";
    let moved = vec![
        Target::VIEWPOINT,
        Target::new(EntityId::Material(1), "diffuse"),
        Target::new(EntityId::Object(1), "center"),
        Target::new(EntityId::Object(1), "radius"),
        Target::new(EntityId::Light(1), "emissivity"),
    ];
    assert_eq!(after(&[other, CAMERA, RED, BALL, LAMP]), (moved, vec![]));
}

#[test]
fn the_file_counts_where_it_was_changed_too() {
    let camera = CAMERA.replace("4 3 6", "4 3 7");
    let red = RED.replace("2 2 2", "2 2 3");
    let ball = BALL.replace("1 2 3", "1 2 4");
    assert_eq!(
        after(&[&camera, &red, &ball, LAMP]),
        (
            vec![
                Target::new(EntityId::Object(0), "radius"),
                Target::new(EntityId::Light(0), "emissivity")
            ],
            vec![
                "camera `c`: viewpoint was changed in the file, which counts".into(),
                "material `red`: diffuse was changed in the file, which counts".into(),
                "sphere `ball`: center was changed in the file, which counts".into(),
            ]
        )
    );
}

#[test]
fn what_is_gone_is_told() {
    let marble = BALL.replace("sphere", "psphere").replace('}', "shader 0 }");
    let red = RED.replace("diffuse 2 2 2", "");
    assert_eq!(
        after(&[CAMERA, &red, &marble]),
        (
            vec![Target::VIEWPOINT],
            vec![
                "material `red`: diffuse was changed in the file, which counts".into(),
                "sphere `ball` is no longer in the file, and what was changed of its center is lost".into(),
                "sphere `ball` is no longer in the file, and what was changed of its radius is lost".into(),
                "light `lamp` is no longer in the file, and what was changed of its emissivity is lost".into(),
            ]
        )
    );
}

#[test]
fn what_was_saved_is_dropped_without_a_word() {
    let text = [CAMERA, RED, BALL, LAMP].concat();
    let mut changes = changes();
    let written = changes.write(text.as_bytes()).unwrap();
    let (old, new) = (scene(&[&text]), parse_text("written", &written).unwrap());
    assert_eq!(changes.rebase(&old, &new), []);
    assert!(changes.is_empty());
    // A value that was changed again while the file was saved stays changed.
    changes
        .set(
            &new,
            Target::new(EntityId::Light(0), "emissivity"),
            [8.0; 3],
        )
        .unwrap();
    assert_eq!(changes.rebase(&new, &new), []);
    assert_eq!(
        changes.get(Target::new(EntityId::Light(0), "emissivity")),
        Some([8.0; 3].into())
    );
}

#[test]
fn equal_names_are_told_apart_by_their_order() {
    let material =
        |name: &str, number: f64| format!("material {name} {{ ambient 1 1 {number} }}\n");
    let (first, second, third) = (material("m", 1.0), material("m", 2.0), material("m", 3.0));
    let old = scene(&[CAMERA, &first, &second, &third]);
    let mut start = Changes::new();
    start
        .set(
            &old,
            Target::new(EntityId::Material(1), "ambient"),
            [9.0; 3],
        )
        .unwrap();
    start
        .set(
            &old,
            Target::new(EntityId::Material(2), "ambient"),
            [8.0; 3],
        )
        .unwrap();
    let mut changes = start.clone();
    let new = scene(&[
        &material("n", 2.0),
        CAMERA,
        &first,
        &material("n", 5.0),
        &second,
        &third,
    ]);
    assert_eq!(changes.rebase(&old, &new), []);
    let left: Vec<_> = changes.iter().collect();
    let moved = [(3, 9.0), (4, 8.0)].map(|(index, value)| {
        (
            Target::new(EntityId::Material(index), "ambient"),
            [value; 3].into(),
        )
    });
    assert_eq!(left, moved);
    // Without the first, the third is the second, and what is said of it is not what the file said.
    let mut changes = start;
    let told: Vec<_> = changes.rebase(&old, &scene(&[CAMERA, &second, &third]));
    let told: Vec<_> = told
        .iter()
        .map(|dropped| (dropped.target, dropped.message.as_str()))
        .collect();
    assert_eq!(
        told,
        [
            (
                Target::new(EntityId::Material(1), "ambient"),
                "material `m`: ambient was changed in the file, which counts"
            ),
            (
                Target::new(EntityId::Material(2), "ambient"),
                "material `m` is no longer in the file, and what was changed of its ambient is lost"
            ),
        ]
    );
    assert!(changes.is_empty());
}

#[test]
fn changes_of_nothing_are_told_and_dropped() {
    let scene = scene(&[CAMERA]);
    let mut changes = Changes::new();
    let light = Target::new(EntityId::Light(3), "emissivity");
    assert!(changes.set(&scene, light, [1.0; 3]).is_err());
    changes.values.insert(light, [1.0; 3].into());
    assert_eq!(changes.apply(&scene), scene);
    let dropped = changes.rebase(&scene, &scene);
    assert_eq!(
        dropped[0].message,
        "something is no longer in the file, and what was changed of its emissivity is lost"
    );
    assert!(changes.is_empty());
}

#[test]
fn what_contradicts_the_file_is_dropped() {
    let floor = |normal: &str| {
        format!(
            "fplane floor {{ material red normal {normal} point 0 0 0 xdir 0 0 1 dimensions 1 1 }}"
        )
    };
    let old = scene(&[CAMERA, RED, &floor("0 1 0")]);
    let xdir = Target::new(EntityId::Object(0), "xdir");
    let mut changes = Changes::new();
    changes.set(&old, xdir, [1.0, 0.0, 0.0]).unwrap();
    let earlier = changes.clone();
    // What the file says now is parallel to it, which each of the two is not by itself.
    let new = scene(&[CAMERA, RED, &floor("2 0 0")]);
    let told: Vec<_> = changes.rebase(&old, &new);
    assert_eq!(
        told[0].to_string(),
        "fplane `floor`: what was changed of its xdir contradicts the file, which counts: `xdir` must not be parallel \
         to `normal`: it is projected onto the plane"
    );
    assert_eq!((told.len(), changes.is_empty()), (1, true));
    let mut earlier = [earlier];
    Changes::rebase_earlier(earlier.iter_mut(), &old, &new);
    assert!(earlier[0].is_empty());
}

#[test]
fn earlier_changes_count_and_not_the_file() {
    let old = scene(&[CAMERA, RED, BALL, LAMP]);
    let new = scene(&[RED, &BALL.replace("radius 1", "radius 2"), CAMERA]);
    let mut earlier = [changes(), Changes::new()];
    Changes::rebase_earlier(earlier.iter_mut(), &old, &new);
    let radius = Target::new(EntityId::Object(0), "radius");
    let light = Target::new(EntityId::Light(0), "emissivity");
    assert_eq!(earlier[0].get(radius), Some(7.0.into()));
    assert_eq!((earlier[0].len(), earlier[0].get(light)), (4, None));
    assert!(earlier[1].is_empty());
}

#[test]
fn a_large_scene_takes_no_square_of_its_size() {
    // All of one name, all changed, in another order of names: with a search for each this would take hours.
    const COUNT: usize = 200_000;
    let mut old = scene(&[CAMERA, RED, BALL, LAMP]);
    old.objects = vec![old.objects[0].clone(); COUNT];
    let mut new = old.clone();
    new.objects.insert(0, new.objects[0].clone());
    new.objects[0].name = "first".into();
    let mut changes = Changes::new();
    for index in 0..COUNT {
        changes
            .set(
                &old,
                Target::new(EntityId::Object(index), "radius"),
                2.0 + index as f64,
            )
            .unwrap();
    }
    assert_eq!(changes.rebase(&old, &new), []);
    assert_eq!(changes.len(), COUNT);
    for (place, (target, value)) in changes.iter().enumerate() {
        assert_eq!(
            (target, value),
            (
                Target::new(EntityId::Object(place + 1), "radius"),
                (2.0 + place as f64).into()
            )
        );
    }
}

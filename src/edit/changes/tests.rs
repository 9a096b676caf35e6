//! Tests of the set of changes: what it takes and what it refuses.

use super::*;
use crate::scene::parse_text;

const SCENE: &str = "\
camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
material red { ambient 1 1 1 diffuse 2 2 2 }
sphere ball { material red center 1 2 3 radius 1 }
fplane floor { material red normal 0 1 0 point 0 0 0 xdir 1 0 0 dimensions 1 1 }
triangle tri { material red v0 0 0 0 v1 1 0 0 v2 0 1 0 }
quadric cone { material red coefficients 1 -0.25 1 0 0 0 -8 2 10 -37 lower -9 0 -9 upper 9 4 9 }
pplane waves { material red normal 0 0 1 point 0 0 0 shader 0 }
light lamp { location 0 0 0 emissivity 1 1 1 }
spotlight spot { location 0 5 0 emissivity 1 1 1 point 0 0 0 theta 30 }
";

fn scene() -> Scene {
    parse_text("test", SCENE.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

const RED: EntityId = EntityId::Material(0);
const BALL: EntityId = EntityId::Object(0);
const FLOOR: EntityId = EntityId::Object(1);
const LAMP: EntityId = EntityId::Light(0);
const SPOT: EntityId = EntityId::Light(1);

fn target(entity: EntityId, attribute: &'static str) -> Target {
    Target::new(entity, attribute)
}

#[test]
fn values_keep_the_limits_of_their_attributes() {
    let scene = scene();
    let mut changes = Changes::new();
    let mut set = |entity, attribute, value: Value| match changes.set(
        &scene,
        target(entity, attribute),
        value,
    ) {
        Ok(()) => String::from("taken"),
        Err(refused) => refused.to_string(),
    };
    let camera = EntityId::Camera;
    let [_, _, triangle, cone, waves] = [0, 1, 2, 3, 4].map(EntityId::Object);
    let known = [
        (camera, "viewpoint", [1.0, 1.0, 5e-324].into(), "taken"),
        (
            camera,
            "viewpoint",
            [1.0, 1.0, 0.0].into(),
            "`viewpoint` must be in front of the screen: its z greater than 0, and is [1.0, 1.0, 0.0]",
        ),
        (camera, "pixeldim", [640.0, 480.0].into(), "taken"),
        (
            camera,
            "pixeldim",
            [640.0, 480.5].into(),
            "`pixeldim` takes whole numbers, and is [640.0, 480.5]",
        ),
        (
            camera,
            "pixeldim",
            [640.0, 0.0].into(),
            "`pixeldim` must be 1 to 1,000,000, and is [640.0, 0.0]",
        ),
        (RED, "ambient", [0.0, 1e300, 2.0].into(), "taken"),
        (
            RED,
            "ambient",
            [0.0, -1.0, 2.0].into(),
            "`ambient` must be 0 or more, and is [0.0, -1.0, 2.0]",
        ),
        (
            RED,
            "ambient",
            [0.0, f64::NAN, 2.0].into(),
            "`ambient` must be finite",
        ),
        (
            RED,
            "ambient",
            1.0.into(),
            "`ambient` takes 3 of them, not 1",
        ),
        (
            RED,
            "specular",
            1.0.into(),
            "`specular` takes 3 of them, not 1",
        ),
        (RED, "transparency", 1.0.into(), "taken"),
        (
            RED,
            "transparency",
            1.5.into(),
            "`transparency` must be 0 to 1, and is [1.5]",
        ),
        (BALL, "radius", 5e-324.into(), "taken"),
        (
            BALL,
            "radius",
            0.0.into(),
            "`radius` must be greater than 0, and is [0.0]",
        ),
        (
            BALL,
            "radius",
            [1.0; 3].into(),
            "`radius` takes 1 of them, not 3",
        ),
        (
            BALL,
            "normal",
            [1.0; 3].into(),
            "`sphere` has no numbers called `normal`",
        ),
        (
            BALL,
            "material",
            1.0.into(),
            "`sphere` has no numbers called `material`",
        ),
        (BALL, "center", [-1e300, 0.0, 0.0].into(), "taken"),
        (
            BALL,
            "center",
            [f64::INFINITY, 0.0, 0.0].into(),
            "`center` must be finite",
        ),
        (
            triangle,
            "vertex3",
            [7.0, 0.0, 0.0].into(),
            "`vertex3` must not lie in a line with `vertex1` and `vertex2`: they are no triangle",
        ),
        (triangle, "normal", Value::LEFT_OUT, "taken"),
        (
            BALL,
            "radius",
            Value::LEFT_OUT,
            "`radius` takes 1 of them, not 0",
        ),
        (
            cone,
            "upper",
            [9.0, -1.0, 9.0].into(),
            "`upper` must be greater than `lower` in x, y and z: nothing would be left between them",
        ),
        (waves, "shader", 1.0.into(), "taken"),
        (LAMP, "emissivity", [0.0; 3].into(), "taken"),
        (
            LAMP,
            "emissivity",
            [0.0, 0.0, -1.0].into(),
            "`emissivity` must be 0 or more, and is [0.0, 0.0, -1.0]",
        ),
        (
            EntityId::Light(2),
            "emissivity",
            [0.0; 3].into(),
            "there is no such entity",
        ),
    ];
    for (entity, attribute, value, answer) in known {
        assert_eq!(set(entity, attribute, value), answer, "{attribute}");
    }
    // What was refused changed nothing, and zero is positive.
    let ambient = target(RED, "ambient");
    assert_eq!(changes.get(ambient), Some([0.0, 1e300, 2.0].into()));
    changes.set(&scene, ambient, [-0.0, 1.0, 1.0]).unwrap();
    assert_eq!(changes.get(ambient).unwrap().numbers()[0].to_bits(), 0);
    assert_eq!(changes.len(), 9);
    assert_eq!(
        changes.reset(&scene, ambient),
        Ok(Some([0.0, 1.0, 1.0].into()))
    );
    assert_eq!(
        (changes.reset(&scene, ambient), changes.get(ambient)),
        (Ok(None), None)
    );
    assert!(!changes.is_empty());
    changes.clear();
    assert!(changes.is_empty());
}

#[test]
fn what_attributes_keep_between_them_is_asked_with_the_other_changes() {
    let scene = scene();
    let mut changes = Changes::new();
    let [normal, xdir] = ["normal", "xdir"].map(|name| target(FLOOR, name));
    let parallel = "`xdir` must not be parallel to `normal`: it is projected onto the plane";
    let refused = changes.set(&scene, normal, [1.0, 0.0, 0.0]).unwrap_err();
    assert_eq!(refused.to_string(), parallel);
    changes.set(&scene, xdir, [0.0, 0.0, 1.0]).unwrap();
    changes.set(&scene, normal, [1.0, 0.0, 0.0]).unwrap();
    // The file's own direction is no longer one.
    assert_eq!(
        changes.reset(&scene, xdir).unwrap_err().to_string(),
        parallel
    );
    assert_eq!(changes.get(xdir), Some([0.0, 0.0, 1.0].into()));
    changes.reset(&scene, normal).unwrap();
    changes.reset(&scene, xdir).unwrap();
    let [aim, location] = ["point", "location"].map(|name| target(SPOT, name));
    let refused = changes.set(&scene, aim, [0.0, 5.0, 0.0]).unwrap_err();
    assert!(
        refused
            .to_string()
            .starts_with("`point` must differ from `location`")
    );
    changes.set(&scene, location, [1.0, 1.0, 1.0]).unwrap();
    changes.set(&scene, aim, [0.0, 5.0, 0.0]).unwrap();
    assert_eq!(changes.len(), 2);
}

#[test]
fn changes_beyond_others_lead_to_the_same_scene() {
    let scene = scene();
    let [radius, center] = ["radius", "center"].map(|name| target(BALL, name));
    let (mut base, mut wanted) = (Changes::new(), Changes::new());
    base.set(&scene, radius, 2.0).unwrap();
    base.set(&scene, center, [0.0; 3]).unwrap();
    wanted.set(&scene, center, [0.0; 3]).unwrap();
    wanted
        .set(&scene, target(LAMP, "emissivity"), [4.0; 3])
        .unwrap();
    let beyond = wanted.beyond(&base, &scene);
    assert_eq!(
        beyond.iter().collect::<Vec<_>>(),
        [
            (radius, 1.0.into()),
            (target(LAMP, "emissivity"), [4.0; 3].into())
        ]
    );
    assert_eq!(beyond.apply(&base.apply(&scene)), wanted.apply(&scene));
    assert!(wanted.beyond(&wanted, &scene).is_empty());
}

/// The panels are made from the rows, and so is this.
#[test]
fn every_number_of_every_entity_can_be_changed() {
    let scene = scene();
    let objects = (0..scene.objects.len()).map(EntityId::Object);
    let lights = (0..scene.lights.len()).map(EntityId::Light);
    let all = [EntityId::Camera, RED]
        .into_iter()
        .chain(objects)
        .chain(lights);
    let mut names = Vec::new();
    for target in all.flat_map(|entity| Target::all_of(&scene, entity)) {
        names.push(target.attribute());
        let value = target.value_in(&scene).unwrap();
        let mut changes = Changes::new();
        changes.set(&scene, target, value).unwrap();
        assert_eq!(changes.apply(&scene), scene);
        // What may be left out can be given, and left out again.
        let mut rows = scene::number_rows(&scene, target.entity());
        let row = rows.find(|row| row.name() == target.attribute()).unwrap();
        let omitted = changes.set(&scene, target, Value::LEFT_OUT).is_ok();
        assert_eq!(omitted, row.may_be_left_out(), "{target:?}");
        if omitted {
            let without = changes.apply(&scene);
            assert_eq!(target.value_in(&without), Some(Value::LEFT_OUT));
            let mut given = Changes::new();
            given.set(&without, target, [0.5, 2.0, 3.0]).unwrap();
            let with = given.apply(&without);
            assert_eq!(target.value_in(&with), Some([0.5, 2.0, 3.0].into()));
        }
        // Each number by itself, to one that is allowed.
        for index in 0..value.numbers().len() {
            let mut numbers = value.numbers().to_vec();
            numbers[index] = if numbers[index] == 0.0 {
                1.0
            } else {
                numbers[index] / 2.0
            };
            if target.attribute() == "pixeldim" {
                numbers[index] = 7.0;
            }
            let changed = Value::new(&numbers).unwrap();
            if changes.set(&scene, target, changed).is_ok() {
                let shown = changes.apply(&scene);
                assert_eq!(target.value_in(&shown), Some(changed));
                assert_ne!(shown, scene);
            } else {
                assert!(
                    ["xdir", "vertex1", "vertex2", "vertex3", "normal"]
                        .contains(&target.attribute()),
                    "{target:?}"
                );
            }
        }
    }
    assert_eq!(names.len(), 31, "{names:?}");
}

//! Tests of the set of changes: what it takes and what it refuses.

use super::super::target::{Measure, Reflectivity};
use super::*;
use crate::scene::fault;

#[test]
fn values_keep_the_limits_of_their_attributes() {
    let mut changes = Changes::new();
    let mut set = |target, value: Value| match changes.set(target, value) {
        Ok(()) => String::from("taken"),
        Err(refused) => refused.to_string(),
    };
    let (red, ball) = (Target::Material(0, Reflectivity::Ambient), |which| {
        Target::Sphere(0, which)
    });
    let known = [
        (Target::Viewpoint, [1.0, 1.0, 5e-324].into(), "taken"),
        (
            Target::Viewpoint,
            [1.0, 1.0, 0.0].into(),
            "`viewpoint` must be in front of the screen: its z greater than 0, and is [1.0, 1.0, 0.0]",
        ),
        (red, [0.0, 1e300, 2.0].into(), "taken"),
        (
            red,
            [0.0, -1.0, 2.0].into(),
            "`ambient` must be 0 or more, and is [0.0, -1.0, 2.0]",
        ),
        (red, [0.0, f64::NAN, 2.0].into(), "`ambient` must be finite"),
        (red, 1.0.into(), "`ambient` takes 3 of them, not 1"),
        (
            Target::Material(9, Reflectivity::Specular),
            1.0.into(),
            "`specular` takes 3 of them, not 1",
        ),
        (ball(Measure::Radius), 5e-324.into(), "taken"),
        (
            ball(Measure::Radius),
            0.0.into(),
            "`radius` must be greater than 0, and is [0.0]",
        ),
        (
            ball(Measure::Radius),
            [1.0; 3].into(),
            "`radius` takes 1 of them, not 3",
        ),
        (ball(Measure::Center), [-1e300, 0.0, 0.0].into(), "taken"),
        (
            ball(Measure::Center),
            [f64::INFINITY, 0.0, 0.0].into(),
            "`center` must be finite",
        ),
        (Target::Light(0), [0.0; 3].into(), "taken"),
        (
            Target::Light(0),
            [0.0, 0.0, -1.0].into(),
            "`emissivity` must be 0 or more, and is [0.0, 0.0, -1.0]",
        ),
    ];
    for (target, value, answer) in known {
        assert_eq!(set(target, value), answer);
    }
    // What was refused changed nothing, and zero is positive.
    assert_eq!(changes.get(red), Some([0.0, 1e300, 2.0].into()));
    changes.set(red, [-0.0, 1.0, 1.0]).unwrap();
    assert_eq!(changes.get(red).unwrap().numbers()[0].to_bits(), 0);
    assert_eq!(changes.len(), 5);
    assert_eq!(changes.remove(red), Some([0.0, 1.0, 1.0].into()));
    assert_eq!((changes.remove(red), changes.get(red)), (None, None));
    let left: Vec<Target> = changes.iter().map(|(target, _)| target).collect();
    assert_eq!(
        left,
        [
            Target::Viewpoint,
            ball(Measure::Center),
            ball(Measure::Radius),
            Target::Light(0)
        ]
    );
    assert!(!changes.is_empty());
    changes.clear();
    assert!(changes.is_empty());
}

#[test]
fn entities_that_share_an_attribute_share_its_limit() {
    for (one, other, attribute) in [
        ("sphere", "psphere", "center"),
        ("sphere", "psphere", "radius"),
        ("light", "spotlight", "emissivity"),
    ] {
        for value in [-1.0, 0.0, 1.0] {
            let values = if attribute == "radius" {
                vec![value]
            } else {
                vec![value; 3]
            };
            assert_eq!(
                fault(one, attribute, &values),
                fault(other, attribute, &values)
            );
        }
    }
    assert!(fault("plane", "radius", &[1.0]).is_some());
}

//! Tests of what panels go by: names, units, limits. That every entity has its panel is tested with the panel.

use super::*;
use crate::scene::parse_text;

#[test]
fn dragged_numbers_end_at_their_limits() {
    let bounds = |least, above_least, most| Bounds {
        least,
        above_least,
        most,
    };
    assert_eq!(within(-3.0, bounds(0.0, true, 180.0), 0.25), 0.25);
    assert_eq!(within(200.0, bounds(0.0, true, 180.0), 0.25), 180.0);
    assert_eq!(within(-3.0, bounds(0.0, false, 1.0), 0.25), 0.0);
    assert_eq!(within(1e-9, bounds(0.0, true, 1.0), 0.25), 1e-9);
}

#[test]
fn a_label_that_is_left_as_it_is_changes_nothing() {
    let third = 1.0 / 3.0;
    assert_eq!(parser(third)(" 0.33333"), Some(third));
    assert_eq!(parser(third)("0.3333"), Some(0.3333));
    assert_eq!(parser(30.0)("45°"), Some(45.0));
    assert_eq!(parser(640.0)("320 px"), Some(320.0));
    assert_eq!(parser(1.0)("−2.5e3"), Some(-2500.0));
    assert_eq!(parser(1.0)("two"), None);
}

#[test]
fn every_number_has_a_name() {
    let text = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
material m { ambient 1 1 1 }
quadric q { material m coefficients 1 1 1 0 0 0 0 0 0 1 }
fplane f { material m normal 0 0 1 point 0 0 0 xdir 1 0 0 dimensions 1 1 }
spotlight s { location 0 5 0 emissivity 1 1 1 point 0 0 -5 theta 30 }";
    let scene = parse_text("test", text.as_bytes()).unwrap();
    let all = [
        EntityId::Camera,
        EntityId::Material(0),
        EntityId::Object(0),
        EntityId::Object(1),
        EntityId::Light(0),
    ];
    let mut units = Vec::new();
    for row in all
        .into_iter()
        .flat_map(|entity| scene::number_rows(&scene, entity))
    {
        assert_eq!(names(&row).len(), row.count(), "{}", row.name());
        units.push((row.name(), unit(&row)));
        assert!(speed(&row, &scene, 0.0) > 0.0, "{}", row.name());
    }
    assert!(units.contains(&("theta", "°")) && units.contains(&("pixeldim", " px")));
}

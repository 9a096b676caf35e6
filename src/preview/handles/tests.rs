//! Tests of where handles are, and of what drags make of them, without a window.

use super::*;
use crate::cpu::camera::camera_getdir;
use crate::prepare::Prepared;
use crate::preview::session::{News, Version};
use crate::preview::undo::Step;
use crate::settings::Settings;

const SCENE: &str = "\
camera cam { pixeldim 641 481  worlddim 8 6  viewpoint 4 3 6 }
material red { ambient 5 0 0 }
sphere ball { material red  center 2 4 -6  radius 2.5 }
triangle tri { material red v0 0 0 -4 v1 1 0 -4 v2 0 1 -4 }
plane floor { material red normal 0 1 0 point 1 0 -3 }
light lamp { location 4 5 -2  emissivity 3 3 3 }
spotlight spot { location 6 5 -1 emissivity 1 1 1 point 5 1 -5 theta 30 }
light behind { location 4 5 7  emissivity 3 3 3 }
sphere around { material red center 4 3 6 radius 1 }
";

const BALL: EntityId = EntityId::Object(0);

fn session() -> Session {
    let mut session = Session::new("room.txt".into(), None);
    let version = Version::read("room.txt".as_ref(), SCENE.into());
    assert!(session.news(News::Version(version)));
    session
}

fn names(session: &Session, entity: EntityId) -> Vec<&'static str> {
    let handles = of(session, Some(entity));
    handles
        .iter()
        .map(|handle| handle.target.attribute())
        .collect()
}

#[test]
fn what_has_a_place_before_the_viewpoint_has_a_handle() {
    let session = session();
    let object = EntityId::Object;
    assert_eq!(names(&session, BALL), ["center", "radius"]);
    assert_eq!(
        names(&session, object(1)),
        ["vertex1", "vertex2", "vertex3"]
    );
    assert_eq!(names(&session, object(2)), ["point"]);
    assert_eq!(names(&session, EntityId::Light(0)), ["location"]);
    assert_eq!(names(&session, EntityId::Light(1)), ["location", "point"]);
    // Behind the viewpoint, around it, or no place at all.
    for entity in [
        EntityId::Light(2),
        object(3),
        EntityId::Material(0),
        EntityId::Camera,
    ] {
        assert_eq!(names(&session, entity), [""; 0], "{entity:?}");
    }
    assert!(of(&session, None).is_empty());
}

/// Handles and pixels are where the renderer has them.
#[test]
fn rays_are_those_of_the_renderer() {
    let session = session();
    let view = View::of(&session).unwrap();
    let scene = session.wanted().unwrap().0;
    let prepared = Prepared::<f64>::new(scene, Settings::default().view());
    for [x, y] in [[0_u32, 0], [640, 480], [100, 333]] {
        let ray = camera_getdir(&prepared.camera, f64::from(x), f64::from(y));
        let wanted = DVec3::new(ray.w.x, ray.w.y, ray.w.z).normalize();
        let middle = [f64::from(x) + 0.5, f64::from(480 - y) + 0.5];
        let found = view.ray(middle).normalize();
        assert!((found - wanted).length() < 1e-12, "{found} {wanted}");
        let place = view.viewpoint + found * 7.0;
        let back = view.project(place).unwrap();
        assert!(
            (0..2).all(|i| (back[i] - middle[i]).abs() < 1e-9),
            "{back:?}"
        );
    }
}

#[test]
fn a_place_stays_under_the_mouse() {
    let mut session = session();
    for (entity, index) in [
        (BALL, 0),
        (EntityId::Light(0), 0),
        (EntityId::Light(1), 1),
        (EntityId::Object(1), 2),
    ] {
        let handle = of(&session, Some(entity))[index];
        // It was not hit in its middle, and does not jump.
        let press = [handle.at[0] + 3.0, handle.at[1] - 2.0];
        let grabbed = Grabbed::new(hit(&[handle], press, 1.0).unwrap(), press, &session);
        assert_eq!(
            grabbed.value(&session, press, false),
            session.value(handle.target)
        );
        let value = grabbed
            .value(&session, [press[0] + 40.0, press[1] + 30.0], false)
            .unwrap();
        let z = session.value(handle.target).unwrap().numbers()[2];
        assert_eq!(value.numbers()[2], z);
        assert!(session.set(handle.target, value, Step::Alone));
        let moved = of(&session, Some(entity))[index];
        let by = [0, 1].map(|i| moved.at[i] - handle.at[i]);
        assert!(
            (by[0] - 40.0).abs() < 0.1 && (by[1] - 30.0).abs() < 0.1,
            "{by:?}"
        );
        // Up is away from the viewpoint, in numbers that a person would write.
        let away = grabbed
            .value(&session, [press[0], press[1] - 30.0], true)
            .unwrap();
        assert!(away.numbers()[2] < z, "{away:?}");
        assert!(
            away.numbers()
                .iter()
                .all(|number| number.to_string().len() <= 8),
            "{away:?}"
        );
    }
}

#[test]
fn the_edge_of_a_sphere_is_where_its_handle_is() {
    let mut session = session();
    let radius = of(&session, Some(BALL))[1];
    let view = View::of(&session).unwrap();
    assert!((view.distance(DVec3::new(2.0, 4.0, -6.0), radius.at) - 2.5).abs() < 1e-9);
    let grabbed = Grabbed::new(radius, radius.at, &session);
    for by in [50.0, -30.0] {
        let mouse = [radius.at[0] + by, radius.at[1]];
        let value = grabbed.value(&session, mouse, false).unwrap();
        assert_eq!(value.numbers()[0] > 2.5, by > 0.0, "{value:?}");
        assert!(session.set(radius.target, value, Step::Alone));
        let moved = of(&session, Some(BALL))[1];
        let off = (moved.at[0] - mouse[0]).hypot(moved.at[1] - mouse[1]);
        assert!(off < 1.5, "{:?} {mouse:?}", moved.at);
    }
}

#[test]
fn the_nearest_handle_within_reach_is_hit() {
    let session = session();
    let handles = of(&session, Some(EntityId::Light(1)));
    let [x, y] = handles[1].at;
    assert_eq!(hit(&handles, [x + 9.0, y], 1.0), Some(handles[1]));
    assert_eq!(hit(&handles, [x + 9.0, y], 2.0), None);
    assert_eq!(hit(&handles, [x + 11.0, y], 1.0), None);
    assert!(hit(&handles, [x + 100.0, y], 0.1).is_some());
}

#[test]
fn a_handle_is_let_go_when_the_file_becomes_another() {
    let mut session = session();
    let handle = of(&session, Some(BALL))[0];
    let grabbed = Grabbed::new(handle, handle.at, &session);
    let text = SCENE.replace(
        "sphere ball",
        "sphere first { material red center 0 0 -9 radius 1 }\nsphere ball",
    );
    let version = Version::read("room.txt".as_ref(), text.into());
    assert!(session.news(News::Version(version)));
    assert_eq!(grabbed.value(&session, handle.at, false), None);
}

//! Undo and redo, with saving and with others who write the file: what is in the file then, to the byte.

use std::time::{Duration, Instant};

use super::*;

/// All that can be changed in a scene of every kind, with a value for each.
const ALL: &str = "\
# All kinds, in odd spellings.
camera cam { pixeldim 064 48  worlddim 8.0 6  viewpoint +4 3 6 }
texture none { filename no.ppm }
material red { ambient 5.0 0 0 specular 0.50 }
material gray { ambient 2 2 2 diffuse 1e0 1 1 shininess 5. transparency .5 }
plane floor { material gray  normal 0 1.0 0  point 0 -1 0 }
tiled_plane tiles { material gray altmaterial red normal 0 1 0 point 0 -2. 0 dimension 1.0 1.0 xdir 1.0 0 0 }
sphere ball { material red  center 4 3 -5.0  radius 2.50 }
fplane sheet { material red normal 0 0 1. point 0 0 -9 xdir 1 0 0 dimensions 2.0 2 }
triangle tri { material red v0 0 0 -4.0 v1 1 0 -4 v2 0 1 -4 normal 0 0 1. }
quadric cone { material red coefficients 1.0 -0.25 1 0 0 0 -8 2 10 -37 lower -9 0 -9 upper 9. 4 9 }
pplane waves { material gray normal 0 0 1 point 0 0 -20. shader 00 }
light lamp { location 4.0 5 -2  emissivity 3.0 3 3 }
spotlight spot { location 0 5 0 emissivity 1.0 1 1 point 0 0 -5.0 theta 30.0 }
";

fn text(session: &Session) -> String {
    fs::read_to_string(&session.path).unwrap()
}

fn all_targets(scene: &Scene) -> Vec<Target> {
    let all = [EntityId::Camera].into_iter();
    let all = all.chain((0..scene.materials.len()).map(EntityId::Material));
    let all = all.chain((0..scene.objects.len()).map(EntityId::Object));
    let all = all.chain((0..scene.lights.len()).map(EntityId::Light));
    all.flat_map(|entity| Target::all_of(scene, entity))
        .filter(|target| target.value_in(scene).is_some())
        .collect()
}

#[test]
fn every_kind_of_change_is_undone_byte_for_byte_and_done_again() {
    let (_folder, mut session) = session(&ALL.replace("texture none { filename no.ppm }\n", ""));
    let before = text(&session);
    let targets = all_targets(&session.good().unwrap().scene);
    let mut names: Vec<_> = targets.iter().map(|target| target.attribute()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 25, "{names:?}");
    for target in targets {
        let value = session.value(target).unwrap();
        let mut numbers = value.numbers().to_vec();
        if numbers.is_empty() {
            numbers = vec![1.0, 2.0, 3.0];
        }
        let last = numbers.len() - 1;
        numbers[last] = match target.attribute() {
            "transparency" => 0.25,
            "vertex3" => -7.0,
            _ => numbers[last] + 1.0,
        };
        let changed = Value::new(&numbers).unwrap();
        assert!(
            session.set(target, changed, Step::Alone),
            "{target:?} {:?}",
            session.said
        );
        undone_and_done_again(&mut session, target, value, &before);
    }
}

/// Saves, undoes and redoes the change that was made to a file with this text, where the target had this value.
fn undone_and_done_again(session: &mut Session, target: Target, value: Value, before: &str) {
    save(session).unwrap();
    let after = text(session);
    assert_ne!(after, before, "{target:?}");
    // What the watcher tells of it is no news, and nothing is forgotten over it.
    assert!(!tell(session, &after));
    assert!(session.step_back(Direction::Undo), "{target:?}");
    assert_eq!(session.value(target), Some(value));
    save(session).unwrap();
    assert_eq!(text(session), before, "{target:?}");
    assert!(session.step_back(Direction::Redo));
    save(session).unwrap();
    assert_eq!(text(session), after, "{target:?}");
    assert!(session.step_back(Direction::Undo));
    save(session).unwrap();
    assert_eq!(text(session), before);
    assert!(session.unsaved().is_empty());
}

#[test]
fn leaving_out_is_undone_byte_for_byte_and_done_again() {
    // A triangle's point, which the scene of all kinds does not give.
    let all = ALL
        .replace("texture none { filename no.ppm }\n", "")
        .replace("normal 0 0 1. }", "normal 0 0 1. point 1 1. 9 }");
    let (_folder, mut session) = session(&all);
    let mut names = Vec::new();
    for target in all_targets(&session.good().unwrap().scene) {
        let value = session.value(target).unwrap();
        // What has to be given is refused.
        if session.set(target, Value::LEFT_OUT, Step::Alone) {
            names.push(target.attribute());
            undone_and_done_again(&mut session, target, value, &all);
        }
    }
    assert_eq!(names, ["xdir", "normal", "point", "lower", "upper"]);
}

#[test]
fn discarding_is_a_step_too() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    session.set(RED, DVec3::ONE.into(), Step::Alone);
    let both = session.unsaved();
    assert!(session.discard(None));
    assert!(session.step_back(Direction::Undo));
    assert_eq!(session.unsaved(), both);
    assert!(session.discard(Some(RED)));
    assert!(session.step_back(Direction::Undo));
    assert_eq!(session.unsaved(), both);
    assert!(session.step_back(Direction::Redo));
    assert_eq!(session.unsaved().len(), 1);
    // Another change, and what was undone is gone.
    session.step_back(Direction::Undo);
    session.set(RADIUS, 4.0.into(), Step::Alone);
    assert!(!session.step_back(Direction::Redo));
    assert_eq!(session.said.last().unwrap(), "nothing to redo");
}

#[test]
fn what_is_refused_is_no_step() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    assert!(!session.set(RADIUS, (-1.0).into(), Step::Alone));
    assert!(session.step_back(Direction::Undo));
    assert!(session.unsaved().is_empty());
    assert!(!session.step_back(Direction::Undo));
}

#[test]
fn a_drag_is_one_step_and_so_is_a_run_of_the_wheel() {
    let (_folder, mut session) = session(SCENE);
    let start = Instant::now();
    let at = |milliseconds| start + Duration::from_millis(milliseconds);
    for i in 1..=5 {
        session.set(RADIUS, f64::from(i).into(), Step::Held(RADIUS, 1));
    }
    for (i, when) in [(6, 0), (7, 300), (8, 900), (9, 5000)] {
        session.set(RADIUS, f64::from(i).into(), Step::Run(RADIUS, at(when)));
    }
    session.set(RADIUS, 10.0.into(), Step::Held(RADIUS, 2));
    session.set(RED, DVec3::ONE.into(), Step::Held(RED, 2));
    let mut seen = vec![session.value(RADIUS).unwrap().numbers()[0]];
    while session.step_back(Direction::Undo) {
        seen.push(session.value(RADIUS).unwrap().numbers()[0]);
    }
    assert_eq!(seen, [10.0, 10.0, 9.0, 8.0, 5.0, 2.5]);
}

#[test]
fn what_was_saved_in_the_middle_of_a_drag_can_be_gone_back_to() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Held(RADIUS, 1));
    save(&mut session).unwrap();
    session.set(RADIUS, 4.0.into(), Step::Held(RADIUS, 1));
    assert!(session.step_back(Direction::Undo));
    assert_eq!(session.value(RADIUS), Some(3.0.into()));
    assert!(session.unsaved().is_empty());
}

#[test]
fn what_others_write_is_not_undone() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    save(&mut session).unwrap();
    let other = text(&session).replace("2 2 2", "1 1 1");
    assert!(tell(&mut session, &other));
    // The step lies on top of what they wrote.
    assert!(session.step_back(Direction::Undo));
    save(&mut session).unwrap();
    assert_eq!(text(&session), other.replace("radius 3", "radius 2.5"));
    assert!(session.step_back(Direction::Redo));
    save(&mut session).unwrap();
    assert_eq!(text(&session), other);
}

#[test]
fn what_the_file_took_away_can_be_brought_back() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    assert!(tell(&mut session, &SCENE.replace("2.50", "4")));
    assert_eq!(session.value(RADIUS), Some(4.0.into()));
    assert!(session.step_back(Direction::Undo));
    assert_eq!(session.value(RADIUS), Some(3.0.into()));
    // And before that nothing was changed.
    assert!(session.step_back(Direction::Undo));
    assert_eq!(session.value(RADIUS), Some(4.0.into()));
    assert!(session.unsaved().is_empty());
}

/// The watcher may see what is saved before who saved it is told.
#[test]
fn what_is_saved_is_known_whoever_tells_first() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    let saving = session.saving().unwrap();
    let (version, _) = saving
        .run(|text, changes| session.expect(text, changes))
        .unwrap();
    let written = text(&session);
    assert!(!tell(&mut session, &written));
    assert!(session.unsaved().is_empty());
    assert!(!session.finish_saving(Some(version)));
    session.step_back(Direction::Undo);
    save(&mut session).unwrap();
    assert_eq!(text(&session), SCENE);
    // Somebody else is quicker than who saved it is told: what they wrote counts.
    session.set(RADIUS, 5.0.into(), Step::Alone);
    let saving = session.saving().unwrap();
    let (version, _) = saving
        .run(|text, changes| session.expect(text, changes))
        .unwrap();
    let theirs = SCENE.replace("2.50", "7");
    assert!(tell(&mut session, &theirs));
    session.finish_saving(Some(version));
    assert_eq!(session.value(RADIUS), Some(7.0.into()));
}

/// Changes that were made while the file was written are not in it.
#[test]
fn what_is_changed_while_it_is_saved_stays_changed() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    let saving = session.saving().unwrap();
    session.set(RADIUS, 3.5.into(), Step::Alone);
    let (version, _) = saving
        .run(|text, changes| session.expect(text, changes))
        .unwrap();
    session.finish_saving(Some(version));
    assert_eq!(session.value_in_file(RADIUS), Some(3.0.into()));
    assert_eq!(session.unsaved().get(RADIUS), Some(3.5.into()));
    save(&mut session).unwrap();
    assert_eq!(text(&session), SCENE.replace("2.50", "3.5"));
}

#[test]
fn the_size_that_was_asked_for_cannot_be_changed_in_the_file() {
    let mut session = Session::new("room.txt".into(), Some([30, 20]));
    let version = Version::read("room.txt".as_ref(), SCENE.into());
    assert!(session.news(News::Version(version)));
    let target = Target::new(EntityId::Camera, "pixeldim");
    assert!(!session.set(target, [10.0, 10.0].into(), Step::Alone));
    assert_eq!(shown(&session).camera.pixeldim, [30, 20]);
    assert_eq!(session.value_in_file(target), Some([64.0, 48.0].into()));
}

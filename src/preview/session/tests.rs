//! What becomes of news of the file and of changes on top of it, without a window.

mod steps;

use std::fs;

use glam::DVec3;
use tempfile::TempDir;

use super::*;

const SCENE: &str = "\
# A room, with a word about it.
camera cam { pixeldim 64 48  worlddim 8 6  viewpoint 4 3 6 }
material red
{
    ambient 5.0 0 0   # bright
    diffuse 1 0 0
}
material gray { ambient 2 2 2 }
sphere ball { material red  center 4 3 -5  radius 2.50 }
plane floor { material gray  normal 0 1 0  point 0 -1 0 }
";

/// A file with this text, and a session of it.
fn session(text: &str) -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.txt");
    fs::write(&path, text).unwrap();
    let mut session = Session::new(path, None);
    assert!(tell(&mut session, text));
    (folder, session)
}

/// The file has this text now, and the session is told.
fn tell(session: &mut Session, text: &str) -> bool {
    fs::write(&session.path, text).unwrap();
    let version = Version::read(&session.path, text.into());
    session.news(News::Version(version))
}

/// The scene as it is to be rendered.
fn shown(session: &Session) -> Scene {
    let (scene, changes) = session.wanted().unwrap();
    changes.apply(scene)
}

/// Saves, as the window does with threads between.
fn save(session: &mut Session) -> Result<(), String> {
    let saving = session.saving()?;
    let saved = saving.run(|text, changes| session.expect(text, changes));
    let (version, said) = match saved {
        Ok((version, said)) => (Some(version), said),
        Err(why) => {
            session.finish_saving(None);
            return Err(why);
        }
    };
    session.said.push(said);
    // What is shown is what was shown before.
    assert!(!session.finish_saving(version));
    Ok(())
}

const RED: Target = Target::new(EntityId::Material(0), "ambient");
const RADIUS: Target = Target::new(EntityId::Object(0), "radius");

#[test]
fn a_mistake_leaves_what_there_was() {
    let (_folder, mut session) = session(SCENE);
    let good = shown(&session);
    assert!(!tell(&mut session, &SCENE.replace("radius", "radios")));
    let Some(Trouble::Mistakes(Mistakes { text, .. })) = &session.trouble else {
        panic!("{:?}", session.trouble);
    };
    assert!(
        text.contains("room.txt:9:") && text.contains("radius"),
        "{text}"
    );
    assert_eq!(shown(&session), good);
    assert!(!session.news(News::Gone));
    assert_eq!(
        (session.trouble.as_ref(), shown(&session)),
        (Some(&Trouble::Gone), good.clone())
    );
    // Back as it was: the trouble is over, and there is nothing new to be rendered.
    assert!(!tell(&mut session, SCENE));
    assert_eq!((&session.trouble, shown(&session)), (&None, good));
}

#[test]
fn only_what_changes_the_scene_is_rendered_again() {
    let (_folder, mut session) = session(SCENE);
    assert!(!tell(&mut session, &SCENE.replace("bright", "very bright")));
    assert!(tell(&mut session, &SCENE.replace("2.50", "2.51")));
}

#[test]
fn a_file_that_begins_with_a_mistake_is_shown_once_it_is_mended() {
    let mut session = Session::new("room.txt".into(), None);
    let version = |text: &str| News::Version(Version::read("room.txt".as_ref(), text.into()));
    assert!(!session.news(version("camera cam {")));
    assert!(session.wanted().is_none() && session.trouble.is_some());
    assert!(save(&mut session).is_err());
    assert!(!session.set(RED, DVec3::ONE.into(), Step::Alone));
    assert!(session.news(version(SCENE)));
    assert!(session.wanted().is_some() && session.trouble.is_none());
}

#[test]
fn the_size_that_was_asked_for_stays_whatever_the_file_says() {
    let mut session = Session::new("room.txt".into(), Some([30, 20]));
    let version = |text: &str| News::Version(Version::read("room.txt".as_ref(), text.into()));
    assert!(session.news(version(SCENE)));
    assert_eq!(shown(&session).camera.pixeldim, [30, 20]);
    assert!(session.news(version(&SCENE.replace("viewpoint 4", "viewpoint 5"))));
    assert_eq!(shown(&session).camera.pixeldim, [30, 20]);
    // The file's own is what is read of it.
    assert_eq!(session.good().unwrap().scene.camera.pixeldim, [64, 48]);
}

#[test]
fn a_change_to_what_the_file_has_is_none() {
    let (_folder, mut session) = session(SCENE);
    assert!(session.set(RADIUS, 3.0.into(), Step::Alone));
    assert_eq!(session.unsaved().len(), 1);
    assert!(!session.set(RADIUS, 3.0.into(), Step::Alone));
    assert!(session.set(RADIUS, 2.5.into(), Step::Alone));
    assert!(session.unsaved().is_empty());
}

#[test]
fn what_the_language_forbids_is_said_and_changes_nothing() {
    let (_folder, mut session) = session(SCENE);
    assert!(!session.set(RADIUS, (-1.0).into(), Step::Alone));
    assert!(!session.set(
        Target::VIEWPOINT,
        DVec3::new(4.0, 3.0, 0.0).into(),
        Step::Alone
    ));
    assert_eq!(session.said.len(), 2, "{:?}", session.said);
    assert!(session.unsaved().is_empty());
}

#[test]
fn changes_are_discarded_one_by_one_or_all() {
    let (_folder, mut session) = session(SCENE);
    let file = shown(&session);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    session.set(RED, DVec3::new(1.0, 2.0, 3.0).into(), Step::Alone);
    assert!(session.discard(Some(RADIUS)));
    assert!(!session.discard(Some(RADIUS)));
    assert_eq!(session.value(RADIUS), Some(2.5.into()));
    assert_eq!(session.unsaved().len(), 1);
    assert!(session.discard(None));
    assert_eq!(shown(&session), file);
}

#[test]
fn looking_around_is_nothing_to_lose() {
    let (_folder, mut session) = session(SCENE);
    session.set(
        Target::VIEWPOINT,
        DVec3::new(5.0, 3.0, 6.0).into(),
        Step::Alone,
    );
    assert_eq!((session.unsaved().len(), session.to_be_lost()), (1, 0));
    session.set(RADIUS, 3.0.into(), Step::Alone);
    assert_eq!((session.unsaved().len(), session.to_be_lost()), (2, 1));
}

#[test]
fn saving_writes_numbers_and_nothing_else() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    session.set(RED, DVec3::new(5.0, 0.25, 0.0).into(), Step::Alone);
    session.set(
        Target::VIEWPOINT,
        DVec3::new(4.5, 3.0, 6.0).into(),
        Step::Alone,
    );
    let wanted = shown(&session);
    save(&mut session).unwrap();
    let text = fs::read_to_string(&session.path).unwrap();
    let expected = SCENE
        .replace("2.50", "3")
        .replace("5.0 0 0 ", "5.0 0.25 0 ")
        .replace("viewpoint 4 ", "viewpoint 4.5 ");
    assert_eq!(text, expected);
    assert!(session.unsaved().is_empty());
    assert_eq!(shown(&session), wanted);
    // What the watcher tells of it then is no news.
    assert!(!tell(&mut session, &text));
    assert!(
        session.said.iter().any(|said| said.contains("3 changes")),
        "{:?}",
        session.said
    );
}

#[test]
fn what_was_written_meanwhile_is_not_written_over() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    // Somebody saved, and the watcher has not told yet.
    let other = SCENE.replace("2 2 2", "1 1 1");
    fs::write(&session.path, &other).unwrap();
    assert!(save(&mut session).is_err());
    assert_eq!(fs::read_to_string(&session.path).unwrap(), other);
    // Once it has, the change lies on top of that.
    assert!(tell(&mut session, &other));
    save(&mut session).unwrap();
    assert_eq!(
        fs::read_to_string(&session.path).unwrap(),
        other.replace("2.50", "3")
    );
}

#[test]
fn a_file_with_a_mistake_or_gone_is_not_saved_into() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    let broken = SCENE.replace("sphere ball {", "sphere ball");
    tell(&mut session, &broken);
    assert!(save(&mut session).unwrap_err().contains("mistake"));
    assert_eq!(fs::read_to_string(&session.path).unwrap(), broken);
    fs::remove_file(&session.path).unwrap();
    session.news(News::Gone);
    assert!(save(&mut session).unwrap_err().contains("gone"));
    assert!(!session.path.exists());
    assert_eq!(session.unsaved().len(), 1);
}

#[test]
fn changes_lie_on_top_of_what_the_file_becomes() {
    let (_folder, mut session) = session(SCENE);
    session.set(RADIUS, 3.0.into(), Step::Alone);
    session.set(RED, DVec3::new(1.0, 2.0, 3.0).into(), Step::Alone);
    // Another material before it, and another ambient for the changed one.
    let edited = SCENE
        .replace(
            "material red\n",
            "material blue { ambient 0 0 1 }\nmaterial red\n",
        )
        .replace("5.0 0 0", "6 0 0");
    assert!(tell(&mut session, &edited));
    assert_eq!(session.value(RADIUS), Some(3.0.into()));
    let red = Target::new(EntityId::Material(1), "ambient");
    assert_eq!(session.value(red), Some(DVec3::new(6.0, 0.0, 0.0).into()));
    assert_eq!(session.unsaved().len(), 1);
    assert!(
        session.said.iter().any(|said| said.contains("red")),
        "{:?}",
        session.said
    );
    // And without the sphere there is nothing left to change.
    let gone = edited.replace(
        "sphere ball { material red  center 4 3 -5  radius 2.50 }\n",
        "",
    );
    assert!(tell(&mut session, &gone));
    assert!(session.unsaved().is_empty());
    assert!(
        session.said.iter().any(|said| said.contains("ball")),
        "{:?}",
        session.said
    );
}

#[test]
fn everything_is_found_in_the_file() {
    let (_folder, session) = session(SCENE);
    let source = session.source(EntityId::Object(1)).unwrap();
    assert_eq!(source.line, 10);
    assert!(source.text.starts_with("plane floor {") && source.text.ends_with('}'));
    assert_eq!(session.source(EntityId::Material(0)).unwrap().line, 3);
    assert_eq!(session.source(EntityId::Light(0)), None);
}

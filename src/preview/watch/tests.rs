//! Watching real files. What has to come is waited for, for as long as a machine may need; what must not come is shown
//! not to by what comes after it. Over many saves: [`long`].

mod long;

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use tempfile::TempDir;

use super::*;
use crate::scene::MAX_FILE;

/// No machine is slower than this.
const DEADLINE: Duration = Duration::from_secs(60);

/// What the window has.
const BOTH: Senses = Senses {
    listen: true,
    look: LOOK,
};

/// Signs of the system, and looks only where one has to be sure: a test that lasts until the next look fails.
const ONLY_EARS: Senses = Senses {
    listen: true,
    look: Duration::from_secs(3600),
};

/// Looks alone.
const ONLY_EYES: Senses = Senses {
    listen: false,
    look: LOOK,
};

/// A file in a folder of its own, and who watches it.
struct Bench {
    _root: TempDir,
    folder: PathBuf,
    file: PathBuf,
    news: Receiver<News>,
    watcher: Watcher,
}

impl Bench {
    /// The file has this text, which the watcher has told.
    fn new(senses: Senses, text: &str) -> Bench {
        let bench = Bench::unread(senses, |folder| {
            let file = folder.join("scene.txt");
            fs::write(&file, text).unwrap();
            file
        });
        bench.expect_text(text);
        bench
    }

    /// The watcher has told nothing yet. `prepare` is given an empty folder and says what is to be watched.
    fn unread(senses: Senses, prepare: impl FnOnce(&Path) -> PathBuf) -> Bench {
        let root = TempDir::new().unwrap();
        let folder = root.path().join("folder");
        fs::create_dir(&folder).unwrap();
        let file = prepare(&folder);
        let (sender, news) = mpsc::channel();
        // Nobody listens any more while a test ends.
        let tell = move |news| drop(sender.send(news));
        let watcher = if senses == BOTH {
            Watcher::new(&file, tell)
        } else {
            Watcher::with(senses, &file, tell)
        };
        Bench {
            _root: root,
            folder,
            file,
            news,
            watcher: watcher.unwrap(),
        }
    }

    fn next(&self) -> News {
        self.news
            .recv_timeout(DEADLINE)
            .expect("news within the deadline")
    }

    /// The next news are this text; but a file that is written over is empty for a moment, which a machine may draw
    /// out.
    #[track_caller]
    fn expect_text(&self, text: &str) {
        let mut next = self.next();
        if next == News::Text(Vec::new()) {
            next = self.next();
        }
        assert_eq!(next, News::Text(text.into()));
    }

    /// Waits for this text; says what came before it.
    #[track_caller]
    fn expect_at_last(&self, text: &str) -> Vec<News> {
        let mut before = Vec::new();
        loop {
            match self.next() {
                News::Text(found) if found == text.as_bytes() => return before,
                other => before.push(other),
            }
        }
    }

    fn write(&self, text: &str) {
        fs::write(&self.file, text).unwrap();
    }

    /// Writes beside the file and renames over it.
    fn replace(&self, text: &str) {
        let beside = self.folder.join(".scene.txt.swp");
        fs::write(&beside, text).unwrap();
        fs::rename(&beside, &self.file).unwrap();
    }
}

/// With the ways of noticing apart, so that neither hides that the other is broken.
fn each_way(test: impl Fn(Senses)) {
    test(ONLY_EARS);
    test(ONLY_EYES);
}

#[test]
fn a_written_file_is_told() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        bench.write("two");
        bench.expect_text("two");
        // As long as before.
        bench.write("owt");
        bench.expect_text("owt");
        let mut file = File::options().append(true).open(&bench.file).unwrap();
        file.write_all(b" and more").unwrap();
        bench.expect_text("owt and more");
    });
}

#[test]
fn a_file_renamed_over_it_is_told() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        for text in ["two", "three", "four"] {
            bench.replace(text);
            bench.expect_text(text);
        }
    });
}

#[test]
fn a_file_moved_aside_first_is_told() {
    let bench = Bench::new(BOTH, "one");
    for text in ["two", "three"] {
        fs::rename(&bench.file, bench.folder.join("scene.txt~")).unwrap();
        bench.write(text);
        bench.expect_at_last(text);
    }
}

#[test]
fn a_save_in_several_steps_ends_with_the_last() {
    let bench = Bench::new(BOTH, "one");
    for round in 0..20 {
        let text = format!("text {round}");
        // Empty for a moment, then written, then once more.
        let mut file = File::create(&bench.file).unwrap();
        let (half, rest) = text.as_bytes().split_at(3);
        file.write_all(half).unwrap();
        file.write_all(rest).unwrap();
        drop(file);
        bench.replace(&text);
        // On a machine that is slow enough the half is seen, or the emptiness; nothing else.
        for news in bench.expect_at_last(&text) {
            assert!(
                [half, b""].map(|t| News::Text(t.into())).contains(&news) || news == News::Gone,
                "{news:?}"
            );
        }
    }
}

#[test]
fn the_same_text_again_is_not_told() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        for _ in 0..20 {
            bench.replace("one");
        }
        bench.replace("two");
        assert_eq!(bench.next(), News::Text("two".into()));
    });
}

#[test]
fn a_deleted_file_is_told_once_and_its_return_as_well() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        fs::remove_file(&bench.file).unwrap();
        assert_eq!(bench.next(), News::Gone);
        // The same text is news: it is back.
        bench.write("one");
        bench.expect_at_last("one");
        fs::remove_file(&bench.file).unwrap();
        assert_eq!(bench.next(), News::Gone);
        bench.replace("two");
        bench.expect_text("two");
    });
}

#[test]
fn a_file_that_stays_empty_is_told() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        bench.write("");
        assert_eq!(bench.next(), News::Text(Vec::new()));
        bench.write("two");
        bench.expect_text("two");
    });
}

#[test]
fn what_is_not_there_yet_is_waited_for() {
    let bench = Bench::unread(BOTH, |folder| folder.join("sub").join("scene.txt"));
    assert_eq!(bench.next(), News::Gone);
    fs::create_dir(bench.folder.join("sub")).unwrap();
    bench.write("one");
    bench.expect_at_last("one");
}

#[test]
fn a_folder_in_its_place_is_told() {
    let bench = Bench::new(BOTH, "one");
    fs::remove_file(&bench.file).unwrap();
    fs::create_dir(&bench.file).unwrap();
    let why = format!("{}: is a directory, not a scene", bench.file.display());
    assert_eq!(bench.next(), News::Unreadable(why));
    fs::remove_dir(&bench.file).unwrap();
    bench.write("two");
    bench.expect_at_last("two");
}

#[test]
fn a_file_that_is_too_large_is_told_and_not_read() {
    let bench = Bench::new(BOTH, "one");
    // A hole, which takes no room.
    File::create(&bench.file)
        .unwrap()
        .set_len(MAX_FILE + 1)
        .unwrap();
    let why = format!(
        "{}: too large for a scene: more than 256 MiB",
        bench.file.display()
    );
    assert_eq!(bench.next(), News::Unreadable(why));
    bench.write("two");
    bench.expect_at_last("two");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_waited_for() {
    let bench = Bench::new(BOTH, "one");
    fs::remove_file(&bench.file).unwrap();
    let made = std::process::Command::new("mkfifo")
        .arg(&bench.file)
        .status();
    assert!(made.unwrap().success());
    let news = bench.next();
    assert!(
        matches!(&news, News::Unreadable(why) if why.ends_with("not a file, which alone can be watched")),
        "{news:?}"
    );
    bench.replace("two");
    bench.expect_at_last("two");
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_where_it_leads() {
    use std::os::unix::fs::symlink;
    each_way(|senses| {
        let bench = Bench::unread(senses, |folder| {
            for name in ["a", "b"] {
                fs::create_dir(folder.join(name)).unwrap();
                fs::write(folder.join(name).join("real.txt"), name).unwrap();
            }
            // A link to a link to the file, each in a folder of its own.
            fs::create_dir(folder.join("links")).unwrap();
            symlink("../a/real.txt", folder.join("links/link.txt")).unwrap();
            symlink("links/link.txt", folder.join("scene.txt")).unwrap();
            folder.join("scene.txt")
        });
        bench.expect_text("a");
        // The file itself, written and replaced.
        let real = bench.folder.join("a/real.txt");
        fs::write(&real, "a written").unwrap();
        bench.expect_text("a written");
        fs::write(bench.folder.join("a/new.txt"), "a replaced").unwrap();
        fs::rename(bench.folder.join("a/new.txt"), &real).unwrap();
        bench.expect_text("a replaced");
        // The link in between is turned to another file, which is listened to from then on.
        symlink("../b/real.txt", bench.folder.join("links/new")).unwrap();
        fs::rename(
            bench.folder.join("links/new"),
            bench.folder.join("links/link.txt"),
        )
        .unwrap();
        bench.expect_text("b");
        fs::write(bench.folder.join("b/real.txt"), "b written").unwrap();
        bench.expect_text("b written");
        fs::remove_file(bench.folder.join("b/real.txt")).unwrap();
        assert_eq!(bench.next(), News::Gone);
    });
}

#[test]
fn a_folder_that_is_deleted_and_made_again_is_watched_again() {
    for senses in [ONLY_EYES, ONLY_EARS] {
        let bench = Bench::new(senses, "one");
        for round in 0..3 {
            fs::remove_dir_all(&bench.folder).unwrap();
            if round == 0 {
                assert_eq!(bench.next(), News::Gone);
            }
            // At once, in the other rounds: the new folder may even have the number of the old one.
            fs::create_dir(&bench.folder).unwrap();
            let back = format!("back {round}");
            bench.write(&back);
            bench.expect_at_last(&back);
            bench.write("again");
            bench.expect_at_last("again");
        }
    }
}

#[test]
fn a_folder_that_is_replaced_as_a_whole_is_watched_again() {
    // Nothing happens in the folder that is listened to if it is its parent that is another one; so one has to look.
    let bench = Bench::unread(BOTH, |folder| {
        for (name, text) in [("now", "one"), ("next", "two")] {
            fs::create_dir_all(folder.join(name).join("sub")).unwrap();
            fs::write(folder.join(name).join("sub/scene.txt"), text).unwrap();
        }
        folder.join("now/sub/scene.txt")
    });
    bench.expect_text("one");
    fs::rename(bench.folder.join("now"), bench.folder.join("old")).unwrap();
    fs::rename(bench.folder.join("next"), bench.folder.join("now")).unwrap();
    bench.expect_at_last("two");
    bench.write("three");
    bench.expect_text("three");
}

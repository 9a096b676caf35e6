//! Watching real files. What has to come is waited for, for as long as a machine may need; what must not come is shown not
//! to by what comes after it.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
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

    /// The next news are this text; but a file that is written over is empty for a moment, which a machine may draw out.
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
        file.write_all(text[..3].as_bytes()).unwrap();
        file.write_all(text[3..].as_bytes()).unwrap();
        drop(file);
        bench.replace(&text);
        // On a machine that is slow enough the half is seen, or the emptiness; nothing else.
        for news in bench.expect_at_last(&text) {
            assert!(
                [text[..3].as_bytes(), b""]
                    .map(|t| News::Text(t.into()))
                    .contains(&news)
                    || news == News::Gone,
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

#[test]
fn the_last_of_1000_quick_saves_arrives() {
    each_way(|senses| {
        let bench = Bench::new(senses, "start");
        for number in 1..=1000 {
            let text = format!("save {number} of many");
            if number % 2 == 0 {
                bench.replace(&text);
            } else {
                bench.write(&text);
            }
        }
        let before = bench.expect_at_last("save 1000 of many");
        // No text comes back that was told before.
        for (place, news) in before.iter().enumerate() {
            let texts = before[place + 1..]
                .iter()
                .filter(|other| *other == news && matches!(news, News::Text(t) if !t.is_empty()));
            assert_eq!(texts.count(), 0, "{news:?}");
        }
    });
}

/// Otherwise reading would be a sign to read, for ever.
#[cfg(target_os = "linux")]
#[test]
fn reading_is_no_sign_and_neither_are_other_files() {
    let root = TempDir::new().unwrap();
    let folder = root.path().join("folder");
    fs::create_dir(&folder).unwrap();
    let file = folder.join("scene.txt");
    fs::write(&file, "one").unwrap();
    let (wake, signs) = mpsc::sync_channel(10_000);
    let mut ears = Ears::new(wake);
    ears.turn_to(&file);
    assert!(ears.hear());
    for number in 0..100 {
        assert_eq!(fs::read(&file).unwrap(), b"one");
        fs::write(folder.join("scene.txt.bak"), number.to_string()).unwrap();
    }
    fs::write(&file, "two").unwrap();
    // Events come in order, so this one, which is known, comes last.
    fs::rename(&folder, root.path().join("moved")).unwrap();
    let mut count = 0;
    while !ears.is_lost() {
        signs.recv_timeout(DEADLINE).expect("a sign of the move");
        count += 1;
    }
    count += signs.try_iter().count();
    // Emptied, written, closed, moved.
    assert!((2..10).contains(&count), "{count} signs");
}

#[test]
fn the_thread_ends_when_it_is_dropped() {
    each_way(|senses| {
        let bench = Bench::new(senses, "one");
        drop(bench.watcher);
        // It has the sender, which goes with it.
        assert_eq!(
            bench.news.recv_timeout(DEADLINE),
            Err(RecvTimeoutError::Disconnected)
        );
    });
}

/// In a process of its own, as the memory of this one is that of all its tests.
#[cfg(target_os = "linux")]
#[test]
fn memory_stays_as_it_is_over_1000_saves() {
    const ALONE: &str = "PLUMB_TEST_ALONE";
    const SIZE: usize = 1 << 16;
    if std::env::var_os(ALONE).is_none() {
        let name = thread::current().name().unwrap().to_owned();
        let child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", &name, "--nocapture"])
            .env(ALONE, "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&child.stdout);
        assert!(
            child.status.success() && said.contains("1 passed"),
            "{said}\n{}",
            String::from_utf8_lossy(&child.stderr)
        );
        return;
    }
    let resident = || -> u64 {
        let status = fs::read_to_string("/proc/self/status").unwrap();
        let line = status.lines().find(|l| l.starts_with("VmRSS:")).unwrap();
        line.split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    let bench = Bench::new(ONLY_EARS, "start");
    let padding = " ".repeat(SIZE);
    let save = |number: usize| {
        let text = number.to_string() + &padding;
        bench.replace(&text);
        bench.expect_at_last(&text);
    };
    (0..50).for_each(save);
    let before = resident();
    (50..1050).for_each(save);
    let after = resident();
    // Were every 20th text kept, this would be 3 MiB more; were all, 62 MiB.
    assert!(
        after < before + 2048,
        "{before} KiB before, {after} KiB after"
    );
}

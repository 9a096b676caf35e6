//! Watching over many saves, and what it costs: signs, threads, memory.

use super::*;

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

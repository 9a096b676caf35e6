//! What docs/CLUSTER.md shows without a cluster, run as it stands there but for the picture's size and the number of
//! parts.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::desk::{Desk, LIT, Ran};

/// A desk with the scene of the examples, and its picture made in one piece.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("scene.txt", LIT);
    desk.run(&["render", "scene.txt", "-o", "whole.png", "--size", "40x30"])
        .ends(0);
    desk
}

/// The text between a line that begins so and the end of its block.
fn example(begins: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/CLUSTER.md");
    let text = fs::read_to_string(path).unwrap();
    let start = text.find(&format!("\n{begins}")).unwrap() + 1;
    let rest = &text[start..];
    rest[..rest.find("\n```").unwrap() + 1].replace("20000x20000", "40x30")
}

/// Runs a line in the folder, where `plumb` is the program.
#[track_caller]
fn shell(desk: &Desk, line: &str) -> Ran {
    let bin = Path::new(env!("CARGO_BIN_EXE_plumb")).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("bash");
    shell
        .args(["-ec", line])
        .env("PATH", path)
        .current_dir(desk.folder.path());
    Ran::new(&[line], shell.output().unwrap())
}

#[test]
fn make_makes_what_is_missing() {
    let desk = desk();
    let rules = example("N := 64");
    desk.write("Makefile", &rules.replace("N := 64", "N := 4"));
    shell(&desk, "make -j2").ends(0);
    assert_eq!(desk.read("big.png"), desk.read("whole.png"));
    fs::remove_file(desk.path("big.png.parts/big.3-of-4.plumbpart")).unwrap();
    let told = shell(&desk, "make -j2").ends(0).stderr;
    assert_eq!(told.matches("is there and right").count(), 3, "{told}");
    assert_eq!(desk.read("big.png"), desk.read("whole.png"));
}

/// The lines of a CI matrix, each part in a folder of its own, and these put together as artifacts are.
#[test]
fn a_ci_matrix_makes_the_same_file() {
    let desk = desk();
    let jobs = example("jobs:");
    let lines: Vec<&str> = jobs
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- run: "))
        .collect();
    let [part, join] = lines[..] else {
        panic!("{jobs}")
    };
    assert!(jobs.contains("k: [1, 2, 3, 4, 5, 6, 7, 8]"), "{jobs}");
    for k in 1..=8 {
        let line = part.replace("${{ matrix.k }}", &k.to_string());
        assert_ne!(line, part);
        shell(&desk, &format!("{line} --size 40x30")).ends(0);
        shell(&desk, &format!("mv parts artifact-{k}")).ends(0);
    }
    shell(&desk, "mkdir parts; mv artifact-*/* parts").ends(0);
    shell(&desk, join).ends(0);
    assert_eq!(desk.read("big.png"), desk.read("whole.png"));
}

/// GNU parallel is not everywhere: its line is run where it is, and by xargs, which does the same, elsewhere.
#[test]
fn parallel_makes_the_same_file() {
    let desk = desk();
    let mut lines = example("seq 64").replace("64", "4");
    if !shell(&desk, "parallel --version")
        .stdout
        .starts_with(b"GNU")
    {
        let is_replaced = lines.contains("parallel plumb");
        assert!(is_replaced, "{lines}");
        lines = lines.replace("parallel", "xargs -P 2 -I{}");
    }
    shell(&desk, &lines).ends(0);
    assert_eq!(desk.read("big.png"), desk.read("whole.png"));
    assert!(!desk.path("big.png.parts").exists());
}

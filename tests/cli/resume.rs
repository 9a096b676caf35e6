//! `--resume`: whatever ends a rendering, the same command goes on.

use std::fs;
use std::process::Stdio;
use std::time::Duration;

use super::desk::{Desk, LIT};

/// Whenever it is killed, the same command goes on with what there is, and the picture is the same file.
#[cfg(unix)]
#[test]
fn a_killed_rendering_goes_on() {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    let options = ["--backend", "cpu", "--size", "200x150", "--samples", "20"];
    let args = |output| [&["render", "lit.txt", "-o", output][..], &options].concat();
    let resume = [&args("a.png")[..], &["--resume"]].concat();
    // By chance, but the same at every run.
    let mut state = 7_u64;
    let (mut kills, mut kept) = (0, 0);
    while kills < 20 {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let mut command = desk.command(&resume);
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(5 + (state >> 33) % 150));
        child.kill().unwrap();
        kills += usize::from(!child.wait().unwrap().success());
        // One that came to its end is begun again.
        if desk.path("a.png").exists() {
            fs::remove_file(desk.path("a.png")).unwrap();
        }
        let there = fs::read_dir(desk.path("a.png.parts"));
        let whole =
            |name: &std::ffi::OsStr| name.to_str().is_some_and(|name| name.starts_with("a."));
        kept = there.map_or(0, |there| {
            there
                .filter(|part| whole(&part.as_ref().unwrap().file_name()))
                .count()
        });
    }
    let told = desk.run(&resume).ends(0).stderr;
    assert_eq!(
        told.contains(&format!("{kept} of")),
        kept > 0,
        "{kept}: {told}"
    );
    desk.run(&args("whole.png")).ends(0);
    assert_eq!(desk.read("a.png"), desk.read("whole.png"));
    assert_eq!(desk.names(), ["a.png", "lit.txt", "room.txt", "whole.png"]);
}

/// A disk that is full costs a part; what is in the way of a picture is told.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_a_part() {
    let desk = Desk::new();
    let options = "--backend cpu --size 400x1500 --samples 4";
    let line = |limit: &str, output: &str, more: &str| {
        format!(
            "trap '' XFSZ; ulimit -f {limit}; exec {} render room.txt -o {output} {options} {more}",
            env!("CARGO_BIN_EXE_plumb")
        )
    };
    let shell = |line: &str| {
        let mut shell = std::process::Command::new("bash");
        shell
            .args(["-c", line])
            .current_dir(desk.folder.path())
            .output()
            .unwrap()
    };
    // Parts fit, the picture does not.
    let full = shell(&line("1600", "a.ppm", "--resume"));
    let told = String::from_utf8_lossy(&full.stderr);
    assert_eq!(full.status.code(), Some(2), "{told}");
    assert!(told.contains("writing a.ppm failed"), "{told}");
    assert!(!desk.path("a.ppm").exists());
    let parts = fs::read_dir(desk.path("a.ppm.parts")).unwrap().count();
    assert!(parts > 1);
    // Now there is room.
    let told = shell(&line("unlimited", "a.ppm", "--resume"));
    let told = String::from_utf8_lossy(&told.stderr).into_owned();
    assert!(told.contains(" 0 of them made now"), "{told}");
    shell(&line("unlimited", "whole.ppm", ""));
    assert_eq!(desk.read("a.ppm"), desk.read("whole.ppm"));
    // Not even a part fits: nothing of it is left.
    let full = shell(&line("1", "b.ppm", "--part 1/3"));
    assert_eq!(full.status.code(), Some(2));
    assert_eq!(fs::read_dir(desk.path("b.ppm.parts")).unwrap().count(), 0);
}

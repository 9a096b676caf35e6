//! Ends that are not ours: readers that go away, full disks, signals; and targets that are no files.

use std::fs;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::desk::{Desk, ROOM};

/// Runs with the reader of stdout gone after the first bytes.
fn with_deaf_reader(desk: &Desk, args: &[&str]) -> (Option<i32>, String) {
    let mut child = desk
        .command(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 2];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn a_broken_pipe_ends_quietly() {
    let desk = Desk::new();
    let render = [
        "render",
        "room.txt",
        "-o",
        "-",
        "--size",
        "1500x1500",
        "--backend",
        "cpu",
    ];
    assert_eq!(with_deaf_reader(&desk, &render), (Some(0), String::new()));
    let materials: String = (0..5000)
        .map(|i| format!("material m{i} {{ ambient 1 1 1 }}\n"))
        .collect();
    desk.write("many.txt", &(materials + ROOM));
    assert_eq!(
        with_deaf_reader(&desk, &["dump", "many.txt"]),
        (Some(0), String::new())
    );
}

#[cfg(unix)]
#[test]
fn devices_are_written_through() {
    use std::os::unix::fs::FileTypeExt;
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "/dev/null"])
        .ends(0);
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert_eq!(desk.names(), ["room.txt"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "/dev/full"])
        .fails_with(&["/dev/full"]);
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    for args in [
        &["render", "room.txt", "--backend", "cpu", "-o", "-"][..],
        &["dump", "room.txt"],
        &["--version"],
    ] {
        let output = desk.command(args).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
    }
}

/// A picture that takes minutes.
#[cfg(unix)]
const LONG: [&str; 8] = [
    "render",
    "room.txt",
    "--backend",
    "cpu",
    "--size",
    "30000x30000",
    "-o",
    "big.ppm",
];

/// Waits until a picture is being written.
#[cfg(unix)]
fn begun(desk: &Desk) {
    let start = Instant::now();
    while desk.names().len() < 2 {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "no file is being written"
        );
        sleep(Duration::from_millis(5));
    }
    sleep(Duration::from_millis(50));
}

#[cfg(unix)]
fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_nothing_behind() {
    for signal in ["-INT", "-TERM", "-HUP"] {
        let desk = Desk::new();
        let mut child = desk.command(&LONG).stderr(Stdio::piped()).spawn().unwrap();
        begun(&desk);
        send(signal, &child);
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(desk.names(), ["room.txt"], "{signal}");
    }
}

/// `nohup` ignores SIGHUP, and a shell without job control ignores SIGINT in what it starts in the background.
#[cfg(unix)]
#[test]
fn signals_that_the_caller_ignores_stay_ignored() {
    let desk = Desk::new();
    let line = format!("trap '' HUP INT; exec \"$0\" {}", LONG.join(" "));
    let mut shell = Command::new("sh");
    shell.args(["-c", &line, env!("CARGO_BIN_EXE_plumb")]);
    shell.current_dir(desk.folder.path()).stderr(Stdio::piped());
    let mut child = shell.spawn().unwrap();
    begun(&desk);
    for signal in ["-HUP", "-INT"] {
        send(signal, &child);
        sleep(Duration::from_millis(300));
        assert_eq!(child.try_wait().unwrap(), None, "{signal}");
    }
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(desk.names(), ["room.txt"]);
}

//! Certified pictures as a user meets them: the report, the verdicts, the exit code, what is remembered. Tests that say
//! so need an adapter, and fail without one.

use std::fs;

use serde_json::Value;

use super::desk::{Desk, Ran, ppm, scenes};

fn json(ran: &Ran) -> Value {
    serde_json::from_slice(&ran.stdout).unwrap()
}

#[test]
fn the_report_says_what_decided_every_pixel() {
    let desk = Desk::new();
    for backend in ["cpu", "auto"] {
        let ran = desk
            .run(&["render", "room.txt", "--backend", backend, "--json"])
            .ends(0);
        let report = json(&ran);
        assert_eq!(report["precision"], "certified");
        assert_eq!(report["pixels"], 1200);
        let decided = report["decided"].as_object().unwrap();
        let stages: Vec<&str> = decided.keys().map(String::as_str).collect();
        let mut expected = [
            "gpu",
            "gpu_f64",
            "f32",
            "f64",
            "pairs",
            "multiprecision",
            "tie",
            "presumed",
        ];
        expected.sort_unstable();
        assert_eq!(stages, expected);
        let sum: u64 = decided.values().map(|n| n.as_u64().unwrap()).sum();
        assert_eq!(sum, 1200);
        assert_eq!(report["ties"], report["decided"]["tie"]);
        assert_eq!(report["presumed"], report["decided"]["presumed"]);
        let seconds = &report["seconds"];
        for time in ["kernel", "kernel_f64", "refine", "spot_checks"] {
            assert!(seconds["beside"][time].is_f64(), "{time}");
        }
        assert!(seconds["stages"]["tie"].is_f64());
        let phases = seconds["phases"].as_object().unwrap();
        let sum: f64 = phases.values().map(|phase| phase.as_f64().unwrap()).sum();
        let total = seconds["total"].as_f64().unwrap();
        // What is between two readings of the clock is in neither of the phases.
        assert!(
            (sum - total).abs() <= 0.02 * total + 1e-4,
            "{sum} of {total}"
        );
        let workers = report["workers"].as_array().unwrap();
        let pixels: u64 = workers
            .iter()
            .map(|worker| worker["pixels"].as_u64().unwrap())
            .sum();
        assert_eq!(pixels, 1200, "{workers:?}");
        for part in ["start", "work", "wait"] {
            assert!(workers[0]["seconds"][part].is_f64(), "{part}");
        }
    }
}

#[test]
fn the_line_on_stderr_says_whether_it_is_certified() {
    let desk = Desk::new();
    let line = |args: &[&str]| {
        let ran = desk.run(&[&["render", "room.txt"], args].concat()).ends(0);
        ran.stderr.lines().last().unwrap().to_owned()
    };
    assert!(line(&["--backend", "cpu"]).contains("; certified: f32 "));
    // Needs an adapter.
    assert!(line(&["--backend", "gpu"]).contains("; certified, "));
    let fast = line(&["--backend", "gpu", "--precision", "fast"]);
    assert!(fast.contains("; fast, not certified"), "{fast}");
}

#[test]
fn a_picture_without_presumed_pixels_passes_strictly() {
    let desk = Desk::new();
    let report = json(
        &desk
            .run(&[
                "render",
                "room.txt",
                "--backend",
                "cpu",
                "--strict",
                "--json",
            ])
            .ends(0),
    );
    assert_eq!(report["presumed"], 0);
    assert_eq!(report["presumed_at"], Value::Array(vec![]));
}

#[test]
fn verdicts_are_a_picture_of_the_same_size() {
    let desk = Desk::new();
    let args = ["--backend", "cpu", "--rows", "3..20", "--band-rows", "4"];
    desk.run(&[&["render", "room.txt", "--verdicts", "why.ppm"], &args[..]].concat())
        .ends(0);
    assert_eq!(desk.names(), ["room.ppm", "room.txt", "why.ppm"]);
    let why = desk.read("why.ppm");
    let (width, height, bytes) = ppm(&why);
    assert_eq!((width, height), (40, 17));
    // f32 decides nearly all of this room, and f64 the rest: light grey, and blue.
    let count = |color: [u8; 3]| bytes.chunks_exact(3).filter(|p| *p == color).count();
    let [single, double] = [[80, 80, 80], [60, 110, 200]].map(count);
    assert_eq!(single + double, 40 * 17);
    assert!(single > 35 * 17, "{single}");
    // They are written whole or not at all, as the picture is.
    desk.run(
        &[
            &["render", "room.txt", "--verdicts", "none/why.ppm"],
            &args[..],
        ]
        .concat(),
    )
    .fails_with(&["none"]);
    desk.run(&["render", "room.txt", "--verdicts", "room.txt"])
        .fails_with(&[".ppm"]);
}

/// Needs an adapter.
#[test]
fn what_the_gpu_is_sure_of_is_grey() {
    let desk = Desk::new();
    let scene = scenes().join("notes/walls.txt");
    desk.run(&[
        "render",
        scene.to_str().unwrap(),
        "--backend",
        "gpu",
        "--size",
        "64x48",
        "--verdicts",
        "why.ppm",
    ])
    .ends(0);
    let why = desk.read("why.ppm");
    let sure = ppm(&why)
        .2
        .chunks_exact(3)
        .filter(|pixel| *pixel == [40, 40, 40])
        .count();
    assert!(sure > 64 * 48 * 9 / 10, "{sure} pixels are sure");
}

#[test]
fn the_height_of_bands_changes_no_byte() {
    let desk = Desk::new();
    let render = |rows: &str| {
        desk.run(&["render", "room.txt", "-o", "-", "--band-rows", rows])
            .ends(0)
            .stdout
    };
    let whole = render("1000000");
    for rows in ["1", "7", "30"] {
        assert!(render(rows) == whole, "{rows}");
    }
}

/// Needs an adapter. The test is run once, and remembered where caches go; where that cannot be written it is run
/// again.
#[test]
fn the_self_test_is_remembered() {
    let desk = Desk::new();
    let run = |cache: &str, precision: &str| {
        let args = ["render", "room.txt", "--backend", "gpu", "--json"];
        let args = [&args[..], &["--precision", precision]].concat();
        let mut command = desk.command(&args);
        command.env("XDG_CACHE_HOME", desk.path(cache));
        let report = json(&Ran::new(&args, command.output().unwrap()).ends(0));
        report["workers"][0]["phases"]["selftest"].as_f64().unwrap()
    };
    let notes = || -> Vec<_> {
        fs::read_dir(desk.path("cache/plumb"))
            .map(|entries| entries.map(|entry| entry.unwrap().path()).collect())
            .unwrap_or_default()
    };
    run("cache", "fast");
    assert!(
        notes().is_empty(),
        "nothing is certified, nothing is tested"
    );
    let first = run("cache", "certified");
    assert_eq!(notes().len(), 1);
    let text = fs::read_to_string(&notes()[0]).unwrap();
    assert!(text.contains("may be deleted"), "{text}");
    let second = run("cache", "certified");
    assert_eq!(notes().len(), 1);
    assert!(second < first, "{second} s after {first} s");
    fs::write(&notes()[0], "nonsense").unwrap();
    run("cache", "certified");
    assert_eq!(fs::read_to_string(&notes()[0]).unwrap(), text);
    // A file where the folder should be.
    run("room.txt", "certified");
}

/// Needs an adapter.
#[test]
fn doctor_prints_the_self_test() {
    let desk = Desk::new();
    let text = desk.run(&["doctor"]).ends(0).text();
    assert!(text.contains("self-test       passed, "), "{text}");
    let report = json(&desk.run(&["doctor", "--json"]).ends(0));
    let checks = report["adapters"][0]["selftest"].as_array().unwrap();
    for name in ["x + y", "sqrt", "round", "two_prod behind the barrier"] {
        let check = checks.iter().find(|check| check["check"] == name).unwrap();
        assert!(check["failure"].is_null() && check["cases"].as_u64() > Some(1000));
    }
}

/// Needs an adapter for what the GPU says.
#[test]
fn probe_says_what_decided_a_pixel() {
    let desk = Desk::new();
    let text = desk.run(&["probe", "room.txt", "12", "7"]).ends(0).text();
    assert!(
        text.contains("\ndecided by   f64 with error bounds\n"),
        "{text}"
    );
    assert!(text.contains("\nGPU          "), "{text}");
    let args = ["probe", "room.txt", "12", "7", "--json"];
    let report = json(&desk.run(&args).ends(0));
    let bytes: Vec<String> = report["bytes"]
        .as_array()
        .unwrap()
        .iter()
        .map(Value::to_string)
        .collect();
    assert!(text.contains(&format!("\nbytes        {}\n", bytes.join(" "))));
    assert_eq!(report["decided"], "f64");
    assert_eq!(report["gpu"], format!("sure: {}", bytes.join(" ")));
    // Both bounds hold, and neither is idle.
    let mut known = 0;
    let number = |of: &str, what: &str, i: usize| report[of][what][i].as_f64().unwrap();
    for i in 0..3 {
        let apart = (number("f32", "value", i) - number("f64", "value", i)).abs();
        let bound = number("f32", "bound", i);
        assert!(
            apart <= bound + number("f64", "bound", i),
            "{apart}, {bound}"
        );
        // The room is not red, green and blue alike.
        let value = number("f64", "value", i);
        known += usize::from(value > 0.0);
        assert!(
            value == 0.0 || (1e-8..1e-3).contains(&(bound / value)),
            "{bound}"
        );
    }
    assert!(known > 0);
    assert!(text.contains("\nGPU's f32    255 v = ("), "{text}");
}

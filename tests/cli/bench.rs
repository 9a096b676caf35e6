//! `plumb bench`. All but the last need an adapter.

use serde_json::Value;

use super::desk::{Desk, LIT, Ran};

const WAYS: [&str; 6] = [
    "gpu_certified",
    "gpu_fast",
    "cpu_certified",
    "cpu_plain",
    "f32_quadratic",
    "f32_naive",
];

fn json(ran: &Ran) -> Value {
    serde_json::from_slice(&ran.stdout).unwrap()
}

/// The report of a way.
#[track_caller]
fn way<'a>(report: &'a Value, scene: usize, way: &str) -> &'a Value {
    let ways = report["scenes"][scene]["ways"].as_array().unwrap();
    ways.iter().find(|found| found["way"] == way).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn every_way_is_measured_and_the_report_is_whole() {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    let args = [
        "bench", "room.txt", "lit.txt", "--repeat", "2", "--json", "--plot", "out.svg",
    ];
    let ran = desk.run(&args).ends(0);
    assert_eq!(ran.stderr, "");
    let report = json(&ran);
    assert_eq!(report["repeat"], 2);
    let machine = &report["machine"];
    for named in ["adapter", "cpu", "system"] {
        assert!(!machine[named].as_str().unwrap().is_empty(), "{machine}");
    }
    for (scene, [name, lights]) in [["room.txt", "0"], ["lit.txt", "2"]]
        .into_iter()
        .enumerate()
    {
        let found = &report["scenes"][scene];
        assert_eq!(found["scene"], name);
        assert_eq!(
            (&found["width"], &found["height"]),
            (&40.into(), &30.into())
        );
        assert_eq!(found["lights"].to_string(), lights);
        assert_eq!(number(&found["rays"]["all"]) > 1.0, lights == "2");
        assert_eq!(found["ways"].as_array().unwrap().len(), WAYS.len());
        for name in WAYS {
            let way = way(&report, scene, name);
            assert_eq!(way["not_available"], Value::Null, "{way}");
            for kind in ["kernel", "frame"] {
                let times = &way["seconds"][kind];
                assert_eq!(times["runs"].as_array().unwrap().len(), 2, "{way}");
                let [min, median, max] = ["min", "median", "max"].map(|of| number(&times[of]));
                assert!(0.0 < min && min <= median && median <= max, "{way}");
                assert!(number(&times["warm_up"]) > 0.0);
            }
            let is_process = !matches!(name, "cpu_plain" | "f32_quadratic" | "f32_naive");
            for kind in ["cold", "warm"] {
                assert_eq!(way["seconds"][kind].is_object(), is_process, "{way}");
            }
            let pixels = number(&way["mpixels_per_second"]) * 1e6;
            let rays = number(&way["rays_per_second"]) / number(&found["rays"]["all"]);
            assert!((pixels / rays - 1.0).abs() < 1e-9, "{way}");
            let t = &way["t"];
            assert!(number(&t["compared"]) > 900.0, "{way}");
            assert!(number(&t["median"]) <= number(&t["percentile_99"]), "{way}");
            let least = if name.starts_with("cpu") { 0.0 } else { 0.01 };
            assert!((least..3.0).contains(&number(&t["median"])), "{way}");
        }
        for exact in ["gpu_certified", "cpu_certified"] {
            let error = &way(&report, scene, exact)["error"];
            assert_eq!((&error["wrong"], &error["worst"]), (&0.into(), &0.into()));
            assert_eq!(number(&error["rms"]), 0.0);
        }
        let doubtful = number(&way(&report, scene, "gpu_certified")["doubtful_percent"]);
        assert!((0.0..20.0).contains(&doubtful), "{doubtful}");
        // Nearly right: a room is not hard.
        for name in ["gpu_fast", "f32_quadratic", "f32_naive"] {
            let wrong = number(&way(&report, scene, name)["error"]["wrong_percent"]);
            assert!(wrong < 10.0, "{name}: {wrong} %");
        }
    }
    let svg = String::from_utf8(desk.read("out.svg")).unwrap();
    assert!(svg.starts_with("<?xml") && svg.trim_end().ends_with("</svg>"));
    for word in [
        "room.txt, 40×30",
        "lit.txt, 40×30",
        "GPU certified",
        "f32 naive",
    ] {
        assert!(svg.contains(word), "no {word:?}");
    }
    assert_eq!(desk.names(), ["lit.txt", "out.svg", "room.txt"]);
}

/// What the textbook loses is what plumb keeps: a small sphere far away.
#[test]
fn a_small_sphere_far_away_tells_the_ways_apart() {
    let desk = Desk::new();
    desk.write(
        "far.txt",
        "camera c { pixeldim 40 30 worlddim 0.00004 0.00003 viewpoint 0.00002 0.000015 1 }
        material m { ambient 900000 500000 200000 }
        sphere s { material m center 0.00002 0.000015 -99999 radius 1 }",
    );
    let ran = desk.run(&["bench", "far.txt", "--repeat", "1", "--json"]);
    let report = json(&ran.ends(0));
    let wrong = |name: &str| number(&way(&report, 0, name)["error"]["wrong_percent"]);
    assert_eq!(wrong("gpu_certified"), 0.0);
    assert!(wrong("gpu_fast") < 1.0, "{}", wrong("gpu_fast"));
    for textbook in ["f32_quadratic", "f32_naive"] {
        assert!(wrong(textbook) > 10.0, "{textbook}: {}", wrong(textbook));
    }
}

#[test]
fn the_table_fits_a_terminal_and_has_the_size_that_was_asked_for() {
    let args = ["bench", "room.txt", "--size", "20x10", "--repeat", "1"];
    let ran = Desk::new().run(&args).ends(0);
    assert_eq!(ran.stderr, "");
    let text = ran.text();
    for line in text.lines().skip(3) {
        assert!(line.chars().count() <= 100, "{line}");
    }
    for word in [
        "room.txt: 20×10",
        "CPU: ",
        "GPU: ",
        "doubtful %",
        "kernel",
        "cold",
    ] {
        assert!(text.contains(word), "no {word:?} in {text}");
    }
    for name in ["GPU certified", "CPU certified", "f32 b²−4ac", "f32 naive"] {
        let starts = |line: &&str| line.trim_start().starts_with(name);
        assert_eq!(text.lines().filter(starts).count(), 3, "{name} in {text}");
    }
    assert!(!text.contains("not available"), "{text}");
}

#[test]
fn too_many_spheres_are_not_for_the_textbook() {
    let desk = Desk::new();
    let mut text = "camera c { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }
        material m { ambient 5 5 5 }\n"
        .to_owned();
    for i in 0..1001 {
        text += &format!("sphere s{i} {{ material m center {i} 0 -50 radius 1 }}\n");
    }
    desk.write("many.txt", &text);
    let ran = desk.run(&["bench", "many.txt", "--repeat", "1", "--json"]);
    let report = json(&ran.ends(0));
    for name in ["f32_quadratic", "f32_naive"] {
        let way = way(&report, 0, name);
        let why = way["not_available"].as_str().unwrap();
        assert!(why.contains("1000 spheres"), "{why}");
        assert_eq!(
            (&way["error"], &way["seconds"]),
            (&Value::Null, &Value::Null)
        );
    }
    assert_eq!(way(&report, 0, "gpu_certified")["error"]["wrong"], 0);
}

#[test]
fn what_cannot_be_measured_is_said_before_anything_is() {
    let desk = Desk::new();
    desk.write("bad.txt", "sphere s { }");
    let cases: [(&[&str], &str); 9] = [
        (&["bench"], "SCENE"),
        (&["bench", "none.txt"], "none.txt"),
        (&["bench", "room.txt", "bad.txt"], "bad.txt"),
        (&["bench", "-"], "save it to a file"),
        (&["bench", "room.txt", "--repeat", "0"], "from 1 to 1000"),
        (&["bench", "room.txt", "--size", "20000x20000"], "100000000"),
        (&["bench", "room.txt", "--plot", "a.png"], ".svg"),
        (
            &["bench", "room.txt", "--plot", "none/a.svg"],
            "does not exist",
        ),
        (&["bench", "room.txt", "--plot", "-"], ".svg"),
    ];
    for (args, word) in cases {
        desk.run(args).fails_with(&[word]);
    }
    desk.write("scene.svg", super::desk::ROOM);
    desk.run(&["bench", "scene.svg", "--plot", "scene.svg"])
        .fails_with(&["one of the scenes"]);
    assert_eq!(desk.names(), ["bad.txt", "room.txt", "scene.svg"]);
}

#[test]
fn a_scene_with_too_many_rays_is_named() {
    let desk = Desk::new();
    // Three half-mirrors that let through as well.
    let mut text = "camera c { pixeldim 3 3 worlddim 8 6 viewpoint 4 3 6 }
        material m { ambient 0.001 0.001 0.001 diffuse 1 1 1 specular 0.9 transparency 0.9 }
        light l { location 4 3 -0.1 emissivity 0.001 0 0 }\n"
        .to_owned();
    for z in 1..=3 {
        text += &format!("plane p{z} {{ material m normal 0 0 1 point 0 0 -{z}.25 }}\n");
    }
    desk.write(
        "rays.txt",
        &text
            .replace("-1.25", "-1.0")
            .replace("-2.25", "-1.1")
            .replace("-3.25", "-1.2"),
    );
    desk.run(&["bench", "rays.txt", "--repeat", "1"])
        .fails_with(&[
            "rays.txt",
            "more than 65536 rays",
            "takes the limits as they are",
        ]);
}

/// The loader is told to find no driver at all.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_cpu_is_measured() {
    let desk = Desk::new();
    let args = ["bench", "room.txt", "--repeat", "1", "--json"];
    let mut command = desk.command(&args);
    command
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .env("VK_ICD_FILENAMES", "/nonexistent.json");
    let report = json(&Ran::new(&args, command.output().unwrap()).ends(0));
    assert_eq!(report["machine"]["adapter"], Value::Null);
    for name in WAYS {
        let why = &way(&report, 0, name)["not_available"];
        if name.starts_with("cpu") {
            assert_eq!(*why, Value::Null);
        } else {
            assert!(why.as_str().unwrap().contains("no GPU adapter"), "{why}");
        }
    }
}

//! Some scenes of each kind on a second driver, whose compiler and arithmetic are others, against the oracle.

use std::path::Path;

use plumb::render::Settings;

use super::kinds::{Case, KINDS, case, for_the_gpu};
use super::random::{rules, settings};
use super::{picture, scene};
use crate::common::drivers::{plumb, second_driver};
use crate::oracle::{self, differences};

/// Scenes of each kind that the second driver has to render, and how many numbers are tried for that: some are beyond
/// f32, so that the CPU renders them.
const SCENES: u32 = 3;
const MOST: u64 = 60;

/// The picture by the program on that driver, if the GPU made it.
fn on_driver(case: &Case, settings: &Settings, driver: &Path) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("extreme.txt");
    // Its textures are those of our scenes.
    let textures = concat!("filename ", env!("CARGO_MANIFEST_DIR"), "/scenes/textures/");
    let text = case.text.replace("filename textures/", textures);
    std::fs::write(&path, text).unwrap();
    let (samples, longest) = (settings.samples.to_string(), settings.limits.max_path);
    let longest = format!("{longest:e}");
    let mut args = vec![
        "render",
        path.to_str().unwrap(),
        "-o",
        "-",
        "--json",
        "--backend",
        "gpu",
    ];
    args.extend(["--samples", &samples, "--max-path", &longest]);
    if case.course {
        args.extend(["--jitter", "course"]);
    }
    let output = plumb(&args, Some(driver));
    let report: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert!(report["revoked"].is_null(), "{}\n{report}", case.text);
    (report["backend"] == "gpu").then_some(output.stdout)
}

#[test]
fn the_second_driver_is_certified_too() {
    let second = second_driver();
    for kind in KINDS {
        let mut tried = 0;
        for number in (2_000..2_000 + MOST).filter(|number| for_the_gpu(*number)) {
            let case = case(kind, number);
            let (scene, settings) = (scene(&case.text), settings(&case));
            // Too many rays are an error, of the program as well.
            if picture(&scene, &settings).is_err() {
                continue;
            }
            let Some(ppm) = on_driver(&case, &settings, &second) else {
                continue;
            };
            let [width, height] = scene.camera.pixeldim;
            let rgb = &ppm[ppm.len() - 3 * (width * height) as usize..];
            let answer = oracle::picture(&scene, &rules(&settings));
            let found: Vec<_> = differences(&scene, &answer, rgb).collect();
            assert!(
                found.is_empty(),
                "{kind:?} {number}:\n{}\n{}",
                case.text,
                found.join("\n")
            );
            tried += 1;
            if tried == SCENES {
                break;
            }
        }
        assert_eq!(tried, SCENES, "{kind:?}: the others are the CPU's");
    }
}

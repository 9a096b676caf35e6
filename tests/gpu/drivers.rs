//! The same picture from two drivers: the one that is used anyhow, and a second one, whose Vulkan ICD file
//! `PLUMB_SECOND_DRIVER` names. `sh scripts/test.sh` fetches SwiftShader for it: another compiler, other arithmetic, so
//! a byte that depends on how a driver rounds or rewrites has to differ. Fails without a second driver.

use std::path::{Path, PathBuf};

use crate::common;
use crate::common::drivers::{plumb, second_driver};

/// Size of the pictures: the second driver is not the quickest.
const SIZE: &str = "96x72";

/// Scenes that are left out: one is an error, and the others keep a driver that is a single CPU busy for long.
const LEFT_OUT: [&str; 2] = ["lit_half_mirrors_three", "lit_thousand_panes"];

/// The picture from the GPU as PPM, and its report.
fn picture(scene: &Path, samples: &str, driver: Option<&Path>) -> (Vec<u8>, serde_json::Value) {
    let scene = scene.to_str().unwrap();
    let args = [
        "render",
        scene,
        "-o",
        "-",
        "--backend",
        "gpu",
        "--json",
        "--precision",
        "certified",
        "--size",
        SIZE,
        "--samples",
        samples,
    ];
    let output = plumb(&args, driver);
    (
        output.stdout,
        serde_json::from_slice(&output.stderr).unwrap(),
    )
}

#[test]
fn two_drivers_make_the_same_pictures() {
    let second = second_driver();
    let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let scenes: Vec<PathBuf> = common::good_scenes()
        .into_iter()
        .filter(|path| !LEFT_OUT.contains(&name(path).as_str()))
        .collect();
    assert!(scenes.len() > 200, "only {} scenes", scenes.len());
    let mut differ = Vec::new();
    // Antialiased the largest shader of ours, which has as many buffers as this driver allows, and two others.
    let antialiased = [
        "showcase.txt",
        "lit/mirror_and_glass.txt",
        "gallery/ring.txt",
    ];
    let antialiased = antialiased.map(|name| (common::scenes().join(name), "16"));
    let once = scenes.iter().map(|path| (path.clone(), "1"));
    for (scene, samples) in &once.chain(antialiased).collect::<Vec<_>>() {
        let (one, first) = picture(scene, samples, None);
        let (other, report) = picture(scene, samples, Some(&second));
        // Scenes whose numbers are beyond f32 are rendered on the CPU.
        let on_cpu = first["fallback"].is_string() && report["fallback"].is_string();
        let same = first["adapter"] == report["adapter"];
        assert!(on_cpu || !same, "both are the same driver");
        for report in [first, report] {
            if report["revoked"].is_string() || (!on_cpu && report["backend"] != "gpu") {
                differ.push(format!("{}: {}", scene.display(), report["revoked"]));
            }
        }
        if one != other {
            differ.push(format!("{}: the bytes differ", scene.display()));
        }
    }
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}

#[test]
fn the_second_driver_passes_the_self_test() {
    let output = plumb(&["doctor", "--json"], Some(&second_driver()));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let checks = report["adapters"][0]["selftest"].as_array().unwrap();
    assert!(checks.len() > 20);
    for check in checks {
        assert!(check["failure"].is_null(), "{check}");
    }
}

/// A scene that takes more buffers than the second driver allows is the CPU's with `--backend auto`, and says so.
#[test]
fn a_scene_with_too_many_buffers_is_rendered_by_the_cpu() {
    let second = second_driver();
    let mut text = String::from(
        "camera c { pixeldim 32 24 worlddim 8 6 viewpoint 4 3 6 }
         material a { ambient 1 2 3 diffuse 3 3 3 specular .5 .5 .5 }
         material g { ambient 1 1 1 diffuse 1 1 1 transparency 0.5 }
         light l { location 4 9 2 emissivity 6 6 6 }
         tiled_plane f { material a normal 0 1 0 point 0 -1 0 dimension 1 1 altmaterial g }
         pplane p { material a normal 0 0 1 point 0 0 -30 shader 0 }
         fplane r { material g normal 0 0 1 point 1 1 -2 xdir 1 0 0 dimensions 2 2 } ",
    );
    for i in 0..60 {
        let (x, y) = (f64::from(i % 10) * 0.8, f64::from(i / 10));
        text += &format!("sphere s{i} {{ material a center {x} {y} -5 radius 0.3 }} ");
    }
    let scene = Path::new(env!("CARGO_TARGET_TMPDIR")).join("many_buffers.txt");
    std::fs::write(&scene, text).unwrap();
    let rendered = |asked: &[&str], driver| {
        let args = ["render", scene.to_str().unwrap(), "-o", "-", "--json"];
        let args = [&args[..], asked].concat();
        let output = plumb(&args, driver);
        let report: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
        (output.stdout, report)
    };
    let (auto, report) = rendered(&["--adapter", "swiftshader"], Some(&second));
    assert_eq!(report["backend"], "cpu");
    let fallback = report["fallback"].as_str().unwrap();
    assert!(fallback.contains("buffers at once"), "{fallback}");
    assert_eq!(auto, rendered(&["--backend", "cpu"], None).0);
    let (gpu, report) = rendered(&["--backend", "gpu"], None);
    assert_eq!((gpu == auto, &report["backend"]), (true, &"gpu".into()));
}

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

/// The pictures of `scenes` from the GPU as PPM, with their reports; all in one process, which opens its device once.
fn pictures(
    scenes: &[PathBuf],
    samples: &str,
    driver: Option<&Path>,
) -> Vec<(Vec<u8>, serde_json::Value)> {
    let which = if driver.is_some() { "second" } else { "first" };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("drivers_{which}_{samples}"));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir(&folder).unwrap();
    let mut args = vec!["render"];
    args.extend(scenes.iter().map(|scene| scene.to_str().unwrap()));
    args.extend(["-o", folder.to_str().unwrap(), "--backend", "gpu", "--json"]);
    args.extend(["--precision", "certified", "--size", SIZE]);
    args.extend(["--samples", samples]);
    let output = plumb(&args, driver);
    let reports = serde_json::Deserializer::from_slice(&output.stdout)
        .into_iter::<serde_json::Value>()
        .map(Result::unwrap);
    let pictures = scenes.iter().zip(reports).map(|(scene, report)| {
        let name = scene.with_extension("ppm");
        let picture = folder.join(name.file_name().unwrap());
        assert_eq!(report["scene"], scene.to_str().unwrap());
        (std::fs::read(picture).unwrap(), report)
    });
    let pictures: Vec<_> = pictures.collect();
    assert_eq!(pictures.len(), scenes.len());
    pictures
}

/// What is wrong with the two drivers' pictures of `scenes`.
fn differences(scenes: &[PathBuf], samples: &str) -> Vec<String> {
    let second = second_driver();
    let (first, second) = std::thread::scope(|scope| {
        let first = scope.spawn(|| pictures(scenes, samples, None));
        let second = pictures(scenes, samples, Some(&second));
        (first.join().unwrap(), second)
    });
    let mut differ = Vec::new();
    for (scene, ((one, first), (other, report))) in scenes.iter().zip(first.into_iter().zip(second))
    {
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
    differ
}

#[test]
fn two_drivers_make_the_same_pictures() {
    let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    // Two compilers are at it for each: one scene in two, unless all are asked for. The proof gives the GPU the others.
    let step = match std::env::var_os("PLUMB_CERTIFY_FULL") {
        None => 2,
        Some(_) => 1,
    };
    let scenes: Vec<PathBuf> = common::good_scenes()
        .into_iter()
        .step_by(step)
        .filter(|path| !LEFT_OUT.contains(&name(path).as_str()))
        .collect();
    assert!(scenes.len() > 200 / step, "only {} scenes", scenes.len());
    let mut differ = differences(&scenes, "1");
    // Antialiased the largest shader of ours, which has as many buffers as this driver allows, and two others.
    let antialiased = [
        "showcase.txt",
        "lit/mirror_and_glass.txt",
        "gallery/ring.txt",
    ];
    differ.extend(differences(
        &antialiased.map(|name| common::scenes().join(name)),
        "16",
    ));
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

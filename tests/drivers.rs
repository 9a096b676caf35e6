//! The same picture from two drivers: the one that is used anyhow, and a second one, whose Vulkan ICD file
//! `PLUMB_SECOND_DRIVER` names. `sh scripts/test.sh` fetches SwiftShader for it: another compiler, other arithmetic, so a
//! byte that depends on how a driver rounds or rewrites has to differ. Fails without a second driver.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Folders all of whose scenes without lights are compared.
const FOLDERS: [&str; 3] = ["notes", "gallery", "known"];

/// Lit scenes that are compared, of those that the second driver compiles in a moment; more belong here.
const LIT: [&str; 1] = ["lit/shadows_balls.txt"];

fn second_driver() -> PathBuf {
    let Some(named) = std::env::var_os("PLUMB_SECOND_DRIVER") else {
        panic!(
            "there is no second driver: `sh scripts/test.sh --test drivers` fetches one; or name the JSON file of another \
             Vulkan driver in PLUMB_SECOND_DRIVER"
        )
    };
    let path = PathBuf::from(named);
    assert!(path.is_file(), "no file {}", path.display());
    path
}

/// Runs the program, on the second driver if there is one given.
fn plumb(args: &[&str], driver: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plumb"));
    command.args(args).env(
        "XDG_CACHE_HOME",
        concat!(env!("CARGO_TARGET_TMPDIR"), "/cache"),
    );
    if let Some(driver) = driver {
        command.env("VK_DRIVER_FILES", driver);
    }
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {stderr}");
    output
}

/// The picture from the GPU as PPM, and its report.
fn picture(scene: &Path, driver: Option<&Path>) -> (Vec<u8>, serde_json::Value) {
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
    let in_folders = |path: &PathBuf| {
        FOLDERS
            .iter()
            .any(|folder| path.starts_with(common::scenes().join(folder)))
            && common::read(path).lights.is_empty()
    };
    let mut scenes: Vec<PathBuf> = common::good_scenes()
        .into_iter()
        .filter(in_folders)
        .collect();
    assert!(scenes.len() > 20, "only {} scenes", scenes.len());
    scenes.extend(LIT.map(|name| common::scenes().join(name)));
    let mut differ = Vec::new();
    for scene in &scenes {
        let (one, first) = picture(scene, None);
        let (other, report) = picture(scene, Some(&second));
        assert_ne!(
            first["adapter"], report["adapter"],
            "both are the same driver"
        );
        for report in [first, report] {
            if report["backend"] != "gpu" {
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

//! With a GPU, and without one. The first two need an adapter and fail without one.

use super::desk::{Desk, Ran, ppm, scenes};

/// Needs an adapter, and fails without one: a GPU that is not tested is not known to work.
#[test]
fn the_gpu_renders_what_the_cpu_renders() {
    let desk = Desk::new();
    let scene = scenes().join("notes/walls.txt");
    let scene = scene.to_str().unwrap();
    let ran = desk
        .run(&[
            "render",
            scene,
            "--backend",
            "gpu",
            "-o",
            "gpu.ppm",
            "--json",
        ])
        .ends(0);
    let json: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(json["backend"], "gpu");
    desk.run(&["render", scene, "--backend", "cpu", "-o", "cpu.ppm"])
        .ends(0);
    let compared = desk.run(&["compare", "gpu.ppm", "cpu.ppm", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    assert!(
        json["comparison"]["percent"].as_f64().unwrap() < 0.05,
        "{json}"
    );
}

/// Needs an adapter, and fails without one.
#[test]
fn doctor_names_the_adapter_that_is_used() {
    let desk = Desk::new();
    let text = desk.run(&["doctor"]).ends(0).text();
    assert!(
        text.contains("plumb renders on ") && text.contains("driver") && text.contains("CPU, "),
        "{text}"
    );
    let json: serde_json::Value =
        serde_json::from_slice(&desk.run(&["doctor", "--json"]).ends(0).stdout).unwrap();
    let name = json["adapters"][json["chosen"].as_u64().unwrap() as usize]["name"]
        .as_str()
        .unwrap();
    let part = name.split(' ').next().unwrap().to_uppercase();
    let args = ["render", "room.txt", "--adapter", &part, "--json"];
    let report: serde_json::Value =
        serde_json::from_slice(&desk.run(&args).ends(0).stdout).unwrap();
    assert!(
        report["adapter"].as_str().unwrap().contains(name),
        "{report}"
    );
    desk.run(&["render", "room.txt", "--adapter", "no such adapter"])
        .fails_with(&["no such adapter", name]);
}

/// A driver that is there and does not get its memory is not to be installed.
#[cfg(target_os = "linux")]
#[test]
fn short_memory_is_no_missing_driver() {
    let desk = Desk::new();
    for kilobytes in [200_000, 400_000, 600_000] {
        let program = env!("CARGO_BIN_EXE_plumb");
        let line = format!("ulimit -v {kilobytes}; exec {program} render room.txt");
        let mut shell = std::process::Command::new("sh");
        // Each thread reserves memory, and machines have many cores.
        shell.args(["-c", &line]).env("RAYON_NUM_THREADS", "2");
        let output = shell.current_dir(desk.folder.path()).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        // The driver or the C library may take the process with them, which is not in our hands; nothing of ours does.
        assert!(
            !told.contains("panicked") && !told.contains("install your"),
            "{told}"
        );
    }
}

/// The loader is told to find no driver at all.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_cpu_renders() {
    let desk = Desk::new();
    let run = |args: &[&str]| {
        let mut command = desk.command(args);
        command
            .env("VK_DRIVER_FILES", "/nonexistent.json")
            .env("VK_ICD_FILENAMES", "/nonexistent.json");
        Ran::new(args, command.output().unwrap())
    };
    let doctor = run(&["doctor"]).ends(1).text();
    assert!(
        doctor.contains("plumb renders on the CPU") && doctor.contains("mesa-vulkan-drivers"),
        "{doctor}"
    );
    run(&["render", "room.txt", "--backend", "gpu", "-o", "-"])
        .fails_with(&["no GPU adapter", "mesa-vulkan-drivers"]);
    // The CPU makes the same picture, so there is nothing to complain of; a fast one would be the GPU's.
    let auto = run(&["render", "room.txt"]).ends(0);
    assert!(
        auto.stderr.starts_with("room.ppm: 40×30, CPU, "),
        "{}",
        auto.stderr
    );
    let fast = run(&["render", "room.txt", "--precision", "fast"]).ends(0);
    assert!(
        fast.stderr.contains("so the CPU renders; "),
        "{}",
        fast.stderr
    );
    assert!(
        fast.stderr.contains("mesa-vulkan-drivers"),
        "{}",
        fast.stderr
    );
    assert_eq!(ppm(&desk.read("room.ppm")).1, 30);
    assert_eq!(run(&["render", "room.txt", "--quiet"]).ends(0).stderr, "");
}

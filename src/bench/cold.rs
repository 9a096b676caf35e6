//! `plumb render` as a process of its own, timed from outside, first with all caches empty, then once more.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;
use std::{fs, io};

use super::statistics::Times;

/// Most runs of a process, however often the rest is repeated.
const MOST_RUNS: u32 = 3;

/// Where the program and the drivers that heed it look for caches.
const CACHES: [&str; 3] = [
    "XDG_CACHE_HOME",
    "MESA_SHADER_CACHE_DIR",
    "__GL_SHADER_DISK_CACHE_PATH",
];

/// Runs `program render` on a scene's file with these options, up to three times twice: in a new folder for caches, and
/// again in the same. The picture goes to a PPM file in that folder. Returns both times.
///
/// # Errors
/// What the program or the system says.
pub fn processes(
    program: &Path,
    scene: &Path,
    size: [u32; 2],
    options: &[&str],
    repeat: u32,
) -> Result<[Option<Times>; 2], String> {
    let mut runs = [Vec::new(), Vec::new()];
    for _ in 0..repeat.min(MOST_RUNS) {
        let failed = |error: io::Error| format!("no folder for caches: {error}");
        let folder = tempfile::tempdir().map_err(failed)?;
        let caches = folder.path().join("caches");
        fs::create_dir(&caches).map_err(failed)?;
        for runs in &mut runs {
            runs.push(process(
                program,
                scene,
                size,
                options,
                folder.path(),
                &caches,
            )?);
        }
    }
    Ok(runs.map(|runs| Times::new(None, runs)))
}

fn process(
    program: &Path,
    scene: &Path,
    size: [u32; 2],
    options: &[&str],
    folder: &Path,
    caches: &Path,
) -> Result<f64, String> {
    let mut command = Command::new(program);
    command
        .args(["render", "--quiet", "--size"])
        .arg(format!("{}x{}", size[0], size[1]))
        .args(options)
        .args([OsStr::new("-o"), folder.join("picture.ppm").as_os_str()])
        .arg("--")
        .arg(scene)
        .envs(CACHES.map(|name| (name, caches)))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let start = Instant::now();
    let ended = command
        .output()
        .map_err(|error| format!("{} cannot be run: {error}", program.display()))?;
    let seconds = start.elapsed().as_secs_f64();
    if ended.status.success() {
        return Ok(seconds);
    }
    let said = String::from_utf8_lossy(&ended.stderr);
    Err(format!(
        "plumb render as a process of its own failed: {}",
        said.trim()
    ))
}

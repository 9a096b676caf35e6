//! The program on a second Vulkan driver: `PLUMB_SECOND_DRIVER` names its ICD file, and `sh scripts/test.sh` fetches
//! SwiftShader for it. A driver is chosen for a whole process, so it takes another one than the test's own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The second driver's ICD file.
pub(crate) fn second_driver() -> PathBuf {
    let Some(named) = std::env::var_os("PLUMB_SECOND_DRIVER") else {
        panic!(
            "there is no second driver: `sh scripts/test.sh` fetches one; or name the JSON file of another Vulkan driver in \
             PLUMB_SECOND_DRIVER"
        )
    };
    let path = PathBuf::from(named);
    assert!(path.is_file(), "no file {}", path.display());
    path
}

/// Runs the program, on the second driver if there is one given.
pub(crate) fn plumb(args: &[&str], driver: Option<&Path>) -> Output {
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

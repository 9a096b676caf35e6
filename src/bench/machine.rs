//! What a report was measured on.

use std::{env, fs, thread};

use serde::Serialize;

use crate::gpu::device::Gpu;

/// The machine, as far as it matters for times.
#[derive(Debug, Clone, Serialize)]
pub struct Machine {
    /// The GPU adapter's name; none where there is none.
    pub adapter: Option<String>,
    /// Its driver.
    pub driver: Option<String>,
    /// Why there is no GPU, if there is none.
    pub no_gpu: Option<String>,
    /// Whether kernels are timed by the device's own clock.
    pub timestamps: bool,
    /// The CPU's model.
    pub cpu: String,
    /// Its threads.
    pub threads: usize,
    /// The operating system.
    pub system: String,
}

impl Machine {
    /// This machine, with the adapter that renders or what keeps it from doing so.
    pub fn new(gpu: Result<&Gpu, String>) -> Self {
        let name = gpu.as_ref().ok().map(|gpu| gpu.name.clone());
        // `name [driver]`, as adapters are described.
        let (adapter, driver) = match name.as_deref().map(|name| name.split_once(" [")) {
            Some(Some((adapter, driver))) => (
                Some(adapter.to_owned()),
                Some(driver.trim_end_matches(']').to_owned()),
            ),
            _ => (name, None),
        };
        Self {
            adapter,
            driver,
            timestamps: gpu.as_ref().is_ok_and(|gpu| gpu.timestamps),
            no_gpu: gpu.err(),
            cpu: cpu(),
            threads: thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", env::consts::OS, env::consts::ARCH),
        }
    }
}

/// The CPU's model, as the system calls it.
fn cpu() -> String {
    let linux = || {
        let text = fs::read_to_string("/proc/cpuinfo").ok()?;
        model_name(&text)
    };
    let windows = || env::var("PROCESSOR_IDENTIFIER").ok();
    let mac = || {
        let mut command = std::process::Command::new("sysctl");
        let output = command
            .args(["-n", "machdep.cpu.brand_string"])
            .output()
            .ok()?;
        String::from_utf8(output.stdout).ok()
    };
    let found = if cfg!(target_os = "macos") {
        mac()
    } else {
        linux().or_else(windows)
    };
    found
        .map(|name| name.split_whitespace().collect::<Vec<_>>().join(" "))
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| format!("unknown ({})", env::consts::ARCH))
}

/// The first model that Linux' /proc/cpuinfo names.
fn model_name(text: &str) -> Option<String> {
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_the_first_that_is_named() {
        let text = "processor\t: 0\nmodel name\t: A  CPU @ 2 GHz\n\nmodel name\t: other\n";
        assert_eq!(model_name(text).as_deref(), Some("A  CPU @ 2 GHz"));
        assert_eq!(model_name("processor: 0\n"), None);
        assert!(!cpu().is_empty());
    }
}

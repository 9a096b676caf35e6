//! Adapters: which there are, and which one is used. `plumb doctor` lists them; `render` and others open the first.
//!
//! Stands above [`device`](super::device), which opens one, and [`selftest`], which tries out what was opened.

use std::sync::{Arc, OnceLock};

use serde::Serialize;

use super::GpuError;
use super::device::{Gpu, describe, driver};
use super::selftest::{self, Outcome};
use crate::shader::constants::WORKGROUP;

/// An adapter, for `plumb doctor`.
#[derive(Debug, Clone, Serialize)]
pub struct AdapterSummary {
    /// Its name, as the driver gives it.
    pub name: String,
    /// `discrete GPU`, `integrated GPU`, `virtual GPU`, `software` or `other`.
    pub kind: &'static str,
    /// The graphics API: `Vulkan`, `Metal` or `Dx12`.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
    /// Largest storage buffer that can be bound, in bytes.
    pub max_storage_buffer: u64,
    /// Largest buffer, in bytes.
    pub max_buffer: u64,
    /// Largest workgroup, in invocations.
    pub max_workgroup: u32,
    /// Whether kernels can be timed on the device.
    pub timestamps: bool,
    /// Whether shaders can compute in f64 (plumb does not need it).
    pub shader_f64: bool,
    /// Why plumb cannot use it, if so.
    pub problem: Option<String>,
    /// How the self-test went, check by check; none where plumb cannot use the adapter.
    pub selftest: Option<Vec<Outcome>>,
}

/// All adapters, in the order in which plumb prefers them: discrete, integrated, virtual, software; each of them
/// tested.
pub fn list() -> Vec<AdapterSummary> {
    let tested = |adapter: &wgpu::Adapter| {
        let mut summary = summary(adapter);
        if summary.problem.is_none() {
            match Gpu::open(adapter).and_then(|gpu| selftest::run(&gpu)) {
                Ok(outcomes) => summary.selftest = Some(outcomes),
                Err(error) => summary.problem = Some(error.to_string()),
            }
        }
        summary
    };
    enumerate(instance()).iter().map(tested).collect()
}

/// The first adapter that can be used, or the first whose name contains `wanted` in any case of letters.
///
/// # Errors
/// If there is none.
pub fn find(wanted: Option<&str>) -> Result<wgpu::Adapter, GpuError> {
    choose(&enumerate(instance()), wanted).cloned()
}

/// Adapters that a picture may be made on together.
#[derive(Debug)]
pub enum Candidates {
    /// These: the one that was named, else all that are hardware, else the first that is software.
    Adapters(Vec<wgpu::Adapter>),
    /// There is software only, which was not asked for; it is called this.
    Software(String),
}

/// The adapters for a picture: the one that was named, or all that are hardware and can be used; where there are none,
/// the first that is software, if that will do.
///
/// # Errors
/// If there is none.
pub fn candidates(wanted: Option<&str>, software: bool) -> Result<Candidates, GpuError> {
    let all = enumerate(instance());
    if wanted.is_none() {
        let is_hardware = |adapter: &&wgpu::Adapter| {
            !is_software(&adapter.get_info()) && problem(adapter).is_none()
        };
        let hardware: Vec<_> = all.iter().filter(is_hardware).cloned().collect();
        if !hardware.is_empty() {
            return Ok(Candidates::Adapters(hardware));
        }
    }
    let first = choose(&all, wanted)?;
    if wanted.is_none() && !software && is_software(&first.get_info()) {
        return Ok(Candidates::Software(first.get_info().name));
    }
    Ok(Candidates::Adapters(vec![first.clone()]))
}

pub(super) fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

/// Whether there may be an adapter that is no software, as far as can be told without loading a driver: on Linux GPUs
/// are files in /dev.
pub fn may_be_hardware() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let is_gpu = |name: &str| {
        ["nvidia", "dxg", "kfd", "mali", "kgsl"]
            .iter()
            .any(|start| name.starts_with(start))
    };
    let holds = |folder: &str, is_gpu: &dyn Fn(&str) -> bool| {
        let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.any(|entry| is_gpu(&entry.file_name().to_string_lossy()))
    };
    holds("/dev/dri", &|name| name.starts_with("renderD")) || holds("/dev", &is_gpu)
}

/// Opens the adapter that [`find`] finds.
///
/// # Errors
/// As [`find`], and as [`Gpu::open`].
pub fn open(wanted: Option<&str>) -> Result<Gpu, GpuError> {
    Gpu::open(&find(wanted)?)
}

/// A device for a window, with what else a window is made from.
#[derive(Debug, Clone)]
pub struct Opened {
    /// The device.
    pub gpu: Arc<Gpu>,
    /// What adapters and surfaces come from.
    pub instance: wgpu::Instance,
    /// The adapter that it was opened on.
    pub adapter: wgpu::Adapter,
}

/// The same as [`open`], for a window.
///
/// # Errors
/// As [`open`].
pub fn open_for_window(wanted: Option<&str>) -> Result<Opened, GpuError> {
    let adapter = find(wanted)?;
    Ok(Opened {
        gpu: Arc::new(Gpu::open(&adapter)?),
        instance: instance().clone(),
        adapter,
    })
}

/// The device that draws the window in which the pictures of `renderer` are shown, which was opened for the same
/// `wanted`.
///
/// On a GPU that is the same device: it changes from one work to the next in a moment, and pictures need not be moved.
/// A driver that computes on the CPU works off what it is given in the order in which it came, and keeps whoever hands
/// something in waiting meanwhile. There the window has a device of its own, on an instance of its own, since a driver's
/// threads belong to its instance: neither queue nor threads are shared, and the system's scheduler decides who goes
/// first.
///
/// # Errors
/// As [`open`].
pub fn open_beside(renderer: &Opened, wanted: Option<&str>) -> Result<Opened, GpuError> {
    if !is_software(&renderer.adapter.get_info()) {
        return Ok(renderer.clone());
    }
    static INSTANCE: OnceLock<wgpu::Instance> = OnceLock::new();
    let instance = INSTANCE.get_or_init(new_instance);
    let adapter = choose(&enumerate(instance), wanted)?.clone();
    Ok(Opened {
        gpu: Arc::new(Gpu::open(&adapter)?),
        instance: instance.clone(),
        adapter,
    })
}

/// The instance that all rendering is done on. It is never dropped, since that unloads the driver, and NVIDIA's can be
/// loaded about thirty times in a process only: the next instance finds no adapter, or the process dies. So a process
/// may open as many devices, one after the other, as it likes; and only the first of them waits for the driver.
fn instance() -> &'static wgpu::Instance {
    static INSTANCE: OnceLock<wgpu::Instance> = OnceLock::new();
    INSTANCE.get_or_init(new_instance)
}

fn new_instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: wgpu::InstanceFlags::empty().with_env(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

/// All adapters, those that plumb prefers first.
fn enumerate(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    // The sort is stable, so that adapters of equal rank stay in the system's order.
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    adapters
}

fn rank(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    }
}

fn choose<'a>(
    adapters: &'a [wgpu::Adapter],
    wanted: Option<&str>,
) -> Result<&'a wgpu::Adapter, GpuError> {
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter);
    }
    if let Some(wanted) = wanted {
        let part = wanted.to_lowercase();
        let named =
            |adapter: &&wgpu::Adapter| describe(&adapter.get_info()).to_lowercase().contains(&part);
        return adapters
            .iter()
            .find(named)
            .ok_or_else(|| GpuError::NoSuchAdapter {
                wanted: wanted.to_owned(),
                found: adapters
                    .iter()
                    .map(|adapter| describe(&adapter.get_info()))
                    .collect(),
            });
    }
    let usable = adapters.iter().find(|adapter| problem(adapter).is_none());
    match usable {
        Some(adapter) => Ok(adapter),
        None => Err(GpuError::Device {
            adapter: describe(&adapters[0].get_info()),
            reason: problem(&adapters[0]).unwrap_or_default(),
        }),
    }
}

/// Why plumb cannot use the adapter, if so.
fn problem(adapter: &wgpu::Adapter) -> Option<String> {
    let limits = adapter.limits();
    let flags = adapter.get_downlevel_capabilities().flags;
    if !flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
        return Some("it has no compute shaders".into());
    }
    let needed = WORKGROUP * WORKGROUP;
    if limits.max_compute_invocations_per_workgroup < needed {
        return Some(format!(
            "its workgroups hold fewer than {needed} invocations"
        ));
    }
    None
}

fn summary(adapter: &wgpu::Adapter) -> AdapterSummary {
    let info = adapter.get_info();
    let limits = adapter.limits();
    let features = adapter.features();
    AdapterSummary {
        name: info.name.clone(),
        kind: match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete GPU",
            wgpu::DeviceType::IntegratedGpu => "integrated GPU",
            wgpu::DeviceType::VirtualGpu => "virtual GPU",
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::Other => "other",
        },
        backend: info.backend.to_string(),
        driver: driver(&info),
        max_storage_buffer: limits.max_storage_buffer_binding_size,
        max_buffer: limits.max_buffer_size,
        max_workgroup: limits.max_compute_invocations_per_workgroup,
        timestamps: features.contains(wgpu::Features::TIMESTAMP_QUERY),
        shader_f64: features.contains(wgpu::Features::SHADER_F64),
        problem: problem(adapter),
        selftest: None,
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use super::*;

    /// The libraries that the process has loaded.
    fn loaded() -> BTreeSet<String> {
        let maps = fs::read_to_string("/proc/self/maps").unwrap();
        let path = |line: &str| Some(line[line.find('/')?..].to_owned());
        let libraries = maps.lines().filter_map(path);
        libraries.filter(|path| path.contains(".so")).collect()
    }

    /// Some drivers cannot be loaded again and again. Needs an adapter, and fails without one.
    #[test]
    fn the_driver_stays_loaded_between_devices() {
        let gpu = open(None).unwrap();
        let with = loaded();
        drop(gpu);
        let without = loaded();
        let gone: Vec<_> = with.difference(&without).collect();
        assert!(gone.is_empty(), "{gone:?}");
    }
}

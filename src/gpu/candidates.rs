//! Which adapters may make a picture together, and whether it is worth loading a driver to ask.

use std::collections::HashSet;
use std::fs;

use super::GpuError;
use super::adapters::{choose, enumerate, instance, problem, wanted_by_variable};
use super::device::is_software;

/// Adapters that a picture may be made on together.
#[derive(Debug)]
pub enum Candidates {
    /// These: the one that was named, else all that are hardware, else the first that is software.
    Adapters(Vec<wgpu::Adapter>),
    /// There is software only, which was not asked for; it is called this.
    Software(String),
}

/// Whether an adapter is named: by this, or by the environment.
pub fn is_named(wanted: Option<&str>) -> bool {
    wanted.is_some() || wanted_by_variable().is_some()
}

/// The adapters for a picture: the one that was named, or all that are hardware and can be used; where there are none,
/// the first that is software, if that will do.
///
/// # Errors
/// If there is none.
pub fn candidates(wanted: Option<&str>, software: bool) -> Result<Candidates, GpuError> {
    let all = enumerate(instance());
    let named = is_named(wanted);
    if !named {
        let is_usable = |adapter: &&wgpu::Adapter| {
            !is_software(&adapter.get_info()) && problem(adapter).is_none()
        };
        let mut hardware: Vec<_> = all.iter().filter(is_usable).cloned().collect();
        let mut seen = HashSet::new();
        hardware.retain(|adapter| card(&adapter.get_info()).is_none_or(|card| seen.insert(card)));
        if !hardware.is_empty() {
            return Ok(Candidates::Adapters(hardware));
        }
    }
    let first = choose(&all, wanted)?;
    if !named && !software && is_software(&first.get_info()) {
        return Ok(Candidates::Software(first.get_info().name));
    }
    Ok(Candidates::Adapters(vec![first.clone()]))
}

/// What is the same for a card that two drivers list, and for no two cards: where it is plugged in, where that is told.
fn card(info: &wgpu::AdapterInfo) -> Option<(u32, u32, String)> {
    let bus = &info.device_pci_bus_id;
    (!bus.is_empty()).then(|| (info.vendor, info.device, bus.clone()))
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
        let mut entries = fs::read_dir(folder).into_iter().flatten().flatten();
        entries.any(|entry| is_gpu(&entry.file_name().to_string_lossy()))
    };
    holds("/dev/dri", &|name| name.starts_with("renderD")) || holds("/dev", &is_gpu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_is_one_whatever_its_drivers_are_called() {
        let info = |driver: &str, bus: &str| {
            let mut info =
                wgpu::AdapterInfo::new(wgpu::DeviceType::DiscreteGpu, wgpu::Backend::Vulkan);
            info.driver = driver.into();
            info.device_pci_bus_id = bus.into();
            info
        };
        let [a, b] = ["0000:01:00.0", "0000:02:00.0"];
        assert_eq!(card(&info("one", a)), card(&info("another", a)));
        assert_ne!(card(&info("one", a)), card(&info("one", b)));
        // Two that do not tell may be two of a kind.
        assert_eq!(card(&info("one", "")), None);
    }
}

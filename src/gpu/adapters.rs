//! Adapters: which there are, and which one is used. `plumb doctor` lists them; `render` and others open the first, or
//! the one that [`VARIABLE`] names.
//!
//! Stands above [`device`](super::device), which opens one, and [`selftest`], which tries out what was opened. Driver
//! and devices are the process's: whoever asks first, on any thread, waits for them, and nobody gives them back.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use serde::Serialize;

use super::GpuError;
use super::device::{Gpu, describe, driver, full_name};
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
    /// How it passed the self-test with f64, if it has that.
    pub selftest_f64: Option<Vec<Outcome>>,
}

impl AdapterSummary {
    /// Whether this part of a name means the adapter.
    pub fn is_named(&self, part: &str) -> bool {
        is_part_of(part, &full_name(&self.name, &self.driver))
    }
}

/// The environment's variable that names an adapter where nothing else does.
pub const VARIABLE: &str = "PLUMB_ADAPTER";

/// All adapters, in the order in which plumb prefers them: discrete, integrated, virtual, software; each of them
/// tested.
pub fn list() -> Vec<AdapterSummary> {
    let tested = |adapter: &wgpu::Adapter| {
        let mut summary = summary(adapter);
        if summary.problem.is_none() {
            let tested = Gpu::open(adapter).and_then(|gpu| {
                summary.selftest_f64 = gpu
                    .doubles
                    .then(|| selftest::run_double(&gpu))
                    .transpose()?;
                selftest::run(&gpu)
            });
            match tested {
                Ok(outcomes) => summary.selftest = Some(outcomes),
                Err(error) => summary.problem = Some(error.to_string()),
            }
        }
        summary
    };
    enumerate(instance()).iter().map(tested).collect()
}

/// What [`VARIABLE`] says, if it says anything.
pub fn wanted_by_variable() -> Option<String> {
    std::env::var(VARIABLE).ok().filter(|part| !part.is_empty())
}

/// The first adapter that can be used, or the first whose name contains `wanted`, or else what [`VARIABLE`] says, in
/// any case of letters.
///
/// # Errors
/// If there is none.
pub fn find(wanted: Option<&str>) -> Result<wgpu::Adapter, GpuError> {
    choose(&enumerate(instance()), wanted).cloned()
}

pub(super) fn choose<'a>(
    adapters: &'a [wgpu::Adapter],
    wanted: Option<&str>,
) -> Result<&'a wgpu::Adapter, GpuError> {
    match (wanted, wanted_by_variable()) {
        (Some(part), _) => named(adapters, part, "--adapter"),
        (None, Some(part)) => named(adapters, &part, VARIABLE),
        (None, None) => first_usable(adapters),
    }
}

/// Opens the adapter that [`find`] finds, for the caller alone.
///
/// # Errors
/// As [`find`], and as [`Gpu::open`].
pub fn open(wanted: Option<&str>) -> Result<Gpu, GpuError> {
    Gpu::open(&find(wanted)?)
}

/// [`shared_on`] the adapter that [`find`] finds.
///
/// # Errors
/// As [`find`], and as [`Gpu::open`].
pub fn shared(wanted: Option<&str>) -> Result<Arc<Gpu>, GpuError> {
    shared_on(&find(wanted)?)
}

/// The process's own device on this adapter: opened when it is first asked for, and anew when something went wrong with
/// the one before. It stays open, for the next picture, and is not closed at the end of the process either, since the
/// system does that.
///
/// # Errors
/// As [`Gpu::open`].
pub fn shared_on(adapter: &wgpu::Adapter) -> Result<Arc<Gpu>, GpuError> {
    static SHARED: Shared = Shared(Mutex::new(Vec::new()));
    SHARED.get(adapter)
}

/// Devices that stay open, at most one an adapter.
struct Shared(Mutex<Vec<(wgpu::AdapterInfo, Arc<Gpu>)>>);

impl Shared {
    fn get(&self, adapter: &wgpu::Adapter) -> Result<Arc<Gpu>, GpuError> {
        let info = adapter.get_info();
        if let Some(gpu) = self.sound(&info) {
            return Ok(gpu);
        }
        // No lock is held meanwhile, so that two adapters open at the same time; of one adapter the first one counts.
        let opened = Arc::new(Gpu::open(adapter)?);
        if let Some(gpu) = self.sound(&info) {
            return Ok(gpu);
        }
        self.lock().push((info, Arc::clone(&opened)));
        Ok(opened)
    }

    /// The adapter's device, if nothing went wrong with it.
    fn sound(&self, info: &wgpu::AdapterInfo) -> Option<Arc<Gpu>> {
        let mut shared = self.lock();
        shared.retain(|(_, gpu)| gpu.check().is_ok());
        let (_, gpu) = shared.iter().find(|(of, _)| of == info)?;
        Some(Arc::clone(gpu))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(wgpu::AdapterInfo, Arc<Gpu>)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
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
/// something in waiting meanwhile. There the window has a device of its own, on an instance of its own, since a
/// driver's threads belong to its instance: neither queue nor threads are shared, and the system's scheduler decides
/// who goes first.
///
/// # Errors
/// As [`open`].
pub fn open_beside(renderer: &Opened, wanted: Option<&str>) -> Result<Opened, GpuError> {
    if renderer.adapter.get_info().device_type != wgpu::DeviceType::Cpu {
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
pub(super) fn instance() -> &'static wgpu::Instance {
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
pub(super) fn enumerate(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
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

/// The first whose name contains this part of it, as `asker` wants it.
fn named<'a>(
    adapters: &'a [wgpu::Adapter],
    part: &str,
    asker: &'static str,
) -> Result<&'a wgpu::Adapter, GpuError> {
    let name = |adapter: &wgpu::Adapter| describe(&adapter.get_info());
    let found = adapters
        .iter()
        .find(|adapter| is_part_of(part, &name(adapter)));
    found.ok_or_else(|| match adapters {
        [] => GpuError::NoAdapter,
        _ => GpuError::NoSuchAdapter {
            wanted: part.to_owned(),
            asker,
            found: adapters.iter().map(name).collect(),
        },
    })
}

/// Whether an adapter of this name is meant.
fn is_part_of(part: &str, name: &str) -> bool {
    name.to_lowercase().contains(&part.to_lowercase())
}

fn first_usable(adapters: &[wgpu::Adapter]) -> Result<&wgpu::Adapter, GpuError> {
    let first = adapters.first().ok_or(GpuError::NoAdapter)?;
    let usable = adapters.iter().find(|adapter| problem(adapter).is_none());
    usable.ok_or_else(|| GpuError::Device {
        adapter: describe(&first.get_info()),
        reason: problem(first).unwrap_or_default(),
    })
}

/// Why plumb cannot use the adapter, if so.
pub(super) fn problem(adapter: &wgpu::Adapter) -> Option<String> {
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
        selftest_f64: None,
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use super::*;

    /// As many devices as the whole test-suite opens, one after the other and some at a time. Needs an adapter, and
    /// fails without one.
    #[test]
    fn a_process_opens_as_many_devices_as_it_likes() {
        for _ in 0..30 {
            let opened: Vec<Gpu> = (0..4).map(|_| open(None).unwrap()).collect();
            assert!(opened.iter().all(|gpu| gpu.check().is_ok()));
        }
    }

    /// Whoever asks, on whichever thread, gets the same device, until something goes wrong with it. Needs an adapter,
    /// and fails without one.
    #[test]
    fn a_device_is_shared_until_it_fails() {
        let devices = Shared(Mutex::new(Vec::new()));
        let get = || devices.get(&find(None).unwrap()).unwrap();
        let first = get();
        let on_thread = std::thread::scope(|scope| scope.spawn(get).join().unwrap());
        assert!(Arc::ptr_eq(&first, &on_thread));
        // This one is refused: a buffer to be mapped for reading must not be one of a scene.
        let _refused = first.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        assert!(first.check().is_err());
        let next = get();
        assert!(!Arc::ptr_eq(&first, &next));
        assert!(next.check().is_ok());
    }

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

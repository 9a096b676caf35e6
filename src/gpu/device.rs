//! Adapters: which there are, which one is used, and opening it.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use serde::Serialize;

use super::GpuError;
use super::selftest::{self, Outcome};
use super::turn::Turn;
use crate::shader::constants::WORKGROUP;
use crate::shader::feature_set::SOFTWARE_LANES;

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    /// The logical device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What the adapter is called, with its driver.
    pub name: String,
    /// All that tells it from other adapters and other drivers: name, driver, driver's version, interface, numbers.
    pub identity: String,
    /// Whether the driver tells its version, so that another version has another identity.
    pub tells_version: bool,
    /// Whether kernels can be timed on the device.
    pub timestamps: bool,
    /// How many invocations share a limit on loops: lavapipe's lanes of a vector; 1 on a GPU, where there is no limit.
    pub lanes: u32,
    /// Seconds that loading the driver took, and opening the device.
    pub seconds: [f64; 2],
    /// Whether work may be handed in.
    pub turn: Turn,
    trouble: Arc<Mutex<Trouble>>,
}

/// Whether wgpu says that a window's surface could not be set up anew because the device did not come idle, or that a frame was
/// drawn for another size than the surface has after that.
fn is_of_a_stale_surface(error: &str) -> bool {
    error.contains("before reconfiguring the Surface")
        || error.contains("is not contained in the render target")
}

/// What went wrong behind our back: wgpu reports some errors by callback.
#[derive(Debug, Default)]
struct Trouble {
    lost: Option<String>,
    refused: Option<String>,
    memory: Option<String>,
}

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

/// All adapters, in the order in which plumb prefers them: discrete, integrated, virtual, software; each of them tested.
pub fn adapters() -> Vec<AdapterSummary> {
    let (_instance, adapters) = enumerate();
    let tested = |adapter: &wgpu::Adapter| {
        let mut summary = summary(adapter);
        if summary.problem.is_none() {
            match open_adapter(adapter).and_then(|gpu| selftest::run(&gpu)) {
                Ok(outcomes) => summary.selftest = Some(outcomes),
                Err(error) => summary.problem = Some(error.to_string()),
            }
        }
        summary
    };
    adapters.iter().map(tested).collect()
}

/// Opens the first adapter, or the first whose name contains `wanted` in any case of letters.
pub fn open(wanted: Option<&str>) -> Result<Gpu, GpuError> {
    let start = Instant::now();
    // The instance has to outlive the adapters only.
    let (_instance, adapters) = enumerate();
    let adapter = choose(&adapters, wanted)?;
    let instance_seconds = start.elapsed().as_secs_f64();
    let mut gpu = open_adapter(adapter)?;
    gpu.seconds[0] = instance_seconds;
    Ok(gpu)
}

/// A device for a window, with what else a window is made from.
#[derive(Debug)]
pub struct Opened {
    /// The device.
    pub gpu: Gpu,
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
    let (instance, adapters) = enumerate();
    let adapter = choose(&adapters, wanted)?.clone();
    Ok(Opened {
        gpu: open_adapter(&adapter)?,
        instance,
        adapter,
    })
}

fn open_adapter(adapter: &wgpu::Adapter) -> Result<Gpu, GpuError> {
    let start = Instant::now();
    let info = adapter.get_info();
    let name = describe(&info);
    let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("plumb"),
        required_features: if timestamps {
            wgpu::Features::TIMESTAMP_QUERY
        } else {
            wgpu::Features::empty()
        },
        required_limits: adapter.limits(),
        ..Default::default()
    };
    let (device, queue) =
        pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
            GpuError::Device {
                adapter: name.clone(),
                reason: error.to_string(),
            }
        })?;
    let trouble = Arc::new(Mutex::new(Trouble::default()));
    watch(&device, &trouble);
    let device_seconds = start.elapsed().as_secs_f64();
    let software = info.device_type == wgpu::DeviceType::Cpu;
    let lanes = if software {
        info.subgroup_max_size.max(SOFTWARE_LANES)
    } else {
        1
    };
    Ok(Gpu {
        device,
        queue,
        name,
        identity: identity(&info),
        tells_version: !info.driver_info.is_empty(),
        timestamps,
        lanes,
        seconds: [0.0, device_seconds],
        turn: Turn::default(),
        trouble,
    })
}

/// Notes what wgpu reports by callback, where it would panic otherwise.
fn watch(device: &wgpu::Device, trouble: &Arc<Mutex<Trouble>>) {
    let errors = Arc::clone(trouble);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let mut trouble = errors.lock().unwrap_or_else(PoisonError::into_inner);
        match error {
            wgpu::Error::OutOfMemory { source } => trouble.memory.get_or_insert(source.to_string()),
            // A frame of a window is lost; the next one tries again.
            other if is_of_a_stale_surface(&other.to_string()) => return,
            other => trouble.refused.get_or_insert(other.to_string()),
        };
    }));
    let lost = Arc::clone(trouble);
    device.set_device_lost_callback(move |reason, message| {
        // Dropping the device counts as destroying it, and is no trouble.
        if reason != wgpu::DeviceLostReason::Destroyed {
            lost.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .lost
                .get_or_insert(message);
        }
    });
}

impl Gpu {
    /// What went wrong since the device was opened, if anything.
    pub fn check(&self) -> Result<(), GpuError> {
        let trouble = self.trouble.lock().unwrap_or_else(PoisonError::into_inner);
        let adapter = self.name.clone();
        if let Some(reason) = trouble.lost.clone() {
            return Err(GpuError::Lost { adapter, reason });
        }
        if let Some(reason) = trouble.memory.clone() {
            return Err(GpuError::OutOfMemory { adapter, reason });
        }
        if let Some(reason) = trouble.refused.clone() {
            return Err(GpuError::Refused { adapter, reason });
        }
        Ok(())
    }

    /// Compiles the shader `wgsl` from its entry point on, with the bindings that it uses.
    pub fn compile(&self, wgsl: &str, entry: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("plumb"),
                source: wgpu::ShaderSource::Wgsl(wgsl.into()),
            });
        self.check()?;
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("plumb"),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        self.check()?;
        Ok(pipeline)
    }

    /// Hands work in, once it is its [`turn`](Self::turn).
    pub fn submit(&self, encoder: wgpu::CommandEncoder) -> wgpu::SubmissionIndex {
        let work = encoder.finish();
        self.turn.take(|| self.queue.submit([work]))
    }

    /// Waits for what was submitted, and for what is to be mapped after it.
    pub fn wait(&self, index: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        let polled = self.device.poll(wgpu::PollType::Wait {
            submission_index: Some(index),
            timeout: None,
        });
        self.check()?;
        polled.map(|_| ()).map_err(|error| self.lost(&error))
    }

    /// Binds buffers to a compiled shader, by the numbers of their bindings.
    pub fn bind(
        &self,
        pipeline: &wgpu::ComputePipeline,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = buffers
            .iter()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plumb"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    /// Runs a shader once, waits, and reads back what it left in `results`.
    pub fn run_once(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: &wgpu::BindGroup,
        [across, down]: [u32; 2],
        results: &wgpu::Buffer,
    ) -> Result<Vec<u8>, GpuError> {
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size: results.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(across, down, 1);
        }
        encoder.copy_buffer_to_buffer(results, 0, &staging, 0, results.size());
        let index = self.submit(encoder);
        staging.map_async(wgpu::MapMode::Read, .., |_| ());
        self.wait(index)?;
        let view = staging
            .get_mapped_range(..)
            .map_err(|error| self.lost(&error))?;
        Ok(view.to_vec())
    }

    /// The error of a device that does not answer as it should.
    pub fn lost(&self, reason: &impl ToString) -> GpuError {
        GpuError::Lost {
            adapter: self.name.clone(),
            reason: reason.to_string(),
        }
    }
}

fn enumerate() -> (wgpu::Instance, Vec<wgpu::Adapter>) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: wgpu::InstanceFlags::empty().with_env(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    // Stable: among equals the system's own order stays.
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    (instance, adapters)
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

/// Name and driver, for people.
fn describe(info: &wgpu::AdapterInfo) -> String {
    let driver = driver(info);
    if driver.is_empty() {
        info.name.clone()
    } else {
        format!("{} [{driver}]", info.name)
    }
}

fn driver(info: &wgpu::AdapterInfo) -> String {
    format!("{} {}", info.driver, info.driver_info)
        .trim()
        .to_owned()
}

/// All that tells an adapter from others, in a line.
fn identity(info: &wgpu::AdapterInfo) -> String {
    let wgpu::AdapterInfo {
        name,
        vendor,
        device,
        driver,
        driver_info,
        backend,
        ..
    } = info;
    format!("{name} | {driver} | {driver_info} | {backend} | {vendor:04x}:{device:04x}")
        .replace(['\n', '\r'], " ")
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

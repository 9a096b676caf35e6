//! A device: opening it on an adapter that [`adapters`](super::adapters) found, handing work to it, hearing of its
//! troubles.

use std::sync::{Arc, Mutex, PoisonError};

use super::GpuError;
use super::bands::buffers::BufferPool;
use super::submit_gate::SubmitGate;
use crate::shader::feature_set::SOFTWARE_LANES;

/// What shaders with f64 need.
const DOUBLES: wgpu::Features = wgpu::Features::SHADER_F64.union(wgpu::Features::SHADER_INT64);

/// What a device is to have, if the adapter does.
const WANTED: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY.union(DOUBLES);

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
    /// Whether shaders may have f64, and u64 for its bits.
    pub doubles: bool,
    /// Whether it is a program on the CPU.
    pub software: bool,
    /// How many invocations share a limit on loops: lavapipe's lanes of a vector; 1 on a GPU, where there is no limit.
    pub lanes: u32,
    /// Whether work may be handed in.
    pub submit_gate: SubmitGate,
    /// Buffers of dispatches that are over.
    pub(super) buffers: Arc<BufferPool>,
    trouble: Arc<Mutex<Trouble>>,
}

/// Whether wgpu says that a window's surface could not be set up anew because the device did not come idle, or that a
/// frame was drawn for another size than the surface has after that.
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

/// Notes what wgpu reports by callback, where it would panic otherwise.
fn watch(device: &wgpu::Device, trouble: &Arc<Mutex<Trouble>>) {
    let errors = Arc::clone(trouble);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let mut trouble = errors.lock().unwrap_or_else(PoisonError::into_inner);
        match error {
            wgpu::Error::OutOfMemory { source } => trouble.memory.get_or_insert(source.to_string()),
            // Only one frame of the window is lost, and the next frame tries again.
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
    /// Opens a device on this adapter, with all that it has.
    ///
    /// # Errors
    /// What the driver says.
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let name = describe(&info);
        let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("plumb"),
            required_features: adapter.features() & WANTED,
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
        let software = is_software(&info);
        let lanes = if software {
            info.subgroup_max_size.max(SOFTWARE_LANES)
        } else {
            1
        };
        Ok(Self {
            device,
            queue,
            name,
            identity: identity(&info),
            tells_version: !info.driver_info.is_empty(),
            timestamps,
            doubles: adapter.features().contains(DOUBLES),
            software,
            lanes,
            submit_gate: SubmitGate::default(),
            buffers: Arc::default(),
            trouble,
        })
    }

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
    ///
    /// # Errors
    /// Who asked for a shader that is refused hears of it; the device is as sound for everyone else as it was.
    pub fn compile(&self, wgsl: &str, entry: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        // wgpu's scopes belong to the thread that opened them.
        let refusals = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("plumb"),
                source: wgpu::ShaderSource::Wgsl(wgsl.into()),
            });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("plumb"),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                // No shader of ours reads what it has not written.
                compilation_options: wgpu::PipelineCompilationOptions {
                    zero_initialize_workgroup_memory: false,
                    ..Default::default()
                },
                cache: None,
            });
        if let Some(refusal) = pollster::block_on(refusals.pop()) {
            return Err(GpuError::Refused {
                adapter: self.name.clone(),
                reason: refusal.to_string(),
            });
        }
        self.check()?;
        Ok(pipeline)
    }

    /// Hands work in, once it passes the [`submit_gate`](Self::submit_gate).
    pub fn submit(&self, encoder: wgpu::CommandEncoder) -> wgpu::SubmissionIndex {
        let work = encoder.finish();
        self.submit_gate.pass(|| self.queue.submit([work]))
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

/// Name and driver, for people.
pub(super) fn describe(info: &wgpu::AdapterInfo) -> String {
    full_name(&info.name, &driver(info))
}

pub(super) fn full_name(adapter: &str, driver: &str) -> String {
    if driver.is_empty() {
        adapter.to_owned()
    } else {
        format!("{adapter} [{driver}]")
    }
}

pub(super) fn driver(info: &wgpu::AdapterInfo) -> String {
    format!("{} {}", info.driver, info.driver_info)
        .trim()
        .to_owned()
}

/// Whether the adapter is a program on the CPU.
pub(super) fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
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

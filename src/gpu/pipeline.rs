//! A composed shader compiled, and the packed scene in buffers bound to it.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use wgpu::util::DeviceExt as _;

use super::GpuError;
use super::device::Gpu;
use crate::shader::binding::{Binding, DISPATCH, OFFSETS, PIXELS};
use crate::shader::feature::{Feature, Features};
use crate::shader::feature_set::FeatureSet;
use crate::shader::form::Form;
use crate::shader::format::Format;
use crate::shader::pack::Packed;
use crate::shader::record::Wide as _;
use crate::shader::records::CameraNumbers;

/// A shader ready to run on a scene.
#[derive(Debug)]
pub struct Pipeline {
    /// The compiled shader.
    pub pipeline: wgpu::ComputePipeline,
    /// What it leaves of pixels.
    pub form: Form,
    /// The camera, where the shader reads it from the dispatch's record.
    pub camera: Option<CameraNumbers>,
    buffers: SceneBuffers,
}

/// The packed scene in buffers, by the numbers of their bindings.
#[derive(Debug)]
pub struct SceneBuffers(Vec<(u32, wgpu::Buffer)>);

impl SceneBuffers {
    /// The buffers that a shader with these features reads.
    ///
    /// # Errors
    /// If the device does not allow so large a buffer, or so many.
    pub fn new<F: Format>(
        gpu: &Gpu,
        packed: &Packed<F>,
        set: &FeatureSet,
    ) -> Result<Self, GpuError> {
        let features = set.features();
        let has = |feature: Feature| features.contains(&feature);
        let buffers = upload(gpu, packed, &features)?;
        // The shader reads these buffers, writes the pixels, and perhaps reads the samples' offsets.
        let needed = buffers.len() as u32 + 1 + u32::from(has(Feature::Course));
        let allowed = gpu.device.limits().max_storage_buffers_per_shader_stage;
        if needed > allowed {
            return Err(GpuError::TooManyBuffers {
                needed,
                allowed,
                adapter: gpu.name.clone(),
            });
        }
        Ok(Self(buffers))
    }
}

impl Pipeline {
    /// Compiles `wgsl`, composed for `packed` with the features of `set`, and uploads the scene.
    pub fn new<F: Format>(
        gpu: &Gpu,
        packed: &Packed<F>,
        set: &FeatureSet,
        wgsl: &str,
    ) -> Result<Self, GpuError> {
        let buffers = SceneBuffers::new(gpu, packed, set)?;
        Ok(Self::of(gpu.compile(wgsl, "main")?, buffers, packed, set))
    }

    /// The compiled shader with its scene's buffers.
    pub(crate) fn of<F: Format>(
        pipeline: wgpu::ComputePipeline,
        buffers: SceneBuffers,
        packed: &Packed<F>,
        set: &FeatureSet,
    ) -> Self {
        let features = set.features();
        let has = |feature: Feature| features.contains(&feature);
        Self {
            pipeline,
            form: Form::of(set),
            camera: has(Feature::Moving).then(|| F::wide(&packed.camera.numbers).narrow()),
            buffers,
        }
    }

    /// Binds the scene, a dispatch's record, a buffer for its pixels, and one for the offsets of its samples if they
    /// are read.
    pub fn bind(
        &self,
        gpu: &Gpu,
        dispatch: &wgpu::Buffer,
        pixels: &wgpu::Buffer,
        offsets: Option<&wgpu::Buffer>,
    ) -> wgpu::BindGroup {
        let own = [(DISPATCH, dispatch), (PIXELS, pixels)]
            .into_iter()
            .chain(offsets.map(|offsets| (OFFSETS, offsets)));
        let scene = self
            .buffers
            .0
            .iter()
            .map(|(binding, buffer)| (*binding, buffer));
        gpu.bind(&self.pipeline, &own.chain(scene).collect::<Vec<_>>())
    }
}

/// Shaders compiled lately, by their texts.
#[derive(Debug, Default)]
pub struct Compiled {
    /// The latest at the back.
    pipelines: Mutex<VecDeque<(String, wgpu::ComputePipeline)>>,
}

/// So many shaders are kept.
const KEPT: usize = 8;

impl Compiled {
    /// The pipeline of a shader's text, compiled if it is not there.
    pub(crate) fn get(&self, gpu: &Gpu, wgsl: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        let lock = || {
            self.pipelines
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let mut pipelines = lock();
        if let Some(place) = pipelines.iter().position(|(text, _)| text == wgsl)
            && let Some((text, pipeline)) = pipelines.remove(place)
        {
            pipelines.push_back((text, pipeline.clone()));
            return Ok(pipeline);
        }
        // The lock is released while this shader compiles, so that other threads can go on.
        drop(pipelines);
        let pipeline = gpu.compile(wgsl, "main")?;
        let mut pipelines = lock();
        pipelines.push_back((wgsl.to_owned(), pipeline.clone()));
        if pipelines.len() > KEPT {
            pipelines.pop_front();
        }
        Ok(pipeline)
    }
}

/// The scene's buffers among the bindings that these features ask for.
fn upload<F: Format>(
    gpu: &Gpu,
    packed: &Packed<F>,
    features: &Features,
) -> Result<Vec<(u32, wgpu::Buffer)>, GpuError> {
    let mut buffers = Vec::new();
    for binding in Binding::<F>::ALL
        .iter()
        .filter(|binding| (binding.holds)(features))
    {
        if let Some(contents) = binding.contents {
            let contents = contents(packed);
            let buffer = buffer(gpu, binding.what, &contents.bytes())?;
            buffers.push((binding.number, buffer));
        }
    }
    gpu.check()?;
    Ok(buffers)
}

fn buffer(gpu: &Gpu, what: &'static str, contents: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    let limits = gpu.device.limits();
    let allowed = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let needed = contents.len() as u64;
    if needed > allowed {
        return Err(GpuError::TooLarge {
            what,
            needed,
            allowed,
            adapter: gpu.name.clone(),
        });
    }
    Ok(gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(what),
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        }))
}

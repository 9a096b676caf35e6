//! A single pixel as the GPU has it before it is quantised, with its error bounds: for `probe`.
//!
//! Every function of the shader is the one that renders the picture; only the entry point is another one.

use bytemuck::Zeroable as _;

use super::GpuError;
use super::device::Gpu;
use super::pipeline::Pipeline;
use crate::settings::Settings;
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::pack::Packed;
use crate::shader::records::Dispatch;

/// 255 times a pixel's value on the GPU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Single {
    /// Red, green, blue.
    pub value: [f32; 3],
    /// How far off they may be.
    pub error: [f32; 3],
}

/// The shader of a certified picture, a ray a pixel, with the other entry point; none where there is nothing to hit.
pub fn wgsl(packed: &Packed, features: &FeatureSet) -> Option<String> {
    features
        .any_object()
        .then(|| compose(packed, features, Entry::Pixel))
}

/// What shaders are composed from for it: certified, four words a pixel.
pub fn features(packed: &Packed, settings: &Settings, lanes: u32) -> FeatureSet {
    FeatureSet {
        values: true,
        quad: false,
        ..FeatureSet::new(packed, settings, lanes)
    }
}

/// The shader of single pixels, compiled for a scene and bound to it.
#[derive(Debug)]
pub struct SinglePipeline {
    pipeline: Pipeline,
    dispatch: wgpu::Buffer,
    pixel: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl SinglePipeline {
    /// For pixels of a certified picture, a ray a pixel; none where there is nothing to hit.
    ///
    /// # Errors
    /// As any rendering on the GPU.
    pub fn new(gpu: &Gpu, packed: &Packed, settings: &Settings) -> Result<Option<Self>, GpuError> {
        let features = features(packed, settings, gpu.lanes);
        let Some(wgsl) = wgsl(packed, &features) else {
            return Ok(None);
        };
        let pipeline = Pipeline::new(gpu, packed, &features, &wgsl)?;
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let dispatch = buffer("dispatch", size_of::<Dispatch>() as u64, uniform);
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let pixel = buffer("pixel", 32, storage);
        let group = pipeline.bind(gpu, &dispatch, &pixel, None);
        gpu.check()?;
        Ok(Some(Self {
            pipeline,
            dispatch,
            pixel,
            group,
        }))
    }

    /// Pixel (x, y), counted from the bottom left; None where the GPU leaves it to the CPU before it has a value.
    /// `gpu` is the device that it was compiled for.
    ///
    /// # Errors
    /// As any rendering on the GPU.
    pub fn run(&self, gpu: &Gpu, at: [u32; 2]) -> Result<Option<Single>, GpuError> {
        let dispatch = Dispatch {
            first: at,
            size: [1, 1],
            ..Dispatch::zeroed()
        };
        gpu.queue
            .write_buffer(&self.dispatch, 0, bytemuck::bytes_of(&dispatch));
        let left = gpu.run_once(&self.pipeline.pipeline, &self.group, [1, 1], &self.pixel)?;
        let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&left);
        let three = |word: &[u32; 4]| [word[0], word[1], word[2]].map(f32::from_bits);
        let [value, error] = [0, 1].map(|i| words.get(i).map(three));
        // A pixel that is given up has no error bounds.
        let known = |error: &[f32; 3]| error.iter().any(|e| *e > 0.0);
        Ok(value
            .zip(error.filter(known))
            .map(|(value, error)| Single { value, error }))
    }
}

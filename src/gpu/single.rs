//! A single pixel as the GPU has it before it is quantised, with its error bounds: for `plumb probe`.
//!
//! Every function of the shader is the one that renders the picture; only the entry point is another one.

use bytemuck::Zeroable as _;
use wgpu::util::DeviceExt as _;

use super::GpuError;
use super::compose::compose;
use super::device::Gpu;
use super::features::FeatureSet;
use super::pack::{Job, Packed};
use super::pipeline::Pipeline;
use crate::settings::Settings;

const SINGLE: &str = include_str!("single.wgsl");

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
    let wgsl = features.any_object().then(|| compose(packed, features))?;
    let before = wgsl.split("@compute").next().unwrap_or_default();
    Some([before, SINGLE].concat())
}

/// What shaders are composed from for it: certified, four words a pixel.
pub fn features(packed: &Packed, settings: &Settings, lanes: u32) -> FeatureSet {
    FeatureSet {
        values: true,
        quad: false,
        ..FeatureSet::new(packed, settings, lanes)
    }
}

/// Pixel (x, y) of a certified picture, a ray a pixel; None where the GPU leaves it to the CPU before it has a value.
///
/// # Errors
/// As any rendering on the GPU.
pub fn single(
    gpu: &Gpu,
    packed: &Packed,
    settings: &Settings,
    at: [u32; 2],
) -> Result<Option<Single>, GpuError> {
    let features = features(packed, settings, gpu.lanes);
    let Some(wgsl) = wgsl(packed, &features) else {
        return Ok(None);
    };
    let pipeline = Pipeline::new(gpu, packed, &features, &wgsl)?;
    let job = Job {
        first: at,
        size: [1, 1],
        ..Job::zeroed()
    };
    let job = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("job"),
            contents: bytemuck::bytes_of(&job),
            usage: wgpu::BufferUsages::UNIFORM,
        });
    let pixels = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixel"),
        size: 32,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = pipeline.bind(gpu, &job, &pixels, None);
    let left = gpu.run_once(&pipeline.pipeline, &group, [1, 1], &pixels)?;
    let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&left);
    let three = |word: &[u32; 4]| [word[0], word[1], word[2]].map(f32::from_bits);
    let [value, error] = [0, 1].map(|i| words.get(i).map(three));
    // A pixel that is given up has no error bounds.
    let known = |error: &[f32; 3]| error.iter().any(|e| *e > 0.0);
    Ok(value
        .zip(error.filter(known))
        .map(|(value, error)| Single { value, error }))
}

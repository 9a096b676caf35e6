//! A picture of the self-test: a small scene through the shader that real scenes get, against the referee.
//!
//! Single operations may be right where a compiler sees them by themselves, and wrong where it puts a whole shader
//! together. So the primary ray, forms of planes and spheres, their bounds, tiles behind a barrier and the bytes are
//! tried as they are composed for a picture.

use std::path::Path;

use super::Outcome;
use crate::cpu::pixel::ExactTracer;
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::{Pipeline, SceneBuffers};
use crate::jitter::Sampling;
use crate::scene::{Scene, load_from};
use crate::settings::Settings;
use crate::shader::compose::{Entry, compose};
use crate::shader::constants::WORKGROUP;
use crate::shader::feature_set::FeatureSet;
use crate::shader::pack::Packed;
use crate::shader::records::Dispatch;

/// A tiled floor and a ball before it, whose borders cross the picture.
pub(super) const SCENE: &str = "
    camera eye { pixeldim 32 16 worlddim 8 4 viewpoint 3.7 1.9 6.3 }
    material plain { ambient 9.1 6.3 2.9 }
    material other { ambient 1.7 4.9 8.3 }
    tiled_plane floor { material plain normal 0.1 1 0.05 point 0 -0.7 0 altmaterial other dimension 1.3 1.7 }
    sphere ball { material plain center 5.1 1.7 -2.3 radius 1.3 }";

/// Its entry point: that of a picture makes several pixels at once, which takes several times as long to compile.
const ENTRY: &str = "
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn selftest(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(i32(id.x), i32(dispatch.first.y) - i32(id.y));
    pixels[id.y * dispatch.size.x + id.x] = vec4u(make_pixel(pixel));
}
";

/// So many of the pixels have to be sure, of a hundred: a shader that is sure of nothing proves nothing.
const SURE: usize = 90;

/// What a picture has to be, and the device's pixels as the shader writes them.
pub(super) struct Tried {
    pub(super) right: Vec<[u8; 3]>,
    pub(super) found: Vec<[u8; 4]>,
}

/// Whether the pixels that are sure are right.
pub(super) fn judge(tried: &Tried) -> Outcome {
    let Tried { right, found } = tried;
    let sure = |pixel: &&[u8; 4]| pixel[3] == 0;
    let count = found.iter().filter(sure).count();
    let wrong = right
        .iter()
        .zip(found)
        .position(|(right, found)| found[3] == 0 && found[..3] != *right);
    let failure = match wrong {
        _ if found.len() != right.len() => Some("results are missing".to_owned()),
        Some(place) => Some(format!(
            "pixel {place} gave {:?} for {:?}",
            &found[place][..3],
            right[place]
        )),
        None if 100 * count < SURE * right.len() => Some(format!("only {count} pixels are sure")),
        None => None,
    };
    Outcome {
        check: "a composed picture",
        asked: "pixels that are sure have the exact bytes, and nine in ten are sure",
        cases: count,
        failure,
    }
}

/// Renders the scene on the device and on the CPU.
pub(super) fn run(gpu: &Gpu) -> Result<Tried, GpuError> {
    let Ok(scene) = load_from("self-test", SCENE.as_bytes(), Path::new(".")) else {
        // A test reads it.
        return Ok(Tried {
            right: vec![[0; 3]],
            found: Vec::new(),
        });
    };
    let settings = Settings::default();
    Ok(Tried {
        found: on_device(gpu, &scene, &settings)?,
        right: referee(&scene, &settings),
    })
}

/// The exact bytes, from the top row on.
fn referee(scene: &Scene, settings: &Settings) -> Vec<[u8; 3]> {
    let tracer = ExactTracer::new(scene, settings.view());
    let limits = settings.sample_limits();
    let [width, height] = scene.camera.pixeldim;
    let places = (0..height)
        .rev()
        .flat_map(|y| (0..width).map(move |x| [x, y]));
    let bytes = places.map(|[x, y]| {
        let decided = tracer.trace(&limits, Sampling::Once, x, y);
        decided.map_or([0; 3], |decided| decided.bytes)
    });
    bytes.collect()
}

fn on_device(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Vec<[u8; 4]>, GpuError> {
    use wgpu::util::DeviceExt as _;
    let packed = Packed::new(scene, settings);
    let features = FeatureSet::new(&packed, settings, gpu.lanes);
    let wgsl = compose(&packed, &features, Entry::Picture) + ENTRY;
    let buffers = SceneBuffers::new(gpu, &packed, &features)?;
    let compiled = gpu.compile(&wgsl, "selftest")?;
    let pipeline = Pipeline::of(compiled, buffers, &packed, &features);
    let [width, height] = scene.camera.pixeldim;
    let dispatch = Dispatch {
        first: [0, height - 1],
        size: [width, height],
        zero: 0,
        room: 0,
    };
    let dispatch = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("self-test"),
            contents: bytemuck::bytes_of(&dispatch),
            usage: wgpu::BufferUsages::UNIFORM,
        });
    let pixels = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("self-test"),
        size: u64::from(width) * u64::from(height) * 16,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = pipeline.bind(gpu, &dispatch, &pixels, None);
    let groups = [width, height].map(|n| n.div_ceil(WORKGROUP));
    let bytes = gpu.run_once(&pipeline.pipeline, &group, groups, &pixels)?;
    Ok(bytes
        .as_chunks::<4>()
        .0
        .iter()
        .step_by(4)
        .copied()
        .collect())
}

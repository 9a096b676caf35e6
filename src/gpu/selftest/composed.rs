//! Pictures of the self-tests: a small scene through the shader that real scenes get, against the referee.
//!
//! Single operations may be right where a compiler sees them by themselves, and wrong where it puts a whole shader
//! together. So the primary ray, forms of planes and spheres, their bounds, tiles behind a barrier and the bytes are
//! tried as they are composed for a picture; in f64, which is asked for lit scenes above all, also directions, powers
//! and shadows.

use std::path::Path;

use bytemuck::Zeroable as _;

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
use crate::shader::format::Format;
use crate::shader::pack::Packed;
use crate::shader::records::Dispatch;

/// A tiled floor and a ball before it, whose borders cross the picture.
pub(super) const SCENE: &str = "
    camera eye { pixeldim 32 16 worlddim 8 4 viewpoint 3.7 1.9 6.3 }
    material plain { ambient 9.1 6.3 2.9 }
    material other { ambient 1.7 4.9 8.3 }
    tiled_plane floor { material plain normal 0.1 1 0.05 point 0 -0.7 0 altmaterial other dimension 1.3 1.7 }
    sphere ball { material plain center 5.1 1.7 -2.3 radius 1.3 }";

/// The same under a lamp, whose light glints on the ball.
pub(super) const LIT_SCENE: &str = "
    camera eye { pixeldim 32 16 worlddim 8 4 viewpoint 3.7 1.9 6.3 }
    material plain { ambient 2.1 1.3 0.9 diffuse 3.1 4.3 2.7 }
    material other { ambient 1.7 0.9 2.3 diffuse 1.9 5.3 4.1 }
    material shiny { ambient 0.9 1.1 0.7 diffuse 2.9 3.7 5.9 specular 0.6 shininess 6.5 }
    tiled_plane floor { material plain normal 0.1 1 0.05 point 0 -0.7 0 altmaterial other dimension 1.3 1.7 }
    sphere ball { material shiny center 5.1 1.7 -2.3 radius 1.3 }
    light lamp { location 2.3 5.9 1.1 emissivity 3.1 2.7 2.3 }";

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

/// Renders a scene on the device and on the CPU.
pub(super) fn run(gpu: &Gpu) -> Result<Tried, GpuError> {
    try_scene(SCENE, |scene, settings| {
        let packed = Packed::new(scene, settings);
        let features = FeatureSet::new(&packed, settings, gpu.lanes);
        on_device(gpu, scene, &packed, &features)
    })
}

/// The same in f64.
pub(super) fn run_double(gpu: &Gpu) -> Result<Tried, GpuError> {
    try_scene(LIT_SCENE, |scene, settings| {
        let features = FeatureSet::new(&Packed::new(scene, settings), settings, gpu.lanes);
        let packed = Packed::in_f64(scene, settings);
        on_device(gpu, scene, &packed, &features.for_the_list())
    })
}

/// A scene's pixels as a device gives them, and as the referee has them.
fn try_scene(
    text: &str,
    on_device: impl FnOnce(&Scene, &Settings) -> Result<Vec<[u8; 4]>, GpuError>,
) -> Result<Tried, GpuError> {
    let Ok(scene) = load_from("self-test", text.as_bytes(), Path::new(".")) else {
        // A test reads it.
        return Ok(Tried {
            right: vec![[0; 3]],
            found: Vec::new(),
        });
    };
    let settings = Settings::default();
    Ok(Tried {
        found: on_device(&scene, &settings)?,
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

/// The scene's pixels, as the device makes them of what is packed.
fn on_device<F: Format>(
    gpu: &Gpu,
    scene: &Scene,
    packed: &Packed<F>,
    features: &FeatureSet,
) -> Result<Vec<[u8; 4]>, GpuError> {
    use wgpu::util::DeviceExt as _;
    // Then there is a function that makes one pixel.
    let features = &FeatureSet {
        quad: true,
        ..features.clone()
    };
    let wgsl = compose(packed, features, Entry::Picture) + ENTRY;
    let buffers = SceneBuffers::new(gpu, packed, features)?;
    let compiled = gpu.compile(&wgsl, "selftest")?;
    let pipeline = Pipeline::of(compiled, buffers, packed, features);
    let [width, height] = scene.camera.pixeldim;
    let dispatch = Dispatch {
        first: [0, height - 1],
        size: [width, height],
        ..Dispatch::zeroed()
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

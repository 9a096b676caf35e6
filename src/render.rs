//! One picture, band after band: chooses the tracer (GPU or CPU), runs it over the rows, hands each finished band on.
//!
//! Stands between the tracers (`gpu`, `cpu`) and what takes the rows (`image`, the preview, a test).

use std::io;
use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use crate::cpu::camera::camera_setpix;
use crate::cpu::trace::ray_trace;
use crate::gpu::bands::BandError;
use crate::gpu::compose::compose;
use crate::gpu::device::Gpu;
use crate::gpu::features::FeatureSet;
use crate::gpu::pack::Packed;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::{self, GpuError};
use crate::prepare::Prepared;
use crate::scene::{self, Scene, Shape};

/// What to render, beyond what the scene says.
#[derive(Debug, Clone)]
pub struct Settings {
    /// The rows to render, half-open, counted from the bottom; all without.
    pub rows: Option<Range<u32>>,
    /// τ: a hit on a plane counts only where its z is ≤ this; 0 in the notes.
    pub screen_tolerance: f64,
    /// Which tracer.
    pub backend: Backend,
    /// Part of the name of the adapter to use, in any case of letters.
    pub adapter: Option<String>,
    /// CPU threads; all cores without.
    pub threads: Option<usize>,
    /// Whether bands carry the unquantised values too (for EXR).
    pub values: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { rows: None, screen_tolerance: 0.0, backend: Backend::Auto, adapter: None, threads: None, values: false }
    }
}

/// Which tracer renders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU if there is one, else the CPU.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The CPU.
    Cpu,
}

/// Finished rows, on their way into a picture. Bands come from the top of the picture downwards, without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Which rows, counted from the bottom.
    pub rows: Range<u32>,
    /// Red, green, blue of every pixel, the band's top row first: 3 · width · rows bytes.
    pub rgb: Vec<u8>,
    /// The values before quantising (1.0 is byte 255), in the same order, if they were asked for.
    pub values: Option<Vec<[f32; 3]>>,
}

/// Takes finished bands; an error ends the rendering.
pub type Emit<'a> = dyn FnMut(&Band) -> io::Result<()> + Send + 'a;

/// How a rendering went: what `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The rows rendered, from the bottom, half-open.
    pub rows: [u32; 2],
    /// The screen tolerance τ.
    pub screen_tolerance: f64,
    /// Which tracer rendered: `gpu` or `cpu`.
    pub backend: Backend,
    /// Adapter and driver, if the GPU rendered.
    pub adapter: Option<String>,
    /// Why the CPU rendered although the GPU was welcome.
    pub fallback: Option<String>,
    /// CPU threads used, if the CPU rendered.
    pub threads: Option<usize>,
    /// Pixels that the GPU handed to the CPU.
    pub refined: u64,
    /// Number of bands.
    pub bands: u32,
    /// Where the time went.
    pub seconds: Seconds,
}

/// Where the time of a rendering went, in seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// Loading the driver and listing adapters.
    pub instance: f64,
    /// Opening the device.
    pub device: f64,
    /// Composing and compiling the shader.
    pub compile: f64,
    /// Packing and uploading the scene.
    pub upload: f64,
    /// Kernel time: from timestamps on the GPU where it has them, else as seen from the host.
    pub kernel: f64,
    /// Copying pictures back and waiting for them, the kernel's own time apart.
    pub readback: f64,
    /// Handing bands on: quantising, encoding, writing.
    pub emit: f64,
    /// All of the above and what lies between.
    pub total: f64,
}

/// Why a rendering failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene uses what plumb reads but does not render yet.
    #[error("not rendered yet: {0}")]
    NotYet(String),
    /// The rows asked for are not of the picture.
    #[error("rows {start}..{end} are not rows of a picture {height} high: rows count from 0 at the bottom, the end not included")]
    Rows {
        /// First row.
        start: u32,
        /// Row after the last.
        end: u32,
        /// Rows of the picture.
        height: u32,
    },
    /// The GPU's fault.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The thread pool would not start.
    #[error("the CPU threads cannot be started: {0}")]
    Threads(String),
    /// What takes the bands said no.
    #[error(transparent)]
    Emit(#[from] io::Error),
}

impl From<BandError> for Error {
    fn from(error: BandError) -> Self {
        match error {
            BandError::Gpu(error) => Self::Gpu(error),
            BandError::Emit(error) => Self::Emit(error),
        }
    }
}

/// What to install where there is no adapter.
pub fn install_hint() -> &'static str {
    if cfg!(target_os = "linux") {
        "install your GPU's Vulkan driver, or the software one (Debian and Ubuntu: apt install mesa-vulkan-drivers)"
    } else if cfg!(windows) {
        "install your GPU's driver; plumb needs Direct3D 12"
    } else {
        "plumb needs Metal, or a Vulkan driver"
    }
}

/// Renders `scene` and hands each finished band to `emit`, from the top of the picture down.
pub fn render(scene: &Scene, settings: &Settings, emit: &mut Emit<'_>) -> Result<Report, Error> {
    let start = Instant::now();
    if let Some(what) = not_yet(scene) {
        return Err(Error::NotYet(what));
    }
    let [width, height] = scene.camera.pixeldim;
    let rows = settings.rows.clone().unwrap_or(0..height);
    if rows.is_empty() || rows.end > height {
        return Err(Error::Rows { start: rows.start, end: rows.end, height });
    }
    let mut report = Report {
        width,
        height,
        rows: [rows.start, rows.end],
        screen_tolerance: settings.screen_tolerance,
        backend: Backend::Cpu,
        adapter: None,
        fallback: None,
        threads: None,
        refined: 0,
        bands: 0,
        seconds: Seconds::default(),
    };
    let gpu = match settings.backend {
        Backend::Cpu => None,
        Backend::Gpu => Some(gpu::device::open(settings.adapter.as_deref())?),
        Backend::Auto => match gpu::device::open(settings.adapter.as_deref()) {
            Ok(gpu) => Some(gpu),
            // Without any GPU the CPU gives the same picture; a GPU that was named has to be there.
            Err(error @ (GpuError::NoAdapter | GpuError::Device { .. })) => {
                report.fallback = Some(format!("{error}, so the CPU renders; {}", install_hint()));
                None
            }
            Err(error) => return Err(error.into()),
        },
    };
    let prepared = Prepared::new(scene, settings.screen_tolerance);
    match gpu {
        Some(gpu) => render_gpu(&gpu, &prepared, width, rows, settings, emit, &mut report)?,
        None => render_cpu(&prepared, width, rows, settings, emit, &mut report)?,
    }
    report.seconds.total = start.elapsed().as_secs_f64();
    Ok(report)
}

fn render_gpu(
    gpu: &Gpu,
    prepared: &Prepared<f64>,
    width: u32,
    rows: Range<u32>,
    settings: &Settings,
    emit: &mut Emit<'_>,
    report: &mut Report,
) -> Result<(), Error> {
    let start = Instant::now();
    let packed = Packed::new(prepared);
    let (found, allowed) = (packed.loop_iterations(), gpu::compose::LOOP_ITERATIONS);
    if found > allowed {
        return Err(GpuError::TooMany { found, allowed }.into());
    }
    let features = FeatureSet::new(&packed, settings.values);
    let wgsl = compose(&packed, &features);
    let packing = start.elapsed().as_secs_f64();
    let refine = |x: u32, y: u32| trace_pixel(prepared, f64::from(x), f64::from(y));
    let pipeline = Pipeline::new(gpu, &packed, &features, &wgsl)?;
    let times = gpu::bands::run(gpu, &pipeline, width, rows, packed.tests(), &refine, emit)?;
    report.refined = times.refined;
    report.backend = Backend::Gpu;
    report.adapter = Some(gpu.name.clone());
    report.bands = times.bands;
    let [instance, device] = gpu.seconds;
    let [compile, upload] = pipeline.seconds;
    report.seconds = Seconds {
        instance,
        device,
        compile,
        upload: packing + upload,
        kernel: times.kernel,
        readback: times.readback,
        emit: times.emit,
        total: 0.0,
    };
    Ok(())
}

fn render_cpu(
    prepared: &Prepared<f64>,
    width: u32,
    rows: Range<u32>,
    settings: &Settings,
    emit: &mut Emit<'_>,
    report: &mut Report,
) -> Result<(), Error> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(settings.threads.unwrap_or(0))
        .build()
        .map_err(|error| Error::Threads(error.to_string()))?;
    report.threads = Some(pool.current_num_threads());
    let tests = prepared.planes.len()
        + prepared.bvh.as_ref().map_or(prepared.spheres.len(), |bvh| prepared.spheres.len() - bvh.len + 8 * bvh.depth);
    let mut end = rows.end;
    while end > rows.start {
        let kernel = Instant::now();
        let height = cpu_band_rows(width, tests).min(end - rows.start);
        let band = pool.install(|| cpu_band(prepared, width, end - height..end, settings.values));
        report.seconds.kernel += kernel.elapsed().as_secs_f64();
        let emitting = Instant::now();
        emit(&band)?;
        report.seconds.emit += emitting.elapsed().as_secs_f64();
        report.bands += 1;
        end -= height;
    }
    Ok(())
}

/// Rows of a band on the CPU: about a megapixel, fewer where a pixel is slow, so that progress shows.
fn cpu_band_rows(width: u32, tests: usize) -> u32 {
    let pixels = (1 << 26) / (tests as u64 + 64);
    (pixels / u64::from(width)).clamp(1, 1 << 20) as u32
}

/// Traces a band on the CPU, pixels in parallel.
fn cpu_band(prepared: &Prepared<f64>, width: u32, rows: Range<u32>, values: bool) -> Band {
    let width = width as usize;
    let pixels = width * (rows.end - rows.start) as usize;
    let mut rgb = vec![0; 3 * pixels];
    let mut floats = if values { vec![[0.0; 3]; pixels] } else { Vec::new() };
    // Pieces small enough to share out, large enough not to cost.
    let piece = (pixels / (8 * rayon::current_num_threads())).clamp(64, 8192);
    let trace = |i: usize| {
        let (x, y) = (i % width, rows.end as usize - 1 - i / width);
        trace_pixel(prepared, x as f64, y as f64)
    };
    rgb.par_chunks_mut(3 * piece).enumerate().for_each(|(k, chunk)| {
        for (i, pixel) in chunk.chunks_exact_mut(3).enumerate() {
            pixel.copy_from_slice(&trace(k * piece + i).1);
        }
    });
    floats.par_chunks_mut(piece).enumerate().for_each(|(k, chunk)| {
        for (i, pixel) in chunk.iter_mut().enumerate() {
            *pixel = trace(k * piece + i).0;
        }
    });
    Band { rows, rgb, values: values.then_some(floats) }
}

/// Value and bytes of a pixel in f64, which decides every comparison (NaN apart, which no scene within its limits makes:
/// such a pixel stays black).
fn trace_pixel(prepared: &Prepared<f64>, x: f64, y: f64) -> ([f32; 3], [u8; 3]) {
    let Ok(traced) = ray_trace(prepared, x, y) else { return ([0.0; 3], [0; 3]) };
    let color = traced.color;
    ([color.x as f32, color.y as f32, color.z as f32], camera_setpix(color).unwrap_or_default())
}

/// What of the scene is read and checked, but not rendered yet.
pub fn not_yet(scene: &Scene) -> Option<String> {
    let mut what = Vec::new();
    for light in &scene.lights {
        what.push(format!("{} `{}`", light.entity(), light.name));
    }
    for object in &scene.objects {
        let waits = match (&object.shape, object.surface) {
            (Shape::Plane { extent: Some(_), .. }, _) => true,
            (_, scene::Surface::Tiled { xdir, .. }) => xdir.is_some(),
            (_, scene::Surface::Textured { .. }) => true,
            _ => false,
        };
        if waits {
            let xdir = if object.entity() == "tiled_plane" { " with xdir" } else { "" };
            what.push(format!("{} `{}`{xdir}", object.entity(), object.name));
        }
    }
    let more = what.len().saturating_sub(5);
    what.truncate(5);
    (!what.is_empty()).then(|| what.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() })
}

//! One picture, band after band: chooses the tracer (GPU or CPU), runs it over the rows, hands each finished band on.
//!
//! Stands between the tracers (`gpu`, `cpu`) and what takes the rows (`image`, the preview, a test).

mod job;

use std::io;
use std::time::Instant;

use serde::Serialize;

use crate::gpu::bands::BandError;
use crate::gpu::{self, GpuError};
use crate::prepare::View;
use crate::scene::Scene;
use job::Job;

pub use crate::frame::{Band, Emit, PixelFault};
pub use crate::settings::{Backend, Settings, Spread};

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
    /// Rays a pixel.
    pub samples: u32,
    /// How several samples were spread.
    pub jitter: Option<Spread>,
    /// The longest path, in world units, if there were lights to make paths.
    pub max_path: Option<f64>,
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
    /// The rows asked for are not of the picture.
    #[error(
        "rows {start}..{end} are not rows of a picture {height} high: rows count from 0 at the bottom, the end not included"
    )]
    Rows {
        /// First row.
        start: u32,
        /// Row after the last.
        end: u32,
        /// Rows of the picture.
        height: u32,
    },
    /// A sample needs more rays than allowed.
    #[error(transparent)]
    TooManyRays(#[from] PixelFault),
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
            BandError::Pixel(error) => Self::TooManyRays(error),
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
    let [width, height] = scene.camera.pixeldim;
    let rows = settings.rows.clone().unwrap_or(0..height);
    if rows.is_empty() || rows.end > height {
        return Err(Error::Rows {
            start: rows.start,
            end: rows.end,
            height,
        });
    }
    let mut report = Report {
        width,
        height,
        rows: [rows.start, rows.end],
        screen_tolerance: settings.screen_tolerance,
        samples: settings.samples,
        jitter: (settings.samples > 1).then_some(settings.jitter),
        max_path: (!scene.lights.is_empty()).then_some(settings.limits.max_path),
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
    let job = Job {
        scene,
        view: View::new(settings.screen_tolerance, settings.samples),
        jitter: settings.sampling(width, rows.end),
        limits: settings.sample_limits(),
        width,
        rows,
        settings,
    };
    let done = match gpu {
        Some(gpu) => job.on_gpu(&gpu, emit, &mut report),
        None => job.on_cpu(emit, &mut report),
    };
    match done {
        // Found before the first band, so nothing is rendered twice.
        Err(Error::Gpu(error @ (GpuError::TooMany { .. } | GpuError::TooLarge { .. })))
            if settings.backend == Backend::Auto =>
        {
            report.fallback = Some(format!("{error}, so the CPU renders"));
            job.on_cpu(emit, &mut report)?;
        }
        done => done?,
    }
    report.seconds.total = start.elapsed().as_secs_f64();
    Ok(report)
}

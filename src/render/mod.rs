//! One picture, band after band: chooses the tracer (GPU or CPU), runs it over the rows, hands each finished band on.
//!
//! Stands between the tracers (`gpu`, `cpu`) and what takes the rows (`image`, the preview, a test).

mod finish;
mod job;
#[cfg(test)]
mod tests;

use std::io;
use std::time::Instant;

use serde::Serialize;

use crate::certify::pixels::Tracer;
use crate::certify::{Stage, StageSeconds, Tally, trust};
use crate::gpu::bands::DISPATCH_SECONDS;
use crate::gpu::canvas::Canvas;
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::Compiled;
use crate::gpu::{GpuError, adapters};
use crate::scene::Scene;
use job::Job;

use crate::frame::Halt;
pub use crate::frame::{Band, Emit, PixelFault, Stop};
pub use crate::settings::{Backend, Precision, Settings, Spread};

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
    /// What was asked of the bytes.
    pub precision: Precision,
    /// Which tracer rendered: `gpu` or `cpu`.
    pub backend: Backend,
    /// Adapter and driver, if the GPU rendered.
    pub adapter: Option<String>,
    /// Why the CPU rendered although the GPU was welcome.
    pub fallback: Option<String>,
    /// Why the CPU rendered the frame once more after the GPU: a pixel that the GPU was sure of, and got wrong.
    pub revoked: Option<String>,
    /// CPU threads that were there to be used.
    pub threads: Option<usize>,
    /// Pixels rendered.
    pub pixels: u64,
    /// Pixels that the GPU handed to the CPU, because it was in doubt or had no room.
    pub refined: u64,
    /// The same, in hundredths of all pixels.
    pub refined_percent: f64,
    /// Samples that the CPU traced for them: of a pixel of which the GPU is sure of some only the others, if that was enough.
    pub refined_samples: u64,
    /// The same, in hundredths of all samples.
    pub refined_samples_percent: f64,
    /// How many pixels each stage decided.
    pub decided: Tally,
    /// Pixels proven to lie on a border exactly.
    pub ties: u64,
    /// Pixels so near a border that they are presumed to lie on it.
    pub presumed: u64,
    /// Column and row (from the bottom) of the first of them.
    pub presumed_at: Vec<[u32; 2]>,
    /// Pixels that the GPU was sure of, computed again on the CPU and found right.
    pub spot_checks: u64,
    /// Number of bands.
    pub bands: u32,
    /// Where the time went.
    pub seconds: Seconds,
}

impl Report {
    /// Of a rendering that is about to begin.
    fn new(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        if rows.is_empty() || rows.end > height {
            return Err(Error::Rows {
                start: rows.start,
                end: rows.end,
                height,
            });
        }
        Ok(Self {
            width,
            height,
            rows: [rows.start, rows.end],
            screen_tolerance: settings.screen_tolerance,
            samples: settings.samples,
            jitter: settings.supersampling().map(|several| several.spread),
            max_path: (!scene.lights.is_empty()).then_some(settings.limits.max_path),
            precision: settings.precision,
            backend: Backend::Cpu,
            adapter: None,
            fallback: None,
            revoked: None,
            threads: None,
            pixels: 0,
            refined: 0,
            refined_percent: 0.0,
            refined_samples: 0,
            refined_samples_percent: 0.0,
            decided: Tally::default(),
            ties: 0,
            presumed: 0,
            presumed_at: Vec::new(),
            spot_checks: 0,
            bands: 0,
            seconds: Seconds::default(),
        })
    }

    /// Takes over what decided the pixels.
    fn count(&mut self, tally: &Tally) {
        self.pixels = tally.pixels();
        self.refined = if self.backend == Backend::Gpu {
            self.pixels - tally.count(Stage::Gpu)
        } else {
            0
        };
        self.refined_percent = 100.0 * self.refined as f64 / self.pixels.max(1) as f64;
        self.refined_samples = if self.backend == Backend::Gpu {
            tally.samples()
        } else {
            0
        };
        let samples = (self.pixels * u64::from(self.samples)).max(1);
        self.refined_samples_percent = 100.0 * self.refined_samples as f64 / samples as f64;
        self.ties = tally.count(Stage::Exact);
        self.presumed = tally.count(Stage::Presumed);
        self.presumed_at = tally.presumed_at().to_vec();
        self.seconds.stages = tally.times();
        self.decided = tally.clone();
    }
}

/// Where the time of a rendering went, in seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// Loading the driver and listing adapters.
    pub instance: f64,
    /// Opening the device.
    pub device: f64,
    /// Finding out whether the device can be trusted: the self-test, or looking up that it was passed.
    pub selftest: f64,
    /// Composing and compiling the shader.
    pub compile: f64,
    /// Packing and uploading the scene.
    pub upload: f64,
    /// Kernel time: from timestamps on the GPU where it has them, else as seen from the host.
    pub kernel: f64,
    /// Copying pictures back and waiting for them, the kernel's own time apart.
    pub readback: f64,
    /// Deciding what the GPU left undecided, while it renders the next bands.
    pub refine: f64,
    /// Computing again some of what it was sure of, likewise.
    pub spot_checks: f64,
    /// Handing bands on: quantising, encoding, writing; likewise.
    pub emit: f64,
    /// That the GPU's side waited for these three.
    pub held: f64,
    /// CPU time for pixels decided one by one, of all threads together, by the stage that decided them.
    pub stages: StageSeconds,
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
    /// Certified values, from the GPU and nothing else.
    #[error(
        "certified values (EXR) are computed on the CPU, all of them: leave out --backend gpu, or take the GPU's own f32 with --precision fast"
    )]
    Values,
    /// A sample needs more rays than allowed.
    #[error(transparent)]
    TooManyRays(#[from] PixelFault),
    /// The GPU's fault.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The thread pool would not start.
    #[error("the CPU threads cannot be started: {0}")]
    Threads(String),
    /// The GPU was sure of a pixel and wrong, and so are rows that were handed on before that was found.
    #[error("{0}; rows that were handed on before are wrong too")]
    Revoked(String),
    /// [`Live::stop`] said that nobody wants the picture any more.
    #[error("the rendering was given up")]
    Stopped,
    /// What takes the bands said no.
    #[error(transparent)]
    Emit(#[from] io::Error),
}

impl From<Halt> for Error {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::TooManyRays(fault) => fault.into(),
            Halt::Stopped => Self::Stopped,
        }
    }
}

/// What a picture is rendered with by whoever renders many: a device that is open, and a say in whether it goes on.
pub struct Live<'a> {
    /// The device; `Settings::adapter` means nothing then.
    pub gpu: &'a Gpu,
    /// Where the picture is shown, on the GPU: all pixels that the GPU makes are copied there.
    pub canvas: Option<&'a Canvas>,
    /// Shaders that were compiled for pictures before: those of fast ones are made such that a picture from another viewpoint
    /// finds its own there.
    pub compiled: Option<&'a Compiled>,
    /// About how many seconds a dispatch is to take: whatever else wants the device has to wait for so long.
    pub dispatch_seconds: f64,
    /// Whether nobody wants the picture any more; asked every few thousand pixels.
    pub stop: &'a Stop<'a>,
}

impl<'a> Live<'a> {
    /// On this device, and to its end.
    pub fn on(gpu: &'a Gpu) -> Self {
        Self {
            gpu,
            canvas: None,
            compiled: None,
            dispatch_seconds: DISPATCH_SECONDS,
            stop: &|| false,
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

/// Renders `scene` and hands each finished band to `emit`, from the top of the picture down. `emit` may be called on another
/// thread: one band is finished while the next one is rendered.
///
/// # Errors
/// Any [`Error`]. After [`Error::Revoked`] alone what was handed on is wrong, and the CPU will do better.
pub fn render(scene: &Scene, settings: &Settings, emit: &mut Emit<'_>) -> Result<Report, Error> {
    let start = Instant::now();
    let mut report = Report::new(scene, settings)?;
    let opened = if wants_gpu(settings, &mut report)? {
        let adapter = adapters::find(settings.adapter.as_deref());
        report.seconds.instance = start.elapsed().as_secs_f64();
        let device = Instant::now();
        let opened = adapter.and_then(|adapter| Gpu::open(&adapter));
        report.seconds.device = device.elapsed().as_secs_f64();
        trusted(opened, |gpu| gpu, settings, &mut report)?
    } else {
        None
    };
    let live = opened.as_ref().map(Live::on);
    run(scene, settings, live.as_ref(), &|| false, emit, &mut report)?;
    report.seconds.total = start.elapsed().as_secs_f64();
    Ok(report)
}

/// The same on a device that is open already, for whoever renders many pictures.
///
/// # Errors
/// As [`render`]; and [`Error::Stopped`].
pub fn render_live(
    scene: &Scene,
    settings: &Settings,
    live: &Live<'_>,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    let start = Instant::now();
    let mut report = Report::new(scene, settings)?;
    let gpu = if wants_gpu(settings, &mut report)? {
        trusted(Ok(live), |live| live.gpu, settings, &mut report)?
    } else {
        None
    };
    run(scene, settings, gpu, live.stop, emit, &mut report)?;
    report.seconds.total = start.elapsed().as_secs_f64();
    Ok(report)
}

/// Renders on the GPU that is given, else on the CPU.
fn run(
    scene: &Scene,
    settings: &Settings,
    gpu: Option<&Live<'_>>,
    stop: &Stop<'_>,
    emit: &mut Emit<'_>,
    report: &mut Report,
) -> Result<(), Error> {
    let [start, end] = report.rows;
    let jitter = settings.sampling(report.width, end);
    let tracer = Tracer::new(scene, settings, &jitter).stopping(stop);
    let threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build();
    let pool = settings.threads.map(threads).transpose();
    let pool = pool.map_err(|error| Error::Threads(error.to_string()))?;
    report.threads = Some(
        pool.as_ref()
            .map_or_else(rayon::current_num_threads, |pool| {
                pool.current_num_threads()
            }),
    );
    let job = Job {
        scene,
        jitter: &jitter,
        tracer: &tracer,
        pool: pool.as_ref(),
        width: report.width,
        rows: start..end,
        settings,
    };
    let done = match gpu {
        Some(live) => job.on_gpu(live, emit, report),
        None => job.on_cpu(emit, report),
    };
    match done {
        // Found before the first band, so nothing is rendered twice.
        Err(Error::Gpu(
            error @ (GpuError::TooMany { .. }
            | GpuError::TooLarge { .. }
            | GpuError::TooManyBuffers { .. }),
        )) if settings.backend == Backend::Auto => {
            report.fallback = Some(format!("{error}, so the CPU renders"));
            job.on_cpu(emit, report)
        }
        done => done,
    }
}

/// Whether the GPU is to render, if there is one that can be trusted.
fn wants_gpu(settings: &Settings, report: &mut Report) -> Result<bool, Error> {
    if settings.backend == Backend::Cpu {
        return Ok(false);
    }
    if settings.values && settings.precision == Precision::Certified {
        if settings.backend == Backend::Gpu {
            return Err(Error::Values);
        }
        report.fallback = Some(
            "certified values are computed on the CPU, all of them; --precision fast takes the GPU's own f32"
                .into(),
        );
        return Ok(false);
    }
    Ok(true)
}

/// The GPU that was opened if it can be trusted; none if the CPU is to render, and why.
fn trusted<T>(
    opened: Result<T, GpuError>,
    gpu: impl Fn(&T) -> &Gpu,
    settings: &Settings,
    report: &mut Report,
) -> Result<Option<T>, Error> {
    let tested = opened.and_then(|opened| {
        let start = Instant::now();
        let doubts = if settings.precision == Precision::Certified {
            trust::doubts(gpu(&opened), settings.cache.as_deref())
        } else {
            None
        };
        report.seconds.selftest = start.elapsed().as_secs_f64();
        match doubts {
            None => Ok(opened),
            Some(failures) => Err(GpuError::Untrusted {
                adapter: gpu(&opened).name.clone(),
                failures,
            }),
        }
    });
    match tested {
        Ok(opened) => Ok(Some(opened)),
        Err(error @ GpuError::Untrusted { .. }) if settings.backend == Backend::Auto => {
            report.fallback = Some(format!("{error}; the CPU renders"));
            Ok(None)
        }
        // Without any GPU the CPU gives the same picture; a GPU that was named has to be there.
        Err(error @ (GpuError::NoAdapter | GpuError::Device { .. }))
            if settings.backend == Backend::Auto =>
        {
            report.fallback = Some(format!("{error}, so the CPU renders; {}", install_hint()));
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

//! One picture, band after band: whoever can make bands takes them from a [`bag`], and finished ones are handed on in
//! order.
//!
//! Stands between the tracers (`gpu`, `cpu`) and what takes the rows (`image`, the preview, a test). [`devices`] opens
//! adapters, `device_worker` and `device_thread` keep one busy, `cpu_worker` does the same with the CPU's cores, and
//! `run` brings them together.

mod bag;
mod cpu_worker;
mod crew;
mod device_thread;
mod device_worker;
mod devices;
mod finish;
mod rendering;
mod report;
mod run;
#[cfg(test)]
mod tests;
mod turns;

use std::error::Error as _;
use std::sync::Arc;
use std::{fs, io};

use crate::certify::pixels::PixelDecider;
use crate::cores;
use crate::cpu::pixel::ExactTracer;
use crate::files::reason;
use crate::gpu::GpuError;
use crate::gpu::bands::DISPATCH_SECONDS;
use crate::gpu::canvas::Canvas;
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::Compiled;
use crate::scene::Scene;
use crate::stopwatch::{Phase, Stopwatch};
use rendering::Rendering;
use run::Source;

use crate::frame::Halt;
pub use crate::frame::{Band, Emit, PixelFault, StopRequested};
pub use crate::settings::{Backend, Precision, SamplePattern, Settings};
pub use devices::Devices;
pub use report::{Beside, Report, Seconds, WorkerReport, WorkerSeconds};
pub use turns::{Turn, Turns};

/// Why a rendering failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The rows asked for are not of the picture.
    #[error(
        "rows {start}..{end} are not rows of a picture {height} high: rows count from 0 at the bottom, the end not \
        included"
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
        "certified values (EXR) are computed on the CPU, all of them: leave out --backend gpu, or take the GPU's own \
        f32 with --precision fast"
    )]
    Values,
    /// A sample needs more rays than allowed.
    #[error(transparent)]
    TooManyRays(#[from] PixelFault),
    /// The GPU's fault.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The thread pool would not start.
    #[error(
        "the CPU threads cannot be started: {0}; there may be too little memory, or too many processes"
    )]
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
#[derive(Clone, Copy)]
pub struct Live<'a> {
    /// The device. It is left out where it is software that `Settings::adapter` does not name, and the CPU makes the
    /// picture many pixels at once: the bytes are certified then, whatever precision was asked for.
    pub gpu: &'a Gpu,
    /// Where the picture is shown, on the GPU: all pixels that the GPU makes are copied there.
    pub canvas: Option<&'a Canvas>,
    /// Shaders that were compiled for pictures before: those of fast ones are made such that a picture from another
    /// viewpoint finds its own there.
    pub compiled: Option<&'a Compiled>,
    /// About how many seconds a dispatch is to take: whatever else wants the device has to wait for so long.
    pub dispatch_seconds: f64,
    /// Whether nobody wants the picture any more; asked every few thousand pixels.
    pub stop: &'a StopRequested<'a>,
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
    if cfg!(target_os = "linux") && has_vulkan_driver() {
        "a Vulkan driver is installed, but finds no GPU, or too little memory to start (`ulimit -v`); the software one \
         needs no GPU (Debian and Ubuntu: apt install mesa-vulkan-drivers)"
    } else if cfg!(target_os = "linux") {
        "install your GPU's Vulkan driver, or the software one (Debian and Ubuntu: apt install mesa-vulkan-drivers)"
    } else if cfg!(windows) {
        "install your GPU's driver; plumb needs Direct3D 12"
    } else {
        "plumb needs Metal, or a Vulkan driver"
    }
}

/// Whether a Vulkan driver is where the loader looks for them first.
fn has_vulkan_driver() -> bool {
    ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"]
        .iter()
        .filter_map(|folder| fs::read_dir(folder).ok())
        .flatten()
        .filter_map(Result::ok)
        .any(|entry| {
            entry
                .path()
                .extension()
                .is_some_and(|ending| ending == "json")
        })
}

/// Renders `scene` and hands each finished band to `emit`, from the top of the picture down.
///
/// # Errors
/// Any [`Error`]. After [`Error::Revoked`] alone what was handed on is wrong, and the CPU will do better.
pub fn render(scene: &Scene, settings: &Settings, emit: &mut Emit<'_>) -> Result<Report, Error> {
    render_with(scene, settings, &Devices::new(), emit)
}

/// The same with devices that are kept for the next picture.
///
/// # Errors
/// As [`render`].
pub fn render_with(
    scene: &Scene,
    settings: &Settings,
    devices: &Devices,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    render_prepared(scene, settings, devices, None, emit)
}

/// The same of a scene that may be prepared already, for the view that the settings ask for.
///
/// # Errors
/// As [`render`].
pub fn render_prepared<'a>(
    scene: &'a Scene,
    settings: &Settings,
    devices: &Devices,
    prepared: Option<ExactTracer<'a>>,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    // Before a driver takes the memory: without a GPU there is a picture, without threads there is none.
    start_threads(settings)?;
    let source = Source::Devices(devices);
    run(scene, settings, source, prepared, None, &|| false, emit)
}

/// The same as one of many pictures: prepares the scene, waits for the turn, and passes it on when all rows are made,
/// before the last of them are handed on.
///
/// # Errors
/// As [`render`].
pub fn render_in_turn(
    scene: &Scene,
    settings: &Settings,
    devices: &Devices,
    turn: &Turn<'_>,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    start_threads(settings)?;
    let source = Source::Devices(devices);
    run(scene, settings, source, None, Some(turn), &|| false, emit)
}

/// The same on a device that somebody else has opened, and alone; the CPU goes on where it fails. The thread that keeps
/// the device busy borrows it, so one that does not answer is not rendered on any more, but waited for at the end: the
/// picture is whole then, and this returns when the driver does.
///
/// # Errors
/// As [`render`]; and [`Error::Stopped`].
pub fn render_live(
    scene: &Scene,
    settings: &Settings,
    live: &Live<'_>,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    let source = Source::Live(live);
    run(scene, settings, source, None, None, live.stop, emit)
}

/// Starts the CPU threads that all pictures share, where they are wanted.
fn start_threads(settings: &Settings) -> Result<(), Error> {
    if settings.threads.is_some() {
        return Ok(());
    }
    cores::start(None).map_err(|error| no_threads(&error))
}

fn no_threads(error: &rayon::ThreadPoolBuildError) -> Error {
    let cause = error.source().and_then(|cause| cause.downcast_ref());
    Error::Threads(cause.map_or_else(|| error.to_string(), reason))
}

/// Whether the rows asked for are rows of the picture.
fn check_rows(scene: &Scene, settings: &Settings) -> Result<(), Error> {
    let height = scene.camera.pixeldim[1];
    let rows = settings.rows_of(height);
    if rows.is_empty() || rows.end > height {
        return Err(Error::Rows {
            start: rows.start,
            end: rows.end,
            height,
        });
    }
    Ok(())
}

fn run<'a>(
    scene: &'a Scene,
    settings: &Settings,
    source: Source<'_>,
    prepared: Option<ExactTracer<'a>>,
    turn: Option<&Turn<'_>>,
    stop: &StopRequested<'_>,
    emit: &mut Emit<'_>,
) -> Result<Report, Error> {
    let mut watch = Stopwatch::start();
    check_rows(scene, settings)?;
    let threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build();
    let pool = settings.threads.map(threads).transpose();
    let pool = pool.map_err(|error| no_threads(&error))?;
    let threads = match &pool {
        Some(pool) => pool.current_num_threads(),
        None => rayon::current_num_threads(),
    };
    watch.lap(Phase::Threads);
    let [width, height] = scene.camera.pixeldim;
    let jitter = Arc::new(settings.sampling(width, settings.rows_of(height).end));
    let mut decider = PixelDecider::new(scene, settings, &jitter).stopping(stop);
    if let Some(prepared) = prepared {
        decider = decider.prepared(prepared);
    }
    let rendering = Rendering::new(scene, settings, &jitter, decider, pool.as_ref(), stop);
    let told = rendering.run(source, turn, emit, &mut watch)?;
    drop(rendering);
    watch.lap(Phase::Release);
    Ok(Report::new(scene, settings, threads, told, &watch))
}

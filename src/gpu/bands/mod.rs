//! The frame, in rectangles bounded in memory and in time: while one is on the GPU, the one before is read back and
//! handed on. No dispatch should take longer than about half a second: a real GPU's watchdog resets longer ones.

mod assembly;
mod plan;
mod slot;

use std::io;
use std::ops::Range;
use std::time::Instant;

use super::GpuError;
use super::compose::WORKGROUP;
use super::device::Gpu;
use super::pipeline::Pipeline;
use crate::frame::PixelFault;
use crate::jitter::Jitter;
use assembly::Assembly;
use plan::Plan;
use slot::Slot;

/// Most pixels of one dispatch: 8 MiB of packed bytes, twice for two dispatches under way, twice for reading back.
const MAX_PIXELS: u64 = 2 << 20;
/// Most bytes of sample offsets of one dispatch.
const MAX_OFFSETS: u64 = 32 << 20;
/// Bytes of a sample's offset.
const OFFSET_BYTES: u64 = 8;

/// Where the time of the bands went, and how many there were.
#[derive(Debug, Clone, Copy, Default)]
pub struct BandTimes {
    /// Number of bands handed on.
    pub bands: u32,
    /// Number of dispatches.
    pub dispatches: u32,
    /// Pixels that the GPU handed to the CPU.
    pub refined: u64,
    /// Seconds in kernels: by the device's clock where it has one, else as waited for.
    pub kernel: f64,
    /// Seconds waiting for the device and copying, kernels apart.
    pub readback: f64,
    /// Seconds in `emit`.
    pub emit: f64,
}

/// Why the bands ended early.
#[derive(Debug, thiserror::Error)]
pub enum BandError {
    /// The GPU's fault.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A pixel needs more rays than allowed.
    #[error(transparent)]
    Pixel(#[from] PixelFault),
    /// `emit` said no.
    #[error(transparent)]
    Emit(#[from] io::Error),
}

/// Value and bytes of pixel (x, y): what the CPU says of pixels that the GPU left undecided.
pub type Refine<'a> = dyn Fn(u32, u32) -> Result<([f32; 3], [u8; 3]), PixelFault> + Sync + 'a;

/// The frame to render.
pub struct Frame<'a> {
    /// Columns.
    pub width: u32,
    /// Rows, from the bottom, half-open.
    pub rows: Range<u32>,
    /// About the number of objects that the rays of a pixel ask.
    pub tests: usize,
    /// How the samples are spread.
    pub jitter: &'a Jitter,
    /// What decides pixels that the GPU does not.
    pub refine: &'a Refine<'a>,
}

/// Renders the frame from the top row down.
pub fn run(
    gpu: &Gpu,
    pipeline: &Pipeline,
    frame: &Frame<'_>,
    emit: &mut crate::frame::Emit<'_>,
) -> Result<BandTimes, BandError> {
    let (width, rows) = (frame.width, frame.rows.clone());
    let largest = largest_dispatch(gpu, pipeline, width, &rows);
    let mut slots = [
        Slot::new(gpu, pipeline, largest),
        Slot::new(gpu, pipeline, largest),
    ];
    gpu.check()?;
    let mut plan = Plan::new(width, rows, largest, frame.tests);
    let mut assembly = Assembly::new(width, pipeline.pixel_bytes == 16);
    let mut times = BandTimes::default();
    let mut next = 0;
    let mut open = 0;
    loop {
        let rectangle = plan.next();
        if open == 2 || (rectangle.is_none() && open > 0) {
            // The older of the two slots: the other one's work goes on meanwhile.
            let oldest = if open == 2 { next } else { 1 - next };
            let seconds = slots[oldest].collect(gpu, &mut assembly, &mut times)?;
            plan.took(seconds.0, seconds.1);
            open -= 1;
            if let Some(band) = assembly.finished(frame.refine, &mut times)? {
                let start = Instant::now();
                emit(&band)?;
                times.emit += start.elapsed().as_secs_f64();
                times.bands += 1;
            }
        }
        match rectangle {
            Some(rectangle) => {
                slots[next].submit(gpu, pipeline, frame.jitter, rectangle);
                next = 1 - next;
                open += 1;
                times.dispatches += 1;
            }
            None if open == 0 => return Ok(times),
            None => {}
        }
    }
}

/// Most pixels that one dispatch may have here.
fn largest_dispatch(gpu: &Gpu, pipeline: &Pipeline, width: u32, rows: &Range<u32>) -> u64 {
    let limits = gpu.device.limits();
    let bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let pixels = u64::from(width) * u64::from(rows.end - rows.start);
    let offsets = u64::from(pipeline.offsets) * OFFSET_BYTES;
    // A row of workgroups at least, whatever it takes; wgpu says so if it is too much.
    let by_offsets = MAX_OFFSETS
        .checked_div(offsets)
        .unwrap_or(u64::MAX)
        .max(u64::from(WORKGROUP * WORKGROUP));
    MAX_PIXELS
        .min(bytes / pipeline.pixel_bytes)
        .min(by_offsets)
        .min(pixels)
}

//! The frame, in rectangles bounded in memory and in time: while one is on the GPU, the one before is read back and
//! handed on. No dispatch should take longer than about half a second: a real GPU's watchdog resets longer ones.

pub(crate) mod assembly;
pub(crate) mod partial;
mod plan;
mod slot;

use std::ops::{ControlFlow, Range};
use std::time::Instant;

use super::GpuError;
use super::canvas::Canvas;
use super::device::Gpu;
use super::pipeline::Pipeline;
use crate::frame::Stop;
use crate::jitter::Jitter;
use crate::shader::constants::WORKGROUP;
use assembly::Assembly;
use plan::Plan;
use slot::Slot;

pub use assembly::Rendered;
pub use partial::Partials;

/// Most pixels of one dispatch: 8 MiB of packed bytes, twice for two dispatches under way, twice for reading back.
const MAX_PIXELS: u64 = 2 << 20;
/// Most bytes of sample offsets of one dispatch.
const MAX_OFFSETS: u64 = 32 << 20;
/// Seconds that a dispatch should take where nothing else waits for the device.
pub const DISPATCH_SECONDS: f64 = 0.15;
/// Bytes of a sample's offset.
const OFFSET_BYTES: u64 = 8;

/// Where the time of the bands went, and how many there were.
#[derive(Debug, Clone, Copy, Default)]
pub struct BandTimes {
    /// Number of dispatches.
    pub dispatches: u32,
    /// Seconds in kernels: by the device's clock where it has one, else as waited for.
    pub kernel: f64,
    /// Seconds waiting for the device and copying, kernels apart.
    pub readback: f64,
    /// Seconds that who takes the bands kept the GPU's side waiting.
    pub held: f64,
}

/// The frame to render.
#[derive(Debug)]
pub struct Frame<'a> {
    /// Columns.
    pub width: u32,
    /// Rows, from the bottom, half-open.
    pub rows: Range<u32>,
    /// About the number of objects that the rays of a pixel ask.
    pub tests: usize,
    /// How the samples are spread.
    pub jitter: &'a Jitter,
    /// Rows of a band, if that was asked for.
    pub band_rows: Option<u32>,
    /// About how many seconds a dispatch is to take.
    pub dispatch_seconds: f64,
    /// Where the pixels are shown, on the GPU.
    pub canvas: Option<&'a Canvas>,
}

/// Renders the frame from the top row down, and hands each band on: while that is waited for, the next two dispatches are
/// on the GPU already. Ends early where `hand_on` breaks off, or `stop` says so.
pub fn run(
    gpu: &Gpu,
    pipeline: &Pipeline,
    frame: &Frame<'_>,
    stop: &Stop<'_>,
    hand_on: &mut dyn FnMut(Rendered) -> ControlFlow<()>,
) -> Result<BandTimes, GpuError> {
    let (width, rows) = (frame.width, frame.rows.clone());
    let largest = largest_dispatch(gpu, pipeline, width, &rows);
    // Rows are filled up to whole invocations.
    let filled =
        largest + u64::from(pipeline.across - 1) * largest.min(u64::from(rows.end - rows.start));
    let mut slots = [
        Slot::new(gpu, pipeline, filled),
        Slot::new(gpu, pipeline, filled),
    ];
    gpu.check()?;
    let mut plan = Plan::new(
        width,
        rows,
        largest,
        frame.tests,
        frame.band_rows,
        frame.dispatch_seconds,
    );
    let mut assembly = Assembly::new(width, pipeline.pixel_bytes == 16);
    let mut times = BandTimes::default();
    let mut next = 0;
    let mut open = 0;
    loop {
        if stop() {
            return Ok(times);
        }
        let rectangle = plan.next();
        let mut finished = None;
        if open == 2 || (rectangle.is_none() && open > 0) {
            // The older of the two slots: the other one's work goes on meanwhile.
            let oldest = if open == 2 { next } else { 1 - next };
            let (pixels, seconds) = slots[oldest].collect(gpu, &mut assembly, &mut times)?;
            plan.took(pixels, seconds);
            open -= 1;
            finished = assembly.finished();
        }
        let done = rectangle.is_none() && open == 0;
        if let Some(rectangle) = rectangle {
            slots[next].submit(gpu, pipeline, frame, rectangle);
            next = 1 - next;
            open += 1;
            times.dispatches += 1;
        }
        // Only now, with the GPU busy: whoever takes the band may keep us waiting.
        if let Some(band) = finished {
            let start = Instant::now();
            if hand_on(band).is_break() {
                return Ok(times);
            }
            times.held += start.elapsed().as_secs_f64();
        }
        if done {
            return Ok(times);
        }
    }
}

/// Most pixels that one dispatch may have here.
fn largest_dispatch(gpu: &Gpu, pipeline: &Pipeline, width: u32, rows: &Range<u32>) -> u64 {
    let limits = gpu.device.limits();
    let bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size)
        - if pipeline.partial_words > 0 {
            partial::MOST
        } else {
            0
        };
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

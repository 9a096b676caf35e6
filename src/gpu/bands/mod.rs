//! The frame, in rectangles bounded in memory and in time: while one is on the GPU, the one before is read back and
//! handed on. No dispatch should take longer than about half a second: a real GPU's watchdog resets longer ones.

pub(crate) mod assembly;
pub(super) mod buffers;
mod listed;
pub(crate) mod partial;
mod plan;
mod slot;

use std::ops::{ControlFlow, Range};

use super::GpuError;
use super::canvas::Canvas;
use super::device::Gpu;
use super::double::DoubleStage;
use super::pipeline::Pipeline;
use crate::frame::StopRequested;
use crate::jitter::Jitter;
use crate::shader::constants::WORKGROUP;
use crate::shader::form::Form;
use crate::stopwatch::{Phase, Stopwatch};
use assembly::Assembly;
use partial::Layout;
use plan::{Next, Plan};
use slot::Slot;

pub use assembly::Rendered;
pub use partial::Partials;

/// Most pixels of one dispatch: 8 MiB of packed bytes, twice for two dispatches under way, twice for reading back.
const MAX_PIXELS: u64 = 2 << 20;
/// Most rows of a band that others cut: devices have at least so many workgroups in a direction.
const MAX_ROWS: u32 = 1 << 16;
/// Most bytes of sample offsets of one dispatch.
const MAX_OFFSETS: u64 = 32 << 20;
/// Seconds that a dispatch should take where nothing else waits for the device.
pub const DISPATCH_SECONDS: f64 = 0.15;
/// Bytes of a sample's offset.
const OFFSET_BYTES: u64 = 8;

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
    /// What decides in f64 what f32 leaves open, if the pipeline lists it.
    pub double: Option<&'a DoubleStage>,
    /// Where the pixels are shown, on the GPU.
    pub canvas: Option<&'a Canvas>,
}

/// What rows are to be rendered next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Order {
    /// These.
    Rows(Range<u32>),
    /// There are none at the moment.
    Later,
    /// There will be none any more.
    End,
}

/// Is asked for the next rows: how many there should be, and whether there is nothing else to do than to wait for them.
pub type NextRows<'a> = dyn FnMut(u32, bool) -> Order + 'a;

/// Gives all rows, from the top down, as many as wished.
pub fn from_the_top(mut rows: Range<u32>) -> impl FnMut(u32, bool) -> Order {
    move |wish, _| {
        let start = rows.end.saturating_sub(wish).max(rows.start);
        let band = start..rows.end;
        rows.end = start;
        if band.is_empty() {
            Order::End
        } else {
            Order::Rows(band)
        }
    }
}

/// Renders the rows that it is told, of those of the frame, and hands each band on: while that is waited for, the next
/// two dispatches are on the GPU already. Ends early where `hand_on` breaks off, or `stop` says so.
pub fn run(
    gpu: &Gpu,
    pipeline: &Pipeline,
    frame: &Frame<'_>,
    next_rows: &mut NextRows<'_>,
    stop: &StopRequested<'_>,
    watch: &mut Stopwatch,
    hand_on: &mut dyn FnMut(Rendered) -> ControlFlow<()>,
) -> Result<(), GpuError> {
    let width = frame.width;
    let (largest, filled) = largest_dispatch(gpu, &pipeline.form, width, &frame.rows);
    // The second one is made when the GPU is busy with the first, and only if there is more to do.
    let mut slots: [Option<Slot>; 2] = [None, None];
    let mut plan = Plan::new(
        width,
        largest,
        frame.tests,
        frame.band_rows,
        frame.dispatch_seconds,
    );
    let mut assembly = Assembly::new(width, pipeline.form.pixels);
    let mut turn = 0;
    let mut open = 0;
    loop {
        if stop() {
            return Ok(());
        }
        let next = plan.next(&mut |wish| next_rows(wish, open == 0));
        watch.lap(Phase::Held);
        let (rectangle, end) = match next {
            Next::Rectangle(rectangle) => (Some(rectangle), false),
            Next::Later => (None, false),
            Next::End => (None, true),
        };
        let mut finished = None;
        if open == 2 || (rectangle.is_none() && open > 0) {
            // The older of the two slots is read back, while the GPU goes on with the other one's work.
            let oldest = if open == 2 { turn } else { 1 - turn };
            if let Some(slot) = &mut slots[oldest] {
                let took = slot.collect(gpu, &mut assembly, watch)?;
                plan.took(took.pixels, took.kernel);
                assembly.took(&took);
            }
            open -= 1;
            finished = assembly.finished();
            watch.lap(Phase::Readback);
        }
        let done = end && open == 0;
        if let Some(rectangle) = rectangle {
            let slot = match &mut slots[turn] {
                Some(slot) => slot,
                none => {
                    let slot = none.insert(Slot::new(gpu, pipeline, filled));
                    gpu.check()?;
                    watch.lap(Phase::Buffers);
                    slot
                }
            };
            slot.submit(gpu, pipeline, frame, rectangle);
            watch.lap(Phase::Submit);
            turn = 1 - turn;
            open += 1;
        }
        // The band is handed on only now, while the GPU is busy: whoever takes it may keep us waiting.
        if let Some(band) = finished {
            let taken = hand_on(band);
            watch.lap(Phase::Held);
            if taken.is_break() {
                return Ok(());
            }
        }
        if done {
            return Ok(());
        }
    }
}

/// Most rows that a band may have whoever cut it: a dispatch has at least one workgroup's columns of all its rows.
pub fn tallest(gpu: &Gpu, pipeline: &Pipeline, frame: &Frame<'_>) -> u32 {
    let (largest, _) = largest_dispatch(gpu, &pipeline.form, frame.width, &frame.rows);
    let columns = frame.width.min(WORKGROUP);
    (largest / u64::from(columns)).min(u64::from(MAX_ROWS)) as u32
}

/// Makes the large buffers for such a frame, unless they are there: meanwhile the shader may be compiled.
pub fn prepare(gpu: &Gpu, form: &Form, width: u32, rows: &Range<u32>) {
    let (largest, filled) = largest_dispatch(gpu, form, width, rows);
    let pixels = u64::from(width) * u64::from(rows.end - rows.start);
    let pairs = if largest < pixels { 2 } else { 1 };
    gpu.buffers.prepare(
        &gpu.device,
        |encoder| {
            gpu.submit(encoder);
        },
        pairs,
        Layout::new(form, filled).bytes,
    );
}

/// Most pixels that one dispatch may have here; and the same with those that its rows are filled up with.
fn largest_dispatch(gpu: &Gpu, form: &Form, width: u32, rows: &Range<u32>) -> (u64, u64) {
    let limits = gpu.device.limits();
    let bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size)
        - if form.record_words > 0 {
            partial::MOST
        } else {
            0
        };
    let pixels = u64::from(width) * u64::from(rows.end - rows.start);
    let offsets = u64::from(form.offsets) * OFFSET_BYTES;
    // With what rows are filled up with.
    let filled = u64::from(width.next_multiple_of(form.group()));
    let most = MAX_PIXELS.min(bytes / form.group_bytes() * u64::from(form.group()));
    let most = (most * u64::from(width) / filled).max(1);
    // A dispatch has at least one row of workgroups, whatever the offsets take; wgpu reports an error if that is too
    // much.
    let by_offsets = MAX_OFFSETS
        .checked_div(offsets)
        .unwrap_or(u64::MAX)
        .max(u64::from(WORKGROUP * WORKGROUP));
    let largest = most.min(by_offsets).min(pixels);
    // A dispatch of several rows has as many as fit whole, and each is filled up to whole groups.
    let most_rows = (largest / u64::from(width)).max(1);
    let group = u64::from(form.group());
    (
        largest,
        (largest + (group - 1) * most_rows).next_multiple_of(group),
    )
}

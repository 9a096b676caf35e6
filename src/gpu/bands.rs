//! The frame, in rectangles bounded in memory and in time: while one is on the GPU, the one before is read back and
//! handed on. No dispatch should take longer than about half a second: a real GPU's watchdog resets longer ones.

use std::io;
use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;

use super::GpuError;
use super::compose::WORKGROUP;
use super::device::Gpu;
use super::pack::Job;
use super::pipeline::Pipeline;
use crate::cpu::pixel::Jitter;
use crate::render::{Band, PixelFault};

/// Most pixels of one dispatch: 8 MiB of packed bytes, twice for two dispatches under way, twice for reading back.
const MAX_PIXELS: u64 = 2 << 20;
/// Most bytes of sample offsets of one dispatch.
const MAX_OFFSETS: u64 = 32 << 20;
/// Bytes of a sample's offset.
const OFFSET_BYTES: u64 = 8;
/// A dispatch is made larger or smaller so that it takes about this long.
const TARGET_SECONDS: f64 = 0.15;
/// Ray–object tests of the first dispatch, whose speed is not known yet: a tenth of a second on two CPU cores.
const FIRST_TESTS: u64 = 8 << 20;
/// What a pixel costs beside its objects, in tests.
const PIXEL_TESTS: u64 = 8;

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
    emit: &mut crate::render::Emit<'_>,
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

/// A rectangle of a band: columns of rows `band` (from the bottom).
#[derive(Debug, Clone, PartialEq, Eq)]
struct Rectangle {
    band: Range<u32>,
    columns: Range<u32>,
    /// Whether the band is complete with it.
    last: bool,
}

impl Rectangle {
    fn pixels(&self) -> u64 {
        u64::from(self.band.end - self.band.start)
            * u64::from(self.columns.end - self.columns.start)
    }

    /// The offsets of the samples of its pixels, top row first.
    fn offsets(&self, jitter: &Jitter, samples: u32) -> Vec<[f32; 2]> {
        let columns = self.columns.start as usize * samples as usize
            ..self.columns.end as usize * samples as usize;
        let rows = self.band.clone().rev().filter_map(|y| jitter.row(y));
        rows.flat_map(|row| {
            row[columns.clone()]
                .iter()
                .map(|[a, b]| [*a as f32, *b as f32])
                .collect::<Vec<_>>()
        })
        .collect()
    }
}

/// Which rectangle comes next, and how large it is to be.
#[derive(Debug)]
struct Plan {
    width: u32,
    rows: Range<u32>,
    largest: u64,
    pixels: u64,
    /// The band under way and its next column.
    band: Option<(Range<u32>, u32)>,
}

impl Plan {
    fn new(width: u32, rows: Range<u32>, largest: u64, tests: usize) -> Self {
        let pixels = (FIRST_TESTS / (tests as u64 + PIXEL_TESTS)).clamp(1, largest);
        Self {
            width,
            rows,
            largest,
            pixels,
            band: None,
        }
    }

    /// Learns that a dispatch of so many pixels took so long.
    fn took(&mut self, pixels: u64, seconds: f64) {
        let ideal = pixels as f64 * TARGET_SECONDS / seconds.max(1e-6);
        // Carefully: one measurement says little, and the next rectangle may be of another kind.
        let (least, most) = (self.pixels as f64 / 4.0, self.pixels as f64 * 4.0);
        self.pixels = (ideal.clamp(least, most) as u64).clamp(1, self.largest);
    }

    fn next(&mut self) -> Option<Rectangle> {
        let (band, column) = match self.band.take() {
            Some(under_way) => under_way,
            None => {
                if self.rows.is_empty() {
                    return None;
                }
                // Whole workgroups of rows if they fit; columns are cut where even those take too long.
                let fitting = (self.largest / u64::from(self.width))
                    .max(1)
                    .min(u64::from(u32::MAX)) as u32;
                let wanted = (self.pixels / u64::from(self.width)) as u32 / WORKGROUP * WORKGROUP;
                let height = wanted
                    .max(WORKGROUP)
                    .min(fitting)
                    .min(self.rows.end - self.rows.start);
                let band = self.rows.end - height..self.rows.end;
                self.rows.end = band.start;
                (band, 0)
            }
        };
        let height = u64::from(band.end - band.start);
        let cut = (self.pixels / height) as u32 / WORKGROUP * WORKGROUP;
        let end = column.saturating_add(cut.max(WORKGROUP)).min(self.width);
        let last = end == self.width;
        if !last {
            self.band = Some((band.clone(), end));
        }
        Some(Rectangle {
            band,
            columns: column..end,
            last,
        })
    }
}

/// Buffers for one dispatch under way.
#[derive(Debug)]
struct Slot {
    job: wgpu::Buffer,
    offsets: Option<wgpu::Buffer>,
    pixels: wgpu::Buffer,
    staging: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    clock: Option<Clock>,
    pixel_bytes: u64,
    pending: Option<(wgpu::SubmissionIndex, Rectangle)>,
}

/// Timestamps before and after a dispatch.
#[derive(Debug)]
struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
}

impl Slot {
    fn new(gpu: &Gpu, pipeline: &Pipeline, largest: u64) -> Self {
        let buffer = |label, size, usage| {
            let descriptor = wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            };
            gpu.device.create_buffer(&descriptor)
        };
        let size = largest * pipeline.pixel_bytes;
        let job = buffer(
            "job",
            size_of::<Job>() as u64,
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let pixels = buffer(
            "pixels",
            size,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        );
        let staging = buffer(
            "staging",
            size,
            wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        );
        let clock = gpu.timestamps.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("clock"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(
                "clock",
                16,
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            staging: buffer(
                "clock staging",
                16,
                wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            ),
        });
        let offsets = (pipeline.offsets > 0).then(|| {
            let size = largest * u64::from(pipeline.offsets) * OFFSET_BYTES;
            buffer(
                "offsets",
                size,
                wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            )
        });
        let bind_group = pipeline.bind(gpu, &job, &pixels, offsets.as_ref());
        Self {
            job,
            offsets,
            pixels,
            staging,
            bind_group,
            clock,
            pixel_bytes: pipeline.pixel_bytes,
            pending: None,
        }
    }

    fn submit(&mut self, gpu: &Gpu, pipeline: &Pipeline, jitter: &Jitter, rectangle: Rectangle) {
        let columns = rectangle.columns.end - rectangle.columns.start;
        let rows = rectangle.band.end - rectangle.band.start;
        let job = Job {
            first: [rectangle.columns.start, rectangle.band.end - 1],
            size: [columns, rows],
        };
        gpu.queue
            .write_buffer(&self.job, 0, bytemuck::bytes_of(&job));
        if let Some(offsets) = &self.offsets {
            gpu.queue.write_buffer(
                offsets,
                0,
                bytemuck::cast_slice(&rectangle.offsets(jitter, pipeline.offsets)),
            );
        }
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let timestamp_writes = self
            .clock
            .as_ref()
            .map(|clock| wgpu::ComputePassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: Some(0),
                end_of_pass_write_index: Some(1),
            });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("plumb"),
                timestamp_writes,
            });
            pass.set_pipeline(&pipeline.pipeline);
            pass.set_bind_group(0, &self.bind_group, &[]);
            pass.dispatch_workgroups(columns.div_ceil(WORKGROUP), rows.div_ceil(WORKGROUP), 1);
        }
        let bytes = rectangle.pixels() * self.pixel_bytes;
        encoder.copy_buffer_to_buffer(&self.pixels, 0, &self.staging, 0, bytes);
        if let Some(clock) = &self.clock {
            encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
            encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.staging, 0, 16);
        }
        let index = gpu.queue.submit([encoder.finish()]);
        self.staging.map_async(wgpu::MapMode::Read, ..bytes, |_| ());
        if let Some(clock) = &self.clock {
            clock.staging.map_async(wgpu::MapMode::Read, .., |_| ());
        }
        self.pending = Some((index, rectangle));
    }

    /// Waits for the dispatch and takes its pixels; returns how many there were, and the seconds they took.
    fn collect(
        &mut self,
        gpu: &Gpu,
        assembly: &mut Assembly,
        times: &mut BandTimes,
    ) -> Result<(u64, f64), GpuError> {
        let Some((index, rectangle)) = self.pending.take() else {
            return Ok((0, 0.0));
        };
        let start = Instant::now();
        let polled = gpu.device.poll(wgpu::PollType::Wait {
            submission_index: Some(index),
            timeout: None,
        });
        gpu.check()?;
        let lost = |reason: String| GpuError::Lost {
            adapter: gpu.name.clone(),
            reason,
        };
        polled.map_err(|error| lost(error.to_string()))?;
        let waited = start.elapsed().as_secs_f64();
        let kernel = match &self.clock {
            Some(clock) => {
                let view = clock
                    .staging
                    .get_mapped_range(..)
                    .map_err(|error| lost(error.to_string()))?;
                let ticks: [u64; 2] = [word(&view, 0), word(&view, 1)];
                drop(view);
                clock.staging.unmap();
                ticks[1].saturating_sub(ticks[0]) as f64
                    * f64::from(gpu.queue.get_timestamp_period())
                    * 1e-9
            }
            None => waited,
        };
        let pixels = rectangle.pixels();
        let bytes = pixels * self.pixel_bytes;
        let view = self
            .staging
            .get_mapped_range(..bytes)
            .map_err(|error| lost(error.to_string()))?;
        assembly.take(&rectangle, &view);
        drop(view);
        self.staging.unmap();
        times.kernel += kernel;
        times.readback += (start.elapsed().as_secs_f64() - kernel).max(0.0);
        Ok((pixels, kernel))
    }
}

/// The little-endian u64 number `i` of a mapped buffer.
fn word(view: &[u8], i: usize) -> u64 {
    view.chunks_exact(8)
        .nth(i)
        .and_then(|bytes| bytes.try_into().ok())
        .map_or(0, u64::from_le_bytes)
}

/// The band under way, put together from its rectangles.
#[derive(Debug)]
struct Assembly {
    width: usize,
    values: bool,
    band: Option<Band>,
    /// Places in the band that the CPU has to decide.
    undecided: Vec<usize>,
    complete: bool,
}

impl Assembly {
    fn new(width: u32, values: bool) -> Self {
        Self {
            width: width as usize,
            values,
            band: None,
            undecided: Vec::new(),
            complete: false,
        }
    }

    /// Copies a rectangle's pixels to their place.
    fn take(&mut self, rectangle: &Rectangle, bytes: &[u8]) {
        let rows = (rectangle.band.end - rectangle.band.start) as usize;
        let pixels = rows * self.width;
        let band = self.band.get_or_insert_with(|| Band {
            rows: rectangle.band.clone(),
            rgb: vec![0; 3 * pixels],
            values: self.values.then(|| vec![[0.0; 3]; pixels]),
        });
        let columns = rectangle.columns.start as usize..rectangle.columns.end as usize;
        let pixel_bytes = if self.values { 16 } else { 4 };
        for (row, line) in bytes.chunks_exact(columns.len() * pixel_bytes).enumerate() {
            let place = row * self.width + columns.start..row * self.width + columns.end;
            let rgb = &mut band.rgb[3 * place.start..3 * place.end];
            let mut verdicts = 0;
            for (pixel, to) in line.chunks_exact(pixel_bytes).zip(rgb.chunks_exact_mut(3)) {
                to.copy_from_slice(&pixel[pixel_bytes - 4..pixel_bytes - 1]);
                verdicts |= pixel[pixel_bytes - 1];
            }
            if verdicts != 0 {
                let pixels = line.chunks_exact(pixel_bytes).enumerate();
                self.undecided.extend(
                    pixels
                        .filter(|(_, p)| p[pixel_bytes - 1] != 0)
                        .map(|(i, _)| place.start + i),
                );
            }
            if let Some(values) = &mut band.values {
                for (pixel, to) in line.chunks_exact(pixel_bytes).zip(&mut values[place]) {
                    let channel = |i: usize| -> f32 {
                        let word = pixel[4 * i..4 * i + 4]
                            .try_into()
                            .map_or(0, u32::from_le_bytes);
                        f32::from_bits(word) / 255.0
                    };
                    *to = [channel(0), channel(1), channel(2)];
                }
            }
        }
        self.complete = rectangle.last;
    }

    /// The band, if all its rectangles have come, with what the CPU had to decide.
    fn finished(
        &mut self,
        refine: &Refine<'_>,
        times: &mut BandTimes,
    ) -> Result<Option<Band>, PixelFault> {
        if !std::mem::take(&mut self.complete) {
            return Ok(None);
        }
        let Some(mut band) = self.band.take() else {
            return Ok(None);
        };
        times.refined += self.undecided.len() as u64;
        let (width, top) = (self.width, band.rows.end - 1);
        let decided: Vec<(usize, _)> = std::mem::take(&mut self.undecided)
            .into_par_iter()
            .map(|place| {
                refine((place % width) as u32, top - (place / width) as u32)
                    .map(|done| (place, done))
            })
            .collect::<Result<_, _>>()?;
        for (place, (value, bytes)) in decided {
            band.rgb[3 * place..3 * place + 3].copy_from_slice(&bytes);
            if let Some(values) = &mut band.values {
                values[place] = value;
            }
        }
        Ok(Some(band))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel exactly once, bands from the top down, and no dispatch larger than allowed.
    fn covers(
        width: u32,
        rows: Range<u32>,
        largest: u64,
        tested: usize,
        seconds: impl Fn(u64) -> f64,
    ) {
        let mut plan = Plan::new(width, rows.clone(), largest, tested);
        let mut top = rows.end;
        let mut column = 0;
        while let Some(r) = plan.next() {
            assert_eq!(r.columns.start, column);
            assert_eq!(r.band.end, top);
            assert!(r.pixels() <= largest && r.pixels() > 0, "{r:?}");
            if r.last {
                assert_eq!(r.columns.end, width);
                top = r.band.start;
                column = 0;
            } else {
                column = r.columns.end;
            }
            plan.took(r.pixels(), seconds(r.pixels()));
        }
        assert_eq!((top, column), (rows.start, 0));
    }

    #[test]
    fn rectangles_cover_the_rows_once() {
        let fast = |pixels: u64| pixels as f64 * 1e-8;
        let slow = |pixels: u64| pixels as f64 * 1e-3;
        covers(640, 0..480, MAX_PIXELS, 3, fast);
        covers(640, 0..480, MAX_PIXELS, 100_000, slow);
        covers(1, 0..1, 1, 3, fast);
        covers(1_000_000, 3..57, MAX_PIXELS, 3, fast);
        covers(1_000_000, 0..40, MAX_PIXELS, 1_000_000, slow);
        covers(7, 100..1_000_000, MAX_PIXELS, 3, fast);
    }

    #[test]
    fn a_slow_scene_gets_small_dispatches() {
        let mut plan = Plan::new(1000, 0..1000, MAX_PIXELS, 3);
        for _ in 0..10 {
            let Some(r) = plan.next() else { break };
            plan.took(r.pixels(), r.pixels() as f64 * 1e-4);
        }
        let pixels = plan.next().map(|r| r.pixels()).unwrap();
        assert!(pixels as f64 * 1e-4 <= 0.5, "{pixels}");
    }
}

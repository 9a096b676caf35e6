//! The buffers of one dispatch under way: two of these take turns.

use std::sync::Arc;

use bytemuck::Zeroable as _;

use super::super::GpuError;
use super::super::device::Gpu;
use super::super::double::DoubleStage;
use super::super::pipeline::Pipeline;
use super::assembly::Assembly;
use super::buffers::{BufferPool, PixelBuffers};
use super::listed;
use super::partial;
use super::plan::Rectangle;
use super::{Frame, OFFSET_BYTES};
use crate::shader::constants::WORKGROUP;
use crate::shader::records::{CameraNumbers, Dispatch};
use crate::stopwatch::{Phase, Stopwatch};

/// Buffers for one dispatch under way.
#[derive(Debug)]
pub(super) struct Slot {
    dispatch: wgpu::Buffer,
    offsets: Option<wgpu::Buffer>,
    buffers: PixelBuffers,
    /// Whether nothing is pending on them.
    is_clean: bool,
    /// Where they go in the end.
    pool: Arc<BufferPool>,
    bind_group: wgpu::BindGroup,
    /// For the pixels that were listed, once the shader for them is there.
    second: Option<Second>,
    clock: Option<Clock>,
    pending: Option<Pending>,
}

/// A dispatch under way.
#[derive(Debug)]
struct Pending {
    index: wgpu::SubmissionIndex,
    rectangle: Rectangle,
    layout: partial::Layout,
    /// How many records of the list f64 takes, if it takes any.
    taken: Option<u32>,
}

/// What a dispatch took.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Took {
    /// How many pixels it made.
    pub(super) pixels: u64,
    /// Seconds that its kernels took: by the device's clock where it has one, else as waited for.
    pub(super) kernel: f64,
    /// Seconds of those that went into f64, by the device's clock; 0 where it has none.
    pub(super) double: f64,
    /// How many pixels f64 was asked for.
    pub(super) listed: u32,
}

/// What takes the pixels of a list.
#[derive(Debug)]
struct Second {
    group: wgpu::BindGroup,
    /// Workgroups of its dispatch.
    workgroups: wgpu::Buffer,
}

impl Second {
    fn new(gpu: &Gpu, pipeline: &Pipeline, dispatch: &wgpu::Buffer, pixels: &wgpu::Buffer) -> Self {
        use wgpu::util::DeviceExt as _;
        let descriptor = wgpu::util::BufferInitDescriptor {
            label: Some("workgroups"),
            contents: bytemuck::cast_slice(&[0_u32, 1, 1]),
            usage: wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_DST,
        };
        Self {
            group: pipeline.bind(gpu, dispatch, pixels, None),
            workgroups: gpu.device.create_buffer_init(&descriptor),
        }
    }
}

/// Timestamps before and after a dispatch.
#[derive(Debug)]
struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
}

impl Slot {
    pub(super) fn new(gpu: &Gpu, pipeline: &Pipeline, largest: u64) -> Self {
        let buffer = |label, size, usage| {
            let descriptor = wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            };
            gpu.device.create_buffer(&descriptor)
        };
        let form = &pipeline.form;
        let buffers = gpu
            .buffers
            .take(&gpu.device, partial::Layout::new(form, largest).bytes);
        let dispatch = buffer(
            "dispatch",
            (size_of::<Dispatch>() + size_of::<CameraNumbers>()) as u64,
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        if let Some(camera) = &pipeline.camera {
            let behind = size_of::<Dispatch>() as u64;
            gpu.queue
                .write_buffer(&dispatch, behind, bytemuck::bytes_of(camera));
        }
        let clock = gpu.timestamps.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("clock"),
                ty: wgpu::QueryType::Timestamp,
                count: 3,
            }),
            resolved: buffer(
                "clock",
                24,
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            staging: buffer(
                "clock staging",
                24,
                wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            ),
        });
        let offsets = (form.offsets > 0).then(|| {
            let size = largest * u64::from(form.offsets) * OFFSET_BYTES;
            buffer(
                "offsets",
                size,
                wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            )
        });
        let bind_group = pipeline.bind(gpu, &dispatch, &buffers.pixels, offsets.as_ref());
        Self {
            dispatch,
            offsets,
            buffers,
            is_clean: true,
            pool: Arc::clone(&gpu.buffers),
            bind_group,
            second: None,
            clock,
            pending: None,
        }
    }

    pub(super) fn submit(
        &mut self,
        gpu: &Gpu,
        pipeline: &Pipeline,
        frame: &Frame<'_>,
        rectangle: Rectangle,
    ) {
        let columns = rectangle.columns.end - rectangle.columns.start;
        let rows = rectangle.band.end - rectangle.band.start;
        let form = &pipeline.form;
        let pitch = columns.next_multiple_of(form.group());
        let layout = partial::Layout::new(form, u64::from(pitch) * u64::from(rows));
        let double = frame.double.and_then(DoubleStage::pipeline);
        let taken = double.map_or(0, |(_, most)| layout.room.min(most));
        let dispatch = Dispatch {
            first: [rectangle.columns.start, rectangle.band.end - 1],
            size: [columns, rows],
            zero: 0,
            room: layout.room,
            taken,
            ..Dispatch::zeroed()
        };
        gpu.queue
            .write_buffer(&self.dispatch, 0, bytemuck::bytes_of(&dispatch));
        if let Some(offsets) = &self.offsets {
            gpu.queue.write_buffer(
                offsets,
                0,
                bytemuck::cast_slice(&rectangle.offsets(frame.jitter, form.offsets)),
            );
        }
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if let (Some((double, _)), None) = (double, &self.second) {
            let second = Second::new(gpu, double, &self.dispatch, &self.buffers.pixels);
            self.second = Some(second);
        }
        let timestamps = |beginning, end| {
            let clock = self.clock.as_ref()?;
            Some(wgpu::ComputePassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: beginning,
                end_of_pass_write_index: end,
            })
        };
        if layout.counter > 0 {
            encoder.clear_buffer(&self.buffers.pixels, 0, Some(layout.counter));
        }
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("plumb"),
                timestamp_writes: timestamps(Some(0), Some(1)),
            });
            pass.set_pipeline(&pipeline.pipeline);
            pass.set_bind_group(0, &self.bind_group, &[]);
            let groups = [pitch / form.across, rows].map(|n| n.div_ceil(WORKGROUP));
            pass.dispatch_workgroups(groups[0], groups[1], 1);
        }
        if let (Some((double, _)), Some(second)) = (double, &self.second) {
            // The second of the counters says how many workgroups the list asks for.
            encoder.copy_buffer_to_buffer(&self.buffers.pixels, 4, &second.workgroups, 0, 4);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("plumb, f64"),
                timestamp_writes: timestamps(None, Some(2)),
            });
            pass.set_pipeline(&double.pipeline);
            pass.set_bind_group(0, &second.group, &[]);
            pass.dispatch_workgroups_indirect(&second.workgroups, 0);
        }
        let bytes = layout.bytes;
        let PixelBuffers { pixels, staging } = &self.buffers;
        encoder.copy_buffer_to_buffer(pixels, 0, staging, 0, bytes);
        if let Some(canvas) = frame.canvas {
            let (at, size) = (
                [rectangle.columns.start, rectangle.band.end],
                [columns, rows],
            );
            canvas.take(&mut encoder, (pixels, layout.counter), pitch, at, size);
        }
        if let Some(clock) = &self.clock {
            // What was not written is not resolved.
            let written = if double.is_some() { 3 } else { 2 };
            encoder.resolve_query_set(&clock.queries, 0..written, &clock.resolved, 0);
            encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.staging, 0, 24);
        }
        let index = gpu.submit(encoder);
        staging.map_async(wgpu::MapMode::Read, ..bytes, |_| ());
        if let Some(clock) = &self.clock {
            clock.staging.map_async(wgpu::MapMode::Read, .., |_| ());
        }
        self.pending = Some(Pending {
            index,
            rectangle,
            layout,
            taken: double.is_some().then_some(taken),
        });
        self.is_clean = false;
    }

    /// Waits for the dispatch and takes its pixels.
    pub(super) fn collect(
        &mut self,
        gpu: &Gpu,
        assembly: &mut Assembly,
        watch: &mut Stopwatch,
    ) -> Result<Took, GpuError> {
        let Some(pending) = self.pending.take() else {
            return Ok(Took::default());
        };
        let Pending {
            index,
            rectangle,
            layout,
            taken,
        } = pending;
        gpu.wait(index)?;
        let waited = watch.lap(Phase::Wait);
        let [kernel, double] = match &self.clock {
            Some(clock) => {
                let view = clock
                    .staging
                    .get_mapped_range(..)
                    .map_err(|error| gpu.lost(&error))?;
                let [start, single, double] = [0, 1, 2].map(|i| word(&view, i));
                drop(view);
                clock.staging.unmap();
                let seconds = |from: u64, to: u64| {
                    to.saturating_sub(from) as f64
                        * f64::from(gpu.queue.get_timestamp_period())
                        * 1e-9
                };
                if taken.is_some() {
                    [seconds(start, double), seconds(single, double)]
                } else {
                    [seconds(start, single), 0.0]
                }
            }
            None => [waited, 0.0],
        };
        let pixels = rectangle.pixels();
        let view = self
            .buffers
            .staging
            .get_mapped_range(..layout.bytes)
            .map_err(|error| gpu.lost(&error))?;
        assembly.take(&rectangle, &layout, &view);
        let listed = taken.map_or(0, |taken| listed::count(&layout, &view).min(taken));
        drop(view);
        self.buffers.staging.unmap();
        self.is_clean = true;
        Ok(Took {
            pixels,
            kernel,
            double,
            listed,
        })
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        // What the device may still be at work on is left to wgpu.
        if self.is_clean {
            self.pool.give(self.buffers.clone());
        }
    }
}

/// The little-endian u64 number `i` of a mapped buffer.
fn word(view: &[u8], i: usize) -> u64 {
    view.chunks_exact(8)
        .nth(i)
        .and_then(|bytes| bytes.try_into().ok())
        .map_or(0, u64::from_le_bytes)
}

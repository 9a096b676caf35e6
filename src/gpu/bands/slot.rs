//! The buffers of one dispatch under way: two of these take turns.

use std::sync::Arc;

use super::super::GpuError;
use super::super::device::Gpu;
use super::super::pipeline::Pipeline;
use super::assembly::Assembly;
use super::buffers::{BufferPool, PixelBuffers};
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
    clock: Option<Clock>,
    pending: Option<(wgpu::SubmissionIndex, Rectangle, partial::Layout)>,
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
        let dispatch = Dispatch {
            first: [rectangle.columns.start, rectangle.band.end - 1],
            size: [columns, rows],
            zero: 0,
            room: layout.room,
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
        let timestamp_writes = self
            .clock
            .as_ref()
            .map(|clock| wgpu::ComputePassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: Some(0),
                end_of_pass_write_index: Some(1),
            });
        if layout.counter > 0 {
            encoder.clear_buffer(&self.buffers.pixels, 0, Some(layout.counter));
        }
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("plumb"),
                timestamp_writes,
            });
            pass.set_pipeline(&pipeline.pipeline);
            pass.set_bind_group(0, &self.bind_group, &[]);
            let groups = [pitch / form.across, rows].map(|n| n.div_ceil(WORKGROUP));
            pass.dispatch_workgroups(groups[0], groups[1], 1);
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
            encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
            encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.staging, 0, 16);
        }
        let index = gpu.submit(encoder);
        staging.map_async(wgpu::MapMode::Read, ..bytes, |_| ());
        if let Some(clock) = &self.clock {
            clock.staging.map_async(wgpu::MapMode::Read, .., |_| ());
        }
        self.pending = Some((index, rectangle, layout));
        self.is_clean = false;
    }

    /// Waits for the dispatch and takes its pixels; returns how many there were, and the seconds that the kernel took:
    /// by the device's clock where it has one, else as waited for.
    pub(super) fn collect(
        &mut self,
        gpu: &Gpu,
        assembly: &mut Assembly,
        watch: &mut Stopwatch,
    ) -> Result<(u64, f64), GpuError> {
        let Some((index, rectangle, layout)) = self.pending.take() else {
            return Ok((0, 0.0));
        };
        gpu.wait(index)?;
        let waited = watch.lap(Phase::Wait);
        let kernel = match &self.clock {
            Some(clock) => {
                let view = clock
                    .staging
                    .get_mapped_range(..)
                    .map_err(|error| gpu.lost(&error))?;
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
        let view = self
            .buffers
            .staging
            .get_mapped_range(..layout.bytes)
            .map_err(|error| gpu.lost(&error))?;
        assembly.take(&rectangle, &layout, &view);
        drop(view);
        self.buffers.staging.unmap();
        self.is_clean = true;
        Ok((pixels, kernel))
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

//! Runs a shader over rows of a picture, one dispatch after the other, and hands on what it wrote.
//!
//! For the shaders that only this report has. They share `gpu`'s uniform [`Dispatch`] and nothing else with
//! `gpu::bands`, which does much more: overlapping, assembling, verdicts.

use std::ops::Range;
use std::time::Instant;

use bytemuck::Zeroable;

use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::shader::constants::WORKGROUP;
use crate::shader::records::Dispatch;

/// Pixels of the first dispatch, whose speed is not known yet.
const FIRST: u64 = 1 << 16;
/// Most pixels of one.
const MOST: u64 = 1 << 20;
/// A dispatch is made to take about so many seconds.
const TARGET: f64 = 0.15;

/// A shader that writes `pixel_bytes` for each pixel of a rectangle, with what its dispatches need.
pub struct Runner<'a> {
    gpu: &'a Gpu,
    pipeline: &'a wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    dispatch: wgpu::Buffer,
    pixels: wgpu::Buffer,
    staging: wgpu::Buffer,
    clock: Option<[wgpu::Buffer; 2]>,
    queries: Option<wgpu::QuerySet>,
    pixel_bytes: u64,
    width: u32,
    most: u64,
}

impl<'a> Runner<'a> {
    /// For pictures that are `width` pixels wide. `bind` binds the dispatch's record and the pixels that it is given,
    /// with what else the shader reads.
    pub fn new(
        gpu: &'a Gpu,
        pipeline: &'a wgpu::ComputePipeline,
        pixel_bytes: u64,
        width: u32,
        bind: impl FnOnce(&wgpu::Buffer, &wgpu::Buffer) -> wgpu::BindGroup,
    ) -> Self {
        use wgpu::BufferUsages as Usage;
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let most = MOST.max(u64::from(width));
        let dispatch = buffer(
            "dispatch",
            size_of::<Dispatch>() as u64,
            Usage::UNIFORM | Usage::COPY_DST,
        );
        let pixels = buffer(
            "pixels",
            most * pixel_bytes,
            Usage::STORAGE | Usage::COPY_SRC,
        );
        let read = Usage::MAP_READ | Usage::COPY_DST;
        let staging = buffer("staging", most * pixel_bytes, read);
        let clock = gpu.timestamps.then(|| {
            let resolved = Usage::QUERY_RESOLVE | Usage::COPY_SRC;
            [
                buffer("clock", 16, resolved),
                buffer("clock staging", 16, read),
            ]
        });
        let queries = gpu.timestamps.then(|| {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("clock"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            })
        });
        let group = bind(&dispatch, &pixels);
        Self {
            gpu,
            pipeline,
            group,
            dispatch,
            pixels,
            staging,
            clock,
            queries,
            pixel_bytes,
            width,
            most,
        }
    }

    /// Runs over all rows below `height`, from the top, and hands on each piece, its top row first. Returns the seconds
    /// that the dispatches took: by the device's clock where it has one, else as waited for.
    pub fn frame(&self, height: u32, mut take: impl FnMut(&[u8])) -> Result<f64, GpuError> {
        let width = u64::from(self.width);
        let mut pixels = FIRST;
        let mut kernel = 0.0;
        let mut end = height;
        while end > 0 {
            let rows = (pixels.min(self.most) / width).clamp(1, u64::from(end)) as u32;
            let seconds = self.rows(end - rows..end, &mut take)?;
            kernel += seconds;
            end -= rows;
            let ideal = (f64::from(rows) * width as f64 * TARGET / seconds.max(1e-6)) as u64;
            pixels = ideal.clamp(pixels / 4, pixels * 4).max(1);
        }
        Ok(kernel)
    }

    /// Runs over these rows, in rising order, and hands on each by itself, four words a pixel.
    pub fn picked(&self, rows: &[u32], mut take: impl FnMut(&[[u32; 4]])) -> Result<(), GpuError> {
        // A workgroup is as wide as it is high, so rows that stand together are run together.
        let fitting = (self.most / u64::from(self.width)).clamp(1, u64::from(WORKGROUP)) as usize;
        for together in rows.chunk_by(|a, b| a + 1 == *b) {
            for rows in together.chunks(fitting) {
                let [first, last] = [rows[0], rows[rows.len() - 1]];
                self.rows(first..last + 1, |bytes| {
                    let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(bytes);
                    // The top row comes first.
                    words.chunks(self.width as usize).rev().for_each(&mut take);
                })?;
            }
        }
        Ok(())
    }

    /// Runs over these rows, which are few enough for one dispatch.
    fn rows(&self, rows: Range<u32>, mut take: impl FnMut(&[u8])) -> Result<f64, GpuError> {
        let gpu = self.gpu;
        let height = rows.end - rows.start;
        let bytes = u64::from(height) * u64::from(self.width) * self.pixel_bytes;
        let dispatch = Dispatch {
            first: [0, rows.end - 1],
            size: [self.width, height],
            ..Dispatch::zeroed()
        };
        gpu.queue
            .write_buffer(&self.dispatch, 0, bytemuck::bytes_of(&dispatch));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let timestamp_writes =
                self.queries
                    .as_ref()
                    .map(|query_set| wgpu::ComputePassTimestampWrites {
                        query_set,
                        beginning_of_pass_write_index: Some(0),
                        end_of_pass_write_index: Some(1),
                    });
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("bench"),
                timestamp_writes,
            });
            pass.set_pipeline(self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(
                self.width.div_ceil(WORKGROUP),
                height.div_ceil(WORKGROUP),
                1,
            );
        }
        encoder.copy_buffer_to_buffer(&self.pixels, 0, &self.staging, 0, bytes);
        if let (Some([resolved, staging]), Some(queries)) = (&self.clock, &self.queries) {
            encoder.resolve_query_set(queries, 0..2, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, staging, 0, 16);
        }
        let start = Instant::now();
        let index = gpu.submit(encoder);
        self.staging.map_async(wgpu::MapMode::Read, ..bytes, |_| ());
        if let Some([_, staging]) = &self.clock {
            staging.map_async(wgpu::MapMode::Read, .., |_| ());
        }
        gpu.wait(index)?;
        let waited = start.elapsed().as_secs_f64();
        let mut ticks = None;
        if let Some([_, staging]) = &self.clock {
            let view = staging.get_mapped_range(..);
            let view = view.map_err(|error| gpu.lost(&error))?;
            ticks = bytemuck::pod_collect_to_vec::<u8, u64>(&view)
                .try_into()
                .ok();
            drop(view);
            staging.unmap();
        }
        let view = self.staging.get_mapped_range(..bytes);
        let view = view.map_err(|error| gpu.lost(&error))?;
        take(&view);
        drop(view);
        self.staging.unmap();
        Ok(ticks.map_or(waited, |[begin, end]: [u64; 2]| {
            end.saturating_sub(begin) as f64 * f64::from(gpu.queue.get_timestamp_period()) * 1e-9
        }))
    }
}

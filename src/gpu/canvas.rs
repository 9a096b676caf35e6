//! A picture that stays on the GPU, for a window that shows it: what [`bands`](super::bands) make is copied here where
//! it is made, and what the CPU decides is put into its place.

use wgpu::util::DeviceExt as _;

use super::GpuError;
use super::device::Gpu;
use crate::frame::{Band, DecidedBy};

const SCATTER: &str = include_str!("canvas.wgsl");
/// Invocations of a workgroup, as the shader has it.
const GROUP: u32 = 64;
/// Workgroups side by side: the others stand below, since a dispatch may have 65,535 in a row only.
const ACROSS: u32 = 1024;

/// A picture on the GPU: a word a pixel, rows from the top. Its bytes from the lowest up are red, green, blue, and the
/// [`DecidedBy`] that decided it, by number; 255 where the CPU has yet to decide.
#[derive(Debug)]
pub struct Canvas {
    /// The words; a storage buffer.
    pub pixels: wgpu::Buffer,
    /// Columns and rows.
    pub size: [u32; 2],
}

impl Canvas {
    /// The most pixels that a canvas can have here.
    pub fn most(gpu: &Gpu) -> u64 {
        let limits = gpu.device.limits();
        let bytes = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
        bytes / 4
    }

    /// A black picture of that size, of [`most`](Self::most) pixels at most.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let pixels = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("canvas"),
            size: 4 * u64::from(size[0]) * u64::from(size[1]),
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_DST
                | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        gpu.check()?;
        Ok(Self { pixels, size })
    }

    /// The word of a pixel with these bytes, decided by that.
    pub fn word([r, g, b]: [u8; 3], by: DecidedBy) -> u32 {
        u32::from_le_bytes([r, g, b, by as u8])
    }

    /// Takes over `size` pixels, whose rows are `pitch` words long, from a byte of a buffer on. They go to column
    /// `at[0]` of the rows below row `at[1]`, which is counted from the bottom, as everywhere else.
    pub(super) fn take(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (from, first): (&wgpu::Buffer, u64),
        pitch: u32,
        at: [u32; 2],
        size: [u32; 2],
    ) {
        let [width, height] = self.size;
        let [columns, rows] = size;
        let place =
            |row| 4 * (u64::from(height - at[1] + row) * u64::from(width) + u64::from(at[0]));
        let mut copy = |row: u32, words: u64| {
            let from_byte = first + 4 * u64::from(row) * u64::from(pitch);
            encoder.copy_buffer_to_buffer(from, from_byte, &self.pixels, place(row), 4 * words);
        };
        if [pitch, columns] == [width, width] {
            copy(0, u64::from(rows) * u64::from(width));
        } else {
            (0..rows).for_each(|row| copy(row, u64::from(columns)));
        }
    }
}

/// Puts pixels that the CPU decided into canvases.
#[derive(Debug)]
pub struct Scatter {
    pipeline: wgpu::ComputePipeline,
}

impl Scatter {
    /// Compiles its shader.
    ///
    /// # Errors
    /// If the shader does not compile.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let pipeline = gpu.compile(SCATTER, "main")?;
        Ok(Self { pipeline })
    }

    /// Puts the pixels of a band that the CPU decided into their places: all of them, if the band does not tell.
    ///
    /// # Errors
    /// If the device has no memory for them.
    pub fn put(&self, gpu: &Gpu, canvas: &Canvas, band: &Band) -> Result<(), GpuError> {
        let [width, height] = canvas.size;
        let first = u64::from(height - band.rows.end) * u64::from(width);
        let verdict = |i: usize| match &band.verdicts {
            Some(verdicts) => verdicts[i],
            None => DecidedBy::Single,
        };
        let records = band.rgb.as_chunks::<3>().0.iter().enumerate();
        let words: Vec<[u32; 2]> = records
            .map(|(i, bytes)| (i, bytes, verdict(i)))
            .filter(|(.., by)| *by != DecidedBy::Gpu)
            .map(|(i, bytes, by)| [(first + i as u64) as u32, Canvas::word(*bytes, by)])
            .collect();
        // A list may be as long as a buffer, half as many records as there are pixels.
        for words in words.chunks(Canvas::most(gpu) as usize / 2) {
            self.list(gpu, canvas, words);
        }
        gpu.check()
    }

    fn list(&self, gpu: &Gpu, canvas: &Canvas, words: &[[u32; 2]]) {
        let list = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("decided pixels"),
                contents: bytemuck::cast_slice(words),
                usage: wgpu::BufferUsages::STORAGE,
            });
        let group = gpu.bind(&self.pipeline, &[(0, &list), (1, &canvas.pixels)]);
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            let groups = (words.len() as u32).div_ceil(GROUP);
            pass.dispatch_workgroups(groups.min(ACROSS), groups.div_ceil(ACROSS), 1);
        }
        gpu.submit(encoder);
    }
}

//! The large buffers of dispatches: what the device writes pixels to, and the copy that the host reads. A device keeps
//! them from one picture to the next, and the first ones are made while the shader compiles: a driver takes up to
//! twenty milliseconds for them.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The buffers of a dispatch.
#[derive(Debug, Clone)]
pub(super) struct PixelBuffers {
    /// What the device writes.
    pub(super) pixels: wgpu::Buffer,
    /// What the host reads.
    pub(super) staging: wgpu::Buffer,
}

/// A device's buffers that are not in use.
#[derive(Debug, Default)]
pub(crate) struct BufferPool(Mutex<Vec<PixelBuffers>>);

/// So many pairs are kept: two of a dispatch each, for two pictures at a time.
const KEPT: usize = 4;

impl BufferPool {
    /// A pair of at least so many bytes each.
    pub(super) fn take(&self, device: &wgpu::Device, bytes: u64) -> PixelBuffers {
        let mut spare = self.lock();
        let fitting = spare.iter().enumerate();
        let fitting = fitting.filter(|(_, pair)| pair.pixels.size() >= bytes);
        let smallest = fitting.min_by_key(|(_, pair)| pair.pixels.size());
        let Some((place, _)) = smallest else {
            drop(spare);
            return PixelBuffers::new(device, bytes);
        };
        spare.swap_remove(place)
    }

    /// Keeps a pair that nothing is pending on.
    pub(super) fn give(&self, pair: PixelBuffers) {
        let mut spare = self.lock();
        spare.push(pair);
        if spare.len() > KEPT {
            spare.sort_unstable_by_key(|pair| std::cmp::Reverse(pair.pixels.size()));
            spare.truncate(KEPT);
        }
    }

    /// Sees to it that there are so many pairs of at least so many bytes, and that the system has given the memory:
    /// `submit` hands the device what touches it.
    pub(super) fn prepare(
        &self,
        device: &wgpu::Device,
        submit: impl Fn(wgpu::CommandEncoder),
        pairs: usize,
        bytes: u64,
    ) {
        let large = |pair: &&PixelBuffers| pair.pixels.size() >= bytes;
        let missing = pairs.saturating_sub(self.lock().iter().filter(large).count());
        for _ in 0..missing {
            let pair = PixelBuffers::new(device, bytes);
            let descriptor = wgpu::CommandEncoderDescriptor::default();
            let mut encoder = device.create_command_encoder(&descriptor);
            encoder.clear_buffer(&pair.pixels, 0, None);
            encoder.clear_buffer(&pair.staging, 0, None);
            submit(encoder);
            self.give(pair);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<PixelBuffers>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl PixelBuffers {
    fn new(device: &wgpu::Device, bytes: u64) -> Self {
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT),
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let written = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        Self {
            pixels: buffer("pixels", written),
            staging: buffer("staging", wgpu::BufferUsages::MAP_READ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::adapters;

    /// Needs an adapter, and fails without one.
    #[test]
    fn buffers_are_used_again() {
        let gpu = adapters::open(None).unwrap();
        let pool = BufferPool::default();
        let prepare = |pairs, bytes| {
            pool.prepare(
                &gpu.device,
                |encoder| {
                    gpu.submit(encoder);
                },
                pairs,
                bytes,
            );
        };
        prepare(2, 1000);
        prepare(2, 900);
        assert_eq!(pool.lock().len(), 2, "those that are there will do");
        let small = pool.take(&gpu.device, 500);
        let large = pool.take(&gpu.device, 2000);
        assert_eq!((small.pixels.size(), large.staging.size()), (1000, 2000));
        pool.give(small);
        (0..KEPT).for_each(|_| pool.give(large.clone()));
        let kept: Vec<u64> = pool.lock().iter().map(|pair| pair.pixels.size()).collect();
        assert_eq!(kept, [2000; KEPT]);
        assert!(gpu.check().is_ok());
    }
}

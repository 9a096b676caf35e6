//! How pictures come to where the window draws them from.
//!
//! Between the worker, which renders them, and the screen. Where one device does both, a picture is made in its place
//! and never leaves the device. Where the window has a device of its own (`gpu::adapters::open_beside`), the picture's
//! bytes, which the host has anyway, are handed to that one once the picture is done.

use std::sync::Arc;

use crate::frame::{Band, DecidedBy};
use crate::gpu::GpuError;
use crate::gpu::canvas::{Canvas, Scatter};
use crate::gpu::device::Gpu;

/// Where canvases come from.
#[derive(Debug)]
pub(super) enum Canvases {
    /// Pictures are made in their places.
    InPlace {
        gpu: Arc<Gpu>,
        scatter: Scatter,
        /// Canvases to be used again once nobody shows them.
        kept: Vec<Arc<Canvas>>,
    },
    /// Pictures are handed over to this device.
    HandedOver { window: Arc<Gpu> },
}

impl Canvases {
    /// For pictures that are rendered on the one device and drawn on the other, which may be the same.
    ///
    /// # Errors
    /// If a shader does not compile.
    pub(super) fn new(gpu: &Arc<Gpu>, window: &Arc<Gpu>) -> Result<Self, GpuError> {
        if Arc::ptr_eq(gpu, window) {
            return Ok(Self::InPlace {
                gpu: Arc::clone(gpu),
                scatter: Scatter::new(gpu)?,
                kept: Vec::new(),
            });
        }
        Ok(Self::HandedOver {
            window: Arc::clone(window),
        })
    }

    /// The most pixels that a picture can have.
    pub(super) fn most(&self) -> u64 {
        match self {
            Self::InPlace { gpu, .. } => Canvas::most(gpu),
            Self::HandedOver { window } => Canvas::most(window),
        }
    }

    /// What a picture of this size is made on, where it is made in its place: a canvas that nobody shows.
    pub(super) fn begin(&mut self, size: [u32; 2]) -> Result<Option<Arc<Canvas>>, GpuError> {
        let Self::InPlace { gpu, kept, .. } = self else {
            return Ok(None);
        };
        // Canvases of another size are dropped, as they will not be used soon; those on the screen are kept.
        kept.retain(|canvas| canvas.size == size || Arc::strong_count(canvas) > 1);
        let mut free = kept.iter().filter(|canvas| canvas.size == size);
        if let Some(canvas) = free.find(|canvas| Arc::strong_count(canvas) == 1) {
            return Ok(Some(Arc::clone(canvas)));
        }
        let canvas = Arc::new(Canvas::new(gpu, size)?);
        kept.push(Arc::clone(&canvas));
        Ok(Some(canvas))
    }

    /// Takes a band that is finished.
    pub(super) fn put(&self, canvas: Option<&Canvas>, band: &Band) -> Result<(), GpuError> {
        match (self, canvas) {
            (Self::InPlace { gpu, scatter, .. }, Some(canvas)) => scatter.put(gpu, canvas, band),
            _ => Ok(()),
        }
    }

    /// The canvas of a picture that is done: the one that was begun, or another one of these bytes and what decided
    /// them, rows from the top.
    pub(super) fn end(
        &self,
        begun: Option<Arc<Canvas>>,
        size: [u32; 2],
        rgb: &[u8],
        verdicts: &[DecidedBy],
    ) -> Result<Arc<Canvas>, GpuError> {
        match (self, begun) {
            (_, Some(canvas)) => Ok(canvas),
            (Self::InPlace { gpu: device, .. } | Self::HandedOver { window: device }, None) => {
                let pixels = rgb.as_chunks::<3>().0.iter().zip(verdicts);
                let words: Vec<u32> = pixels
                    .map(|(bytes, by)| Canvas::word(*bytes, *by))
                    .collect();
                Ok(Arc::new(Canvas::of(device, size, &words)?))
            }
        }
    }
}

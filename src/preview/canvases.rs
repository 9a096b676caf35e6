//! How pictures come to where the window draws them from.
//!
//! Between the worker, which renders them, and the screen. Where one device does both, a picture is made in its place
//! and never leaves the device. Where the host draws the window ([`painter`](super::painter)), it has the bytes anyway.

use std::sync::Arc;

use crate::frame::Band;
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
    /// The host draws pictures from their bytes.
    OnHost,
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
        Ok(Self::OnHost)
    }

    /// The most pixels that a picture can have.
    pub(super) fn most(&self) -> u64 {
        match self {
            Self::InPlace { gpu, .. } => Canvas::most(gpu),
            Self::OnHost => u64::MAX,
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
}

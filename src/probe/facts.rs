//! The outcome of a pixel alone: for `plumb probe --json`, and for whoever asks for one pixel after the other.

use super::primary_ray::direction;
use super::why::ExactRay;
use super::{AskGpu, GpuVerdict, Probe, Unexplained};
use crate::cpu::camera::camera_getdir;
use crate::cpu::pixel::FirstHit;
use crate::frame::{Decided, PixelFault};
use crate::gpu::single::Single;
use crate::real::{Bounded, Undecided};

/// What there is to know of a pixel, in short. Colours are red, green, blue; 1 is full brightness where nothing else is
/// said.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// Column from the left, row from the bottom.
    pub pixel: [u32; 2],
    /// Where the ray through the pixel's middle starts, in world coordinates.
    pub viewpoint: [f64; 3],
    /// Where it meets the screen: the pixel's world point.
    pub world_point: [f64; 3],
    /// Its direction, of unit length.
    pub direction: [f64; 3],
    /// What that ray hits first, if anything; undecided where not even exact numbers tell.
    pub hit: Result<Option<FirstHit>, Undecided>,
    /// The value before quantising, the certified bytes and what decided them; or that a sample needs too many rays.
    pub decided: Result<Decided, PixelFault>,
    /// The value in f64, and how far off that may be: what the CPU tries first. None where it leaves open what the rays
    /// meet.
    pub enclosure: Option<[Bounded; 3]>,
    /// Whether the GPU is sure of the bytes, if it was asked.
    pub verdict: Option<GpuVerdict>,
    /// 255 times the value in the GPU's f32, and how far off that may be, if it was asked, and has a value: it has none
    /// of several samples.
    pub single: Option<Single>,
}

impl Probe<'_> {
    /// The outcome of pixel (x, y), counted from the bottom left. Where a sample needs too many rays, the GPU is not
    /// asked.
    ///
    /// # Errors
    /// [`Unexplained::NoSuchPixel`].
    pub fn facts(&self, [x, y]: [u32; 2], ask: AskGpu) -> Result<Facts, Unexplained> {
        self.check(x, y)?;
        let row = self.row(y);
        let sampling = self.sampling(row.as_deref(), x);
        let middle = [f64::from(x), f64::from(y)];
        let ray = camera_getdir(&self.exact_tracer.bounded().camera, middle[0], middle[1]);
        let decided = self.exact_tracer.trace(&self.limits, sampling, x, y);
        let ask = if decided.is_ok() {
            ask
        } else {
            AskGpu::Nothing
        };
        Ok(Facts {
            pixel: [x, y],
            viewpoint: self.scene.camera.viewpoint.to_array(),
            world_point: ExactRay::new(&self.scene.camera, middle[0], middle[1]).world_point(),
            direction: direction(&ray),
            hit: self.exact_tracer.first_hit(middle),
            decided,
            enclosure: self
                .exact_tracer
                .pixel_enclosure(&self.limits, sampling, x, y),
            verdict: (ask == AskGpu::ValueAndVerdict).then(|| self.verdict(x, y)),
            single: (ask != AskGpu::Nothing)
                .then(|| self.single(x, y))
                .flatten(),
        })
    }
}

//! A pixel from its samples: the notes' `make_pixel`, in the number types that it takes to be sure of it.

use std::sync::OnceLock;

use super::camera::camera_setpix;
use super::trace::{Fault, Limits, Unwatched, ray_trace};
use crate::frame::{Decided, PixelFault, Stage};
use crate::jitter::{self, Sampling};
use crate::prepare::{Prepared, View};
use crate::real::{Bounded, DoubleDouble, Real, V3};
use crate::scene::Scene;

/// The value of pixel (x, y), counted from the bottom left: the mean of its samples.
pub fn make_pixel<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    sampling: Sampling<'_>,
    x: u32,
    y: u32,
) -> Result<V3<R>, Fault> {
    let (px, py) = (f64::from(x), f64::from(y));
    let at = |[a, b]: [f64; 2]| {
        ray_trace(scene, limits, px + a, py + b, &mut Unwatched).map(|traced| traced.color)
    };
    let mut sum = V3::new(R::zero(), R::zero(), R::zero());
    let count = match sampling {
        Sampling::Once => return at([0.0, 0.0]),
        Sampling::Hash(samples) => {
            for sample in 0..samples {
                sum = sum + at(jitter::hash(x, y, sample))?;
            }
            samples
        }
        Sampling::Given(offsets) => {
            for offset in offsets {
                sum = sum + at(*offset)?;
            }
            offsets.len() as u32
        }
    };
    let n = R::exact(f64::from(count));
    Ok(V3::new(sum.x / n, sum.y / n, sum.z / n))
}

/// The scene on the CPU, in as many number types as it takes: f64 with error bounds decides nearly every pixel; where it
/// cannot, pairs of f64 do; and plain f64 where those overflow.
#[derive(Debug)]
pub struct Stages<'a> {
    scene: &'a Scene,
    view: View,
    bounded: Prepared<Bounded>,
    pairs: OnceLock<Prepared<DoubleDouble>>,
    plain: OnceLock<Prepared<f64>>,
}

impl<'a> Stages<'a> {
    /// Prepares the scene.
    pub fn new(scene: &'a Scene, view: View) -> Self {
        Self {
            scene,
            view,
            bounded: Prepared::new(scene, view),
            pairs: OnceLock::new(),
            plain: OnceLock::new(),
        }
    }

    /// Value and bytes of pixel (x, y).
    pub fn trace(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        x: u32,
        y: u32,
    ) -> Result<Decided, PixelFault> {
        let mut pixel = attempt(&self.bounded, limits, sampling, x, y);
        let mut stage = Stage::Bounded;
        if matches!(pixel, Err(Fault::Undecided)) {
            let prepare = || Prepared::new(self.scene, self.view);
            pixel = attempt(self.pairs.get_or_init(prepare), limits, sampling, x, y);
            stage = Stage::Pairs;
        }
        if matches!(pixel, Err(Fault::Undecided)) {
            let prepare = || Prepared::new(self.scene, self.view);
            pixel = attempt(self.plain.get_or_init(prepare), limits, sampling, x, y);
            stage = Stage::Presumed;
        }
        match pixel {
            Ok((value, bytes)) => Ok(Decided {
                value,
                bytes,
                stage,
            }),
            // Not a number even so: such a pixel stays black.
            Err(Fault::Undecided) => Ok(Decided {
                value: [0.0; 3],
                bytes: [0; 3],
                stage,
            }),
            Err(Fault::TooManyRays) => Err(PixelFault {
                x,
                y,
                max_rays: limits.max_rays,
            }),
        }
    }
}

fn attempt<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    sampling: Sampling<'_>,
    x: u32,
    y: u32,
) -> Result<([f32; 3], [u8; 3]), Fault> {
    let v = make_pixel(scene, limits, sampling, x, y)?;
    let bytes = camera_setpix(v)?;
    let v = v.approx();
    Ok(([v.x as f32, v.y as f32, v.z as f32], bytes))
}

//! A pixel from its samples: the notes' `make_pixel`, and whole bands of pixels on all cores.

use std::ops::Range;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::camera::camera_setpix;
use super::trace::{Fault, Limits, Unwatched, ray_trace};
use crate::frame::{Band, Pixel, PixelFault};
use crate::jitter::{self, Jitter, Sampling};
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
    ) -> Result<Pixel, PixelFault> {
        let mut pixel = attempt(&self.bounded, limits, sampling, x, y);
        if matches!(pixel, Err(Fault::Undecided)) {
            let prepare = || Prepared::new(self.scene, self.view);
            pixel = attempt(self.pairs.get_or_init(prepare), limits, sampling, x, y);
        }
        if matches!(pixel, Err(Fault::Undecided)) {
            let prepare = || Prepared::new(self.scene, self.view);
            pixel = attempt(self.plain.get_or_init(prepare), limits, sampling, x, y);
        }
        match pixel {
            Ok(pixel) => Ok(pixel),
            // Not a number even so: such a pixel stays black.
            Err(Fault::Undecided) => Ok(([0.0; 3], [0; 3])),
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
) -> Result<Pixel, Fault> {
    let v = make_pixel(scene, limits, sampling, x, y)?;
    let bytes = camera_setpix(v)?;
    let v = v.approx();
    Ok(([v.x as f32, v.y as f32, v.z as f32], bytes))
}

/// Traces a band on the CPU, pixels in parallel on the current thread pool.
pub fn make_band(
    scene: &Stages<'_>,
    limits: &Limits,
    jitter: &Jitter,
    width: u32,
    rows: Range<u32>,
    values: bool,
) -> Result<Band, PixelFault> {
    let width = width as usize;
    let pixels = width * (rows.end - rows.start) as usize;
    let mut rgb = vec![0; 3 * pixels];
    let mut floats = if values {
        vec![[0.0; 3]; pixels]
    } else {
        Vec::new()
    };
    // Pieces of rows, small enough to share out, large enough not to cost.
    let piece = (pixels / (8 * rayon::current_num_threads()))
        .clamp(64, 8192)
        .min(width);
    let top = rows.end - 1;
    // Beside each line of bytes its line of values, or nothing.
    let value_lines: Vec<Option<&mut [[f32; 3]]>> =
        split(values.then_some(&mut floats[..]), width, rows.len());
    rgb.par_chunks_mut(3 * width)
        .zip(value_lines)
        .enumerate()
        .try_for_each(|(line, (bytes, values))| {
            let y = top - line as u32;
            let offsets = jitter.row(y);
            let pieces = split(values, piece, width.div_ceil(piece));
            bytes
                .par_chunks_mut(3 * piece)
                .zip(pieces)
                .enumerate()
                .try_for_each(|(k, (bytes, mut values))| {
                    for (i, pixel) in bytes.chunks_exact_mut(3).enumerate() {
                        let x = k * piece + i;
                        let sampling = jitter.pixel(offsets.as_deref(), width, x);
                        let (value, three) = scene.trace(limits, sampling, x as u32, y)?;
                        pixel.copy_from_slice(&three);
                        if let Some(values) = &mut values {
                            values[i] = value;
                        }
                    }
                    Ok(())
                })
        })?;
    Ok(Band {
        rows,
        rgb,
        values: values.then_some(floats),
    })
}

/// Pieces of `size`, or as many nothings.
fn split<T>(values: Option<&mut [T]>, size: usize, count: usize) -> Vec<Option<&mut [T]>> {
    match values {
        Some(values) => values.chunks_mut(size).map(Some).collect(),
        None => (0..count).map(|_| None).collect(),
    }
}

//! A pixel explained, from its rays to its bytes, by the reference tracer in f64: for `plumb probe` and for the
//! inspector of the preview.
//!
//! Stands beside the flow: it renders nothing, and takes what it tells from the tracers. A [`Probe`] is made once for a
//! scene and asked for many pixels: [`Probe::write`] explains one at length (`primary_ray` the ray from the viewpoint
//! and what every object answered, with `why` in exact arithmetic; `tree` the rays and lights; `verdict` what the GPU
//! says), [`Probe::facts`] tells the outcome alone.
//!
//! A probe borrows its scene. A thread that answers for many scenes holds each in an `Arc` of its own, and has a probe
//! beside it for as long as questions are about that scene.

mod answer;
pub mod digits;
mod explain;
mod facts;
mod primary_ray;
mod quadric;
mod tree;
mod verdict;
mod why;

#[cfg(test)]
mod tests;

use std::cell::{OnceCell, RefCell};
use std::io::{self, Write};

use crate::cpu::pixel::ExactTracer;
use crate::cpu::trace::Limits;
use crate::frame::PixelFault;
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::gpu::single::{Single, SinglePipeline};
use crate::jitter::{Jitter, Sampling};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::shader::pack::Packed;

pub use facts::Facts;
pub use verdict::GpuVerdict;

/// What is shown of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Everything: misses of more than 50 objects, more than 200 rays or samples, each of more than 50 lights.
    pub all: bool,
    /// Of several samples: the rays of this one, counted from 0, if there are so many.
    pub sample: Option<u32>,
    /// What the GPU is asked for.
    pub gpu: AskGpu,
}

/// What the GPU is asked for, beside what the CPU has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AskGpu {
    /// Nothing.
    #[default]
    Nothing,
    /// What it has before it quantises, and how far off that may be: one invocation, of a shader that is compiled when
    /// the first pixel is asked for.
    Value,
    /// That, and whether it is sure of the bytes: for this the whole row is rendered, with a shader compiled for it.
    ValueAndVerdict,
}

/// Why there is no explanation of a pixel, or not all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unexplained {
    /// The picture has no such pixel.
    #[error("there is no pixel ({x}, {y})")]
    NoSuchPixel {
        /// Column, from the left.
        x: u32,
        /// Row, from the bottom.
        y: u32,
    },
    /// A sample needs more rays than allowed.
    #[error(transparent)]
    TooManyRays(#[from] PixelFault),
    /// A number that f64 does not have.
    #[error("pixel ({x}, {y}) is out of f64's range")]
    OutOfRange {
        /// Column, from the left.
        x: u32,
        /// Row, from the bottom.
        y: u32,
    },
}

/// How an explanation ends: if not in a fault of writing, perhaps in one of the tracer's, after what could be told.
pub type Ended = io::Result<Result<(), Unexplained>>;

/// A scene made ready for questions about its pixels.
///
/// Scenes are prepared when it is made, and in plain f64, as people read numbers, for the first pixel that is explained
/// at length. It goes to another thread, but is not asked by two at a time.
#[derive(Debug)]
pub struct Probe<'a> {
    scene: &'a Scene,
    settings: Settings,
    limits: Limits,
    gpu: Result<&'a Gpu, &'a GpuError>,
    exact_tracer: ExactTracer<'a>,
    jitter: RefCell<Rows>,
    single: OnceCell<Option<SinglePipeline>>,
}

/// How pixels are sampled, in the rows below `end`.
#[derive(Debug)]
struct Rows {
    jitter: Jitter,
    end: u32,
}

impl<'a> Probe<'a> {
    /// For `scene`, rendered as `settings` say, certified; what they say of rows, threads and the tracer does not
    /// matter. `gpu` is the device that is asked, or why there is none.
    pub fn new(scene: &'a Scene, settings: &Settings, gpu: Result<&'a Gpu, &'a GpuError>) -> Self {
        Self {
            scene,
            limits: settings.sample_limits(),
            settings: settings.clone(),
            gpu,
            exact_tracer: ExactTracer::new(scene, settings.view()),
            jitter: RefCell::new(Rows {
                jitter: settings.sampling(scene.camera.pixeldim[0], 0),
                end: 0,
            }),
            single: OnceCell::new(),
        }
    }

    /// Explains pixel (x, y), counted from the bottom left, of the scene that is called `name`: as text for people, in
    /// lines.
    ///
    /// # Errors
    /// When `to` fails; and inside, when not all can be told.
    pub fn write(
        &self,
        name: &str,
        [x, y]: [u32; 2],
        options: Options,
        to: &mut dyn Write,
    ) -> Ended {
        match self.check(x, y) {
            Ok(()) => explain::write(self, name, [x, y], options, to),
            Err(outside) => Ok(Err(outside)),
        }
    }

    /// Whether there is such a pixel.
    fn check(&self, x: u32, y: u32) -> Result<(), Unexplained> {
        let [width, height] = self.scene.camera.pixeldim;
        if x < width && y < height {
            Ok(())
        } else {
            Err(Unexplained::NoSuchPixel { x, y })
        }
    }

    /// The offsets of the samples of row `y`, where they are not computed pixel by pixel.
    fn row(&self, y: u32) -> Option<Vec<[f64; 2]>> {
        let mut rows = self.jitter.borrow_mut();
        if y >= rows.end {
            // The course's offsets are counted from the bottom row: no farther than asked for at first, then twice as
            // far each time, so that rows one after the other are not counted again for each.
            let [width, height] = self.scene.camera.pixeldim;
            rows.end = rows.end.saturating_mul(2).min(height).max(y + 1);
            rows.jitter = self.settings.sampling(width, rows.end);
        }
        rows.jitter.row(y)
    }

    /// The samples of pixel `x` in a row with these offsets.
    fn sampling<'r>(&self, row: Option<&'r [[f64; 2]]>, x: u32) -> Sampling<'r> {
        let width = self.scene.camera.pixeldim[0];
        let rows = self.jitter.borrow();
        rows.jitter.pixel(row, width as usize, x as usize)
    }

    /// Whether the GPU is sure of pixel (x, y).
    fn verdict(&self, x: u32, y: u32) -> GpuVerdict {
        verdict::ask(self.scene, &self.settings, self.gpu, x, y)
    }

    /// What the GPU has before it quantises, and how far off it may be; of a single sample. None where it has no value,
    /// or cannot be asked.
    fn single(&self, x: u32, y: u32) -> Option<Single> {
        let gpu = self.gpu.ok()?;
        let compiled = self.single.get_or_init(|| {
            if self.settings.supersampling().is_some() {
                return None;
            }
            let packed = Packed::prepared(self.exact_tracer.bounded(), self.scene, &self.settings);
            if packed.unprovable.is_some() {
                return None;
            }
            SinglePipeline::new(gpu, &packed, &self.settings)
                .ok()
                .flatten()
        });
        compiled.as_ref()?.run(gpu, [x, y]).ok().flatten()
    }
}

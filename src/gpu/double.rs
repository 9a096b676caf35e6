//! The stage behind f32 on a GPU that has f64: the shader that takes pixels from a list. It is made while the first bands
//! are rendered without it.

use std::sync::OnceLock;

use super::GpuError;
use super::device::Gpu;
use super::pipeline::Pipeline;
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::format::Double as F64;
use crate::shader::pack::Packed;

/// The stage, whether it is there yet or not.
#[derive(Debug, Default)]
pub struct DoubleStage {
    /// With the number of pixels that it is tried with.
    pipeline: OnceLock<(Pipeline, u32)>,
    worth: OnceLock<bool>,
}

/// Samples of a dispatch that are taken in f64 until it is known whether that is worth its time: of software drivers so
/// many that it takes no second, of others so many that they have work for most of their units.
const TRIED_IN_SOFTWARE: u32 = 1 << 10;
/// See [`TRIED_IN_SOFTWARE`].
const TRIED: u32 = 1 << 14;
/// As many pixels are taken at least: of several samples most miss a few.
const TRIED_PIXELS: u32 = 64;

/// Whether a scene can have this stage: not where its bounds cannot be relied on, where pairs of f64 tell that an object
/// is never seen and f64 does not, or where objects are so many that pairs have them on demand.
pub fn can_be(single: &Packed, double: &Packed<F64>) -> bool {
    double.unprovable.is_none()
        && single.kinds == double.kinds
        && single.counts() == double.counts()
}

impl DoubleStage {
    /// Makes it, from a scene in f32 and in f64 and the features of the picture's shader, which lists pixels.
    ///
    /// # Errors
    /// What the device says; there is no such stage then.
    pub fn make(
        &self,
        gpu: &Gpu,
        (single, double): (&Packed, &Packed<F64>),
        features: FeatureSet,
    ) -> Result<(), GpuError> {
        if !can_be(single, double) {
            return Ok(());
        }
        let features = features.for_the_list();
        let wgsl = compose(double, &features, Entry::Listed);
        let pipeline = Pipeline::new(gpu, double, &features, &wgsl)?;
        let samples = if gpu.software {
            TRIED_IN_SOFTWARE
        } else {
            TRIED
        };
        self.set(
            pipeline,
            (samples / features.samples.max(1)).max(TRIED_PIXELS),
        );
        Ok(())
    }

    /// Has its pipeline made already, which is tried with so many pixels of a dispatch.
    pub fn set(&self, pipeline: Pipeline, tried: u32) {
        // It is made once.
        let _ = self.pipeline.set((pipeline, tried));
    }

    /// Its pipeline, once that is there, and how many pixels of a dispatch it is to take at most; none where it is not
    /// worth its time.
    pub fn pipeline(&self) -> Option<(&Pipeline, u32)> {
        let (pipeline, tried) = self.pipeline.get()?;
        match self.worth.get() {
            None => Some((pipeline, *tried)),
            Some(true) => Some((pipeline, u32::MAX)),
            Some(false) => None,
        }
    }

    /// Takes all pixels from now on, or leaves all to the CPU, which decides them in less time.
    pub fn judge(&self, is_worth: bool) {
        // What was found first counts.
        let _ = self.worth.set(is_worth);
    }
}

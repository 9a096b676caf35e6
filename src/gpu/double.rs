//! The stage behind f32 on a GPU that has f64: the shader that takes pixels from a list. It is made while the first
//! bands are rendered without it.

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

/// Whether a scene can have this stage: not where its bounds cannot be relied on, where pairs of f64 tell that an
/// object is never seen and f64 does not, or where objects are so many that pairs have them on demand.
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::cpu::pixel::ExactTracer;
    use crate::scene::parse;
    use crate::settings::Settings;

    /// Objects that pairs of f64 prepare on demand are in no buffer, and the lists that name them are those of f32:
    /// what is packed of them has no stage in f64. `Packed::in_f64` prepares them all.
    #[test]
    fn many_objects_have_no_stage() {
        let mut text = "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
            material m { ambient 3 1 2 }"
            .to_owned();
        for i in 0..3000 {
            let (x, y) = (f64::from(i % 60) / 7.5, f64::from(i / 60) / 8.0);
            text += &format!("\nsphere s {{ material m center {x} {y} -2 radius 0.05 }}");
        }
        let scene = parse("many", text.as_bytes(), Path::new(".")).unwrap();
        let settings = Settings::default();
        let tracer = ExactTracer::new(&scene, settings.view());
        let single = Packed::new(&scene, &settings);
        assert!(single.screen_grid.is_some() && !single.spheres.is_empty());
        let on_demand = Packed::<F64>::rounded(tracer.pairs(), &scene, &settings);
        assert!(!can_be(&single, &on_demand));
        // Prepared as f32's are, they are the same.
        let whole = Packed::in_f64(&scene, &settings);
        assert_eq!(single.counts(), whole.counts());
        assert!(can_be(&single, &whole));
    }
}

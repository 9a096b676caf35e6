//! What primary rays meet on the GPU, and how far away: the shaders of pictures, with another entry point.
//!
//! Every function of theirs is as it is where a picture is rendered.

use super::dispatch::Runner;
use super::truth::{FirstObject, PixelHit};
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::Pipeline;
use crate::real::rational::two_to;
use crate::settings::Settings;
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::pack::Packed;

/// The shader of a picture with the other entry point, and its features; none where there is nothing to hit.
#[must_use]
pub fn wgsl(packed: &Packed, settings: &Settings, lanes: u32) -> Option<(String, FeatureSet)> {
    let mut features = FeatureSet::new(packed, settings, lanes);
    if !features.any_object() {
        return None;
    }
    // Pixels are four words then; the bounds of certified pixels stay in the text.
    features.values = true;
    let wgsl = compose(packed, &features, Entry::FirstHit);
    Some((wgsl, features))
}

/// What the pixels of these rows see, row by row, from the left.
///
/// # Errors
/// As any rendering on the GPU.
pub fn hits(
    gpu: &Gpu,
    packed: &Packed,
    settings: &Settings,
    width: u32,
    rows: &[u32],
) -> Result<Vec<PixelHit>, GpuError> {
    let Some((wgsl, features)) = wgsl(packed, settings, gpu.lanes) else {
        let nothing = PixelHit {
            object: FirstObject::Nothing,
            t: 0.0,
        };
        return Ok(vec![nothing; rows.len() * width as usize]);
    };
    let pipeline = Pipeline::new(gpu, packed, &features, &wgsl)?;
    let bind = |dispatch: &_, pixels: &_| pipeline.bind(gpu, dispatch, pixels, None);
    let runner = Runner::new(gpu, &pipeline.pipeline, 16, width, bind);
    let unit = two_to(packed.scale);
    let mut seen = Vec::with_capacity(rows.len() * width as usize);
    runner.picked(rows, |pixels| {
        seen.extend(pixels.iter().map(|&[t, object, ..]| {
            PixelHit {
                object: object
                    .checked_sub(1)
                    .map_or(FirstObject::Nothing, FirstObject::Object),
                t: f64::from(f32::from_bits(t)) * unit,
            }
        }));
    })?;
    Ok(seen)
}

//! Whether the GPU is sure of a single pixel.

use std::fmt;

use crate::certify::DecidedBy;
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::render::{Backend, Live, Precision, Report, Settings, render_live};
use crate::scene::Scene;

/// What the GPU says of a pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum GpuVerdict {
    /// It is sure of these bytes.
    Sure([u8; 3]),
    /// It leaves the pixel to the CPU.
    Doubtful,
    /// It cannot be asked.
    Unknown(String),
}

impl fmt::Display for GpuVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sure([r, g, b]) => write!(f, "sure: {r} {g} {b}"),
            Self::Doubtful => f.write_str("in doubt"),
            Self::Unknown(why) => f.write_str(why),
        }
    }
}

/// Asks it for the whole row, certified: what is rendered is what is told.
pub(super) fn ask(
    scene: &Scene,
    settings: &Settings,
    gpu: Result<&Gpu, &GpuError>,
    x: u32,
    y: u32,
) -> GpuVerdict {
    let live = match gpu {
        Ok(gpu) => Live::on(gpu),
        Err(error) => return GpuVerdict::Unknown(error.to_string()),
    };
    let settings = Settings {
        rows: Some(y..y + 1),
        backend: Backend::Gpu,
        precision: Precision::Certified,
        values: false,
        verdicts: true,
        ..settings.clone()
    };
    let x = x as usize;
    let mut verdict = None;
    let rendered = render_live(scene, &settings, &live, &mut |band| {
        let by = band.verdicts.as_ref().and_then(|verdicts| verdicts.get(x));
        let bytes = band.rgb.as_chunks::<3>().0.get(x);
        verdict = by.copied().zip(bytes.copied());
        Ok(())
    });
    let revoked = match rendered {
        Err(error) => return GpuVerdict::Unknown(error.to_string()),
        Ok(Report { revoked, .. }) => revoked,
    };
    match (revoked, verdict) {
        (Some(revoked), _) => GpuVerdict::Unknown(format!("not trusted: {revoked}")),
        (None, Some((DecidedBy::Gpu, bytes))) => GpuVerdict::Sure(bytes),
        (None, _) => GpuVerdict::Doubtful,
    }
}

//! What the GPU says of a single pixel, for `probe`.

use std::fmt;

use plumb::certify::Stage;
use plumb::gpu::device;
use plumb::gpu::pack::Packed;
use plumb::gpu::single::{Single, single};
use plumb::render::{Backend, Report, Settings, render};
use plumb::scene::Scene;

use super::cache;

/// What the GPU says of a pixel.
pub(crate) enum Verdict {
    /// It is sure of these bytes.
    Sure([u8; 3]),
    /// It leaves the pixel to the CPU.
    Doubtful,
    /// It cannot be asked.
    Unknown(String),
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sure([r, g, b]) => write!(f, "sure: {r} {g} {b}"),
            Self::Doubtful => f.write_str("in doubt"),
            Self::Unknown(why) => f.write_str(why),
        }
    }
}

/// What it has before it quantises, with bounds; None where it has no value, or cannot be asked.
pub(crate) fn value(scene: &Scene, settings: &Settings, x: u32, y: u32) -> Option<Single> {
    let packed = Packed::new(scene, settings);
    if packed.unprovable.is_some() {
        return None;
    }
    let gpu = device::open(settings.adapter.as_deref()).ok()?;
    single(&gpu, &packed, settings, [x, y]).ok().flatten()
}

/// Asks it for the whole row, certified: what is rendered is what is told.
pub(crate) fn ask(scene: &Scene, settings: &Settings, x: u32, y: u32) -> Verdict {
    let settings = Settings {
        rows: Some(y..y + 1),
        backend: Backend::Gpu,
        verdicts: true,
        cache: cache::folder(),
        ..settings.clone()
    };
    let x = x as usize;
    let mut verdict = None;
    let rendered = render(scene, &settings, &mut |band| {
        let stage = band.verdicts.as_ref().and_then(|stages| stages.get(x));
        let bytes = band.rgb.as_chunks::<3>().0.get(x);
        verdict = stage.copied().zip(bytes.copied());
        Ok(())
    });
    let revoked = match rendered {
        Err(error) => return Verdict::Unknown(error.to_string()),
        Ok(Report { revoked, .. }) => revoked,
    };
    match (revoked, verdict) {
        (Some(revoked), _) => Verdict::Unknown(format!("not trusted: {revoked}")),
        (None, Some((Stage::Gpu, bytes))) => Verdict::Sure(bytes),
        (None, _) => Verdict::Doubtful,
    }
}

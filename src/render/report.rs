//! How a rendering went: put together at its end, from what was asked for, what was found, and where the time went.

use serde::Serialize;

use super::{Backend, Precision, SamplePattern, Settings};
use crate::certify::{CpuSeconds, DecidedBy, Tally};
use crate::scene::Scene;
use crate::stopwatch::{Phases, Stopwatch};

/// How a rendering went: what `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The rows rendered, from the bottom, half-open.
    pub rows: [u32; 2],
    /// The screen tolerance τ.
    pub screen_tolerance: f64,
    /// Rays a pixel.
    pub samples: u32,
    /// How several samples were spread.
    pub jitter: Option<SamplePattern>,
    /// The longest path, in world units, if there were lights to make paths.
    pub max_path: Option<f64>,
    /// What was asked of the bytes.
    pub precision: Precision,
    /// Which tracer rendered: `gpu` or `cpu`.
    pub backend: Backend,
    /// Adapter and driver, if the GPU rendered.
    pub adapter: Option<String>,
    /// Why the CPU rendered although the GPU was welcome.
    pub fallback: Option<String>,
    /// Why the CPU rendered the frame once more after the GPU: a pixel that the GPU was sure of, and got wrong.
    pub revoked: Option<String>,
    /// CPU threads that were there to be used.
    pub threads: Option<usize>,
    /// Pixels rendered.
    pub pixels: u64,
    /// Pixels that the GPU handed to the CPU, because it was in doubt or had no room.
    pub refined: u64,
    /// The same, in hundredths of all pixels.
    pub refined_percent: f64,
    /// Samples that the CPU traced for them: of a pixel of which the GPU is sure of some only the others, if that was
    /// enough.
    pub refined_samples: u64,
    /// The same, in hundredths of all samples.
    pub refined_samples_percent: f64,
    /// How many pixels each kind of arithmetic decided.
    pub decided: Tally,
    /// Pixels proven to lie on a border exactly.
    pub ties: u64,
    /// Pixels so near a border that they are presumed to lie on it.
    pub presumed: u64,
    /// Column and row (from the bottom) of the first of them.
    pub presumed_at: Vec<[u32; 2]>,
    /// Pixels that the GPU was sure of, computed again on the CPU and found right.
    pub spot_checks: u64,
    /// Number of bands.
    pub bands: u32,
    /// Where the time went.
    pub seconds: Seconds,
}

/// What a rendering came to, beside its bands.
#[derive(Debug)]
pub(super) struct Done {
    /// Which tracer made the picture.
    pub(super) backend: Backend,
    /// Adapter and driver, if the GPU rendered, rightly or not.
    pub(super) adapter: Option<String>,
    /// Why the CPU rendered although the GPU was welcome.
    pub(super) fallback: Option<String>,
    /// Why the CPU rendered once more after the GPU.
    pub(super) revoked: Option<String>,
    /// What decided the pixels.
    pub(super) tally: Tally,
    /// Sure pixels that were computed again, and were right.
    pub(super) spot_checks: u64,
    /// Number of bands.
    pub(super) bands: u32,
    /// What ran beside the thread that renders.
    pub(super) beside: Beside,
}

impl Done {
    /// On the CPU, from the start.
    pub(super) fn on_cpu(tally: Tally, bands: u32) -> Self {
        Self {
            backend: Backend::Cpu,
            adapter: None,
            fallback: None,
            revoked: None,
            tally,
            spot_checks: 0,
            bands,
            beside: Beside::default(),
        }
    }
}

impl Report {
    /// Of a rendering that has ended, with so many CPU threads.
    pub(super) fn new(
        scene: &Scene,
        settings: &Settings,
        threads: usize,
        done: Done,
        watch: &Stopwatch,
    ) -> Self {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        let tally = done.tally;
        let pixels = tally.pixels();
        let [refined, refined_samples] = match done.backend {
            Backend::Gpu => [pixels - tally.count(DecidedBy::Gpu), tally.samples()],
            Backend::Cpu | Backend::Auto => [0, 0],
        };
        let percent = |part: u64, whole: u64| 100.0 * part as f64 / whole.max(1) as f64;
        Self {
            width,
            height,
            rows: [rows.start, rows.end],
            screen_tolerance: settings.screen_tolerance,
            samples: settings.samples,
            jitter: settings.supersampling().map(|several| several.spread),
            max_path: (!scene.lights.is_empty()).then_some(settings.limits.max_path),
            precision: settings.precision,
            backend: done.backend,
            adapter: done.adapter,
            fallback: done.fallback,
            revoked: done.revoked,
            threads: Some(threads),
            pixels,
            refined,
            refined_percent: percent(refined, pixels),
            refined_samples,
            refined_samples_percent: percent(refined_samples, pixels * u64::from(settings.samples)),
            ties: tally.count(DecidedBy::Exact),
            presumed: tally.count(DecidedBy::Presumed),
            presumed_at: tally.presumed_at().to_vec(),
            spot_checks: done.spot_checks,
            bands: done.bands,
            seconds: Seconds {
                phases: watch.phases(),
                beside: done.beside,
                stages: tally.times(),
                total: watch.total(),
            },
            decided: tally,
        }
    }
}

/// Where the time of a rendering went, in seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// From the call of `render` to its end.
    pub total: f64,
    /// What the thread that renders did, or waited for: these follow each other, and add up to the total.
    pub phases: Phases,
    /// What others did meanwhile.
    pub beside: Beside,
    /// CPU time for pixels decided one by one, of all threads together, by what decided them.
    pub stages: CpuSeconds,
}

/// Seconds of what runs beside the thread that renders, while the GPU renders.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Beside {
    /// The GPU's kernels: by its own clock where it has one, else as waited for.
    pub kernel: f64,
    /// Deciding what the GPU left undecided, while it renders the next bands.
    pub refine: f64,
    /// Computing again some of what it was sure of, likewise.
    pub spot_checks: f64,
    /// Handing bands on: encoding, writing; likewise.
    pub emit: f64,
}

//! What a rendering is asked for, beyond what the scene says.
//!
//! Stands below the tracers, which read it; `cli` makes it from arguments.

use std::ops::Range;
use std::path::PathBuf;

use serde::Serialize;

use crate::jitter::{Course, Jitter};

/// What to render, beyond what the scene says.
#[derive(Debug, Clone)]
pub struct Settings {
    /// The rows to render, half-open, counted from the bottom; all without.
    pub rows: Option<Range<u32>>,
    /// τ: a hit on a plane counts only where its z is ≤ this; 0 in the notes.
    pub screen_tolerance: f64,
    /// Which tracer.
    pub backend: Backend,
    /// Whether every byte has to be the right one.
    pub precision: Precision,
    /// Rays a pixel: 1 goes through its middle, more are spread and their mean is taken.
    pub samples: u32,
    /// How several samples are spread.
    pub jitter: Spread,
    /// How far rays are followed.
    pub limits: Limits,
    /// Part of the name of the adapter to use, in any case of letters.
    pub adapter: Option<String>,
    /// CPU threads; all cores without.
    pub threads: Option<usize>,
    /// Whether bands carry the unquantised values too (for EXR).
    pub values: bool,
    /// Whether bands tell what decided each pixel.
    pub verdicts: bool,
    /// Rows of a band; without, as many as take a moment. A band has fewer where a dispatch cannot have so many.
    pub band_rows: Option<u32>,
    /// The folder in which adapters that passed the self-test are remembered; without, it is run once a process.
    pub cache: Option<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            rows: None,
            screen_tolerance: 0.0,
            samples: 1,
            jitter: Spread::Hash,
            limits: Limits::default(),
            backend: Backend::Auto,
            adapter: None,
            threads: None,
            precision: Precision::Certified,
            values: false,
            verdicts: false,
            band_rows: None,
            cache: None,
        }
    }
}

impl Settings {
    /// How the pixels of a picture of this width are sampled, in the rows below `end`.
    pub fn sampling(&self, width: u32, end: u32) -> Jitter {
        match (self.samples, self.jitter) {
            (0 | 1, _) => Jitter::Once,
            (samples, Spread::Hash) => Jitter::Hash(samples),
            (samples, Spread::Course) => Jitter::Course(Course::new(width, end, samples)),
        }
    }

    /// The limits of a sample: where the values themselves are wanted, those above 1 count too.
    pub fn sample_limits(&self) -> Limits {
        let enough = if self.values {
            f64::INFINITY
        } else {
            f64::from(self.samples)
        };
        Limits {
            enough,
            ..self.limits
        }
    }
}

/// How the samples of a pixel are spread over it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Spread {
    /// By a hash of column, row and sample: any row can be rendered alone.
    #[default]
    Hash,
    /// As the course's program did, by the C library's `random()`.
    Course,
}

impl Spread {
    /// What spreads the samples, for people.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Hash => "a hash",
            Self::Course => "the C library's random(), as the course's program did",
        }
    }
}

/// Which tracer renders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU if there is one, else the CPU.
    #[default]
    Auto,
    /// The GPU, or an error. Pixels that it leaves undecided go to the CPU, as does a frame that it got wrong.
    Gpu,
    /// The CPU.
    Cpu,
}

/// What is asked of the bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// Every byte is the one that the rules define in exact arithmetic: what the GPU is not sure of, the CPU decides.
    #[default]
    Certified,
    /// The GPU's f32 as it comes.
    Fast,
}

/// How far rays are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A ray that starts farther than this along its path brings nothing, in world units.
    pub max_path: f64,
    /// Most rays of a sample, shadow rays not counted.
    pub max_rays: u32,
    /// A sample this bright in all channels makes its pixel white whatever else it brings: rays take no light away.
    pub enough: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_path: 20.0,
            max_rays: 1 << 16,
            enough: 1.0,
        }
    }
}

//! What a rendering is asked for, beyond what the scene says.
//!
//! Stands below the tracers, which read it; `cli` makes it from arguments.

use std::ops::Range;
use std::path::PathBuf;

use serde::Serialize;

use crate::jitter::{Course, Jitter};

/// More samples than this show nothing more, and take hours.
pub const MAX_SAMPLES: u32 = 65_536;
/// The offsets of this many samples are held in memory at a time, for a row: a quarter of a gigabyte a thread.
const MOST_COURSE_SAMPLES: u64 = 1 << 24;

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
    pub jitter: SamplePattern,
    /// How far rays are followed.
    pub limits: Limits,
    /// Part of the name of the adapter to use, in any case of letters; without, the environment may name one
    /// ([`VARIABLE`](crate::gpu::adapters::VARIABLE)).
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
            jitter: SamplePattern::Hash,
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
    /// The rows to render of a picture of this height, from the bottom.
    pub fn rows_of(&self, height: u32) -> Range<u32> {
        self.rows.clone().unwrap_or(0..height)
    }

    /// Several rays a pixel, if that was asked for; else one goes through its middle.
    pub fn supersampling(&self) -> Option<Supersampling> {
        (self.samples > 1).then_some(Supersampling {
            samples: self.samples,
            spread: self.jitter,
        })
    }

    /// How the pixels of a picture of this width are sampled, in the rows below `end`.
    pub fn sampling(&self, width: u32, end: u32) -> Jitter {
        match self.supersampling() {
            None => Jitter::Once,
            Some(Supersampling { samples, spread }) => match spread {
                SamplePattern::Hash => Jitter::Hash(samples),
                SamplePattern::Course => Jitter::Course(Course::new(width, end, samples)),
            },
        }
    }

    /// Why a picture of this width cannot be rendered so: it would take memory without end.
    pub fn fault(&self, width: u32) -> Option<String> {
        let Supersampling { samples, spread } = self.supersampling()?;
        let too_many = spread == SamplePattern::Course
            && u64::from(width) * u64::from(samples) > MOST_COURSE_SAMPLES;
        too_many.then(|| {
            format!(
                "--jitter course makes the samples of a whole row at once, and a row of {width} pixels with {samples} \
                 samples has more than {MOST_COURSE_SAMPLES}: take fewer, or --jitter hash, which needs no memory"
            )
        })
    }

    /// How the scene is looked at.
    pub fn view(&self) -> ViewParameters {
        ViewParameters {
            screen_tolerance: self.screen_tolerance,
            margin: self.supersampling().map_or(0.0, |_| 0.5),
        }
    }

    /// Whether the GPU's pixels come with error bounds, so that it knows which of them it is sure of. Certified values
    /// are the CPU's.
    pub fn has_gpu_bounds(&self) -> bool {
        self.precision == Precision::Certified && !self.values
    }

    /// The limits of a sample: where the values themselves are wanted, those above 1 count too, and the
    /// least ray does.
    pub fn sample_limits(&self) -> Limits {
        if self.values {
            return Limits {
                enough: f64::INFINITY,
                faint: 0.0,
                ..self.limits
            };
        }
        Limits {
            enough: f64::from(self.samples),
            ..self.limits
        }
    }
}

/// Several rays a pixel, whose mean is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Supersampling {
    /// How many: at least two.
    pub samples: u32,
    /// How they are spread.
    pub spread: SamplePattern,
}

/// How the scene is looked at, beyond what it says itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewParameters {
    /// τ: a hit on a plane counts only where its z is ≤ this; 0 in the notes.
    pub screen_tolerance: f64,
    /// How far from its pixel's center a ray may pass, in pixels: 0, or ½ with several samples.
    pub margin: f64,
}

impl From<f64> for ViewParameters {
    /// The view with this screen tolerance, a ray a pixel.
    fn from(screen_tolerance: f64) -> Self {
        Self {
            screen_tolerance,
            margin: 0.0,
        }
    }
}

/// How the samples of a pixel are spread over it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SamplePattern {
    /// By a hash of column, row and sample: any row can be rendered alone.
    #[default]
    Hash,
    /// As the course's program did, by the C library's `random()`.
    Course,
}

impl SamplePattern {
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
    /// A ray that can bring no more than this to its sample, with all rays that it leaves, is not followed: its bytes
    /// are those that they are with it or without. 0 to follow every ray.
    pub faint: f64,
}

/// What the rays of a sample may bring together that are too faint to be followed, 2¹⁷ at most, is a thousandth of a
/// byte.
const FAINT: f64 = 1.0 / (1_u64 << 36) as f64;

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_path: 20.0,
            max_rays: 1 << 16,
            enough: 1.0,
            faint: FAINT,
        }
    }
}

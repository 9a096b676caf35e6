//! Finished pixels on their way: what the tracers hand on, and what takes it.

pub mod spare;

use std::io;
use std::ops::Range;

/// Finished rows, on their way into a picture. Bands come from the top of the picture downwards, without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Which rows, counted from the bottom.
    pub rows: Range<u32>,
    /// Red, green, blue of every pixel, the band's top row first: 3 · width · rows bytes.
    pub rgb: Vec<u8>,
    /// The values before quantising (1.0 is byte 255), in the same order, if they were asked for.
    pub values: Option<Vec<[f32; 3]>>,
    /// What decided each pixel, in the same order, if it was asked for.
    pub verdicts: Option<Vec<DecidedBy>>,
}

/// Takes finished bands; an error ends the rendering.
pub type Emit<'a> = dyn FnMut(&Band) -> io::Result<()> + Send + 'a;

/// Asked now and then by whoever renders: whether nobody wants the picture any more.
pub type StopRequested<'a> = dyn Fn() -> bool + Sync + 'a;

/// What decided a pixel, from the cheapest to the dearest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DecidedBy {
    /// The GPU, in f32, and it was sure.
    Gpu,
    /// The GPU, in f64, likewise.
    Double,
    /// The CPU, in f32, likewise.
    Single,
    /// f64 with error bounds.
    Bounded,
    /// Pairs of f64 with error bounds.
    Pairs,
    /// Numbers of 128 bits and more, or exact ones that differ.
    Multiprecision,
    /// Exact arithmetic: the pixel lies on a border, which was proven.
    Exact,
    /// Nothing: numbers that agree to 1,024 bits are presumed to be equal; or the pixel was too much for exact ones.
    Presumed,
}

impl DecidedBy {
    /// All of them, in order; each stands at its own number.
    pub const ALL: [Self; 8] = [
        Self::Gpu,
        Self::Double,
        Self::Single,
        Self::Bounded,
        Self::Pairs,
        Self::Multiprecision,
        Self::Exact,
        Self::Presumed,
    ];

    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Double => "gpu_f64",
            Self::Single => "f32",
            Self::Bounded => "f64",
            Self::Pairs => "pairs",
            Self::Multiprecision => "multiprecision",
            Self::Exact => "tie",
            Self::Presumed => "presumed",
        }
    }
}

/// A pixel that the CPU decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decided {
    /// The value before quantising: 1.0 is byte 255.
    pub value: [f32; 3],
    /// The bytes.
    pub bytes: [u8; 3],
    /// What decided them.
    pub by: DecidedBy,
}

/// What is known of a pixel of several samples before the CPU decides it: the share of those that f32 is sure of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part<'a> {
    /// 255 times the share that the sure samples have in the pixel's mean.
    pub sum: [f32; 3],
    /// How far that may be off.
    pub error: [f32; 3],
    /// A bit for each sample that is in the sum, from the lowest up, 32 to a word.
    pub summed: &'a [u32],
}

impl Part<'_> {
    /// Of a pixel of which nothing is known.
    pub const NOTHING: Self = Self {
        sum: [0.0; 3],
        error: [0.0; 3],
        summed: &[],
    };

    /// Whether a sample is in the sum.
    pub fn holds(&self, sample: u32) -> bool {
        let word = self.summed.get(sample as usize / 32);
        word.is_some_and(|word| word >> (sample % 32) & 1 != 0)
    }

    /// How many samples are in the sum.
    pub fn samples(&self) -> u32 {
        self.summed.iter().map(|word| word.count_ones()).sum()
    }
}

/// Why pixels were not decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Halt {
    /// One of them needs more rays than allowed.
    #[error(transparent)]
    TooManyRays(#[from] PixelFault),
    /// Nobody wants them any more.
    #[error("given up")]
    Stopped,
}

/// A pixel that needs more rays than allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "pixel ({x}, {y}) needs more than {max_rays} rays for one sample: mirrors and transparent surfaces multiply them; \
    --max-rays allows more, --max-path fewer"
)]
pub struct PixelFault {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the bottom.
    pub y: u32,
    /// How many were allowed.
    pub max_rays: u32,
}

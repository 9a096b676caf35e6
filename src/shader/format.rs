//! The floating-point formats that shaders are made for: f32, and f64 where a device has it.
//!
//! One text and one list of records serve both. What differs is here: the unit roundoff that bounds are counted in,
//! what the scene is prepared in, and what a record becomes in the end.

use std::fmt::Debug;

use super::bounds::GROWTH;
use super::literal::{literal, literal_of_f64};
use super::record::{Record, Wide};
use crate::real::{Bounded, Pair, Real};

/// A floating-point format.
pub trait Format: Debug + Clone + Copy + PartialEq + Send + Sync + 'static {
    /// What the scene is prepared in: numbers whose own error is nothing beside this format's.
    type Number: Known;
    /// What a record is for this format.
    type Record<W: Wide>: Record;

    /// Whether it is f64.
    const DOUBLE: bool;
    /// What + − × may be off by, relatively.
    const ROUNDING: f64;
    /// The same, with what bounds' own roundings may take.
    const U: f64 = Self::ROUNDING * GROWTH;

    /// What the offset of a sample may be off by, in pixels, where it is given and not computed.
    const OFFSET_ERROR: f64;

    /// The nearest number of this format, as a WGSL literal.
    fn literal(value: f64) -> String;

    /// The number of this format that is no less.
    fn round_up(value: f64) -> f64;

    /// The record, every number rounded to this format.
    fn record<W: Wide>(wide: W) -> Self::Record<W>;

    /// The record as f64 has it.
    fn wide<W: Wide>(record: &Self::Record<W>) -> W;
}

/// A number that knows how far it is from an f64.
pub trait Known: Real {
    /// The f64 nearest to what is known of the number; no number where nothing is.
    fn nearest(self) -> f64;

    /// How far the number may be from that, but for its rounding to f64.
    fn off(self) -> f64;
}

impl Known for Bounded {
    #[inline(always)]
    fn nearest(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn off(self) -> f64 {
        self.error
    }
}

impl Known for Pair {
    #[inline(always)]
    fn nearest(self) -> f64 {
        if self.error.is_finite() {
            self.high
        } else {
            f64::NAN
        }
    }

    #[inline(always)]
    fn off(self) -> f64 {
        self.error
    }
}

/// f32.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Single;

impl Format for Single {
    type Number = Bounded;
    type Record<W: Wide> = W::Narrow;

    const DOUBLE: bool = false;
    const ROUNDING: f64 = super::bounds::ROUNDING;
    const OFFSET_ERROR: f64 = super::bounds::OFFSET_ERROR;

    fn literal(value: f64) -> String {
        literal(value as f32)
    }

    fn round_up(value: f64) -> f64 {
        super::bounds::round_up(value).into()
    }

    #[inline]
    fn record<W: Wide>(wide: W) -> W::Narrow {
        wide.narrow()
    }

    #[inline]
    fn wide<W: Wide>(record: &W::Narrow) -> W {
        W::widen(*record)
    }
}

/// f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Double;

impl Format for Double {
    type Number = Pair;
    type Record<W: Wide> = W;

    const DOUBLE: bool = true;
    const ROUNDING: f64 = 1.0 / (1_u64 << 53) as f64;
    // Offsets are numbers of f64.
    const OFFSET_ERROR: f64 = 0.0;

    fn literal(value: f64) -> String {
        literal_of_f64(value)
    }

    fn round_up(value: f64) -> f64 {
        // Bounds are computed in f64, and what they lose there `GROWTH` makes up for.
        value
    }

    #[inline]
    fn record<W: Wide>(wide: W) -> W {
        wide
    }

    #[inline]
    fn wide<W: Wide>(record: &W) -> W {
        *record
    }
}

//! The number types that the tracer runs on.
//!
//! `cpu` is written once, over [`Real`]. A number type says what it knows: a comparison that it cannot decide is
//! [`Undecided`], never a guess. f64 decides always, and is wrong where its rounding crosses the border.

mod bounded;
mod double_double;
mod float;
mod vec3;

pub use bounded::Bounded;
pub use double_double::DoubleDouble;
pub use vec3::V3;

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_ratio::Relaxed as Ratio;

/// What a comparison answers that the number type is too coarse for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undecided;

/// A number that stands for a real one.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number that `value` is, exactly.
    fn exact(value: f64) -> Self;

    /// The number nearest to `value`, or the smallest that encloses it.
    fn ratio(value: &Ratio) -> Self;

    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;

    /// The number, which is > 0, to the power of `exponent`.
    fn pow(self, exponent: f64) -> Self;

    /// The cosine of an angle of 0 to 180 degrees.
    fn cos_degrees(angle: f64) -> Self;

    /// The sign of the number, if it is certain.
    fn sign(self) -> Result<Ordering, Undecided>;

    /// The largest integer that is not above the number, if it is certain.
    fn floor(self) -> Result<f64, Undecided>;

    /// An f64 near the number, for people to read.
    fn approx(self) -> f64;

    /// Whether the number is > 0.
    fn positive(self) -> Result<bool, Undecided> {
        Ok(self.sign()? == Ordering::Greater)
    }

    /// Whether the number is ≥ 0.
    fn non_negative(self) -> Result<bool, Undecided> {
        Ok(self.sign()? != Ordering::Less)
    }

    /// Zero.
    fn zero() -> Self {
        Self::exact(0.0)
    }

    /// The absolute value.
    fn abs(self) -> Result<Self, Undecided> {
        Ok(if self.non_negative()? { self } else { -self })
    }
}

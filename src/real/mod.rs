//! The number types that the tracer runs on.
//!
//! `cpu` is written once, over [`Real`]. A number type says what it knows: a comparison that it cannot decide is
//! [`Undecided`], never a guess. [`Bounded`] is f64 that knows its error, and decides nearly every pixel; [`Pair`] has
//! twice the digits; [`Lazy`] decides the others, in the end exactly. Plain f64 decides always, and is wrong where its
//! rounding crosses the border: it is for people to read, and for what nothing else decides.
//!
//! [`rational`] stands below them all: the arithmetic that `prepare` takes a scene's facts from.

mod bounded;
mod float;
mod lazy;
mod pair;
pub mod rational;
mod vec3;

pub use bounded::Bounded;
pub use lazy::{Effort, Lazy, Mark};
pub use pair::Pair;
pub use vec3::V3;

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use rational::Ratio;

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

    /// The product with an f64, taken exactly.
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * Self::exact(factor)
    }

    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;

    /// The number, which is > 0, to the power of `exponent`.
    fn pow(self, exponent: f64) -> Self;

    /// The cosine of an angle of 0 to 180 degrees.
    fn cos_degrees(angle: f64) -> Self;

    /// 1 − the cosine of a small angle, as accurate as a number of its size; None where the cosine itself does.
    fn versine_degrees(angle: f64) -> Option<Self>;

    /// The sign of the number, if it is certain.
    fn sign(self) -> Result<Ordering, Undecided>;

    /// The largest integer that is not above the number, if it is certain.
    fn floor(self) -> Result<f64, Undecided>;

    /// The floor of the number modulo `modulus`, from 0 up, if it is certain.
    fn floor_mod(self, modulus: u32) -> Result<u32, Undecided> {
        // Exact: a remainder of doubles has no rounding, and integers below 2³² can be added to one.
        let modulus = f64::from(modulus);
        let rest = self.floor()? % modulus;
        Ok(if rest < 0.0 { rest + modulus } else { rest } as u32)
    }

    /// Whether the type has one number for two that may be equal; see [`joined`](Real::joined).
    const JOINS: bool = false;

    /// One number of which nothing is said that does not hold for both, if they may be equal.
    fn joined(self, other: Self) -> Option<Self> {
        let _ = other;
        None
    }

    /// One number of which nothing is said that does not hold for all that are larger by 0 to `more`, if the type has
    /// such.
    fn up_to(self, more: f64) -> Option<Self> {
        (more == 0.0).then_some(self)
    }

    /// An f64 near the number: for people to read, and where any number near it will do.
    fn to_f64(self) -> f64;

    /// An f64 near the number, and how far off it may be.
    fn enclosure(self) -> Bounded {
        Bounded::exact(self.to_f64())
    }

    /// The same, as it is known without any work.
    fn quick_enclosure(self) -> Bounded {
        self.enclosure()
    }

    /// The f32 nearest to the number, of two the even one, if it is certain.
    fn nearest_f32(self) -> Result<f32, Undecided>;

    /// floor(min(255, max(0, 255·v))) of a number v that is not negative, if it is certain.
    fn byte(self) -> Result<u8, Undecided> {
        let scaled = self * Self::exact(255.0);
        if (scaled - Self::exact(255.0)).non_negative()? {
            return Ok(255);
        }
        // Below 1 the byte is 0, however near to 0 that is.
        if (Self::exact(1.0) - scaled).positive()? {
            return Ok(0);
        }
        Ok(scaled.floor()? as u8)
    }

    /// How much memory numbers take; see [`release`](Real::release).
    fn mark() -> Mark {
        Mark::default()
    }

    /// Gives back the memory of all numbers made since then; none of them may be used again.
    fn release(mark: Mark) {
        let _ = mark;
    }

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

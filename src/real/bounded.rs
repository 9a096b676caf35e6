//! f64 with a running error bound: a [`Real`] that knows when f64 is too coarse.
//!
//! The bound is that of floating point to nearest: a result r̂ differs from the exact result on its computed operands
//! by at most u·|r̂|, u = 2⁻⁵³, and by half the smallest subnormal where it underflows; the operands' own errors are
//! carried along. The bound is itself computed in f64. All its terms are ≥ 0, so that it is low by a part in 10¹⁵ or so
//! for each of the operations behind it; wherever it is used it is made larger by a part in 10⁸, which is enough for
//! ten million operations in a row. Nothing is decided by a NaN or an infinity. docs/NUMERICS.md, section 8, derives
//! each bound.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::float::whole_below;
use super::rational::{Ratio, ratio};
use super::{Real, Undecided, lazy};

/// A number within `error` of `value`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounded {
    /// The f64 result.
    pub value: f64,
    /// How far the exact number may lie from it, to a part in 10⁸; infinite where nothing is known.
    pub error: f64,
}

/// Unit roundoff of f64.
const U: f64 = 1.0 / 9_007_199_254_740_992.0;
/// What underflow may take: half the smallest subnormal from the result, and from each of up to seven terms of the
/// bound. That would be 2⁻¹⁰⁷². But then all numbers that are 0 by a product have a subnormal bound, and a product with
/// that takes some processors a hundred times as long as others; so it is 2⁻¹⁰⁰⁰.
const TINY: f64 = f64::from_bits(103_582_791_429_521_408);

impl Bounded {
    /// What the roundings of the bound itself may add up to: where a bound is used, it is multiplied by this.
    pub const GROW: f64 = 1.0 + 1e-8;

    /// The least that the number may be, but for the rounding of this.
    pub fn least(self) -> f64 {
        self.value - self.error * Self::GROW
    }

    /// The most that it may be, likewise.
    pub fn most(self) -> f64 {
        self.value + self.error * Self::GROW
    }

    /// Nothing is known.
    const UNKNOWN: Self = Self {
        value: 0.0,
        error: f64::INFINITY,
    };

    /// The power with a whole exponent, by squaring.
    fn whole_power(self, mut exponent: f64) -> Self {
        let (mut result, mut square) = (Self::exact(1.0), self);
        loop {
            if exponent % 2.0 == 1.0 {
                result = (result * square).grown();
            }
            exponent = (exponent / 2.0).floor();
            if exponent == 0.0 {
                return result;
            }
            square = (square * square).grown();
        }
    }

    /// The same with what rounding took from its bound made up for: squaring doubles that share where a number is
    /// smaller than its bound, so that it does not wait until the bound is used.
    fn grown(self) -> Self {
        Self {
            error: self.error * POWER_GROWTH,
            ..self
        }
    }

    /// The power with an exponent in [0, 1), by a square root for each bit of it, until a root is so near to 1 that
    /// three terms of the binomial series do for the rest.
    fn part_power(self, mut exponent: f64) -> Self {
        let one = Self::exact(1.0);
        let mut result = one;
        let mut root = self;
        for _ in 0..64 {
            if exponent == 0.0 {
                return result;
            }
            let off = one - root;
            if off.value.abs() + off.error < NEAR_ONE {
                // (1 − ε)ˢ = 1 − sε − s(1 − s)/2·ε² − …, what is left out is at most CUBIC·|ε|³ for 0 ≤ s ≤ 1.
                let s = Self::exact(exponent);
                let bend = s * (one - s) * Self::exact(0.5);
                let mut rest = one - off * (s + bend * off);
                let wide = off.value.abs() + off.error;
                rest.error += CUBIC * wide * wide * wide;
                return result * rest;
            }
            root = root.sqrt();
            exponent *= 2.0;
            if exponent >= 1.0 {
                result = result * root;
                exponent -= 1.0;
            }
        }
        Self::UNKNOWN
    }
}

/// What a product's bound, computed by five operations, is larger by: 16u.
pub(super) const POWER_GROWTH: f64 = 1.0 + 1.0 / 562_949_953_421_312.0;

/// What the factors' errors make of that of their product.
#[inline(always)]
fn carried(a: Bounded, b: Bounded) -> f64 {
    (a.value.abs() + a.error) * b.error + b.value.abs() * a.error
}

/// A divisor whose relative error is below this is divided by as it is.
const NEARLY: f64 = 1.0 / 1_048_576.0;

/// Where a root counts as near to 1.
const NEAR_ONE: f64 = 1.0 / 131_072.0;

/// The binomial series' next term there, for a unit of the third power.
const CUBIC: f64 = 0.07;

/// What the margin of a byte is larger by, relatively, for its own roundings.
const BYTE_GROWTH: f64 = 1e-12;

/// Roundings of 255 times a value, and of its distance from a whole number.
const BYTE_ROUNDINGS: f64 = 4.0;

impl Add for Bounded {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        // Sums do not underflow: a subnormal one is exact.
        let value = self.value + o.value;
        Self {
            value,
            error: (self.error + o.error) + U * value.abs(),
        }
    }
}

impl Sub for Bounded {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let value = self.value - o.value;
        Self {
            value,
            error: (self.error + o.error) + U * value.abs(),
        }
    }
}

impl Mul for Bounded {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let value = self.value * o.value;
        Self {
            value,
            error: carried(self, o) + (U * value.abs() + TINY),
        }
    }
}

impl Div for Bounded {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let inverse = 1.0 / o.value.abs();
        let off = (value.abs() + TINY) * o.error + (self.error + TINY);
        if o.error * inverse < NEARLY {
            // 1/(|y| − ε) ≤ (1 + 2·ε/|y|)/|y|: the division need not wait for the errors.
            return Self {
                value,
                error: off * (inverse * (1.0 + 3.0 * NEARLY)) + (U * value.abs() + TINY),
            };
        }
        // This difference may be much smaller than its terms, so the bound is made as large as it may be first.
        let least = o.value.abs() - o.error * Self::GROW;
        Self {
            value,
            error: if least > 0.0 {
                off / least + (U * value.abs() + TINY)
            } else {
                f64::INFINITY
            },
        }
    }
}

impl Neg for Bounded {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            error: self.error,
        }
    }
}

impl Real for Bounded {
    #[inline(always)]
    fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    fn ratio(value: &Ratio) -> Self {
        let rounded = f64::ratio(value);
        let exact = rounded.is_finite() && ratio(rounded) == *value;
        Self {
            value: rounded,
            error: if exact { 0.0 } else { U * rounded.abs() + TINY },
        }
    }

    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        let value = self.value * factor;
        Self {
            value,
            error: factor.abs() * self.error + (U * value.abs() + TINY),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // √(a ± e) lies within e/√a of √a, and within √(2e) where a is no larger than e. A root never underflows.
        let value = self.value.max(0.0).sqrt();
        let carried = if self.value > self.error {
            self.error / value
        } else {
            (2.0 * self.error).sqrt()
        };
        Self {
            value,
            error: carried + (U * value + TINY),
        }
    }

    fn pow(self, exponent: f64) -> Self {
        // A root of what may be negative would be a guess.
        if self.least() <= 0.0 {
            return Self::UNKNOWN;
        }
        let whole = exponent.trunc();
        let power = self.whole_power(whole);
        if exponent == whole {
            power
        } else {
            power * self.part_power(exponent - whole)
        }
    }

    fn cos_degrees(angle: f64) -> Self {
        // By Niven's theorem no other angle in range has a rational cosine.
        match angle {
            0.0 | 60.0 | 90.0 | 120.0 | 180.0 => Self::exact(f64::cos_degrees(angle)),
            _ => lazy::bounded_cosine(angle),
        }
    }

    fn versine_degrees(angle: f64) -> Option<Self> {
        lazy::bounded_versine(angle)
    }

    #[inline(always)]
    fn sign(self) -> Result<Ordering, Undecided> {
        if self.value.abs() > self.error * Self::GROW {
            return Ok(if self.value > 0.0 {
                Ordering::Greater
            } else {
                Ordering::Less
            });
        }
        if self.value == 0.0 && self.error == 0.0 {
            return Ok(Ordering::Equal);
        }
        Err(Undecided)
    }

    #[inline(always)]
    fn floor(self) -> Result<f64, Undecided> {
        let low = whole_below(self.value);
        if self.error == 0.0 {
            return Ok(low);
        }
        // Both differences are exact or rounded by a part in 2⁵³, and the margin is larger than the error by a part in
        // 10⁸.
        let margin = self.error * Self::GROW;
        if self.value - low > margin && (low + 1.0) - self.value > margin {
            Ok(low)
        } else {
            Err(Undecided)
        }
    }

    #[inline(always)]
    fn abs(self) -> Result<Self, Undecided> {
        // | |X| − |x| | ≤ |X − x|, whatever the signs are.
        Ok(Self {
            value: self.value.abs(),
            error: self.error,
        })
    }

    const JOINS: bool = true;

    fn joined(self, other: Self) -> Option<Self> {
        let apart = (other.value - self.value).abs();
        let error = self.error.max(other.error + apart * (1.0 + 2.0 * U));
        // Numbers that may be equal overlap, and are not much farther apart than each is known.
        (apart <= (self.error + other.error) && error.is_finite()).then_some(Self {
            value: self.value,
            error,
        })
    }

    fn up_to(self, more: f64) -> Option<Self> {
        let half = 0.5 * more;
        Some(if more == 0.0 {
            self
        } else {
            self + Self {
                value: half,
                error: half * Self::GROW + TINY,
            }
        })
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn enclosure(self) -> Self {
        self
    }

    fn nearest_f32(self) -> Result<f32, Undecided> {
        // Rounded outward, and to f32 monotonically.
        let margin = self.error * Self::GROW;
        let (low, high) = (self.value - margin, self.value + margin);
        let exact = self.error == 0.0;
        let low = if exact { low } else { low.next_down() } as f32;
        let high = if exact { high } else { high.next_up() } as f32;
        if low == high && self.value.is_finite() {
            Ok(high)
        } else {
            Err(Undecided)
        }
    }

    #[inline(always)]
    fn byte(self) -> Result<u8, Undecided> {
        let scaled = 255.0 * self.value;
        // The product's rounding and those below are within BYTE_ROUNDINGS·u of it.
        let margin =
            (255.0 * (Self::GROW + BYTE_GROWTH)) * self.error + (BYTE_ROUNDINGS * U) * scaled.abs();
        if scaled + margin < 1.0 {
            return Ok(0);
        }
        if scaled - margin >= 255.0 {
            return Ok(255);
        }
        // A NaN passes neither of the comparisons above nor those below.
        let whole = scaled as i32;
        let rest = scaled - f64::from(whole);
        if rest > margin && 1.0 - rest > margin {
            Ok(whole as u8)
        } else {
            Err(Undecided)
        }
    }
}

#[cfg(test)]
pub(super) mod tests;

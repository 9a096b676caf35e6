//! Pairs of f64 with a running error bound: about 104 bits, at some ten times what [`Bounded`] takes.
//!
//! A number is the sum of two f64, the second no more than half a unit of the last place of the first. Sums and
//! products of two f64 are taken with what they round off (`two_sum`, `two_product`, exact in IEEE arithmetic but for
//! underflow), and what is neglected in the second part is counted in units of u², u = 2⁻⁵³. The bound is carried as
//! that of `Bounded` is, and its own roundings are made up for by the same factor where it is used. docs/NUMERICS.md,
//! section 8, derives each bound.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::bounded::POWER_GROWTH;
use super::float::nearest_f32_by_middle;
use super::rational::{Ratio, ratio};
use super::{Bounded, Real, Undecided, lazy};

/// A number within `error` of high + low.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The f64 nearest to the sum.
    pub high: f64,
    /// The rest.
    pub low: f64,
    /// How far the exact number may lie from the sum, to a part in 10⁸; infinite where nothing is known.
    pub error: f64,
}

/// u², the square of f64's unit roundoff.
const U2: f64 = 1.0 / (1_u128 << 106) as f64;
/// What underflow may take: 2η from a product of two, η/2 from each other product and quotient, and from terms of the
/// bound, η = 2⁻¹⁰⁷⁴.
const TINY: f64 = f64::from_bits(16);
/// Roundings of a sum, in units of u² of the terms' sizes.
const SUM: f64 = 4.0;
/// Roundings of a product, in units of u² of it.
const PRODUCT: f64 = 9.0;
/// The same of a product by an f64.
const MULTIPLE: f64 = 4.0;
/// The same of a quotient.
const QUOTIENT: f64 = 13.0;
/// The same of a root.
const ROOT: f64 = 5.0;

/// The sum of two f64 and what it rounded off (Knuth): exact unless it overflows.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let back = sum - a;
    (sum, (a - (sum - back)) + (b - back))
}

/// An f64 in two of 26 bits (Veltkamp); no number for one above 2⁹⁹⁶.
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0;
    let scaled = FACTOR * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// The product of two f64 and what it rounded off (Dekker): within 2η.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let rest = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    (product, rest)
}

impl Pair {
    /// Nothing is known.
    const UNKNOWN: Self = Self {
        high: 0.0,
        low: 0.0,
        error: f64::INFINITY,
    };

    /// The sum of a number and one that is small beside it.
    #[inline(always)]
    fn of(first: f64, second: f64, error: f64) -> Self {
        let (high, low) = two_sum(first, second);
        // A number that overflowed on the way is none, whatever its bound says.
        if (high + low).is_finite() {
            Self { high, low, error }
        } else {
            Self::UNKNOWN
        }
    }

    /// The number that is within a bound of an f64, given what is known of the rest.
    pub(super) fn from_parts(first: f64, rest: Bounded) -> Self {
        Self::of(first, rest.value, rest.error)
    }

    /// The same with what rounding took from its bound made up for, as in a power of `Bounded`.
    fn grown(self) -> Self {
        Self {
            error: self.error * POWER_GROWTH,
            ..self
        }
    }

    /// What the factors' errors make of that of their product.
    #[inline(always)]
    fn carried(self, o: Self) -> f64 {
        (self.high.abs() + self.error) * o.error + o.high.abs() * self.error
    }
}

impl Add for Pair {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        let (sum, rest) = two_sum(self.high, o.high);
        let (low, least) = two_sum(self.low, o.low);
        let (high, more) = two_sum(sum, rest + low);
        let error = (self.error + o.error) + (SUM * U2) * (self.high.abs() + o.high.abs());
        Self::of(high, least + more, error)
    }
}

impl Sub for Pair {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Pair {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let (product, rest) = two_product(self.high, o.high);
        let low = (self.high * o.low + self.low * o.high) + rest;
        let error = self.carried(o) + ((PRODUCT * U2) * product.abs() + TINY);
        Self::of(product, low, error)
    }
}

impl Div for Pair {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        let quotient = self.high / o.high;
        let (product, rest) = two_product(quotient, o.high);
        // What the quotient leaves of the numerator.
        let left = (((self.high - product) - rest) + self.low) - quotient * o.low;
        // This difference may be much smaller than its terms, so the bound is made as large as it may be first.
        let least = o.high.abs() - o.error * Bounded::GROW;
        if least.is_nan() || least <= 0.0 {
            return Self::UNKNOWN;
        }
        let off = (quotient.abs() + TINY) * o.error + (self.error + TINY);
        let error = off / least + ((QUOTIENT * U2) * quotient.abs() + TINY);
        Self::of(quotient, left / o.high, error)
    }
}

impl Neg for Pair {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
            error: self.error,
        }
    }
}

impl Real for Pair {
    #[inline]
    fn exact(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
            error: 0.0,
        }
    }

    fn ratio(value: &Ratio) -> Self {
        let first = f64::ratio(value);
        if !first.is_finite() {
            return Self::UNKNOWN;
        }
        Self::from_parts(first, Bounded::ratio(&(value - ratio(first))))
    }

    #[inline]
    fn times(self, factor: f64) -> Self {
        let (product, rest) = two_product(self.high, factor);
        let error = factor.abs() * self.error + ((MULTIPLE * U2) * product.abs() + TINY);
        Self::of(product, self.low * factor + rest, error)
    }

    #[inline]
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            // What is enclosed and not negative is at most twice the error.
            return Self {
                error: (2.0 * self.error + TINY).sqrt(),
                ..Self::exact(0.0)
            };
        }
        let root = self.high.sqrt();
        let (product, rest) = two_product(root, root);
        let left = ((self.high - product) - rest) + self.low;
        // √(a ± e) lies within e/√a of √a, and within √(2e) where a is no larger than e.
        let carried = if self.high > self.error {
            self.error / root
        } else {
            (2.0 * self.error).sqrt()
        };
        let error = carried + ((ROOT * U2) * root + TINY / root);
        Self::of(root, left / (2.0 * root), error)
    }

    /// By squares and roots: an exponent in f64 is a whole number over a power of two.
    fn pow(self, exponent: f64) -> Self {
        // A root of what may be negative would be a guess.
        if self.high - self.error * Bounded::GROW <= 0.0 {
            return Self::UNKNOWN;
        }
        let (mut whole, mut part) = (exponent.trunc(), exponent.fract());
        let (mut result, mut square, mut root) = (Self::exact(1.0), self, self);
        while whole > 0.0 {
            if whole % 2.0 == 1.0 {
                result = (result * square).grown();
            }
            whole = (whole / 2.0).floor();
            square = (square * square).grown();
        }
        while part > 0.0 {
            root = root.sqrt();
            part *= 2.0;
            if part >= 1.0 {
                result = (result * root).grown();
                part -= 1.0;
            }
        }
        result
    }

    fn cos_degrees(angle: f64) -> Self {
        // By Niven's theorem no other angle in range has a rational cosine.
        match angle {
            0.0 | 60.0 | 90.0 | 120.0 | 180.0 => Self::exact(f64::cos_degrees(angle)),
            _ => lazy::pair_of_cosine(angle),
        }
    }

    fn versine_degrees(angle: f64) -> Option<Self> {
        lazy::pair_of_versine(angle)
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Undecided> {
        // The sum is off its first part by a share of 2⁻⁵³ at most: less than what GROW adds.
        if self.high.abs() > self.error * Bounded::GROW {
            return Ok(if self.high > 0.0 {
                Ordering::Greater
            } else {
                Ordering::Less
            });
        }
        if self.high == 0.0 && self.error == 0.0 {
            return Ok(Ordering::Equal);
        }
        Err(Undecided)
    }

    fn floor(self) -> Result<f64, Undecided> {
        // The sum lies between the neighbours of its first part, so its floor is that part's or the one below.
        let whole = self.high.floor();
        if self.error == 0.0 {
            let below = whole == self.high && self.low < 0.0;
            return Ok(if below { whole - 1.0 } else { whole });
        }
        for low in [whole, whole - 1.0] {
            if (self - Self::exact(low)).non_negative()?
                && (Self::exact(low + 1.0) - self).positive()?
            {
                return Ok(low);
            }
        }
        Err(Undecided)
    }

    #[inline]
    fn abs(self) -> Result<Self, Undecided> {
        // | |X| − |x| | ≤ |X − x|, whatever the signs are.
        Ok(if self.high < 0.0 { -self } else { self })
    }

    const JOINS: bool = true;

    fn joined(self, other: Self) -> Option<Self> {
        let apart = other - self;
        let farthest = (apart.high.abs() + apart.error) * Bounded::GROW;
        let error = self.error.max(other.error + farthest);
        // Numbers that may be equal are not told from each other, nor much farther apart than each is known.
        let equal = matches!(apart.sign(), Ok(Ordering::Equal) | Err(Undecided));
        (equal && error.is_finite()).then_some(Self { error, ..self })
    }

    fn up_to(self, more: f64) -> Option<Self> {
        let half = 0.5 * more;
        Some(if more == 0.0 {
            self
        } else {
            self + Self {
                error: half * Bounded::GROW + TINY,
                ..Self::exact(half)
            }
        })
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.high
    }

    #[inline]
    fn enclosure(self) -> Bounded {
        Bounded {
            value: self.high,
            error: self.error + self.low.abs(),
        }
    }

    fn nearest_f32(self) -> Result<f32, Undecided> {
        nearest_f32_by_middle(self, self.enclosure())
    }
}

#[cfg(test)]
mod tests;

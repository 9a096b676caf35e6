//! f64 with a running error bound: a [`Real`] that knows when f64 is too coarse.
//!
//! The bound is that of floating point to nearest: an operation's result r̂ differs from the exact result on its computed
//! operands by at most u·|r̂|, u = 2⁻⁵³ (and by the smallest subnormal), and the operands' own errors are carried along to
//! first order with their products included. The bound's own roundings, a few u for each operation, are covered when it is
//! used: by a part in 10⁹, good for a million operations in a row. A NaN on either side decides nothing.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_ratio::Relaxed as Ratio;

use super::{Real, Undecided};

/// A number within `error` of `value`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounded {
    /// The f64 result.
    pub value: f64,
    /// How far the exact number may lie from it; infinite where nothing is known.
    pub error: f64,
}

/// Unit roundoff of f64.
const U: f64 = 1.0 / 9_007_199_254_740_992.0;
/// What the roundings of the bound itself may add up to.
const GROW: f64 = 1.0 + 1e-9;
/// The smallest subnormal: what a result may lose where it underflows.
const TINY: f64 = f64::from_bits(1);

impl Bounded {
    /// A computed value whose operands' errors contribute `carried`.
    #[inline(always)]
    fn rounded(value: f64, carried: f64) -> Self {
        Self {
            value,
            error: carried + (U * value.abs() + TINY),
        }
    }
}

impl Add for Bounded {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::rounded(self.value + o.value, self.error + o.error)
    }
}

impl Sub for Bounded {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::rounded(self.value - o.value, self.error + o.error)
    }
}

impl Mul for Bounded {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let carried =
            self.value.abs() * o.error + o.value.abs() * self.error + self.error * o.error;
        Self::rounded(self.value * o.value, carried)
    }
}

impl Div for Bounded {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let least = o.value.abs() - o.error;
        if least <= 0.0 {
            return Self {
                value,
                error: f64::INFINITY,
            };
        }
        Self::rounded(value, (self.error + value.abs() * o.error) / least)
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

    #[inline(always)]
    fn ratio(value: &Ratio) -> Self {
        Self::rounded(f64::ratio(value), 0.0)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // √(a ± e) lies within e/√a of √a, and within √e where a is that small.
        let value = self.value.max(0.0).sqrt();
        let carried = if self.value > self.error {
            self.error / value
        } else {
            (2.0 * self.error).sqrt()
        };
        Self::rounded(value, carried)
    }

    #[inline(always)]
    fn pow(self, exponent: f64) -> Self {
        // d(xⁿ) = n·xⁿ⁻¹·dx; the library's own error is taken as 2⁻⁵⁰, since none is promised.
        let value = self.value.powf(exponent);
        let least = self.value - self.error;
        if least <= 0.0 {
            return Self {
                value,
                error: f64::INFINITY,
            };
        }
        let slope = exponent.abs()
            * value
                .max(least.powf(exponent))
                .max((self.value + self.error).powf(exponent));
        Self::rounded(value, slope * self.error / least + 8.0 * U * value)
    }

    #[inline(always)]
    fn cos_degrees(angle: f64) -> Self {
        let value = f64::cos_degrees(angle);
        let exact = [60.0, 90.0, 120.0, 180.0].contains(&angle);
        if exact {
            Self::exact(value)
        } else {
            Self {
                value,
                error: 8.0 * U,
            }
        }
    }

    #[inline(always)]
    fn sign(self) -> Result<Ordering, Undecided> {
        if self.value.abs() > self.error * GROW || self.error == 0.0 {
            self.value.sign()
        } else {
            Err(Undecided)
        }
    }

    #[inline(always)]
    fn floor(self) -> Result<f64, Undecided> {
        let low = self.value.floor();
        if self.error == 0.0 {
            return Ok(low);
        }
        // Both differences are exact, or as good as: they are at most 1, and value has the bits.
        let margin = self.error * GROW;
        if self.value - low > margin && low + 1.0 - self.value > margin {
            Ok(low)
        } else {
            Err(Undecided)
        }
    }

    #[inline(always)]
    fn approx(self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::exact::{Ratio, abs, ratio};

    /// Every bound holds against exact arithmetic, and is not absurdly wide.
    #[test]
    fn the_bound_contains_the_exact_result() {
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5)
                * ((state % 13) as f64 - 6.0).exp2()
        };
        let mut worst: f64 = 0.0;
        for _ in 0..20_000 {
            let (a, b, c, d) = (next(), next(), next(), next());
            let x = Bounded::exact(a) * Bounded::exact(b) - Bounded::exact(c) * Bounded::exact(d);
            let exact: Ratio = ratio(a) * ratio(b) - ratio(c) * ratio(d);
            let off = abs(ratio(x.value) - exact);
            assert!(off <= ratio(x.error), "{a} {b} {c} {d}");
            worst = worst.max(off.to_f64().value() / x.error);
            let q = Bounded::exact(a) / Bounded::exact(b) + Bounded::exact(c);
            let exact = ratio(a) / ratio(b) + ratio(c);
            assert!(abs(ratio(q.value) - exact) <= ratio(q.error), "{a} {b} {c}");
            let r = (Bounded::exact(a) * Bounded::exact(a) + Bounded::exact(b)).sqrt();
            let square = ratio(a) * ratio(a) + ratio(b);
            if square >= ratio(0.0) {
                let (low, high) = (ratio(r.value - r.error), ratio(r.value + r.error));
                assert!(low <= ratio(0.0) || &low * &low <= square, "{a} {b}");
                assert!(&high * &high >= square, "{a} {b}");
            }
        }
        assert!(worst > 0.3, "the bound is {worst} of what it should be");
    }

    #[test]
    fn what_it_cannot_tell_is_undecided() {
        let third = Bounded::exact(1.0) / Bounded::exact(3.0);
        let nothing = third * Bounded::exact(3.0) - Bounded::exact(1.0);
        assert_eq!(nothing.sign(), Err(Undecided));
        assert_eq!((third * Bounded::exact(3.0)).floor(), Err(Undecided));
        assert_eq!(third.sign(), Ok(Ordering::Greater));
        assert_eq!(third.floor(), Ok(0.0));
        assert_eq!((Bounded::exact(1.0) / nothing).sign(), Err(Undecided));
        assert_eq!(Bounded::exact(2.0).floor(), Ok(2.0));
    }
}

//! Pairs of f64 with an error bound: about 100 bits, for the pixels that f64 cannot decide.
//!
//! A value is the unevaluated sum hi + lo, |lo| ≤ ulp(hi)/2 (Dekker 1971; Knuth's two-sum; products by fused multiply-add).
//! Sums, products, quotients and roots are within 2⁻⁹⁸ of exact on their operands, well above the 2⁻¹⁰¹ or better of the
//! algorithms. What differs from a border by no more than the bound is *presumed* to lie on it: with numbers of a scene
//! file an exact tie is all but certain then, where f64 would decide by its rounding errors.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_ratio::Relaxed as Ratio;

use super::{Real, Undecided};
use crate::prepare::exact::ratio;

/// A number within `error` of hi + lo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DoubleDouble {
    hi: f64,
    lo: f64,
    error: f64,
    /// Whether everything behind the number is known to about 100 bits: then what cannot be told from a border is
    /// presumed to lie on it. Library functions that promise no more than f64 make it false.
    fine: bool,
}

/// A sum whose terms are known this well, relatively, is presumed to be 0 where its bound allows it.
const PRESUMED: f64 = 1.0 / (1_u64 << 60) as f64;

/// Relative error of an operation.
const U: f64 = 1.0 / (1_u128 << 98) as f64;

/// a + b exactly, as a sum and its rounding error.
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// a · b exactly, as a product and its rounding error.
#[inline]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    (p, a.mul_add(b, -p))
}

impl DoubleDouble {
    #[inline]
    fn new(hi: f64, lo: f64, carried: f64, fine: bool) -> Self {
        let (hi, lo) = two_sum(hi, lo);
        // The bound's own roundings are covered by a part in 2⁴⁰; underflow by the smallest normal number.
        let error = (carried + U * hi.abs()) * (1.0 + 1e-12) + f64::MIN_POSITIVE;
        Self {
            hi,
            lo,
            error: if (hi + error).is_nan() {
                f64::INFINITY
            } else {
                error
            },
            fine,
        }
    }

    /// Near to value, with what f64's own functions leave of its accuracy.
    #[inline]
    fn coarse(value: f64, error: f64) -> Self {
        Self {
            hi: value,
            lo: 0.0,
            error,
            fine: false,
        }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        let (s, e) = two_sum(self.hi, o.hi);
        let (t, f) = two_sum(self.lo, o.lo);
        let (s, e) = two_sum(s, e + t);
        let error = self.error + o.error;
        // Where errors have grown, as they do from mirror to mirror, a small difference says nothing about a tie.
        // (Terms that are 0 but for rounding are measured against the viewpoint's distance, which is about 1.)
        let known = error <= PRESUMED * (self.hi.abs() + o.hi.abs()).max(1.0);
        Self::new(s, e + f, error, known && self.fine && o.fine)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let (p, e) = two_product(self.hi, o.hi);
        let e = e + (self.hi * o.lo + self.lo * o.hi);
        let carried = self.hi.abs() * o.error + o.hi.abs() * self.error + self.error * o.error;
        Self::new(p, e, carried * (1.0 + 1e-15), self.fine && o.fine)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        let least = o.hi.abs() * (1.0 - 1e-15) - o.error;
        let q = self.hi / o.hi;
        if least <= 0.0 {
            return Self::coarse(q, f64::INFINITY);
        }
        // One step of long division: the remainder of the first quotient, over again.
        let (p, e) = two_product(q, o.hi);
        let remainder = (self.hi - p) - e + self.lo - q * o.lo;
        let carried = (self.error + q.abs() * o.error) / least;
        Self::new(
            q,
            remainder / o.hi,
            carried * (1.0 + 1e-15),
            self.fine && o.fine,
        )
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
            ..self
        }
    }
}

impl Real for DoubleDouble {
    #[inline]
    fn exact(value: f64) -> Self {
        Self {
            hi: value,
            lo: 0.0,
            error: 0.0,
            fine: true,
        }
    }

    #[inline]
    fn ratio(value: &Ratio) -> Self {
        let hi = value.to_f64().value();
        let lo = (value.clone() - ratio(hi)).to_f64().value();
        Self::new(hi, lo, 0.0, true)
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.hi.max(0.0).sqrt();
        if self.hi <= self.error {
            // √(a ± e) lies within √(a + e) of 0 and of √a.
            return Self {
                error: (2.0 * self.error).sqrt(),
                ..Self::coarse(root, 0.0)
            }
            .with_fine(self.fine);
        }
        // One Newton step from the f64 root: the remainder over twice the root.
        let (p, e) = two_product(root, root);
        let remainder = (self.hi - p) - e + self.lo;
        Self::new(root, remainder / (2.0 * root), self.error / root, self.fine)
    }

    #[inline]
    fn pow(self, exponent: f64) -> Self {
        if exponent.fract() == 0.0 && exponent <= 1e9 {
            // By squaring, so that the error stays that of products.
            let (mut result, mut square) = (Self::exact(1.0), self);
            let mut n = exponent as u64;
            while n > 0 {
                if n & 1 == 1 {
                    result = result * square;
                }
                square = square * square;
                n >>= 1;
            }
            return result;
        }
        let value = self.hi.powf(exponent);
        Self::coarse(
            value,
            value * (exponent * (self.error / self.hi + 1e-15) + 1e-15),
        )
    }

    #[inline]
    fn cos_degrees(angle: f64) -> Self {
        let value = f64::cos_degrees(angle);
        let exact = [60.0, 90.0, 120.0, 180.0].contains(&angle);
        if exact {
            Self::exact(value)
        } else {
            Self::coarse(value, 1e-15)
        }
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Undecided> {
        if self.fine && self.hi.abs() <= self.error && self.error.is_finite() {
            return Ok(Ordering::Equal);
        }
        self.hi.sign()
    }

    #[inline]
    fn floor(self) -> Result<f64, Undecided> {
        if self.hi.abs() >= 1.0 / f64::EPSILON {
            // hi is an integer, and its sum with lo's floor need not be an f64.
            return Ok(self.hi + self.lo.floor());
        }
        let nearest = self.hi.round();
        let above = (self.hi - nearest) + self.lo;
        if above.is_nan() {
            return Err(Undecided);
        }
        let presumed =
            self.fine && self.error <= PRESUMED * self.hi.abs().max(1.0) && -above <= self.error;
        Ok(if above < 0.0 && !presumed {
            nearest - 1.0
        } else {
            nearest
        })
    }

    #[inline]
    fn approx(self) -> f64 {
        self.hi
    }
}

impl DoubleDouble {
    #[inline]
    fn with_fine(self, fine: bool) -> Self {
        Self { fine, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::exact::abs;

    fn off(x: DoubleDouble, exact: &Ratio) -> Ratio {
        abs(ratio(x.hi) + ratio(x.lo) - exact.clone())
    }

    #[test]
    fn the_bound_contains_the_exact_result() {
        let mut state = 7_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5)
                * ((state % 13) as f64 - 6.0).exp2()
        };
        let mut widest: f64 = 0.0;
        for _ in 0..5000 {
            let (a, b, c) = (next(), next(), next());
            let (x, y, z) = (
                DoubleDouble::exact(a),
                DoubleDouble::exact(b),
                DoubleDouble::exact(c),
            );
            let (ra, rb, rc) = (ratio(a), ratio(b), ratio(c));
            let value = x / y + y / z - x * z;
            let exact = &ra / &rb + &rb / &rc - &ra * &rc;
            assert!(off(value, &exact) <= ratio(value.error), "{a} {b} {c}");
            widest = widest.max(value.error / value.hi.abs());
            let square = x * x + y * y;
            let root = square.sqrt();
            let middle = ratio(root.hi) + ratio(root.lo);
            let exact = &ra * &ra + &rb * &rb;
            let (low, high) = (&middle - ratio(root.error), &middle + ratio(root.error));
            assert!(&low * &low <= exact && exact <= &high * &high, "{a} {b}");
        }
        assert!(widest < 1e-20, "a bound of {widest} decides nothing");
    }

    #[test]
    fn a_tie_is_presumed_and_a_near_miss_is_not() {
        let third = DoubleDouble::exact(1.0) / DoubleDouble::exact(3.0);
        let one = third * DoubleDouble::exact(3.0);
        assert_eq!((one - DoubleDouble::exact(1.0)).sign(), Ok(Ordering::Equal));
        assert_eq!(one.floor(), Ok(1.0));
        let less = one - DoubleDouble::exact(1e-25);
        assert_eq!(less.floor(), Ok(0.0));
        assert_eq!((less - DoubleDouble::exact(1.0)).sign(), Ok(Ordering::Less));
    }

    #[test]
    fn powers_of_whole_numbers_are_fine() {
        let x = DoubleDouble::exact(0.1).pow(7.0);
        let r = ratio(0.1);
        let exact = &r * &r * &r * &r * &r * &r * &r;
        assert!(x.fine && off(x, &exact) <= ratio(x.error));
        assert!(!DoubleDouble::exact(0.1).pow(7.5).fine);
    }
}

//! f64 with a running error bound: a [`Real`] that knows when f64 is too coarse.
//!
//! The bound is that of floating point to nearest: a result r̂ differs from the exact result on its computed operands by at
//! most u·|r̂|, u = 2⁻⁵³, and by half the smallest subnormal where it underflows; the operands' own errors are carried along.
//! The bound is itself computed in f64. All its terms are ≥ 0, so that it is low by a part in 10¹⁵ or so for each of the
//! operations behind it; wherever it is used it is made larger by a part in 10⁸, which is enough for ten million operations
//! in a row. Nothing is decided by a NaN or an infinity. docs/NUMERICS.md, section 8, derives each bound.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_ratio::Relaxed as Ratio;

use super::float::whole_below;
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
/// What underflow may take: half the smallest subnormal from the result, and from each of up to seven terms of the bound.
const TINY: f64 = f64::from_bits(4);

impl Bounded {
    /// What the roundings of the bound itself may add up to: where a bound is used, it is multiplied by this.
    pub const GROW: f64 = 1.0 + 1e-8;

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
                result = result * square;
            }
            exponent = (exponent / 2.0).floor();
            if exponent == 0.0 {
                return result;
            }
            square = square * square;
        }
    }

    /// The power with an exponent in [0, 1), by a square root for each bit of it, until a root is so near to 1 that three
    /// terms of the binomial series do for the rest.
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
                // (1 − ε)ˢ = 1 − sε − s(1 − s)/2·ε² − …, what is left out is at most 0.07·|ε|³ for 0 ≤ s ≤ 1.
                let s = Self::exact(exponent);
                let bend = s * (one - s) * Self::exact(0.5);
                let mut rest = one - off * (s + bend * off);
                let wide = off.value.abs() + off.error;
                rest.error += 0.07 * wide * wide * wide;
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

/// What the factors' errors make of that of their product.
#[inline(always)]
fn carried(a: Bounded, b: Bounded) -> f64 {
    (a.value.abs() + a.error) * b.error + b.value.abs() * a.error
}

/// A divisor whose relative error is below this is divided by as it is.
const NEARLY: f64 = 1.0 / 1_048_576.0;

/// Where a root counts as near to 1.
const NEAR_ONE: f64 = 1.0 / 131_072.0;

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
        let near = f64::ratio(value);
        let exact = near.is_finite() && crate::prepare::exact::ratio(near) == *value;
        Self {
            value: near,
            error: if exact { 0.0 } else { U * near.abs() + TINY },
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
        if self.value - self.error * Self::GROW <= 0.0 {
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
        // Both differences are exact, or rounded to no less than they are wide: they are at most 1.
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

    #[inline(always)]
    fn approx(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn near(self) -> Self {
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
        // The product's rounding and those below are within 4u of it.
        let margin = (255.0 * (Self::GROW + 1e-12)) * self.error + (4.0 * U) * scaled.abs();
        if scaled + margin < 1.0 {
            return Ok(0);
        }
        if scaled - margin >= 255.0 {
            return Ok(255);
        }
        // No decision by a NaN: it is neither.
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
mod tests {
    use super::*;
    use crate::prepare::exact::{Ratio, abs, ratio};

    /// Random numbers of many sizes, and numbers next to powers of two and to each other.
    fn random() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let value = (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5;
            match (state >> 7) % 8 {
                0 => 1.0 + value * 4.0 * f64::EPSILON,
                1 => value * 1e-8 + 1.0,
                2 => value * ((state % 61) as f64 - 30.0).exp2(),
                3 => ((state % 100) as f64) / 10.0,
                _ => value * ((state % 13) as f64 - 6.0).exp2(),
            }
        }
    }

    /// Whether the exact number lies within the bound, the bound times `scale` taken.
    fn holds(x: Bounded, exact: &Ratio, scale: f64) -> bool {
        abs(ratio(x.value) - exact) <= ratio(x.error * Bounded::GROW * scale)
    }

    /// The same of a root, by squares.
    fn holds_root(x: Bounded, square: &Ratio, scale: f64) -> bool {
        let error = ratio(x.error * Bounded::GROW * scale);
        let (low, high) = (ratio(x.value) - &error, ratio(x.value) + error);
        (low <= Ratio::ZERO || &low * &low <= *square) && &high * &high >= *square
    }

    /// How many results of random expressions lie outside of their bounds scaled; and how near the worst comes to its bound.
    fn outside(scale: f64, count: usize) -> (usize, f64) {
        let mut next = random();
        let (mut outside, mut worst) = (0, 0.0_f64);
        for _ in 0..count {
            let (a, b, c, d) = (next(), next(), next(), next());
            let [x, y, z, w] = [a, b, c, d].map(Bounded::exact);
            let [ra, rb, rc, rd] = [a, b, c, d].map(ratio);
            let cross = x * y - z * w;
            let exact = &ra * &rb - &rc * &rd;
            let mut check = |good: bool| outside += usize::from(!good);
            check(holds(cross, &exact, scale));
            if cross.error > 0.0 {
                let off = abs(ratio(cross.value) - &exact).to_f64().value();
                worst = worst.max(off / cross.error);
            }
            check(holds(cross.times(d), &(&exact * &rd), scale));
            check(holds(cross.abs().unwrap(), &abs(exact.clone()), scale));
            if b != 0.0 && exact != Ratio::ZERO {
                let quotient = x / y + z;
                check(holds(quotient, &(&ra / &rb + &rc), scale));
                // By what has an error, some of them larger than the number.
                let quotient = z / cross;
                if quotient.error.is_finite() {
                    check(holds(quotient, &(&rc / &exact), scale));
                }
            }
            let square = &ra * &ra + &exact * &exact;
            check(holds_root((x * x + cross * cross).sqrt(), &square, scale));
        }
        (outside, worst)
    }

    #[test]
    fn the_bound_contains_the_exact_result() {
        let (outside, worst) = outside(1.0, 200_000);
        assert_eq!(outside, 0);
        // And is not absurdly wide.
        assert!(worst > 0.5, "the bound is never nearer than {worst}");
    }

    #[test]
    fn a_bound_that_is_too_small_is_noticed() {
        assert!(outside(0.0, 1000).0 > 500);
        assert!(outside(0.3, 20_000).0 > 0);
    }

    #[test]
    fn underflow_and_overflow_decide_nothing_wrong() {
        let tiny = Bounded::exact(5e-324);
        for x in [
            tiny * tiny,
            tiny * Bounded::exact(0.25),
            tiny / Bounded::exact(3.0),
        ] {
            assert_eq!(x.sign(), Err(Undecided), "{x:?}");
        }
        let huge = Bounded::exact(1e308);
        for x in [huge * huge, huge + huge, (huge * huge).sqrt(), huge / tiny] {
            assert_eq!(x.sign(), Err(Undecided), "{x:?}");
            assert_eq!(x.floor(), Err(Undecided));
            assert_eq!(x.byte(), Err(Undecided));
            assert_eq!(x.nearest_f32(), Err(Undecided));
        }
        let nothing = huge * huge - huge * huge;
        assert!(nothing.sign().is_err() && nothing.byte().is_err());
        assert!(nothing.sqrt().sign().is_err() && (tiny / nothing).sign().is_err());
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
        assert_eq!((-third).floor(), Ok(-1.0));
        assert_eq!((-third).floor_mod(7), Ok(6));
    }

    #[test]
    fn bytes_and_f32_are_those_of_all_the_interval() {
        let mut next = random();
        let (mut told, mut all) = (0, 0);
        for _ in 0..100_000 {
            let (v, e) = (next().abs(), (next() * 1e-3).powi(4));
            let x = Bounded { value: v, error: e };
            let ends = [(v - e).max(0.0), v + e];
            all += 1;
            if let Ok(byte) = x.byte() {
                told += 1;
                for end in ends {
                    let exact = (ratio(end) * ratio(255.0)).canonicalize().floor();
                    let exact = u8::try_from(exact).unwrap_or(255);
                    assert_eq!(byte, exact, "{x:?}");
                }
            }
            if let Ok(single) = x.nearest_f32() {
                assert!(ends.iter().all(|&end| end as f32 == single), "{x:?}");
            }
        }
        assert!(told * 4 > all * 3, "only {told} of {all} told");
    }
}

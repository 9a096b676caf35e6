//! Numbers of any precision with a bound on their error, and of any size: f64 neither overflows nor underflows here.

use std::cmp::Ordering;

use dashu_base::{BitTest, SquareRoot};
use dashu_int::{IBig, UBig};

use super::mag::{Low, Mag, top};
use crate::real::rational::Ratio;
use crate::real::{Bounded, Pair};

/// Every real within `rad` of mid·2^exp.
#[derive(Debug, Clone)]
pub(super) struct Ball {
    mid: IBig,
    exp: i64,
    rad: Mag,
}

/// Exponents beyond this are taken as infinite, or as zero within so little.
const FARTHEST: i64 = 1 << 60;

impl Ball {
    pub(super) fn zero() -> Self {
        Self {
            mid: IBig::ZERO,
            exp: 0,
            rad: Mag::ZERO,
        }
    }

    /// A finite f64, exactly.
    pub(super) fn exact(value: f64) -> Self {
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i64;
        let fraction = bits & ((1 << 52) - 1);
        let (m, exp) = if biased == 0 {
            (fraction, -1074)
        } else {
            (fraction | (1 << 52), biased - 1075)
        };
        let mid = IBig::from(if value < 0.0 { -(m as i64) } else { m as i64 });
        Self {
            mid,
            exp,
            rad: Mag::ZERO,
        }
    }

    /// An integer times a power of two, within a unit of it.
    pub(super) fn new(mid: IBig, exp: i64, rad: Mag) -> Self {
        Self { mid, exp, rad }
    }

    /// A rational number.
    pub(super) fn ratio(value: &Ratio, bits: usize) -> Option<Self> {
        let over = |mid: IBig| Self {
            mid,
            exp: 0,
            rad: Mag::ZERO,
        };
        let numerator = over(value.numerator().clone());
        numerator.div(&over(IBig::from(value.denominator().clone())), bits)
    }

    /// The middle: an integer times a power of two.
    #[cfg(test)]
    pub(super) fn middle(self) -> (IBig, i64) {
        (self.mid, self.exp)
    }

    /// The exponent of the middle's highest bit; None for 0.
    fn height(&self) -> Option<i64> {
        (!self.mid.is_zero()).then(|| self.exp + self.mid.bit_len() as i64)
    }

    /// Keeps so many bits of the middle, and counts what is cut off.
    fn rounded(mut self, bits: usize) -> Option<Self> {
        let has = self.mid.bit_len();
        if has > bits {
            let cut = has - bits;
            self.mid >>= cut;
            self.exp += cut as i64;
            self.rad = self.rad.add(Mag::two_to(self.exp));
        }
        let least = self.height().unwrap_or(0);
        let widest = if self.rad.is_zero() {
            0
        } else {
            self.rad.exponent()
        };
        if least > FARTHEST || widest > FARTHEST {
            return None;
        }
        if least < -FARTHEST {
            self.rad = self.rad.add(Mag::two_to(-FARTHEST));
            self.mid = IBig::ZERO;
            self.exp = 0;
        }
        if widest < -FARTHEST {
            self.rad = Mag::two_to(-FARTHEST);
        }
        Some(self)
    }

    pub(super) fn neg(&self) -> Self {
        Self {
            mid: -&self.mid,
            ..*self
        }
    }

    pub(super) fn add(&self, o: &Self, bits: usize) -> Option<Self> {
        let rad = self.rad.add(o.rad);
        let (Some(a), Some(b)) = (self.height(), o.height()) else {
            let some = if self.mid.is_zero() { o } else { self };
            return Self {
                rad,
                ..some.clone()
            }
            .rounded(bits);
        };
        // A term below the last bit that is kept counts as error.
        let reach = bits as i64 + 8;
        if a - b > reach || b - a > reach {
            let (big, small) = if a > b { (self, o) } else { (o, self) };
            let rad = rad.add(Mag::above(&small.mid, small.exp));
            return Self { rad, ..big.clone() }.rounded(bits);
        }
        let (high, low) = if self.exp >= o.exp {
            (self, o)
        } else {
            (o, self)
        };
        let mid = (&high.mid << ((high.exp - low.exp) as usize)) + &low.mid;
        Self {
            mid,
            exp: low.exp,
            rad,
        }
        .rounded(bits)
    }

    pub(super) fn mul(&self, o: &Self, bits: usize) -> Option<Self> {
        let (a, b) = (Mag::above(&self.mid, self.exp), Mag::above(&o.mid, o.exp));
        let rad = a.mul(o.rad).add(b.mul(self.rad)).add(self.rad.mul(o.rad));
        Self {
            mid: &self.mid * &o.mid,
            exp: self.exp + o.exp,
            rad,
        }
        .rounded(bits)
    }

    /// The quotient; None where the divisor may be 0.
    pub(super) fn div(&self, o: &Self, bits: usize) -> Option<Self> {
        let least = Low::new(&o.mid, o.exp, o.rad)?;
        let shift = (bits + o.mid.bit_len() + 1).saturating_sub(self.mid.bit_len());
        let mid = (&self.mid << shift) / &o.mid;
        let exp = self.exp - o.exp - shift as i64;
        // |x/y − a/b| = |(x − a) − (a/b)(y − b)| / |y|, and a/b is the quotient within its last bit.
        let ulp = Mag::two_to(exp);
        let quotient = Mag::above(&mid, exp).add(ulp);
        let rad = self.rad.add(quotient.mul(o.rad)).div(least).add(ulp);
        Self { mid, exp, rad }.rounded(bits)
    }

    /// The root of a number that is known not to be negative; None if it is negative all the same.
    pub(super) fn sqrt(&self, bits: usize) -> Option<Self> {
        let positive = self.mid > IBig::ZERO;
        let nonzero = Low::new(&self.mid, self.exp, self.rad).is_some();
        if !positive || !nonzero {
            if nonzero {
                return None;
            }
            let most = Mag::above(&self.mid, self.exp).add(self.rad);
            let rad = if most.is_zero() { most } else { most.sqrt() };
            return Some(Self {
                rad,
                ..Self::zero()
            });
        }
        let mut shift = (2 * bits + 2).saturating_sub(self.mid.bit_len());
        shift += (self.exp - shift as i64).rem_euclid(2) as usize;
        let (_, magnitude) = (&self.mid << shift).into_parts();
        let root: UBig = magnitude.sqrt();
        let exp = (self.exp - shift as i64) / 2;
        let mid = IBig::from(root);
        // |√x − √a| ≤ |x − a|/√a.
        let mut rad = Mag::two_to(exp);
        if !self.rad.is_zero() {
            rad = rad.add(self.rad.div(Low::new(&mid, exp, Mag::ZERO)?));
        }
        Self { mid, exp, rad }.rounded(bits)
    }

    /// The sign, if all of the ball has one.
    pub(super) fn sign(&self) -> Option<Ordering> {
        if self.mid.is_zero() && self.rad.is_zero() {
            return Some(Ordering::Equal);
        }
        Low::new(&self.mid, self.exp, self.rad)?;
        Some(self.mid.cmp(&IBig::ZERO))
    }

    /// The integer nearest to the middle, if the ball is narrower than a quarter and the integer has few enough bits.
    pub(super) fn integer(&self) -> Option<IBig> {
        if !self.rad.is_zero() && self.rad.exponent() >= -2 {
            return None;
        }
        let height = self.height().unwrap_or(0);
        if height > 1 << 16 {
            return None;
        }
        if self.exp >= 0 {
            return Some(&self.mid << self.exp as usize);
        }
        if height < -1 {
            return Some(IBig::ZERO);
        }
        // Rounding to the nearest integer is the floor of the number plus one half.
        let cut = (-self.exp) as usize;
        Some((&self.mid + (IBig::ONE << (cut - 1))) >> cut)
    }

    /// The ball as a pair of f64.
    pub(super) fn pair(&self) -> Pair {
        let first = self.bounded().value;
        let rest = self.add(&Self::exact(-first), 256);
        Pair::from_parts(first, rest.map_or(self.bounded(), |rest| rest.bounded()))
    }

    /// The ball in f64.
    pub(super) fn bounded(&self) -> Bounded {
        let Some((bits, shift, more)) = top(&self.mid) else {
            return Bounded {
                value: 0.0,
                error: self.rad.to_f64(),
            };
        };
        let whole = bits & 0x7ff == 0 && !more;
        let e = self.exp + shift + 11;
        let m = (bits >> 11) as f64;
        let power = |e: i64| f64::from_bits(((1023 + e) as u64) << 52);
        let mut error = self.rad.to_f64();
        let size = if e > 960 {
            f64::INFINITY
        } else if e >= -1022 {
            m * power(e)
        } else if e >= -1080 {
            // May round to a subnormal.
            error += f64::from_bits(1);
            m * power(-1022) * power(e + 1022)
        } else {
            error += Mag::two_to(e + 53).to_f64();
            0.0
        };
        if !whole {
            // What was cut off: below one unit of the last of 53 bits.
            error += size * (2.0 * f64::EPSILON) + f64::from_bits(1);
        }
        let value = if self.mid > IBig::ZERO { size } else { -size };
        if size == f64::INFINITY {
            error = f64::INFINITY;
        }
        Bounded {
            value,
            error: error * (1.0 + 4.0 * f64::EPSILON),
        }
    }
}

//! Bounds of error: upper bounds of a few digits and of any size.

use dashu_int::IBig;

/// A number ≥ 0 that is not exceeded: m·2^e, m in [1, 2), or 0.
///
/// Results are rounded up by 2⁻⁵⁰, eight times what an operation on doubles in [1, 2) can be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mag {
    m: f64,
    e: i64,
}

/// Rounds up what an operation made of numbers of ordinary size.
const UP: f64 = 1.0 + 1.0 / (1_u64 << 50) as f64;
/// Twice what a difference of such numbers can be off.
const SLACK: f64 = 1.0 / (1_u64 << 50) as f64;

/// 2^e for |e| ≤ 1000.
fn power(e: i64) -> f64 {
    f64::from_bits(((1023 + e) as u64) << 52)
}

impl Mag {
    pub(super) const ZERO: Self = Self { m: 0.0, e: 0 };

    /// 2^e.
    pub(super) fn two_to(e: i64) -> Self {
        Self { m: 1.0, e }
    }

    /// m·2^e for an m of ordinary size (2⁻¹⁰⁰⁰ to 2¹⁰⁰⁰) or 0.
    fn new(m: f64, e: i64) -> Self {
        if m == 0.0 {
            return Self::ZERO;
        }
        let bits = m.to_bits();
        Self {
            m: f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52)),
            e: e + ((bits >> 52) as i64 - 1023),
        }
    }

    /// At least |mid|·2^exp, and at most 2⁻⁵⁰ above it.
    pub(super) fn above(mid: &IBig, exp: i64) -> Self {
        let Some((top, shift, more)) = top(mid) else {
            return Self::ZERO;
        };
        let m = (top >> 11) + u64::from(more || top & 0x7ff != 0);
        Self::new(m as f64, exp + shift + 11)
    }

    pub(super) fn is_zero(self) -> bool {
        self.m == 0.0
    }

    /// The exponent: the number is below 2^(e + 1). Only of numbers other than 0.
    pub(super) fn exponent(self) -> i64 {
        self.e
    }

    pub(super) fn add(self, o: Self) -> Self {
        if self.is_zero() || o.is_zero() {
            return if self.is_zero() { o } else { self };
        }
        let (big, small) = if self.e >= o.e { (self, o) } else { (o, self) };
        let gap = big.e - small.e;
        // What is 2⁶⁰ times smaller is covered by rounding up.
        let sum = if gap > 60 {
            big.m
        } else {
            big.m + small.m * power(-gap)
        };
        Self::new(sum * UP, big.e)
    }

    pub(super) fn mul(self, o: Self) -> Self {
        Self::new(self.m * o.m * UP, self.e + o.e)
    }

    /// The quotient by a number that is no more than what is meant.
    pub(super) fn div(self, o: Low) -> Self {
        Self::new(self.m / o.m * UP, self.e - o.e)
    }

    pub(super) fn sqrt(self) -> Self {
        let odd = self.e.rem_euclid(2);
        let m = if odd == 1 { 2.0 * self.m } else { self.m };
        Self::new(m.sqrt() * UP, (self.e - odd) / 2)
    }

    /// An f64 that is not less; infinite where there is none.
    pub(super) fn to_f64(self) -> f64 {
        if self.is_zero() {
            0.0
        } else if self.e > 1022 {
            f64::INFINITY
        } else if self.e < -1000 {
            // Beyond this every bound is as good as 2⁻¹⁰⁰⁰.
            if self.e < -1070 {
                f64::from_bits(16)
            } else {
                self.m * power(-1000) * power(self.e + 1000) + f64::from_bits(1)
            }
        } else {
            self.m * power(self.e)
        }
    }
}

/// A number > 0 that is not undercut: m·2^e.
#[derive(Debug, Clone, Copy)]
pub(super) struct Low {
    m: f64,
    e: i64,
}

impl Low {
    /// At most |mid|·2^exp − rad, if that is > 0.
    pub(super) fn new(mid: &IBig, exp: i64, rad: Mag) -> Option<Self> {
        let (top, shift, _) = top(mid)?;
        // In [1, 2), as top has its highest bit set.
        let m = (top >> 11) as f64 * power(-52);
        let e = exp + shift + 63;
        if rad.is_zero() {
            return Some(Self { m, e });
        }
        let gap = rad.e - e;
        if gap > 1 {
            return None;
        }
        let off = if gap < -60 { 0.0 } else { rad.m * power(gap) };
        let m = m - off - SLACK;
        (m > 0.0).then_some(Self { m, e })
    }
}

/// The 64 highest bits of |n|, the highest one set, how many lie below them (less than 0 for a small n), and whether
/// any word below is not 0. None for 0.
pub(super) fn top(n: &IBig) -> Option<(u64, i64, bool)> {
    let (_, words) = n.as_sign_words();
    let last = *words.last()?;
    let lead = last.leading_zeros();
    let below = words.len().checked_sub(2).map_or(0, |i| words[i]);
    let top = if lead == 0 {
        last
    } else {
        (last << lead) | (below >> (64 - lead))
    };
    let rest = if lead == 0 { below } else { below << lead };
    let more = rest != 0 || words.iter().rev().skip(2).any(|&w| w != 0);
    Some((top, 64 * (words.len() as i64 - 1) - i64::from(lead), more))
}

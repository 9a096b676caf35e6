//! Upper bounds in one machine word: what the radius of a ball is added up in, always rounded up.

use dashu_base::{Abs, BitTest};
use dashu_int::IBig;

/// An upper bound of a number that is not negative: `mantissa` · 2^`exponent`, mantissa < 2^62.
#[derive(Debug, Clone, Copy)]
pub(super) struct Upper {
    pub(super) mantissa: u64,
    pub(super) exponent: i64,
}

impl Upper {
    pub(super) const ZERO: Self = Self {
        mantissa: 0,
        exponent: 0,
    };

    pub(super) fn new(mantissa: u128, exponent: i64) -> Self {
        let excess = (128 - i64::from(mantissa.leading_zeros()) - 61).max(0);
        Self {
            mantissa: ceil_shift(mantissa, excess) as u64,
            exponent: exponent + excess,
        }
    }

    /// At least |`n`| · 2^`exponent`.
    pub(super) fn of(n: &IBig, exponent: i64) -> Self {
        let bits = n.bit_len() as i64;
        if bits <= 61 {
            let magnitude = u64::try_from(n.clone().abs()).expect("at most 61 bits");
            return Self::new(u128::from(magnitude), exponent);
        }
        let excess = bits - 61;
        let high = u64::try_from(n.clone().abs() >> excess as usize).expect("at most 61 bits");
        Self::new(u128::from(high) + 1, exponent + excess)
    }

    pub(super) fn plus(self, other: Self) -> Self {
        if self.mantissa == 0 {
            return other;
        }
        if other.mantissa == 0 {
            return self;
        }
        let (high, low) = if self.exponent >= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        let apart = high.exponent - low.exponent;
        let left = apart.min(60);
        let sum = (u128::from(high.mantissa) << left)
            + ceil_shift(u128::from(low.mantissa), apart - left);
        Self::new(sum, high.exponent - left)
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self::new(
            u128::from(self.mantissa) * u128::from(other.mantissa),
            self.exponent + other.exponent,
        )
    }

    /// Divided by a positive whole number.
    pub(super) fn over(self, divisor: &IBig) -> Self {
        let excess = (divisor.bit_len() as i64 - 60).max(0);
        // Cut off, so no larger than it is.
        let low = u64::try_from(divisor.clone() >> excess as usize).expect("at most 60 bits");
        let quotient = (u128::from(self.mantissa) << 64).div_ceil(u128::from(low));
        Self::new(quotient, self.exponent - 64 - excess)
    }
}

/// n / 2^shift, rounded up.
pub(super) fn ceil_shift(n: u128, shift: i64) -> u128 {
    match shift {
        0 => n,
        1..=127 => (n >> shift) + u128::from(n & ((1 << shift) - 1) != 0),
        _ => u128::from(n != 0),
    }
}

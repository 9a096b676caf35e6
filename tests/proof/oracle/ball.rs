//! Balls: a whole number times a power of two, give or take a radius. Every operation returns a ball that holds the
//! exact result for all operands in the balls given; only whole numbers are computed with, so nothing rounds unseen.
//!
//! The bottom of the oracle: `real` evaluates its expressions in balls, of few bits first, of more where it must.

use std::cmp::Ordering;

use dashu_base::{Abs, BitTest, SquareRoot};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use super::upper::{Upper, ceil_shift};

/// Numbers beyond 2^FAR or below 2^-FAR are not told apart: exponents never overflow.
const FAR: i64 = 1 << 40;

/// Bits that a radius may have.
const RADIUS_BITS: i64 = 32;

/// All reals that lie at most `radius` · 2^`exponent` from `middle` · 2^`exponent`.
#[derive(Debug, Clone)]
pub(crate) struct Ball {
    middle: IBig,
    /// Below 2^[`RADIUS_BITS`] + 2; [`WHOLE`] where nothing is known.
    radius: u64,
    exponent: i64,
}

/// The radius of the whole line.
const WHOLE: u64 = u64::MAX;

/// n · 2^shift, rounded down.
fn floor_shift(n: &IBig, shift: i64) -> IBig {
    if shift >= 0 {
        n << shift as usize
    } else {
        // Whole numbers shift right as if in two's complement: downwards.
        n >> (-shift) as usize
    }
}

impl Ball {
    /// The whole line: nothing is known.
    fn whole() -> Self {
        Self {
            middle: IBig::ZERO,
            radius: WHOLE,
            exponent: 0,
        }
    }

    /// A whole number, exactly, if it has no more bits than `bits`.
    pub(crate) fn integer(n: &IBig, bits: usize) -> Self {
        Self::new(n.clone(), 0, Upper::ZERO, bits)
    }

    /// A ratio of whole numbers.
    pub(crate) fn ratio(ratio: &RBig, bits: usize) -> Self {
        let over = Self::integer(ratio.numerator(), bits + 8);
        let under = Self::integer(ratio.denominator().as_ibig(), bits + 8);
        over.div(&under, bits)
    }

    /// `middle` · 2^`exponent`, give or take `error` · 2^`exponent`.
    pub(crate) fn around(middle: IBig, error: &IBig, exponent: i64, bits: usize) -> Self {
        Self::new(middle, exponent, Upper::of(error, exponent), bits)
    }

    /// `middle` · 2^`exponent` give or take `radius`, in about `bits` bits.
    fn new(middle: IBig, exponent: i64, radius: Upper, bits: usize) -> Self {
        let middle_bits = middle.bit_len() as i64;
        let mut shift = middle_bits - bits as i64;
        if radius.mantissa == 0 {
            shift = shift.max(0);
        } else {
            let radius_bits =
                64 - i64::from(radius.mantissa.leading_zeros()) + radius.exponent - exponent;
            let least = radius_bits - RADIUS_BITS;
            shift = if middle_bits == 0 {
                least
            } else {
                shift.max(least)
            };
        }
        let exact = shift <= 0 || middle.trailing_zeros().is_none_or(|n| n as i64 >= shift);
        let shifted = if shift == 0 {
            middle
        } else {
            floor_shift(&middle, -shift)
        };
        let exponent = exponent + shift;
        let up = radius.exponent - exponent;
        let mut ball_radius = if radius.mantissa == 0 {
            0
        } else if up >= 0 {
            radius.mantissa << up
        } else {
            ceil_shift(u128::from(radius.mantissa), -up) as u64
        };
        ball_radius += u64::from(!exact);
        let top = exponent + (shifted.bit_len() as i64).max(RADIUS_BITS + 2);
        if top > FAR {
            return Self::whole();
        }
        if top < -FAR && !(shifted.is_zero() && ball_radius == 0) {
            // It lies within 2^-FAR of zero.
            return Self {
                middle: IBig::ZERO,
                radius: 1,
                exponent: -FAR,
            };
        }
        Self {
            middle: shifted,
            radius: ball_radius,
            exponent,
        }
    }

    fn is_whole(&self) -> bool {
        self.radius == WHOLE
    }

    fn radius(&self) -> Upper {
        Upper::new(u128::from(self.radius), self.exponent)
    }

    /// Whether there is but one number in the ball.
    pub(crate) fn is_exact(&self) -> bool {
        self.radius == 0
    }

    /// The number itself, if there is but one in the ball and it has not very many digits.
    pub(crate) fn exact(&self) -> Option<RBig> {
        if self.radius != 0 {
            return None;
        }
        if self.exponent.abs() > 1 << 16 {
            return None;
        }
        let (up, down) = (self.exponent.max(0), (-self.exponent).max(0));
        Some(RBig::from_parts(
            &self.middle << up as usize,
            UBig::ONE << down as usize,
        ))
    }

    /// Whether there is but one number in the ball, this one.
    pub(crate) fn is_exactly(&self, n: i64) -> bool {
        self.radius == 0
            && if n == 0 {
                self.middle.is_zero()
            } else {
                self.exponent.abs() < 64 && self.exact() == Some(RBig::from(n))
            }
    }

    /// Bits of the middle that the radius leaves certain; all where there is but one number in the ball.
    pub(crate) fn certain_bits(&self) -> usize {
        let uncertain = u64::BITS - self.radius.leading_zeros();
        match self.radius {
            0 => usize::MAX,
            _ => self.middle.bit_len().saturating_sub(uncertain as usize),
        }
    }

    pub(crate) fn neg(&self) -> Self {
        Self {
            middle: -&self.middle,
            ..self.clone()
        }
    }

    pub(crate) fn add(&self, other: &Self, bits: usize) -> Self {
        if self.is_whole() || other.is_whole() {
            return Self::whole();
        }
        let (high, low) = if self.exponent >= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        if high.is_exactly(0) {
            return low.clone();
        }
        if low.is_exactly(0) {
            return high.clone();
        }
        let radius = high.radius().plus(low.radius());
        let apart = high.exponent - low.exponent;
        if apart <= 2 * bits as i64 + 128 {
            let sum = (&high.middle << apart as usize) + &low.middle;
            return Self::new(sum, low.exponent, radius, bits);
        }
        // The lower one is too small to show; it widens the radius.
        let radius = radius.plus(Upper::of(&low.middle, low.exponent));
        Self::new(high.middle.clone(), high.exponent, radius, bits)
    }

    pub(crate) fn sub(&self, other: &Self, bits: usize) -> Self {
        self.add(&other.neg(), bits)
    }

    pub(crate) fn mul(&self, other: &Self, bits: usize) -> Self {
        if self.is_whole() || other.is_whole() {
            return Self::whole();
        }
        let radius = if self.radius == 0 && other.radius == 0 {
            Upper::ZERO
        } else {
            let (mine, theirs) = (self.radius(), other.radius());
            Upper::of(&self.middle, self.exponent)
                .times(theirs)
                .plus(Upper::of(&other.middle, other.exponent).times(mine))
                .plus(mine.times(theirs))
        };
        Self::new(
            &self.middle * &other.middle,
            self.exponent + other.exponent,
            radius,
            bits,
        )
    }

    pub(crate) fn div(&self, other: &Self, bits: usize) -> Self {
        if self.is_whole() || other.is_whole() {
            return Self::whole();
        }
        // The divisor least in magnitude, in units of 2^other.exponent.
        let least = other.middle.clone().abs() - IBig::from(other.radius);
        if least <= IBig::ZERO {
            return Self::whole();
        }
        let more =
            (bits as i64 + 2 + other.middle.bit_len() as i64 - self.middle.bit_len() as i64).max(0);
        let over = &self.middle << more as usize;
        let quotient = &over / &other.middle;
        let exponent = self.exponent - other.exponent - more;
        // |(a + α)/(b + β) − a/b| ≤ (|α| + |a/b|·|β|)/(|b| − |β|)
        let mut radius = Upper::ZERO;
        if self.radius != 0 || other.radius != 0 {
            let quotient_bound = Upper::of(&quotient, 0).plus(Upper::new(1, 0));
            radius = Upper::new(u128::from(self.radius), more)
                .plus(quotient_bound.times(Upper::new(u128::from(other.radius), 0)))
                .over(&least);
            radius.exponent += exponent;
        }
        if &quotient * &other.middle != over {
            radius = radius.plus(Upper::new(1, exponent));
        }
        Self::new(quotient, exponent, radius, bits)
    }

    /// The square root of what in the ball is not negative.
    pub(crate) fn sqrt(&self, bits: usize) -> Self {
        if self.is_whole() {
            return Self::whole();
        }
        let odd = self.exponent.rem_euclid(2);
        let middle = &self.middle << odd as usize;
        let (radius, exponent) = (self.radius << odd, self.exponent - odd);
        let most = &middle + IBig::from(radius);
        if middle <= IBig::from(radius) {
            // From 0 to the root of the largest: half of it, give or take as much.
            let Ok(most) = UBig::try_from(most) else {
                return Self::whole();
            };
            let more = (64 - most.bit_len() as i64).max(0) + 2;
            let root = (most << (2 * more) as usize).sqrt() + UBig::ONE;
            let bound = Upper::of(root.as_ibig(), exponent / 2 - more - 1);
            return Self::new(
                IBig::from(bound.mantissa),
                bound.exponent,
                Upper::new(u128::from(bound.mantissa), bound.exponent),
                bits,
            );
        }
        let more = ((2 * bits as i64 + 4 - middle.bit_len() as i64) / 2).max(0);
        let Ok(large) = UBig::try_from(middle << (2 * more) as usize) else {
            return Self::whole();
        };
        let root = IBig::from(large.sqrt());
        let half = exponent / 2 - more;
        // |√(m + δ) − √m| ≤ |δ| / √m where m + δ is not negative.
        let mut bound = Upper::ZERO;
        if radius != 0 {
            bound = Upper::new(u128::from(radius), 2 * more).over(&root);
            bound.exponent += half;
        }
        if IBig::from(large) != &root * &root {
            bound = bound.plus(Upper::new(1, half));
        }
        Self::new(root, half, bound, bits)
    }

    /// The sign, if it is the same for all of the ball.
    pub(crate) fn sign(&self) -> Option<Ordering> {
        if self.is_whole() {
            return None;
        }
        if self.radius == 0 {
            return Some(self.middle.cmp(&IBig::ZERO));
        }
        let radius = IBig::from(self.radius);
        if self.middle > radius {
            Some(Ordering::Greater)
        } else if -&self.middle > radius {
            Some(Ordering::Less)
        } else {
            None
        }
    }

    /// The whole parts of the least and of the largest number in the ball; none where they have very many digits.
    pub(crate) fn floors(&self) -> Option<(IBig, IBig)> {
        if self.is_whole() || self.exponent > 4096 {
            return None;
        }
        let radius = IBig::from(self.radius);
        Some((
            floor_shift(&(&self.middle - &radius), self.exponent),
            floor_shift(&(&self.middle + &radius), self.exponent),
        ))
    }
}

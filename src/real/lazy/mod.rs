//! Numbers that are computed when they are asked about: expressions over f64 by + − × ÷ √, decided exactly.
//!
//! A [`Lazy`] is a handle into its thread's arena. Every expression has an f64 enclosure from the start; where that
//! does not decide, `decide` goes on: exactly at once where few roots are in it, else in balls of 128 bits and more,
//! and exactly again where those do not separate a number from 0. Only what that is too hard for is presumed, and
//! counted.

mod arena;
mod ball;
mod cosine;
mod decide;
mod mag;
mod tower;

#[cfg(test)]
mod tests;

pub use arena::{Effort, Mark};

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_int::IBig;

use super::float::nearest_f32_by_middle;
use super::{Bounded, Pair, Real, Undecided};
use crate::real::rational::Ratio;
use arena::{Op, with};

/// A real number, of which as much is computed as is asked for. It belongs to the thread that made it, until
/// [`release`](Lazy::release) of an earlier [`Mark`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lazy(u32);

impl Lazy {
    /// The hardest that this thread had to do since it last asked.
    pub fn effort() -> Effort {
        with(|arena| {
            arena.exact_made = 0;
            arena.words = 0;
            std::mem::take(&mut arena.effort)
        })
    }

    /// How much this thread has computed since it began: words of balls, and products of words for exact numbers.
    pub fn work() -> u64 {
        with(|arena| arena.work)
    }

    /// Forgets all numbers of this thread.
    pub fn clear() {
        with(arena::Arena::clear);
    }

    /// f64 with an error bound, as narrow as f64 allows.
    pub fn bounded(self) -> Bounded {
        with(|arena| arena.narrow(self, 1.0 / (1_u64 << 50) as f64))
    }

    /// The cosine of an angle of which nothing but approximations is known.
    fn opaque_cosine(angle: f64) -> Self {
        let enclosure = bounded_cosine(angle);
        with(|arena| arena.push(Op::Cosine(angle), enclosure))
    }
}

/// A rigorous f64 enclosure of 1 − the cosine of a small angle, if that is to be known.
pub(super) fn bounded_versine(angle: f64) -> Option<Bounded> {
    cosine::narrow(angle).then(|| cosine::versine(angle, 128).bounded())
}

/// A rigorous f64 enclosure of the cosine of 0 to 180 degrees.
pub(super) fn bounded_cosine(angle: f64) -> Bounded {
    cosine::cosine(angle, 128).bounded()
}

/// The cosine of 0 to 180 degrees, as a pair has it.
pub(super) fn pair_of_cosine(angle: f64) -> Pair {
    cosine::cosine(angle, 256).pair()
}

/// 1 − the cosine of a small angle, if that is to be known, as a pair has it.
pub(super) fn pair_of_versine(angle: f64) -> Option<Pair> {
    cosine::narrow(angle).then(|| cosine::versine(angle, 256).pair())
}

impl Add for Lazy {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        with(|arena| arena.add(self, o))
    }
}

impl Sub for Lazy {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        with(|arena| arena.sub(self, o))
    }
}

impl Mul for Lazy {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        with(|arena| arena.mul(self, o))
    }
}

impl Div for Lazy {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        with(|arena| arena.div(self, o))
    }
}

impl Neg for Lazy {
    type Output = Self;
    fn neg(self) -> Self {
        with(|arena| arena.neg(self))
    }
}

impl Real for Lazy {
    fn exact(value: f64) -> Self {
        with(|arena| arena.number(value))
    }

    fn ratio(value: &Ratio) -> Self {
        with(|arena| arena.ratio(value))
    }

    fn sqrt(self) -> Self {
        with(|arena| arena.sqrt(self))
    }

    /// By squares and roots: an exponent in f64 is a whole number over a power of two.
    fn pow(self, exponent: f64) -> Self {
        with(|arena| arena.pow(self, exponent))
    }

    fn cos_degrees(angle: f64) -> Self {
        if cosine::by_roots(angle) {
            cosine::rooted(angle)
        } else {
            Self::opaque_cosine(angle)
        }
    }

    fn versine_degrees(angle: f64) -> Option<Self> {
        let enclosure = bounded_versine(angle)?;
        Some(with(|arena| arena.push(Op::Versine(angle), enclosure)))
    }

    fn sign(self) -> Result<Ordering, Undecided> {
        with(|arena| arena.sign(self))
    }

    fn floor(self) -> Result<f64, Undecided> {
        if let Some(enclosure) = with(|arena| arena.clear_of_integers(self))
            && let Ok(low) = enclosure.floor()
        {
            return Ok(low);
        }
        let whole = with(|arena| arena.floor(self))?;
        // Beyond 2⁵³ it need not be an f64.
        i64::try_from(whole)
            .ok()
            .filter(|whole| whole.unsigned_abs() <= 1 << 53)
            .map(|whole| whole as f64)
            .ok_or(Undecided)
    }

    fn floor_mod(self, modulus: u32) -> Result<u32, Undecided> {
        if let Some(enclosure) = with(|arena| arena.clear_of_integers(self))
            && let Ok(rest) = enclosure.floor_mod(modulus)
        {
            return Ok(rest);
        }
        let whole = with(|arena| arena.floor(self))?;
        let modulus = IBig::from(modulus);
        let rest = (whole % &modulus + &modulus) % &modulus;
        u32::try_from(rest).map_err(|_| Undecided)
    }

    fn to_f64(self) -> f64 {
        self.quick_enclosure().value
    }

    fn quick_enclosure(self) -> Bounded {
        with(|arena| arena.enclosure(self))
    }

    fn enclosure(self) -> Bounded {
        with(|arena| arena.narrow(self, 1e-9))
    }

    fn nearest_f32(self) -> Result<f32, Undecided> {
        nearest_f32_by_middle(self, self.bounded())
    }

    fn mark() -> Mark {
        with(|arena| arena.mark())
    }

    fn release(mark: Mark) {
        with(|arena| arena.release(mark));
    }
}

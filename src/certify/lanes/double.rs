//! What `f64` is where a vector of the processor holds numbers of 32 bits for so many lanes: [`D`], two vectors, of
//! half of the lanes each. So all else is as it is for f32: masks, whole numbers, places in buffers
//! ([`number`](super::number)).

use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Bytes as _, MaskNarrow as _, MaskWiden as _, Select as _, Simd, prelude::*};

use super::number::{F, I, Lanewise, M, U};
#[cfg(test)]
use super::tests::{self, Fault};

/// An `f64` of each lane: of the first half of the lanes, and of the others.
#[derive(Clone, Copy)]
pub(super) struct D<S: Simd>(pub S::f64s, pub S::f64s);

impl<S: Simd> D<S> {
    /// The same number in all lanes.
    #[inline(always)]
    pub(super) fn splat(simd: S, value: f64) -> Self {
        let all = S::f64s::splat(simd, value);
        Self(all, all)
    }

    /// A number for each lane, by its place.
    #[inline(always)]
    pub(super) fn from_fn(simd: S, mut of: impl FnMut(usize) -> f64) -> Self {
        let low = S::f64s::from_fn(simd, &mut of);
        Self(low, S::f64s::from_fn(simd, |lane| of(S::f64s::LEN + lane)))
    }

    /// The number of a lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> f64 {
        let half = S::f64s::LEN;
        match lane.checked_sub(half) {
            None => self.0.as_slice()[lane],
            Some(lane) => self.1.as_slice()[lane],
        }
    }

    /// Of the halves of its bits.
    #[inline(always)]
    pub(super) fn of_halves(low: U<S>, high: U<S>) -> Self {
        let (low, high) = (low.0.widen(), high.0.widen());
        let whole = |low: S::u64s, high: S::u64s| (low | (high << 32_u32)).bitcast();
        Self(whole(low.0, high.0), whole(low.1, high.1))
    }

    #[inline(always)]
    fn map(self, of: impl Fn(S::f64s) -> S::f64s) -> Self {
        Self(of(self.0), of(self.1))
    }

    #[inline(always)]
    fn zip(self, other: Self, of: impl Fn(S::f64s, S::f64s) -> S::f64s) -> Self {
        Self(of(self.0, other.0), of(self.1, other.1))
    }

    #[inline(always)]
    fn compare(self, other: Self, of: impl Fn(S::f64s, S::f64s) -> S::mask64s) -> M<S> {
        M(of(self.0, other.0).narrow(of(self.1, other.1)))
    }

    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| a.min(b))
    }

    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| a.max(b))
    }

    #[inline(always)]
    pub(super) fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        self.map(|v| v.abs())
    }

    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        self.map(|v| v.sqrt())
    }

    #[inline(always)]
    pub(super) fn floor(self) -> Self {
        self.map(|v| v.floor())
    }

    /// The nearest whole number, of two the even one.
    #[inline(always)]
    pub(super) fn round(self) -> Self {
        self.map(|v| v.round_ties_even())
    }

    /// Truncated; of numbers that `u32` holds.
    #[inline(always)]
    pub(super) fn as_u32(self) -> U<S> {
        let whole = |v: S::f64s| -> S::u64s { v.to_int() };
        U(whole(self.0).narrow(whole(self.1)))
    }

    /// Truncated; of numbers that `i32` holds.
    #[inline(always)]
    pub(super) fn as_i32(self) -> I<S> {
        let whole = |v: S::f64s| -> S::i64s { v.to_int() };
        I(whole(self.0).narrow(whole(self.1)))
    }

    /// The nearest `f32`.
    #[inline(always)]
    pub(super) fn as_f32(self) -> F<S> {
        F(self.0.narrow(self.1))
    }
}

macro_rules! comparisons {
    ($($name:ident $simd:ident),+) => {
        impl<S: Simd> D<S> {
            $(
                #[inline(always)]
                pub(super) fn $name(self, other: Self) -> M<S> {
                    self.compare(other, |a, b| a.$simd(b))
                }
            )+
        }
    };
}

comparisons!(eq simd_eq, ne simd_ne, lt simd_lt, le simd_le, gt simd_gt, ge simd_ge);

macro_rules! operators {
    ($($op:ident $name:ident),+) => {$(
        impl<S: Simd> $op for D<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.zip(other, |a, b| $op::$name(a, b))
            }
        }

        impl<S: Simd> $op<f64> for D<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                $op::$name(self, D::splat(self.0.token(), other))
            }
        }

        impl<S: Simd> $op<D<S>> for f64 {
            type Output = D<S>;

            #[inline(always)]
            fn $name(self, other: D<S>) -> D<S> {
                $op::$name(D::splat(other.0.token(), self), other)
            }
        }
    )+};
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl<S: Simd> Neg for D<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

impl<S: Simd> Lanewise<S> for D<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self::splat(simd, 0.0)
    }

    #[inline(always)]
    fn pick(on: M<S>, new: Self, old: Self) -> Self {
        #[cfg(test)]
        let on = tests::inverted(Fault::ChoiceInverted, on);
        let (low, high) = on.0.widen();
        Self(low.select(new.0, old.0), high.select(new.1, old.1))
    }
}

impl<S: Simd> F<S> {
    /// The same number.
    #[inline(always)]
    pub(super) fn as_f64(self) -> D<S> {
        let (low, high) = self.0.widen();
        D(low, high)
    }
}

impl<S: Simd> U<S> {
    #[inline(always)]
    pub(super) fn as_f64(self) -> D<S> {
        let (low, high) = self.0.widen();
        D(low.to_float(), high.to_float())
    }
}

impl<S: Simd> I<S> {
    #[inline(always)]
    pub(super) fn as_f64(self) -> D<S> {
        let (low, high) = self.0.widen();
        D(low.to_float(), high.to_float())
    }
}

//! What WGSL's numbers are where a vector of the processor holds one for each lane: `f32` is [`F`], `u32` is [`U`],
//! `i32` is [`I`], `bool` is [`M`].
//!
//! A number that all lanes share stays an `f32` or `u32` of Rust, and meets lanes in the operators. Every operation is
//! IEEE's, rounded to nearest and not contracted, whatever the width (docs/NUMERICS.md).

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Shl, Shr, Sub};

use fearless_simd::{Bytes as _, Select as _, Simd, prelude::*};

#[cfg(test)]
use super::tests::{self, Fault};

/// An `f32` of each lane.
#[derive(Clone, Copy)]
pub(super) struct F<S: Simd>(pub S::f32s);
/// A `u32` of each lane.
#[derive(Clone, Copy)]
pub(super) struct U<S: Simd>(pub S::u32s);
/// An `i32` of each lane.
#[derive(Clone, Copy)]
pub(super) struct I<S: Simd>(pub S::i32s);
/// A truth of each lane: a mask.
#[derive(Clone, Copy)]
pub(super) struct M<S: Simd>(pub S::mask32s);

/// What lanes hold: numbers, vectors and records of them.
pub(super) trait Lanewise<S: Simd>: Copy {
    /// What WGSL's variables are before anything is stored.
    fn zero(simd: S) -> Self;

    /// `new` in the lanes of a mask, `old` in the others.
    fn pick(on: M<S>, new: Self, old: Self) -> Self;

    /// Stores in the lanes of a mask.
    #[inline(always)]
    fn set(&mut self, on: M<S>, new: Self) {
        *self = Self::pick(on, new, *self);
    }
}

macro_rules! numbers {
    ($($lanes:ident, $one:ty, $inner:ident;)+) => {$(
        impl<S: Simd> $lanes<S> {
            /// The same number in all lanes.
            #[inline(always)]
            pub(super) fn splat(simd: S, value: $one) -> Self {
                Self(S::$inner::splat(simd, value))
            }

            /// A number for each lane, by its place.
            #[inline(always)]
            pub(super) fn from_fn(simd: S, of: impl FnMut(usize) -> $one) -> Self {
                Self(S::$inner::from_fn(simd, of))
            }

            /// How many there are.
            pub(super) const LANES: usize = S::$inner::LEN;

            /// The numbers.
            #[inline(always)]
            pub(super) fn as_slice(&self) -> &[$one] {
                self.0.as_slice()
            }

            #[inline(always)]
            pub(super) fn min(self, other: Self) -> Self {
                Self(self.0.min(other.0))
            }

            #[inline(always)]
            pub(super) fn max(self, other: Self) -> Self {
                Self(self.0.max(other.0))
            }
        }

        impl<S: Simd> Lanewise<S> for $lanes<S> {
            #[inline(always)]
            fn zero(simd: S) -> Self {
                Self::splat(simd, Default::default())
            }

            #[inline(always)]
            fn pick(on: M<S>, new: Self, old: Self) -> Self {
                #[cfg(test)]
                let on = tests::inverted(Fault::ChoiceInverted, on);
                Self(on.0.select(new.0, old.0))
            }
        }

        comparisons!($lanes: eq simd_eq, ne simd_ne, lt simd_lt, le simd_le, gt simd_gt, ge simd_ge);
        operators!($lanes, $one, $inner: Add add, Sub sub, Mul mul);
    )+};
}

macro_rules! comparisons {
    ($lanes:ident: $($name:ident $simd:ident),+) => {
        impl<S: Simd> $lanes<S> {
            $(
                #[inline(always)]
                pub(super) fn $name(self, other: Self) -> M<S> {
                    M(self.0.$simd(other.0))
                }
            )+
        }
    };
}

macro_rules! operators {
    ($lanes:ident, $one:ty, $inner:ident: $($op:ident $name:ident),+) => {$(
        impl<S: Simd> $op for $lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.0, other.0))
            }
        }

        impl<S: Simd> $op<$one> for $lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: $one) -> Self {
                Self($op::$name(self.0, S::$inner::splat(self.0.token(), other)))
            }
        }

        impl<S: Simd> $op<$lanes<S>> for $one {
            type Output = $lanes<S>;

            #[inline(always)]
            fn $name(self, other: $lanes<S>) -> $lanes<S> {
                $lanes($op::$name(S::$inner::splat(other.0.token(), self), other.0))
            }
        }
    )+};
}

numbers! {
    F, f32, f32s;
    U, u32, u32s;
    I, i32, i32s;
}
operators!(F, f32, f32s: Div div);
operators!(U, u32, u32s: BitAnd bitand, BitOr bitor, BitXor bitxor, Shl shl, Shr shr);

impl<S: Simd> Shl<U<S>> for I<S> {
    type Output = Self;

    #[inline(always)]
    fn shl(self, by: U<S>) -> Self {
        Self(self.0 << by.as_i32().0)
    }
}

impl<S: Simd> Shr<u32> for I<S> {
    type Output = Self;

    #[inline(always)]
    fn shr(self, by: u32) -> Self {
        Self(self.0 >> by)
    }
}

impl<S: Simd> Shl<u32> for I<S> {
    type Output = Self;

    #[inline(always)]
    fn shl(self, by: u32) -> Self {
        Self(self.0 << by)
    }
}

impl<S: Simd> Neg for F<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> Not for U<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl<S: Simd> F<S> {
    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// 1/√x, of two roundings.
    #[inline(always)]
    pub(super) fn inverse_sqrt(self) -> Self {
        1.0 / self.sqrt()
    }

    #[inline(always)]
    pub(super) fn floor(self) -> Self {
        Self(self.0.floor())
    }

    /// The nearest whole number, of two the even one.
    #[inline(always)]
    pub(super) fn round(self) -> Self {
        Self(self.0.round_ties_even())
    }

    #[inline(always)]
    pub(super) fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// Truncated; of numbers that `u32` holds.
    #[inline(always)]
    pub(super) fn as_u32(self) -> U<S> {
        U(self.0.to_int())
    }

    /// Truncated; of numbers that `i32` holds.
    #[inline(always)]
    pub(super) fn as_i32(self) -> I<S> {
        I(self.0.to_int())
    }

    /// Its bits.
    #[inline(always)]
    pub(super) fn bits(self) -> U<S> {
        U(self.0.bitcast())
    }

    /// Its bits.
    #[inline(always)]
    pub(super) fn signed_bits(self) -> I<S> {
        I(self.0.bitcast())
    }
}

impl<S: Simd> U<S> {
    #[inline(always)]
    pub(super) fn as_f32(self) -> F<S> {
        F(self.0.to_float())
    }

    #[inline(always)]
    pub(super) fn as_i32(self) -> I<S> {
        I(self.0.bitcast())
    }

    /// The number that has these bits.
    #[inline(always)]
    pub(super) fn float(self) -> F<S> {
        F(self.0.bitcast())
    }
}

impl<S: Simd> I<S> {
    #[inline(always)]
    pub(super) fn as_f32(self) -> F<S> {
        F(self.0.to_float())
    }

    #[inline(always)]
    pub(super) fn as_u32(self) -> U<S> {
        U(self.0.bitcast())
    }

    /// The number that has these bits.
    #[inline(always)]
    pub(super) fn float(self) -> F<S> {
        F(self.0.bitcast())
    }
}

impl<S: Simd> M<S> {
    #[inline(always)]
    pub(super) fn splat(simd: S, value: bool) -> Self {
        Self(S::mask32s::splat(simd, value))
    }

    /// Whether any lane is on.
    #[inline(always)]
    pub(super) fn any(self) -> bool {
        #[cfg(test)]
        if tests::is_wrong(Fault::BranchSkipped) {
            return self.all();
        }
        self.0.any_true()
    }

    /// Whether all lanes are on.
    #[inline(always)]
    pub(super) fn all(self) -> bool {
        self.0.all_true()
    }

    /// `accept` where the mask is on, else `reject`.
    #[inline(always)]
    pub(super) fn select<T: Lanewise<S>>(self, accept: T, reject: T) -> T {
        T::pick(self, accept, reject)
    }

    /// A bit for each lane.
    #[inline(always)]
    pub(super) fn bits(self) -> u64 {
        self.0.to_bitmask()
    }
}

impl<S: Simd> Lanewise<S> for M<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self::splat(simd, false)
    }

    #[inline(always)]
    fn pick(on: M<S>, new: Self, old: Self) -> Self {
        Self((on.0 & new.0) | (!on.0 & old.0))
    }
}

macro_rules! masks {
    ($($op:ident $name:ident),+) => {$(
        impl<S: Simd> $op for M<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.0, other.0))
            }
        }
    )+};
}

masks!(BitAnd bitand, BitOr bitor, BitXor bitxor);

impl<S: Simd> Not for M<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

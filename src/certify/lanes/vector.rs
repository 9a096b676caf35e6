//! What WGSL's vectors and structs are for lanes: [`Vec2`], [`Vec3`], [`Vec4`] and what `record!` makes, of the numbers
//! in `number`.

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Shl, Shr, Sub};

use fearless_simd::Simd;

pub(super) use super::double::D;
pub(super) use super::number::{F, I, Lanewise, M, U};

macro_rules! vectors {
    ($($vector:ident: $first:ident $($part:ident)+;)+) => {$(
        /// A vector of WGSL.
        #[derive(Clone, Copy)]
        pub(super) struct $vector<T> {
            pub $first: T,
            $(pub $part: T,)+
        }

        impl<T: Copy> $vector<T> {
            #[inline(always)]
            pub(super) fn new($first: T, $($part: T),+) -> Self {
                Self { $first, $($part),+ }
            }

            #[inline(always)]
            pub(super) fn splat(value: T) -> Self {
                Self { $first: value, $($part: value),+ }
            }

            /// A function of each component.
            #[inline(always)]
            pub(super) fn map<R>(self, of: impl Fn(T) -> R) -> $vector<R> {
                $vector { $first: of(self.$first), $($part: of(self.$part)),+ }
            }

            /// A function of the components of two vectors.
            #[inline(always)]
            pub(super) fn zip<Q, R>(self, other: $vector<Q>, of: impl Fn(T, Q) -> R) -> $vector<R> {
                $vector { $first: of(self.$first, other.$first), $($part: of(self.$part, other.$part)),+ }
            }
        }

        impl<S: Simd, T: Lanewise<S>> Lanewise<S> for $vector<T> {
            #[inline(always)]
            fn zero(simd: S) -> Self {
                Self::splat(T::zero(simd))
            }

            #[inline(always)]
            fn pick(on: M<S>, new: Self, old: Self) -> Self {
                new.zip(old, |new, old| T::pick(on, new, old))
            }
        }

        vectors!(@each $vector: Add add, Sub sub, Mul mul, Div div, BitAnd bitand, BitOr bitor, BitXor bitxor,
            Shl shl, Shr shr);

        impl<T: Copy + Neg<Output = T>> Neg for $vector<T> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                self.map(|part| -part)
            }
        }

        impl<T: Copy + Not<Output = T>> Not for $vector<T> {
            type Output = Self;

            #[inline(always)]
            fn not(self) -> Self {
                self.map(|part| !part)
            }
        }

        vectors!(@real $vector: F f32; $first $($part)+);
        vectors!(@real $vector: D f64; $first $($part)+);

        impl<S: Simd> Mul<u32> for $vector<U<S>> {
            type Output = Self;

            #[inline(always)]
            fn mul(self, by: u32) -> Self {
                self.map(|part| part * by)
            }
        }

        impl<S: Simd> $vector<M<S>> {
            /// Where all components hold.
            #[inline(always)]
            pub(super) fn all(self) -> M<S> {
                self.$first $(& self.$part)+
            }

            /// Where any component holds.
            #[inline(always)]
            pub(super) fn any_of(self) -> M<S> {
                self.$first $(| self.$part)+
            }

            /// `accept` where a component holds, else `reject`.
            #[inline(always)]
            pub(super) fn select<T: Lanewise<S>>(self, accept: $vector<T>, reject: $vector<T>) -> $vector<T> {
                $vector {
                    $first: self.$first.select(accept.$first, reject.$first),
                    $($part: self.$part.select(accept.$part, reject.$part)),+
                }
            }
        }
    )+};
    (@real $vector:ident: $lanes:ident $one:ident; $first:ident $($part:ident)+) => {
        impl<S: Simd> Mul<$lanes<S>> for $vector<$lanes<S>> {
            type Output = Self;

            #[inline(always)]
            fn mul(self, by: $lanes<S>) -> Self {
                self.map(|part| part * by)
            }
        }

        impl<S: Simd> Mul<$one> for $vector<$lanes<S>> {
            type Output = Self;

            #[inline(always)]
            fn mul(self, by: $one) -> Self {
                self.map(|part| part * by)
            }
        }

        impl<S: Simd> Mul<$vector<$lanes<S>>> for $lanes<S> {
            type Output = $vector<$lanes<S>>;

            #[inline(always)]
            fn mul(self, other: $vector<$lanes<S>>) -> $vector<$lanes<S>> {
                other.map(|part| self * part)
            }
        }

        impl<S: Simd> Mul<$vector<$lanes<S>>> for $one {
            type Output = $vector<$lanes<S>>;

            #[inline(always)]
            fn mul(self, other: $vector<$lanes<S>>) -> $vector<$lanes<S>> {
                other.map(|part| self * part)
            }
        }

        impl<S: Simd> $vector<$lanes<S>> {
            /// The sum of the products of components, from the first to the last.
            #[inline(always)]
            pub(super) fn dot(self, other: Self) -> $lanes<S> {
                self.$first * other.$first $(+ self.$part * other.$part)+
            }
        }
    };
    (@each $vector:ident: $($op:ident $name:ident),+) => {$(
        impl<T: Copy + $op<Q, Output = T>, Q: Copy> $op<$vector<Q>> for $vector<T> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: $vector<Q>) -> Self {
                self.zip(other, |a, b| a.$name(b))
            }
        }
    )+};
}

vectors! {
    Vec2: x y;
    Vec3: x y z;
    Vec4: x y z w;
}

macro_rules! cross {
    ($($lanes:ident),+) => {$(
        impl<S: Simd> Vec3<$lanes<S>> {
            /// At right angles to both.
            #[inline(always)]
            pub(super) fn cross(self, other: Self) -> Self {
                Self::new(
                    self.y * other.z - self.z * other.y,
                    self.z * other.x - self.x * other.z,
                    self.x * other.y - self.y * other.x,
                )
            }
        }
    )+};
}

cross!(F, D);

/// A record of lanes, as a struct of WGSL.
macro_rules! record {
    ($(#[$meta:meta])* $name:ident { $($field:ident: $type:ty),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy)]
        pub(super) struct $name<S: Simd> {
            $(pub $field: $type,)+
        }

        impl<S: Simd> Lanewise<S> for $name<S> {
            #[inline(always)]
            fn zero(simd: S) -> Self {
                Self { $($field: Lanewise::zero(simd)),+ }
            }

            #[inline(always)]
            fn pick(on: M<S>, new: Self, old: Self) -> Self {
                Self { $($field: Lanewise::pick(on, new.$field, old.$field)),+ }
            }
        }
    };
}

pub(super) use record;

//! What lanes read from the scene's buffers: each its own element.

use std::marker::PhantomData;

use bytemuck::Pod;
use fearless_simd::Simd;

#[cfg(test)]
use super::tests::{self, Fault};
use super::vector::{D, F, I, U, Vec2, Vec3, Vec4};

/// Bytes of a word: all fields of all records are made of words.
const WORD: usize = size_of::<u32>();
/// Bytes of an f64.
const DOUBLE: usize = size_of::<f64>();

/// An element of a buffer for each lane, of which fields are read by their places in it (`offset_of`). Lanes that are
/// off may have any index: they read the last element.
#[derive(Clone, Copy)]
pub(super) struct Gather<'a, T, S: Simd> {
    simd: S,
    words: &'a [u32],
    /// The first word of each lane's element.
    first: U<S>,
    /// The same, where all lanes have one element.
    same: Option<usize>,
    of: PhantomData<&'a T>,
}

impl<'a, T: Pod, S: Simd> Gather<'a, T, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, buffer: &'a [T], at: U<S>) -> Self {
        let at = at.min(U::splat(simd, buffer.len().saturating_sub(1) as u32));
        #[cfg(test)]
        let at = if tests::is_wrong(Fault::RecordsShifted) {
            let width = at.as_slice().len();
            U::from_fn(simd, |lane| at.as_slice()[(lane + 1) % width])
        } else {
            at
        };
        let first = at.as_slice()[0];
        let same = at.eq(U::splat(simd, first)).all();
        let words = size_of::<T>() / WORD;
        Self {
            simd,
            words: bytemuck::cast_slice(buffer),
            first: at * words as u32,
            same: same.then_some(first as usize * words),
            of: PhantomData,
        }
    }

    /// Of one element for all.
    #[inline(always)]
    pub(super) fn same(simd: S, element: &'a T) -> Self {
        Self {
            simd,
            words: bytemuck::cast_slice(std::slice::from_ref(element)),
            first: U::splat(simd, 0),
            same: Some(0),
            of: PhantomData,
        }
    }

    #[inline(always)]
    pub(super) fn u32(&self, field: usize) -> U<S> {
        let place = field / WORD;
        match self.same {
            Some(first) => U::splat(self.simd, self.words[first + place]),
            None => own_words(self.simd, self.words, self.first, place),
        }
    }

    #[inline(always)]
    pub(super) fn f32(&self, field: usize) -> F<S> {
        self.u32(field).float()
    }

    #[inline(always)]
    pub(super) fn f64(&self, field: usize) -> D<S> {
        let half = |more: usize| self.u32(field + more * WORD);
        D::of_halves(half(0), half(1))
    }

    #[inline(always)]
    pub(super) fn vec2_f64(&self, field: usize) -> Vec2<D<S>> {
        Vec2::new(0, 1).map(|part| self.f64(field + part * DOUBLE))
    }

    #[inline(always)]
    pub(super) fn vec3_f64(&self, field: usize) -> Vec3<D<S>> {
        Vec3::new(0, 1, 2).map(|part| self.f64(field + part * DOUBLE))
    }

    #[inline(always)]
    pub(super) fn vec4_f64(&self, field: usize) -> Vec4<D<S>> {
        Vec4::new(0, 1, 2, 3).map(|part| self.f64(field + part * DOUBLE))
    }

    #[inline(always)]
    pub(super) fn vec2(&self, field: usize) -> Vec2<F<S>> {
        self.vec2_u32(field).map(U::float)
    }

    #[inline(always)]
    pub(super) fn vec3(&self, field: usize) -> Vec3<F<S>> {
        Vec3::new(0, 1, 2).map(|part| self.f32(field + part * WORD))
    }

    #[inline(always)]
    pub(super) fn vec4(&self, field: usize) -> Vec4<F<S>> {
        Vec4::new(0, 1, 2, 3).map(|part| self.f32(field + part * WORD))
    }

    #[inline(always)]
    pub(super) fn vec2_u32(&self, field: usize) -> Vec2<U<S>> {
        Vec2::new(0, 1).map(|part| self.u32(field + part * WORD))
    }

    #[inline(always)]
    pub(super) fn vec2_i32(&self, field: usize) -> Vec2<I<S>> {
        self.vec2_u32(field).map(U::as_i32)
    }
}

/// A word for each lane. It stands by itself, since the text reads fields in hundreds of places, and the compiler would
/// take as long for these as for all the rest.
fn own_words<S: Simd>(simd: S, words: &[u32], first: U<S>, place: usize) -> U<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let first = first.as_slice();
            U::from_fn(simd, |lane| words[first[lane] as usize + place])
        },
    )
}

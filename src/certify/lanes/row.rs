//! A row of pixels, of a sample each or of several: from columns to words.

use fearless_simd::{Simd, prelude::*};

use super::Scene;
use super::text::{State, camera_getdir, camera_setpix, jitter_hash, ray_trace};
use crate::certify::lanes::mean::{Means, Shares};
#[cfg(test)]
use crate::certify::lanes::tests::{self, Fault};
use crate::certify::lanes::vector::{F, I, U, Vec2, Vec3};
use crate::shader::constants::FINE;

/// The words of pixels side by side, from column `first` of row `y` on: bytes, and a verdict.
pub(in crate::certify::lanes) fn strip<S: Simd>(
    scene: &Scene<'_, S>,
    first: u32,
    y: u32,
    words: &mut [u32],
) {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let width = S::f32s::LEN;
            let place = I::from_fn(scene.simd, |lane| lane as i32);
            let middle = Vec2::splat(scene.f32(0.0));
            let mut state = State::new(scene.simd);
            for (k, words) in words.chunks_mut(width).enumerate() {
                let column = first as i32 + (k * width) as i32;
                let on = place.lt(scene.i32(words.len() as i32));
                let pixel = Vec2::new(place + column, scene.i32(y as i32));
                let traced = ray_trace(scene, &mut state, on, camera_getdir(scene, pixel, middle));
                let word = camera_setpix(scene, traced.color, traced.error) | traced.verdict;
                words.copy_from_slice(&word.as_slice()[..words.len()]);
                #[cfg(test)]
                if words.len() > 1 && tests::is_wrong(Fault::PixelsSwapped) {
                    words.swap(0, 1);
                }
            }
        },
    );
}

/// The same of pixels of several samples: by the hash, or with these offsets. Lanes are samples, one pixel's after the
/// other's, so that rays that go side by side stay together.
pub(in crate::certify::lanes) fn sampled<S: Simd>(
    scene: &Scene<'_, S>,
    [first, y]: [u32; 2],
    offsets: Option<&[[f64; 2]]>,
    means: &mut Means,
    words: &mut [u32],
) {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let (width, samples) = (S::f32s::LEN as u32, means.samples());
            let all = words.len() as u32 * samples;
            let place = U::from_fn(scene.simd, |lane| lane as u32);
            let row = scene.i32(y as i32);
            let last = scene.i32(first as i32 + words.len() as i32 - 1);
            let mut column = I::from_fn(scene.simd, |lane| (first + lane as u32 / samples) as i32);
            let mut number = U::from_fn(scene.simd, |lane| lane as u32 % samples);
            let mut state = State::new(scene.simd);
            let [share, error_share] = means.shares();
            means.begin(words.len());
            for done in (0..all).step_by(width as usize) {
                let on = place.lt(scene.u32(all - done));
                let pixel = Vec2::new(column.min(last), row);
                let offset = match offsets {
                    None => jitter_hash(scene, pixel, number),
                    Some(offsets) => Vec2::new(0, 1).map(|part| given(scene, offsets, done, part)),
                };
                let traced = ray_trace(scene, &mut state, on, camera_getdir(scene, pixel, offset));
                let sure = traced.verdict.eq(scene.u32(0));
                let fine = traced.error.map(|error| error.lt(scene.f32(FINE))).all();
                let color = traced.color * share;
                #[cfg(test)]
                let color = color.map(|part| tests::shifted(Fault::SamplesShifted, part));
                let error = traced.error * error_share;
                means.add(&Shares {
                    color: [&color.x, &color.y, &color.z].map(F::as_slice),
                    error: [&error.x, &error.y, &error.z].map(F::as_slice),
                    sure: sure.bits(),
                    fine: (sure & fine).bits(),
                    count: width.min(all - done) as usize,
                });
                // The same lane's next sample, perhaps of another pixel.
                number = number + width % samples;
                let beyond = number.ge(scene.u32(samples));
                number = beyond.select(number - scene.u32(samples), number);
                column = column + (width / samples) as i32;
                column = beyond.select(column + 1, column);
            }
            for (k, words) in words.chunks_mut(width as usize).enumerate() {
                let sum = |which: usize, part: usize| {
                    F::from_fn(scene.simd, |lane| {
                        means.sum(k * width as usize + lane)[which][part]
                    })
                };
                let [color, error] =
                    [0, 1].map(|which| Vec3::new(0, 1, 2).map(|part| sum(which, part)));
                let word = camera_setpix(scene, color, error);
                for ((lane, word), new) in words.iter_mut().enumerate().zip(word.as_slice()) {
                    *word = new | means.verdict(k * width as usize + lane);
                }
            }
        },
    );
}

/// What was given for the samples from this one on.
#[inline(always)]
fn given<S: Simd>(scene: &Scene<'_, S>, offsets: &[[f64; 2]], first: u32, part: usize) -> F<S> {
    F::from_fn(scene.simd, |lane| {
        let offset = offsets.get(first as usize + lane);
        offset.map_or(0.0, |offset| offset[part] as f32)
    })
}

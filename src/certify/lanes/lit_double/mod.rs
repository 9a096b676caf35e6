//! Scenes with lights, in f64: pixels of a list, or samples of pixels.

#[allow(
    clippy::duplicate_mod,
    reason = "it is about the types of the text beside it"
)]
#[path = "../lit/by_hand.rs"]
mod loops;
#[allow(
    clippy::duplicate_mod,
    reason = "it is about the types of the text beside it"
)]
#[path = "../primary.rs"]
mod primary;
#[allow(
    clippy::all,
    unused,
    unused_comparisons,
    reason = "it is written by a program"
)]
mod text;
#[cfg(test)]
mod values;
#[allow(
    clippy::duplicate_mod,
    reason = "it is about the types of the text beside it"
)]
#[path = "../lit/walk.rs"]
mod walk;

use fearless_simd::Simd;

use crate::certify::lanes::scene;
#[cfg(test)]
use crate::certify::lanes::tests::{self, Fault};
use crate::certify::lanes::vector::{D as Real, I, Vec2};
use crate::cpu::pixel::of_bytes;
use crate::real::Bounded;
use crate::shader::format::Double;
use crate::shader::records::wide as records;

/// A number that all lanes share.
type Number = f64;
/// The scene in f64.
type Scene<'a, S> = scene::Scene<'a, S, Double>;

/// What the text calls that is written by hand.
mod by_hand {
    use fearless_simd::Simd;

    use super::Scene;
    pub(super) use super::loops::*;
    use crate::certify::lanes::vector::{D, U};

    /// The f64 of two words, the lower half first.
    #[inline(always)]
    pub(super) fn double_of<'a, S: Simd>(_: &'a Scene<'a, S>, low: U<S>, high: U<S>) -> D<S> {
        D::of_halves(low, high)
    }
}

/// Traces samples, each by its pixel and where in that its ray passes, as many at once as there are lanes: of each what
/// it brings, where that is certain.
pub(super) fn samples<S: Simd>(
    scene: &Scene<'_, S>,
    places: &[[u32; 2]],
    offsets: &[[f64; 2]],
    brought: &mut [Option<[Bounded; 3]>],
) {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut state = text::State::new(scene.simd);
            let width = I::<S>::LANES;
            let all = places.chunks(width).zip(offsets.chunks(width));
            for ((places, offsets), brought) in all.zip(brought.chunks_mut(width)) {
                let offset = |lane: usize| offsets[lane.min(offsets.len() - 1)];
                let offset = Vec2::new(0, 1)
                    .map(|part| Real::from_fn(scene.simd, |lane| offset(lane)[part]));
                let traced = traced(scene, &mut state, places, offset);
                let sure = traced.verdict.eq(scene.u32(0)).bits();
                let channels = [
                    (traced.color.x, traced.error.x),
                    (traced.color.y, traced.error.y),
                    (traced.color.z, traced.error.z),
                ];
                for (lane, brought) in brought.iter_mut().enumerate() {
                    *brought = (sure >> lane & 1 != 0).then(|| {
                        channels.map(|(color, error)| of_bytes(color.lane(lane), error.lane(lane)))
                    });
                }
                #[cfg(test)]
                if brought.len() > 1 && tests::is_wrong(Fault::PixelsSwapped) {
                    brought.swap(0, 1);
                }
            }
        },
    );
}

/// Traces the pixels of a list, as many at once as there are lanes: of each its bytes, red lowest, or OPEN.
pub(super) fn pixels<S: Simd>(scene: &Scene<'_, S>, places: &[[u32; 2]], words: &mut [u32]) {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut state = text::State::new(scene.simd);
            let width = I::<S>::LANES;
            let middle = Vec2::splat(scene.real(0.0));
            for (places, words) in places.chunks(width).zip(words.chunks_mut(width)) {
                let traced = traced(scene, &mut state, places, middle);
                let word = text::camera_setpix(scene, traced.color, traced.error) | traced.verdict;
                words.copy_from_slice(&word.as_slice()[..words.len()]);
                #[cfg(test)]
                if words.len() > 1 && tests::is_wrong(Fault::PixelsSwapped) {
                    words.swap(0, 1);
                }
            }
        },
    );
}

/// What rays of pixels bring that pass so far from their middles, a lane each: of one to as many as there are.
#[inline(always)]
fn traced<S: Simd>(
    scene: &Scene<'_, S>,
    state: &mut text::State<S>,
    places: &[[u32; 2]],
    offset: Vec2<Real<S>>,
) -> text::Traced<S> {
    let lane = I::from_fn(scene.simd, |lane| lane as i32);
    let on = lane.lt(scene.i32(places.len() as i32));
    // What is off looks where the last one does.
    let place = |lane: usize| places[lane.min(places.len() - 1)];
    let pixel = Vec2::new(0, 1).map(|part| I::from_fn(scene.simd, |lane| place(lane)[part] as i32));
    text::ray_trace(scene, state, on, text::camera_getdir(scene, pixel, offset))
}

//! The GPU's arithmetic on the CPU: as many pixels of a row at once as a vector of the processor holds, in f32 with the
//! GPU's error bounds (docs/NUMERICS.md); and in f64 those of lit scenes that f32 leaves open ([`doubles`]).
//!
//! Every operation of IEEE arithmetic keeps what the bounds ask of a GPU's, so a pixel that is sure here has its exact
//! bytes; the others are left to [`ExactTracer`](crate::cpu::pixel::ExactTracer). What is computed is the WGSL itself:
//! `src/lower` writes `text.rs` in `ambient`, `lit` and `lit_double` from `shaders/`. By hand are rows of pixels
//! (`row`, with the means of several samples in [`mean`]), the loops over objects (`primary` for rays of pixels,
//! `lit/by_hand` and `lit/walk` for rays from anywhere), and what the text's types are here (`number`, `double`,
//! `vector`, `gather`, `scene`). [`cpu`](crate::cpu) is the referee.

mod ambient;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod double;
pub mod doubles;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod gather;
mod lit;
mod lit_double;
pub mod mean;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod number;
mod scene;
#[cfg(test)]
mod tests;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod vector;

use std::sync::Arc;

use bytemuck::Zeroable;
use fearless_simd::{Level, Simd};

use crate::settings::Settings;
use crate::shader::binding;
use crate::shader::format::Single;
use crate::shader::pack::{Lit, Packed};
use mean::Means;
use scene::{Buffers, LaneFormat, Numbers, Scene, numbers};

/// Pixels that the widest vectors hold.
pub const LANES: usize = 16;

/// The highest byte of a pixel's word where the lanes leave it open.
pub const OPEN: u32 = 0xff00_0000;

/// Boxes of a tree that may wait while others are entered.
const MOST_DEPTH: usize = lit::MOST_DEPTH;

/// A scene for as many pixels at once as the processor's vectors hold.
#[derive(Debug, Clone)]
pub struct Lanes {
    packed: Arc<Packed>,
    numbers: Numbers<f32>,
    buffers: Buffers<Single>,
    /// Rays a pixel.
    samples: u32,
    level: Level,
}

impl Lanes {
    /// The scene as the GPU would get it, asked for only where it may do; None where it takes more than there is here.
    pub fn new(settings: &Settings, packed: impl FnOnce() -> Arc<Packed>) -> Option<Self> {
        if settings.values {
            return None;
        }
        Self::of(packed(), settings)
    }

    /// A scene that was packed with these settings.
    pub fn of(packed: Arc<Packed>, settings: &Settings) -> Option<Self> {
        if !may_be(&packed) {
            return None;
        }
        let mut numbers = numbers(&packed, settings);
        let buffers = buffers(&packed, &mut numbers);
        Some(Self {
            numbers,
            buffers,
            packed,
            samples: settings.samples.max(1),
            level: Level::new(),
        })
    }

    /// The same with each kind of vectors that this processor has, by name.
    pub fn with_each_vector(&self) -> Vec<(&'static str, Self)> {
        let with = |level| Self {
            level,
            ..self.clone()
        };
        let levels = levels(self.level).into_iter();
        levels.map(|(name, level)| (name, with(level))).collect()
    }

    /// Where the means of pixels are kept, if they have several samples.
    pub fn means(&self) -> Option<Means> {
        (self.samples > 1).then(|| Means::new(self.samples))
    }

    /// The pixels of row `y` from column `first` on, of a sample each: of each its bytes, red lowest, or [`OPEN`] in
    /// the highest.
    pub fn strip(&self, [first, y]: [u32; 2], words: &mut [u32]) {
        self.fill(
            words,
            Work {
                first,
                y,
                means: None,
            },
        );
    }

    /// The same of pixels of several samples, [`Means::at_once`] at most: by the hash, or with the row's offsets. What
    /// is known of those that are left open is in `means`.
    pub fn sampled(
        &self,
        [first, y]: [u32; 2],
        offsets: Option<&[[f64; 2]]>,
        words: &mut [u32],
        means: &mut Means,
    ) {
        let offsets = offsets.map(|row| &row[(first * self.samples) as usize..]);
        let means = Some((offsets, means));
        self.fill(words, Work { first, y, means });
    }

    fn fill(&self, words: &mut [u32], work: Work<'_>) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match self.level {
            Level::Avx512(simd) => self.fill_by(simd, words, work),
            Level::Avx2(simd) => self.fill_by(simd, words, work),
            // SSE4.2 has little more, and each kind of vectors takes the compiler as long as the others.
            level => match level.as_sse2() {
                Some(simd) => self.fill_by(simd, words, work),
                None => words.fill(OPEN),
            },
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        fearless_simd::dispatch!(self.level, simd => self.fill_by(simd, words, work));
    }

    fn fill_by<S: Simd>(&self, simd: S, words: &mut [u32], work: Work<'_>) {
        let scene = Scene::new(simd, &self.packed, &self.numbers, &self.buffers);
        let Work { first, y, means } = work;
        match (means, self.packed.lit.is_some()) {
            (None, false) => ambient::row::strip(&scene, first, y, words),
            (None, true) => lit::row::strip(&scene, first, y, words),
            (Some((offsets, means)), false) => {
                ambient::row::sampled(&scene, [first, y], offsets, means, words);
            }
            (Some((offsets, means)), true) => {
                lit::row::sampled(&scene, [first, y], offsets, means, words);
            }
        }
    }
}

/// The kinds of vectors up to a level, by name.
fn levels(level: Level) -> Vec<(&'static str, Level)> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let levels = [
        ("SSE2", level.as_sse2().map(Level::Sse2)),
        ("AVX2", level.as_avx2().map(Level::Avx2)),
        ("AVX-512", level.as_avx512().map(Level::Avx512)),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let levels = [("the only ones", Some(level))];
    let there = |(name, level): (&'static str, Option<Level>)| Some((name, level?));
    levels.into_iter().filter_map(there).collect()
}

/// So many panes a shadow ray may pass: what each adds to its share's error is counted once, and as much again for all
/// products of these (docs/NUMERICS.md).
const MOST_PANES: usize = 900_000;

/// Whether lanes can take a scene: where its bounds can be relied on, rays pass no more panes than bounds count, and
/// the walk down its tree has room.
fn may_be<X: LaneFormat>(packed: &Packed<X>) -> bool {
    // A ray meets a quadric twice, all else once.
    let panes = |lit: &Lit<X>| {
        if lit.transparent {
            2 * lit.objects.len()
        } else {
            0
        }
    };
    packed.unprovable.is_none()
        && !packed.kinds.is_empty()
        && packed.bvh_depth <= MOST_DEPTH
        && packed.lit.as_ref().map_or(0, panes) <= MOST_PANES
}

/// The buffers that the text asks for, whether the scene has tables or not: it reads beyond the last object then, and
/// finds that there is none.
fn buffers<X: LaneFormat>(packed: &Packed<X>, numbers: &mut Numbers<X::Real>) -> Buffers<X> {
    let mut buffers = Buffers {
        objects: binding::objects(packed),
        lit_objects: binding::lit_objects(packed),
    };
    if packed.tables.words.is_empty() {
        numbers.tables = buffers.objects.len().max(buffers.lit_objects.len()) as u32;
        buffers.objects.push(Zeroable::zeroed());
        buffers.lit_objects.push(Zeroable::zeroed());
    }
    buffers
}

/// What words are of: pixels from column `first` of row `y` on; their means if they have several samples, which lie by
/// the hash, or with these offsets.
struct Work<'a> {
    first: u32,
    y: u32,
    means: Option<(Option<&'a [[f64; 2]]>, &'a mut Means)>,
}

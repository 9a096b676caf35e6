//! The GPU's arithmetic on the CPU: as many pixels of a row at once as a vector of the processor holds, in f32 with the
//! GPU's error bounds (docs/NUMERICS.md).
//!
//! For a ray a pixel. Every operation of IEEE arithmetic keeps what the bounds ask of a GPU's, so a pixel that is sure
//! here has its exact bytes; the others are left to [`ExactTracer`](crate::cpu::pixel::ExactTracer). What is computed is
//! the WGSL itself: `src/lower` writes `ambient/text.rs` and `lit/text.rs` from `shaders/`. By hand are the loops over
//! objects (`primary` for rays of pixels, `lit/by_hand` and `lit/walk` for rays from anywhere), and what the text's
//! types are here (`vector`, `gather`, `scene`). [`cpu`](crate::cpu) is the referee.

mod ambient;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod gather;
mod lit;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod number;
mod scene;
#[allow(
    dead_code,
    reason = "the texts that are written say what they need of WGSL's types"
)]
mod vector;

use std::sync::Arc;

use fearless_simd::{Level, Simd};

use crate::settings::Settings;
use crate::shader::binding;
use crate::shader::pack::Packed;
use scene::{Buffers, Numbers, Scene};

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
    numbers: Numbers,
    buffers: Buffers,
    level: Level,
}

impl Lanes {
    /// The scene as the GPU would get it, asked for only where it may do; None where it takes more than there is here.
    pub fn new(settings: &Settings, packed: impl FnOnce() -> Arc<Packed>) -> Option<Self> {
        if settings.supersampling().is_some() || settings.values {
            return None;
        }
        Self::of(packed(), settings)
    }

    /// A packed scene, for a ray a pixel.
    pub fn of(packed: Arc<Packed>, settings: &Settings) -> Option<Self> {
        if packed.unprovable.is_some() || packed.kinds.is_empty() || packed.bvh_depth > MOST_DEPTH {
            return None;
        }
        Some(Self {
            numbers: Numbers::new(&packed, settings),
            buffers: Buffers {
                objects: binding::objects(&packed),
                lit_objects: binding::lit_objects(&packed),
            },
            packed,
            level: Level::new(),
        })
    }

    /// The same with each kind of vectors that this processor has, by name.
    pub fn with_each_vector(&self) -> Vec<(&'static str, Self)> {
        let level = self.level;
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let levels = [
            ("SSE2", level.as_sse2().map(Level::Sse2)),
            ("AVX2", level.as_avx2().map(Level::Avx2)),
            ("AVX-512", level.as_avx512().map(Level::Avx512)),
        ];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let levels = [("the only ones", Some(level))];
        let at = |(name, level): (&'static str, Option<Level>)| {
            let level = level?;
            Some((
                name,
                Self {
                    level,
                    ..self.clone()
                },
            ))
        };
        levels.into_iter().filter_map(at).collect()
    }

    /// The pixels of row `y` from column `first` on: of each its bytes, red lowest, or [`OPEN`] in the highest.
    pub fn strip(&self, first: u32, y: u32, words: &mut [u32]) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match self.level {
            Level::Avx512(simd) => self.strip_by(simd, first, y, words),
            Level::Avx2(simd) => self.strip_by(simd, first, y, words),
            // SSE4.2 has little more, and each kind of vectors takes the compiler as long as the others.
            level => match level.as_sse2() {
                Some(simd) => self.strip_by(simd, first, y, words),
                None => words.fill(OPEN),
            },
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        fearless_simd::dispatch!(self.level, simd => self.strip_by(simd, first, y, words));
    }

    fn strip_by<S: Simd>(&self, simd: S, first: u32, y: u32, words: &mut [u32]) {
        let scene = Scene::new(simd, &self.packed, &self.numbers, &self.buffers);
        if self.packed.lit.is_some() {
            lit::primary::strip(&scene, first, y, words);
        } else {
            ambient::primary::strip(&scene, first, y, words);
        }
    }
}

//! What f32 leaves open, in f64 for as many pixels at once: the same text with another unit roundoff
//! (docs/NUMERICS.md, "The same in f64"). Pixels come from a list, and may lie anywhere.

use fearless_simd::{Level, Simd};

use super::lit_double;
use super::scene::{Buffers, Numbers, Scene, numbers};
use super::{buffers, may_be};
use crate::real::Bounded;
use crate::scene::Scene as Model;
use crate::settings::{Precision, Settings};
use crate::shader::format::Double;
use crate::shader::pack::Packed;

/// Of more objects each pixel meets few, others than its neighbours in a list do: from 1,000 on it is decided in less
/// time by itself.
const MOST_OBJECTS: usize = 512;

/// A lit scene in f64.
#[derive(Debug)]
pub struct DoubleLanes {
    packed: Packed<Double>,
    numbers: Numbers<f64>,
    buffers: Buffers<Double>,
    level: Level,
}

impl DoubleLanes {
    /// Whether this may be worth its preparation: where vectors hold four f64 or more, and for scenes with lights. What
    /// f32 leaves open of others lies on borders, where f64 does not help.
    pub fn may_be(scene: &Model, settings: &Settings) -> bool {
        !scene.lights.is_empty()
            && scene.objects.len() <= MOST_OBJECTS
            && !settings.values
            && is_wide(Level::new())
    }

    /// Prepares the scene; None where its numbers are too large or too small.
    pub fn new(scene: &Model, settings: &Settings) -> Option<Self> {
        let settings = &Settings {
            precision: Precision::Certified,
            ..settings.clone()
        };
        let packed = Packed::in_f64(scene, settings);
        if !may_be(&packed) {
            return None;
        }
        let mut numbers = numbers(&packed, settings);
        let buffers = buffers(&packed, &mut numbers);
        Some(Self {
            packed,
            numbers,
            buffers,
            level: Level::new(),
        })
    }

    /// The same with each kind of vectors that this processor has and that hold four f64 or more, by name.
    pub fn with_each_vector(self) -> Vec<(&'static str, Self)> {
        let copy = |level: Level| Self {
            packed: self.packed.clone(),
            numbers: self.numbers.clone(),
            buffers: self.buffers.clone(),
            level,
        };
        super::levels(self.level)
            .into_iter()
            .filter(|(_, level)| is_wide(*level))
            .map(|(name, level)| (name, copy(level)))
            .collect()
    }

    /// The scene as functions for such vectors ask for it.
    pub(super) fn scene<S: Simd>(&self, simd: S) -> Scene<'_, S, Double> {
        Scene::new(simd, &self.packed, &self.numbers, &self.buffers)
    }

    /// Samples, by their pixels' columns and rows, and by where their rays pass, in pixels from the middle: of each
    /// what it brings, where that is certain.
    pub fn samples(
        &self,
        places: &[[u32; 2]],
        offsets: &[[f64; 2]],
        brought: &mut [Option<[Bounded; 3]>],
    ) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match self.level {
            Level::Avx512(simd) => {
                lit_double::samples(&self.scene(simd), places, offsets, brought);
            }
            Level::Avx2(simd) => lit_double::samples(&self.scene(simd), places, offsets, brought),
            _ => brought.fill(None),
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            let _ = (places, offsets);
            brought.fill(None);
        }
    }

    /// Pixels of one sample, by column and row: of each its bytes, red lowest, or [`OPEN`](super::OPEN) in the highest.
    pub fn pixels(&self, places: &[[u32; 2]], words: &mut [u32]) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match self.level {
            Level::Avx512(simd) => lit_double::pixels(&self.scene(simd), places, words),
            Level::Avx2(simd) => lit_double::pixels(&self.scene(simd), places, words),
            _ => words.fill(super::OPEN),
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            let _ = places;
            words.fill(super::OPEN);
        }
    }
}

/// Whether vectors of this kind hold four f64 or more.
fn is_wide(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        matches!(level, Level::Avx512(_) | Level::Avx2(_))
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        let _ = level;
        false
    }
}

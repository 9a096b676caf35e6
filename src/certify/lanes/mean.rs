//! Pixels of several samples: the sums of what lanes are sure of. What counts, and how, is as in
//! `shaders/entry/picture.wgsl`; the bounds are those of docs/NUMERICS.md, "Samples".

use super::OPEN;
#[cfg(test)]
use super::tests::{self, Fault};
use crate::frame::Part;
use crate::shader::bounds;
use crate::shader::constants::FINE;

/// So many samples are traced before their pixels are decided.
const AT_ONCE: u32 = 1024;

/// Sums of samples' shares: 255 times their colours, and how far that may be off.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    color: [f32; 3],
    error: [f32; 3],
    count: u32,
}

/// What is known of pixels side by side.
#[derive(Debug)]
pub struct Means {
    samples: u32,
    /// A sample's share of a pixel, and of its error.
    shares: [f32; 2],
    /// Roundings of a sum, for a unit of it.
    roundings: f32,
    /// Of the samples that are sure.
    sure: Vec<Sum>,
    /// Of those that are known well enough to be worth keeping should others be in doubt.
    fine: Vec<Sum>,
    /// Which those are: words of bits, as many for each pixel.
    summed: Vec<u32>,
    /// Pixel and sample that come next.
    next: [u32; 2],
}

impl Means {
    pub(super) fn new(samples: u32) -> Self {
        let share = 1.0 / samples as f32;
        let [growth, roundings, u] =
            [bounds::SAMPLE_GROWTH, bounds::SAMPLE_ROUNDINGS, bounds::U].map(bounds::round_up);
        Self {
            samples,
            shares: [share, growth / samples as f32],
            roundings: roundings * u,
            sure: Vec::new(),
            fine: Vec::new(),
            summed: Vec::new(),
            next: [0; 2],
        }
    }

    /// How many pixels are made at once.
    pub fn at_once(&self) -> usize {
        (AT_ONCE / self.samples).max(1) as usize
    }

    pub(super) fn samples(&self) -> u32 {
        self.samples
    }

    /// Words of bits of a pixel.
    fn stride(&self) -> usize {
        self.samples.div_ceil(32) as usize
    }

    /// Of so many pixels nothing is known.
    pub(super) fn begin(&mut self, pixels: usize) {
        for sums in [&mut self.sure, &mut self.fine] {
            sums.clear();
            sums.resize(pixels, Sum::default());
        }
        self.summed.clear();
        self.summed.resize(pixels * self.stride(), 0);
        self.next = [0; 2];
    }

    /// Adds the next sample, if it counts: what a doubtful one brings means nothing. They come pixel by pixel.
    #[inline(always)]
    pub(super) fn add(&mut self, color: [f32; 3], error: [f32; 3], sure: bool) {
        let [pixel, sample] = self.next;
        self.next = if sample + 1 < self.samples {
            [pixel, sample + 1]
        } else {
            [pixel + 1, 0]
        };
        if !sure {
            return;
        }
        #[cfg(test)]
        let color = if tests::is_wrong(Fault::SampleLost) {
            [0.0; 3]
        } else {
            color
        };
        let pixel = pixel as usize;
        self.sure[pixel].add(color, error, self.shares, self.roundings);
        if error.iter().all(|error| *error < FINE) {
            self.fine[pixel].add(color, error, self.shares, self.roundings);
            let word = pixel * self.stride() + sample as usize / 32;
            self.summed[word] |= 1 << (sample % 32);
        }
    }

    /// Sum and error of a pixel's sure samples; of none beyond the last pixel.
    #[inline(always)]
    pub(super) fn sum(&self, pixel: usize) -> [[f32; 3]; 2] {
        let sum = self.sure.get(pixel).copied().unwrap_or_default();
        [sum.color, sum.error]
    }

    /// [`OPEN`] where a sample of the pixel is in doubt, else 0.
    #[inline(always)]
    pub(super) fn verdict(&self, pixel: usize) -> u32 {
        if self.sure[pixel].count == self.samples {
            0
        } else {
            OPEN
        }
    }

    /// What is known of a pixel that is left open, where that is something and not all.
    pub fn part(&self, pixel: usize) -> Option<Part<'_>> {
        let fine = &self.fine[pixel];
        let some = (1..self.samples).contains(&fine.count);
        some.then(|| Part {
            sum: fine.color,
            error: fine.error,
            summed: &self.summed[pixel * self.stride()..][..self.stride()],
        })
    }
}

impl Sum {
    #[inline(always)]
    fn add(&mut self, color: [f32; 3], error: [f32; 3], shares: [f32; 2], roundings: f32) {
        for i in 0..3 {
            self.color[i] += color[i] * shares[0];
            self.error[i] += error[i] * shares[1] + roundings * self.color[i];
        }
        self.count += 1;
    }
}

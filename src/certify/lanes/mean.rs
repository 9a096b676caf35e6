//! Pixels of several samples: the sums of what lanes are sure of. What counts, and how, is as in
//! `shaders/entry/picture.wgsl`; the bounds are those of docs/NUMERICS.md, "Samples".

use std::ops::Range;

use super::OPEN;
#[cfg(test)]
use super::tests::{self, Fault};
use crate::frame::Part;
use crate::shader::bounds;

/// So many samples are traced before their pixels are decided.
const AT_ONCE: u32 = 1024;

/// Sums of samples' shares: 255 times their colours, and how far that may be off.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    color: [f32; 3],
    error: [f32; 3],
    count: u32,
}

/// What the lanes of a vector bring, one sample after the other: shares of their pixels' colours and errors, and bits
/// of the lanes that count.
pub(super) struct Shares<'a> {
    /// By channels.
    pub(super) color: [&'a [f32]; 3],
    /// By channels.
    pub(super) error: [&'a [f32]; 3],
    /// Which are sure.
    pub(super) sure: u64,
    /// Which of these are known well enough to be worth keeping should others be in doubt.
    pub(super) fine: u64,
    /// How many there are.
    pub(super) count: usize,
}

/// What is known of pixels side by side.
#[derive(Debug)]
pub struct Means {
    samples: u32,
    /// A sample's share of a pixel's colour, and of its error.
    shares: [f32; 2],
    /// Roundings of a sum, for a unit of it.
    roundings: f32,
    /// Of the samples that are fine.
    fine: Vec<Sum>,
    /// Of those that are sure, and not fine.
    coarse: Vec<Sum>,
    /// Which are fine: words of bits, as many for each pixel.
    summed: Vec<u32>,
    /// Pixel and sample that come next.
    next: [usize; 2],
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
            fine: Vec::new(),
            coarse: Vec::new(),
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

    /// A sample's share of its pixel's colour, and of its error.
    pub(super) fn shares(&self) -> [f32; 2] {
        self.shares
    }

    /// Words of bits of a pixel.
    fn stride(&self) -> usize {
        self.samples.div_ceil(32) as usize
    }

    /// Of so many pixels nothing is known.
    pub(super) fn begin(&mut self, pixels: usize) {
        for sums in [&mut self.fine, &mut self.coarse] {
            sums.clear();
            sums.resize(pixels, Sum::default());
        }
        self.summed.clear();
        self.summed.resize(pixels * self.stride(), 0);
        self.next = [0; 2];
    }

    /// Adds the next samples, as far as they count: what a doubtful one brings means nothing. They come pixel by pixel.
    #[inline(always)]
    pub(super) fn add(&mut self, new: &Shares<'_>) {
        let mut lane = 0;
        while lane < new.count {
            let [pixel, sample] = self.next;
            let end = new.count.min(lane + (self.samples as usize - sample));
            let coarse = new.sure & !new.fine;
            self.fine[pixel].add(new, lane..end, new.fine, self.roundings);
            if coarse & bits(&(lane..end)) != 0 {
                self.coarse[pixel].add(new, lane..end, coarse, self.roundings);
            }
            let word = pixel * self.stride() + sample / 32;
            let bits = ((new.fine & bits(&(lane..end))) >> lane) << (sample % 32);
            self.summed[word] |= bits as u32;
            if bits >> 32 != 0 {
                self.summed[word + 1] |= (bits >> 32) as u32;
            }
            self.next = if sample + (end - lane) == self.samples as usize {
                [pixel + 1, 0]
            } else {
                [pixel, sample + (end - lane)]
            };
            lane = end;
        }
    }

    /// Sum and error of a pixel's sure samples; of none beyond the last pixel.
    #[inline(always)]
    pub(super) fn sum(&self, pixel: usize) -> [[f32; 3]; 2] {
        let (Some(fine), Some(coarse)) = (self.fine.get(pixel), self.coarse.get(pixel)) else {
            return [[0.0; 3]; 2];
        };
        let color = [0, 1, 2].map(|i| fine.color[i] + coarse.color[i]);
        let error = [0, 1, 2].map(|i| fine.error[i] + coarse.error[i] + self.roundings * color[i]);
        [color, error]
    }

    /// [`OPEN`] where a sample of the pixel is in doubt, else 0.
    #[inline(always)]
    pub(super) fn verdict(&self, pixel: usize) -> u32 {
        if self.fine[pixel].count + self.coarse[pixel].count == self.samples {
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
    /// Adds those of these lanes whose bits are set; the others as if they brought nothing.
    #[inline(always)]
    fn add(&mut self, new: &Shares<'_>, lanes: Range<usize>, counts: u64, roundings: f32) {
        let mut sum = *self;
        let all = bits(&lanes);
        for lane in lanes {
            #[cfg(test)]
            if tests::is_wrong(Fault::SampleLost) {
                continue;
            }
            let adds = counts & all == all || counts >> lane & 1 != 0;
            for i in 0..3 {
                let share = |of: &[&[f32]; 3]| if adds { of[i][lane] } else { 0.0 };
                sum.color[i] += share(&new.color);
                sum.error[i] += share(&new.error) + roundings * sum.color[i];
            }
        }
        sum.count += (counts & all).count_ones();
        *self = sum;
    }
}

/// A bit for each of these lanes.
#[inline(always)]
fn bits(lanes: &Range<usize>) -> u64 {
    ((1 << lanes.len()) - 1) << lanes.start
}

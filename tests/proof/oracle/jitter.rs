//! Where samples lie (docs/SCENE.md, "Bytes and samples"), written from the text alone.

use std::num::Wrapping;

use dashu_ratio::RBig;
use plumb::render::SamplePattern;

/// The offsets of the samples of one pixel.
pub(crate) type Offsets = Vec<[RBig; 2]>;

/// The offsets of every pixel of a picture, bottom row first.
pub(crate) struct Jitter {
    width: u32,
    samples: u32,
    /// `random()/0x7fffffff − 0.5` in order, for the course's jitter.
    course: Vec<f64>,
}

impl Jitter {
    pub(crate) fn new([width, height]: [u32; 2], samples: u32, pattern: SamplePattern) -> Self {
        let mut course = Vec::new();
        if samples > 1 && pattern == SamplePattern::Course {
            let count = 2 * width as usize * height as usize * samples as usize;
            course = random(count)
                .into_iter()
                .map(|r| f64::from(r) / f64::from(0x7fff_ffff) - 0.5)
                .collect();
        }
        Self {
            width,
            samples,
            course,
        }
    }

    /// The offsets of column `x`, row `y` from the bottom.
    pub(crate) fn of(&self, x: u32, y: u32) -> Offsets {
        if self.samples <= 1 {
            return vec![[RBig::ZERO, RBig::ZERO]];
        }
        (0..self.samples)
            .map(|sample| {
                if self.course.is_empty() {
                    hash(x, y, sample)
                } else {
                    let pixel = y as usize * self.width as usize + x as usize;
                    let at = 2 * (pixel * self.samples as usize + sample as usize);
                    // x + a is the f64 that C computes; what it adds to x is exact.
                    [(x, at), (y, at + 1)].map(|(n, at)| {
                        let place = f64::from(n) + self.course[at];
                        RBig::try_from(place).expect("finite") - RBig::from(n)
                    })
                }
            })
            .collect()
    }
}

fn hash(x: u32, y: u32, sample: u32) -> [RBig; 2] {
    let step = |n: u32| Wrapping(n) * Wrapping(1_664_525) + Wrapping(1_013_904_223);
    let (mut p, mut q, mut r) = (step(x), step(y), step(sample));
    p += q * r;
    q += r * p;
    r += p * q;
    p ^= p >> 16;
    q ^= q >> 16;
    r ^= r >> 16;
    p += q * r;
    q += r * p;
    [p, q].map(|n| RBig::from(n.0 >> 22) / RBig::from(1024) - RBig::from(1) / RBig::from(2))
}

/// The first numbers of glibc's `random()` with its default seed, 1: an additive feedback of lags 3 and 31.
fn random(count: usize) -> Vec<u32> {
    let mut r: Vec<u32> = vec![1];
    for i in 1..31 {
        let word = i64::from(r[i - 1].cast_signed());
        r.push(((16_807 * word).rem_euclid(2_147_483_647)) as u32);
    }
    for i in 31..34 {
        r.push(r[i - 31]);
    }
    for i in 34..344 + count {
        r.push(r[i - 31].wrapping_add(r[i - 3]));
    }
    r[344..].iter().map(|word| word >> 1).collect()
}

//! Where in its pixel a sample's ray passes: the offsets (a, b), each in [−½, ½].
//!
//! Stands beside `cpu` and `gpu`, which both trace (x + a, y + b). The hash needs no state, so any row can be rendered
//! alone; the course's sequence runs through the whole picture, and is kept at checkpoints.

/// The offsets of sample `sample` of pixel (x, y), y from the bottom: the PCG 3D hash of Jarzynski and Olano ("Hash
/// Functions for GPU Rendering", 2020), ten bits of it. `shaders/jitter.wgsl` has the same steps:
/// docs/SCENE.md prescribes them, to the bit.
pub fn hash(x: u32, y: u32, sample: u32) -> [f64; 2] {
    let start = |v: u32| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    let (mut p, mut q, mut r) = (start(x), start(y), start(sample));
    let mix = |p: &mut u32, q: &mut u32, r: &mut u32| {
        *p = p.wrapping_add(q.wrapping_mul(*r));
        *q = q.wrapping_add(r.wrapping_mul(*p));
        *r = r.wrapping_add(p.wrapping_mul(*q));
    };
    mix(&mut p, &mut q, &mut r);
    p ^= p >> 16;
    q ^= q >> 16;
    r ^= r >> 16;
    mix(&mut p, &mut q, &mut r);
    [p, q].map(|v| f64::from(v >> 22) / 1024.0 - 0.5)
}

/// The state of C's `random()` as glibc seeds it by default: an additive feedback of 31 words, r_i = r_{i−3} +
/// r_{i−31}.
#[derive(Debug, Clone)]
struct Random {
    words: [u32; 31],
    /// The oldest word, which the next one replaces; the first words are used from the fourth on.
    oldest: usize,
}

impl Random {
    fn new() -> Self {
        let mut words = [0; 31];
        // Seed 1, then the Lehmer generator 16807·w mod 2³¹ − 1; the first 310 numbers are thrown away.
        let mut word = 1_u64;
        for slot in &mut words {
            *slot = word as u32;
            word = word * 16_807 % 0x7fff_ffff;
        }
        let mut random = Self { words, oldest: 3 };
        random.skip(310);
        random
    }

    fn next(&mut self) -> u32 {
        let i = self.oldest;
        let back_3 = if i >= 3 { i - 3 } else { i + 28 };
        self.words[i] = self.words[i].wrapping_add(self.words[back_3]);
        self.oldest = if i == 30 { 0 } else { i + 1 };
        self.words[i] >> 1
    }

    fn skip(&mut self, count: u64) {
        for _ in 0..count {
            self.next();
        }
    }

    /// An offset as the course's program takes it: `random()/0x7fffffff − 0.5`.
    fn offset(&mut self) -> f64 {
        f64::from(self.next()) / 2_147_483_647.0 - 0.5
    }
}

/// The course's jitter for a whole picture: pixels from the bottom row, left to right, samples inside, a before b.
#[derive(Debug, Clone)]
pub struct Course {
    width: u32,
    samples: u32,
    /// The state before every row whose number is a multiple of `stride`.
    checkpoints: Vec<Random>,
    stride: u32,
}

/// Most states kept: 124 bytes each.
const MAX_CHECKPOINTS: u32 = 1 << 16;

impl Course {
    /// Runs through the sequence once for the rows up to `rows`, as rows below have to be counted though they may not
    /// be rendered. Two nanoseconds an offset or so.
    pub fn new(width: u32, rows: u32, samples: u32) -> Self {
        let stride = rows.div_ceil(MAX_CHECKPOINTS).max(1);
        let mut random = Random::new();
        let mut checkpoints = Vec::new();
        for row in 0..rows {
            if row % stride == 0 {
                checkpoints.push(random.clone());
            }
            random.skip(2 * u64::from(width) * u64::from(samples));
        }
        Self {
            width,
            samples,
            checkpoints,
            stride,
        }
    }

    /// The offsets of row `y`: those of a pixel's samples together, pixels from the left.
    pub fn row(&self, y: u32) -> Vec<[f64; 2]> {
        let mut random = self.checkpoints[(y / self.stride) as usize].clone();
        let row = 2 * u64::from(self.width) * u64::from(self.samples);
        random.skip(u64::from(y % self.stride) * row);
        (0..self.width as usize * self.samples as usize)
            .map(|_| {
                let a = random.offset();
                [a, random.offset()]
            })
            .collect()
    }
}

/// How the pixels of a band are sampled.
#[derive(Debug, Clone)]
pub enum Jitter {
    /// One ray a pixel.
    Once,
    /// Several, spread by the hash.
    Hash(u32),
    /// Several, as the course's program spread them.
    Course(Course),
}

impl Jitter {
    /// The offsets of a row, where they are not computed pixel by pixel.
    pub fn row(&self, y: u32) -> Option<Vec<[f64; 2]>> {
        if let Self::Course(course) = self {
            Some(course.row(y))
        } else {
            None
        }
    }

    /// The samples of pixel `x` in a row with these offsets.
    pub fn pixel<'a>(&self, row: Option<&'a [[f64; 2]]>, width: usize, x: usize) -> Sampling<'a> {
        match (self, row) {
            (Self::Hash(samples), _) => Sampling::Hash(*samples),
            (Self::Course(_), Some(row)) => {
                let samples = row.len() / width;
                Sampling::Given(&row[x * samples..(x + 1) * samples])
            }
            _ => Sampling::Once,
        }
    }
}

/// Which rays a pixel is made of.
#[derive(Debug, Clone, Copy)]
pub enum Sampling<'a> {
    /// One, through its middle.
    Once,
    /// This many, spread by the hash.
    Hash(u32),
    /// As the course's program spread them: the offsets of this pixel.
    Given(&'a [[f64; 2]]),
}

impl<'a> Sampling<'a> {
    /// Where the samples of pixel (x, y) are, from its middle.
    pub fn offsets(self, x: u32, y: u32) -> impl Iterator<Item = [f64; 2]> + use<'a> {
        let (hashed, given): (u32, &[[f64; 2]]) = match self {
            Self::Once => (0, &[[0.0; 2]]),
            Self::Hash(samples) => (samples, &[]),
            Self::Given(offsets) => (0, offsets),
        };
        (0..hashed)
            .map(move |sample| hash(x, y, sample))
            .chain(given.iter().copied())
    }

    /// The same where rays are counted from the pixel: a sample is at x + a as f64 rounds it, and what that differs from x
    /// by is an f64.
    pub fn rounded_offsets(self, x: u32, y: u32) -> impl Iterator<Item = [f64; 2]> + use<'a> {
        let rounded = |x: u32, a: f64| (f64::from(x) + a) - f64::from(x);
        self.offsets(x, y)
            .map(move |[a, b]| [rounded(x, a), rounded(y, b)])
    }

    /// How many rays.
    pub fn samples(&self) -> u32 {
        match self {
            Self::Once => 1,
            Self::Hash(samples) => *samples,
            Self::Given(offsets) => offsets.len() as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_is_the_c_librarys() {
        // The first numbers that `random()` returns in a program that never calls `srandom()`.
        let mut random = Random::new();
        let first: Vec<u32> = (0..5).map(|_| random.next()).collect();
        assert_eq!(
            first,
            [
                1_804_289_383,
                846_930_886,
                1_681_692_777,
                1_714_636_915,
                1_957_747_793
            ]
        );
    }

    #[test]
    fn rows_follow_each_other_whatever_the_checkpoints() {
        let course = Course::new(5, 7, 3);
        let coarse = Course {
            stride: 3,
            checkpoints: course.checkpoints.iter().step_by(3).cloned().collect(),
            ..course.clone()
        };
        let mut random = Random::new();
        for y in 0..7 {
            let want: Vec<[f64; 2]> = (0..15)
                .map(|_| {
                    let a = random.offset();
                    [a, random.offset()]
                })
                .collect();
            assert_eq!(course.row(y), want);
            assert_eq!(coarse.row(y), want);
        }
    }

    #[test]
    fn the_hash_is_spread_evenly_and_needs_all_three() {
        let mut counts = [[0_u32; 8]; 2];
        for i in 0..8000 {
            for (count, v) in counts.iter_mut().zip(hash(i % 100, i / 100, i % 16)) {
                assert!((-0.5..0.5).contains(&v));
                count[((v + 0.5) * 8.0) as usize] += 1;
            }
        }
        assert!(
            counts.iter().flatten().all(|&n| (850..1150).contains(&n)),
            "{counts:?}"
        );
        assert_ne!(hash(1, 2, 3), hash(2, 2, 3));
        assert_ne!(hash(1, 2, 3), hash(1, 3, 3));
        assert_ne!(hash(1, 2, 3), hash(1, 2, 4));
    }
}

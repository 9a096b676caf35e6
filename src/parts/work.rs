//! How much work the rows of a picture are, estimated: rays are counted, of pixels spread over the picture.
//!
//! No clock takes part, nor what differs between machines: what decides which rays there are is computed with
//! additions, products, quotients and square roots, whose roundings are the same everywhere. (A colour may hang on the
//! system's cosine and powers; no ray hangs on a colour here, as none is left out where a pixel is white already.) So
//! everybody comes to the same numbers.

use std::ops::Range;

use rayon::prelude::*;

use crate::cpu::pixel::ExactTracer;
use crate::cpu::surface::Point;
use crate::cpu::trace::{Branch, Fault, TraceObserver, Unmet, ray_trace};
use crate::jitter;
use crate::real::{Bounded, V3};
use crate::scene::Scene;
use crate::settings::{Limits, Settings};

/// One pixel in so many is looked at.
const ONE_OF: u64 = 2048;
/// At least and at most so many pixels are, whatever the picture's size: some milliseconds; a second or so.
const LEAST: u64 = 512;
const MOST: u64 = 1 << 16;
/// So many columns of them, if there are as many.
const COLUMNS: u32 = 16;
/// Most rays of a sample that are followed: what has more counts as this many.
const MOST_RAYS: u32 = 1024;

/// What a sample costs, in the time that a ray takes: more than its rays, as its pixel is written.
const SAMPLE: u64 = 1;
/// What a sample costs that f64 with bounds does not decide.
const UNDECIDED: u64 = 100;

/// How much work rows are, in the time of a ray or so: equally high blocks of rows, from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Work {
    /// The work of all blocks above each one, and of all.
    sums: Vec<u64>,
    /// Samples that were looked at: so many samples have so much work.
    samples: u64,
}

impl Work {
    /// Estimates the work that these rows of the scene's picture are, to be cut into so many parts: the estimate may
    /// take a small share of the time that one of them does. The scene is prepared already, for the settings' view.
    pub fn estimate(
        (scene, tracer): (&Scene, &ExactTracer<'_>),
        settings: &Settings,
        rows: &Range<u32>,
        parts: u32,
    ) -> Self {
        let width = scene.camera.pixeldim[0];
        let height = rows.len() as u32;
        let samples = u64::from(width) * u64::from(height) * u64::from(settings.samples);
        let pixels = (samples / ONE_OF / u64::from(parts.max(1))).clamp(LEAST, MOST);
        let columns = COLUMNS.min(width);
        let blocks = ((pixels / u64::from(columns)) as u32).clamp(1, height.max(1));
        let limits = Limits {
            max_rays: MOST_RAYS.min(settings.limits.max_rays),
            enough: f64::INFINITY,
            ..settings.limits
        };
        let lights = scene.lights.len() as u64;
        // The middle of the k-th of n equal pieces.
        let middle = |length: u32, n: u32, k: u32| {
            ((2 * u64::from(k) + 1) * u64::from(length) / (2 * u64::from(n))) as u32
        };
        let block = |block: u32| {
            let y = rows.end - 1 - middle(height, blocks, block);
            let cost = |k| {
                let mut rays = Rays { lights, count: 0 };
                let x = middle(width, columns, k);
                // The middle of a pixel may be special, such as where a floor begins at the screen's edge: there all
                // middles of a row are undecided, and few samples are. How samples are spread does not matter to this.
                let [a, b] = if settings.samples > 1 {
                    jitter::hash(x, y, 0)
                } else {
                    [0.0; 2]
                };
                let (x, y) = (f64::from(x) + a, f64::from(y) + b);
                let traced = ray_trace(tracer.bounded(), &limits, x, y, &mut rays);
                SAMPLE
                    + match traced {
                        Ok(_) => rays.count,
                        Err(Fault::TooManyRays) => u64::from(MOST_RAYS) * (1 + lights),
                        Err(Fault::Undecided) => rays.count + UNDECIDED,
                    }
            };
            (0..columns).map(cost).sum()
        };
        let blocks: Vec<u64> = (0..blocks).into_par_iter().map(block).collect();
        let looked = blocks.len() as u64 * u64::from(columns);
        Self {
            samples: looked,
            ..Self::of_blocks(blocks)
        }
    }

    /// The same for all rows, where nothing is known of them.
    pub fn even() -> Self {
        Self::of_blocks(vec![1])
    }

    /// The work of blocks that are given.
    pub(super) fn of_blocks(blocks: Vec<u64>) -> Self {
        let samples = blocks.len() as u64;
        let mut sums = vec![0];
        for block in blocks {
            let above = sums.last().copied().unwrap_or(0);
            sums.push(above + block);
        }
        Self { sums, samples }
    }

    /// The work of the uppermost `above` of so many rows, in units of which a row has as many as there are rows.
    pub(super) fn of(&self, rows: u32, above: u32) -> u128 {
        let blocks = self.sums.len() as u64 - 1;
        // In which block that row lies, and how much of it lies above: in `rows` to a block.
        let at = u64::from(above.min(rows)) * blocks;
        let (block, part) = (at / u64::from(rows), at % u64::from(rows));
        let sum = |block: u64| u128::from(self.sums.get(block as usize).copied().unwrap_or(0));
        let inside = sum(block + 1).saturating_sub(sum(block)) * u128::from(part);
        sum(block) * u128::from(rows) + inside
    }

    /// About how many rays a sample takes, with what it costs besides.
    pub fn of_a_sample(&self) -> f64 {
        let total = self.sums.last().copied().unwrap_or(0);
        total as f64 / self.samples.max(1) as f64
    }
}

/// Counts rays.
struct Rays {
    lights: u64,
    count: u64,
}

impl TraceObserver<Bounded> for Rays {
    fn missed(&mut self, _number: u32, _ray: &Branch<Bounded>, why: Unmet) {
        if why == Unmet::Nothing {
            self.count += 1;
        }
    }

    fn met(
        &mut self,
        _number: u32,
        _ray: &Branch<Bounded>,
        _t: Bounded,
        _point: &Point<Bounded>,
        _ambient: V3<Bounded>,
    ) {
        // From what it meets, a ray goes to each light.
        self.count += 1 + self.lights;
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::load_from;

    /// Where a floor begins at the screen's edge, all middles of a row of pixels are undecided, and hardly a sample is.
    #[test]
    fn samples_do_not_cost_what_middles_do() {
        let text = "camera c { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }\n\
            material m { ambient 4 4 4 }\n\
            plane floor { material m normal 0 1 0 point 0 0 0 }\n";
        let scene = load_from("scene", text.as_bytes(), Path::new(".")).unwrap();
        let settings = Settings {
            samples: 2,
            ..Settings::default()
        };
        let tracer = ExactTracer::new(&scene, settings.view());
        let work = Work::estimate((&scene, &tracer), &settings, &(0..30), 1);
        let percent = (work.of(30, 30) - work.of(30, 29)) * 100 / work.of(30, 30);
        assert!(percent < 10, "{percent}");
    }

    #[test]
    fn work_is_spread_over_the_rows_of_its_block() {
        let work = Work::of_blocks(vec![4, 0, 2]);
        let above: Vec<u128> = (0..=6).map(|above| work.of(6, above)).collect();
        assert_eq!(above, [0, 12, 24, 24, 24, 30, 36]);
        // Fewer rows than blocks, and not a whole number of them in a block.
        let above: Vec<u128> = (0..=2).map(|above| work.of(2, above)).collect();
        assert_eq!(above, [0, 8, 12]);
        assert_eq!(work.of_a_sample(), 2.0);
    }
}

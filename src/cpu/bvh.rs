//! Which of many spheres a ray may hit. Referee of `shaders/bvh.wgsl`.

use crate::prepare::boxes::{Bounds, SLACK};
use crate::prepare::bvh::Bvh;
use crate::real::{Bounded, Real, Undecided, V3};

/// So many spheres are asked without a tree where that says nothing.
const FEW: usize = 4096;

/// The greatest f64 that a number may be: how far hits matter.
pub fn at_most<R: Real>(number: R) -> f64 {
    let most = number.enclosure().most() * SLACK;
    if most.is_nan() { f64::INFINITY } else { most }
}

/// A ray as boxes are asked about it: in f64, and as well as the tracer's number type knows it.
///
/// A point at s on it is off by no more than the base's error and s times that of `dir`, and what is in the boxes is
/// nearer than a distance that their size tells: they are widened by what that can be.
#[derive(Debug, Clone, Copy)]
pub struct BoxRay {
    low: [f64; 3],
    high: [f64; 3],
    inverse: [f64; 3],
}

impl BoxRay {
    /// The ray from `base` along `dir`, for boxes no point of which is farther than `size` from the viewpoint; None
    /// where it is so inaccurate that they would say little.
    #[inline]
    pub fn new(base: [Bounded; 3], dir: [Bounded; 3], size: f64) -> Option<Self> {
        let farthest = size + base.iter().map(|c| c.value.abs()).sum::<f64>();
        let longest = dir
            .iter()
            .fold(0.0, |longest, c| c.value.abs().max(longest));
        let mut slack = [0.0; 3];
        for (slack, (base, dir)) in slack.iter_mut().zip(base.iter().zip(&dir)) {
            // A component that is replaced below is off by twice as much as its replacement; and the base is rounded
            // once more when it is moved.
            *slack = 1.01 * (base.error + farthest / longest * (dir.error + 2e-30))
                + 4.0 * f64::EPSILON * farthest;
        }
        // A NaN fails this comparison too.
        if !slack.iter().all(|slack| *slack < 1e-3 * farthest) {
            return None;
        }
        // A zero component becomes tiny: the ray stays in its slab or out of it.
        let inverse = dir.map(|c| {
            1.0 / if c.value.abs() < 1e-30 {
                1e-30
            } else {
                c.value
            }
        });
        Some(Self {
            low: [0, 1, 2].map(|i| base[i].value + slack[i]),
            high: [0, 1, 2].map(|i| base[i].value - slack[i]),
            inverse,
        })
    }

    /// Where it enters a box; None if it passes it by for certain.
    #[inline(always)]
    pub fn enters(&self, bounds: &Bounds) -> Option<f64> {
        bounds.enters(self.low, self.high, self.inverse)
    }
}

/// Calls `test` with the index of each sphere of the tree that the ray from `base` along `dir` may hit, near boxes
/// first, as long as they are entered no farther than at `reach`. `test` returns the new reach, in units of `dir`.
///
/// Where boxes say too little of the ray it is `Undecided`, unless all spheres can be asked.
pub fn bvh_hits<R: Real>(
    bvh: &Bvh,
    base: V3<R>,
    dir: V3<R>,
    mut reach: f64,
    mut test: impl FnMut(usize) -> Result<f64, Undecided>,
) -> Result<(), Undecided> {
    let ray = BoxRay::new(
        [base.x, base.y, base.z].map(Real::enclosure),
        [dir.x, dir.y, dir.z].map(Real::enclosure),
        bvh.size(),
    );
    let Some(ray) = ray else {
        if bvh.len > FEW {
            return Err(Undecided);
        }
        return (0..bvh.len).try_for_each(|sphere| test(sphere).map(|_| ()));
    };
    let mut stack = Vec::new();
    let mut index = 0;
    loop {
        let node = &bvh.nodes[index];
        let first = node.first as usize;
        let mut next = None;
        if node.count > 0 {
            for sphere in first..first + node.count as usize {
                reach = test(sphere)?;
            }
        } else {
            let enters = |child: usize| {
                let near = ray.enters(&bvh.nodes[child].bounds());
                near.filter(|&near| near <= reach * SLACK)
            };
            next = match (enters(first), enters(first + 1)) {
                (Some(left), Some(right)) => {
                    let left_first = left <= right;
                    stack.push(if left_first { first + 1 } else { first });
                    Some(if left_first { first } else { first + 1 })
                }
                (Some(_), None) => Some(first),
                (None, Some(_)) => Some(first + 1),
                (None, None) => None,
            };
        }
        match next.or_else(|| stack.pop()) {
            Some(node) => index = node,
            None => return Ok(()),
        }
    }
}

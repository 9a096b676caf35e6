//! A walk down a tree by the rays of all lanes together: a box is entered if any of them enters it. `shaders/bvh.wgsl`
//! has the same tests of boxes for a ray that walks alone.

use std::ops::Range;

use fearless_simd::Simd;

use super::by_hand::Tree;
use super::text::SecondaryRay;
use super::text::constants::{BOX_ROUNDINGS, BVH_FAR, BVH_NEAR, SECOND_ORDER, U};
use super::{Real, Scene};
#[cfg(test)]
use crate::certify::lanes::tests::{self, Fault};
use crate::certify::lanes::vector::{M, Vec3};

/// Boxes wait at most so many: trees are no deeper.
pub(in crate::certify::lanes) const MOST_DEPTH: usize = 128;

pub(super) struct Walk<S: Simd> {
    base: Vec3<Real<S>>,
    inverse: Vec3<Real<S>>,
    /// What the boxes are widened by, as rays are not known exactly.
    pad: Real<S>,
    waiting: [u32; MOST_DEPTH],
    count: usize,
}

impl<S: Simd> Walk<S> {
    #[inline(always)]
    pub(super) fn new<'a>(scene: &'a Scene<'a, S>, tree: Tree, ray: SecondaryRay<S>) -> Self {
        let tiny = scene.real(1e-20);
        let inverse = ray
            .dir
            .map(|along| 1.0 / along.abs().lt(tiny).select(tiny, along));
        let size = ray.size + scene.bvh_size;
        let moved = ray.base_error + ray.start_error;
        let pad =
            SECOND_ORDER * (moved + ray.dir_error * (size + moved)) + BOX_ROUNDINGS * U * size;
        let mut waiting = [0; MOST_DEPTH];
        waiting[0] = tree.root;
        Self {
            base: ray.base,
            inverse,
            pad,
            waiting,
            count: 1,
        }
    }

    /// The objects of the next leaf that some lane of `on` enters before `reach`.
    #[inline(always)]
    pub(super) fn next<'a>(
        &mut self,
        scene: &'a Scene<'a, S>,
        on: M<S>,
        reach: Real<S>,
    ) -> Option<Range<usize>> {
        #[cfg(test)]
        let on = tests::inverted(Fault::BoxInverted, on);
        while self.count > 0 {
            self.count -= 1;
            let mut index = self.waiting[self.count];
            loop {
                let node = &scene.bvh[index as usize];
                if node.count > 0 {
                    let first = node.first as usize;
                    return Some(first..first + node.count as usize);
                }
                let [left, right] = [0, 1].map(|child| self.enters(scene, node.first + child));
                let goes = |near: Real<S>| on & near.ge(scene.real(0.0)) & near.le(reach);
                let (go_left, go_right) = (goes(left), goes(right));
                match (go_left.any(), go_right.any()) {
                    (true, true) => {
                        // The first that most lanes come to.
                        let sooner = (left.le(right) & go_left).bits().count_ones();
                        let later = (right.lt(left) & go_right).bits().count_ones();
                        let second = u32::from(sooner >= later);
                        self.waiting[self.count] = node.first + second;
                        self.count += 1;
                        index = node.first + 1 - second;
                    }
                    (true, false) => index = node.first,
                    (false, true) => index = node.first + 1,
                    (false, false) => break,
                }
            }
        }
        None
    }

    /// Where rays enter a box, in units of their directions; negative where they do not.
    #[inline(always)]
    fn enters<'a>(&self, scene: &'a Scene<'a, S>, index: u32) -> Real<S> {
        let node = &scene.bvh[index as usize];
        let pad = Vec3::splat(self.pad);
        let a = (scene.reals(node.min) - self.base - pad) * self.inverse;
        let b = (scene.reals(node.max) - self.base + pad) * self.inverse;
        let low = a.zip(b, |a, b| a.min(b));
        let high = a.zip(b, |a, b| a.max(b));
        let near = low.x.max(low.y).max(low.z.max(scene.real(0.0)));
        let far = high.x.min(high.y).min(high.z);
        near.le(far * BVH_FAR)
            .select(near * BVH_NEAR, scene.real(-1.0))
    }
}

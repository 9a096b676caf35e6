//! Twin of `shaders/bvh.wgsl`: which of many spheres a ray may hit.

use glam::DVec3;

use crate::prepare::bvh::Bvh;

/// Calls `test` with the index of each sphere of the tree that the ray from `base` along `dir` may hit, near boxes first,
/// as long as they are entered no farther than at `reach`. `test` returns the new reach, in units of `dir`.
///
/// The boxes are asked in f64, whatever the tracer's number type is: their padding is far wider than an f64's error, and
/// keeps what is as far as `reach` in.
pub fn bvh_hits<E>(
    bvh: &Bvh,
    base: DVec3,
    dir: DVec3,
    mut reach: f64,
    mut test: impl FnMut(usize) -> Result<f64, E>,
) -> Result<(), E> {
    // A zero component becomes tiny: the ray stays in its slab or out of it.
    let inverse = dir
        .to_array()
        .map(|c| 1.0 / if c.abs() < 1e-30 { 1e-30 } else { c });
    let base = base.to_array();
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
                bvh.nodes[child]
                    .enters(base, inverse)
                    .filter(|&near| near <= reach)
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

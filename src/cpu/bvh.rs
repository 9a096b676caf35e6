//! Twin of `shaders/bvh.wgsl`: which of many spheres a ray may hit.

use super::camera::Ray;
use super::sphere::sphere_hits;
use super::trace::{Hit, nearer};
use crate::prepare::Prepared;
use crate::prepare::bvh::Bvh;
use crate::real::{Real, Undecided};

/// Tests the spheres of the tree that the ray may hit, near boxes first. The boxes are asked in f64, whatever `R` is:
/// their padding is far wider than an f64's error.
pub fn bvh_hits<R: Real>(
    scene: &Prepared<R>,
    bvh: &Bvh,
    ray: &Ray<R>,
    closest: &mut Option<Hit<R>>,
) -> Result<(), Undecided> {
    let w = ray.w.approx();
    // A zero component becomes tiny: the ray stays in its slab or out of it.
    let inverse = w.to_array().map(|c| 1.0 / if c.abs() < 1e-30 { 1e-30 } else { c });
    let mut stack = Vec::new();
    let mut index = 0;
    loop {
        let node = &bvh.nodes[index];
        let first = node.first as usize;
        let mut next = None;
        if node.count > 0 {
            for index in first..first + node.count as usize {
                let sphere = &scene.spheres[index];
                if let Some(inverse) = sphere_hits(&scene.camera, sphere, ray)? {
                    nearer(closest, Hit { inverse, object: sphere.object, index })?;
                }
            }
        } else {
            // Boxes beyond the closest hit so far cannot hold a nearer one; the padding keeps equal ones in.
            let reach = closest.as_ref().map_or(f64::INFINITY, |hit| 1.0 / hit.inverse.approx());
            let enters = |child: usize| bvh.nodes[child].enters(inverse).filter(|&near| near <= reach);
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

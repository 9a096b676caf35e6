//! Bounding volume hierarchies over many spheres and over many triangles, for rays from anywhere. For both tracers.
//!
//! `obvhs` builds the tree from f32 boxes. A box is padded outward before that, by more than a slab test in f32 can
//! err, so that the tree only ever says "may be hit": what is hit, and where, is decided by what it holds alone.

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

use super::boxes::Bounds;
use super::world_sphere::WorldSphere;
use crate::real::Real;

/// A tree. The spheres or triangles it holds stand in its order: a leaf's are `first..first + count`.
#[derive(Debug, Clone)]
pub struct Bvh {
    /// Node 0 is the root.
    pub nodes: Vec<Node>,
    /// Most nodes that wait while one is looked at.
    pub depth: usize,
    /// How many spheres or triangles the tree holds.
    pub len: usize,
}

impl Bvh {
    /// No point of the boxes is farther than this from the viewpoint.
    pub fn size(&self) -> f64 {
        let root = &self.nodes[0];
        let reach = |i: usize| f64::from(root.min[i].abs().max(root.max[i].abs()));
        reach(0) + reach(1) + reach(2)
    }
}

/// A box, from the viewpoint in units of 2^scale, and what is in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Its least corner.
    pub min: [f32; 3],
    /// Its greatest corner.
    pub max: [f32; 3],
    /// A leaf's first sphere or triangle, or the first of an inner node's two children, which are neighbours.
    pub first: u32,
    /// How many a leaf holds; 0 for an inner node.
    pub count: u32,
}

/// From this many spheres or triangles on a tree is quicker than asking every one (docs/BENCH.md).
pub const WORTHWHILE: usize = 48;

/// A box is widened by this share of its corners' coordinates: what its own rounding to f32 and a hit point's may be
/// off. The slab test's roundings are relative to the distance, and covered by the slack of the test.
const PAD: f64 = 1.0 / 524_288.0;

/// Coordinates beyond this would overflow an f32 when areas are compared; such spheres and triangles stay outside the
/// tree.
const REACH: f64 = 1e17;

struct Boxed(Aabb);

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// The padded box of a sphere, if f32 can hold it.
fn around_sphere<R: Real>(sphere: &WorldSphere<R>) -> Option<Boxed> {
    let (center, radius) = (sphere.center.to_f64(), sphere.radius.to_f64());
    padded(center - radius, center + radius, radius)
}

/// The padded box between two corners, if f32 can hold it; `size` is how large what it holds is.
fn padded(min: DVec3, max: DVec3, size: f64) -> Option<Boxed> {
    let corner = |corner: DVec3, side: f64| {
        let at = |bound: f64| (bound + side * (PAD * (bound.abs() + size) + 1e-30)) as f32;
        Vec3A::new(at(corner.x), at(corner.y), at(corner.z))
    };
    // A NaN fails this comparison.
    (min.abs().max(max.abs()).max_element() < REACH)
        .then(|| Boxed(Aabb::new(corner(min, -1.0), corner(max, 1.0))))
}

/// Builds the tree over the spheres that f32 can hold and puts those first, in the tree's order; the others follow in
/// their own. None, and nothing moved, if they are too few.
pub fn build<R: Real>(spheres: &mut Vec<WorldSphere<R>>) -> Option<Bvh> {
    let (tree, order) = tree(spheres.iter().map(around_sphere).collect())?;
    let mut unsorted: Vec<Option<WorldSphere<R>>> =
        std::mem::take(spheres).into_iter().map(Some).collect();
    spheres.extend(order.into_iter().filter_map(|i| unsorted[i].take()));
    Some(tree)
}

/// Builds the tree over triangles, given by their vertices, positions from the viewpoint in units of 2^scale. With it
/// come the numbers of all triangles: those of the tree first, in its order.
pub fn over_triangles(triangles: &[[DVec3; 3]]) -> Option<(Bvh, Vec<usize>)> {
    let around = |vertices: &[DVec3; 3]| {
        let [a, b, c] = *vertices;
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        padded(min, max, (max - min).max_element())
    };
    tree(triangles.iter().map(around).collect())
}

/// The tree over what has a box, and the numbers of all: those of the tree first, in its order. None if they are too
/// few.
fn tree(boxes: Vec<Option<Boxed>>) -> Option<(Bvh, Vec<usize>)> {
    let inside: Vec<usize> = (0..boxes.len()).filter(|&i| boxes[i].is_some()).collect();
    if inside.len() < WORTHWHILE {
        return None;
    }
    let outside: Vec<usize> = (0..boxes.len()).filter(|&i| boxes[i].is_none()).collect();
    let boxes: Vec<Boxed> = boxes.into_iter().flatten().collect();
    let tree = build_bvh2(
        &boxes,
        BvhBuildParams::fast_build(),
        &mut Duration::default(),
    );
    let nodes: Vec<Node> = tree
        .nodes
        .iter()
        .map(|node| Node {
            min: node.aabb.min.to_array(),
            max: node.aabb.max.to_array(),
            first: node.first_index,
            count: node.prim_count,
        })
        .collect();
    let order = tree
        .primitive_indices
        .iter()
        .map(|&i| inside[i as usize])
        .chain(outside);
    let order = order.collect();
    let depth = depth(&nodes);
    let len = inside.len();
    Some((Bvh { nodes, depth, len }, order))
}

/// The depth of the tree: one node waits on each level of the way down.
fn depth(nodes: &[Node]) -> usize {
    let mut deepest = 0;
    let mut stack = vec![(0_u32, 1)];
    while let Some((index, depth)) = stack.pop() {
        let node = &nodes[index as usize];
        deepest = deepest.max(depth);
        if node.count == 0 {
            stack.extend([(node.first, depth + 1), (node.first + 1, depth + 1)]);
        }
    }
    deepest
}

impl Node {
    /// Its box.
    #[inline(always)]
    pub fn bounds(&self) -> Bounds {
        Bounds {
            min: self.min.map(f64::from),
            max: self.max.map(f64::from),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::V3;

    fn sphere(object: usize, x: f64, y: f64, z: f64, radius: f64) -> WorldSphere<f64> {
        WorldSphere {
            object,
            center: V3::new(x, y, z),
            radius,
            lights_on_surface: vec![],
        }
    }

    #[test]
    fn every_sphere_is_in_one_leaf_and_in_its_box() {
        // Every fifth is too far for f32.
        let far = |i: usize| if i.is_multiple_of(5) { 1e18 } else { 0.0 };
        let mut spheres: Vec<_> = (0..500)
            .map(|i| {
                let z = -5.0 - (i / 100) as f64;
                sphere(i, (i % 10) as f64 + far(i), (i / 10 % 10) as f64, z, 0.3)
            })
            .collect();
        let tree = build(&mut spheres).unwrap();
        assert_eq!(tree.len, 400);
        assert!(spheres[..400].iter().all(|s| !s.object.is_multiple_of(5)));
        let mut seen = vec![0; 400];
        for node in tree.nodes.iter().filter(|n| n.count > 0) {
            for i in node.first..node.first + node.count {
                seen[i as usize] += 1;
                let c = spheres[i as usize].center;
                for (axis, at) in [c.x, c.y, c.z].into_iter().enumerate() {
                    assert!(
                        f64::from(node.min[axis]) < at - 0.3
                            && at + 0.3 < f64::from(node.max[axis])
                    );
                }
            }
        }
        assert_eq!(seen, vec![1; 400]);
    }

    #[test]
    fn every_triangle_is_in_one_leaf_and_in_its_box() {
        // Every seventh is too far for f32; flat ones have boxes all the same.
        let far = |i: usize| if i.is_multiple_of(7) { 1e18 } else { 0.0 };
        let triangle = |i: usize| {
            let at = DVec3::new((i % 10) as f64 + far(i), (i / 10) as f64, -5.0);
            [at, at + DVec3::X, at + DVec3::Y * 0.5]
        };
        let triangles: Vec<_> = (0..300).map(triangle).collect();
        let (tree, order) = over_triangles(&triangles).unwrap();
        assert_eq!((tree.len, order.len()), (257, 300));
        let mut seen = vec![0; 300];
        for node in tree.nodes.iter().filter(|n| n.count > 0) {
            for i in node.first..node.first + node.count {
                let number = order[i as usize];
                seen[number] += 1;
                for vertex in triangles[number] {
                    for axis in 0..3 {
                        let (min, max) = (f64::from(node.min[axis]), f64::from(node.max[axis]));
                        assert!(min < vertex[axis] && vertex[axis] < max);
                    }
                }
            }
        }
        assert!((0..300).all(|i| seen[i] == usize::from(!i.is_multiple_of(7))));
    }

    #[test]
    fn few_spheres_get_no_tree() {
        let mut spheres: Vec<_> = (0..WORTHWHILE - 1)
            .map(|i| sphere(i, i as f64, 0.0, -5.0, 0.3))
            .collect();
        assert!(build(&mut spheres).is_none());
    }
}

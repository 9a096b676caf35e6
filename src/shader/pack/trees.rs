//! The trees over spheres and triangles, in one list of nodes.

use crate::prepare::World;
use crate::prepare::bvh::Bvh;
use crate::real::Bounded;
use crate::shader::records::BvhNode;

/// The nodes of the spheres' tree, then of the triangles'.
#[derive(Default)]
pub(super) struct Trees {
    pub(super) nodes: Vec<BvhNode>,
    pub(super) depth: usize,
    pub(super) triangle_root: Option<usize>,
}

impl Trees {
    pub(super) fn new(world: Option<&World<Bounded>>) -> Self {
        let mut trees = Self::default();
        let Some(world) = world else { return trees };
        if let Some(tree) = &world.sphere_tree {
            trees.add(tree, 0);
        }
        if let Some(tree) = &world.triangle_tree {
            trees.triangle_root = Some(trees.nodes.len());
            trees.add(tree, world.loose_planes());
        }
        trees
    }

    /// Adds the nodes of a tree whose leaves begin to count at `first`.
    fn add(&mut self, tree: &Bvh, first: usize) {
        let root = self.nodes.len();
        self.depth = self.depth.max(tree.depth);
        self.nodes.extend(tree.nodes.iter().map(|node| BvhNode {
            min: node.min,
            first: node.first + if node.count == 0 { root } else { first } as u32,
            max: node.max,
            count: node.count,
        }));
    }
}

pub(super) fn node_size(node: &BvhNode) -> f64 {
    let corner = |i: usize| f64::from(node.min[i].abs().max(node.max[i].abs()));
    corner(0) + corner(1) + corner(2)
}

//! The trees over spheres and triangles, in one list of nodes.

use crate::prepare::World;
use crate::prepare::bvh::Bvh;
use crate::shader::format::Format;
use crate::shader::records::wide::BvhNode;

/// The nodes of the spheres' tree, then of the triangles'.
pub(super) struct Trees<F: Format> {
    pub(super) nodes: Vec<F::Record<BvhNode>>,
    pub(super) depth: usize,
    pub(super) triangle_root: Option<usize>,
}

impl<F: Format> Trees<F> {
    pub(super) fn new(world: Option<&World<F::Number>>) -> Self {
        let mut trees = Self {
            nodes: Vec::new(),
            depth: 0,
            triangle_root: None,
        };
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
        self.nodes.extend(tree.nodes.iter().map(|node| {
            F::record(BvhNode {
                min: node.min.map(f64::from),
                first: node.first + if node.count == 0 { root } else { first } as u32,
                max: node.max.map(f64::from),
                count: node.count,
            })
        }));
    }
}

pub(super) fn node_size(node: &BvhNode) -> f64 {
    let corner = |i: usize| node.min[i].abs().max(node.max[i].abs());
    corner(0) + corner(1) + corner(2)
}

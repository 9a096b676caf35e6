//! Which objects are packed at all, and which of them share a surface.

use crate::prepare::{Prepared, world};
use crate::real::Bounded;
use crate::scene::{Scene, Shape};

/// Which objects share a surface, and which never come first on theirs.
#[derive(Debug)]
pub(super) struct Surfaces {
    /// The number of each object's surface.
    groups: Vec<u32>,
    /// Whether no ray hits it: an object that comes before covers all of it, or all of it is before the screen.
    pub(super) hidden: Vec<bool>,
    /// For each surface, whether several objects that are not hidden share it.
    shared: Vec<bool>,
}

impl Surfaces {
    pub(super) fn new(scene: &Scene, prepared: &Prepared<Bounded>, tolerance: f64) -> Self {
        let groups = match &prepared.world {
            Some(world) => world.groups.to_vec(),
            None => world::groups(scene, prepared.tiles.is_none()),
        };
        let count = groups.iter().map(|g| *g as usize + 1).max().unwrap_or(0);
        let mut covered = vec![false; count];
        let mut members = vec![0_u32; count];
        let mut hidden = Vec::with_capacity(groups.len());
        for (object, group) in scene.objects.iter().zip(&groups) {
            // A plane of constant z before τ is never hit.
            let before = matches!(object.shape, Shape::Plane { normal, point, .. }
                if normal.x == 0.0 && normal.y == 0.0 && point.z > tolerance);
            let hides = before || covered[*group as usize];
            hidden.push(hides);
            if !hides {
                members[*group as usize] += 1;
            }
            if !matches!(
                object.shape,
                Shape::Plane {
                    extent: Some(_),
                    ..
                }
            ) {
                covered[*group as usize] = true;
            }
        }
        Self {
            groups,
            hidden,
            shared: members.into_iter().map(|n| n > 1).collect(),
        }
    }

    /// A number for the object's surface if others share it, else 0.
    pub(super) fn shared(&self, object: usize) -> u32 {
        let group = self.groups[object];
        if self.shared[group as usize] {
            group + 1
        } else {
            0
        }
    }
}

//! Which objects share a surface.

use crate::prepare::Prepared;
use crate::real::Real;

/// Numbers of surfaces, and which of them several objects share.
#[derive(Debug)]
pub(super) struct Surfaces<'a> {
    /// The number of each object's surface.
    groups: &'a [u32],
    /// For each surface, whether several objects that can be hit share it.
    shared: Vec<bool>,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(prepared: &'a Prepared<impl Real>) -> Self {
        let groups = &prepared.groups;
        let mut members = vec![0_u32; groups.iter().map(|g| *g as usize + 1).max().unwrap_or(0)];
        for (group, hidden) in groups.iter().zip(prepared.hidden.iter()) {
            members[*group as usize] += u32::from(!hidden);
        }
        Self {
            groups,
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

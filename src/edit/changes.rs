//! The changes on top of a scene: an ordered map from [`Target`] to [`Value`], checked when a value is set.

use std::collections::BTreeMap;

use super::target::{Target, Value};
use crate::scene::{self, Scene};

/// Why a value was not taken, in a sentence without a full stop.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(String);

/// What is changed of a scene, at most one value a target, in the order of [`Target`].
///
/// Every value in it keeps the limits of the scene language (docs/SCENE.md): see [`Changes::set`]. What attributes must
/// keep between them concerns none that can be changed. So a good scene with changes on top is a good scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Changes {
    pub(super) values: BTreeMap<Target, Value>,
}

impl Changes {
    /// None.
    pub fn new() -> Self {
        Self::default()
    }

    /// Changes a target to a value, in place of an earlier one. −0 becomes 0, as in a file.
    ///
    /// This is where a value is checked, and the only place. Nothing is clamped: one that the scene language does not
    /// allow is refused, and the earlier one stays.
    ///
    /// # Errors
    /// When the value breaks the limit of its attribute, is not finite, or is one number where there are three, or the
    /// other way round.
    pub fn set(&mut self, target: Target, value: impl Into<Value>) -> Result<(), Refused> {
        let value = value.into().with_positive_zeros();
        match scene::fault(target.entity_type(), target.attribute(), value.numbers()) {
            Some(fault) => Err(Refused(fault)),
            None => {
                self.values.insert(target, value);
                Ok(())
            }
        }
    }

    /// What a target is changed to.
    pub fn get(&self, target: Target) -> Option<Value> {
        self.values.get(&target).copied()
    }

    /// Takes a change back.
    pub fn remove(&mut self, target: Target) -> Option<Value> {
        self.values.remove(&target)
    }

    /// Takes all changes back.
    pub fn clear(&mut self) {
        self.values.clear();
    }

    /// Is nothing changed?
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// How many targets are changed.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// All changes, in the order of [`Target`].
    pub fn iter(&self) -> impl Iterator<Item = (Target, Value)> + '_ {
        self.values.iter().map(|(target, value)| (*target, *value))
    }

    /// A scene with the changes on top. Textures are shared with the original, the rest is copied.
    #[must_use]
    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut changed = scene.clone();
        self.apply_to(&mut changed);
        changed
    }

    /// Puts the changes into a scene. A change of what the scene does not have does nothing.
    pub fn apply_to(&self, scene: &mut Scene) {
        for (target, value) in self.iter() {
            target.put(scene, value);
        }
    }
}

#[cfg(test)]
mod tests;

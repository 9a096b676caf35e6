//! The changes on top of a scene: an ordered map from [`Target`] to [`Value`], checked when a value is set.

use std::collections::BTreeMap;

use super::target::{Target, Value};
use crate::scene::{self, EntityId, Scene};

/// Why a value was not taken, in a sentence without a full stop.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(String);

/// What is changed of a scene, at most one value a target, in the order of [`Target`].
///
/// The changes keep the limits of the scene language (docs/SCENE.md), also what attributes must keep between them: see
/// [`Changes::set`]. So a good scene with changes on top is a good scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Changes {
    pub(super) values: BTreeMap<Target, Value>,
}

impl Changes {
    /// None.
    pub fn new() -> Self {
        Self::default()
    }

    /// Changes a target of a scene to a value, in place of an earlier one. −0 becomes 0, as in a file.
    ///
    /// This is where a value is checked, and the only place. Nothing is clamped: one that the scene language does not
    /// allow, by itself or beside the entity's other numbers as they are with the changes, is refused, and the earlier
    /// one stays.
    ///
    /// # Errors
    /// When the value breaks a limit, is not finite, is more or fewer numbers than the attribute has, or the scene has
    /// no such numbers.
    pub fn set(
        &mut self,
        scene: &Scene,
        target: Target,
        value: impl Into<Value>,
    ) -> Result<(), Refused> {
        let value = value.into().with_positive_zeros();
        let others = self.of(target.entity());
        let others = others.filter(|(other, _)| *other != target);
        let changed = others
            .map(|(other, value)| (other.attribute(), value))
            .chain([(target.attribute(), &value)]);
        let changed = changed.map(|(attribute, value)| (attribute, value.numbers()));
        if let Some(fault) = scene::fault(scene, target.entity(), changed) {
            return Err(Refused(fault));
        }
        self.values.insert(target, value);
        Ok(())
    }

    /// What a target is changed to.
    pub fn get(&self, target: Target) -> Option<Value> {
        self.values.get(&target).copied()
    }

    /// Takes a change back. Returns what it was.
    ///
    /// # Errors
    /// When the scene's own value contradicts what else is changed of the entity; nothing is taken back then.
    pub fn reset(&mut self, scene: &Scene, target: Target) -> Result<Option<Value>, Refused> {
        let value = self.values.remove(&target);
        if let (Some(value), Some(fault)) = (value, self.fault(scene, target.entity())) {
            self.values.insert(target, value);
            return Err(Refused(fault));
        }
        Ok(value)
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

    /// What else has to be changed where `base` is on top of the scene already, so that it is as with these alone.
    #[must_use]
    pub fn beyond(&self, base: &Self, scene: &Scene) -> Self {
        let mut values = BTreeMap::new();
        for target in self.values.keys().chain(base.values.keys()) {
            let file = || target.value_in(scene);
            let wanted = self.get(*target).or_else(file);
            if wanted != base.get(*target).or_else(file) {
                values.extend(wanted.map(|value| (*target, value)));
            }
        }
        Self { values }
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

    /// The changes of one entity.
    fn of(&self, entity: EntityId) -> impl Iterator<Item = (Target, &Value)> {
        // No attribute has an empty name, which stands before all others.
        let changes = self.values.range(Target::new(entity, "")..);
        changes
            .take_while(move |(target, _)| target.entity() == entity)
            .map(|(target, value)| (*target, value))
    }

    /// What is wrong with an entity of a scene under the changes.
    pub(super) fn fault(&self, scene: &Scene, entity: EntityId) -> Option<String> {
        let changed = self.of(entity);
        let changed = changed.map(|(target, value)| (target.attribute(), value.numbers()));
        scene::fault(scene, entity, changed)
    }
}

#[cfg(test)]
mod tests;

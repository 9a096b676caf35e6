//! The file was edited under the changes: which of them stay on top of the new scene, and where.

use std::collections::HashMap;
use std::fmt;

use super::changes::Changes;
use super::target::{Target, Value, kind_and_name, titled};
use crate::scene::{EntityId, Scene};

/// A change that is no longer on top of the file. Printed, it is a sentence without a full stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Dropped {
    /// What was changed, in the old scene.
    pub target: Target,
    /// What it was changed to.
    pub value: Value,
    /// Why it is no longer.
    pub message: String,
}

impl fmt::Display for Dropped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// An entity as a person who edits the file would say it: its type, its name, and its number among those of the same
/// type and name, from 0.
type Identity<'s> = (&'static str, &'s str, usize);

/// Whose value an attribute gets that was changed, and changed in the file too.
#[derive(Clone, Copy, PartialEq)]
enum Counts {
    File,
    Change,
}

impl Changes {
    /// Moves the changes from the scene `old` to the scene `new`, which the file has become under them.
    ///
    /// A change stays where its entity is still there, the n-th of its type and name (the camera whatever its name),
    /// and the file's own value is what it was; its index becomes that of the new scene. Otherwise the file counts, and
    /// the change is returned with the reason. A change to what the file now says itself is dropped without a word.
    /// Where what is left contradicts the file's other numbers of the entity, none of the entity stays.
    ///
    /// Takes time in the number of entities and changes.
    pub fn rebase(&mut self, old: &Scene, new: &Scene) -> Vec<Dropped> {
        let moves = Moves::find(self.values.keys().copied(), old, new);
        let (moved, dropped) = self.moved(&moves, [old, new], Counts::File);
        *self = moved;
        dropped
    }

    /// Moves changes that were once made, as [`Changes::rebase`] does, but that they count and not the file: all of
    /// which the entity is still there stay.
    ///
    /// Takes time in the number of entities, and of changes of all of them.
    pub fn rebase_earlier<'c>(
        earlier: impl Iterator<Item = &'c mut Self>,
        old: &Scene,
        new: &Scene,
    ) {
        let mut earlier: Vec<_> = earlier.collect();
        let targets = earlier
            .iter()
            .flat_map(|changes| changes.values.keys().copied());
        let moves = Moves::find(targets, old, new);
        for changes in &mut earlier {
            **changes = changes.moved(&moves, [old, new], Counts::Change).0;
        }
    }

    fn moved(
        &self,
        moves: &Moves,
        [old, new]: [&Scene; 2],
        counts: Counts,
    ) -> (Self, Vec<Dropped>) {
        let (mut stay, mut dropped) = (Self::new(), Vec::new());
        let mut origins = HashMap::new();
        for (target, value) in self.iter() {
            let moved = moves.of(target);
            let now = moved.and_then(|moved| moved.value_in(new));
            let attribute = target.attribute();
            let why = match (moved, now) {
                (Some(_), Some(now)) if now == value => continue,
                (Some(moved), Some(now))
                    if counts == Counts::Change || target.value_in(old) == Some(now) =>
                {
                    stay.values.insert(moved, value);
                    origins.insert(moved, target);
                    continue;
                }
                (Some(_), Some(_)) => {
                    format!(": {attribute} was changed in the file, which counts")
                }
                _ => format!(
                    " is no longer in the file, and what was changed of its {attribute} is lost"
                ),
            };
            let message = titled(old, target.entity()) + &why;
            dropped.push(Dropped {
                target,
                value,
                message,
            });
        }
        let mut entities: Vec<_> = stay.values.keys().map(|target| target.entity()).collect();
        entities.dedup();
        for entity in entities {
            let Some(fault) = stay.fault(new, entity) else {
                continue;
            };
            let wrong: Vec<_> = stay.iter().filter(|it| it.0.entity() == entity).collect();
            for (target, value) in wrong {
                stay.values.remove(&target);
                dropped.push(Dropped {
                    target: origins.get(&target).copied().unwrap_or(target),
                    value,
                    message: format!(
                        "{}: what was changed of its {} contradicts the file, which counts: {fault}",
                        titled(new, entity),
                        target.attribute()
                    ),
                });
            }
        }
        (stay, dropped)
    }
}

/// Where the changed entities of one scene are in another.
struct Moves(HashMap<EntityId, EntityId>);

impl Moves {
    fn find(targets: impl Iterator<Item = Target>, old: &Scene, new: &Scene) -> Self {
        // Entities are counted only if they have the type and name of a changed one.
        let mut counts = HashMap::new();
        for target in targets {
            if let Some(key) = kind_and_name(old, target.entity()) {
                counts.insert(key, 0);
            }
        }
        let mut identities: HashMap<Identity<'_>, EntityId> = HashMap::new();
        count(new, counts.clone(), |identity, id| {
            identities.insert(identity, id);
        });
        let mut moves = HashMap::from([(EntityId::Camera, EntityId::Camera)]);
        count(old, counts, |identity, id| {
            if let Some(moved) = identities.get(&identity) {
                moves.insert(id, *moved);
            }
        });
        Self(moves)
    }

    fn of(&self, target: Target) -> Option<Target> {
        let moved = *self.0.get(&target.entity())?;
        Some(Target::new(moved, target.attribute()))
    }
}

/// Hands over the entities of a scene whose type and name are counted, each with its identity.
fn count<'s>(
    scene: &'s Scene,
    mut counts: HashMap<(&'static str, &'s str), usize>,
    mut found: impl FnMut(Identity<'s>, EntityId),
) {
    let materials = (0..scene.materials.len()).map(EntityId::Material);
    let objects = (0..scene.objects.len()).map(EntityId::Object);
    let lights = (0..scene.lights.len()).map(EntityId::Light);
    for id in materials.chain(objects).chain(lights) {
        if let Some((kind, name)) = kind_and_name(scene, id)
            && let Some(count) = counts.get_mut(&(kind, name))
        {
            found((kind, name, *count), id);
            *count += 1;
        }
    }
}

#[cfg(test)]
mod tests;

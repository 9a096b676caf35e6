//! What can be changed of a scene: the keys and values of [`Changes`](super::Changes). Which attributes there are, and
//! where in a [`Scene`] each is, the language's table knows (`scene/attributes.rs`).

use std::fmt;

use glam::DVec3;

use crate::diagnostic::quote;
use crate::scene::{self, EntityId, MOST_NUMBERS, Scene};

/// What can be changed: one attribute of one entity, of those that are numbers.
///
/// Any pair can be named. What a scene does not have has no value in it and cannot be changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Target {
    entity: EntityId,
    attribute: &'static str,
}

/// What an attribute is changed to: its numbers, as many as it has, or none where it is left out.
#[derive(Clone, Copy)]
pub struct Value {
    numbers: [f64; MOST_NUMBERS],
    count: usize,
}

impl Value {
    /// What an attribute has that is not given, where that means something else than zero.
    pub const LEFT_OUT: Self = Self {
        numbers: [0.0; MOST_NUMBERS],
        count: 0,
    };

    /// These numbers; nothing where they are more than any attribute has.
    pub fn new(numbers: &[f64]) -> Option<Self> {
        let mut all = [0.0; MOST_NUMBERS];
        all.get_mut(..numbers.len())?.copy_from_slice(numbers);
        Some(Self {
            numbers: all,
            count: numbers.len(),
        })
    }

    /// Its numbers.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers[..self.count]
    }

    /// As a place or a direction, where it is three numbers.
    pub fn vector(&self) -> Option<DVec3> {
        <[f64; 3]>::try_from(self.numbers())
            .ok()
            .map(DVec3::from_array)
    }

    /// As a scene has it: zero is never negative.
    pub(super) fn with_positive_zeros(mut self) -> Self {
        self.numbers.iter_mut().for_each(|number| *number += 0.0);
        self
    }
}

impl PartialEq for Value {
    fn eq(&self, other: &Self) -> bool {
        self.numbers() == other.numbers()
    }
}

impl fmt::Debug for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.numbers().fmt(f)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        [number].into()
    }
}

impl From<DVec3> for Value {
    fn from(vector: DVec3) -> Self {
        vector.to_array().into()
    }
}

impl<const COUNT: usize> From<[f64; COUNT]> for Value {
    fn from(given: [f64; COUNT]) -> Self {
        const { assert!(COUNT <= MOST_NUMBERS, "no attribute has so many numbers") };
        let mut numbers = [0.0; MOST_NUMBERS];
        numbers[..COUNT].copy_from_slice(&given);
        Self {
            numbers,
            count: COUNT,
        }
    }
}

impl Target {
    /// The camera's viewpoint.
    pub const VIEWPOINT: Self = Self::new(EntityId::Camera, "viewpoint");

    /// An attribute of an entity, by its name in docs/SCENE.md's tables.
    pub const fn new(entity: EntityId, attribute: &'static str) -> Self {
        Self { entity, attribute }
    }

    /// All that can be changed of an entity, in the order of docs/SCENE.md's tables.
    pub fn all_of(scene: &Scene, entity: EntityId) -> impl Iterator<Item = Self> {
        let rows = scene::number_rows(scene, entity);
        rows.map(move |row| Self::new(entity, row.name()))
    }

    /// The entity that it is of.
    pub fn entity(self) -> EntityId {
        self.entity
    }

    /// The attribute's name in the file.
    pub fn attribute(self) -> &'static str {
        self.attribute
    }

    /// The value that a scene has there; nothing where it has no such entity, or that has no such attribute.
    pub fn value_in(self, scene: &Scene) -> Option<Value> {
        Value::new(&scene::numbers_of(scene, self.entity, self.attribute)?)
    }

    /// Puts a value of the right length there; nothing happens where there is nothing of the kind.
    pub(super) fn put(self, scene: &mut Scene, value: Value) {
        scene::put(scene, self.entity, self.attribute, value.numbers());
    }
}

/// The type and the name of an entity of a scene, as in ``sphere `ball` ``.
pub(super) fn titled(scene: &Scene, id: EntityId) -> String {
    match kind_and_name(scene, id) {
        Some((kind, name)) => format!("{kind} {}", quote(name.as_bytes())),
        // Only where the changes are of another scene than the caller says.
        None => String::from("something"),
    }
}

/// The type and the name of an entity; nothing where a scene has no such entity.
pub(super) fn kind_and_name(scene: &Scene, id: EntityId) -> Option<(&'static str, &str)> {
    match id {
        EntityId::Camera => Some(("camera", scene.camera.name.as_str())),
        EntityId::Material(index) => {
            let material = scene.materials.get(index)?;
            Some(("material", material.name.as_str()))
        }
        EntityId::Texture(index) => Some(("texture", scene.textures.get(index)?.name.as_str())),
        EntityId::Object(index) => {
            let object = scene.objects.get(index)?;
            Some((object.entity(), object.name.as_str()))
        }
        EntityId::Light(index) => {
            let light = scene.lights.get(index)?;
            Some((light.entity(), light.name.as_str()))
        }
    }
}

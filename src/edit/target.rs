//! What can be changed of a scene, and where that is in a [`Scene`]: the keys and values of
//! [`Changes`](super::Changes).

use glam::DVec3;

use crate::diagnostic::quote;
use crate::scene::{EntityId, Scene, Shape};

/// What can be changed: one attribute of one entity. In this order they stand in [`Changes`](super::Changes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Target {
    /// The camera's viewpoint: a vector, z > 0.
    Viewpoint,
    /// A reflectivity of the material of this index: r g b, each ≥ 0.
    Material(usize, Reflectivity),
    /// A measure of the object of this index, which is a sphere or psphere.
    Sphere(usize, Measure),
    /// The emissivity of the light, spotlight or projector of this index: r g b, each ≥ 0.
    Light(usize),
}

/// The reflectivities of a material, in the order in which one writes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Reflectivity {
    /// For the light that is everywhere.
    Ambient,
    /// For light from lights.
    Diffuse,
    /// Of a mirror.
    Specular,
}

/// The measures of a sphere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Measure {
    /// Its center: a vector.
    Center,
    /// Its radius: a number > 0.
    Radius,
}

/// What an attribute is changed to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// One number.
    Number(f64),
    /// Three: x y z, or r g b.
    Vector(DVec3),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

impl From<DVec3> for Value {
    fn from(vector: DVec3) -> Self {
        Value::Vector(vector)
    }
}

impl From<[f64; 3]> for Value {
    fn from(vector: [f64; 3]) -> Self {
        Value::Vector(vector.into())
    }
}

impl Value {
    /// Its numbers: one or three.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Value::Number(number) => std::slice::from_ref(number),
            Value::Vector(vector) => vector.as_ref(),
        }
    }

    /// As a scene has it: zero is never negative.
    pub(super) fn with_positive_zeros(self) -> Self {
        match self {
            Value::Number(number) => Value::Number(number + 0.0),
            Value::Vector(vector) => Value::Vector(vector + DVec3::ZERO),
        }
    }
}

impl Reflectivity {
    /// All of them, in order.
    pub const ALL: [Reflectivity; 3] = [
        Reflectivity::Ambient,
        Reflectivity::Diffuse,
        Reflectivity::Specular,
    ];

    /// The attribute's name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Reflectivity::Ambient => "ambient",
            Reflectivity::Diffuse => "diffuse",
            Reflectivity::Specular => "specular",
        }
    }
}

impl Target {
    /// The entity that it is of.
    pub fn entity(self) -> EntityId {
        match self {
            Target::Viewpoint => EntityId::Camera,
            Target::Material(index, _) => EntityId::Material(index),
            Target::Sphere(index, _) => EntityId::Object(index),
            Target::Light(index) => EntityId::Light(index),
        }
    }

    /// The attribute's name in the file.
    pub fn attribute(self) -> &'static str {
        match self {
            Target::Viewpoint => "viewpoint",
            Target::Material(_, reflectivity) => reflectivity.name(),
            Target::Sphere(_, Measure::Center) => "center",
            Target::Sphere(_, Measure::Radius) => "radius",
            Target::Light(_) => "emissivity",
        }
    }

    /// An entity type that has this attribute; where several have it, its limits are the same in all of them (tested).
    pub(super) fn entity_type(self) -> &'static str {
        match self {
            Target::Viewpoint => "camera",
            Target::Material(..) => "material",
            Target::Sphere(..) => "sphere",
            Target::Light(_) => "light",
        }
    }

    /// The value that a scene has there; nothing where it has no such entity, or the object is no sphere.
    pub fn value_in(self, scene: &Scene) -> Option<Value> {
        match self {
            Target::Viewpoint => Some(scene.camera.viewpoint.into()),
            Target::Material(index, reflectivity) => {
                let material = scene.materials.get(index)?;
                let value = match reflectivity {
                    Reflectivity::Ambient => material.ambient,
                    Reflectivity::Diffuse => material.diffuse,
                    Reflectivity::Specular => material.specular,
                };
                Some(value.into())
            }
            Target::Sphere(index, measure) => {
                let Shape::Sphere { center, radius } = &scene.objects.get(index)?.shape else {
                    return None;
                };
                Some(match measure {
                    Measure::Center => (*center).into(),
                    Measure::Radius => (*radius).into(),
                })
            }
            Target::Light(index) => Some(scene.lights.get(index)?.emissivity.into()),
        }
    }

    /// Puts a value of the right length there; nothing happens where there is nothing of the kind.
    pub(super) fn put(self, scene: &mut Scene, value: Value) {
        match (self, value) {
            (Target::Viewpoint, Value::Vector(value)) => scene.camera.viewpoint = value,
            (Target::Material(index, reflectivity), Value::Vector(value)) => {
                if let Some(material) = scene.materials.get_mut(index) {
                    match reflectivity {
                        Reflectivity::Ambient => material.ambient = value,
                        Reflectivity::Diffuse => material.diffuse = value,
                        Reflectivity::Specular => material.specular = value,
                    }
                }
            }
            (Target::Sphere(index, measure), value) => {
                if let Some(object) = scene.objects.get_mut(index)
                    && let Shape::Sphere { center, radius } = &mut object.shape
                {
                    match (measure, value) {
                        (Measure::Center, Value::Vector(value)) => *center = value,
                        (Measure::Radius, Value::Number(value)) => *radius = value,
                        _ => {}
                    }
                }
            }
            (Target::Light(index), Value::Vector(value)) => {
                if let Some(light) = scene.lights.get_mut(index) {
                    light.emissivity = value;
                }
            }
            (Target::Viewpoint | Target::Material(..) | Target::Light(_), Value::Number(_)) => {}
        }
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

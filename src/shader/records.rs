//! The GPU's records, each a list of fields: see [`record`](super::record) for all that follows from it.

mod lit;
mod primary;
#[cfg(test)]
mod tests;

use super::format::{Format, Single};
use super::record::Layout;
pub use lit::{Light, LitObject, Material, Projector, WorldPlane, WorldSphere};
pub use primary::{
    BvhNode, CameraNumbers, Dispatch, Object, Plane, Polygon, ProceduralPlane, Quadric, Sphere,
    SphereAndHit, SphereHit, Texplane, TiledPlane,
};

/// The layouts of all records.
pub fn layouts() -> impl Iterator<Item = &'static Layout> {
    [primary::LAYOUTS, lit::LAYOUTS].into_iter().flatten()
}

/// The records with f64 for f32.
pub mod wide {
    pub use super::lit::wide::*;
    pub use super::primary::wide::*;
}

/// What the shader is told of the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackedCamera<F: Format = Single> {
    /// Its numbers, which go into the text of the shader as a rule.
    pub numbers: F::Record<wide::CameraNumbers>,
    /// Bound of the error of W, as a vector.
    pub w_error: f32,
    /// κ ≥ 1 (docs/NUMERICS.md): the terms that W·W is a sum of, over W·W.
    pub condition: f32,
}

//! What depends on the scene alone, computed once, on the host, before anything is rounded to f32.
//!
//! Stands between `scene` (what the file says) and the two tracers: `cpu` runs on a [`Prepared`] over its own number
//! type, `shader::pack` rounds a `Prepared<Bounded>` to f32. Two rules make f32 enough for nearly every pixel
//! (docs/NUMERICS.md):
//!
//! - **The viewpoint is the origin, and lengths are in units of 2^scale**, the power of two next below the viewpoint's
//!   z. Every ray starts at the origin; differences from the viewpoint are taken here, where there are bits to lose.
//! - **What is linear in the pixel stays linear**: the inverse 1/s of the ray parameter of a plane, the offset from a
//!   sphere's projected center, the z > τ rule. No 10000 and no 1000 of the tile rules ever meets an f32.

pub mod boxes;
pub mod brightest;
pub mod bvh;
pub mod camera;
pub mod extent;
pub mod groups;
pub mod hidden;
pub mod index;
pub mod local_quadric;
pub mod material;
pub mod on_demand;
pub mod plane;
pub mod prepared;
pub mod projector;
pub mod quadric;
pub mod screen_grid;
pub mod sphere;
pub mod surface;
mod triangle;
pub mod world;
pub mod world_plane;
pub mod world_sphere;

pub use crate::settings::ViewParameters;
pub use camera::Camera;
pub use material::{Light, Material};
pub use plane::Plane;
pub use prepared::Prepared;
pub use quadric::Quadric;
pub use sphere::Sphere;
pub use surface::Surface;
pub use world::World;
pub use world_plane::WorldPlane;
pub use world_sphere::WorldSphere;

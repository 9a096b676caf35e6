//! What depends on the scene alone, computed once, on the host, before anything is rounded to f32.
//!
//! Stands between `scene` (what the file says) and the two tracers: `cpu` runs on a [`Prepared`] over its own number
//! type, `gpu::pack` rounds a `Prepared<f64>` to f32. Two rules make f32 enough for nearly every pixel (docs/NUMERICS.md):
//!
//! - **The viewpoint is the origin, and lengths are in units of 2^scale**, the power of two next below the viewpoint's z.
//!   Every ray starts at the origin; differences from the viewpoint are taken here, where there are bits to lose.
//! - **What is linear in the pixel stays linear**: the inverse 1/s of the ray parameter of a plane, the offset from a
//!   sphere's projected center, the z > τ rule. No 10000 and no 1000 of the tile rules ever meets an f32.

pub mod bvh;
pub mod camera;
pub mod exact;
pub mod plane;
pub mod sphere;
pub mod surface;

use bvh::Bvh;

use crate::real::{Real, V3};
use crate::scene::{Scene, Shape};

pub use camera::Camera;
pub use plane::Plane;
pub use sphere::Sphere;
pub use surface::Surface;

/// A scene made ready for tracing rays from its viewpoint, in the number type `R`.
#[derive(Debug, Clone)]
pub struct Prepared<R> {
    /// How a pixel becomes a ray.
    pub camera: Camera<R>,
    /// The planes that a primary ray can hit, in file order.
    pub planes: Vec<Plane<R>>,
    /// The spheres that a primary ray can hit: those of the tree in its order, then the others in file order.
    pub spheres: Vec<Sphere<R>>,
    /// The tree over the spheres seen small, if there are many.
    pub bvh: Option<Bvh>,
    /// One for each object of the scene: what it looks like.
    pub surfaces: Vec<Surface<R>>,
    /// One for each object of the scene: index of its material.
    pub materials: Vec<usize>,
    /// One for each material of the scene: its ambient reflectivity.
    pub ambient: Vec<V3<R>>,
}

impl<R: Real> Prepared<R> {
    /// Prepares `scene` for the screen tolerance τ (0 in the notes).
    pub fn new(scene: &Scene, screen_tolerance: f64) -> Self {
        let camera = Camera::new(&scene.camera);
        let mut planes = Vec::new();
        let mut spheres = Vec::new();
        let mut surfaces = Vec::with_capacity(scene.objects.len());
        for (index, object) in scene.objects.iter().enumerate() {
            match object.shape {
                Shape::Plane { normal, point, .. } => {
                    planes.extend(Plane::new(&scene.camera, screen_tolerance, index, normal, point));
                }
                Shape::Sphere { center, radius } => {
                    spheres.extend(Sphere::new(&scene.camera, &camera, index, center, radius));
                }
            }
            surfaces.push(Surface::new(scene, object));
        }
        let bvh = bvh::build(&mut spheres, |sphere| sphere.seen.is_some());
        let materials = scene.objects.iter().map(|object| object.material).collect();
        let ambient = scene.materials.iter().map(|material| V3::exact(material.ambient)).collect();
        Self { camera, planes, spheres, bvh, surfaces, materials, ambient }
    }
}

//! Spheres and triangles that are made ready one by one, when a ray comes near them: for number types whose numbers
//! take memory.
//!
//! Their trees and the screen grid, and all that is no number, is shared with a scene prepared before in another type.
//! The floor below `world` and `prepared`, which hold an [`OnDemandShapes`] in place of their spheres and triangles.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::camera::Camera;
use super::plane::Plane;
use super::sphere::Sphere;
use super::world_plane::WorldPlane;
use super::world_sphere::WorldSphere;
use crate::real::rational::two_to;
use crate::real::{Real, V3};
use crate::scene::{self, Light, Scene, Shape, Triangle};
use crate::settings::ViewParameters;

/// What many spheres and triangles are made from.
#[derive(Debug, Clone)]
pub struct OnDemandShapes {
    camera: scene::Camera,
    view: ViewParameters,
    lights: Arc<Vec<Light>>,
    scale: i32,
    /// One for each object: center and radius; of others nothing.
    balls: Balls,
    /// The objects that are spheres, in the order of the prepared ones.
    order: Arc<Vec<u32>>,
    /// The triangles, in the order of the prepared ones, each with its object.
    triangles: Arc<Vec<(u32, Triangle)>>,
    /// Lights that lie on spheres, by object.
    lights_on_spheres: Arc<HashMap<u32, Vec<usize>>>,
}

/// What the primary spheres and triangles and those of the world are made from, where they are many.
#[derive(Debug, Clone, Default)]
pub struct OnDemandSources {
    pub(super) primary: Option<OnDemandShapes>,
    pub(super) world: Option<OnDemandShapes>,
}

/// One for each object of a scene: center and radius; of others nothing.
pub(super) type Balls = Arc<Vec<(DVec3, f64)>>;

/// The centers and radii of a scene's spheres.
pub(super) fn balls(scene: &Scene) -> Balls {
    let ball = |shape: &Shape| match *shape {
        Shape::Sphere { center, radius } => (center, radius),
        Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => (DVec3::ZERO, 0.0),
    };
    Arc::new(scene.objects.iter().map(|o| ball(&o.shape)).collect())
}

impl OnDemandShapes {
    /// For the spheres that are the objects of `order`, the lights that lie on some of them, and the triangles that are
    /// the objects of `triangles`.
    pub(super) fn new(
        scene: &Scene,
        view: ViewParameters,
        scale: i32,
        balls: &Balls,
        order: impl Iterator<Item = usize>,
        lights_on_spheres: HashMap<u32, Vec<usize>>,
        triangles: impl Iterator<Item = usize>,
    ) -> Self {
        let triangle = |object: usize| match scene.objects[object].shape {
            Shape::Triangle(triangle) => Some((object as u32, triangle)),
            Shape::Plane { .. } | Shape::Sphere { .. } | Shape::Quadric(_) => None,
        };
        Self {
            camera: scene.camera.clone(),
            view,
            lights: Arc::new(scene.lights.clone()),
            scale,
            balls: Arc::clone(balls),
            order: Arc::new(order.map(|object| object as u32).collect()),
            triangles: Arc::new(triangles.filter_map(triangle).collect()),
            lights_on_spheres: Arc::new(lights_on_spheres),
        }
    }

    /// How many spheres there are.
    pub(super) fn count(&self) -> usize {
        self.order.len()
    }

    /// The triangle of this number as primary rays see it.
    pub(super) fn primary_triangle<R: Real>(
        &self,
        camera: &Camera<R>,
        index: usize,
    ) -> Option<Plane<R>> {
        let (object, triangle) = self.triangles.get(index)?;
        Plane::of_triangle(&self.camera, camera, self.view, *object as usize, triangle)
    }

    /// The triangle of this number as rays from anywhere see it.
    pub(super) fn world_triangle<R: Real>(&self, index: usize) -> Option<WorldPlane<R>> {
        let (object, triangle) = self.triangles.get(index)?;
        let (view, lights) = (self.camera.viewpoint, &self.lights);
        Some(WorldPlane::of_triangle(
            view,
            lights,
            self.scale,
            *object as usize,
            triangle,
        ))
    }

    /// The sphere of this number as primary rays see it.
    pub(super) fn primary<R: Real>(&self, camera: &Camera<R>, index: usize) -> Option<Sphere<R>> {
        let object = *self.order.get(index)? as usize;
        let (center, radius) = self.balls[object];
        Sphere::new(self.camera.viewpoint, camera, object, center, radius)
    }

    /// The sphere of this number as rays from anywhere see it.
    pub(super) fn world<R: Real>(&self, index: usize) -> Option<WorldSphere<R>> {
        let object = *self.order.get(index)?;
        let (center, radius) = self.balls[object as usize];
        let lights_on_surface = self
            .lights_on_spheres
            .get(&object)
            .cloned()
            .unwrap_or_default();
        let (viewpoint, unit) = (
            V3::exact(self.camera.viewpoint),
            R::exact(two_to(-self.scale)),
        );
        Some(WorldSphere {
            object: object as usize,
            center: (V3::exact(center) - viewpoint) * unit,
            radius: R::exact(radius) * unit,
            lights_on_surface,
        })
    }
}

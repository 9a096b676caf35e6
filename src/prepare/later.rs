//! Spheres that are made ready one by one, when a ray comes near them: for number types whose numbers take memory.
//!
//! The spheres' tree and tiles, and all that is no number, is shared with a scene prepared before in another type.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::{Prepared, Sphere, World, world::WorldSphere};
use crate::real::rational::two_to;
use crate::real::{Real, V3};
use crate::scene::{Scene, Shape};

/// What many spheres are made from.
#[derive(Debug, Clone)]
pub struct Later {
    viewpoint: DVec3,
    scale: i32,
    /// One for each object: center and radius; of planes nothing.
    shapes: Arc<Vec<(DVec3, f64)>>,
    /// The objects that are spheres, in the order of the prepared ones.
    order: Arc<Vec<u32>>,
    /// Lights that lie on spheres, by object.
    levels: Arc<HashMap<u32, Vec<usize>>>,
}

/// What the primary spheres and those of the world are made from, where they are many.
#[derive(Debug, Clone, Default)]
pub struct Laters {
    pub(super) primary: Option<Later>,
    pub(super) world: Option<Later>,
}

impl Laters {
    /// For a scene that has been prepared in some number type.
    pub fn new<R: Real>(scene: &Scene, prepared: &Prepared<R>) -> Self {
        let world = prepared.world.as_ref();
        let world_tree = world.and_then(|world| world.bvh.as_ref());
        if prepared.tiles.is_none() && world_tree.is_none() {
            return Self::default();
        }
        let shape = |shape: &Shape| match *shape {
            Shape::Sphere { center, radius } => (center, radius),
            Shape::Plane { .. } => (DVec3::ZERO, 0.0),
        };
        let shapes = Arc::new(scene.objects.iter().map(|o| shape(&o.shape)).collect());
        let later = |order: Vec<u32>, levels| Later {
            viewpoint: scene.camera.viewpoint,
            scale: prepared.camera.scale,
            shapes: Arc::clone(&shapes),
            order: Arc::new(order),
            levels: Arc::new(levels),
        };
        let primary = prepared.tiles.as_ref().map(|_| {
            let order = prepared.spheres.iter().map(|s| s.object as u32);
            later(order.collect(), HashMap::new())
        });
        let world = world.filter(|world| world.bvh.is_some()).map(|world| {
            let order = world.spheres.iter().map(|s| s.object as u32);
            let lit = world.spheres.iter().filter(|s| !s.level.is_empty());
            let levels = lit.map(|s| (s.object as u32, s.level.clone()));
            later(order.collect(), levels.collect())
        });
        Self { primary, world }
    }
}

impl<R: Real> Prepared<R> {
    /// How many spheres a primary ray can hit.
    pub fn sphere_count(&self) -> usize {
        self.later
            .as_ref()
            .map_or(self.spheres.len(), |later| later.order.len())
    }

    /// A sphere that is not in `spheres`.
    pub fn make_sphere(&self, index: usize) -> Option<Sphere<R>> {
        let later = self.later.as_ref()?;
        let object = *later.order.get(index)? as usize;
        let (center, radius) = later.shapes[object];
        Sphere::new(later.viewpoint, &self.camera, object, center, radius)
    }
}

impl<R: Real> World<R> {
    /// How many spheres there are.
    pub fn sphere_count(&self) -> usize {
        self.later
            .as_ref()
            .map_or(self.spheres.len(), |later| later.order.len())
    }

    /// A sphere that is not in `spheres`; there is one for each place below [`sphere_count`](Self::sphere_count).
    pub fn make_sphere(&self, place: usize) -> Option<WorldSphere<R>> {
        let later = self.later.as_ref()?;
        let object = *later.order.get(place)?;
        let (center, radius) = later.shapes[object as usize];
        let unit = R::exact(two_to(-later.scale));
        Some(WorldSphere {
            object: object as usize,
            center: (V3::exact(center) - V3::exact(later.viewpoint)) * unit,
            radius: R::exact(radius) * unit,
            level: later.levels.get(&object).cloned().unwrap_or_default(),
        })
    }
}

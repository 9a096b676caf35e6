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
pub mod hidden;
pub mod index;
pub mod later;
pub mod material;
pub mod plane;
pub mod sphere;
pub mod surface;
pub mod tiles;
pub mod world;

use std::sync::Arc;

use later::{Later, Laters};
use tiles::Tiles;

use crate::real::Real;
use crate::scene::{Object, Scene, Shape, Texels};

pub use crate::settings::View;
pub use camera::Camera;
pub use material::{Light, Material};
pub use plane::Plane;
pub use sphere::Sphere;
pub use surface::Surface;
pub use world::World;

/// A scene made ready for tracing rays from its viewpoint, in the number type `R`.
#[derive(Debug, Clone)]
pub struct Prepared<R> {
    /// How a pixel becomes a ray.
    pub camera: Camera<R>,
    /// The planes that a primary ray can hit, in file order.
    pub planes: Vec<Plane<R>>,
    /// The spheres that a primary ray can hit, in file order; where they are in tiles, those that are seen.
    pub spheres: Vec<Sphere<R>>,
    /// Where on the screen they are, if there are many.
    pub tiles: Option<Arc<Tiles>>,
    /// What spheres are made from that are not in `spheres`.
    pub later: Option<Later>,
    /// One for each object of the scene: what it looks like.
    pub surfaces: Vec<Surface<R>>,
    /// One for each object of the scene: index of its material.
    pub materials: Arc<Vec<usize>>,
    /// One for each object of the scene: whether it is a plane, not a sphere.
    pub is_plane: Arc<Vec<bool>>,
    /// One for each object of the scene: the number of the surface that it is or is part of.
    pub groups: Arc<Vec<u32>>,
    /// One for each object of the scene: whether it is never hit. `planes` and `spheres` lack those, here and in `world`.
    pub hidden: Arc<Vec<bool>>,
    /// Whether some object lets light through.
    pub any_clear: bool,
    /// The materials of the scene.
    pub palette: Vec<Material<R>>,
    /// The textures of the scene.
    pub textures: Vec<Arc<Texels>>,
    /// What rays from elsewhere than the viewpoint need; None without lights, where there are no such rays.
    pub world: Option<World<R>>,
}

impl<R: Real> Prepared<R> {
    /// Prepares `scene`.
    pub fn new(scene: &Scene, view: impl Into<View>) -> Self {
        let view = view.into();
        let lit = !scene.lights.is_empty();
        // Of many spheres the tiles leave out equal ones.
        let equal_spheres = lit || scene.objects.len() < tiles::WORTHWHILE;
        let groups = Arc::new(world::groups(scene, equal_spheres));
        let hidden = hidden::hidden(scene, &groups, view.screen_tolerance);
        let mut prepared = Self::of(scene, view, true, &hidden);
        if scene.objects.len() >= tiles::WORTHWHILE {
            let (spheres, tiles) = Tiles::sorted(scene, &prepared.camera, view, &hidden);
            prepared.tiles = (!spheres.is_empty()).then(|| Arc::new(tiles));
            prepared.spheres = spheres;
        }
        let materials = scene.objects.iter().map(|object| object.material);
        let is_plane = scene
            .objects
            .iter()
            .map(|object| matches!(object.shape, Shape::Plane { .. }));
        prepared.materials = Arc::new(materials.collect());
        prepared.is_plane = Arc::new(is_plane.collect());
        let scale = prepared.camera.scale;
        prepared.world = lit.then(|| {
            World::new(
                scene,
                scale,
                view.screen_tolerance,
                Arc::clone(&groups),
                &hidden,
            )
        });
        prepared.groups = groups;
        prepared.hidden = Arc::new(hidden);
        prepared
    }

    /// Prepares a scene that has been prepared before in another number type, and shares with that what is no number. Where
    /// `laters` has spheres, they are made when they are asked for.
    pub fn again<S: Real>(
        scene: &Scene,
        view: View,
        before: &Prepared<S>,
        laters: &Laters,
    ) -> Self {
        let prepared = Self::of(scene, view, laters.primary.is_none(), &before.hidden);
        let world = before.world.as_ref().map(|world| {
            let scale = prepared.camera.scale;
            let later = laters.world.as_ref();
            let hidden = &before.hidden;
            World::again(scene, scale, view.screen_tolerance, world, hidden, later)
        });
        Self {
            tiles: before.tiles.clone(),
            later: laters.primary.clone(),
            materials: Arc::clone(&before.materials),
            is_plane: Arc::clone(&before.is_plane),
            groups: Arc::clone(&before.groups),
            hidden: Arc::clone(&before.hidden),
            world,
            ..prepared
        }
    }

    /// The scene without tiles, world and tables; spheres in file order if they are wanted and few.
    fn of(scene: &Scene, view: View, with_spheres: bool, hidden: &[bool]) -> Self {
        let camera = Camera::new(&scene.camera);
        let mut planes = Vec::new();
        let mut surfaces = Vec::with_capacity(scene.objects.len());
        for (index, object) in scene.objects.iter().enumerate() {
            surfaces.push(Surface::new(scene, object));
            let (
                false,
                &Shape::Plane {
                    normal,
                    point,
                    extent,
                },
            ) = (hidden[index], &object.shape)
            else {
                continue;
            };
            let camera = &scene.camera;
            planes.extend(Plane::new(
                camera,
                view,
                index,
                normal,
                point,
                extent.as_ref(),
            ));
        }
        let sphere = |(index, object): (usize, &Object)| match object.shape {
            Shape::Sphere { center, radius } if !hidden[index] => {
                Sphere::new(scene.camera.viewpoint, &camera, index, center, radius)
            }
            _ => None,
        };
        // Many are made with their tiles, or later.
        let few = with_spheres && scene.objects.len() < tiles::WORTHWHILE;
        let objects = scene.objects.iter().enumerate();
        let spheres = if few {
            objects.filter_map(sphere).collect()
        } else {
            Vec::new()
        };
        let any_clear = scene
            .objects
            .iter()
            .any(|object| scene.materials[object.material].transparency != 0.0);
        let palette = scene.materials.iter().map(Material::new).collect();
        let textures = scene
            .textures
            .iter()
            .map(|texture| Arc::clone(&texture.texels))
            .collect();
        Self {
            camera,
            planes,
            spheres,
            tiles: None,
            later: None,
            surfaces,
            materials: Arc::default(),
            is_plane: Arc::default(),
            groups: Arc::default(),
            hidden: Arc::default(),
            any_clear,
            palette,
            textures,
            world: None,
        }
    }
}

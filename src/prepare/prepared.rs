//! A scene made ready: the top of `prepare`, over all its parts.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::camera::Camera;
use super::groups::groups;
use super::hidden::hidden;
use super::material::Material;
use super::on_demand::{OnDemandShapes, OnDemandSources, balls};
use super::plane::Plane;
use super::quadric::Quadric;
use super::screen_grid::{self, ScreenGrid};
use super::sphere::Sphere;
use super::surface::Surface;
use super::world::World;
use crate::real::Real;
use crate::scene::{self, Scene, Shape, Texels};
use crate::settings::ViewParameters;

/// A scene made ready for tracing rays from its viewpoint, in the number type `R`.
#[derive(Debug, Clone)]
pub struct Prepared<R> {
    /// How a pixel becomes a ray.
    pub camera: Camera<R>,
    /// The planes that a primary ray can hit, in file order.
    pub planes: Vec<Plane<R>>,
    /// The spheres that a primary ray can hit, in file order; where they are in the screen's cells, those that are
    /// seen.
    pub spheres: Vec<Sphere<R>>,
    /// The quadrics that a ray can hit, in file order.
    pub quadrics: Arc<Vec<Quadric<R>>>,
    /// The triangles that are in the screen's cells; others are among the planes.
    pub triangles: Vec<Plane<R>>,
    /// Where on the screen spheres and triangles are, if there are many.
    pub screen_grid: Option<Arc<ScreenGrid>>,
    /// What spheres and triangles are made from that are not in `spheres` and `triangles`.
    pub on_demand: Option<OnDemandShapes>,
    /// One for each object of the scene: what it looks like.
    pub surfaces: Vec<Surface<R>>,
    /// One for each object of the scene: index of its material.
    pub materials: Arc<Vec<usize>>,
    /// One for each object of the scene: whether it is a plane, not a sphere.
    pub is_plane: Arc<Vec<bool>>,
    /// One for each object of the scene: the number of the surface that it is or is part of.
    pub groups: Arc<Vec<u32>>,
    /// One for each object of the scene: whether it is never hit. `planes` and `spheres` lack those, here and in
    /// `world`.
    pub hidden: Arc<Vec<bool>>,
    /// Whether some object lets light through.
    pub any_transparent: bool,
    /// The materials of the scene.
    pub palette: Vec<Material<R>>,
    /// The textures of the scene.
    pub textures: Vec<Arc<Texels>>,
    /// What rays from elsewhere than the viewpoint need; None without lights, where there are no such rays.
    pub world: Option<World<R>>,
}

impl<R: Real> Prepared<R> {
    /// Prepares `scene`.
    pub fn new(scene: &Scene, view: impl Into<ViewParameters>) -> Self {
        let view = view.into();
        let lit = !scene.lights.is_empty();
        // Of many spheres the screen grid leaves out equal ones.
        let equal_spheres = lit || scene.objects.len() < screen_grid::WORTHWHILE;
        let (groups, picture_planes) = groups(scene, equal_spheres);
        let groups = Arc::new(groups);
        let hidden = hidden(scene, &groups, view.screen_tolerance);
        let mut prepared = Self::of(scene, view, true, &hidden);
        if scene.objects.len() >= screen_grid::WORTHWHILE {
            let (spheres, triangles, screen_grid) =
                ScreenGrid::sorted(scene, &prepared.camera, view, &hidden);
            let any = !spheres.is_empty() || !triangles.is_empty();
            prepared.screen_grid = any.then(|| Arc::new(screen_grid));
            (prepared.spheres, prepared.triangles) = (spheres, triangles);
        }
        let scale = prepared.camera.scale;
        let tolerance = view.screen_tolerance;
        let quadrics = Quadric::all(scene, scale, tolerance, &hidden, &groups);
        prepared.quadrics = Arc::new(quadrics);
        let materials = scene.objects.par_iter().map(|object| object.material);
        let is_plane = scene.objects.par_iter().map(|object| match object.shape {
            Shape::Plane { .. } => true,
            Shape::Sphere { .. } | Shape::Quadric(_) => false,
            Shape::Triangle(_) => true,
        });
        prepared.materials = Arc::new(materials.collect());
        prepared.is_plane = Arc::new(is_plane.collect());
        let quadrics = &prepared.quadrics;
        prepared.world = lit.then(|| {
            let groups = (Arc::clone(&groups), Arc::new(picture_planes));
            World::new(scene, scale, tolerance, groups, &hidden, quadrics)
        });
        prepared.groups = groups;
        prepared.hidden = Arc::new(hidden);
        prepared
    }

    /// Prepares a scene that has been prepared before in another number type, and shares with that what is no number.
    /// Where `sources` has spheres, they are made when they are asked for.
    pub fn again<S: Real>(
        scene: &Scene,
        view: ViewParameters,
        before: &Prepared<S>,
        sources: &OnDemandSources,
    ) -> Self {
        let prepared = Self::of(scene, view, sources.primary.is_none(), &before.hidden);
        let scale = prepared.camera.scale;
        let (hidden, groups) = (&before.hidden, &before.groups);
        let quadrics = Quadric::all(scene, scale, view.screen_tolerance, hidden, groups);
        let quadrics = Arc::new(quadrics);
        let world = before.world.as_ref().map(|world| {
            let on_demand = sources.world.as_ref();
            World::again(
                scene,
                scale,
                view.screen_tolerance,
                world,
                hidden,
                on_demand,
                &quadrics,
            )
        });
        Self {
            quadrics,
            screen_grid: before.screen_grid.clone(),
            on_demand: sources.primary.clone(),
            materials: Arc::clone(&before.materials),
            is_plane: Arc::clone(&before.is_plane),
            groups: Arc::clone(&before.groups),
            hidden: Arc::clone(&before.hidden),
            world,
            ..prepared
        }
    }

    /// The scene without screen grid, world and tables; spheres in file order if they are wanted and few.
    fn of(scene: &Scene, view: ViewParameters, with_spheres: bool, hidden: &[bool]) -> Self {
        let camera = Camera::new(&scene.camera);
        let mut planes = Vec::new();
        // One after the other: an exact number belongs to the thread that made it.
        let surfaces = scene
            .objects
            .iter()
            .map(|object| Surface::new(scene, object));
        // Many spheres are made with their tiles, or later.
        let few = with_spheres && scene.objects.len() < screen_grid::WORTHWHILE;
        let mut spheres = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            match object.shape {
                _ if hidden[index] => {}
                Shape::Plane {
                    normal,
                    point,
                    extent,
                } => planes.extend(Plane::new(
                    &scene.camera,
                    view,
                    index,
                    normal,
                    point,
                    &extent,
                )),
                Shape::Sphere { center, radius } if few => spheres.extend(Sphere::new(
                    scene.camera.viewpoint,
                    &camera,
                    index,
                    center,
                    radius,
                )),
                Shape::Triangle(ref triangle) if few => planes.extend(Plane::of_triangle(
                    &scene.camera,
                    &camera,
                    view,
                    index,
                    triangle,
                )),
                Shape::Sphere { .. } | Shape::Triangle(_) | Shape::Quadric(_) => {}
            }
        }
        let is_transparent = |material: &scene::Material| material.transparency != 0.0;
        let any_transparent = scene.materials.iter().any(is_transparent)
            && scene
                .objects
                .par_iter()
                .any(|object| is_transparent(&scene.materials[object.material]));
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
            quadrics: Arc::default(),
            triangles: Vec::new(),
            screen_grid: None,
            on_demand: None,
            surfaces: surfaces.collect(),
            materials: Arc::default(),
            is_plane: Arc::default(),
            groups: Arc::default(),
            hidden: Arc::default(),
            any_transparent,
            palette,
            textures,
            world: None,
        }
    }

    /// What spheres and triangles are made from one by one in another number type, where they are many.
    pub fn sources(&self, scene: &Scene, view: ViewParameters) -> OnDemandSources {
        let world = self.world.as_ref().filter(|world| world.has_tree());
        if self.screen_grid.is_none() && world.is_none() {
            return OnDemandSources::default();
        }
        let (balls, scale) = (balls(scene), self.camera.scale);
        OnDemandSources {
            primary: self.screen_grid.as_ref().map(|_| {
                let order = self.spheres.iter().map(|s| s.object);
                let triangles = self.triangles.iter().map(|t| t.object);
                OnDemandShapes::new(scene, view, scale, &balls, order, HashMap::new(), triangles)
            }),
            world: world.map(|world| world.on_demand(scene, view, scale, &balls)),
        }
    }

    /// Whether an object that a ray can hit is a quadric.
    pub fn is_quadric(&self, object: usize) -> bool {
        let place = self.quadrics.binary_search_by_key(&object, |q| q.object);
        place.is_ok()
    }

    /// How many spheres a primary ray can hit.
    pub fn sphere_count(&self) -> usize {
        self.on_demand
            .as_ref()
            .map_or(self.spheres.len(), OnDemandShapes::count)
    }

    /// A sphere that is not in `spheres`.
    pub fn make_sphere(&self, index: usize) -> Option<Sphere<R>> {
        self.on_demand.as_ref()?.primary(&self.camera, index)
    }

    /// The triangle of this number; made now where it is not in `triangles`.
    pub fn triangle(&self, index: usize) -> Option<Cow<'_, Plane<R>>> {
        match self.triangles.get(index) {
            Some(triangle) => Some(Cow::Borrowed(triangle)),
            None => {
                let on_demand = self.on_demand.as_ref()?;
                let made = on_demand.primary_triangle(&self.camera, index)?;
                Some(Cow::Owned(made))
            }
        }
    }
}

//! The scene as rays from anywhere see it: shadow rays, mirror rays, rays that go through.
//!
//! Positions are from the viewpoint, in units of 2^scale, as everywhere after `prepare`. What holds for whole surfaces
//! is decided here, exactly: which of them coincide, and which lights lie on them.

use std::sync::Arc;

use super::brightest::Brightest;
use super::bvh::{self, Bvh};
use super::extent::Extent;
use super::material::Light;
use super::on_demand::{Balls, OnDemandSpheres};
use super::quadric::Quadric;
use super::world_plane::WorldPlane;
use super::world_sphere::{WorldSphere, lights_on_sphere};
use crate::real::rational::{power_of_two, ratio, two_to};
use crate::real::{Real, V3};
use crate::scene::{Scene, Shape};

/// Everything that a ray from anywhere can meet, and the lights.
#[derive(Debug, Clone)]
pub struct World<R> {
    /// All planes that a ray can hit, in file order.
    pub planes: Vec<WorldPlane<R>>,
    /// All spheres that a ray can hit: those of the tree in its order, then the others in file order.
    pub spheres: Vec<WorldSphere<R>>,
    /// All quadrics that a ray can hit, in file order.
    pub quadrics: Arc<Vec<Quadric<R>>>,
    /// The tree over the spheres, if they are many.
    pub bvh: Option<Arc<Bvh>>,
    /// What spheres are made from that are not in `spheres`.
    pub on_demand: Option<OnDemandSpheres>,
    /// The lights, in file order.
    pub lights: Vec<Light<R>>,
    /// For each object: the number of the surface that it is or is part of. Objects on the same plane share it, and
    /// equal spheres: from one of them the other is at t = 0, a miss.
    pub groups: Arc<Vec<u32>>,
    /// For each object that a ray can hit: its place in `planes`, `quadrics` or `spheres`.
    pub places: Arc<Vec<usize>>,
    /// The rule H.z ≤ τ for positions.
    pub highest: R,
    /// How much a ray can bring.
    pub brightest: Arc<Brightest>,
}

impl<R: Real> World<R> {
    /// Prepares a lit scene.
    pub(super) fn new(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        groups: Arc<Vec<u32>>,
        hidden: &[bool],
        quadrics: &Arc<Vec<Quadric<R>>>,
    ) -> Self {
        let places = Arc::default();
        let mut world = Self::of(scene, scale, screen_tolerance, groups, places, hidden, true);
        world.quadrics = Arc::clone(quadrics);
        world.bvh = bvh::build(&mut world.spheres).map(Arc::new);
        let mut places = vec![0; scene.objects.len()];
        for (place, plane) in world.planes.iter().enumerate() {
            places[plane.object] = place;
        }
        for (place, quadric) in world.quadrics.iter().enumerate() {
            places[quadric.object] = place;
        }
        for (place, sphere) in world.spheres.iter().enumerate() {
            places[sphere.object] = place;
        }
        world.places = Arc::new(places);
        world.brightest = Arc::new(Brightest::new(scene, &world, scale, hidden));
        world
    }

    /// Prepares a lit scene that has been prepared before in another number type; with `on_demand`, spheres one by one.
    pub(super) fn again<S: Real>(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        before: &World<S>,
        hidden: &[bool],
        on_demand: Option<&OnDemandSpheres>,
        quadrics: &Arc<Vec<Quadric<R>>>,
    ) -> Self {
        let (groups, places) = (Arc::clone(&before.groups), Arc::clone(&before.places));
        Self {
            quadrics: Arc::clone(quadrics),
            bvh: before.bvh.clone(),
            on_demand: on_demand.cloned(),
            brightest: Arc::clone(&before.brightest),
            ..Self::of(
                scene,
                scale,
                screen_tolerance,
                groups,
                places,
                hidden,
                on_demand.is_none(),
            )
        }
    }

    /// The world without its tree, spheres in file order if they are wanted.
    fn of(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        groups: Arc<Vec<u32>>,
        places: Arc<Vec<usize>>,
        hidden: &[bool],
        spheres: bool,
    ) -> Self {
        let view = V3::exact(scene.camera.viewpoint);
        let unit = R::exact(two_to(-scale));
        let mut world = Self {
            planes: Vec::new(),
            spheres: Vec::new(),
            quadrics: Arc::default(),
            bvh: None,
            on_demand: None,
            lights: scene
                .lights
                .iter()
                .map(|light| Light::new(view, scale, light))
                .collect(),
            groups,
            places,
            highest: R::ratio(
                &((ratio(screen_tolerance) - ratio(scene.camera.viewpoint.z))
                    / power_of_two(scale)),
            ),
            brightest: Arc::default(),
        };
        for (object, entity) in scene.objects.iter().enumerate() {
            match entity.shape {
                _ if hidden[object] => {}
                Shape::Plane {
                    normal,
                    point,
                    extent,
                } => {
                    let extent = Extent::new(&scene.camera, scale, normal, point, &extent);
                    let plane = WorldPlane::new(scene, scale, object, normal, point, extent);
                    world.planes.push(plane);
                }
                Shape::Sphere { center, radius } if spheres => world.spheres.push(WorldSphere {
                    object,
                    center: (V3::exact(center) - view) * unit,
                    radius: R::exact(radius) * unit,
                    lights_on_surface: lights_on_sphere(scene, center, radius),
                }),
                Shape::Triangle(ref triangle) => {
                    let plane = WorldPlane::of_triangle(scene, scale, object, triangle);
                    world.planes.push(plane);
                }
                Shape::Sphere { .. } | Shape::Quadric(_) => {}
            }
        }
        world
    }

    /// What the spheres are made from one by one in another number type.
    pub(super) fn on_demand(&self, scene: &Scene, scale: i32, balls: &Balls) -> OnDemandSpheres {
        let order = self.spheres.iter().map(|s| s.object);
        let lit = self
            .spheres
            .iter()
            .filter(|s| !s.lights_on_surface.is_empty());
        let levels = lit.map(|s| (s.object as u32, s.lights_on_surface.clone()));
        OnDemandSpheres::new(scene, scale, balls, order, levels.collect())
    }

    /// How many spheres there are.
    pub fn sphere_count(&self) -> usize {
        self.on_demand
            .as_ref()
            .map_or(self.spheres.len(), OnDemandSpheres::count)
    }

    /// A sphere that is not in `spheres`; there is one for each place below [`sphere_count`](Self::sphere_count).
    pub fn make_sphere(&self, place: usize) -> Option<WorldSphere<R>> {
        self.on_demand.as_ref()?.world(place)
    }
}

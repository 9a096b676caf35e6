//! The scene as rays from anywhere see it: shadow rays, mirror rays, rays that go through.
//!
//! Positions are from the viewpoint, in units of 2^scale, as everywhere after `prepare`. What holds for whole surfaces
//! is decided here, exactly: which of them coincide, and which lights lie on them.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::boxes::Boxes;
use super::brightest::Brightest;
use super::bvh::{self, Bvh};
use super::extent::Extent;
use super::material::Light;
use super::on_demand::{Balls, OnDemandShapes};
use super::quadric::Quadric;
use super::world_plane::WorldPlane;
use super::world_sphere::{WorldSphere, lights_on_sphere};
use crate::real::rational::{power_of_two, ratio, two_to};
use crate::real::{Real, V3};
use crate::scene::{Object, Scene, Shape, Triangle};
use crate::settings::ViewParameters;

/// Everything that a ray from anywhere can meet, and the lights.
#[derive(Debug, Clone)]
pub struct World<R> {
    /// All planes, rectangles and triangles that a ray can hit, in file order, but that those of the triangles' tree
    /// come last, in its order.
    pub planes: Vec<WorldPlane<R>>,
    /// All spheres that a ray can hit: those of the tree in its order, then the others in file order.
    pub spheres: Vec<WorldSphere<R>>,
    /// All quadrics that a ray can hit, in file order.
    pub quadrics: Arc<Vec<Quadric<R>>>,
    /// The tree over the spheres, if they are many.
    pub sphere_tree: Option<Arc<Bvh>>,
    /// The tree over the triangles, if they are many.
    pub triangle_tree: Option<Arc<Bvh>>,
    /// The objects that are in it, in its order.
    tree_objects: Arc<Vec<usize>>,
    /// Around what no tree holds; spheres count from the tree's on.
    pub boxes: Arc<Boxes>,
    /// What spheres and triangles are made from that are not in `spheres` and `planes`.
    pub on_demand: Option<OnDemandShapes>,
    /// The lights, in file order.
    pub lights: Vec<Light<R>>,
    /// For each object: the number of the surface that it is or is part of. Objects on the same plane share it, and
    /// equal spheres: from one of them the other is at t = 0, a miss.
    pub groups: Arc<Vec<u32>>,
    /// For each light: the number of the plane of its picture, on which it brings nothing; one that no object has, if
    /// it has none.
    pub picture_planes: Arc<Vec<u32>>,
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
        (groups, picture_planes): (Arc<Vec<u32>>, Arc<Vec<u32>>),
        hidden: &[bool],
        quadrics: &Arc<Vec<Quadric<R>>>,
    ) -> Self {
        let places = Arc::default();
        let (triangle_tree, tree_objects) = triangle_tree(scene, scale, hidden);
        let mut world = Self::of(
            scene,
            scale,
            screen_tolerance,
            groups,
            places,
            Arc::new(tree_objects),
            hidden,
            true,
        );
        world.triangle_tree = triangle_tree.map(Arc::new);
        world.quadrics = Arc::clone(quadrics);
        world.sphere_tree = bvh::build(&mut world.spheres).map(Arc::new);
        let loose = world.sphere_tree.as_ref().map_or(0, |tree| tree.len);
        world.boxes = Arc::new(Boxes::new(
            scene,
            scale,
            &world.planes[..world.loose_planes()],
            quadrics,
            &world.spheres[loose..],
        ));
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
        world.picture_planes = picture_planes;
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
        on_demand: Option<&OnDemandShapes>,
        quadrics: &Arc<Vec<Quadric<R>>>,
    ) -> Self {
        let (groups, places) = (Arc::clone(&before.groups), Arc::clone(&before.places));
        Self {
            quadrics: Arc::clone(quadrics),
            sphere_tree: before.sphere_tree.clone(),
            triangle_tree: before.triangle_tree.clone(),
            boxes: Arc::clone(&before.boxes),
            on_demand: on_demand.cloned(),
            brightest: Arc::clone(&before.brightest),
            picture_planes: Arc::clone(&before.picture_planes),
            ..Self::of(
                scene,
                scale,
                screen_tolerance,
                groups,
                places,
                Arc::clone(&before.tree_objects),
                hidden,
                on_demand.is_none(),
            )
        }
    }

    /// The world without its trees, spheres in file order; with `all` what is in trees too, or may be.
    #[expect(clippy::too_many_arguments, reason = "what the two above share")]
    fn of(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        groups: Arc<Vec<u32>>,
        places: Arc<Vec<usize>>,
        tree_objects: Arc<Vec<usize>>,
        hidden: &[bool],
        all: bool,
    ) -> Self {
        let view = V3::exact(scene.camera.viewpoint);
        let unit = R::exact(two_to(-scale));
        let mut world = Self {
            planes: Vec::new(),
            spheres: Vec::new(),
            quadrics: Arc::default(),
            sphere_tree: None,
            triangle_tree: None,
            boxes: Arc::default(),
            tree_objects: Arc::clone(&tree_objects),
            on_demand: None,
            lights: scene
                .lights
                .iter()
                .map(|light| Light::new(scene, scale, light))
                .collect(),
            groups,
            picture_planes: Arc::default(),
            places,
            highest: R::ratio(
                &((ratio(screen_tolerance) - ratio(scene.camera.viewpoint.z))
                    / power_of_two(scale)),
            ),
            brightest: Arc::default(),
        };
        let mut is_in_tree = vec![false; scene.objects.len()];
        for &object in tree_objects.iter() {
            is_in_tree[object] = true;
        }
        let lights = &scene.lights;
        for (object, entity) in scene.objects.iter().enumerate() {
            match entity.shape {
                _ if hidden[object] || is_in_tree[object] => {}
                Shape::Plane {
                    normal,
                    point,
                    extent,
                } => {
                    let extent = Extent::new(&scene.camera, scale, normal, point, &extent);
                    let plane = WorldPlane::new(scene, scale, object, normal, point, extent);
                    world.planes.push(plane);
                }
                Shape::Sphere { center, radius } if all => world.spheres.push(WorldSphere {
                    object,
                    center: (V3::exact(center) - view) * unit,
                    radius: R::exact(radius) * unit,
                    lights_on_surface: lights_on_sphere(scene, center, radius),
                }),
                Shape::Triangle(ref triangle) => {
                    let view = scene.camera.viewpoint;
                    let plane = WorldPlane::of_triangle(view, lights, scale, object, triangle);
                    world.planes.push(plane);
                }
                Shape::Sphere { .. } | Shape::Quadric(_) => {}
            }
        }
        if all {
            let made = tree_objects.par_iter().filter_map(|&object| {
                let triangle = triangle_of(&scene.objects[object])?;
                let view = scene.camera.viewpoint;
                Some(WorldPlane::of_triangle(
                    view, lights, scale, object, triangle,
                ))
            });
            world.planes.par_extend(made);
        }
        world
    }

    /// The plane, rectangle or triangle that this object is.
    pub fn plane_of(&self, object: usize) -> Option<Cow<'_, WorldPlane<R>>> {
        self.plane(*self.places.get(object)?)
    }

    /// The plane, rectangle or triangle of this place.
    pub fn plane(&self, place: usize) -> Option<Cow<'_, WorldPlane<R>>> {
        match self.planes.get(place) {
            Some(plane) => Some(Cow::Borrowed(plane)),
            None => {
                let index = place.checked_sub(self.planes.len())?;
                let made = self.on_demand.as_ref()?.world_triangle(index)?;
                Some(Cow::Owned(made))
            }
        }
    }

    /// How many of the planes are in no tree; those that are come after them.
    pub fn loose_planes(&self) -> usize {
        match &self.on_demand {
            // Those of the tree are not there.
            Some(_) => self.planes.len(),
            None => self.planes.len() - self.tree_objects.len(),
        }
    }

    /// Whether spheres or triangles are so many that they have a tree.
    pub fn has_tree(&self) -> bool {
        self.sphere_tree.is_some() || self.triangle_tree.is_some()
    }

    /// What spheres and triangles are made from one by one in another number type.
    pub(super) fn on_demand(
        &self,
        scene: &Scene,
        view: ViewParameters,
        scale: i32,
        balls: &Balls,
    ) -> OnDemandShapes {
        let order = self.spheres.iter().map(|s| s.object);
        let lit = self
            .spheres
            .iter()
            .filter(|s| !s.lights_on_surface.is_empty());
        let levels = lit.map(|s| (s.object as u32, s.lights_on_surface.clone()));
        let triangles = self.tree_objects.iter().copied();
        OnDemandShapes::new(
            scene,
            view,
            scale,
            balls,
            order,
            levels.collect(),
            triangles,
        )
    }

    /// How many spheres there are.
    pub fn sphere_count(&self) -> usize {
        self.on_demand
            .as_ref()
            .map_or(self.spheres.len(), OnDemandShapes::count)
    }

    /// A sphere that is not in `spheres`; there is one for each place below [`sphere_count`](Self::sphere_count).
    pub fn make_sphere(&self, place: usize) -> Option<WorldSphere<R>> {
        self.on_demand.as_ref()?.world(place)
    }
}

fn triangle_of(object: &Object) -> Option<&Triangle> {
    match &object.shape {
        Shape::Triangle(triangle) => Some(triangle),
        Shape::Plane { .. } | Shape::Sphere { .. } | Shape::Quadric(_) => None,
    }
}

/// The tree over the triangles that f32 can hold, if these are many, and the objects that are in it, in its order.
fn triangle_tree(scene: &Scene, scale: i32, hidden: &[bool]) -> (Option<Bvh>, Vec<usize>) {
    let visible = (0..scene.objects.len()).filter(|&object| !hidden[object]);
    let found = visible.filter_map(|object| Some((object, triangle_of(&scene.objects[object])?)));
    let (objects, triangles): (Vec<usize>, Vec<&Triangle>) = found.unzip();
    let (view, unit) = (scene.camera.viewpoint, two_to(-scale));
    let corner = |vertex: DVec3| (vertex - view) * unit;
    let corners: Vec<_> = triangles.iter().map(|t| t.vertices.map(corner)).collect();
    match bvh::over_triangles(&corners) {
        None => (None, Vec::new()),
        Some((tree, order)) => {
            let inside = order[..tree.len].iter().map(|&i| objects[i]).collect();
            (Some(tree), inside)
        }
    }
}

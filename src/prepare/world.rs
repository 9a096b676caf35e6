//! The scene as rays from anywhere see it: shadow rays, mirror rays, rays that go through.
//!
//! Positions are from the viewpoint, in units of 2^scale, as everywhere after `prepare`. What holds for whole surfaces is
//! decided here, exactly: which of them coincide, and which lights lie on them.

use std::collections::HashMap;
use std::sync::Arc;

use dashu_ratio::RBig;
use glam::DVec3;

use super::bvh::{self, Bvh};
use super::later::Later;
use super::{Light, plane::Extent};
use crate::real::rational::{Ratio, dot, is_zero, power_of_two, ratio, ratio3, sub, two_to};
use crate::real::{Real, V3};
use crate::scene::{Scene, Shape};

/// Everything that a ray from anywhere can meet, and the lights.
#[derive(Debug, Clone)]
pub struct World<R> {
    /// All planes that a ray can hit, in file order.
    pub planes: Vec<WorldPlane<R>>,
    /// All spheres that a ray can hit: those of the tree in its order, then the others in file order.
    pub spheres: Vec<WorldSphere<R>>,
    /// The tree over the spheres, if they are many.
    pub bvh: Option<Arc<Bvh>>,
    /// What spheres are made from that are not in `spheres`.
    pub later: Option<Later>,
    /// The lights, in file order.
    pub lights: Vec<Light<R>>,
    /// For each object: the number of the surface that it is or is part of. Objects on the same plane share it, and
    /// equal spheres: from one of them the other is at t = 0, a miss.
    pub groups: Arc<Vec<u32>>,
    /// For each object that a ray can hit: its place in `planes` or `spheres`.
    pub places: Arc<Vec<usize>>,
    /// The rule H.z ≤ τ for positions.
    pub highest: R,
}

/// A plane or a rectangle of one.
#[derive(Debug, Clone)]
pub struct WorldPlane<R> {
    /// Index of the object.
    pub object: usize,
    /// Unit normal.
    pub normal: V3<R>,
    /// normal · P for the points P of the plane.
    pub offset: R,
    /// The normal divided by its largest component: rational.
    pub direction: V3<R>,
    /// direction · P for the points P of the plane.
    pub constant: R,
    /// What turns a direction into its mirror image, by rows: I − 2·N·Nᵀ/(N·N), which is rational. Taken as a whole it
    /// does not let errors grow, as D − 2(D·N)N would: three times at each mirror.
    pub mirror: [V3<R>; 3],
    /// If the plane is perpendicular to an axis: which, and the coordinate that all its points share.
    pub own: Option<(usize, R)>,
    /// Its rectangle, if it has one.
    pub extent: Option<Extent<R>>,
    /// Lights that lie in the plane exactly, ascending.
    pub level: Vec<usize>,
}

/// A sphere.
#[derive(Debug, Clone)]
pub struct WorldSphere<R> {
    /// Index of the object.
    pub object: usize,
    /// Its center.
    pub center: V3<R>,
    /// Its radius.
    pub radius: R,
    /// Lights that lie on the sphere exactly, ascending.
    pub level: Vec<usize>,
}

impl<R: Real> World<R> {
    /// Prepares a lit scene.
    pub(super) fn new(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        groups: Arc<Vec<u32>>,
        hidden: &[bool],
    ) -> Self {
        let places = Arc::default();
        let mut world = Self::of(scene, scale, screen_tolerance, groups, places, hidden, true);
        world.bvh = bvh::build(&mut world.spheres).map(Arc::new);
        let mut places = vec![0; scene.objects.len()];
        for (place, plane) in world.planes.iter().enumerate() {
            places[plane.object] = place;
        }
        for (place, sphere) in world.spheres.iter().enumerate() {
            places[sphere.object] = place;
        }
        world.places = Arc::new(places);
        world
    }

    /// Prepares a lit scene that has been prepared before in another number type; with `later`, spheres one by one.
    pub(super) fn again<S: Real>(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        before: &World<S>,
        hidden: &[bool],
        later: Option<&Later>,
    ) -> Self {
        let (groups, places) = (Arc::clone(&before.groups), Arc::clone(&before.places));
        Self {
            bvh: before.bvh.clone(),
            later: later.cloned(),
            ..Self::of(
                scene,
                scale,
                screen_tolerance,
                groups,
                places,
                hidden,
                later.is_none(),
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
            bvh: None,
            later: None,
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
        };
        for (object, entity) in scene.objects.iter().enumerate() {
            match entity.shape {
                _ if hidden[object] => {}
                Shape::Plane {
                    normal,
                    point,
                    extent,
                } => {
                    let extent =
                        extent.map(|e| Extent::new(&scene.camera, scale, normal, point, &e));
                    world
                        .planes
                        .push(plane(scene, scale, object, normal, point, extent));
                }
                Shape::Sphere { center, radius } if spheres => world.spheres.push(WorldSphere {
                    object,
                    center: (V3::exact(center) - view) * unit,
                    radius: R::exact(radius) * unit,
                    level: lights_on_sphere(scene, center, radius),
                }),
                Shape::Sphere { .. } => {}
            }
        }
        world
    }
}

fn plane<R: Real>(
    scene: &Scene,
    scale: i32,
    object: usize,
    normal: DVec3,
    point: DVec3,
    extent: Option<Extent<R>>,
) -> WorldPlane<R> {
    let n = ratio3(normal);
    let v = ratio3(scene.camera.viewpoint);
    let q = ratio3(point);
    let unit = power_of_two(scale);
    let from_viewpoint = sub(&q, &v);
    // The direction alone counts: by its largest component a normal of any length stays within range.
    let direction: V3<R> = shortened(normal);
    let length = direction.dot(direction).sqrt();
    let largest = ratio(normal.abs().max_element());
    let offset = R::ratio(&(dot(&n, &from_viewpoint) / &largest / &unit));
    let axis = (0..3).find(|&axis| (0..3).all(|i| i == axis || is_zero(&n[i])));
    let level = (0..scene.lights.len()).filter(|&i| {
        let light = scene.lights[i].location;
        // Most lights are far from most planes, and f64 is enough to say so.
        let rough = normal.dot(light - point).abs();
        let size = normal.abs().dot(light.abs() + point.abs());
        (rough <= 1e-9 * size || !rough.is_normal()) && is_zero(&dot(&n, &sub(&ratio3(light), &q)))
    });
    WorldPlane {
        object,
        normal: V3::new(
            direction.x / length,
            direction.y / length,
            direction.z / length,
        ),
        offset: offset / length,
        direction,
        constant: offset,
        mirror: mirror(&n),
        own: axis.map(|axis| (axis, R::ratio(&(&from_viewpoint[axis] / &unit)))),
        extent,
        level: level.collect(),
    }
}

/// The rows of I − 2·N·Nᵀ/(N·N).
fn mirror<R: Real>(n: &[Ratio; 3]) -> [V3<R>; 3] {
    let nn = dot(n, n);
    [0, 1, 2].map(|i| {
        let [x, y, z] = [0, 1, 2].map(|j| {
            let own = ratio(if i == j { 1.0 } else { 0.0 });
            R::ratio(&(own - ratio(2.0) * &n[i] * &n[j] / &nn))
        });
        V3::new(x, y, z)
    })
}

/// A normal divided by its largest component, in absolute value.
pub fn shortened<R: Real>(normal: DVec3) -> V3<R> {
    let largest = ratio(normal.abs().max_element());
    let [x, y, z] = ratio3(normal).map(|c| R::ratio(&(c / &largest)));
    V3::new(x, y, z)
}

fn lights_on_sphere(scene: &Scene, center: DVec3, radius: f64) -> Vec<usize> {
    let on = |light: &crate::scene::Light| {
        let rough = (light.location - center).length();
        (rough - radius).abs() <= 1e-9 * (radius + light.location.length() + center.length()) && {
            let d = sub(&ratio3(light.location), &ratio3(center));
            let r = ratio(radius);
            dot(&d, &d) == &r * &r
        }
    };
    (0..scene.lights.len())
        .filter(|&i| on(&scene.lights[i]))
        .collect()
}

/// For each object the number of the surface that it is or is part of: the same for the same set of points. Where equal
/// spheres need not be told, spheres have none in common.
pub fn groups(scene: &Scene, equal_spheres: bool) -> Vec<u32> {
    let mut groups = Groups::default();
    let of = |object: &crate::scene::Object| match object.shape {
        Shape::Sphere { .. } if !equal_spheres => groups.one_more(),
        _ => groups.of(&object.shape),
    };
    scene.objects.iter().map(of).collect()
}

/// Numbers for surfaces, the same for the same point set.
#[derive(Debug, Default)]
struct Groups {
    planes: HashMap<[RBig; 4], u32>,
    spheres: HashMap<[u64; 4], u32>,
    count: u32,
}

impl Groups {
    fn of(&mut self, shape: &Shape) -> u32 {
        let new = self.count;
        let group = match *shape {
            Shape::Plane { normal, point, .. } => {
                let n = ratio3(normal);
                // N·X = N·Q with the first component of N that is not 0 scaled to 1.
                let lead = n
                    .iter()
                    .find(|c| !is_zero(c))
                    .cloned()
                    .unwrap_or(Ratio::ONE);
                let offset = dot(&n, &ratio3(point)) / &lead;
                let [x, y, z] = n.map(|c| (c / &lead).canonicalize());
                *self
                    .planes
                    .entry([x, y, z, offset.canonicalize()])
                    .or_insert(new)
            }
            Shape::Sphere { center, radius } => {
                // Adding 0 makes −0 and 0 the same.
                let key =
                    [center.x + 0.0, center.y + 0.0, center.z + 0.0, radius].map(f64::to_bits);
                *self.spheres.entry(key).or_insert(new)
            }
        };
        if group == new {
            self.one_more();
        }
        group
    }

    /// The number of a surface that nothing shares.
    fn one_more(&mut self) -> u32 {
        self.count += 1;
        self.count - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: [f64; 3], point: [f64; 3]) -> Shape {
        Shape::Plane {
            normal: normal.into(),
            point: point.into(),
            extent: None,
        }
    }

    fn same_group(a: &Shape, b: &Shape) -> bool {
        let mut groups = Groups::default();
        groups.of(a) == groups.of(b)
    }

    #[test]
    fn coincident_surfaces_share_a_group() {
        let wall = plane([3.0, 0.0, 1.0], [0.0, 0.0, 0.0]);
        assert!(same_group(
            &wall,
            &plane([-6.0, 0.0, -2.0], [1.0, 7.0, -3.0])
        ));
        assert!(!same_group(
            &wall,
            &plane([-6.0, 0.0, -2.0], [1.0, 7.0, -3.0 - 1e-15])
        ));
        assert!(!same_group(
            &wall,
            &plane([3.0, 1e-300, 1.0], [0.0, 0.0, 0.0])
        ));
        let ball = |z: f64| Shape::Sphere {
            center: DVec3::new(0.0, 1.0, z),
            radius: 2.0,
        };
        assert!(same_group(&ball(0.0), &ball(-0.0)));
        assert!(!same_group(&ball(0.0), &ball(f64::MIN_POSITIVE)));
    }
}

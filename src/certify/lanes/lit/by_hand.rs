//! What the text calls that is written by hand: what rays from anywhere meet, over all objects.

use fearless_simd::Simd;

pub(super) use super::primary::find_closest_object;
use super::records::{WorldPlane, WorldSphere};
use super::text::constants::{NOTHING, T_MAX};
use super::text::{
    self, Intersection, Range, SecondaryHit, SecondaryRay, Shadow, State, closest_approach,
    nearer_secondary, occludes, plane_hits_from, quadric_hits_from, sphere_hits_from,
};
use super::walk::Walk;
use super::{Number, Scene};
#[cfg(test)]
use crate::certify::lanes::tests::{self, Fault};
use crate::certify::lanes::vector::{Lanewise as _, M, U, Vec3};

/// The first object that each ray meets in range.
pub(super) fn closest_hit<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    ray: SecondaryRay<S>,
    range: Range<S>,
    _weight: u32,
) -> SecondaryHit<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut closest = SecondaryHit::zero(scene.simd);
            closest.object = scene.u32(NOTHING);
            closest.group = scene.u32(NOTHING);
            closest.t = scene.real(T_MAX);
            closest.low = closest.t;
            closest.rival = closest.t;
            let lit = LooseAndTrees::new(scene);
            for plane in lit.planes {
                closer_plane(scene, plane, ray, range, &mut closest);
            }
            for quadric in scene.quadrics {
                let hits = quadric_hits_from(scene, on, quadric, ray, range);
                let numbers = [quadric.object, quadric.group];
                takes(scene, &mut closest, hits, numbers, range);
            }
            for sphere in lit.spheres {
                if all_miss(scene, on, sphere, ray) {
                    continue;
                }
                closer_sphere(scene, sphere, ray, range, &mut closest);
            }
            for tree in lit.trees {
                let mut walk = Walk::new(scene, tree, ray);
                // What is truly nearer than the closest is entered before it.
                while let Some(leaf) = walk.next(
                    scene,
                    on,
                    (closest.t + closest.error).min(range.limit + range.limit_error),
                ) {
                    for i in leaf {
                        if tree.spheres {
                            closer_sphere(scene, &scene.world_spheres[i], ray, range, &mut closest);
                        } else {
                            closer_plane(scene, &scene.world_planes[i], ray, range, &mut closest);
                        }
                    }
                }
            }
            closest
        },
    )
}

/// Takes what is met of an object if it is nearer: with the object's number, and its surface's.
#[inline(always)]
fn takes<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    closest: &mut SecondaryHit<S>,
    hits: Intersection<S>,
    numbers: [u32; 2],
    range: Range<S>,
) {
    let [object, group] = numbers.map(|number| scene.u32(number));
    nearer_secondary(scene, closest, hits, object, group, range);
}

#[inline(always)]
fn closer_plane<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    plane: &WorldPlane,
    ray: SecondaryRay<S>,
    range: Range<S>,
    closest: &mut SecondaryHit<S>,
) {
    let hits = plane_hits_from(scene, plane, ray, range);
    takes(scene, closest, hits, [plane.object, plane.group], range);
}

#[inline(always)]
fn closer_sphere<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: &WorldSphere,
    ray: SecondaryRay<S>,
    range: Range<S>,
    closest: &mut SecondaryHit<S>,
) {
    let hits = sphere_hits_from(scene, sphere, ray, range);
    takes(scene, closest, hits, [sphere.object, sphere.group], range);
}

/// Whether all rays pass a sphere so far away that its own test would say so: r² − apart is then below −disc_error,
/// with all roundings, as apart is more than (r + 1.05·off)²·(1 + 2⁻¹⁶) (docs/NUMERICS.md).
#[inline(always)]
fn all_miss<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    sphere: &WorldSphere,
    ray: SecondaryRay<S>,
) -> bool {
    let [radius, size] = [sphere.radius, sphere.size].map(|number| scene.real(number));
    let approach = closest_approach(scene, scene.reals(sphere.center), radius, size, ray);
    let reach = sphere.radius + MISS_SLOPE * approach.off;
    !(on & !approach.apart.gt(MISS_GROWTH * reach * reach)).any()
}

/// See [`all_miss`].
const MISS_SLOPE: Number = 1.05;
/// See [`all_miss`]: 1 + 2⁻¹⁶.
const MISS_GROWTH: Number = 1.0 + 1.0 / 65_536.0;

/// Nothing, perhaps something, or something stands in range: 0, 1, 2.
fn any_hit<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    ray: SecondaryRay<S>,
    range: Range<S>,
) -> U<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut found = scene.u32(0);
            let lit = LooseAndTrees::new(scene);
            for sphere in lit.spheres {
                if all_miss(scene, on, sphere, ray) {
                    continue;
                }
                let hits = sphere_hits_from(scene, sphere, ray, range);
                found = found.max(occludes(scene, hits, range));
            }
            let open = on & found.ne(scene.u32(2));
            #[cfg(test)]
            let open = tests::inverted(Fault::ShadowInverted, open);
            if !open.any() {
                return found;
            }
            for plane in lit.planes {
                let hits = plane_hits_from(scene, plane, ray, range);
                found = found.max(occludes(scene, hits, range));
            }
            for quadric in scene.quadrics {
                let hits = quadric_hits_from(scene, on, quadric, ray, range);
                found = found.max(occludes(scene, hits, range));
            }
            for tree in lit.trees {
                let mut walk = Walk::new(scene, tree, ray);
                loop {
                    let open = on & found.ne(scene.u32(2));
                    let Some(leaf) = walk.next(scene, open, range.limit + range.limit_error) else {
                        break;
                    };
                    for i in leaf {
                        let hits = if tree.spheres {
                            sphere_hits_from(scene, &scene.world_spheres[i], ray, range)
                        } else {
                            plane_hits_from(scene, &scene.world_planes[i], ray, range)
                        };
                        found = found.max(occludes(scene, hits, range));
                    }
                }
            }
            found
        },
    )
}

/// What of a light reaches a point: where nothing lets light through, it is enough to find anything that stands there.
#[inline(always)]
pub(super) fn shadow<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    ray: SecondaryRay<S>,
    range: Range<S>,
) -> Shadow<S> {
    if scene.transparent {
        return text::shadow(scene, state, on, ray, range);
    }
    let found = any_hit(scene, on, ray, range);
    let mut shadow = Shadow::zero(scene.simd);
    shadow.transmittance = Vec3::splat(scene.real(1.0));
    shadow.open = found.ne(scene.u32(2));
    shadow.sure = found.ne(scene.u32(1));
    shadow
}

/// A tree over objects.
#[derive(Clone, Copy)]
pub(super) struct Tree {
    /// Its root among the nodes.
    pub(super) root: u32,
    /// Whether they are spheres, not triangles.
    pub(super) spheres: bool,
}

/// The objects that are asked one by one, and the trees over the others.
struct LooseAndTrees<'a, T> {
    planes: &'a [WorldPlane],
    spheres: &'a [WorldSphere],
    trees: T,
}

impl<'a> LooseAndTrees<'a, std::iter::Flatten<std::array::IntoIter<Option<Tree>, 2>>> {
    #[inline(always)]
    fn new<S: Simd>(scene: &Scene<'a, S>) -> Self {
        let (loose, in_tree) = match &scene.packed.lit {
            Some(lit) => (lit.loose_planes, lit.in_tree),
            None => (0, 0),
        };
        let spheres = (in_tree > 0).then_some(Tree {
            root: 0,
            spheres: true,
        });
        let triangles = scene.packed.triangle_root.map(|root| Tree {
            root: root as u32,
            spheres: false,
        });
        Self {
            planes: &scene.world_planes[..loose],
            spheres: &scene.world_spheres[in_tree..],
            trees: [spheres, triangles].into_iter().flatten(),
        }
    }
}

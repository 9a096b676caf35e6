//! The closest hits of primary rays: the loops over objects.

use fearless_simd::Simd;

use super::records::Sphere;
use super::text::{
    Hit, PrimaryIntersection, Ray, from_pixel, nearer, plane_hits, polygon_hits, quadric_hits,
    sphere_disc, sphere_hits,
};
use super::{Number, Scene};
#[cfg(test)]
use crate::certify::lanes::tests::{self, Fault};
use crate::certify::lanes::vector::{Lanewise as _, M, Vec2};

/// The closest object that each ray hits.
#[inline(always)]
pub(super) fn find_closest_object<'a, S: Simd>(scene: &'a Scene<'a, S>, ray: Ray<S>) -> Hit<S> {
    let mut closest = Hit::zero(scene.simd);
    let loose = scene.packed.loose_polygons();
    for polygon in &scene.polygons[..loose] {
        let hits = polygon_hits(scene, polygon, ray);
        takes(
            scene,
            &mut closest,
            hits,
            [polygon.object, 0, polygon.group],
        );
    }
    for plane in scene.planes {
        let hits = plane_hits(scene, plane, ray);
        takes(scene, &mut closest, hits, [plane.object, 0, plane.group]);
    }
    for quadric in scene.quadrics {
        let hits = quadric_hits(scene, scene.mask(true), quadric, ray);
        takes(scene, &mut closest, hits, [quadric.object, 0, 0]);
    }
    match &scene.packed.screen_grid {
        None => {
            for (i, sphere) in (0..).zip(scene.spheres) {
                if let Some(hits) = sphere_if_near(scene, sphere, ray) {
                    takes(scene, &mut closest, hits, [sphere.object, i, 0]);
                }
            }
        }
        Some(_) => in_cells(scene, ray, &mut closest),
    }
    closest
}

/// Takes what is met of an object if it is nearer: with the object's number, that among its kind, and its surface's.
#[inline(always)]
fn takes<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    closest: &mut Hit<S>,
    hits: PrimaryIntersection<S>,
    numbers: [u32; 3],
) {
    let [object, index, group] = numbers.map(|number| scene.u32(number));
    nearer(scene, closest, hits, object, index, group);
}

/// What the rays meet of a sphere, unless all miss it.
#[inline(always)]
fn sphere_if_near<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: &Sphere,
    ray: Ray<S>,
) -> Option<PrimaryIntersection<S>> {
    let at = from_pixel(scene, ray, scene.vec2_i32(sphere.anchor));
    let disc = sphere_disc(scene, scene.same(sphere), at);
    #[cfg(test)]
    if tests::is_wrong(Fault::MissedByOne) && !disc.gt(scene.real(-sphere.disc_error)).all() {
        return None;
    }
    if disc.gt(scene.real(-sphere.disc_error)).any() {
        Some(sphere_hits(scene, sphere, ray))
    } else {
        None
    }
}

/// The objects in the cells of the screen that the lanes' pixels lie in, one cell after the other: in each the nearest
/// first, until what is left must lie behind what its rays have hit.
#[inline(always)]
fn in_cells<'a, S: Simd>(scene: &'a Scene<'a, S>, ray: Ray<S>, closest: &mut Hit<S>) {
    let Some(grid) = &scene.packed.screen_grid else {
        return;
    };
    let Vec2 { x, y } = ray.pixel;
    let sides = grid.sides.map(|side| side as i32);
    let mut left = scene.mask(true).bits();
    while left != 0 {
        let lane = left.trailing_zeros() as usize;
        let first = [x.as_slice()[lane], y.as_slice()[lane]];
        let [column, row] = [0, 1].map(|i| first[i] / sides[i] * sides[i]);
        let inside = x.ge(scene.i32(column))
            & x.lt(scene.i32(column + sides[0]))
            & y.ge(scene.i32(row))
            & y.lt(scene.i32(row + sides[1]));
        left &= !(inside.bits() | 1 << lane);
        for &place in grid.at([f64::from(column), f64::from(row)]) {
            let place = place as usize;
            let nearest = scene.real(Number::from(grid.max_inverse[place]));
            let behind = (closest.inverse - closest.error).gt(nearest);
            if !(inside & !behind).any() {
                break;
            }
            match scene.spheres.get(place) {
                Some(sphere) => {
                    if let Some(hits) = sphere_if_near(scene, sphere, ray) {
                        let numbers = [sphere.object, place as u32, 0];
                        takes(scene, closest, only(hits, inside), numbers);
                    }
                }
                None => {
                    let polygon = scene.packed.grid_polygon(place);
                    let hits = polygon_hits(scene, polygon, ray);
                    takes(scene, closest, only(hits, inside), [polygon.object, 0, 0]);
                }
            }
        }
    }
}

/// What is met, for the rays of a cell alone.
#[inline(always)]
fn only<S: Simd>(hits: PrimaryIntersection<S>, inside: M<S>) -> PrimaryIntersection<S> {
    #[cfg(test)]
    let inside = tests::inverted(Fault::CellInverted, inside);
    PrimaryIntersection {
        hit: hits.hit & inside,
        possible: hits.possible & inside,
        ..hits
    }
}

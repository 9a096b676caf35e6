//! The closest hit of a primary ray, and the colour that a ray brings. Referee of `shaders/closest.wgsl`, `point.wgsl`
//! and `trace.wgsl`.

use super::camera::{Ray, camera_getdir, inverse_distance};
use super::light::{Lit, light_term, normal_at};
use super::plane::{on_plane, plane_hits};
use super::sphere::{sphere_from_center, sphere_hits};
use super::surface::{Point, getamb};
use super::world::{Range, closest_hit};
use crate::prepare::{Prepared, Surface, World};
use crate::real::rational::two_to;
use crate::real::{Bounded, Real, Undecided, V3};

pub use super::observer::{Branch, RayKind, TraceObserver, Unmet, Unobserved};
pub use crate::settings::Limits;

/// A hit of a primary ray.
#[derive(Debug, Clone, Copy)]
pub struct Hit<R> {
    /// 1/s: the larger, the nearer.
    pub inverse: R,
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the prepared plane or sphere.
    pub index: usize,
}

/// Why a ray's colour is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The number type is too coarse.
    Undecided,
    /// The sample needs more rays than allowed.
    TooManyRays,
}

impl From<Undecided> for Fault {
    fn from(_: Undecided) -> Self {
        Self::Undecided
    }
}

/// The closest object that a primary ray hits; of equally near ones the first in the file.
#[inline]
pub fn find_closest_object<R: Real>(
    scene: &Prepared<R>,
    ray: &Ray<R>,
) -> Result<Option<Hit<R>>, Undecided> {
    let mut closest: Option<Hit<R>> = None;
    for (index, plane) in scene.planes.iter().enumerate() {
        let mark = R::mark();
        let hit = plane_hits(plane, ray)?.map(|inverse| Hit {
            inverse,
            object: plane.object,
            index,
        });
        if !takes(&mut closest, hit)? {
            R::release(mark);
        }
    }
    let sphere = |closest: &mut Option<Hit<R>>, index: usize| -> Result<(), Undecided> {
        let mark = R::mark();
        let made;
        let sphere = match scene.spheres.get(index) {
            Some(sphere) => sphere,
            None => {
                made = scene.make_sphere(index);
                match &made {
                    Some(sphere) => sphere,
                    None => return Err(Undecided),
                }
            }
        };
        let hit = sphere_hits(&scene.camera, sphere, ray)?.map(|inverse| Hit {
            inverse,
            object: sphere.object,
            index,
        });
        if !takes(closest, hit)? {
            R::release(mark);
        }
        Ok(())
    };
    let Some(screen_grid) = &scene.screen_grid else {
        for index in 0..scene.sphere_count() {
            sphere(&mut closest, index)?;
        }
        return Ok(closest);
    };
    for &index in screen_grid.at(ray.pixel) {
        let index = index as usize;
        // The nearest come first: the others lie behind what is hit.
        if closest
            .as_ref()
            .is_some_and(|hit| f64::from(screen_grid.max_inverse[index]) < at_least(hit.inverse))
        {
            break;
        }
        sphere(&mut closest, index)?;
    }
    Ok(closest)
}

/// The least f64 that a number may be.
fn at_least<R: Real>(number: R) -> f64 {
    let Bounded { value, error } = number.enclosure();
    value - (error + value.abs() * f64::EPSILON) * Bounded::GROW
}

/// Takes `hit`, if there is one, where it is nearer than `closest`, or as near and first in the file. Whether it did.
#[inline]
fn takes<R: Real>(closest: &mut Option<Hit<R>>, hit: Option<Hit<R>>) -> Result<bool, Undecided> {
    let Some(hit) = hit else {
        return Ok(false);
    };
    let takes = match closest {
        None => true,
        Some(best) => {
            let difference = hit.inverse - best.inverse;
            difference.positive()? || (hit.object < best.object && difference.non_negative()?)
        }
    };
    if takes {
        *closest = Some(hit);
    }
    Ok(takes)
}

/// Where a primary ray hit.
pub fn locate<R: Real>(scene: &Prepared<R>, ray: &Ray<R>, hit: &Hit<R>) -> Point<R> {
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let object = hit.object;
    if scene.world.is_none() && matches!(scene.surfaces[object], Surface::Plain) {
        // Neither the surface nor a light asks where the hit is.
        return Point {
            object,
            position: zero,
            from_center: zero,
        };
    }
    let mut position = ray.w * (R::exact(1.0) / hit.inverse);
    if !scene.is_plane[object] {
        let sphere = scene.spheres.get(hit.index).copied();
        let sphere = sphere.or_else(|| scene.make_sphere(hit.index));
        return Point {
            object,
            position,
            from_center: sphere.map_or(zero, |sphere| {
                sphere_from_center(&scene.camera, &sphere, ray, hit.inverse)
            }),
        };
    }
    if let Some(world) = &scene.world {
        position = on_plane(&world.planes[world.places[object]], position);
    }
    Point {
        object,
        position,
        from_center: zero,
    }
}

/// What a ray found, and the colour it brings, (r, g, b) with 1 as bright as a byte goes.
#[derive(Debug, Clone, Copy)]
pub struct Traced<R> {
    /// The ray.
    pub ray: Ray<R>,
    /// The closest hit, if any.
    pub hit: Option<Hit<R>>,
    /// Ambient reflectivity at the hit; zero without.
    pub ambient: V3<R>,
    /// The colour.
    pub color: V3<R>,
}

/// Traces the ray through pixel (x, y), counted from the bottom left, with fractions between pixels.
pub fn ray_trace<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    x: f64,
    y: f64,
    observer: &mut impl TraceObserver<R>,
) -> Result<Traced<R>, Fault> {
    let ray = camera_getdir(&scene.camera, x, y);
    let zero = V3::new(R::zero(), R::zero(), R::zero());
    let hit = find_closest_object(scene, &ray)?;
    let Some(hit) = hit else {
        return Ok(Traced {
            ray,
            hit,
            ambient: zero,
            color: zero,
        });
    };
    let point = locate(scene, &ray, &hit);
    let ambient = getamb(scene, &point)?;
    let color = match &scene.world {
        // Without lights the notes' ambient tracer is all there is.
        None => ambient * inverse_distance(&scene.camera, &ray, hit.inverse),
        Some(world) => {
            let length = ray.w2.sqrt();
            let one = R::exact(1.0);
            let first = Branch {
                base: zero,
                dir: ray.w * (one / length),
                total: R::zero(),
                last: None,
                weight: V3::new(one, one, one),
                counts: [true; 3],
                parent: 0,
                kind: RayKind::Primary,
            };
            let mut tree = Tree {
                scene,
                world,
                waiting: Vec::new(),
                rays: 1,
                color: zero,
            };
            tree.shade(0, &first, length / hit.inverse, &point, observer)?;
            tree.grow(limits, observer)?;
            tree.color
        }
    };
    Ok(Traced {
        ray,
        hit: Some(hit),
        ambient,
        color,
    })
}

/// The rays of a sample: those that wait, and what the others brought.
struct Tree<'a, R> {
    scene: &'a Prepared<R>,
    world: &'a World<R>,
    waiting: Vec<Branch<R>>,
    rays: u32,
    color: V3<R>,
}

impl<R: Real> Tree<'_, R> {
    /// Follows the waiting rays, and those that they leave, to their ends.
    fn grow(&mut self, limits: &Limits, observer: &mut impl TraceObserver<R>) -> Result<(), Fault> {
        let longest = R::exact(limits.max_path) * R::exact(two_to(-self.scene.camera.scale));
        while let Some(ray) = self.waiting.pop() {
            if self.saturated(limits.enough) {
                observer.full(self.waiting.len() + 1);
                return Ok(());
            }
            let number = self.rays;
            let mark = R::mark();
            if (ray.total - longest).positive()? {
                R::release(mark);
                observer.missed(number, &ray, Unmet::TooLong);
                continue;
            }
            if self.rays == limits.max_rays {
                return Err(Fault::TooManyRays);
            }
            self.rays += 1;
            let range = Range {
                skip: ray.last,
                light: None,
            };
            match closest_hit(self.world, ray.base, ray.dir, &range)? {
                Some(hit) => self.shade(number, &ray, hit.t, &hit.point, observer)?,
                None => {
                    R::release(mark);
                    observer.missed(number, &ray, Unmet::Nothing);
                }
            }
        }
        Ok(())
    }

    /// Whether the colour is certainly at least `enough` in all channels, so that the other rays cannot change the
    /// bytes.
    fn saturated(&self, enough: f64) -> bool {
        let color = self.color;
        enough.is_finite()
            && [color.x, color.y, color.z].into_iter().all(|c| {
                let Bounded { value, error } = c.quick_enclosure();
                value - error * Bounded::GROW >= enough * (1.0 + f64::EPSILON)
            })
    }

    /// Adds what a ray that met `point` at distance `t` brings, and leaves the rays that go on from there.
    fn shade(
        &mut self,
        number: u32,
        ray: &Branch<R>,
        t: R,
        point: &Point<R>,
        observer: &mut impl TraceObserver<R>,
    ) -> Result<(), Fault> {
        let (scene, world) = (self.scene, self.world);
        let normal = normal_at(world, scene.is_plane[point.object], point);
        let mut color = getamb(scene, point)?;
        observer.met(number, ray, t, point, color);
        for light in 0..world.lights.len() {
            let mark = R::mark();
            let lit = light_term(scene, world, light, point, normal, ray.base)?;
            observer.light(light, &lit);
            if let Lit::Lit { diffuse, glint, .. } = lit {
                color = color + diffuse + glint;
            } else {
                R::release(mark);
            }
        }
        let total = ray.total + t;
        let material = &scene.palette[scene.materials[point.object]];
        let one = R::exact(1.0);
        let kept = if material.transparent {
            one - material.transparency
        } else {
            one
        };
        let share = (kept / total).times(two_to(-scene.camera.scale));
        let share = ray.weight.each(color) * share;
        observer.adds(share);
        self.color = self.color + share;
        let last = Some(world.groups[point.object]);
        let mut leave = |kind: RayKind, dir: V3<R>, weight: V3<R>, channels: [bool; 3]| {
            let counts = [0, 1, 2].map(|i| ray.counts[i] && channels[i]);
            let branch = Branch {
                base: point.position,
                dir,
                total,
                last,
                weight,
                counts,
                parent: number,
                kind,
            };
            // A ray that counts for nothing need not be traced.
            if counts == [false; 3] {
                observer.missed(number, &branch, Unmet::Weightless);
            } else {
                self.waiting.push(branch);
            }
        };
        if material.mirror {
            let mirrored = if scene.is_plane[point.object] {
                // With the normal as it is given there is no root in the direction.
                let plane = &world.planes[world.places[point.object]];
                let [x, y, z] = plane.mirror;
                V3::new(x.dot(ray.dir), y.dot(ray.dir), z.dot(ray.dir))
            } else {
                let along = normal.dot(-ray.dir);
                normal * (along + along) + ray.dir
            };
            leave(
                RayKind::Mirror,
                mirrored,
                ray.weight.each(material.specular),
                material.mirrored,
            );
        }
        if material.transparent {
            let tint = &scene.palette[super::surface::tile_material(scene, point)?];
            leave(
                RayKind::Through,
                ray.dir,
                ray.weight.each(tint.tint) * material.transparency,
                tint.passed,
            );
        }
        Ok(())
    }
}

//! The rays that a sample grows where it meets mirrors and what light goes through. Referee of `shaders/branch.wgsl`.
//!
//! A ray whose whole subtree cannot count is not followed: what it may bring at most is known from the scene
//! (`prepare::brightest`) and added to what is left open. Rays on the same way are followed as one.

use super::fault::Fault;
use super::light::{Lit, light_term, normal_at};
use super::observer::{Branch, RayKind, TraceObserver, Unmet};
use super::surface::{Point, getamb, tile_material};
use super::waiting::Waiting;
use super::world::{Range, closest_hit};
use crate::prepare::{Prepared, World};
use crate::real::rational::two_to;
use crate::real::{Bounded, Real, V3};
use crate::settings::Limits;

/// A ray of which it cannot be told what it meets stays open if all that it may bring is at most this: a sixteenth of a
/// byte.
const OPEN: f64 = 1.0 / 4096.0;

/// More than the roundings of what a ray may bring.
const SLACK: f64 = 1.0 + 1e-9;

/// The rays of a sample: those that wait, and what the others brought.
pub(super) struct Tree<'a, R> {
    scene: &'a Prepared<R>,
    world: &'a World<R>,
    limits: &'a Limits,
    waiting: Waiting<R>,
    rays: u32,
    /// What the rays brought.
    pub(super) color: V3<R>,
    /// What those may bring that were not followed.
    pub(super) open: [f64; 3],
}

impl<'a, R: Real> Tree<'a, R> {
    /// A tree without rays.
    pub(super) fn new(scene: &'a Prepared<R>, world: &'a World<R>, limits: &'a Limits) -> Self {
        Self {
            scene,
            world,
            limits,
            waiting: Waiting::new(),
            rays: 0,
            color: V3::new(R::zero(), R::zero(), R::zero()),
            open: [0.0; 3],
        }
    }

    /// The primary ray along `dir`, which met `point` at distance `t`, and all rays that it leaves, to their ends.
    pub(super) fn grow(
        &mut self,
        dir: V3<R>,
        t: R,
        point: &Point<R>,
        observer: &mut impl TraceObserver<R>,
    ) -> Result<(), Fault> {
        let (zero, one) = (R::zero(), R::exact(1.0));
        let first = Branch {
            base: V3::new(zero, zero, zero),
            dir,
            total: zero,
            last: None,
            weight: V3::new(one, one, one),
            counts: [true; 3],
            most: [f64::INFINITY; 3],
            rays: 1,
            parent: 0,
            kind: RayKind::Primary,
        };
        self.rays = 1;
        self.shade(0, &first, t, point, observer)?;
        let longest = R::exact(self.limits.max_path) * R::exact(two_to(-self.scene.camera.scale));
        let mut undecided = false;
        while let Some(ray) = self.waiting.next() {
            if self.full() == [true; 3] {
                observer.full(self.waiting.len() + 1);
                break;
            }
            // Others may have filled channels in which it counted.
            if self.faint(&ray) {
                self.leave_open(&ray);
                observer.missed(self.rays, &ray, Unmet::Faint);
                continue;
            }
            match self.follow(&ray, longest, observer) {
                Err(Fault::Undecided) if self.within(&ray, OPEN) => self.leave_open(&ray),
                // The others may be too many already, which takes other numbers much longer to find.
                Err(Fault::Undecided) if R::JOINS => undecided = true,
                followed => followed?,
            }
        }
        let full = self.full();
        if undecided && full != [true; 3] {
            return Err(Fault::Undecided);
        }
        // Whatever else there is in a full channel, its byte is the highest.
        for (open, full) in self.open.iter_mut().zip(full) {
            if full {
                *open = 0.0;
            }
        }
        Ok(())
    }

    /// Follows a ray: what it meets is added, and the rays that it leaves wait.
    fn follow(
        &mut self,
        ray: &Branch<R>,
        longest: R,
        observer: &mut impl TraceObserver<R>,
    ) -> Result<(), Fault> {
        let number = self.rays;
        let mark = R::mark();
        if (ray.total - longest).positive()? {
            R::release(mark);
            observer.missed(number, ray, Unmet::TooLong);
            return Ok(());
        }
        self.rays = self.rays.saturating_add(ray.rays);
        if self.rays > self.limits.max_rays {
            return Err(Fault::TooManyRays);
        }
        let range = Range {
            skip: ray.last,
            light: None,
            through: false,
        };
        match closest_hit(self.world, ray.base, ray.dir, &range)? {
            Some(hit) => self.shade(number, ray, hit.t, &hit.point, observer)?,
            None => {
                R::release(mark);
                observer.missed(number, ray, Unmet::Nothing);
            }
        }
        Ok(())
    }

    /// In which channels the colour is certainly at least `enough`, so that the other rays cannot change the byte.
    fn full(&self) -> [bool; 3] {
        let (color, enough) = (self.color, self.limits.enough);
        [color.x, color.y, color.z].map(|c| {
            enough.is_finite() && c.quick_enclosure().least() >= enough * (1.0 + f64::EPSILON)
        })
    }

    /// Whether nothing that a ray may bring can count beside what there is.
    fn faint(&self, ray: &Branch<R>) -> bool {
        self.within(ray, self.limits.faint)
    }

    /// Whether a ray may bring at most so much in all channels that are not full.
    fn within(&self, ray: &Branch<R>, least: f64) -> bool {
        let full = self.full();
        let small = |(most, full): (&f64, bool)| *most <= least || full;
        self.limits.faint > 0.0 && ray.most.iter().zip(full).all(small)
    }

    fn leave_open(&mut self, ray: &Branch<R>) {
        let full = self.full();
        for ((open, most), full) in self.open.iter_mut().zip(ray.most).zip(full) {
            if !full {
                *open += most;
            }
        }
    }

    /// What a ray and all that it leaves may bring, in each channel: weight·X/path, with the scene's own X.
    fn most(&self, last: Option<u32>, weight: V3<R>, counts: [bool; 3], total: R) -> [f64; 3] {
        let brightest = self.world.brightest.leaving(last, self.limits.max_rays);
        // After some mirrors the first enclosure may be too wide to say anything, and no ray would be faint.
        let least = total.enclosure().least() * two_to(self.scene.camera.scale);
        let weight = [weight.x, weight.y, weight.z].map(|w| {
            let Bounded { value, error } = w.quick_enclosure();
            value.abs() + error * Bounded::GROW
        });
        [0, 1, 2].map(|i| {
            // No less where it underflows.
            let most = (weight[i] * brightest[i] / least * SLACK).max(f64::MIN_POSITIVE);
            if !counts[i] || brightest[i] == 0.0 {
                0.0
            } else if least > 0.0 && most.is_finite() {
                most
            } else {
                f64::INFINITY
            }
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
                most: self.most(last, weight, counts, total),
                rays: ray.rays,
                parent: number,
                kind,
            };
            // A ray that counts for nothing need not be traced, nor one whose whole subtree is too faint.
            if counts == [false; 3] {
                observer.missed(number, &branch, Unmet::Weightless);
            } else if self.faint(&branch) {
                self.leave_open(&branch);
                observer.missed(number, &branch, Unmet::Faint);
            } else {
                self.waiting.push(branch);
            }
        };
        if material.mirror {
            let plane = if scene.is_plane[point.object] {
                world.plane_of(point.object)
            } else {
                None
            };
            let mirrored = if let Some(plane) = plane {
                // With the normal as it is given there is no root in the direction.
                let [x, y, z] = plane.mirror;
                V3::new(x.dot(ray.dir), y.dot(ray.dir), z.dot(ray.dir))
            } else if scene.is_quadric(point.object) {
                // Likewise: the gradient's length is a root that the direction need not have.
                let gradient = point.from_center;
                let along = gradient.dot(ray.dir).times(2.0) / gradient.dot(gradient);
                ray.dir - gradient * along
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
            let tint = &scene.palette[tile_material(scene, point)?];
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

//! How a colour comes about, told step by step: `plumb probe` listens, rendering does not.

use super::light::Lit;
use super::surface::Point;
use crate::real::V3;

/// A ray of the tree that a sample grows.
#[derive(Debug, Clone, Copy)]
pub struct Branch<R> {
    /// Where it starts, from the viewpoint in units of 2^scale.
    pub base: V3<R>,
    /// Its unit direction.
    pub dir: V3<R>,
    /// Length of the path before it, in units of 2^scale.
    pub total: R,
    /// The group of surfaces that it left from.
    pub last: Option<u32>,
    /// What its colour counts for.
    pub weight: V3<R>,
    /// In which channels that is not 0.
    pub counts: [bool; 3],
    /// What it and all that it leaves may bring, by channels.
    pub most: [f64; 3],
    /// How many rays on the same way it stands for.
    pub rays: u32,
    /// Number of the ray that it came from; its own for the first.
    pub parent: u32,
    /// How it left.
    pub kind: RayKind,
}

/// How a ray left the surface it came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RayKind {
    /// From the viewpoint.
    Primary,
    /// Straight through.
    Through,
    /// As a mirror image.
    Mirror,
}

/// Why a ray met nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unmet {
    /// Nothing is there; this is a ray like any other, and has a number.
    Nothing,
    /// It was not followed, as the path before it is too long.
    TooLong,
    /// It was not followed, as its weight is zero.
    Weightless,
    /// It was not followed, as nothing that it may bring can count.
    Faint,
}

/// Sees how a colour comes about: `plumb probe` listens, rendering does not.
///
/// In f64 rays come depth first: a ray, then the one that goes on through the surface with all that it leads to, then
/// the mirror image. Of a ray that meets something `met` is told, then `light` for each light, then `adds`.
pub trait TraceObserver<R> {
    /// `ray` met nothing; had it a number, that is `number`.
    fn missed(&mut self, number: u32, ray: &Branch<R>, why: Unmet) {
        let _ = (number, ray, why);
    }
    /// Ray `number` met `point` at distance `t`, where the ambient reflectivity is `ambient`.
    fn met(&mut self, number: u32, ray: &Branch<R>, t: R, point: &Point<R>, ambient: V3<R>) {
        let _ = (number, ray, t, point, ambient);
    }
    /// What a light does there.
    fn light(&mut self, light: usize, lit: &Lit<R>) {
        let _ = (light, lit);
    }
    /// What the ray adds to the colour.
    fn adds(&mut self, share: V3<R>) {
        let _ = share;
    }
    /// The colour is as bright as it can get: so many rays that wait are not followed.
    fn full(&mut self, waiting: usize) {
        let _ = waiting;
    }
}

/// An observer that ignores everything.
#[derive(Debug, Clone, Copy)]
pub struct Unobserved;

impl<R> TraceObserver<R> for Unobserved {}

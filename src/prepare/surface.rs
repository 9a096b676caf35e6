//! What an object's surface needs to know about a hit point, made ready: tile indices and vectors from a point.

use dashu_ratio::Relaxed as Ratio;
use glam::DVec3;

use super::camera;
use super::exact::{abs, is_zero, parity, power_of_two, ratio, ratio3};
use crate::real::Real;
use crate::scene::{self, Object, Shape};

/// What modulates the ambient reflectivity of an object. Positions are from the viewpoint, in units of 2^scale.
#[derive(Debug, Clone)]
pub enum Surface<R> {
    /// The material alone.
    Plain,
    /// A `tiled_plane`.
    Tiled(Box<Tiled<R>>),
    /// A `pplane`.
    Pplane(Box<Pplane<R>>),
    /// A `psphere` with the shader of this number.
    Psphere(u32),
}

/// A `tiled_plane`: tile indices along world x and z, and the other material.
#[derive(Debug, Clone, Copy)]
pub struct Tiled<R> {
    /// Tile index along x and along z.
    pub index: [TileIndex<R>; 2],
    /// Index of the alternate material.
    pub altmaterial: usize,
}

/// A `pplane`: the shader, and what the shaders may ask about a hit point.
#[derive(Debug, Clone, Copy)]
pub struct Pplane<R> {
    /// Number of the shader.
    pub shader: u32,
    /// The indices floor(2·H + 1000) along x, y, z.
    pub index: [TileIndex<R>; 3],
    /// The components x and y of H − point.
    pub from_point: [FromPoint<R>; 2],
}

/// floor((H + shift)/d) for one coordinate of a hit point: `floor(P·per_unit + fraction) + parity`, up to an even number.
///
/// The whole part of (V + shift)/d is folded into `parity` here, exactly; what is left is small.
#[derive(Debug, Clone, Copy)]
pub struct TileIndex<R> {
    /// 2^scale / d; 0 where the coordinate is the plane's own.
    pub per_unit: R,
    /// In [0, 1); ½ where the coordinate is the plane's own, far from every edge.
    pub fraction: R,
    /// 0 or 1.
    pub parity: u32,
}

/// One component of H − point: `P·per_unit − offset`, in world units.
#[derive(Debug, Clone, Copy)]
pub struct FromPoint<R> {
    /// 2^scale; 0 where the coordinate is the plane's own.
    pub per_unit: R,
    /// point − viewpoint; 0 where the coordinate is the plane's own, as then H and point agree in it.
    pub offset: R,
}

/// Added to a coordinate before it is divided by the tile's size (the notes; it keeps indices positive in C).
const TILE_SHIFT: f64 = 10_000.0;
/// floor(2·H + 1000) is floor((H + 500)/½).
const PPLANE_SHIFT: f64 = 500.0;
const PPLANE_TILE: f64 = 0.5;

impl<R: Real> Surface<R> {
    /// Prepares the surface of `object`.
    pub fn new(scene: &scene::Scene, object: &Object) -> Self {
        let view = scene.camera.viewpoint;
        let scale = camera::exponent(view.z);
        match (object.surface, &object.shape) {
            (scene::Surface::Tiled { dimension, altmaterial, .. }, Shape::Plane { normal, point, .. }) => {
                let index = |axis, d| TileIndex::new(view[axis], own(*normal, *point, axis), TILE_SHIFT, d, scale);
                Self::Tiled(Box::new(Tiled { index: [index(0, dimension.x), index(2, dimension.y)], altmaterial }))
            }
            (scene::Surface::Procedural { shader }, Shape::Plane { normal, point, .. }) => {
                let index =
                    |axis| TileIndex::new(view[axis], own(*normal, *point, axis), PPLANE_SHIFT, PPLANE_TILE, scale);
                let from_point = |axis: usize| FromPoint::new(view[axis], *normal, *point, axis, scale);
                Self::Pplane(Box::new(Pplane {
                    shader,
                    index: [index(0), index(1), index(2)],
                    from_point: [from_point(0), from_point(1)],
                }))
            }
            (scene::Surface::Procedural { shader }, Shape::Sphere { .. }) => Self::Psphere(shader),
            _ => Self::Plain,
        }
    }
}

/// The coordinate that every point of the plane shares, if it is perpendicular to that axis.
fn own(normal: DVec3, point: DVec3, axis: usize) -> Option<f64> {
    let n = ratio3(normal);
    (0..3).all(|i| i == axis || is_zero(&n[i])).then(|| point[axis])
}

impl<R: Real> TileIndex<R> {
    fn new(view: f64, own: Option<f64>, shift: f64, d: f64, scale: i32) -> Self {
        let index_of = |h: f64| -> Ratio { (ratio(h) + ratio(shift)) / ratio(d) };
        if let Some(own) = own {
            let whole = index_of(own).floor();
            return Self { per_unit: R::zero(), fraction: R::exact(0.5), parity: parity(&whole) };
        }
        let index = index_of(view);
        let whole = index.floor();
        Self {
            per_unit: R::ratio(&(power_of_two(scale) / abs(ratio(d)))),
            fraction: R::ratio(&(index - Ratio::from(whole.clone()))),
            parity: parity(&whole),
        }
    }

    /// Whether the index at position `p` is odd (1) or even (0).
    pub fn odd(&self, p: R) -> Result<u32, crate::real::Undecided> {
        let index = (p * self.per_unit + self.fraction).floor()? + f64::from(self.parity);
        Ok((index - 2.0 * (index * 0.5).floor()) as u32)
    }
}

impl<R: Real> FromPoint<R> {
    fn new(view: f64, normal: DVec3, point: DVec3, axis: usize, scale: i32) -> Self {
        if own(normal, point, axis).is_some() {
            return Self { per_unit: R::zero(), offset: R::zero() };
        }
        Self {
            per_unit: R::ratio(&power_of_two(scale)),
            offset: R::ratio(&(ratio(point[axis]) - ratio(view))),
        }
    }

    /// The component at position `p`.
    pub fn at(&self, p: R) -> R {
        p * self.per_unit - self.offset
    }
}

//! What an object's surface needs to know about a hit point, made ready: tile indices and vectors from a point.

use glam::{DVec2, DVec3};

use super::camera;
use super::extent::{Rectangle, rows};
use super::triangle;
use crate::real::rational::{Ratio, abs, parity, power_of_two, ratio, two_to};
use crate::real::{Real, V3};
use crate::scene::{self, Extent, Object, Shape, TextureMode};

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
    /// A `texplane`.
    Textured(Box<Textured<R>>),
}

/// A `tiled_plane`: tile indices along two directions, and the other material.
#[derive(Debug, Clone, Copy)]
pub struct Tiled<R> {
    /// The directions, if not world x and z.
    pub rows: Option<[V3<R>; 2]>,
    /// Tile indices along them.
    pub index: [TileIndex<R>; 2],
    /// Material of the tiles whose indices add up to an even number, and of the others.
    pub materials: [usize; 2],
}

/// A `texplane`: texel column and row are floor(p_i · per_unit\[i\]), p the coordinates on the rectangle.
#[derive(Debug, Clone)]
pub struct Textured<R> {
    /// The rectangle.
    pub rectangle: Rectangle<R>,
    /// Texels a unit, along both sides.
    pub per_unit: [R; 2],
    /// Index of the texture.
    pub texture: usize,
    /// Columns and rows of the texture.
    pub size: [u32; 2],
    /// Whether the picture repeats (mode 1); else it is stretched, and indices are clamped.
    pub repeats: bool,
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

/// floor((H + shift)/d) for one coordinate of a hit point: `floor(P·per_unit + fraction) + parity`, up to an even
/// number.
///
/// The whole part of (V + shift)/d is folded into `parity` here, exactly; what is left is small.
#[derive(Debug, Clone, Copy)]
pub struct TileIndex<R> {
    /// 2^scale / d; 0 where the coordinate is the plane's own.
    pub per_unit: R,
    /// In [0, 1), or next to it; ½ where the coordinate is the plane's own, far from every edge.
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
pub(super) const TILE_SHIFT: f64 = 10_000.0;
/// floor(2·H + 1000) is floor((H + 500)/½).
pub(super) const PPLANE_SHIFT: f64 = 500.0;
pub(super) const PPLANE_TILE: f64 = 0.5;

impl<R: Real> Surface<R> {
    /// Prepares the surface of `object`.
    pub fn new(scene: &scene::Scene, object: &Object) -> Self {
        match (&object.shape, object.surface) {
            (_, scene::Surface::Plain) => Self::Plain,
            (
                &Shape::Plane { normal, .. },
                scene::Surface::Tiled {
                    dimension,
                    altmaterial,
                    xdir,
                },
            ) => {
                let materials = [object.material, altmaterial];
                let camera = &scene.camera;
                Self::Tiled(Box::new(match xdir {
                    None => {
                        let flat = flat_axis(&object.shape);
                        Tiled::along_axes(camera, flat, dimension, materials)
                    }
                    Some(xdir) => Tiled::along_rows(camera, normal, xdir, dimension, materials),
                }))
            }
            (&Shape::Plane { point, .. }, scene::Surface::Procedural { shader }) => {
                let flat = flat_axis(&object.shape);
                Self::Pplane(Box::new(Pplane::new(&scene.camera, flat, point, shader)))
            }
            (Shape::Triangle(triangle), scene::Surface::Procedural { shader }) => {
                let flat = flat_axis(&object.shape);
                let point = triangle.vertices[0];
                Self::Pplane(Box::new(Pplane::new(&scene.camera, flat, point, shader)))
            }
            (Shape::Sphere { .. }, scene::Surface::Procedural { shader }) => Self::Psphere(shader),
            (
                &Shape::Plane {
                    normal,
                    point,
                    extent: Extent::Rectangle(ref rectangle),
                },
                scene::Surface::Textured { texture, mode },
            ) => {
                let scale = camera::exponent(scene.camera.viewpoint.z);
                let rectangle = Rectangle::new(&scene.camera, scale, normal, point, rectangle);
                Self::Textured(Box::new(Textured::new(scene, rectangle, texture, mode)))
            }
            // The scene language has no such objects.
            (
                Shape::Plane {
                    extent: Extent::Unbounded,
                    ..
                }
                | Shape::Sphere { .. }
                | Shape::Triangle(_)
                | Shape::Quadric(_),
                scene::Surface::Textured { .. },
            )
            | (
                Shape::Sphere { .. } | Shape::Triangle(_) | Shape::Quadric(_),
                scene::Surface::Tiled { .. },
            ) => Self::Plain,
            // Its shaders are planes', with the world's origin for a point.
            (Shape::Quadric(_), scene::Surface::Procedural { shader }) => {
                let origin = DVec3::ZERO;
                Self::Pplane(Box::new(Pplane::new(&scene.camera, None, origin, shader)))
            }
        }
    }
}

impl<R: Real> Tiled<R> {
    /// Tiles along world x and z; `materials` are the plane's own and the other.
    fn along_axes(
        camera: &scene::Camera,
        flat: Option<(usize, f64)>,
        dimension: DVec2,
        materials: [usize; 2],
    ) -> Self {
        let view = camera.viewpoint;
        let scale = camera::exponent(view.z);
        let index = |axis: usize, d: f64| {
            TileIndex::new(
                view[axis],
                fixed_coordinate(flat, axis),
                TILE_SHIFT,
                d,
                scale,
            )
        };
        Self {
            rows: None,
            index: [index(0, dimension.x), index(2, dimension.y)],
            materials,
        }
    }

    /// Tiles along `xdir` and normal × xdir.
    fn along_rows(
        camera: &scene::Camera,
        normal: DVec3,
        xdir: DVec3,
        dimension: DVec2,
        [plain, other]: [usize; 2],
    ) -> Self {
        let view = camera.viewpoint;
        let scale = camera::exponent(view.z);
        let rows = rows(normal, xdir);
        let index = |i: usize, d| TileIndex::along(rows[i].dot(V3::exact(view)), d, scale);
        Self {
            rows: Some(rows),
            index: [index(0, dimension.x), index(1, dimension.y)],
            // With xdir the course's program has the two materials the other way round.
            materials: [other, plain],
        }
    }
}

impl<R: Real> Textured<R> {
    pub(super) fn new(
        scene: &scene::Scene,
        rectangle: Rectangle<R>,
        texture: usize,
        mode: TextureMode,
    ) -> Self {
        let camera = &scene.camera;
        let texels = &scene.textures[texture].texels;
        let size = [texels.width, texels.height];
        let per_unit = [0, 1].map(|i| match mode {
            TextureMode::Fit => R::exact(f64::from(size[i])) / rectangle.dimensions[i],
            // A texel is as large as a pixel of the screen.
            TextureMode::Tile => R::ratio(
                &(power_of_two(camera::exponent(camera.viewpoint.z))
                    * ratio(f64::from(camera.pixeldim[i]))
                    / ratio(camera.worlddim[i])),
            ),
        });
        Self {
            rectangle,
            per_unit,
            texture,
            size,
            repeats: mode == TextureMode::Tile,
        }
    }
}

impl<R: Real> Pplane<R> {
    fn new(camera: &scene::Camera, flat: Option<(usize, f64)>, point: DVec3, shader: u32) -> Self {
        let view = camera.viewpoint;
        let scale = camera::exponent(view.z);
        let index = |axis: usize| {
            TileIndex::new(
                view[axis],
                fixed_coordinate(flat, axis),
                PPLANE_SHIFT,
                PPLANE_TILE,
                scale,
            )
        };
        let from_point = |axis: usize| {
            FromPoint::new(view[axis], fixed_coordinate(flat, axis), point[axis], scale)
        };
        Self {
            shader,
            index: [index(0), index(1), index(2)],
            from_point: [from_point(0), from_point(1)],
        }
    }
}

/// The axis that a planar shape is perpendicular to, and the coordinate that all its points share, if there is one.
pub fn flat_axis(shape: &Shape) -> Option<(usize, f64)> {
    match shape {
        Shape::Plane { normal, point, .. } => {
            let is_flat = |axis: usize| (0..3).all(|i| i == axis || normal[i] == 0.0);
            let axis = (0..3).find(|&axis| is_flat(axis))?;
            Some((axis, point[axis]))
        }
        Shape::Triangle(triangle) => triangle::flat_axis(triangle),
        Shape::Sphere { .. } | Shape::Quadric(_) => None,
    }
}

/// The coordinate along this axis, if all points share it.
fn fixed_coordinate(flat: Option<(usize, f64)>, axis: usize) -> Option<f64> {
    flat.filter(|flat| flat.0 == axis).map(|flat| flat.1)
}

impl<R: Real> TileIndex<R> {
    fn new(view: f64, fixed_coordinate: Option<f64>, shift: f64, d: f64, scale: i32) -> Self {
        let index_of = |h: f64| -> Ratio { (ratio(h) + ratio(shift)) / ratio(d) };
        if let Some(fixed_coordinate) = fixed_coordinate {
            let whole = index_of(fixed_coordinate).floor();
            return Self {
                per_unit: R::zero(),
                fraction: R::exact(0.5),
                parity: parity(&whole),
            };
        }
        let index = index_of(view);
        let whole = index.floor();
        Self {
            per_unit: R::ratio(&(power_of_two(scale) / abs(ratio(d)))),
            fraction: R::ratio(&(index - Ratio::from(whole.clone()))),
            parity: parity(&whole),
        }
    }

    /// The index along a direction in which the viewpoint's coordinate is `view`.
    fn along(view: R, d: f64, scale: i32) -> Self {
        let d = R::exact(d);
        let index = (view + R::exact(TILE_SHIFT)) / d;
        // Any whole number near the index will do: what is left need not lie in [0, 1).
        let whole = index.to_f64().floor();
        let whole = if whole.is_finite() { whole } else { 0.0 };
        Self {
            per_unit: R::exact(two_to(scale)) / d,
            fraction: index - R::exact(whole),
            parity: whole.rem_euclid(2.0) as u32,
        }
    }

    /// Whether the index at position `p` is odd (1) or even (0).
    pub fn odd(&self, p: R) -> Result<u32, crate::real::Undecided> {
        Ok((p * self.per_unit + self.fraction).floor_mod(2)? ^ self.parity)
    }
}

impl<R: Real> FromPoint<R> {
    fn new(view: f64, fixed_coordinate: Option<f64>, point: f64, scale: i32) -> Self {
        if fixed_coordinate.is_some() {
            return Self {
                per_unit: R::zero(),
                offset: R::zero(),
            };
        }
        Self {
            per_unit: R::ratio(&power_of_two(scale)),
            offset: R::ratio(&(ratio(point) - ratio(view))),
        }
    }

    /// The component at position `p`.
    pub fn at(&self, p: R) -> R {
        p * self.per_unit - self.offset
    }
}

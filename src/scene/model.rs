//! The scene as plain data, in f64, as the file says it: what the parser makes, what a program may build by hand,
//! and what everything after it reads.
//!
//! A `Scene` that went through [`super::parse()`] or [`super::SceneBuilder`] keeps every limit of the scene language
//! (docs/SCENE.md); the rest of the program relies on that.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::kind::{Class, EntityKind, LightClass};

/// A whole scene: one camera, and lists in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The only camera.
    pub camera: Camera,
    /// Materials in file order; names may repeat, references mean the first.
    pub materials: Vec<Material>,
    /// Visible objects in file order; of equally near hits the first counts.
    pub objects: Vec<Object>,
    /// Lights in file order.
    pub lights: Vec<Light>,
    /// Textures in file order; names may repeat, references mean the first.
    pub textures: Vec<Texture>,
}

/// The viewpoint and the screen, the rectangle (0, 0, 0)–(worlddim.x, worlddim.y, 0).
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The name in the file.
    pub name: String,
    /// Columns and rows of the picture, each 1 to 1,000,000.
    pub pixeldim: [u32; 2],
    /// The screen's size in world units, each > 0.
    pub worlddim: DVec2,
    /// Where the rays start; z > 0.
    pub viewpoint: DVec3,
}

/// How a surface answers light; every number ≥ 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Material {
    /// The name in the file.
    pub name: String,
    /// Reflectivity for the light that is everywhere (r, g, b).
    pub ambient: DVec3,
    /// Reflectivity for light from lights (r, g, b).
    pub diffuse: DVec3,
    /// Mirror reflectivity (r, g, b).
    pub specular: DVec3,
    /// Exponent of the glint; 0 means none.
    pub shininess: f64,
    /// Share of light that goes straight through, 0 to 1.
    pub transparency: f64,
}

/// A visible object: a shape, and what its surface looks like.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The name in the file.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Where it is.
    pub shape: Shape,
    /// What modulates the material's reflectivity.
    pub surface: Surface,
}

/// Where an object is.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A plane, or a rectangle of one.
    Plane {
        /// Perpendicular to the plane, of any length but 0.
        normal: DVec3,
        /// A point on the plane; of a rectangle, its corner.
        point: DVec3,
        /// Where the plane ends.
        extent: Extent,
    },
    /// A sphere.
    Sphere {
        /// Its center.
        center: DVec3,
        /// Its radius, > 0.
        radius: f64,
    },
    /// A triangle.
    Triangle(Triangle),
    /// What a quadratic equation in x, y and z describes.
    Quadric(Quadric),
}

/// A triangle: the plane through its vertices, between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Its vertices, not in a line.
    pub vertices: [DVec3; 3],
    /// Where this is given, the normal (v2 − v1) × (v3 − v1) is turned over if it points to the other side; not
    /// perpendicular to that.
    pub normal: Option<DVec3>,
    /// As a plane has it: read, listed, and without a meaning.
    pub point: Option<DVec3>,
}

/// A general quadric surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    /// A to J of A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z = J; of A to I one is not 0.
    pub coefficients: [f64; 10],
    /// Only points with coordinates of at least these belong to it.
    pub lower: Option<DVec3>,
    /// Only points with coordinates of at most these belong to it; each more than that of `lower`.
    pub upper: Option<DVec3>,
}

/// Where a plane ends: straight sides all around, or nowhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// It has no end.
    Unbounded,
    /// It is a rectangle (`fplane`, `texplane`).
    Rectangle(Rectangle),
}

/// The rectangle of a finite plane, from `point` along xdir (projected onto the plane) and normal × xdir.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// The direction of the first side; not parallel to the normal.
    pub xdir: DVec3,
    /// Lengths of the sides, > 0.
    pub dimensions: DVec2,
}

/// What modulates the reflectivity of an object's material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Nothing: the material alone.
    Plain,
    /// A checkerboard of the material and another (`tiled_plane`).
    Tiled {
        /// The size of a tile in world units, > 0.
        dimension: DVec2,
        /// Index into [`Scene::materials`].
        altmaterial: usize,
        /// The direction of the first side; without it tiles follow world x and z.
        xdir: Option<DVec3>,
    },
    /// A procedural ambient reflectivity (`pplane`, `psphere`, `ptriangle`, `pquadric`).
    Procedural {
        /// Number of the shader, below the number of shaders for the shape.
        shader: u32,
    },
    /// A picture (`texplane`).
    Textured {
        /// Index into [`Scene::textures`].
        texture: usize,
        /// How the texture is laid on the rectangle.
        mode: TextureMode,
    },
}

/// How a texture is laid on a `texplane`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureMode {
    /// Stretched over the rectangle (mode 0).
    Fit,
    /// Repeated, a texel as large as a pixel of the screen (mode 1).
    Tile,
}

/// A light; it lights, and is not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// The name in the file.
    pub name: String,
    /// Where it is.
    pub location: DVec3,
    /// How bright it is (r, g, b), each ≥ 0.
    pub emissivity: DVec3,
    /// Where it shines.
    pub beam: Beam,
}

/// Where a light shines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// To all sides (`light`).
    Everywhere,
    /// Into a cone (`spotlight`).
    Cone(Cone),
    /// Through a picture (`projector`).
    Picture(ProjectorPicture),
}

/// The picture that a projector throws: its light passes through this rectangle alone, which itself is not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProjectorPicture {
    /// Perpendicular to the rectangle, of any length but 0.
    pub normal: DVec3,
    /// A corner of the rectangle.
    pub point: DVec3,
    /// Where it ends.
    pub rectangle: Rectangle,
    /// Index into [`Scene::textures`].
    pub texture: usize,
    /// How the texture is laid on the rectangle.
    pub mode: TextureMode,
}

/// The cone that a spotlight lights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// A point on the axis; not the light's location.
    pub point: DVec3,
    /// Half the opening angle in degrees, 0 < theta ≤ 180.
    pub theta: f64,
}

/// A named picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// The name in the file.
    pub name: String,
    /// The file name as the scene gives it.
    pub filename: String,
    /// Where it was read from.
    pub path: PathBuf,
    /// Its texels.
    pub texels: Arc<Texels>,
}

/// The texels of a texture, as a binary PPM with maxval 255 has them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texels {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue of each texel, top row first: 3 · width · height bytes.
    pub rgb: Vec<u8>,
}

impl Object {
    /// The entity type that the scene file calls this object by.
    pub fn entity(&self) -> &'static str {
        EntityKind::Object(self.class()).name()
    }

    /// The class of the entity that the scene file has for this shape and surface.
    pub(super) fn class(&self) -> Class {
        match (&self.shape, &self.surface) {
            (Shape::Sphere { .. }, Surface::Procedural { .. }) => Class::ProceduralSphere,
            // Spheres have no tiles and no pictures.
            (
                Shape::Sphere { .. },
                Surface::Plain | Surface::Tiled { .. } | Surface::Textured { .. },
            ) => Class::Sphere,
            (Shape::Triangle(_), Surface::Procedural { .. }) => Class::ProceduralTriangle,
            (Shape::Quadric(_), Surface::Procedural { .. }) => Class::ProceduralQuadric,
            // Nor have triangles and quadrics.
            (
                Shape::Triangle(_),
                Surface::Plain | Surface::Tiled { .. } | Surface::Textured { .. },
            ) => Class::Triangle,
            (
                Shape::Quadric(_),
                Surface::Plain | Surface::Tiled { .. } | Surface::Textured { .. },
            ) => Class::Quadric,
            (Shape::Plane { .. }, Surface::Tiled { .. }) => Class::Tiled,
            (Shape::Plane { .. }, Surface::Procedural { .. }) => Class::ProceduralPlane,
            (Shape::Plane { .. }, Surface::Textured { .. }) => Class::Textured,
            (Shape::Plane { extent, .. }, Surface::Plain) => match extent {
                Extent::Unbounded => Class::Plane,
                Extent::Rectangle(_) => Class::Finite,
            },
        }
    }
}

impl Light {
    /// The entity type that the scene file calls this light by.
    pub fn entity(&self) -> &'static str {
        self.kind().name()
    }

    /// The kind of entity that it is.
    pub(super) fn kind(&self) -> EntityKind {
        EntityKind::Light(match self.beam {
            Beam::Everywhere => LightClass::Light,
            Beam::Cone(_) => LightClass::Spotlight,
            Beam::Picture(_) => LightClass::Projector,
        })
    }
}

//! The scene in exact reals: made from `plumb::scene` once a thread, read by `hits`, `surface` and `trace`.
//!
//! Normals keep the length that the file gives them, and so do the sides of rectangles: lengths, which take square
//! roots, stand apart, where docs/SCENE.md wants unit vectors.

use std::cmp::Ordering;
use std::collections::HashMap;

use dashu_ratio::RBig;
use glam::{DVec2, DVec3};
use plumb::scene::{self, Beam, Extent, Light, Material, Object, Scene, Shape, Surface, Triangle};

use super::Rules;
use super::angle::cosine_of;
use super::real::Real;
use super::vector::Vector;

/// Scene and rules.
#[derive(Debug)]
pub(crate) struct World<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) rules: &'s Rules,
    pub(crate) viewpoint: Vector,
    pub(crate) tolerance: Real,
    pub(crate) max_path: Real,
    pub(crate) bodies: Vec<Body<'s>>,
    /// How many different surfaces the bodies lie on.
    pub(crate) carriers: usize,
    pub(crate) materials: Vec<Stuff>,
    pub(crate) lamps: Vec<Lamp>,
}

/// An object.
#[derive(Debug)]
pub(crate) struct Body<'s> {
    pub(crate) object: &'s Object,
    pub(crate) form: Form,
    /// Which infinite plane or sphere it lies on: the same number for the same one, whatever normal or point names it.
    pub(crate) carrier: usize,
    /// The sides that tiles or a texture follow, or that bound a rectangle.
    pub(crate) sides: Option<Sides>,
}

/// Where an object is.
#[derive(Debug)]
pub(crate) enum Form {
    /// N·(H − Q) = 0.
    Plane {
        normal: Vector,
        point: Vector,
        /// The only coordinate that N has: on all of the plane it is Q's.
        axis: Option<usize>,
    },
    /// |H − C| = r.
    Sphere {
        center: Vector,
        /// r².
        square: Real,
    },
}

/// Two directions in a plane at a right angle, of any length.
#[derive(Debug)]
pub(crate) struct Sides {
    pub(crate) directions: [Vector; 2],
    pub(crate) lengths: [Real; 2],
    /// The rectangle's or the tile's size along each.
    pub(crate) dimensions: [Real; 2],
}

/// A material.
#[derive(Debug)]
pub(crate) struct Stuff {
    pub(crate) ambient: Vector,
    pub(crate) diffuse: Vector,
    pub(crate) specular: Vector,
    pub(crate) transparency: Real,
    pub(crate) opacity: Real,
    /// K/max(K) of the diffuse reflectivity, 1 where that is 0.
    pub(crate) tint: Vector,
}

/// A light.
#[derive(Debug)]
pub(crate) struct Lamp {
    pub(crate) location: Vector,
    pub(crate) emissivity: Vector,
    pub(crate) cone: Option<Cone>,
}

/// What a spotlight lights.
#[derive(Debug)]
pub(crate) struct Cone {
    /// From the location to the point.
    pub(crate) axis: Vector,
    /// axis·axis.
    pub(crate) square: Real,
    pub(crate) cosine: Real,
}

impl<'s> World<'s> {
    pub(crate) fn new(scene: &'s Scene, rules: &'s Rules) -> Self {
        let mut carriers = HashMap::new();
        Self {
            scene,
            rules,
            viewpoint: Vector::from_f64(scene.camera.viewpoint),
            tolerance: Real::from_f64(rules.tolerance),
            max_path: Real::from_f64(rules.max_path),
            bodies: scene
                .objects
                .iter()
                .map(|object| {
                    let next = carriers.len();
                    body(
                        object,
                        *carriers.entry(carrier(&object.shape)).or_insert(next),
                    )
                })
                .collect(),
            carriers: carriers.len(),
            materials: scene.materials.iter().map(stuff).collect(),
            lamps: scene.lights.iter().map(lamp).collect(),
        }
    }
}

/// What is the same for shapes on the same plane or sphere, and for no others.
fn carrier(shape: &Shape) -> (bool, [RBig; 4]) {
    let exact = |v: DVec3| v.to_array().map(|c| RBig::try_from(c).expect("finite"));
    match *shape {
        Shape::Sphere { center, radius } => {
            let [x, y, z] = exact(center);
            let radius = RBig::try_from(radius).expect("finite");
            (true, [x, y, z, radius])
        }
        Shape::Plane { normal, point, .. } => {
            let ([a, b, c], [x, y, z]) = (exact(normal), exact(point));
            let offset = &a * x + &b * y + &c * z;
            let numbers = [a, b, c, offset];
            let first = numbers.iter().find(|n| !n.is_zero()).cloned();
            let first = first.expect("a normal is not zero");
            (false, numbers.map(|n| n / &first))
        }
        Shape::Triangle(Triangle { vertices, .. }) => {
            let [v1, v2, v3] = vertices.map(exact);
            let edge = |to: &[RBig; 3]| [0, 1, 2].map(|i| &to[i] - &v1[i]);
            let (a, b) = (edge(&v2), edge(&v3));
            let [x, y, z] = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i]);
            let offset = &x * &v1[0] + &y * &v1[1] + &z * &v1[2];
            let numbers = [x, y, z, offset];
            let first = numbers.iter().find(|n| !n.is_zero()).cloned();
            let first = first.expect("vertices are not in a line");
            (false, numbers.map(|n| n / &first))
        }
        Shape::Quadric(_) => panic!("no scene has a quadric yet"),
    }
}

fn body(object: &Object, carrier: usize) -> Body<'_> {
    match object.shape {
        Shape::Sphere { center, radius } => Body {
            object,
            carrier,
            form: Form::Sphere {
                center: Vector::from_f64(center),
                square: Real::from_f64(radius).square().settled(),
            },
            sides: None,
        },
        Shape::Triangle(Triangle {
            vertices,
            normal: facing,
            ..
        }) => {
            let corners = vertices.map(Vector::from_f64);
            let edge = |from: usize, to: usize| (&corners[to] - &corners[from]).settled();
            let mut normal = edge(0, 1).cross(&edge(0, 2)).settled();
            if let Some(facing) = facing
                && normal
                    .dot(&Vector::from_f64(facing))
                    .sign()
                    .expect("rational numbers have a sign")
                    == Ordering::Less
            {
                normal = normal.scale(&Real::integer(-1)).settled();
            }
            // A plane normal to an axis has one coordinate for all its points.
            let axis = (0..3).find(|i| vertices.iter().all(|v| v[*i] == vertices[0][*i]));
            Body {
                object,
                carrier,
                sides: None,
                form: Form::Plane {
                    normal,
                    point: Vector::from_f64(vertices[0]),
                    axis,
                },
            }
        }
        Shape::Quadric(_) => panic!("no scene has a quadric yet"),
        Shape::Plane {
            normal,
            point,
            extent,
        } => {
            let mut coordinates = (0..3).filter(|i| normal[*i] != 0.0);
            let axis = match (coordinates.next(), coordinates.next()) {
                (Some(axis), None) => Some(axis),
                _ => None,
            };
            let normal = Vector::from_f64(normal);
            let along = match (extent, object.surface) {
                (Extent::Rectangle(r), _) => Some((r.xdir, r.dimensions)),
                (
                    Extent::Unbounded,
                    Surface::Tiled {
                        dimension,
                        xdir: Some(xdir),
                        ..
                    },
                ) => Some((xdir, dimension)),
                (Extent::Unbounded, _) => None,
            };
            Body {
                object,
                carrier,
                sides: along.map(|(xdir, dimensions)| sides(&normal, xdir, dimensions)),
                form: Form::Plane {
                    normal,
                    point: Vector::from_f64(point),
                    axis,
                },
            }
        }
    }
}

/// xdir − (N·xdir)N for a unit N is, times N·N, (N·N)xdir − (N·xdir)N for any.
fn sides(normal: &Vector, xdir: DVec3, dimensions: DVec2) -> Sides {
    let xdir = Vector::from_f64(xdir);
    let first = (&xdir.scale(&normal.dot(normal)) - &normal.scale(&normal.dot(&xdir))).settled();
    let second = normal.cross(&first).settled();
    let length = |v: &Vector| v.dot(v).settled().sqrt().settled();
    Sides {
        lengths: [length(&first), length(&second)],
        directions: [first, second],
        dimensions: dimensions.to_array().map(Real::from_f64),
    }
}

fn lamp(light: &Light) -> Lamp {
    let Light {
        name: _,
        location,
        emissivity,
        beam,
    } = *light;
    let cone = match beam {
        Beam::Cone(cone) => Some(cone),
        Beam::Everywhere => None,
        Beam::Picture(_) => panic!("no scene has a projector yet"),
    };
    let location = Vector::from_f64(location);
    Lamp {
        emissivity: Vector::from_f64(emissivity),
        cone: cone.map(|scene::Cone { point, theta }| {
            let axis = (&Vector::from_f64(point) - &location).settled();
            Cone {
                square: axis.dot(&axis).settled(),
                axis,
                cosine: cosine_of(theta),
            }
        }),
        location,
    }
}

fn stuff(material: &Material) -> Stuff {
    // The glint's exponent is asked of the scene.
    let Material {
        name: _,
        ambient,
        diffuse,
        specular,
        shininess: _,
        transparency,
    } = *material;
    let transparency = Real::from_f64(transparency);
    let most = diffuse.max_element();
    Stuff {
        ambient: Vector::from_f64(ambient),
        diffuse: Vector::from_f64(diffuse),
        specular: Vector::from_f64(specular),
        opacity: (&Real::integer(1) - &transparency).settled(),
        transparency,
        tint: if most == 0.0 {
            Vector::all(1)
        } else {
            let most = Real::from_f64(most);
            Vector(
                diffuse
                    .to_array()
                    .map(|k| (&Real::from_f64(k) / &most).settled()),
            )
        },
    }
}

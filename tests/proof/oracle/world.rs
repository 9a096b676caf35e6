//! The scene in exact reals: made from `plumb::scene` once a thread, read by `hits`, `surface` and `trace`.
//!
//! Normals keep the length that the file gives them, and so do the sides of rectangles: lengths, which take square
//! roots, stand apart, where docs/SCENE.md wants unit vectors.

use std::cmp::Ordering;
use std::collections::HashMap;

use dashu_ratio::RBig;
use glam::{DVec2, DVec3};
use plumb::scene::{
    self, Beam, Extent, Light, Material, Object, ProjectorPicture, Scene, Shape, Surface,
    TextureMode, Triangle,
};

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
    /// Where a quadric is cut: the axis, whether hits are not to be below or not above, and the coordinate.
    pub(crate) borders: Vec<(usize, bool, Real)>,
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
    Quadric(Quadric),
}

/// H·(M H) + slope·H = constant.
#[derive(Debug)]
pub(crate) struct Quadric {
    rows: [Vector; 3],
    slope: Vector,
    constant: Real,
}

impl Quadric {
    fn new(coefficients: &[f64; 10]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j] = coefficients.map(Real::from_f64);
        let half = |x: Real| (&x / &Real::integer(2)).settled();
        let [d, e, f] = [half(d), half(e), half(f)];
        Self {
            rows: [
                Vector([a, d.clone(), e.clone()]),
                Vector([d, b, f.clone()]),
                Vector([e, f, c]),
            ],
            slope: Vector([g, h, i]),
            constant: j,
        }
    }

    /// M v.
    pub(crate) fn turned(&self, v: &Vector) -> Vector {
        Vector(self.rows.each_ref().map(|row| row.dot(v)))
    }

    /// The gradient of the left side.
    pub(crate) fn gradient(&self, at: &Vector) -> Vector {
        &self.turned(at).scale(&Real::integer(2)) + &self.slope
    }

    /// The left side less the constant: 0 on the surface.
    pub(crate) fn left_side(&self, at: &Vector) -> Real {
        let left = &at.dot(&self.turned(at)) + &self.slope.dot(at);
        (&left - &self.constant).settled()
    }
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
    pub(crate) slide: Option<Slide>,
}

/// The picture that a projector throws.
#[derive(Debug)]
pub(crate) struct Slide {
    pub(crate) normal: Vector,
    /// The corner where the texture begins.
    pub(crate) point: Vector,
    pub(crate) sides: Sides,
    pub(crate) texture: usize,
    pub(crate) mode: TextureMode,
    /// Which infinite plane it lies on, if an object lies there too.
    pub(crate) carrier: Option<usize>,
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
        let mut carriers = Carriers::new();
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
            lamps: scene
                .lights
                .iter()
                .map(|light| lamp(light, &carriers))
                .collect(),
        }
    }
}

/// Numbers of the planes, spheres and quadrics that objects lie on.
type Carriers = HashMap<(u8, Vec<RBig>), usize>;

/// What is the same for shapes on the same plane, sphere or quadric, and for no others; but a quadric is no sphere.
fn carrier(shape: &Shape) -> (u8, Vec<RBig>) {
    let exact = |v: DVec3| v.to_array().map(|c| RBig::try_from(c).expect("finite"));
    match *shape {
        Shape::Sphere { center, radius } => {
            let [x, y, z] = exact(center);
            let radius = RBig::try_from(radius).expect("finite");
            (1, vec![x, y, z, radius])
        }
        Shape::Plane { normal, point, .. } => {
            let ([a, b, c], [x, y, z]) = (exact(normal), exact(point));
            let offset = &a * x + &b * y + &c * z;
            let numbers = [a, b, c, offset];
            let first = numbers.iter().find(|n| !n.is_zero()).cloned();
            let first = first.expect("a normal is not zero");
            (0, numbers.map(|n| n / &first).to_vec())
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
            (0, numbers.map(|n| n / &first).to_vec())
        }
        Shape::Quadric(scene::Quadric { coefficients, .. }) => {
            let numbers = coefficients.map(|c| RBig::try_from(c).expect("finite"));
            let first = numbers.iter().find(|n| !n.is_zero()).cloned();
            let first = first.expect("of A to I one is not zero");
            let [a, b, c, d, e, f, rest @ ..] = numbers.map(|n| n / &first);
            if [&a, &b, &c, &d, &e, &f].iter().all(|n| n.is_zero()) {
                (0, rest.to_vec())
            } else {
                (2, [vec![a, b, c, d, e, f], rest.to_vec()].concat())
            }
        }
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
            borders: Vec::new(),
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
                borders: Vec::new(),
                form: Form::Plane {
                    normal,
                    point: Vector::from_f64(vertices[0]),
                    axis,
                },
            }
        }
        Shape::Quadric(quadric) => Body {
            object,
            carrier,
            form: quadric_form(&quadric),
            sides: None,
            borders: borders(&quadric),
        },
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
                borders: Vec::new(),
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

/// A quadric's surface; one without squares is a plane.
fn quadric_form(quadric: &scene::Quadric) -> Form {
    let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients;
    if [a, b, c, d, e, f] != [0.0; 6] {
        return Form::Quadric(Quadric::new(&quadric.coefficients));
    }
    let normal = Vector::from_f64(DVec3::new(g, h, i));
    // N·J/(N·N) is on it.
    let part = &Real::from_f64(j) / &normal.dot(&normal);
    let mut coordinates = (0..3).filter(|i| quadric.coefficients[6 + i] != 0.0);
    let axis = coordinates.next().filter(|_| coordinates.next().is_none());
    Form::Plane {
        point: normal.scale(&part).settled(),
        normal,
        axis,
    }
}

/// Where a quadric is cut.
fn borders(quadric: &scene::Quadric) -> Vec<(usize, bool, Real)> {
    let sides = [(true, quadric.lower), (false, quadric.upper)];
    let given = sides
        .into_iter()
        .filter_map(|(least, side)| Some((least, side?)));
    given
        .flat_map(|(least, side)| [0, 1, 2].map(|axis| (axis, least, Real::from_f64(side[axis]))))
        .collect()
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

fn lamp(light: &Light, carriers: &Carriers) -> Lamp {
    let Light {
        name: _,
        location,
        emissivity,
        beam,
    } = *light;
    let (cone, slide) = match beam {
        Beam::Everywhere => (None, None),
        Beam::Cone(cone) => (Some(cone), None),
        Beam::Picture(picture) => (None, Some(slide(&picture, carriers))),
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
        slide,
        location,
    }
}

fn slide(picture: &ProjectorPicture, carriers: &Carriers) -> Slide {
    let ProjectorPicture {
        normal,
        point,
        rectangle,
        texture,
        mode,
    } = *picture;
    let plane = Shape::Plane {
        normal,
        point,
        extent: Extent::Unbounded,
    };
    let normal = Vector::from_f64(normal);
    Slide {
        sides: sides(&normal, rectangle.xdir, rectangle.dimensions),
        normal,
        point: Vector::from_f64(point),
        texture,
        mode,
        carrier: carriers.get(&carrier(&plane)).copied(),
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

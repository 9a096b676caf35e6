//! A quadric, as all rays see it: its equation over positions, exactly, then rounded once.
//!
//! With X = V + σP the left side less the right side is
//!
//! ```text
//! A P.x² + B P.y² + C P.z² + D P.x·P.y + E P.x·P.z + F P.y·P.z  +  slope·P  +  constant
//! ```
//!
//! in coefficients of its own, which a power of two brings near 1. The viewpoint is the origin, so the constant is what
//! the left side is there, and whether it is 0 is known.

use std::cmp::Ordering;
use std::collections::HashMap;

use dashu_base::BitTest as _;
use dashu_ratio::RBig;
use glam::DVec3;

use crate::real::rational::{Ratio, dot, is_zero, power_of_two, ratio, ratio3};
use crate::real::{Bounded, Real, V3};
use crate::scene::{self, Scene, Shape};

/// A quadric that a ray can hit. Positions are from the viewpoint, in units of 2^scale.
#[derive(Debug, Clone)]
pub struct Quadric<R> {
    /// Index of the object.
    pub object: usize,
    /// The coefficients of P.x², P.y², P.z², P.x·P.y, P.x·P.z and P.y·P.z; None if all are 0.
    pub square: Option<[R; 6]>,
    /// The coefficients of P.
    pub slope: V3<R>,
    /// The left side at the viewpoint.
    pub constant: R,
    /// Its sign, exactly.
    pub side: Ordering,
    /// For each axis the least and the greatest coordinate of a hit, where it has to be asked.
    pub borders: [[Option<R>; 2]; 3],
    /// The surfaces of other objects that have the same points, borders aside, if they are curved: a ray that left one
    /// of them starts on this one.
    pub same_points: Vec<u32>,
    /// Lights that lie on the surface exactly, borders aside; ascending.
    pub lights_on_surface: Vec<usize>,
}

/// What a scene says of a quadric.
#[derive(Debug, Clone, Copy)]
pub(super) struct Equation<'a> {
    /// A to J.
    coefficients: &'a [f64; 10],
    /// The least coordinates, if it is cut.
    lower: Option<DVec3>,
    /// The greatest coordinates, if it is cut.
    upper: Option<DVec3>,
}

/// More than the roundings of a distance, which is made of sums of products of few numbers, none of them negative.
const SLACK: f64 = 1.0 + 1e-9;

impl<R: Real> Quadric<R> {
    /// Prepares the quadrics of a scene that a ray can hit, in file order.
    pub fn all(
        scene: &Scene,
        scale: i32,
        screen_tolerance: f64,
        hidden: &[bool],
        groups: &[u32],
    ) -> Vec<Self> {
        if !scene
            .objects
            .iter()
            .any(|object| Equation::of(&object.shape).is_some())
        {
            return Vec::new();
        }
        let mut same_points = same_points(scene, groups);
        let objects = scene
            .objects
            .iter()
            .enumerate()
            .filter(|(index, _)| !hidden[*index]);
        let of = |(index, object): (usize, &scene::Object)| {
            let equation = Equation::of(&object.shape)?;
            Self::new(
                scene,
                scale,
                index,
                &equation,
                screen_tolerance,
                std::mem::take(&mut same_points[index]),
            )
        };
        objects.filter_map(of).collect()
    }

    /// Prepares a quadric; None if no ray can hit it: all of it is before the screen, or it lies in a plane that its
    /// borders leave out.
    fn new(
        scene: &Scene,
        scale: i32,
        object: usize,
        equation: &Equation<'_>,
        screen_tolerance: f64,
        same_points: Vec<u32>,
    ) -> Option<Self> {
        let camera = &scene.camera;
        let moved = Moved::new(camera, scale, equation.coefficients);
        let mut borders = equation.borders(screen_tolerance);
        if let Some((axis, place)) = equation.fixed_coordinate() {
            let [least, greatest] = borders[axis].map(|border| border.map(ratio));
            let left_out = least.is_some_and(|least| place < least)
                || greatest.is_some_and(|greatest| place > greatest);
            if left_out {
                return None;
            }
            borders[axis] = [None; 2];
        }
        let empty = |[least, greatest]: [Option<f64>; 2]| matches!((least, greatest), (Some(a), Some(b)) if a > b);
        if borders.into_iter().any(empty) {
            return None;
        }
        let viewpoint = camera.viewpoint.to_array();
        let unit = power_of_two(scale);
        let borders = [0, 1, 2].map(|axis| {
            borders[axis].map(|border| {
                border.map(|at| R::ratio(&((ratio(at) - ratio(viewpoint[axis])) / &unit)))
            })
        });
        let on = |light: &scene::Light| is_zero(&equation.at(light.location));
        let lights = scene.lights.iter().enumerate();
        Some(Self {
            object,
            square: moved
                .square
                .iter()
                .any(|c| !is_zero(c))
                .then(|| moved.square.each_ref().map(R::ratio)),
            slope: V3::new(
                R::ratio(&moved.slope[0]),
                R::ratio(&moved.slope[1]),
                R::ratio(&moved.slope[2]),
            ),
            constant: R::ratio(&moved.constant),
            side: moved.constant.cmp(&Ratio::ZERO),
            borders,
            same_points,
            lights_on_surface: lights.filter(|(_, l)| on(l)).map(|(i, _)| i).collect(),
        })
    }

    /// The left side's part of the second degree at `v`, and half its gradient there.
    pub fn squared(square: &[R; 6], v: V3<R>) -> (R, V3<R>) {
        let [a, b, c, d, e, f] = *square;
        let half = |x: R| x.times(0.5);
        let gradient = V3::new(
            a * v.x + half(d * v.y + e * v.z),
            b * v.y + half(d * v.x + f * v.z),
            c * v.z + half(e * v.x + f * v.y),
        );
        (gradient.dot(v), gradient)
    }

    /// Whether it is a plane in which the light of this number lies.
    pub fn is_plane_with(&self, light: usize) -> bool {
        self.square.is_none() && self.lights_on_surface.binary_search(&light).is_ok()
    }

    /// How far the surface is from a position at least.
    ///
    /// v away the left side has changed by at most |gradient|·|v| + |M|·|v|², M its matrix, and that is as much as
    /// there is of it not before 2·|left side|/(|gradient| + √(|gradient|² + 4·|M|·|left side|)).
    pub(super) fn distance(&self, from: V3<R>) -> f64 {
        let mut left = self.slope.dot(from) + self.constant;
        let mut matrix = 0.0;
        if let Some(square) = &self.square {
            left = left + Self::squared(square, from).0;
            let [a, b, c, d, e, f] = square.map(Real::to_f64);
            let both = (d * d + e * e + f * f) / 2.0;
            matrix = (a * a + b * b + c * c + both).sqrt() * SLACK;
        }
        let Bounded { value, error } = left.enclosure();
        let left = value.abs() - error * Bounded::GROW;
        let [x, y, z] = {
            let gradient = self.gradient(from);
            [gradient.x, gradient.y, gradient.z].map(|c| {
                let Bounded { value, error } = c.enclosure();
                value.abs() + error * Bounded::GROW
            })
        };
        let gradient = (x * x + y * y + z * z).sqrt() * SLACK;
        let distance = 2.0 * left / (gradient + (gradient * gradient + 4.0 * matrix * left).sqrt());
        if left > 0.0 { distance / SLACK } else { 0.0 }
    }

    /// The gradient of the left side at a position, up to a positive factor.
    pub fn gradient(&self, position: V3<R>) -> V3<R> {
        match &self.square {
            None => self.slope,
            Some(square) => self.slope + Self::squared(square, position).1 * R::exact(2.0),
        }
    }
}

/// The equation over positions.
pub(super) struct Moved {
    pub(super) square: [Ratio; 6],
    pub(super) slope: [Ratio; 3],
    pub(super) constant: Ratio,
}

impl Moved {
    pub(super) fn new(camera: &scene::Camera, scale: i32, coefficients: &[f64; 10]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j] = coefficients.map(ratio);
        let [x, y, z] = ratio3(camera.viewpoint);
        let two = ratio(2.0);
        let slope = [
            &two * &a * &x + &d * &y + &e * &z + &g,
            &two * &b * &y + &d * &x + &f * &z + &h,
            &two * &c * &z + &e * &x + &f * &y + &i,
        ];
        let constant = &a * &x * &x
            + &b * &y * &y
            + &c * &z * &z
            + &d * &x * &y
            + &e * &x * &z
            + &f * &y * &z
            + &g * &x
            + &h * &y
            + &i * &z
            - j;
        let unit = power_of_two(scale);
        let square = [a, b, c, d, e, f].map(|c| c * &unit * &unit);
        let slope = slope.map(|c| c * &unit);
        // The largest coefficient of the surface's shape becomes one of size 1.
        let sizes = square.iter().chain(&slope).filter(|c| !is_zero(c));
        let largest = sizes.map(size).max().unwrap_or(0);
        let factor = power_of_two(-largest);
        Self {
            square: square.map(|c| c * &factor),
            slope: slope.map(|c| c * &factor),
            constant: constant * &factor,
        }
    }
}

/// About the exponent of a number that is not 0.
fn size(number: &Ratio) -> i32 {
    let bits = |n: usize| i32::try_from(n).unwrap_or(i32::MAX / 4);
    bits(number.numerator().bit_len()) - bits(number.denominator().bit_len())
}

impl<'a> Equation<'a> {
    /// Of a quadric.
    pub(super) fn of(shape: &'a Shape) -> Option<Self> {
        match shape {
            Shape::Quadric(scene::Quadric {
                coefficients,
                lower,
                upper,
            }) => Some(Self {
                coefficients,
                lower: *lower,
                upper: *upper,
            }),
            Shape::Plane { .. } | Shape::Sphere { .. } | Shape::Triangle(_) => None,
        }
    }

    /// The left side less the right side, exactly.
    fn at(&self, point: DVec3) -> Ratio {
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(ratio);
        let [x, y, z] = ratio3(point);
        (&a * &x + &d * &y + &e * &z + g) * &x + (&b * &y + &f * &z + h) * &y + (&c * &z + i) * &z
            - j
    }

    /// Whether it has no term of the second degree.
    fn is_flat(&self) -> bool {
        self.coefficients[..6].iter().all(|c| *c == 0.0)
    }

    /// If it is a plane perpendicular to an axis: which, and the coordinate that all its points share.
    fn fixed_coordinate(&self) -> Option<(usize, Ratio)> {
        let normal = &self.coefficients[6..9];
        let axis = (0..3).find(|&axis| normal[axis] != 0.0)?;
        let alone = self.is_flat() && (0..3).all(|i| i == axis || normal[i] == 0.0);
        alone.then(|| (axis, ratio(self.coefficients[9]) / ratio(normal[axis])))
    }

    /// The least and the greatest coordinate of a hit along each axis; H.z ≤ τ is one of them.
    fn borders(&self, screen_tolerance: f64) -> [[Option<f64>; 2]; 3] {
        let of = |side: Option<DVec3>, axis: usize| side.map(|side| side[axis]);
        let mut borders = [0, 1, 2].map(|axis| [of(self.lower, axis), of(self.upper, axis)]);
        let behind = borders[2][1].map_or(screen_tolerance, |upper| upper.min(screen_tolerance));
        borders[2][1] = Some(behind);
        borders
    }

    /// What is the same for equations that a factor takes to each other: the first coefficient that is not 0 is 1.
    fn key(&self) -> [RBig; 10] {
        let lead = self.coefficients.iter().find(|c| **c != 0.0);
        let lead = lead.map_or(Ratio::ONE, |lead| ratio(*lead));
        self.coefficients.map(|c| (ratio(c) / &lead).canonicalize())
    }

    /// The center and the squared radius of the sphere that it is, if it is one.
    fn sphere(&self) -> Option<([Ratio; 3], Ratio)> {
        let [a, b, c, d, e, f, g, h, i, j] = *self.coefficients;
        if a == 0.0 || a != b || a != c || [d, e, f] != [0.0; 3] {
            return None;
        }
        let center = [g, h, i].map(|slope| ratio(slope) / (ratio(-2.0) * ratio(a)));
        let square = ratio(j) / ratio(a) + dot(&center, &center);
        Some((center, square))
    }

    /// The plane that it is, as a normal and what that makes of its points, if it is one.
    pub(super) fn plane(&self) -> Option<([Ratio; 3], Ratio)> {
        let [.., g, h, i, j] = *self.coefficients;
        self.is_flat()
            .then(|| ([ratio(g), ratio(h), ratio(i)], ratio(j)))
    }
}

/// What a curved quadric's equation is known by, and what the sphere is known by that it may be.
type Keys = (Option<[RBig; 10]>, Option<[RBig; 4]>);

/// For each object the surfaces of others that have the same points as it, if it is a curved quadric.
pub(super) fn same_points(scene: &Scene, groups: &[u32]) -> Vec<Vec<u32>> {
    let mut curved: HashMap<[RBig; 10], Vec<u32>> = HashMap::new();
    let mut balls: HashMap<[RBig; 4], Vec<u32>> = HashMap::new();
    let mut keys: Vec<Keys> = Vec::new();
    for (object, &group) in scene.objects.iter().zip(groups) {
        let equation = Equation::of(&object.shape).filter(|equation| !equation.is_flat());
        let key = equation.map(|equation| equation.key());
        if let Some(key) = &key {
            curved.entry(key.clone()).or_default().push(group);
        }
        let ball = equation.and_then(|equation| equation.sphere());
        keys.push((key, ball.map(|(center, square)| sphere_key(center, square))));
    }
    if keys.iter().any(|(_, ball)| ball.is_some()) {
        for (object, &group) in scene.objects.iter().zip(groups) {
            if let Shape::Sphere { center, radius } = object.shape {
                let square = ratio(radius) * ratio(radius);
                let key = sphere_key(ratio3(center), square);
                balls.entry(key).or_default().push(group);
            }
        }
    }
    let of = |(keys, own): (&Keys, &u32)| {
        let (curve, ball) = keys;
        let quadrics = curve.as_ref().and_then(|key| curved.get(key));
        let spheres = ball.as_ref().and_then(|key| balls.get(key));
        let all = quadrics.into_iter().chain(spheres).flatten();
        all.copied().filter(|group| group != own).collect()
    };
    keys.iter().zip(groups).map(of).collect()
}

/// What is the same for equal spheres.
fn sphere_key([x, y, z]: [Ratio; 3], square: Ratio) -> [RBig; 4] {
    [x, y, z, square].map(Ratio::canonicalize)
}

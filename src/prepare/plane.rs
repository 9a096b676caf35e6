//! Planes as primary rays see them: 1/s is linear in the ray, and the z > τ rule is linear in the pixel.

use glam::DVec3;

use super::camera::{self, origin, over_pixels, step};
use super::extent::{Rectangle, along_sides};
use crate::real::Real;
use crate::real::rational::{
    Ratio, abs, dot, is_positive, is_zero, power_of_two, ratio, ratio3, root, sub,
};
use crate::scene;
use crate::settings::ViewParameters;

/// A plane that some pixel's ray can hit.
///
/// On the ray viewpoint + s·W the plane is met where 1/s = N·W / N·(Q − V), a linear form in W. The nearest of several
/// planes is the one of largest 1/s, with no division. The form's coefficients are quotients in which the length of the
/// normal and the choice of Q cancel: taken exactly and rounded once, they are the same numbers for the same plane,
/// however it is written, so that of coincident planes the first in the file wins.
#[derive(Debug, Clone)]
pub struct Plane<R> {
    /// Index of the object.
    pub object: usize,
    /// 1/s = inverse\[0\]·W.x + inverse\[1\]·W.y + inverse\[2\], as W.z is the same for all rays.
    pub inverse: [R; 3],
    /// Hit only where front\[0\]·x + front\[1\]·y + front\[2\] ≥ 0, with (x, y) the pixel: the rule H.z ≤ τ.
    /// None where that is so on the whole screen. The larger of the first two is ±1.
    pub front: Option<[R; 3]>,
    /// The same where it depends on x or on y alone.
    pub front_step: Option<Step>,
    /// Where it ends.
    pub sides: Sides<R>,
}

/// A border that runs along a column or a row of pixels, as an exact fact: inside is `pixel[axis] ≥ at`, or `≤ at`.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// 0 for x, 1 for y.
    pub axis: usize,
    /// Whether inside is from `at` upwards.
    pub rising: bool,
    /// The border, in pixels.
    pub at: Ratio,
}

impl Step {
    /// The border of `form ≥ 0` over (x, y, 1), if it is one.
    pub(super) fn of(form: &[Ratio; 3]) -> Option<Self> {
        let axis = match (is_zero(&form[0]), is_zero(&form[1])) {
            (false, true) => 0,
            (true, false) => 1,
            _ => return None,
        };
        Some(Self {
            axis,
            rising: is_positive(&form[axis]),
            at: -(&form[2] / &form[axis]),
        })
    }
}

/// The sides of a plane as primary rays see them.
#[derive(Debug, Clone)]
pub enum Sides<R> {
    /// There are none: the plane has no end.
    Unbounded,
    /// A rectangle is where two strips cross.
    Rectangle(Box<[Strip<R>; 2]>),
    /// A triangle is what is within three sides.
    Triangle(Box<[Side<R>; 3]>),
}

/// What lies on one side of a line.
#[derive(Debug, Clone)]
pub struct Side<R> {
    /// Coefficients over (W.x, W.y, 1) of a form that is ≥ 0 within.
    pub form: [R; 3],
    /// The same, where the line runs along a column or a row.
    pub step: Option<Step>,
}

/// What lies between two parallel sides, 0 ≤ p ≤ length: on the ray s·W, p/s is linear in the ray.
#[derive(Debug, Clone)]
pub struct Strip<R> {
    /// Coefficients of p/s over (W.x, W.y, 1).
    pub form: [R; 3],
    /// In units of 2^scale.
    pub length: R,
    /// The borders p ≥ 0 and p ≤ length, where they run along columns or rows.
    pub steps: [Option<Step>; 2],
}

impl<R: Real> Plane<R> {
    /// Prepares a plane; None if no ray through the screen can hit it.
    pub fn new(
        camera: &scene::Camera,
        view: ViewParameters,
        object: usize,
        normal: DVec3,
        point: DVec3,
        extent: &scene::Extent,
    ) -> Option<Self> {
        let n = ratio3(normal);
        let v = ratio3(camera.viewpoint);
        let k = dot(&n, &sub(&ratio3(point), &v));
        if is_zero(&k) {
            // The viewpoint lies on the plane: t = 0 or none at all, a miss either way.
            return None;
        }
        // 1/s over the world coordinates of the ray: N·W/k, W = (X − V.x, Y − V.y, −V.z).
        let a = &n[0] / &k;
        let b = &n[1] / &k;
        let c = -(&n[2] * &v[2]) / &k;
        let front = Front::new(camera, view, &a, &b, &c);
        if front.never {
            return None;
        }
        let scale = camera::exponent(camera.viewpoint.z);
        let unit = power_of_two(scale);
        let inverse = [
            R::ratio(&(&a * &unit)),
            R::ratio(&(&b * &unit)),
            R::ratio(&c),
        ];
        let sides = match extent {
            scene::Extent::Unbounded => Sides::Unbounded,
            scene::Extent::Rectangle(rectangle) => {
                let steps = side_steps(camera, normal, point, rectangle, &[&a, &b, &c]);
                let distance = R::ratio(&(&v[2] / &unit));
                let rectangle = Rectangle::new(camera, scale, normal, point, rectangle);
                let [first, second] = steps;
                let strip = |i, steps| Strip::new(&rectangle, i, &inverse, distance, steps);
                Sides::Rectangle(Box::new([strip(0, first), strip(1, second)]))
            }
        };
        Some(Self {
            object,
            inverse,
            front_step: if front.always {
                None
            } else {
                Step::of(&front.form)
            },
            front: (!front.always).then(|| front.form.map(|f| R::ratio(&f))),
            sides,
        })
    }
}

impl<R: Real> Strip<R> {
    /// The strip along side `i` of a rectangle; `inverse` is 1/s over (W.x, W.y, 1), and W.z is −`distance`.
    fn new(
        rectangle: &Rectangle<R>,
        i: usize,
        inverse: &[R; 3],
        distance: R,
        steps: [Option<Step>; 2],
    ) -> Self {
        let (row, origin) = (rectangle.rows[i], rectangle.origin[i]);
        Self {
            form: [
                row.x - origin * inverse[0],
                row.y - origin * inverse[1],
                -(row.z * distance) - origin * inverse[2],
            ],
            length: rectangle.dimensions[i],
            steps,
        }
    }
}

/// The sides of a rectangle that run along columns or rows; `inverse` is 1/s over (W.x, W.y, 1) in world units.
fn side_steps(
    camera: &scene::Camera,
    normal: DVec3,
    point: DVec3,
    rectangle: &scene::Rectangle,
    inverse: &[&Ratio; 3],
) -> [[Option<Step>; 2]; 2] {
    let v = ratio3(camera.viewpoint);
    let corner = sub(&ratio3(point), &v);
    let q = over_pixels(camera, &inverse.map(Clone::clone));
    let steps = |row: &[Ratio; 3], length: f64| {
        // |row| times p/s, and the same for length − p where |row| is rational.
        let offset = dot(row, &corner);
        let p = over_pixels(
            camera,
            &[
                &row[0] - &offset * inverse[0],
                &row[1] - &offset * inverse[1],
                -(&row[2] * &v[2]) - &offset * inverse[2],
            ],
        );
        let end = root(&dot(row, row)).and_then(|size| {
            let d = ratio(length) * size;
            Step::of(&[&d * &q[0] - &p[0], &d * &q[1] - &p[1], &d * &q[2] - &p[2]])
        });
        [Step::of(&p), end]
    };
    let [first, second] = along_sides(&ratio3(normal), &ratio3(rectangle.xdir));
    let lengths = rectangle.dimensions;
    [steps(&first, lengths.x), steps(&second, lengths.y)]
}

/// The rule H.z ≤ τ as a linear form over pixels that is ≥ 0 where it holds.
pub(super) struct Front {
    pub(super) form: [Ratio; 3],
    /// It holds on the whole screen.
    pub(super) always: bool,
    /// It holds nowhere on the screen, or the plane is met nowhere there.
    pub(super) never: bool,
}

impl Front {
    /// H.z = V.z·(1 − s) ≤ τ, with s > 0, is (V.z − τ)·(1/s) ≤ V.z.
    pub(super) fn new(
        camera: &scene::Camera,
        ViewParameters {
            screen_tolerance,
            margin,
        }: ViewParameters,
        a: &Ratio,
        b: &Ratio,
        c: &Ratio,
    ) -> Self {
        let [width, height] = camera.pixeldim;
        let (dx, dy) = (
            step(width, camera.worlddim.x),
            step(height, camera.worlddim.y),
        );
        let x0 = origin(width, camera.worlddim.x) - ratio(camera.viewpoint.x);
        let y0 = origin(height, camera.worlddim.y) - ratio(camera.viewpoint.y);
        // The coefficients of 1/s as a form over pixels.
        let per_x = a * &dx;
        let per_y = b * &dy;
        let constant = a * x0 + b * y0 + c;
        let vz = ratio(camera.viewpoint.z);
        let reach = &vz - ratio(screen_tolerance);
        let mut form = [
            -(&reach * &per_x),
            -(&reach * &per_y),
            vz - &reach * &constant,
        ];
        let at = |f: &[Ratio; 3], x: f64, y: f64| &f[0] * ratio(x) + &f[1] * ratio(y) + &f[2];
        let (right, top) = (
            f64::from(width - 1) + margin,
            f64::from(height - 1) + margin,
        );
        let corners = [
            (-margin, -margin),
            (right, -margin),
            (-margin, top),
            (right, top),
        ];
        let inverse = [per_x, per_y, constant];
        let always = corners.iter().all(|&(x, y)| at(&form, x, y) >= Ratio::ZERO);
        let never = corners.iter().all(|&(x, y)| at(&form, x, y) < Ratio::ZERO)
            || corners
                .iter()
                .all(|&(x, y)| !is_positive(&at(&inverse, x, y)));
        // Dividing by the larger coefficient leaves the border's own position: an edge that runs through a pixel
        // column exactly stays there exactly, in f32 too.
        let (fx, fy) = (abs(form[0].clone()), abs(form[1].clone()));
        let larger = if fx > fy { fx } else { fy };
        if is_positive(&larger) {
            form = form.map(|f| f / &larger);
        }
        Self {
            form,
            always,
            never,
        }
    }
}

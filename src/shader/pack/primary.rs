//! What primary rays can hit, as forms over the pixel with literal error bounds: planes, rectangles, spheres.

use crate::prepare::camera::ANCHOR_LIMIT;
use crate::prepare::plane::{Side, Step, Strip};
use crate::prepare::{self, Camera};
use crate::real::{Bounded, Real as _, V3};
use crate::shader::bounds::{
    FLOOR, Form, GROWTH, LEAST_NORMAL, OUTLINE_ROUNDINGS, OUTLINE_SHARE, Screen, linear, quadratic,
    step, upper_bound,
};
use crate::shader::format::{Format, Known as _};
use crate::shader::records::wide::{Plane, Polygon, Sphere, SphereHit};

fn number<F: Format>(value: f64) -> F::Number {
    F::Number::exact(value)
}

/// A form over (W.x, W.y, 1) as one over (X, Y, 1), the pixel from the camera's anchor.
fn over_pixels<F: Format>(camera: &Camera<F::Number>, form: &[F::Number; 3]) -> [F::Number; 3] {
    [
        form[0] * camera.step[0],
        form[1] * camera.step[1],
        form[0] * camera.offset[0] + form[1] * camera.offset[1] + form[2],
    ]
}

/// The z ≤ τ rule of a plane; where it always holds, a form that is 1.
fn front<F: Format>(
    camera: &Camera<F::Number>,
    plane: &prepare::Plane<F::Number>,
    screen: &Screen,
) -> Form<3> {
    let Some(form) = plane.front else {
        return ([0.0, 0.0, 1.0], 0.0);
    };
    if let Some(exact) = plane
        .front_step
        .as_ref()
        .and_then(|s| step(s, camera.anchor, screen))
    {
        return exact;
    }
    // It is given over (x, y, 1).
    let [x, y] = camera.anchor.map(|a| number::<F>(f64::from(a)));
    let moved = [form[0], form[1], form[2] + form[0] * x + form[1] * y];
    linear::<F>(moved, screen.reach(camera.anchor), screen)
}

pub(super) fn plane<F: Format>(
    camera: &Camera<F::Number>,
    plane: &prepare::Plane<F::Number>,
    screen: &Screen,
    group: u32,
) -> Plane {
    let reach = screen.reach(camera.anchor);
    let (inverse, inverse_error) =
        linear::<F>(over_pixels::<F>(camera, &plane.inverse), reach, screen);
    let (front, front_error) = front::<F>(camera, plane, screen);
    Plane {
        inverse,
        object: plane.object as u32,
        front,
        group,
        inverse_error,
        front_error,
        pad: Default::default(),
    }
}

/// A side as a form over the pixel, exactly where it runs along a column or a row.
fn side<F: Format>(
    camera: &Camera<F::Number>,
    form: &[F::Number; 3],
    exact: Option<&Step>,
    screen: &Screen,
) -> Form<3> {
    exact
        .and_then(|s| step(s, camera.anchor, screen))
        .unwrap_or_else(|| {
            linear::<F>(
                over_pixels::<F>(camera, form),
                screen.reach(camera.anchor),
                screen,
            )
        })
}

/// The four sides of a rectangle.
pub(super) fn rectangle<F: Format>(
    camera: &Camera<F::Number>,
    plane: &prepare::Plane<F::Number>,
    strips: &[Strip<F::Number>; 2],
    screen: &Screen,
) -> [Form<3>; 4] {
    let q = plane.inverse;
    let [[a, c], [b, d]] = strips.each_ref().map(|strip| {
        let (p, [start, end]) = (strip.form, &strip.steps);
        let rest = [0, 1, 2].map(|k| strip.length * q[k] - p[k]);
        [(p, start), (rest, end)]
            .map(|(form, step)| side::<F>(camera, &form, step.as_ref(), screen))
    });
    [a, b, c, d]
}

/// The three sides of a triangle, and a fourth that everything is within.
pub(super) fn triangle<F: Format>(
    camera: &Camera<F::Number>,
    sides: &[Side<F::Number>; 3],
    screen: &Screen,
) -> [Form<3>; 4] {
    let [a, b, c] = sides
        .each_ref()
        .map(|s| side::<F>(camera, &s.form, s.step.as_ref(), screen));
    [a, b, c, ([0.0, 0.0, 1.0], 0.0)]
}

/// The record of a plane with these sides; its hits' 1/s are at most `max_inverse`, where that is asked.
pub(super) fn polygon(base: Plane, [a, b, c, d]: [Form<3>; 4], max_inverse: f64) -> Polygon {
    Polygon {
        inverse: base.inverse,
        object: base.object,
        front: base.front,
        group: base.group,
        side_0: a.0,
        inverse_error: base.inverse_error,
        side_1: b.0,
        front_error: base.front_error,
        side_2: c.0,
        max_inverse,
        side_3: d.0,
        pad_1: Default::default(),
        side_errors: [a.1, b.1, c.1, d.1],
    }
}

/// A sphere's outline as a conic: the discriminant over (X², XY, Y², X, Y, 1) from `anchor`, and W and e·W over (X, Y,
/// 1).
struct Outline<F: Format> {
    anchor: [i32; 2],
    disc: [F::Number; 6],
    along: [F::Number; 3],
    /// W at the anchor.
    w: V3<F::Number>,
    /// The largest |X| and |Y| at which the sphere can be hit, or at which a pixel is.
    reach: [f64; 2],
}

/// W at a pixel.
fn ray<F: Format>(camera: &Camera<F::Number>, pixel: [i32; 2]) -> V3<F::Number> {
    let axis = |i: usize| {
        number::<F>(f64::from(pixel[i] - camera.anchor[i])) * camera.step[i] + camera.offset[i]
    };
    V3::new(axis(0), axis(1), -camera.distance)
}

fn along<F: Format>(
    camera: &Camera<F::Number>,
    e: V3<F::Number>,
    w: V3<F::Number>,
) -> [F::Number; 3] {
    [e.x * camera.step[0], e.y * camera.step[1], e.dot(w)]
}

/// disc = (e·W)² − κ²·W·W, from the camera's anchor.
fn wide<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
    screen: &Screen,
) -> Outline<F> {
    let w = ray::<F>(camera, camera.anchor);
    let [a, b, c] = along::<F>(camera, sphere.toward, w);
    let [sx, sy] = camera.step;
    let k = sphere.kappa2;
    let two = number::<F>(2.0);
    Outline {
        anchor: camera.anchor,
        disc: [
            a * a - k * sx * sx,
            two * a * b,
            b * b - k * sy * sy,
            two * (a * c - k * sx * w.x),
            two * (b * c - k * sy * w.y),
            c * c - k * w.dot(w),
        ],
        along: [a, b, c],
        w,
        reach: screen.reach(camera.anchor),
    }
}

/// disc = ρ²·W·W − e_z²·F::U·F::U − (e_x·U.y − e_y·U.x)², F::U = W − W_c, from the pixel `anchor`, at which F::U is
/// `u`.
fn small<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
    anchor: [i32; 2],
    u: [F::Number; 2],
) -> [F::Number; 6] {
    let w = ray::<F>(camera, anchor);
    let e = sphere.toward;
    let [sx, sy] = camera.step;
    let (rho2, z2) = (sphere.rho2, e.z * e.z);
    let turn = e.x * u[1] - e.y * u[0];
    let two = number::<F>(2.0);
    [
        sx * sx * (rho2 - z2 - e.y * e.y),
        two * sx * sy * e.x * e.y,
        sy * sy * (rho2 - z2 - e.x * e.x),
        two * sx * (rho2 * w.x - z2 * u[0] + e.y * turn),
        two * sy * (rho2 * w.y - z2 * u[1] - e.x * turn),
        rho2 * w.dot(w) - z2 * (u[0] * u[0] + u[1] * u[1]) - turn * turn,
    ]
}

/// The outline of a sphere that is seen as an ellipse, from a pixel next to its middle.
fn ellipse<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
) -> Option<Outline<F>> {
    let projected = sphere.projected.as_ref()?;
    let disc = small::<F>(camera, sphere, projected.anchor, projected.offset);
    let [a, b, c, d, e, _] = disc.map(|c| c.nearest());
    let determinant = 4.0 * a * c - b * b;
    if !(a < 0.0 && determinant > 0.0) {
        return None;
    }
    let middle = [
        (b * e - 2.0 * c * d) / determinant,
        (b * d - 2.0 * a * e) / determinant,
    ];
    let shift = middle.map(f64::round);
    let place = [0, 1].map(|i| f64::from(projected.anchor[i]) + shift[i]);
    if !place.iter().all(|p| p.abs() <= ANCHOR_LIMIT) {
        return None;
    }
    let anchor = place.map(|p| p as i32);
    let u = [0, 1].map(|i| projected.offset[i] + number::<F>(shift[i]) * camera.step[i]);
    let disc = small::<F>(camera, sphere, anchor, u);
    // The ellipse's box and a little more. With S = |a|X² + |c|Y² and μ = 1 − |b|/√(4ac) the form is at most
    // |f| + L√S − μS, which is below −δS from S = S₀ on; and all its terms together are below 3S there.
    let size = disc.map(|c| c.nearest().abs());
    let [a, b, c, d, e, f] = size;
    let mu = 1.0 - b / (2.0 * (a * c).sqrt());
    let slope = (d * d / a + e * e / c).sqrt();
    let delta = OUTLINE_SHARE * mu;
    let root = (slope + (slope * slope + 4.0 * (mu - delta) * f).sqrt()) / (2.0 * (mu - delta));
    // The reach is at least a pixel, since the bounds of coordinates between pixels assume that.
    let reach = [root / a.sqrt(), root / c.sqrt()].map(|r| (r * Bounded::GROW).max(1.0));
    let [x, y] = reach;
    let most = [x * x, x * y, y * y, x, y, 1.0];
    let terms: f64 = most.iter().zip(&size).map(|(m, c)| m * c).sum();
    // What the bound of the form has beside its roundings: errors of the coefficients, and what is flushed.
    let rest: f64 = most
        .iter()
        .zip(&disc)
        .map(|(m, c)| m * (c.off() + OUTLINE_ROUNDINGS * LEAST_NORMAL))
        .sum();
    let w = ray::<F>(camera, anchor);
    // Then no pixel outside the box is taken for one that may be hit (docs/NUMERICS.md).
    (delta * root * root > OUTLINE_ROUNDINGS * F::U * terms + GROWTH * (rest + FLOOR)
        && terms.is_finite())
    .then(|| Outline {
        anchor,
        disc,
        along: along::<F>(camera, sphere.toward, w),
        w,
        reach,
    })
}

fn outline<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
    screen: &Screen,
) -> Outline<F> {
    ellipse::<F>(camera, sphere).unwrap_or_else(|| wide::<F>(camera, sphere, screen))
}

/// The record of a sphere; its hits' 1/s are at most `max_inverse`.
pub(super) fn sphere<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
    screen: &Screen,
    max_inverse: f64,
) -> Sphere {
    let outline = outline::<F>(camera, sphere, screen);
    let (disc, disc_error) = quadratic::<F>(outline.disc, outline.reach, screen);
    let (along, along_error) = linear::<F>(outline.along, outline.reach, screen);
    Sphere {
        along,
        gain: sphere.gain.nearest(),
        square: [disc[0], disc[1], disc[2]],
        object: sphere.object as u32,
        affine: [disc[3], disc[4], disc[5]],
        along_error,
        anchor: outline.anchor,
        disc_error,
        max_inverse,
    }
}

/// The record of the hits on a sphere.
pub(super) fn sphere_hit<F: Format>(
    camera: &Camera<F::Number>,
    sphere: &prepare::Sphere<F::Number>,
    screen: &Screen,
) -> SphereHit {
    let outline = outline::<F>(camera, sphere, screen);
    // (H − C)/(r·s) = (W − gain·along·C)/r − gain·C/r·√disc.
    let radius = sphere.rho2.sqrt() * sphere.distance;
    let inverse_radius = number::<F>(1.0) / radius;
    let center = sphere.toward * (sphere.gain * sphere.distance * inverse_radius);
    let part = |axis: usize| {
        let mut form = outline.along.map(|c| -(c * center.axis(axis)));
        if axis < 2 {
            form[axis] = form[axis] + camera.step[axis] * inverse_radius;
        }
        form[2] = form[2] + outline.w.axis(axis) * inverse_radius;
        linear::<F>(form, outline.reach, screen)
    };
    let (x, y, z) = (part(0), part(1), part(2));
    let error = [x.1, y.1, z.1];
    SphereHit {
        form_x: x.0,
        form_error: F::round_up(error.iter().map(|e| e * e).sum::<f64>().sqrt() * Bounded::GROW),
        form_y: y.0,
        center_size: F::round_up(upper_bound(center.dot(center).sqrt())),
        form_z: z.0,
        pad_0: Default::default(),
        center: super::nearest(center),
        pad_1: Default::default(),
    }
}

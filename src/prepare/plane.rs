//! Planes as primary rays see them: 1/s is linear in the ray, and the z > τ rule is linear in the pixel.

use glam::DVec3;

use super::camera::{origin, step};
use super::exact::{Ratio, abs, dot, is_positive, is_zero, power_of_two, ratio, ratio3, sub};
use crate::real::Real;
use crate::scene;

/// A plane that some pixel's ray can hit.
///
/// On the ray viewpoint + s·W the plane is met where 1/s = N·W / N·(Q − V), a linear form in W. The nearest of several
/// planes is the one of largest 1/s, with no division. The form's coefficients are quotients in which the length of the
/// normal and the choice of Q cancel: taken exactly and rounded once, they are the same numbers for the same plane,
/// however it is written, so that of coincident planes the first in the file wins.
#[derive(Debug, Clone, Copy)]
pub struct Plane<R> {
    /// Index of the object.
    pub object: usize,
    /// 1/s = inverse\[0\]·W.x + inverse\[1\]·W.y + inverse\[2\], as W.z is the same for all rays.
    pub inverse: [R; 3],
    /// Hit only where front\[0\]·x + front\[1\]·y + front\[2\] ≥ 0, with (x, y) the pixel: the rule H.z ≤ τ.
    /// None where that is so on the whole screen. The larger of the first two is ±1.
    pub front: Option<[R; 3]>,
}

impl<R: Real> Plane<R> {
    /// Prepares a plane; None if no ray through the screen can hit it.
    pub fn new(
        camera: &scene::Camera,
        screen_tolerance: f64,
        object: usize,
        normal: DVec3,
        point: DVec3,
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
        let front = Front::new(camera, screen_tolerance, &a, &b, &c);
        if front.never {
            return None;
        }
        let unit = power_of_two(super::camera::exponent(camera.viewpoint.z));
        Some(Self {
            object,
            inverse: [R::ratio(&(&a * &unit)), R::ratio(&(&b * &unit)), R::ratio(&c)],
            front: (!front.always).then(|| front.form.map(|f| R::ratio(&f))),
        })
    }
}

/// The rule H.z ≤ τ as a linear form over pixels that is ≥ 0 where it holds.
struct Front {
    form: [Ratio; 3],
    always: bool,
    never: bool,
}

impl Front {
    /// H.z = V.z·(1 − s) ≤ τ, with s > 0, is (V.z − τ)·(1/s) ≤ V.z.
    fn new(camera: &scene::Camera, screen_tolerance: f64, a: &Ratio, b: &Ratio, c: &Ratio) -> Self {
        let [width, height] = camera.pixeldim;
        let (dx, dy) = (step(width, camera.worlddim.x), step(height, camera.worlddim.y));
        let x0 = origin(width, camera.worlddim.x) - ratio(camera.viewpoint.x);
        let y0 = origin(height, camera.worlddim.y) - ratio(camera.viewpoint.y);
        // 1/s over pixels.
        let per_x = a * &dx;
        let per_y = b * &dy;
        let constant = a * x0 + b * y0 + c;
        let vz = ratio(camera.viewpoint.z);
        let reach = &vz - ratio(screen_tolerance);
        let mut form = [-(&reach * &per_x), -(&reach * &per_y), vz - &reach * &constant];
        let at = |f: &[Ratio; 3], x: u32, y: u32| {
            &f[0] * ratio(f64::from(x)) + &f[1] * ratio(f64::from(y)) + &f[2]
        };
        let corners = [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)];
        let inverse = [per_x, per_y, constant];
        let always = corners.iter().all(|&(x, y)| at(&form, x, y) >= Ratio::ZERO);
        let never = corners.iter().all(|&(x, y)| at(&form, x, y) < Ratio::ZERO)
            || corners.iter().all(|&(x, y)| !is_positive(&at(&inverse, x, y)));
        // Dividing by the larger coefficient leaves the border's own position: an edge that runs through a pixel
        // column exactly stays there exactly, in f32 too.
        let (fx, fy) = (abs(form[0].clone()), abs(form[1].clone()));
        let larger = if fx > fy { fx } else { fy };
        if is_positive(&larger) {
            form = form.map(|f| f / &larger);
        }
        Self { form, always, never }
    }
}

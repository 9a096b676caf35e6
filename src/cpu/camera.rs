//! From a pixel to its ray, from a colour to its bytes. Referee of `shaders/camera.wgsl`.

use crate::prepare::Camera;
use crate::real::rational::two_to;
use crate::real::{Real, Undecided, V3};

/// A primary ray: base viewpoint (the origin), direction W through the screen, not of unit length.
#[derive(Debug, Clone, Copy)]
pub struct Ray<R> {
    /// The pixel, (0, 0) at the bottom left; with a fraction between pixels.
    pub pixel: [f64; 2],
    /// From the viewpoint to the world point of the pixel, in units of 2^scale.
    pub w: V3<R>,
    /// W·W.
    pub w2: R,
}

/// The ray through pixel (x, y).
#[inline]
pub fn camera_getdir<R: Real>(camera: &Camera<R>, x: f64, y: f64) -> Ray<R> {
    let axis = |i: usize, at: f64| steps_from(camera, i, at, camera.anchor[i]) + camera.offset[i];
    let w = V3::new(axis(0, x), axis(1, y), -camera.distance);
    Ray {
        pixel: [x, y],
        w,
        w2: w.dot(w),
    }
}

/// How far the place `at` is from pixel `anchor` along an axis, in units of 2^scale, with nothing rounded on the way.
#[inline]
pub(super) fn steps_from<R: Real>(camera: &Camera<R>, axis: usize, at: f64, anchor: i32) -> R {
    let anchor = f64::from(anchor);
    let pixels = at - anchor;
    // What the difference rounded off, exactly (Knuth's TwoSum). A whole pixel loses nothing, nor one with the hash's
    // ten bits; the course's places have 53, and lose some where the anchor is farther from them than they are from 0.
    let back = pixels - at;
    let rest = (at - (pixels - back)) - (anchor + back);
    let steps = camera.step[axis].times(pixels);
    if rest == 0.0 {
        steps
    } else {
        steps + camera.step[axis].times(rest)
    }
}

/// The factor from a reflectivity to a pixel value: 1/t, the inverse of the distance s·|W| in world units.
#[inline]
pub fn inverse_distance<R: Real>(camera: &Camera<R>, ray: &Ray<R>, inverse: R) -> R {
    (inverse / ray.w2.sqrt()).times(two_to(-camera.scale))
}

/// The bytes of a pixel: floor(min(255, max(0, 255·v))).
#[inline]
pub fn camera_setpix<R: Real>(value: V3<R>) -> Result<[u8; 3], Undecided> {
    // Reflectivities are not negative, so neither is v.
    Ok([value.x.byte()?, value.y.byte()?, value.z.byte()?])
}

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
    let axis = |i: usize, at: f64| {
        // Exact: a pixel, with the jitter's ten bits, and a whole number.
        camera.step[i].times(at - f64::from(camera.anchor[i])) + camera.offset[i]
    };
    let w = V3::new(axis(0, x), axis(1, y), -camera.distance);
    Ray {
        pixel: [x, y],
        w,
        w2: w.dot(w),
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

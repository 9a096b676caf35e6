//! From pixels to rays: the world point of pixel (x, y) is worlddim · (x, y) / (pixeldim − 1), z = 0 (docs/SCENE.md,
//! "Rays").

use crate::real::Real;
use crate::real::rational::{Ratio, power_of_two, ratio};
use crate::scene;

/// How a pixel becomes a ray: its direction W = world point − viewpoint, in units of 2^scale, not of unit length.
///
/// `W.x = (x − anchor) · step + offset`, where `anchor` is the pixel next to the viewpoint: so W.x keeps its relative
/// accuracy where it is small, in f32 too. `W.z = −distance` for every pixel.
#[derive(Debug, Clone, Copy)]
pub struct Camera<R> {
    /// Lengths of the prepared scene are in units of 2^scale.
    pub scale: i32,
    /// The pixel column and row next to the viewpoint, at most 2²² away.
    pub anchor: [i32; 2],
    /// World units from one pixel to the next, in units of 2^scale; 0 with one pixel in that direction.
    pub step: [R; 2],
    /// W.x at column `anchor[0]` and W.y at row `anchor[1]`.
    pub offset: [R; 2],
    /// The viewpoint's distance from the screen, in [1, 2).
    pub distance: R,
}

/// Pixels farther from the screen's corner than this are of no use as anchors, of the camera or of a sphere: f32 holds
/// integers to 2²⁴.
pub const ANCHOR_LIMIT: f64 = 4_194_304.0;

impl<R: Real> Camera<R> {
    /// Prepares the camera.
    pub fn new(camera: &scene::Camera) -> Self {
        let scale = exponent(camera.viewpoint.z);
        let axis = |pixels: u32, world: f64, view: f64| {
            let world_step = step(pixels, world);
            let anchor = if pixels > 1 {
                (view / world_step.to_f64().value())
                    .round()
                    .clamp(-ANCHOR_LIMIT, ANCHOR_LIMIT)
            } else {
                0.0
            };
            let offset = origin(pixels, world) + ratio(anchor) * &world_step - ratio(view);
            let unit = power_of_two(scale);
            (
                anchor as i32,
                R::ratio(&(world_step / &unit)),
                R::ratio(&(offset / &unit)),
            )
        };
        let (ax, sx, ox) = axis(camera.pixeldim[0], camera.worlddim.x, camera.viewpoint.x);
        let (ay, sy, oy) = axis(camera.pixeldim[1], camera.worlddim.y, camera.viewpoint.y);
        Self {
            scale,
            anchor: [ax, ay],
            step: [sx, sy],
            offset: [ox, oy],
            distance: R::ratio(&(ratio(camera.viewpoint.z) / power_of_two(scale))),
        }
    }
}

/// World units from one pixel to the next: worlddim / (pixeldim − 1), and 0 with a single pixel.
pub fn step(pixels: u32, world: f64) -> Ratio {
    if pixels > 1 {
        ratio(world) / ratio(f64::from(pixels - 1))
    } else {
        Ratio::ZERO
    }
}

/// The world coordinate of pixel 0: 0, and the middle of the side with a single pixel.
pub fn origin(pixels: u32, world: f64) -> Ratio {
    if pixels > 1 {
        Ratio::ZERO
    } else {
        ratio(world) / ratio(2.0)
    }
}

/// A form over (W.x, W.y, 1), W in world units, as one over (x, y, 1), the pixel.
pub fn over_pixels(camera: &scene::Camera, form: &[Ratio; 3]) -> [Ratio; 3] {
    let sides = [camera.worlddim.x, camera.worlddim.y];
    let view = [camera.viewpoint.x, camera.viewpoint.y];
    let steps = [0, 1].map(|i| step(camera.pixeldim[i], sides[i]));
    let offsets = [0, 1].map(|i| origin(camera.pixeldim[i], sides[i]) - ratio(view[i]));
    [
        &form[0] * &steps[0],
        &form[1] * &steps[1],
        &form[0] * &offsets[0] + &form[1] * &offsets[1] + &form[2],
    ]
}

/// The exponent of the power of two next below `z` > 0.
pub fn exponent(z: f64) -> i32 {
    // The exponent stays in the range in which `two_to` has an inverse.
    if z.is_normal() {
        (((z.to_bits() >> 52) & 0x7ff) as i32 - 1023).min(1022)
    } else {
        -1022
    }
}

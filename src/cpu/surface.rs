//! Twin of `shaders/surface.wgsl`: the reflectivity of an object at a hit.

use super::camera::Ray;
use super::procedural;
use super::sphere::sphere_from_center;
use super::trace::Hit;
use crate::prepare::surface::{Pplane, Tiled};
use crate::prepare::{Prepared, Surface};
use crate::real::{Real, Undecided, V3};

/// What a procedural plane's shader is told about the hit.
#[derive(Debug, Clone, Copy)]
pub struct PlanePoint<'a, R> {
    /// The hit point from the viewpoint, in units of 2^scale.
    pub position: V3<R>,
    /// The material's ambient reflectivity.
    pub ambient: V3<R>,
    /// What the host made ready.
    pub plane: &'a Pplane<R>,
}

impl<R: Real> PlanePoint<'_, R> {
    /// Parity of floor(2·H.x + 1000), floor(2·H.y + 1000) or floor(2·H.z + 1000).
    pub fn odd(&self, axis: usize) -> Result<u32, Undecided> {
        let p = [self.position.x, self.position.y, self.position.z][axis];
        self.plane.index[axis].odd(p)
    }

    /// Components x and y of H − point, in world units.
    pub fn from_point(&self) -> [R; 2] {
        [self.plane.from_point[0].at(self.position.x), self.plane.from_point[1].at(self.position.y)]
    }
}

/// What a procedural sphere's shader is told about the hit.
#[derive(Debug, Clone, Copy)]
pub struct SpherePoint<R> {
    /// H − center, in units of 2^scale.
    pub from_center: V3<R>,
    /// The material's ambient reflectivity.
    pub ambient: V3<R>,
}

/// The ambient reflectivity at a hit.
pub fn getamb<R: Real>(scene: &Prepared<R>, ray: &Ray<R>, hit: &Hit<R>) -> Result<V3<R>, Undecided> {
    let ambient = scene.ambient[scene.materials[hit.object]];
    let position = || ray.w * (R::exact(1.0) / hit.inverse);
    match &scene.surfaces[hit.object] {
        Surface::Plain => Ok(ambient),
        Surface::Tiled(tiled) => {
            let foreground = tplane_foreground(tiled, position())?;
            Ok(if foreground { ambient } else { scene.ambient[tiled.altmaterial] })
        }
        Surface::Pplane(plane) => {
            procedural::pplane(plane.shader, &PlanePoint { position: position(), ambient, plane })
        }
        Surface::Psphere(shader) => {
            let from_center = sphere_from_center(&scene.camera, &scene.spheres[hit.index], ray, hit.inverse);
            procedural::psphere(*shader, &SpherePoint { from_center, ambient })
        }
    }
}

/// Whether a tile is of the plane's own material.
fn tplane_foreground<R: Real>(tiled: &Tiled<R>, position: V3<R>) -> Result<bool, Undecided> {
    Ok(tiled.index[0].odd(position.x)? == tiled.index[1].odd(position.z)?)
}

/// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)) with θ the angle of (x, y) from +x; θ = 0 at the origin.
///
/// By 1 + cos 2α = 2·cos²α: no acos, no cos, and nothing cancels.
pub fn color_wheel<R: Real>(x: R, y: R) -> Result<V3<R>, Undecided> {
    // The larger component becomes ±1, so that squares neither overflow nor vanish.
    let (ax, ay) = (x.abs()?, y.abs()?);
    let larger = if (ax - ay).non_negative()? { ax } else { ay };
    if !larger.positive()? {
        return Ok(V3::new(R::exact(2.0), R::exact(0.5), R::exact(0.5)));
    }
    let half = R::exact(0.5);
    let half_root_3 = R::exact(0.75).sqrt();
    let (x, y) = (x / larger, y / larger);
    let green = half * x - half_root_3 * y;
    let blue = half * x + half_root_3 * y;
    let scale = R::exact(2.0) / (x * x + y * y);
    Ok(V3::new(x * x * scale, green * green * scale, blue * blue * scale))
}

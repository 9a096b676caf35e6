//! The reflectivity of an object at a hit. Referee of `shaders/surface.wgsl`.

use crate::prepare::surface::{Pplane, Textured, Tiled};
use crate::prepare::{Prepared, Surface};
use crate::procedural::{self, PlanePoint, SpherePoint};
use crate::real::{Real, Undecided, V3};

/// What a procedural plane's shader is told about the hit.
struct PlaneHit<'a, R> {
    position: V3<R>,
    ambient: V3<R>,
    plane: &'a Pplane<R>,
}

impl<R: Real> PlanePoint<R> for PlaneHit<'_, R> {
    fn ambient(&self) -> V3<R> {
        self.ambient
    }

    fn odd(&self, axis: usize) -> Result<u32, Undecided> {
        self.plane.index[axis].odd(self.position.axis(axis))
    }

    fn offset_from_point(&self) -> [R; 2] {
        [
            self.plane.from_point[0].at(self.position.x),
            self.plane.from_point[1].at(self.position.y),
        ]
    }
}

/// A hit point, with what its surface's looks depend on.
#[derive(Debug, Clone, Copy)]
pub struct Point<R> {
    /// Index of the object.
    pub object: usize,
    /// The hit point from the viewpoint, in units of 2^scale.
    pub position: V3<R>,
    /// H − center on a sphere, in the same units; on a quadric its gradient; zero on a plane.
    pub from_center: V3<R>,
}

/// The material at a hit: of a tiled plane, that of the tile.
pub fn tile_material<R: Real>(scene: &Prepared<R>, at: &Point<R>) -> Result<usize, Undecided> {
    match &scene.surfaces[at.object] {
        Surface::Tiled(tiled) => Ok(tiled.materials[tplane_odd(tiled, at.position)?]),
        Surface::Plain | Surface::Pplane(_) | Surface::Psphere(_) | Surface::Textured(_) => {
            Ok(scene.materials[at.object])
        }
    }
}

/// The ambient reflectivity at a hit.
pub fn getamb<R: Real>(scene: &Prepared<R>, at: &Point<R>) -> Result<V3<R>, Undecided> {
    let ambient = scene.palette[tile_material(scene, at)?].ambient;
    match &scene.surfaces[at.object] {
        Surface::Plain | Surface::Tiled(_) => Ok(ambient),
        Surface::Pplane(plane) => procedural::pplane(
            plane.shader,
            &PlaneHit {
                position: at.position,
                ambient,
                plane,
            },
        ),
        Surface::Psphere(shader) => procedural::psphere(
            *shader,
            &SpherePoint {
                from_center: at.from_center,
                ambient,
            },
        ),
        Surface::Textured(textured) => Ok(ambient.each(texel(scene, textured, at.position)?)),
    }
}

/// The diffuse reflectivity at a hit.
pub fn getdiff<R: Real>(scene: &Prepared<R>, at: &Point<R>) -> Result<V3<R>, Undecided> {
    let diffuse = scene.palette[tile_material(scene, at)?].diffuse;
    match &scene.surfaces[at.object] {
        Surface::Textured(textured) => Ok(diffuse.each(texel(scene, textured, at.position)?)),
        // The material is the tile's, and a procedural surface is ambient alone.
        Surface::Plain | Surface::Tiled(_) | Surface::Pplane(_) | Surface::Psphere(_) => {
            Ok(diffuse)
        }
    }
}

/// 0 where the indices of a tile add up to an even number, else 1.
fn tplane_odd<R: Real>(tiled: &Tiled<R>, position: V3<R>) -> Result<usize, Undecided> {
    let [p, q] = match &tiled.rows {
        None => [position.x, position.z],
        Some(rows) => [rows[0].dot(position), rows[1].dot(position)],
    };
    Ok(usize::from(
        tiled.index[0].odd(p)? != tiled.index[1].odd(q)?,
    ))
}

/// Column and row of the texel at a point of a rectangle with a picture, from the bottom left.
pub fn texel_place<R: Real>(
    textured: &Textured<R>,
    position: V3<R>,
) -> Result<[usize; 2], Undecided> {
    let p = textured.rectangle.coordinates(position);
    let mut place = [0; 2];
    for (i, place) in place.iter_mut().enumerate() {
        let index = p[i] * textured.per_unit[i];
        let size = textured.size[i];
        *place = if textured.repeats {
            index.floor_mod(size)? as usize
        } else {
            (index.floor()?.max(0.0) as usize).min(size as usize - 1)
        };
    }
    Ok(place)
}

/// The texel at a point of a rectangle with a picture, each channel byte/256.
pub(super) fn texel<R: Real>(
    scene: &Prepared<R>,
    textured: &Textured<R>,
    position: V3<R>,
) -> Result<V3<R>, Undecided> {
    let place = texel_place(textured, position)?;
    let texels = &scene.textures[textured.texture];
    // The picture's top row comes first.
    let row = texels.height as usize - 1 - place[1];
    let first = 3 * (row * texels.width as usize + place[0]);
    let channel = |i: usize| R::exact(f64::from(texels.rgb[first + i]) / 256.0);
    Ok(V3::new(channel(0), channel(1), channel(2)))
}

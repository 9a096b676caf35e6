//! The records of projectors, and the textures that they and texplanes share.

use super::{Packed, f32x3, factor, lit};
use crate::prepare::{self, Prepared, World};
use crate::real::{Bounded, Real, V3};
use crate::shader::bounds::{FRACTION_ROUNDINGS, GROWTH, U, round_up, upper_bound};
use crate::shader::records::Projector;

impl Packed {
    /// Packs a texture unless it has been, and returns where its texels begin.
    pub(super) fn pack_texture(
        &mut self,
        scene: &Prepared<Bounded>,
        texture: usize,
        textures: &mut [Option<u32>],
    ) -> u32 {
        *textures[texture].get_or_insert_with(|| {
            let first = self.texels.len() as u32;
            let texels = &scene.textures[texture];
            let rows = texels.rgb.chunks_exact(3 * texels.width as usize).rev();
            let pack = |t: &[u8]| u32::from(t[0]) | u32::from(t[1]) << 8 | u32::from(t[2]) << 16;
            self.texels
                .extend(rows.flat_map(|row| row.chunks_exact(3)).map(pack));
            first
        })
    }

    /// For each light its record if it is a projector that lights anything, and the textures of those.
    pub(super) fn pack_projectors(
        &mut self,
        scene: &Prepared<Bounded>,
        world: &World<Bounded>,
        textures: &mut [Option<u32>],
    ) -> Vec<Option<Projector>> {
        let lights = world.lights.iter().zip(world.picture_planes.iter());
        lights
            .map(|(light, &group)| {
                let projector = light.projector.as_ref()?;
                let reach = projector.reach?;
                let first = self.pack_texture(scene, projector.picture.texture, textures);
                Some(record(light.location, projector, reach, (first, group)))
            })
            .collect()
    }
}

/// The record of a projector at `location`; with the first texel of its texture, and the number of the surface that its
/// picture's plane is.
fn record(
    location: V3<Bounded>,
    projector: &prepare::projector::Projector<Bounded>,
    reach: Bounded,
    (first, group): (u32, u32),
) -> Projector {
    let prepare::projector::Projector {
        direction,
        constant: _,
        reach: _,
        picture,
    } = projector;
    let length = direction.dot(*direction).sqrt();
    let rectangle = &picture.rectangle;
    let rows = [0, 1].map(|i| rectangle.rows[i] * picture.per_unit[i]);
    let from_corner = rectangle.coordinates(location);
    let starts = [0, 1].map(|i| from_corner[i] * picture.per_unit[i]);
    let ends = [0, 1].map(|i| rectangle.dimensions[i] * picture.per_unit[i]);
    let errors = [0, 1].map(|i| {
        let (start, end) = (starts[i], ends[i]);
        let roundings = FRACTION_ROUNDINGS * U * (1.0 + upper_bound(start) + upper_bound(end));
        round_up(roundings + GROWTH * (start.error + end.error))
    });
    Projector {
        normal: f32x3(*direction * (Bounded::exact(1.0) / length)),
        reach: factor((reach / length).value),
        row_0: f32x3(rows[0]),
        start_0: starts[0].value as f32,
        row_1: f32x3(rows[1]),
        start_1: starts[1].value as f32,
        ends: ends.map(|end| end.value as f32),
        size: picture.size,
        row_lengths: rows.map(lit::size),
        errors,
        first,
        repeats: u32::from(picture.repeats),
        group,
        pad: Default::default(),
    }
}

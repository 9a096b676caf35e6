//! The records of projectors, and the textures that they and texplanes share.

use super::{Packed, factor, lit, nearest};
use crate::prepare::{self, Prepared, World};
use crate::real::{Real as _, V3};
use crate::shader::bounds::{FRACTION_ROUNDINGS, GROWTH, upper_bound};
use crate::shader::format::{Format, Known as _};
use crate::shader::records::wide::Projector;

impl<F: Format> Packed<F> {
    /// Packs a texture unless it has been, and returns where its texels begin.
    pub(super) fn pack_texture(
        &mut self,
        scene: &Prepared<F::Number>,
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
        scene: &Prepared<F::Number>,
        world: &World<F::Number>,
        textures: &mut [Option<u32>],
    ) -> Vec<Option<Projector>> {
        let lights = world.lights.iter().zip(world.picture_planes.iter());
        lights
            .map(|(light, &group)| {
                let projector = light.projector.as_ref()?;
                let reach = projector.reach?;
                let first = self.pack_texture(scene, projector.picture.texture, textures);
                Some(record::<F>(
                    light.location,
                    projector,
                    reach,
                    (first, group),
                ))
            })
            .collect()
    }
}

/// The record of a projector at `location`; with the first texel of its texture, and the number of the surface that its
/// picture's plane is.
fn record<F: Format>(
    location: V3<F::Number>,
    projector: &prepare::projector::Projector<F::Number>,
    reach: F::Number,
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
        let roundings = FRACTION_ROUNDINGS * F::U * (1.0 + upper_bound(start) + upper_bound(end));
        F::round_up(roundings + GROWTH * (start.off() + end.off()))
    });
    Projector {
        normal: nearest(*direction * (F::Number::exact(1.0) / length)),
        reach: factor((reach / length).nearest()),
        row_0: nearest(rows[0]),
        start_0: starts[0].nearest(),
        row_1: nearest(rows[1]),
        start_1: starts[1].nearest(),
        ends: ends.map(|end| end.nearest()),
        size: picture.size,
        row_lengths: rows.map(lit::size::<F>),
        errors,
        first,
        repeats: u32::from(picture.repeats),
        group,
        pad: Default::default(),
    }
}

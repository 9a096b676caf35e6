//! The records of what modulates an object's material: tiles, procedural planes, textures.

use super::{f32x3, factors};
use crate::prepare::Prepared;
use crate::prepare::surface::{Pplane, Textured, Tiled};
use crate::real::{Bounded, Real, V3};
use crate::shader::bounds::{
    FRACTION_ROUNDINGS, FROM_POINT_ROUNDINGS, GROWTH, U, round_up, upper_bound,
};
use crate::shader::records::{ProceduralPlane, Texplane, TiledPlane};

/// The bound of an index's error that does not come from the position: of the fraction added to it.
fn index_error(fraction: Bounded) -> f32 {
    round_up(FRACTION_ROUNDINGS * U * (1.0 + upper_bound(fraction)) + GROWTH * fraction.error)
}

fn length(row: V3<Bounded>) -> f32 {
    round_up(upper_bound(row.dot(row).sqrt()))
}

pub(super) fn tiled_plane(
    scene: &Prepared<Bounded>,
    tiled: &Tiled<Bounded>,
    material: usize,
) -> TiledPlane {
    let (zero, one) = (Bounded::zero(), Bounded::exact(1.0));
    let world = [V3::new(one, zero, zero), V3::new(zero, zero, one)];
    let rows = tiled.rows.unwrap_or(world);
    let rows = [
        rows[0] * tiled.index[0].per_unit,
        rows[1] * tiled.index[1].per_unit,
    ];
    let [even, odd] = tiled.materials;
    // In the shader, tiles whose indices have an even sum are of the object's own material.
    let (other, flip) = if even == material {
        (odd, 0)
    } else {
        (even, 1)
    };
    TiledPlane {
        row_0: f32x3(rows[0]),
        fraction_0: tiled.index[0].fraction.value as f32,
        row_1: f32x3(rows[1]),
        fraction_1: tiled.index[1].fraction.value as f32,
        altmaterial: factors(scene.palette[other].ambient),
        altindex: other as u32,
        parity: (tiled.index[0].parity + tiled.index[1].parity + flip) as f32,
        pad_0: Default::default(),
        row_lengths: rows.map(length),
        errors: tiled.index.map(|i| index_error(i.fraction)),
        pad_1: Default::default(),
    }
}

pub(super) fn procedural_plane(pplane: &Pplane<Bounded>) -> ProceduralPlane {
    let [x, y] = pplane.from_point;
    let offset = upper_bound(x.offset).max(upper_bound(y.offset));
    ProceduralPlane {
        per_unit: pplane.index.map(|i| i.per_unit.value as f32),
        index_error: pplane
            .index
            .map(|i| index_error(i.fraction))
            .into_iter()
            .fold(0.0, f32::max),
        fraction: pplane.index.map(|i| i.fraction.value as f32),
        from_point_error: round_up(
            FROM_POINT_ROUNDINGS * U * offset + GROWTH * x.offset.error.max(y.offset.error),
        ),
        parity: pplane.index.map(|i| i.parity as f32),
        pad: Default::default(),
        from_point: [
            x.per_unit.value as f32,
            y.per_unit.value as f32,
            x.offset.value as f32,
            y.offset.value as f32,
        ],
    }
}

pub(super) fn texplane(textured: &Textured<Bounded>, first: u32) -> Texplane {
    let rectangle = &textured.rectangle;
    let [u, v] = textured.per_unit;
    let rows = [rectangle.rows[0] * u, rectangle.rows[1] * v];
    let origins = [rectangle.origin[0] * u, rectangle.origin[1] * v];
    Texplane {
        row_0: f32x3(rows[0]),
        origin_0: origins[0].value as f32,
        row_1: f32x3(rows[1]),
        origin_1: origins[1].value as f32,
        size: textured.size,
        first,
        repeats: u32::from(textured.repeats),
        row_lengths: rows.map(length),
        errors: origins.map(index_error),
    }
}

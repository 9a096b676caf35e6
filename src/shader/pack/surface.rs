//! The records of what modulates an object's material: tiles, procedural planes, textures.

use super::numbers::larger;
use super::{factors, nearest};
use crate::prepare::Prepared;
use crate::prepare::surface::{Pplane, Textured, Tiled};
use crate::real::{Real as _, V3};
use crate::shader::bounds::{FRACTION_ROUNDINGS, FROM_POINT_ROUNDINGS, GROWTH, upper_bound};
use crate::shader::format::{Format, Known as _};
use crate::shader::records::wide::{ProceduralPlane, Texplane, TiledPlane};

/// The bound of an index's error that does not come from the position: of the fraction added to it.
fn index_error<F: Format>(fraction: F::Number) -> f64 {
    F::round_up(FRACTION_ROUNDINGS * F::U * (1.0 + upper_bound(fraction)) + GROWTH * fraction.off())
}

fn length<F: Format>(row: V3<F::Number>) -> f64 {
    F::round_up(upper_bound(row.dot(row).sqrt()))
}

pub(super) fn tiled_plane<F: Format>(
    scene: &Prepared<F::Number>,
    tiled: &Tiled<F::Number>,
    material: usize,
) -> TiledPlane {
    let (zero, one) = (F::Number::zero(), F::Number::exact(1.0));
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
        row_0: nearest(rows[0]),
        fraction_0: tiled.index[0].fraction.nearest(),
        row_1: nearest(rows[1]),
        fraction_1: tiled.index[1].fraction.nearest(),
        altmaterial: factors(scene.palette[other].ambient),
        altindex: other as u32,
        parity: (tiled.index[0].parity + tiled.index[1].parity + flip).into(),
        pad_0: Default::default(),
        row_lengths: rows.map(length::<F>),
        errors: tiled.index.map(|i| index_error::<F>(i.fraction)),
        pad_1: Default::default(),
    }
}

pub(super) fn procedural_plane<F: Format>(pplane: &Pplane<F::Number>) -> ProceduralPlane {
    let [x, y] = pplane.from_point;
    let offset = larger([x.offset, y.offset].map(upper_bound));
    ProceduralPlane {
        per_unit: pplane.index.map(|i| i.per_unit.nearest()),
        index_error: pplane
            .index
            .map(|i| index_error::<F>(i.fraction))
            .into_iter()
            .fold(0.0, f64::max),
        fraction: pplane.index.map(|i| i.fraction.nearest()),
        from_point_error: F::round_up(
            FROM_POINT_ROUNDINGS * F::U * offset + GROWTH * x.offset.off().max(y.offset.off()),
        ),
        parity: pplane.index.map(|i| i.parity.into()),
        pad: Default::default(),
        from_point: [
            x.per_unit.nearest(),
            y.per_unit.nearest(),
            x.offset.nearest(),
            y.offset.nearest(),
        ],
    }
}

pub(super) fn texplane<F: Format>(textured: &Textured<F::Number>, first: u32) -> Texplane {
    let rectangle = &textured.rectangle;
    let [u, v] = textured.per_unit;
    let rows = [rectangle.rows[0] * u, rectangle.rows[1] * v];
    let origins = [rectangle.origin[0] * u, rectangle.origin[1] * v];
    Texplane {
        row_0: nearest(rows[0]),
        origin_0: origins[0].nearest(),
        row_1: nearest(rows[1]),
        origin_1: origins[1].nearest(),
        size: textured.size,
        first,
        repeats: u32::from(textured.repeats),
        row_lengths: rows.map(length::<F>),
        errors: origins.map(index_error::<F>),
    }
}

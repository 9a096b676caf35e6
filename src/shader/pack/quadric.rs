//! Quadrics for all rays: their equations about a point near them, which f32 has exactly.

use super::lit::{bits, size};
use crate::prepare::local_quadric::{Local, local};
use crate::prepare::{self, Prepared};
use crate::real::{Bounded, Real as _, V3};
use crate::scene::Scene;
use crate::shader::bounds::{round_up, upper_bound};
use crate::shader::records::Quadric;

/// Stands for no border: beyond every position that a ray is followed to.
const NO_BORDER: f32 = (1_u64 << 60) as f32;

/// The records of a scene's quadrics.
pub(super) fn all(scene: &Scene, prepared: &Prepared<Bounded>) -> Vec<Quadric> {
    let quadrics = prepared.quadrics.iter();
    quadrics
        .map(|quadric| {
            let group = prepared.groups[quadric.object];
            let about = local(scene, prepared.camera.scale, quadric.object);
            record(quadric, &about, group)
        })
        .collect()
}

fn record(quadric: &prepare::Quadric<Bounded>, local: &Local, group: u32) -> Quadric {
    let f32s = |values: [Bounded; 3]| values.map(|v| v.value as f32);
    let [x, y, z] = local.slope;
    let slope = V3::new(x, y, z);
    let center = local.center.map(|c| Bounded::exact(f64::from(c)));
    let border = |side: usize, none: f32| {
        let near = |b: &Bounded| b.value.abs() < f64::from(NO_BORDER);
        let of = |axis: usize| {
            let border = quadric.borders[axis][side].filter(near);
            border.map_or(none, |b| b.value as f32)
        };
        [of(0), of(1), of(2)]
    };
    Quadric {
        center: local.center,
        object: quadric.object as u32,
        diagonal: f32s([local.square[0], local.square[1], local.square[2]]),
        group,
        beside: f32s([local.square[3], local.square[4], local.square[5]]),
        constant: local.constant.value as f32,
        adjoint_diagonal: f32s([local.adjoint[0], local.adjoint[1], local.adjoint[2]]),
        norm: norm(&local.square),
        adjoint_beside: f32s([local.adjoint[3], local.adjoint[4], local.adjoint[5]]),
        adjoint_norm: norm(&local.adjoint),
        slope: [slope.x, slope.y, slope.z].map(|v| v.value as f32),
        slope_size: size(slope),
        lower: border(0, -NO_BORDER),
        size: size(V3::new(center[0], center[1], center[2])),
        upper: border(1, NO_BORDER),
        lights_on_surface: bits(&quadric.lights_on_surface),
    }
}

/// No less than the largest stretch of a symmetric matrix: the root of the sum of its squares.
fn norm(matrix: &[Bounded; 6]) -> f32 {
    let squares = matrix.map(|c| upper_bound(c) * upper_bound(c));
    let [a, b, c, d, e, f] = squares;
    round_up((a + b + c + 2.0 * (d + e + f)).sqrt())
}

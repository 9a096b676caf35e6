//! Quadrics for all rays: their equations about a point near them, which f32 has exactly.

use super::lit::{bits, size};
use crate::prepare::quadric::{self, Local};
use crate::prepare::{self, Prepared};
use crate::real::{Bounded, Real as _, V3};
use crate::scene::Scene;
use crate::shader::bounds::{U, round_up, upper_bound};
use crate::shader::records::Quadric;

/// Stands for no border: beyond every position that a ray is followed to.
const NO_BORDER: f32 = (1_u64 << 60) as f32;

/// Whether a quadric is a plane, which `shaders/quadric.wgsl` has no answer to.
pub(super) fn flat(scene: &Prepared<Bounded>) -> bool {
    scene
        .quadrics
        .iter()
        .any(|quadric| quadric.square.is_none())
}

/// The records of a scene's quadrics.
pub(super) fn all(scene: &Scene, prepared: &Prepared<Bounded>) -> Vec<Quadric> {
    let curved = prepared.quadrics.iter().filter(|q| q.square.is_some());
    curved
        .map(|quadric| {
            let group = prepared.groups[quadric.object];
            let local = quadric::local(scene, prepared.camera.scale, quadric.object);
            record(quadric, &local, group)
        })
        .collect()
}

fn record(quadric: &prepare::Quadric<Bounded>, local: &Local, group: u32) -> Quadric {
    let f32s = |values: [Bounded; 3]| values.map(|v| v.value as f32);
    let [slope, ..] = [local.slope];
    let slope = V3::new(slope[0], slope[1], slope[2]);
    let border = |side: usize, none: f32| {
        let of = |axis: usize| quadric.borders[axis][side].map_or(none, |b| b.value as f32);
        [of(0), of(1), of(2)]
    };
    let largest = quadric.borders.iter().flatten().flatten();
    let largest = largest.map(|b| upper_bound(*b)).fold(0.0, f64::max);
    // The rounding to f32, and that of the difference.
    let border_error = round_up(1.5 * U * largest);
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
        size: size(V3::new(
            Bounded::exact(f64::from(local.center[0])),
            Bounded::exact(f64::from(local.center[1])),
            Bounded::exact(f64::from(local.center[2])),
        )),
        upper: border(1, NO_BORDER),
        lights_on_surface: bits(&quadric.lights_on_surface),
        border_error,
        pad: Default::default(),
    }
}

/// No less than the largest stretch of a symmetric matrix: the root of the sum of its squares.
fn norm(matrix: &[Bounded; 6]) -> f32 {
    let squares = matrix.map(|c| upper_bound(c) * upper_bound(c));
    let [a, b, c, d, e, f] = squares;
    round_up((a + b + c + 2.0 * (d + e + f)).sqrt())
}

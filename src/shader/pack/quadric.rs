//! Quadrics for all rays: their equations about a point near them, which f32 has exactly.

use super::lit::{BEYOND, bits, size};
use crate::prepare::local_quadric::{Local, local};
use crate::prepare::{self, Prepared};
use crate::real::{Real as _, V3};
use crate::scene::Scene;
use crate::shader::bounds::upper_bound;
use crate::shader::format::{Format, Known as _};
use crate::shader::records::wide::Quadric;

/// The records of a scene's quadrics.
pub(super) fn all<F: Format>(
    scene: &Scene,
    prepared: &Prepared<F::Number>,
) -> Vec<F::Record<Quadric>> {
    let quadrics = prepared.quadrics.iter();
    quadrics
        .map(|quadric| {
            let group = prepared.groups[quadric.object];
            let about = local::<F::Number>(scene, prepared.camera.scale, quadric.object);
            F::record(record::<F>(quadric, &about, group))
        })
        .collect()
}

fn record<F: Format>(
    quadric: &prepare::Quadric<F::Number>,
    local: &Local<F::Number>,
    group: u32,
) -> Quadric {
    let nearest = |values: [F::Number; 3]| values.map(|v| v.nearest());
    let [x, y, z] = local.slope;
    let slope = V3::new(x, y, z);
    let slope_size = size::<F>(slope);
    let center = local.center.map(|c| F::Number::exact(f64::from(c)));
    // A border that is farther away is as good there, on whichever side of all positions it is.
    let border = |side: usize, none: f64| {
        [0, 1, 2].map(|axis| {
            let border = quadric.borders[axis][side];
            border.map_or(none, |b| b.nearest().clamp(-BEYOND, BEYOND))
        })
    };
    let [lower, upper] = [border(0, -BEYOND), border(1, BEYOND)];
    let known = lower.iter().chain(&upper).all(|border| !border.is_nan());
    let size = size::<F>(V3::new(center[0], center[1], center[2]));
    Quadric {
        center: local.center.map(f64::from),
        object: quadric.object as u32,
        diagonal: nearest([local.square[0], local.square[1], local.square[2]]),
        group,
        beside: nearest([local.square[3], local.square[4], local.square[5]]),
        constant: local.constant.nearest(),
        adjoint_diagonal: nearest([local.adjoint[0], local.adjoint[1], local.adjoint[2]]),
        norm: norm::<F>(&local.square),
        adjoint_beside: nearest([local.adjoint[3], local.adjoint[4], local.adjoint[5]]),
        adjoint_norm: norm::<F>(&local.adjoint),
        slope: [slope.x, slope.y, slope.z].map(|v| v.nearest()),
        slope_size,
        lower,
        // Where a border is not known, nor is the scene taken: this number's range is looked at.
        size: if known { size } else { f64::INFINITY },
        upper,
        lights_on_surface: bits(&quadric.lights_on_surface),
    }
}

/// No less than the largest stretch of a symmetric matrix: the root of the sum of its squares.
fn norm<F: Format>(matrix: &[F::Number; 6]) -> f64 {
    let squares = matrix.map(|c| upper_bound(c) * upper_bound(c));
    let [a, b, c, d, e, f] = squares;
    F::round_up((a + b + c + 2.0 * (d + e + f)).sqrt())
}

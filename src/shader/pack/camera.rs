//! The camera rounded to f32, with the bounds that all primary rays share.

use crate::prepare;
use crate::real::rational::two_to;
use crate::shader::bounds::{Screen, W_ROUNDINGS, round_up, upper_bound};
use crate::shader::format::{Format, Known as _};
use crate::shader::records::PackedCamera;
use crate::shader::records::wide::CameraNumbers;

pub(super) fn camera<F: Format>(
    camera: &prepare::Camera<F::Number>,
    screen: &Screen,
) -> PackedCamera<F> {
    let unit = two_to(-camera.scale);
    let reach = screen.reach(camera.anchor);
    let d = camera.distance.nearest();
    let offset = camera.offset.map(upper_bound);
    let parts = [0, 1].map(|i| upper_bound(camera.step[i]) * reach[i] + offset[i]);
    // κ − 1: docs/NUMERICS.md. Only columns and rows for which X·step and the offset have opposite signs count.
    let more = [0, 1].map(|i| {
        let (o, first) = (offset[i], -f64::from(camera.anchor[i]));
        let opposite = if camera.offset[i].nearest() > 0.0 {
            -first
        } else {
            f64::from(screen.pixels[i] - 1) + first
        };
        let most = (opposite + screen.margin).max(0.0) * upper_bound(camera.step[i]);
        let worst = most.min((d * d + o * o).sqrt());
        4.0 * worst * o / (d * d + (worst - o) * (worst - o))
    });
    // Offsets that were rounded move W, whose length is at least d.
    let moved = camera.step.map(upper_bound).iter().sum::<f64>() * screen.offset_error::<F>();
    PackedCamera {
        numbers: F::record(CameraNumbers {
            anchor: camera.anchor,
            step: camera.step.map(|v| v.nearest()),
            offset: camera.offset.map(|v| v.nearest()),
            distance: d,
            gain: 255.0 * unit,
            unit,
            pad: Default::default(),
        }),
        w_error: round_up(
            W_ROUNDINGS * F::U * (parts[0] * parts[0] + parts[1] * parts[1] + d * d).sqrt() + moved,
        ),
        condition: round_up(1.0 + more[0] + more[1] + moved / (d * F::U)),
    }
}

//! A pixel from its samples: the notes' `make_pixel`, in one number type. `pixel` chooses which.

use super::trace::{Fault, Limits, Traced, Unobserved, ray_trace};
use crate::jitter::Sampling;
use crate::prepare::Prepared;
use crate::real::{Real, V3};

/// A value, or somewhat less than it, by what rays bring that were not followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Value<R> {
    pub(super) color: V3<R>,
    /// How much less at most, by channels.
    pub(super) open: [f64; 3],
}

impl<R: Real> Value<R> {
    /// The value, if the number type can say what lies between two numbers.
    pub(super) fn closed(self) -> Option<V3<R>> {
        let [r, g, b] = self.open;
        let V3 { x, y, z } = self.color;
        Some(V3::new(x.up_to(r)?, y.up_to(g)?, z.up_to(b)?))
    }

    /// The most that it may be.
    pub(super) fn most(self) -> V3<R> {
        let [r, g, b] = self.open.map(R::exact);
        self.color + V3::new(r, g, b)
    }
}

/// The mean of a pixel's samples, of which `at` tells each; those that are not `wanted` count as 0.
pub(super) fn mean<R: Real>(
    sampling: Sampling<'_>,
    x: u32,
    y: u32,
    wanted: impl Fn(u32) -> bool,
    mut at: impl FnMut(f64, f64) -> Result<Value<R>, Fault>,
) -> Result<Value<R>, Fault> {
    let (px, py) = (f64::from(x), f64::from(y));
    if let Sampling::Once = sampling {
        return at(px, py);
    }
    let mut sum = V3::new(R::zero(), R::zero(), R::zero());
    let mut open = [0.0; 3];
    for (sample, [a, b]) in (0..).zip(sampling.offsets(x, y)) {
        if wanted(sample) {
            let value = at(px + a, py + b)?;
            sum = sum + value.color;
            open = [0, 1, 2].map(|i| open[i] + value.open[i]);
        }
    }
    let samples = f64::from(sampling.samples());
    let n = R::exact(samples);
    Ok(Value {
        color: V3::new(sum.x / n, sum.y / n, sum.z / n),
        open: open.map(|open| open / samples),
    })
}

/// The value of pixel (x, y), counted from the bottom left: the mean of its samples.
pub(super) fn make_pixel<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    sampling: Sampling<'_>,
    x: u32,
    y: u32,
) -> Result<Value<R>, Fault> {
    mean(sampling, x, y, |_| true, |x, y| color(scene, limits, x, y))
}

/// The colour of a sample.
pub(super) fn color<R: Real>(
    scene: &Prepared<R>,
    limits: &Limits,
    x: f64,
    y: f64,
) -> Result<Value<R>, Fault> {
    let Traced { color, open, .. } = ray_trace(scene, limits, x, y, &mut Unobserved)?;
    Ok(Value { color, open })
}

//! Why a quadric is hit or not, exactly: the roots along a ray are p ± q·√d in rational numbers.

use std::cmp::Ordering;

use super::answer::{HitOrMiss, Reason};
use crate::real::rational::{Ratio, is_positive, is_zero, ratio};
use crate::scene::Quadric;

/// A root t of the equation along the ray: part + times·√square.
struct Root {
    part: Ratio,
    times: Ratio,
    square: Ratio,
}

impl Root {
    /// The sign of offset + slope·t.
    fn sign(&self, offset: &Ratio, slope: &Ratio) -> Ordering {
        let plain = offset + slope * &self.part;
        let rooted = slope * &self.times;
        let (a, b) = (plain.cmp(&Ratio::ZERO), rooted.cmp(&Ratio::ZERO));
        let squares = &plain * &plain - &rooted * &rooted * &self.square;
        match (a, b) {
            (_, Ordering::Equal) => a,
            _ if is_zero(&self.square) => a,
            (Ordering::Equal, _) => b,
            _ if a == b => a,
            (Ordering::Greater, _) => squares.cmp(&Ratio::ZERO),
            (Ordering::Less, _) => Ratio::ZERO.cmp(&squares),
        }
    }

    /// A number near it.
    fn near(&self) -> f64 {
        let f64 = |number: &Ratio| number.to_f64().value();
        f64(&self.part) + f64(&self.times) * f64(&self.square).sqrt()
    }
}

/// What a quadric answers to the ray viewpoint + t·w, under the screen tolerance τ.
pub(super) fn ask(
    quadric: &Quadric,
    viewpoint: &[Ratio; 3],
    w: &[Ratio; 3],
    screen_tolerance: f64,
) -> HitOrMiss {
    let roots = match roots(quadric, viewpoint, w) {
        Ok(roots) => roots,
        Err(reason) => return HitOrMiss::Miss(reason),
    };
    let ahead = |root: &Root| root.sign(&Ratio::ZERO, &Ratio::ONE) == Ordering::Greater;
    let mut nearest = None;
    for root in roots.iter().filter(|root| ahead(root)) {
        match left_out(quadric, root, viewpoint, w, screen_tolerance) {
            None => return HitOrMiss::Hit,
            Some(reason) => nearest = nearest.or(Some(reason)),
        }
    }
    HitOrMiss::Miss(nearest.unwrap_or(Reason::Behind))
}

/// Where the ray's line meets the quadric, the lesser root first.
fn roots(quadric: &Quadric, viewpoint: &[Ratio; 3], w: &[Ratio; 3]) -> Result<Vec<Root>, Reason> {
    let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients.map(ratio);
    // Twice the symmetric form of the part of the second degree.
    let both = |p: &[Ratio; 3], q: &[Ratio; 3]| -> Ratio {
        ratio(2.0) * (&a * &p[0] * &q[0] + &b * &p[1] * &q[1] + &c * &p[2] * &q[2])
            + &d * (&p[0] * &q[1] + &p[1] * &q[0])
            + &e * (&p[0] * &q[2] + &p[2] * &q[0])
            + &f * (&p[1] * &q[2] + &p[2] * &q[1])
    };
    let slope = |p: &[Ratio; 3]| &g * &p[0] + &h * &p[1] + &i * &p[2];
    let twice_a = both(w, w);
    let b = both(viewpoint, w) + slope(w);
    let c = both(viewpoint, viewpoint) / ratio(2.0) + slope(viewpoint) - j;
    if is_zero(&twice_a) {
        if is_zero(&b) {
            return Err(Reason::Parallel);
        }
        return Ok(vec![Root {
            part: -c / b,
            times: Ratio::ZERO,
            square: Ratio::ZERO,
        }]);
    }
    let square = &b * &b - ratio(2.0) * &twice_a * &c;
    if is_zero(&square) {
        return Err(Reason::Tangent);
    }
    if !is_positive(&square) {
        return Err(Reason::Passes);
    }
    let root = |sign: f64| Root {
        part: -&b / &twice_a,
        times: ratio(sign) / &twice_a,
        square: square.clone(),
    };
    let first = if is_positive(&twice_a) { -1.0 } else { 1.0 };
    Ok(vec![root(first), root(-first)])
}

/// Why a point of the surface does not count, if it does not.
fn left_out(
    quadric: &Quadric,
    root: &Root,
    viewpoint: &[Ratio; 3],
    w: &[Ratio; 3],
    screen_tolerance: f64,
) -> Option<Reason> {
    let beyond =
        |axis: usize, border: f64| root.sign(&(&viewpoint[axis] - ratio(border)), &w[axis]);
    let at =
        |axis: usize| viewpoint[axis].to_f64().value() + root.near() * w[axis].to_f64().value();
    if beyond(2, screen_tolerance) == Ordering::Greater {
        return Some(Reason::BeforeScreen(at(2)));
    }
    for axis in 0..3 {
        let cut = |side: Option<glam::DVec3>, out: Ordering| {
            side.is_some_and(|side| beyond(axis, side[axis]) == out)
        };
        if cut(quadric.lower, Ordering::Less) || cut(quadric.upper, Ordering::Greater) {
            let at = at(axis);
            return Some(Reason::CutAway { axis, at });
        }
    }
    None
}

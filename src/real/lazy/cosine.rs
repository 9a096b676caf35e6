//! The cosine of an angle in degrees: to any precision, and by square roots where that can be.

use dashu_int::IBig;

use super::Lazy;
use super::ball::Ball;
use super::mag::Mag;
use crate::real::Real;
use crate::real::rational::ratio;

/// Bits beyond those asked for: the series below lose fewer than 16.
const GUARD: usize = 64;

/// 2^bits · atan(1/n), by its series; each of the terms is off by less than 2.
fn arc_tangent(n: i64, bits: usize) -> IBig {
    let square = IBig::from(n * n);
    let mut power = (IBig::ONE << bits) / IBig::from(n);
    let mut sum = IBig::ZERO;
    let mut k = 1_i64;
    while !power.is_zero() {
        let term = &power / IBig::from(k);
        if k % 4 == 1 {
            sum += term;
        } else {
            sum -= term;
        }
        power /= &square;
        k += 2;
    }
    sum
}

/// 2^bits · π, by Machin: 16·atan(1/5) − 4·atan(1/239). Off by less than 40 for each of its terms.
fn pi(bits: usize) -> IBig {
    arc_tangent(5, bits) * IBig::from(16) - arc_tangent(239, bits) * IBig::from(4)
}

/// The cosine of 0 to 180 degrees.
///
/// The series of the cosine at φ ≤ π, in fixed point with [`GUARD`] more bits. π is off by fewer than bits·40 units in
/// the last place, φ likewise, φ² by seven times that; a term's error is multiplied by φ²/(k(k+1)), which is below 5
/// once and below 1 from then on, and takes up the error of φ² and 2 units. In all fewer than 2¹⁶·bits units: the ball
/// has 2³² of them.
pub(super) fn cosine(angle: f64, bits: usize) -> Ball {
    let precision = bits + GUARD;
    let degrees = ratio(angle);
    let phi = pi(precision) * degrees.numerator().clone()
        / (IBig::from(degrees.denominator().clone()) * IBig::from(180));
    let square = (&phi * &phi) >> precision;
    let mut term = IBig::ONE << precision;
    let mut sum = IBig::ZERO;
    let mut k = 0_i64;
    while !term.is_zero() {
        if k % 4 == 0 {
            sum += &term;
        } else {
            sum -= &term;
        }
        term = ((&term * &square) >> precision) / IBig::from((k + 1) * (k + 2));
        k += 2;
    }
    let exp = -(precision as i64);
    Ball::new(sum, exp, Mag::two_to(exp + 32))
}

/// Whether the cosine of the angle can be had from rationals by square roots.
///
/// Every f64 is k/2^m degrees, so e^{iθ} is a root of unity of an order n that divides 360·2^m = 2^(3+m)·3²·5. The
/// degree of cos θ is φ(n)/2, a power of two just if 9 does not divide n, that is, if 3 divides k. Otherwise cos θ is
/// in no tower of square roots, and no number that is compared with it here can be equal to it.
pub(super) fn by_roots(angle: f64) -> bool {
    let bits = angle.to_bits();
    let fraction = bits & ((1 << 52) - 1);
    let whole = if bits >> 52 == 0 {
        fraction
    } else {
        fraction | (1 << 52)
    };
    // A power of two changes nothing about divisibility by three.
    whole % 3 == 0
}

/// The cosine by square roots: by half angles, from multiples of 12 degrees.
pub(super) fn rooted(angle: f64) -> Lazy {
    if angle % 12.0 == 0.0 {
        return of_twelfths((angle / 12.0) as i64);
    }
    // Exact: the grid of a double does not get finer here.
    let double = 2.0 * angle;
    let double = if double > 180.0 {
        360.0 - double
    } else {
        double
    };
    let root = ((Lazy::exact(1.0) + rooted(double)) * Lazy::exact(0.5)).sqrt();
    if angle > 90.0 { -root } else { root }
}

/// cos 12j°, j from 0 to 15, as that of 60a + 36b degrees.
fn of_twelfths(j: i64) -> Lazy {
    let b = 2 * j % 5;
    let a = ((j - 3 * b) / 5).rem_euclid(6);
    let half_root_3 = || Lazy::exact(0.75).sqrt();
    let (cos_a, sin_a) = match a {
        0 => (Lazy::exact(1.0), Lazy::zero()),
        1 => (Lazy::exact(0.5), half_root_3()),
        2 => (Lazy::exact(-0.5), half_root_3()),
        3 => (Lazy::exact(-1.0), Lazy::zero()),
        4 => (Lazy::exact(-0.5), -half_root_3()),
        _ => (Lazy::exact(0.5), -half_root_3()),
    };
    if b == 0 {
        return cos_a;
    }
    // cos 36° = (√5 + 1)/4, cos 72° = (√5 − 1)/4.
    let one = Lazy::exact(if b % 3 == 1 { 1.0 } else { -1.0 });
    let cos_b = (Lazy::exact(5.0).sqrt() + one) * Lazy::exact(0.25);
    let cos_b = if b > 2 { -cos_b } else { cos_b };
    let sin_b = (Lazy::exact(1.0) - cos_b * cos_b).sqrt();
    cos_a * cos_b - sin_a * sin_b
}

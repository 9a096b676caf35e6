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
    let square = radians_squared(angle, precision);
    series(IBig::ONE << precision, 0, &square, precision)
}

/// 1 − the cosine of 0 to 1 degrees, known to so many bits of itself, not of 1.
///
/// φ²/2 − φ⁴/24 + …, in fixed point with as many more bits as φ² has zeros in front. As φ < 1/57, all errors but that
/// of φ²/2 are less than a hundredth of it: in all fewer than 40 units for each bit of the precision, of which there
/// are fewer than 2¹⁸. The ball has 2³², and φ²/2 at least 2^(bits + 63).
pub(super) fn versine(angle: f64, bits: usize) -> Ball {
    let exponent = crate::real::rational::exponent(angle);
    // φ is more than 2^(exponent − 6).
    let zeros = usize::try_from(2 * (6 - exponent)).unwrap_or(0);
    let precision = bits + GUARD + zeros;
    let square = radians_squared(angle, precision);
    let first = square.clone() / IBig::from(2);
    series(first, 2, &square, precision)
}

/// The cosine's series from the term φ^k/k! on, which counts as positive, in fixed point; the ball has 2³² units in the
/// last place.
fn series(first: IBig, mut k: i64, square: &IBig, precision: usize) -> Ball {
    let (mut term, mut sum, mut adds) = (first, IBig::ZERO, true);
    while !term.is_zero() {
        if adds {
            sum += &term;
        } else {
            sum -= &term;
        }
        adds = !adds;
        term = ((&term * square) >> precision) / IBig::from((k + 1) * (k + 2));
        k += 2;
    }
    let exp = -(precision as i64);
    Ball::new(sum, exp, Mag::two_to(exp + 32))
}

/// 2^precision·φ², φ the angle in radians.
fn radians_squared(angle: f64, precision: usize) -> IBig {
    let degrees = ratio(angle);
    let phi = pi(precision) * degrees.numerator().clone()
        / (IBig::from(degrees.denominator().clone()) * IBig::from(180));
    (&phi * &phi) >> precision
}

/// More halvings of an angle than this are not made by roots: as many roots in a row take longer to compute than the
/// series, and a tower holds fewer.
const MOST_HALVINGS: u32 = 10;

/// How many square roots one after another make the cosine of the angle from rationals, less 1 at most; None if none
/// do.
///
/// Every f64 is k/2^m degrees, so e^{iθ} is a root of unity of an order n that divides 360·2^m = 2^(3+m)·3²·5. The
/// degree of cos θ is φ(n)/2, a power of two just if 9 does not divide n, that is, if 3 divides k. Otherwise cos θ is
/// in no tower of square roots, and no number that is compared with it here can be equal to it. If θ is 12j/2^h with an
/// odd j, 2^h divides φ(n): a tower of fewer than h − 1 roots does not hold it.
pub(super) fn roots(angle: f64) -> Option<u32> {
    let bits = angle.to_bits();
    let fraction = bits & ((1 << 52) - 1);
    let (whole, exponent) = match (bits >> 52) as i32 {
        0 if fraction == 0 => return Some(0),
        0 => (fraction, -1074),
        biased => (fraction | (1 << 52), biased - 1075),
    };
    // A power of two changes nothing about divisibility by three; 12 has two of them.
    (whole % 3 == 0)
        .then(|| u32::try_from(2 - exponent - whole.trailing_zeros().cast_signed()).unwrap_or(0))
}

/// Whether the cosine of the angle is made by square roots.
pub(super) fn by_roots(angle: f64) -> bool {
    roots(angle).is_some_and(|halvings| halvings <= MOST_HALVINGS)
}

/// Whether 1 − the cosine of the angle is to be known beside it: the angle is small, and no roots make its cosine.
pub(super) fn narrow(angle: f64) -> bool {
    angle < 1.0 && !by_roots(angle)
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

//! The cosine of an angle in degrees: in roots where ruler and compass can make it, else enclosed by its series.
//!
//! An f64 is a whole number times a power of two, and 360 = 2³·3²·5: by Gauss and Wantzel its cosine lies in a tower of
//! square roots just if the angle is a multiple of 3 degrees halved some times. The other cosines are equal to no
//! number that a tower holds, so that balls separate them from every one in the end.

use dashu_base::Abs;
use dashu_int::IBig;
use dashu_ratio::RBig;

use super::ball::Ball;
use super::real::Real;

/// The cosine of an angle from 0 to 180 degrees.
pub(crate) fn cosine_of(degrees: f64) -> Real {
    let degrees = RBig::try_from(degrees).expect("a scene holds finite numbers");
    constructed(&degrees, 60).unwrap_or_else(|| Real::cosine(degrees))
}

/// The cosine in square roots, if at most `halvings` halvings of a multiple of 3 degrees make the angle.
fn constructed(degrees: &RBig, halvings: u32) -> Option<Real> {
    if *degrees > RBig::from(90) {
        return Some(-&constructed(&(RBig::from(180) - degrees), halvings)?);
    }
    let threes = degrees / RBig::from(3);
    if threes.is_int() {
        let n = i64::try_from(threes.into_parts().0).ok()?;
        return Some(turned(n));
    }
    if halvings == 0 {
        return None;
    }
    // cos(a) = √((1 + cos 2a)/2) where cos(a) is not negative.
    let double = constructed(&(degrees * RBig::from(2)), halvings - 1)?;
    let half = &(&Real::integer(1) + &double) / &Real::integer(2);
    Some(half.sqrt())
}

/// The cosine of 3n degrees, 0 to 90.
fn turned(n: i64) -> Real {
    let number = Real::integer;
    let half = |real: &Real| real / &number(2);
    match n * 3 {
        0 => number(1),
        90 => number(0),
        60 => half(&number(1)),
        30 => half(&number(3).sqrt()),
        45 => half(&number(2).sqrt()),
        36 => &(&number(1) + &number(5).sqrt()) / &number(4),
        72 => &(&number(5).sqrt() - &number(1)) / &number(4),
        _ => {
            // 15 = 45 − 30, 6 = 36 − 30, 9 = 15 − 6, 3 = 9 − 6; then as many threes as it takes.
            let cosine36 = turned(12);
            let sine36 = (&number(1) - &cosine36.square()).sqrt();
            let (cosine30, sine30) = (turned(10), half(&number(1)));
            let cosine45 = turned(15);
            let plus = |a: &(Real, Real), b: &(Real, Real)| {
                (
                    &(&a.0 * &b.0) - &(&a.1 * &b.1),
                    &(&a.0 * &b.1) + &(&a.1 * &b.0),
                )
            };
            let back = |a: &(Real, Real)| (a.0.clone(), -&a.1);
            let fifteen = plus(
                &(cosine45.clone(), cosine45),
                &back(&(cosine30.clone(), sine30.clone())),
            );
            let six = plus(&(cosine36, sine36), &back(&(cosine30, sine30)));
            let nine = plus(&fifteen, &back(&six));
            let three = plus(&nine, &back(&six));
            let mut angle = three.clone();
            for _ in 1..n {
                angle = plus(&angle, &three);
            }
            angle.0
        }
    }
}

/// The cosine of 0 to 180 degrees, by its power series on fixed-point numbers.
pub(crate) fn cosine(degrees: &RBig, bits: usize) -> Ball {
    // Fixed point with room for the errors below, each at most a few units of 2^-places.
    let places = bits + 64;
    // Quartered, so that its radians are below 1; two doublings undo that.
    let (over, under) = (degrees / RBig::from(720)).into_parts();
    let angle = (pi(places) * over) / IBig::from(under);
    // Off by less than 3 units: pi by 2, times at most 1/4, and the quotient by 1.
    let square = (&angle * &angle) >> places;
    let mut term = IBig::ONE << places;
    let mut sum = term.clone();
    let mut k = 1_u64;
    while !term.clone().abs().is_zero() {
        // Rounding of one unit a step; the terms shrink, as the angle is below 1.
        term = -((&term * &square) >> places) / IBig::from((2 * k - 1) * (2 * k));
        sum += &term;
        k += 1;
    }
    // Each term is off by less than 8 units (7 from the square's error in the first, less later), the rest by less than
    // 1: 8·k in all, k < 2^10 terms for fewer than 2^12 bits. Each doubling 2c² − 1 makes it at most 4 times as much,
    // and 2 more.
    for _ in 0..2 {
        sum = ((&sum * &sum) >> (places - 1)) - (IBig::ONE << places);
    }
    let error = IBig::from((8 * k + 8) * 16 + 16);
    Ball::around(sum, &error, -(places as i64), bits)
}

/// π · 2^places, off by less than 2, by Machin: 16·atan(1/5) − 4·atan(1/239).
fn pi(places: usize) -> IBig {
    let guard = 32;
    let atan = |n: u64| {
        let mut power = (IBig::ONE << (places + guard)) / IBig::from(n);
        let mut sum = power.clone();
        let mut k = 1_u64;
        while power != IBig::ZERO {
            power /= IBig::from(n * n);
            let term = &power / IBig::from(2 * k + 1);
            if k % 2 == 1 {
                sum -= term;
            } else {
                sum += term;
            }
            k += 1;
        }
        sum
    };
    (atan(5) * IBig::from(16) - atan(239) * IBig::from(4)) >> guard
}

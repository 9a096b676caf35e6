//! Literal bounds of forms at the ends of what f32 can hold.

use super::*;
use crate::real::Real as _;

const SCREEN: Screen = Screen {
    pixels: [1 << 20, 1],
    margin: 0.0,
    lattice: 1.0,
};

/// Forms whose coefficients f32 cannot hold, or a device may take for 0, over pictures so wide that it matters.
#[test]
fn coefficients_that_are_flushed_are_within_the_bound() {
    let x = f64::from(1 << 20);
    for exponent in [-127.0_f64, -140.0, -300.0] {
        let tiny = Bounded::exact(exponent.exp2());
        let zero = Bounded::zero();
        let all_of_it = tiny.value * x * x;
        let (_, error) = quadratic([tiny, zero, zero, zero, zero, zero], [x, 0.0], &SCREEN);
        assert!(f64::from(error) > all_of_it, "{error:e} {all_of_it:e}");
        let (_, error) = linear([tiny, zero, zero], [x, 0.0], &SCREEN);
        assert!(f64::from(error) > tiny.value * x);
    }
}

/// k roundings of a term make a little more than k·ROUNDING of it, and the bound itself is rounded k times more in
/// the comparison.
#[test]
fn what_follows_the_first_order_is_within_the_bound() {
    let one = Bounded::exact(1.0);
    let sampled = Screen {
        margin: 0.5,
        ..SCREEN
    };
    let bounds = [
        (LINEAR_ROUNDINGS, linear([one; 3], [1.0; 2], &SCREEN).1, 3.0),
        (
            SAMPLED_QUADRATIC_ROUNDINGS,
            quadratic([one; 6], [1.0; 2], &sampled).1,
            6.0,
        ),
    ];
    for (roundings, bound, terms) in bounds {
        // A faithful result r of a exact one is off by ROUNDING·|r|: by a factor of 1/(1 − ROUNDING) at most.
        let off = (1.0 - ROUNDING).powf(-roundings) - 1.0;
        let left = f64::from(bound) * (1.0 - ROUNDING).powf(roundings);
        assert!(terms * off < left, "{roundings}");
        assert!(left < 1.001 * terms * off);
    }
}

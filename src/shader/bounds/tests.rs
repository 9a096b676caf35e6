//! Literal bounds of forms at the ends of what a format can hold.

use super::*;
use crate::real::Real as _;
use crate::shader::format::{Double, Single};

const SCREEN: Screen = Screen {
    pixels: [1 << 20, 1],
    margin: 0.0,
    lattice: 1.0,
};

/// Forms whose coefficients the format cannot hold, or a device may take for 0, over pictures so wide that it matters.
#[test]
fn coefficients_that_are_flushed_are_within_the_bound() {
    fn tried<F: Format>(exponents: [f64; 3]) {
        let x = f64::from(1 << 20);
        for tiny in exponents.map(f64::exp2) {
            let (form, zero) = (F::Number::exact(tiny), F::Number::zero());
            let all_of_it = tiny * x * x;
            let (_, error) =
                quadratic::<F>([form, zero, zero, zero, zero, zero], [x, 0.0], &SCREEN);
            assert!(error > all_of_it, "{error:e} {all_of_it:e}");
            let (_, error) = linear::<F>([form, zero, zero], [x, 0.0], &SCREEN);
            assert!(error > tiny * x);
        }
    }
    tried::<Single>([-127.0, -140.0, -300.0]);
    tried::<Double>([-300.0, -1022.0, -1074.0]);
}

/// k roundings of a term make a little more than k·ROUNDING of it, and the bound itself is rounded k times more in
/// the comparison.
#[test]
fn what_follows_the_first_order_is_within_the_bound() {
    fn tried<F: Format>() {
        let one = F::Number::exact(1.0);
        let sampled = Screen {
            margin: 0.5,
            ..SCREEN
        };
        let bounds = [
            (
                LINEAR_ROUNDINGS,
                linear::<F>([one; 3], [1.0; 2], &SCREEN).1,
                3.0,
            ),
            (
                SAMPLED_QUADRATIC_ROUNDINGS,
                quadratic::<F>([one; 6], [1.0; 2], &sampled).1,
                6.0,
            ),
        ];
        for (roundings, bound, terms) in bounds {
            // A result r is off from the exact one by ROUNDING·|r| at most: by a factor of 1/(1 − ROUNDING).
            let grown = -roundings * (-F::ROUNDING).ln_1p();
            let (off, left) = (grown.exp_m1(), bound * (-grown).exp());
            assert!(terms * off < left, "{roundings}");
            // FLOOR is all that is more.
            assert!(left - FLOOR * GROWTH < 1.001 * terms * off);
        }
    }
    tried::<Single>();
    tried::<Double>();
}

/// Offsets that are handed over are rounded to f32 on their way to a device; f64 has them as they are.
#[test]
fn offsets_that_are_rounded_count() {
    let given = Screen {
        margin: 0.5,
        lattice: 0.0,
        ..SCREEN
    };
    assert_eq!(given.offset_error::<Single>(), OFFSET_ERROR);
    assert_eq!(given.offset_error::<Double>(), 0.0);
    assert_eq!(SCREEN.offset_error::<Single>(), 0.0);
    let slope = |screen| linear::<Single>([Bounded::exact(1.0); 3], [1.0; 2], screen).1;
    let computed = Screen {
        lattice: 1.0 / 1024.0,
        ..given
    };
    assert!(slope(&given) > slope(&computed) + 1.9 * OFFSET_ERROR);
}

/// The f32 next below: less than a result may be.
fn down(value: f64) -> f64 {
    let near = value as f32;
    f64::from(if f64::from(near) < value {
        near
    } else {
        near.next_down()
    })
}

/// What a weight may be off by after so many factors, each of which is off by `counted` roundings, over the bound that
/// `shaders/branch.wgsl` computes for it, with all its own roundings downward.
fn weight_over_bound(factors: u32, counted: f64, growth: f64) -> f64 {
    let u = down(U);
    let (grown, more) = (down(1.0 + growth * u), down(counted * u));
    let (mut off, mut bound) = (1.0, 0.0);
    for _ in 0..factors {
        off *= (1.0 - ROUNDING).powf(-counted);
        bound = down(down(grown * bound) + more);
    }
    (off - 1.0) / bound
}

#[test]
fn the_bound_of_a_weight_holds_after_any_number_of_mirrors_and_panes() {
    for counted in [2.0, 4.0] {
        for factors in [1, 100, 10_000, 50_000] {
            let worst = weight_over_bound(factors, counted, WEIGHT_GROWTH);
            assert!((0.95..1.0).contains(&worst), "{factors}: {worst}");
        }
        assert!(weight_over_bound(10_000, counted, 0.0) > 1.0);
    }
}

/// What a sum of many terms may be off by, each of which is known to a hundredth, over the bound that the shader
/// computes for it, with all its own roundings downward; `own` of them count what the bound has so far, too.
fn sum_over_bound(own: f64) -> f64 {
    let (term, roundings) = (1.0 / 3.0, down(SUM_ROUNDINGS * U));
    let (mut sum, mut off, mut bound) = (0.0, 0.0, 0.0);
    for _ in 0..20_000 {
        sum += term;
        off += 0.01 * term + SUM_ROUNDINGS * ROUNDING * sum;
        let added = down(0.01 * term * GROWTH) + down(roundings * down(sum + own * bound));
        bound = down(bound + down(added));
    }
    off / bound
}

#[test]
fn the_bound_of_a_sum_holds_for_any_number_of_terms() {
    let worst = sum_over_bound(1.0);
    assert!((0.95..1.0).contains(&worst), "{worst}");
    assert!(sum_over_bound(0.0) > 1.0);
}

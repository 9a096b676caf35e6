//! Bounds contain the exact result, are not absurdly wide, and a broken one is noticed.

use super::*;
use crate::real::rational::{Ratio, abs, ratio};

/// Random numbers of many sizes, and numbers next to powers of two and to each other.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let value = (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5;
        match (state >> 7) % 8 {
            0 => 1.0 + value * 4.0 * f64::EPSILON,
            1 => value * 1e-8 + 1.0,
            2 => value * ((state % 61) as f64 - 30.0).exp2(),
            3 => ((state % 100) as f64) / 10.0,
            _ => value * ((state % 13) as f64 - 6.0).exp2(),
        }
    }
}

/// Whether the exact number lies within the bound, the bound times `scale` taken.
fn holds(x: Bounded, exact: &Ratio, scale: f64) -> bool {
    abs(ratio(x.value) - exact) <= ratio(x.error * Bounded::GROW * scale)
}

/// The same of a root, by squares.
fn holds_root(x: Bounded, square: &Ratio, scale: f64) -> bool {
    let error = ratio(x.error * Bounded::GROW * scale);
    let (low, high) = (ratio(x.value) - &error, ratio(x.value) + error);
    (low <= Ratio::ZERO || &low * &low <= *square) && &high * &high >= *square
}

/// How many results of random expressions lie outside of their bounds scaled; and how near the worst comes to its
/// bound.
fn outside(scale: f64, count: usize) -> (usize, f64) {
    let mut next = random();
    let (mut outside, mut worst) = (0, 0.0_f64);
    for _ in 0..count {
        let (a, b, c, d) = (next(), next(), next(), next());
        let [x, y, z, w] = [a, b, c, d].map(Bounded::exact);
        let [ra, rb, rc, rd] = [a, b, c, d].map(ratio);
        let cross = x * y - z * w;
        let exact = &ra * &rb - &rc * &rd;
        let mut check = |good: bool| outside += usize::from(!good);
        check(holds(cross, &exact, scale));
        if cross.error > 0.0 {
            let off = abs(ratio(cross.value) - &exact).to_f64().value();
            worst = worst.max(off / cross.error);
        }
        check(holds(cross.times(d), &(&exact * &rd), scale));
        check(holds(cross.abs().unwrap(), &abs(exact.clone()), scale));
        if b != 0.0 && exact != Ratio::ZERO {
            let quotient = x / y + z;
            check(holds(quotient, &(&ra / &rb + &rc), scale));
            // By what has an error, some of them larger than the number.
            let quotient = z / cross;
            if quotient.error.is_finite() {
                check(holds(quotient, &(&rc / &exact), scale));
            }
        }
        let square = &ra * &ra + &exact * &exact;
        check(holds_root((x * x + cross * cross).sqrt(), &square, scale));
    }
    (outside, worst)
}

#[test]
fn the_bound_contains_the_exact_result() {
    let (outside, worst) = outside(1.0, 200_000);
    assert_eq!(outside, 0);
    // And is not absurdly wide.
    assert!(worst > 0.5, "the bound is never nearer than {worst}");
}

#[test]
fn a_bound_that_is_too_small_is_noticed() {
    assert!(outside(0.0, 1000).0 > 500);
    assert!(outside(0.3, 20_000).0 > 0);
}

#[test]
fn underflow_and_overflow_decide_nothing_wrong() {
    let tiny = Bounded::exact(5e-324);
    for x in [
        tiny * tiny,
        tiny * Bounded::exact(0.25),
        tiny / Bounded::exact(3.0),
    ] {
        assert_eq!(x.sign(), Err(Undecided), "{x:?}");
    }
    let huge = Bounded::exact(1e308);
    for x in [huge * huge, huge + huge, (huge * huge).sqrt(), huge / tiny] {
        assert_eq!(x.sign(), Err(Undecided), "{x:?}");
        assert_eq!(x.floor(), Err(Undecided));
        assert_eq!(x.byte(), Err(Undecided));
        assert_eq!(x.nearest_f32(), Err(Undecided));
    }
    let nothing = huge * huge - huge * huge;
    assert!(nothing.sign().is_err() && nothing.byte().is_err());
    assert!(nothing.sqrt().sign().is_err() && (tiny / nothing).sign().is_err());
}

#[test]
fn what_it_cannot_tell_is_undecided() {
    let third = Bounded::exact(1.0) / Bounded::exact(3.0);
    let nothing = third * Bounded::exact(3.0) - Bounded::exact(1.0);
    assert_eq!(nothing.sign(), Err(Undecided));
    assert_eq!((third * Bounded::exact(3.0)).floor(), Err(Undecided));
    assert_eq!(third.sign(), Ok(Ordering::Greater));
    assert_eq!(third.floor(), Ok(0.0));
    assert_eq!((Bounded::exact(1.0) / nothing).sign(), Err(Undecided));
    assert_eq!(Bounded::exact(2.0).floor(), Ok(2.0));
    assert_eq!((-third).floor(), Ok(-1.0));
    assert_eq!((-third).floor_mod(7), Ok(6));
}

#[test]
fn bytes_and_f32_are_those_of_all_the_interval() {
    let mut next = random();
    let (mut told, mut all) = (0, 0);
    for _ in 0..100_000 {
        let (v, e) = (next().abs(), (next() * 1e-3).powi(4));
        let x = Bounded { value: v, error: e };
        let ends = [(v - e).max(0.0), v + e];
        all += 1;
        if let Ok(byte) = x.byte() {
            told += 1;
            for end in ends {
                let exact = (ratio(end) * ratio(255.0)).canonicalize().floor();
                let exact = u8::try_from(exact).unwrap_or(255);
                assert_eq!(byte, exact, "{x:?}");
            }
        }
        if let Ok(single) = x.nearest_f32() {
            assert!(ends.iter().all(|&end| end as f32 == single), "{x:?}");
        }
    }
    assert!(told * 4 > all * 3, "only {told} of {all} told");
}

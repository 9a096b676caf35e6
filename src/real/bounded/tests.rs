//! Bounds contain the exact result, are not absurdly wide, and a broken one is noticed.

use super::*;
use crate::real::rational::{Ratio, abs, ratio};

/// Random numbers of many sizes, and numbers next to powers of two and to each other.
pub(in crate::real) fn random() -> impl FnMut() -> f64 {
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

/// Numbers of all sizes that f64 has, four of one or two in a row, so that what they make is of any size too.
pub(in crate::real) fn anywhere() -> impl FnMut() -> f64 {
    let mut next = random();
    let (mut sizes, mut left) = ([0; 2], 0);
    move || {
        if left == 0 {
            left = 4;
            // A third of them about the smallest, whose products are none.
            let size = |x: f64| (x.abs() * 1e9) as i32 % 2098 - 1074;
            sizes = [size(next()), size(next())];
            if sizes[0] % 3 == 0 {
                sizes = sizes.map(|size| (size - 1074) / 2);
            }
        }
        left -= 1;
        let (value, size) = (next(), sizes[left % 2]);
        // In two steps, as one need not be an f64.
        let scaled = value * f64::from(size / 2).exp2() * f64::from(size - size / 2).exp2();
        if scaled.is_finite() { scaled } else { value }
    }
}

/// A number type that encloses.
pub(in crate::real) trait Encloses: Real {
    /// The number that the bound is about.
    fn middle(self) -> Ratio;
    /// The bound; none where nothing is known.
    fn bound(self) -> Option<f64>;
}

impl Encloses for Bounded {
    fn middle(self) -> Ratio {
        ratio(self.value)
    }

    fn bound(self) -> Option<f64> {
        (self.value.is_finite() && self.error.is_finite()).then_some(self.error)
    }
}

/// Whether the exact number lies within the bound, the bound times `scale` taken, or nothing is said of it.
fn holds<R: Encloses>(x: R, exact: &Ratio, scale: f64) -> bool {
    let Some(error) = x.bound() else {
        return x.sign().is_err() && x.byte().is_err() && x.floor().is_err();
    };
    abs(x.middle() - exact) <= ratio(error * Bounded::GROW * scale)
}

/// The same of a root, by squares.
fn holds_root<R: Encloses>(x: R, square: &Ratio, scale: f64) -> bool {
    let Some(error) = x.bound() else {
        return x.sign().is_err();
    };
    let error = ratio(error * Bounded::GROW * scale);
    let (low, high) = (x.middle() - &error, x.middle() + error);
    (low <= Ratio::ZERO || &low * &low <= *square) && &high * &high >= *square
}

/// How many results of random expressions lie outside of their bounds scaled; and how near the worst comes to its
/// bound.
pub(in crate::real) fn outside<R: Encloses>(
    mut next: impl FnMut() -> f64,
    scale: f64,
    count: usize,
) -> (usize, f64) {
    let (mut outside, mut worst) = (0, 0.0_f64);
    for _ in 0..count {
        let (a, b, c, d) = (next(), next(), next(), next());
        let [x, y, z, w] = [a, b, c, d].map(R::exact);
        let [ra, rb, rc, rd] = [a, b, c, d].map(ratio);
        let cross = x * y - z * w;
        let exact = &ra * &rb - &rc * &rd;
        let mut check = |good: bool| outside += usize::from(!good);
        check(holds(cross, &exact, scale));
        if b != 0.0 {
            let quotient = &ra / &rb;
            check(holds(R::ratio(&quotient), &quotient, scale));
        }
        if let Some(error) = cross.bound().filter(|error| *error > 0.0) {
            let off = abs(cross.middle() - &exact) / ratio(error);
            worst = worst.max(off.to_f64().value());
        }
        check(holds(cross.times(d), &(&exact * &rd), scale));
        check(holds(cross * cross, &(&exact * &exact), scale));
        if let Ok(size) = cross.abs() {
            check(holds(size, &abs(exact.clone()), scale));
        }
        if b != 0.0 && exact != Ratio::ZERO {
            let quotient = x / y + z;
            check(holds(quotient, &(&ra / &rb + &rc), scale));
            // By what has an error, some of them larger than the number.
            let quotient = z / cross;
            if quotient.bound().is_some() {
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
    let (outside, worst) = outside::<Bounded>(random(), 1.0, 200_000);
    assert_eq!(outside, 0);
    // And is not absurdly wide.
    assert!(worst > 0.5, "the bound is never nearer than {worst}");
}

#[test]
fn the_bound_contains_the_exact_result_of_any_size() {
    let (outside, worst) = outside::<Bounded>(anywhere(), 1.0, 30_000);
    assert_eq!(outside, 0);
    assert!(worst > 0.5, "the bound is never nearer than {worst}");
}

/// What encloses two numbers encloses each, and what is not known to differ has such.
#[test]
fn joined_numbers_hold_for_both() {
    let third = Bounded::exact(1.0) / Bounded::exact(3.0);
    let other = Bounded::exact(1.0) - Bounded::exact(2.0) / Bounded::exact(3.0);
    let both = third.joined(other).unwrap();
    for x in [third, other] {
        assert!(both.value - both.error * Bounded::GROW <= x.value - x.error);
        assert!(both.value + both.error * Bounded::GROW >= x.value + x.error);
    }
    assert_eq!(third.joined(Bounded::exact(0.5)), None);
    assert_eq!(
        Bounded::exact(1.0).joined(Bounded::exact(1.0)),
        Some(Bounded::exact(1.0))
    );
    let unknown = Bounded::exact(1e308) * Bounded::exact(1e308);
    assert_eq!(unknown.joined(unknown), None);
    let more = third.up_to(0.25).unwrap();
    assert!(more.value - more.error <= third.value - third.error);
    assert!(more.value + more.error >= third.value + third.error + 0.25);
    assert!(more.error < 0.126);
}

#[test]
fn a_bound_that_is_too_small_is_noticed() {
    assert!(outside::<Bounded>(random(), 0.0, 1000).0 > 500);
    assert!(outside::<Bounded>(random(), 0.3, 20_000).0 > 0);
}

/// Of a number that may be as large as its bound, 28 squarings are known only by the power of that bound.
#[test]
fn bounds_of_powers_do_not_shrink() {
    let error = f64::from_bits(0x3ff0_0000_24f5_8aa0);
    let base = |grown: bool| {
        let start = Bounded {
            value: f64::MIN_POSITIVE,
            error,
        };
        (0..28).fold(start, |x, _| {
            let square = x * x;
            if grown { square.grown() } else { square }
        })
    };
    let exact = (0..28).fold(ratio(error), |x, _| {
        // Rounded down by much less than f64 does.
        let square = &x * &x * ratio(2_f64.powi(200));
        Ratio::from(square.canonicalize().floor()) / ratio(2_f64.powi(200))
    });
    let holds = |x: Bounded| ratio(x.error * Bounded::GROW) >= exact;
    assert!(holds(base(true)));
    assert!(!holds(base(false)), "the growth is needed");
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

//! Bounds of pairs contain the exact result, are not absurdly wide, and a broken one is noticed.

use dashu_base::SquareRoot;

use super::*;
use crate::real::Lazy;
use crate::real::bounded::tests::{Encloses, anywhere, outside, random};
use crate::real::rational::abs;

impl Encloses for Pair {
    fn middle(self) -> Ratio {
        ratio(self.high) + ratio(self.low)
    }

    fn bound(self) -> Option<f64> {
        let finite = self.high.is_finite() && self.low.is_finite() && self.error.is_finite();
        finite.then_some(self.error)
    }
}

#[test]
fn the_bound_contains_the_exact_result() {
    assert_eq!(outside::<Pair>(random(), 1.0, 200_000).0, 0);
}

#[test]
fn the_bound_contains_the_exact_result_of_any_size() {
    assert_eq!(outside::<Pair>(anywhere(), 1.0, 30_000).0, 0);
}

#[test]
fn a_bound_that_is_too_small_is_noticed() {
    assert!(outside::<Pair>(random(), 0.0, 1000).0 > 500);
    assert!(outside::<Pair>(random(), 0.1, 20_000).0 > 0);
}

/// Pairs with nothing known to be wrong: the low part is as large as it may be, or nearly.
fn pairs() -> impl FnMut() -> Pair {
    let mut next = random();
    move || {
        let (high, rest) = (next(), next());
        let high = if high == 0.0 { 1.0 } else { high };
        let half = 0.5 * (high.next_up() - high);
        let sign = if rest < 0.0 { -1.0 } else { 1.0 };
        Pair::of(high, half * sign * (1.0 - rest.abs() % 0.1), 0.0)
    }
}

/// The largest error of an operation on pairs without error, in units of u² of `size`.
fn worst(mut error: impl FnMut(Pair, Pair) -> (Ratio, f64)) -> f64 {
    let mut next = pairs();
    let unit = Ratio::ONE / ratio(U2);
    (0..100_000).fold(0.0, |worst: f64, _| {
        let (off, size) = error(next(), next());
        worst.max((abs(off) * &unit / ratio(size)).to_f64().value())
    })
}

/// Each constant is more than what was seen, and not more than some times that.
#[test]
fn every_constant_is_enough_and_not_much_too_large() {
    let sum = worst(|x, y| {
        let z = x + y;
        (
            z.middle() - (x.middle() + y.middle()),
            x.high.abs() + y.high.abs(),
        )
    });
    let product = worst(|x, y| {
        let z = x * y;
        (
            z.middle() - x.middle() * y.middle(),
            (x.high * y.high).abs(),
        )
    });
    let multiple = worst(|x, y| {
        let z = x.times(y.high);
        (
            z.middle() - x.middle() * ratio(y.high),
            (x.high * y.high).abs(),
        )
    });
    let quotient = worst(|x, y| {
        let z = x / y;
        (
            z.middle() - x.middle() / y.middle(),
            (x.high / y.high).abs(),
        )
    });
    let root = worst(|x, _| {
        let x = x.abs().unwrap();
        let z = x.sqrt();
        // By 400 bits of the root.
        let shift = ratio(2_f64.powi(400));
        let square = (x.middle() * &shift * &shift).canonicalize().floor();
        let exact = Ratio::from(square.into_parts().1.sqrt()) / shift;
        (z.middle() - exact, x.high.sqrt())
    });
    for (name, seen, constant) in [
        ("sum", sum, SUM),
        ("product", product, PRODUCT),
        ("multiple", multiple, MULTIPLE),
        ("quotient", quotient, QUOTIENT),
        ("root", root, ROOT),
    ] {
        assert!(
            seen < constant && constant < 5.0 * seen,
            "{name}: {seen} of {constant}"
        );
    }
}

#[test]
fn underflow_and_overflow_decide_nothing_wrong() {
    let tiny = Pair::exact(5e-324);
    for x in [
        tiny * tiny,
        tiny * Pair::exact(0.25),
        tiny / Pair::exact(3.0),
    ] {
        assert_eq!(x.sign(), Err(Undecided), "{x:?}");
    }
    let huge = Pair::exact(1e308);
    for x in [
        huge * huge,
        huge + huge,
        (huge * huge).sqrt(),
        huge / tiny,
        // No overflow, but of what is needed for the rest.
        huge * Pair::exact(1e-300),
        huge.times(0.5),
        Pair::exact(1e305).sqrt() / Pair::exact(1e305),
    ] {
        assert!(x.error.is_infinite(), "{x:?}");
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
fn what_it_cannot_tell_is_undecided_and_what_f64_cannot_it_can() {
    let third = Pair::exact(1.0) / Pair::exact(3.0);
    let nothing = third * Pair::exact(3.0) - Pair::exact(1.0);
    assert_eq!(nothing.sign(), Err(Undecided));
    assert_eq!((third * Pair::exact(3.0)).floor(), Err(Undecided));
    let hair = Pair::exact(1e-28);
    assert_eq!((nothing + hair).sign(), Ok(Ordering::Greater));
    assert_eq!((nothing - hair).sign(), Ok(Ordering::Less));
    assert_eq!((Pair::exact(5.0) - hair).floor(), Ok(4.0));
    assert_eq!((Pair::exact(5.0) + hair).floor(), Ok(5.0));
    assert_eq!((-hair).floor(), Ok(-1.0));
    assert_eq!((-third).floor_mod(7), Ok(6));
    assert_eq!(Pair::exact(2.0).floor(), Ok(2.0));
    let byte = |x: Pair| (Pair::exact(100.0) / Pair::exact(255.0) + x).byte();
    assert_eq!([byte(hair), byte(-hair)], [Ok(100), Ok(99)]);
    assert_eq!(byte(Pair::zero()), Err(Undecided));
    let between = Pair::exact(1.0 + 2_f64.powi(-24));
    assert_eq!((between + hair).nearest_f32(), Ok(1.0_f32.next_up()));
    assert_eq!((between - hair).nearest_f32(), Ok(1.0));
}

/// Powers and cosines against balls of many bits.
#[test]
fn powers_and_cosines_contain_the_exact_ones() {
    let within = |x: Pair, exact: Lazy| {
        let off = Lazy::exact(x.high) + Lazy::exact(x.low) - exact;
        let Bounded { value, error } = off.bounded();
        assert!(
            value.abs() - error <= x.error * Bounded::GROW,
            "{x:?}: off by {value:e}"
        );
        assert!(x.error < 1e-27 * x.high.abs(), "{x:?}");
    };
    for exponent in [0.3, 0.5, 1.0, 2.7, 20.0, 20.5, 63.999, 400.0] {
        for base in [0.9, 0.99, 0.5] {
            within(
                Pair::exact(base).pow(exponent),
                Lazy::exact(base).pow(exponent),
            );
        }
    }
    for angle in [1e-9, 0.1, 12.0, 25.0, 36.0, 77.7, 90.1, 179.9] {
        within(Pair::cos_degrees(angle), Lazy::cos_degrees(angle));
        if let Some(versine) = Pair::versine_degrees(angle) {
            within(versine, Lazy::versine_degrees(angle).unwrap());
        }
    }
    assert_eq!(Pair::cos_degrees(60.0), Pair::exact(0.5));
}

/// What encloses two numbers encloses each, and what is not known to differ has such.
#[test]
fn joined_numbers_hold_for_both() {
    let third = Pair::exact(1.0) / Pair::exact(3.0);
    let other = Pair::exact(1.0) - Pair::exact(2.0) / Pair::exact(3.0);
    let both = third.joined(other).unwrap();
    for x in [third, other] {
        let apart = abs(x.middle() - both.middle()) + ratio(x.error);
        assert!(apart <= ratio(both.error * Bounded::GROW));
    }
    assert_eq!(third.joined(third + Pair::exact(1e-25)), None);
    assert_eq!(
        Pair::exact(1.0).joined(Pair::exact(1.0)).map(|x| x.high),
        Some(1.0)
    );
    let more = third.up_to(0.25).unwrap();
    assert!(more.high - more.error <= third.high && more.high + more.error >= third.high + 0.25);
    assert!(more.error < 0.126);
}

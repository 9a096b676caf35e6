//! The oracle's own arithmetic: balls hold what they must and are small, towers find zeros and only zeros, cosines are
//! right.
//!
//! What the oracle says about pictures rests on this and on the text of docs/SCENE.md.

use std::cmp::Ordering;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;
use proptest::prelude::*;

use crate::oracle::angle;
use crate::oracle::ball::Ball;
use crate::oracle::real::{Real, Unresolved};
use crate::oracle::tower::{self, Limits};

const SOME: Limits = Limits {
    roots: 7,
    work: 1_000_000_000,
};

fn number(n: i64) -> Real {
    Real::integer(n)
}

/// Whether a number may lie in a ball.
fn holds(ball: &Ball, exact: &RBig) -> bool {
    // exact − ball contains 0: its sign is open or zero.
    let difference = ball.sub(&Ball::ratio(exact, 2_000), 2_000);
    matches!(difference.sign(), None | Some(Ordering::Equal))
}

fn ratio() -> impl Strategy<Value = RBig> {
    (any::<i64>(), 1_u64.., -80_i32..80, any::<bool>()).prop_map(|(over, under, shift, short)| {
        let over = if short { over % 8 } else { over };
        let under = if short { under % 8 + 1 } else { under };
        let power = RBig::from(UBig::ONE << shift.unsigned_abs() as usize);
        let ratio = RBig::from(over) / RBig::from(under);
        if shift < 0 {
            ratio / power
        } else {
            ratio * power
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn balls_hold_the_exact_results(a in ratio(), b in ratio(), c in ratio(), bits in prop::sample::select(vec![8_usize, 60, 192])) {
        let (x, y, z) = (Ball::ratio(&a, bits), Ball::ratio(&b, bits), Ball::ratio(&c, bits));
        prop_assert!(holds(&x, &a));
        prop_assert!(x.certain_bits() >= bits - 2 || a.is_zero());
        // Two operations deep, so that operands have a radius.
        let sum = x.add(&y, bits);
        prop_assert!(holds(&sum, &(&a + &b)));
        prop_assert!(holds(&sum.mul(&z, bits), &((&a + &b) * &c)));
        prop_assert!(holds(&sum.sub(&z, bits), &(&a + &b - &c)));
        let product = x.mul(&y, bits);
        prop_assert!(holds(&product, &(&a * &b)));
        prop_assert!(product.certain_bits() >= bits - 4 || a.is_zero() || b.is_zero());
        prop_assert!(holds(&product.add(&z, bits), &(&a * &b + &c)));
        if !c.is_zero() {
            let quotient = product.div(&z, bits);
            prop_assert!(holds(&quotient, &(&a * &b / &c)));
            prop_assert!(quotient.certain_bits() >= bits - 5 || a.is_zero() || b.is_zero());
            if &a + &b != RBig::ZERO {
                prop_assert!(holds(&z.div(&sum, bits), &(&c / (&a + &b))));
            }
        }
    }

    #[test]
    fn balls_hold_the_roots(a in ratio(), b in ratio(), bits in prop::sample::select(vec![8_usize, 60, 192])) {
        // √(a²) and √((a + b)²), of balls with and without a radius.
        let square = Ball::ratio(&(&a * &a), bits);
        let positive = if a < RBig::ZERO { -a.clone() } else { a.clone() };
        prop_assert!(holds(&square.sqrt(bits), &positive));
        prop_assert!(square.sqrt(bits).certain_bits() >= bits - 3 || a.is_zero());
        let sum = Ball::ratio(&a, bits).add(&Ball::ratio(&b, bits), bits);
        let root = sum.mul(&sum, bits).sqrt(bits);
        let exact = &a + &b;
        let positive = if exact < RBig::ZERO { -exact } else { exact };
        prop_assert!(holds(&root, &positive));
    }

}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whole_parts_are_exact(a in ratio(), n in -1_000_i64..1_000) {
        // n − a + a is n, on the border; a little less is not.
        let a = Real::ratio(a);
        let tie = &(&number(n) - &a) + &a;
        prop_assert_eq!(tie.floor().unwrap(), IBig::from(n));
        let hair = Real::ratio(RBig::from(1) / RBig::from(UBig::ONE << 3_000));
        prop_assert_eq!((&tie - &hair).floor().unwrap(), IBig::from(n - 1));
        prop_assert_eq!((&tie + &hair).floor().unwrap(), IBig::from(n));
    }

    #[test]
    fn towers_find_zeros(a in 2_i64..50, b in 2_i64..50, c in 1_i64..50, d in 1_i64..9) {
        // (√a + √b)² = a + b + 2√(ab), however it is spelt; √(a + b + 2√(ab)) is in the tower without being seen to be.
        let root = |n: i64| number(n).sqrt();
        let sum = &root(a) + &root(b);
        let nested = (&number(a + b) + &(&number(2) * &root(a * b))).sqrt();
        let tie = &sum - &nested;
        prop_assert!(tie.is_zero().unwrap());
        // One more storey, through a quotient: 1/(√(c + tie) + d) − 1/(√c + d).
        let over = |x: &Real| &number(1) / &(&x.sqrt() + &number(d));
        let deeper = &over(&(&number(c) + &tie)) - &over(&number(c));
        prop_assert!(deeper.is_zero().unwrap());
        // And what is not zero, by 2^-5000, is not.
        let hair = Real::ratio(RBig::from(1) / RBig::from(UBig::ONE << 5_000));
        prop_assert_eq!((&tie + &hair).sign().unwrap(), Ordering::Greater);
        prop_assert_eq!((&tie - &hair).sign().unwrap(), Ordering::Less);
    }
}

#[test]
fn nothing_is_known_of_a_quotient_by_what_may_be_zero() {
    let bits = 60;
    let ball = |n: i64, error: i64| Ball::around(IBig::from(n), &IBig::from(error), 0, bits);
    let one = ball(1, 0);
    // Up to zero, and beyond it.
    for divisor in [
        ball(1 << 40, 1 << 40),
        ball(-3, 3),
        ball(1, 5),
        ball(0, 1),
        ball(0, 0),
    ] {
        assert_eq!(one.div(&divisor, bits).sign(), None);
    }
    assert_eq!(one.div(&ball(-4, 1), bits).sign(), Some(Ordering::Less));
    // The root of what may be zero is not negative, and no more is known.
    let root = ball(3, 3).sqrt(bits);
    assert_eq!(root.sign(), None);
    assert!(holds(&root, &RBig::ZERO) && holds(&root, &RBig::from(2)));
    assert_eq!(root.sub(&ball(3, 0), bits).sign(), Some(Ordering::Less));
}

#[test]
fn a_root_of_zero_divides_nothing() {
    let zero = &(&number(2).sqrt() * &number(3).sqrt()) - &number(6).sqrt();
    assert_eq!(tower::sign(&zero.sqrt(), SOME), Some(Ordering::Equal));
    // 1/(√6 + √2·√3), where the norm 6 − 6 is zero.
    let sum = &number(6).sqrt() + &(&number(2).sqrt() * &number(3).sqrt());
    let half = &(&number(1) / &sum) - &(&number(1) / &(&number(2) * &number(6).sqrt()));
    assert!(half.is_zero().unwrap());
}

#[test]
fn what_is_too_deep_is_not_guessed() {
    // Two sums of twelve roots that are equal: no tower of 7 holds them, no ball separates them.
    let primes = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    let sum = |order: &mut dyn Iterator<Item = i64>| {
        order.fold(number(0), |sum, p| &sum + &number(p).sqrt())
    };
    let tie = &sum(&mut primes.into_iter()) - &sum(&mut primes.into_iter().rev());
    assert_eq!(tie.sign(), Err(Unresolved));
}

#[test]
fn cosines_of_constructed_angles_are_roots() {
    let same = |degrees: f64, want: Real| {
        assert!(
            (&angle::cosine_of(degrees) - &want).is_zero().unwrap(),
            "{degrees}"
        );
    };
    let half = |real: Real| &real / &number(2);
    same(180.0, number(-1));
    same(90.0, number(0));
    same(60.0, half(number(1)));
    same(120.0, half(number(-1)));
    same(45.0, half(number(2).sqrt()));
    same(30.0, half(number(3).sqrt()));
    same(22.5, half((&number(2) + &number(2).sqrt()).sqrt()));
    same(
        75.0,
        &half(half(&number(6).sqrt() - &number(2).sqrt())) * &number(1),
    );
    same(36.0, half(half(&number(1) + &number(5).sqrt())));
}

#[test]
fn both_ways_to_a_cosine_agree() {
    // Roots and series, which share nothing; and cos 3x = 4 cos³ x − 3 cos x of series alone.
    let series = |degrees: RBig| Real::cosine(degrees);
    let near = |a: &Real, b: &Real| {
        let hair = Real::ratio(RBig::from(1) / RBig::from(UBig::ONE << 900));
        let apart = a - b;
        (&apart - &hair).sign() == Ok(Ordering::Less)
            && (&apart + &hair).sign() == Ok(Ordering::Greater)
    };
    for threes in 1..=60 {
        let degrees = RBig::from(3 * threes);
        let root = angle::cosine_of(f64::from(3 * threes));
        assert!(near(&root, &series(degrees)), "{}", 3 * threes);
    }
    for degrees in [1e-300, 1e-3, 1.0, 10.0, 20.0, 33.3, 55.5] {
        let exact = RBig::try_from(degrees).unwrap();
        let c = series(exact.clone());
        let triple = &(&number(4) * &(&c * &c.square())) - &(&number(3) * &c);
        assert!(near(&triple, &series(exact * RBig::from(3))), "{degrees}");
    }
    // 20 degrees are not to be made by ruler and compass; its cosine solves 8c³ − 6c = 1 and no tower says so.
    let c = angle::cosine_of(20.0);
    assert_eq!(tower::sign(&c, SOME), None);
    assert!(near(
        &(&(&number(8) * &(&c * &c.square())) - &(&number(6) * &c)),
        &number(1)
    ));
}

#[test]
fn powers_are_squares_and_roots() {
    let half = &number(1) / &number(2);
    let is = |x: &Real, want: &Real| (x - want).is_zero().unwrap();
    assert!(is(&half.power(1.0).unwrap(), &half));
    assert!(is(&half.power(5.0).unwrap(), &(&number(1) / &number(32))));
    assert!(is(&half.power(0.5).unwrap(), &half.sqrt()));
    assert!(is(
        &half.power(2.25).unwrap(),
        &(&half.square() * &half.sqrt().sqrt())
    ));
    // Of a number that is 1 without being seen to be, whatever the exponent.
    let one = &number(2).sqrt().square() / &number(2);
    assert!(is(&one.power(0.1).unwrap(), &number(1)));
    assert!(is(&one.power(1e300).unwrap(), &number(1)));
    // Too small for any ball to tell from zero: so said, not guessed.
    let nothing = half.power(1e300).unwrap();
    assert_eq!((&nothing - &number(1)).sign(), Ok(Ordering::Less));
    assert_eq!((&nothing + &number(1)).byte(), Err(Unresolved));
    let little = half.power(3e3).unwrap();
    assert_eq!((&little + &number(1)).byte(), Ok(1));
    assert_eq!((&number(1) - &little).byte(), Ok(0));
}

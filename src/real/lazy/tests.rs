//! Balls contain what they stand for, and ties are proven or not there.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::arena::with;
use super::ball::Ball;
use super::mag::Mag;
use super::{Effort, Lazy, cosine};
use crate::real::rational::{Ratio, abs, power_of_two, ratio};
use crate::real::{Bounded, Real, Undecided};

fn number(value: f64) -> Lazy {
    Lazy::exact(value)
}

fn root(value: f64) -> Lazy {
    number(value).sqrt()
}

/// Random numbers of many sizes, few bits and many.
fn random() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let bits = state >> 11;
        let bits = if state.is_multiple_of(3) {
            bits >> 45
        } else {
            bits
        };
        let value = (bits as f64 - 100.0) * ((state >> 3) as f64 % 60.0 - 30.0).exp2();
        if state.is_multiple_of(17) { 0.0 } else { value }
    }
}

#[test]
fn roots_that_cancel_are_proven_to() {
    let vanish = [
        root(2.0) * root(3.0) - root(6.0),
        (number(5.0) + number(2.0) * root(6.0)).sqrt() - root(2.0) - root(3.0),
        (number(3.0) + number(2.0) * root(2.0)).sqrt() - number(1.0) - root(2.0),
        number(1.0) / number(3.0) * number(3.0) - number(1.0),
        (root(5.0) - number(1.0)) * number(0.25) - Lazy::cos_degrees(72.0),
    ];
    for (i, x) in vanish.into_iter().enumerate() {
        assert_eq!(x.sign(), Ok(Ordering::Equal), "{i}");
        assert_eq!(Lazy::effort(), Effort::Proven, "{i}");
        let nodes = Lazy::mark();
        assert_eq!(x.sign(), Ok(Ordering::Equal), "{i}");
        assert_eq!(x.bounded(), Bounded::exact(0.0), "{i} is known by now");
        Lazy::release(nodes);
        assert_eq!(Lazy::effort(), Effort::Proven, "{i}");
    }
    // 10⁻³⁰⁰ · 10³⁰⁰ is not 1 in the numbers that a double holds.
    let nearly = root(1e-300) * root(1e300) - number(1.0);
    assert_ne!(nearly.sign(), Ok(Ordering::Equal));
}

#[test]
fn what_nearly_vanishes_is_not_zero() {
    // A sphere of radius 1 + 2⁻⁵¹ at offset (1, 2⁻²⁵): its discriminant is 2⁻¹⁰².
    let radius = number(1.0 + 2.0_f64.powi(-51));
    let offset = [number(1.0), number(2.0_f64.powi(-25))];
    let disc = radius * radius - (offset[0] * offset[0] + offset[1] * offset[1]);
    assert_eq!(disc.sign(), Ok(Ordering::Greater));
    assert_eq!(Lazy::effort(), Effort::Precision);
    assert_eq!(disc.bounded().value, 2.0_f64.powi(-102));
    // Numbers 10⁻²⁸⁰ apart, with more roots than are tried exactly, and with fewer.
    let tiny = number(1e-140) * number(1e-140);
    let sum = root(17.0)
        + root(19.0)
        + root(2.0)
        + root(3.0)
        + root(5.0)
        + root(7.0)
        + root(11.0)
        + root(13.0);
    assert_eq!(
        (sum + tiny
            - (root(19.0)
                + root(17.0)
                + root(13.0)
                + root(11.0)
                + root(7.0)
                + root(5.0)
                + root(3.0)
                + root(2.0)))
        .sign(),
        Ok(Ordering::Greater)
    );
    assert_eq!((root(2.0) - tiny - root(2.0)).sign(), Ok(Ordering::Less));
    assert_eq!(Lazy::effort(), Effort::Precision);
}

#[test]
fn a_tie_of_too_many_roots_is_presumed_and_said_so() {
    let sum = |order: &[f64]| order.iter().fold(number(0.0), |sum, &n| sum + root(n));
    let primes = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0];
    let back: Vec<f64> = primes.into_iter().rev().collect();
    let x = sum(&primes) - sum(&back);
    assert_eq!(x.sign(), Ok(Ordering::Equal));
    assert_eq!(Lazy::effort(), Effort::Presumed);
    // Six are proven.
    let x = sum(&primes[..6]) - sum(&back[2..]);
    assert_eq!(x.sign(), Ok(Ordering::Equal));
    assert_eq!(Lazy::effort(), Effort::Proven);
}

#[test]
fn division_by_zero_is_undecided_and_no_panic() {
    let zero = root(2.0) * root(2.0) - number(2.0);
    assert_eq!((number(1.0) / zero).sign(), Err(Undecided));
    assert_eq!((number(1.0) / number(0.0)).sign(), Err(Undecided));
    assert_eq!((number(1.0) / zero).floor(), Err(Undecided));
    assert_eq!(number(f64::NAN).sign(), Err(Undecided));
    assert_eq!((root(2.0) - number(3.0)).sqrt().sign(), Err(Undecided));
    assert_eq!(zero.sqrt().sign(), Ok(Ordering::Equal));
}

#[test]
fn sizes_beyond_f64_are_no_obstacle() {
    let huge = number(1e300) * number(1e300);
    assert_eq!(
        (huge - huge * number(1.0 + f64::EPSILON)).sign(),
        Ok(Ordering::Less)
    );
    assert_eq!((huge.sqrt() - number(1e300)).sign(), Ok(Ordering::Equal));
    let tiny = number(5e-324) * number(5e-324);
    assert_eq!(tiny.sign(), Ok(Ordering::Greater));
    assert_eq!((number(1.0) / tiny).sqrt().sign(), Ok(Ordering::Greater));
    // 0.5 to the power of 10³⁰⁰ is beyond what an exponent holds, and 0 for all that asks.
    let power = number(0.5).pow(1e300);
    assert!(power.byte() == Ok(0) && power.nearest_f32() == Ok(0.0));
}

#[test]
fn floors_at_integers_are_exact() {
    let third = number(1.0) / number(3.0);
    assert_eq!((third * number(3.0)).floor(), Ok(1.0));
    assert_eq!((third * number(3.0) - number(1e-200)).floor(), Ok(0.0));
    assert_eq!((-(root(2.0) * root(2.0))).floor(), Ok(-2.0));
    assert_eq!(
        (-(root(2.0) * root(2.0)) - number(1e-200)).floor(),
        Ok(-3.0)
    );
    let big = number(2.0_f64.powi(60)) * third * number(3.0) + number(1.0);
    assert_eq!(big.floor_mod(2), Ok(1));
    assert_eq!((big - number(1e-100)).floor_mod(2), Ok(0));
    assert_eq!((-big).floor_mod(5), Ok(3), "2⁶⁰ + 1 is 2 modulo 5");
    assert_eq!(big.floor(), Err(Undecided), "no f64 is 2⁶⁰ + 1");
}

#[test]
fn whole_bytes_are_exact() {
    for n in 0..=255 {
        let v = (root(f64::from(n)) * root(f64::from(n))) / number(255.0);
        assert_eq!(v.byte(), Ok(n as u8));
        if n > 0 {
            assert_eq!((v - number(1e-100)).byte(), Ok((n - 1) as u8));
        }
    }
}

#[test]
fn the_nearest_f32_breaks_ties_to_even() {
    let exact = |x: f64| root(2.0) * root(2.0) * number(x * 0.5);
    let e = f64::from(f32::EPSILON);
    assert_eq!(exact(1.0 + 0.5 * e).nearest_f32(), Ok(1.0));
    assert_eq!(
        exact(1.0 + 1.5 * e).nearest_f32(),
        Ok(1.0 + 2.0 * f32::EPSILON)
    );
    assert_eq!(
        (exact(1.0 + 0.5 * e) + number(1e-100)).nearest_f32(),
        Ok(1.0 + f32::EPSILON)
    );
    assert_eq!(exact(2.0_f64.powi(-150)).nearest_f32(), Ok(0.0));
    assert_eq!(
        (exact(2.0_f64.powi(-150)) + number(1e-200)).nearest_f32(),
        Ok(f32::from_bits(1))
    );
    assert_eq!(exact(1e300).nearest_f32(), Ok(f32::INFINITY));
    let end = f64::from(f32::MAX);
    assert_eq!(
        exact(end + 2.0_f64.powi(103)).nearest_f32(),
        Ok(f32::INFINITY)
    );
    assert_eq!(
        (exact(end + 2.0_f64.powi(103)) - number(1.0)).nearest_f32(),
        Ok(f32::MAX)
    );
}

/// A ball's middle, exactly, and its radius.
fn parts(ball: &Ball) -> (Ratio, Ratio) {
    let near = ball.bounded();
    (ratio(near.value), ratio(near.error))
}

/// Balls of few bits, so that their radii count, against rationals.
#[test]
fn balls_contain_the_exact_result() {
    let mut next = random();
    let mut widest: f64 = 0.0;
    let contains = |ball: &Ball, exact: &Ratio, what: &str| {
        let (middle, radius) = parts(ball);
        let off = abs(middle - exact.clone());
        assert!(
            off <= radius,
            "{what}: off by {} of {}",
            off.to_f64().value(),
            radius.to_f64().value()
        );
    };
    for _ in 0..20_000 {
        let (a, b, c) = (next(), next(), next());
        let bits = 20;
        let around = |x: f64, y: f64| {
            // A ball around x that holds numbers e away, and one of these.
            let e = (y.abs() * 1e-3).min(1e12);
            let radius = Mag::above(&IBig::from((e * 1024.0) as i64 + 1), -10);
            let ball = Ball::exact(x).add(&Ball::new(IBig::ZERO, 0, radius), bits);
            let ball = ball.unwrap();
            (ball, ratio(x) + ratio(e * 0.999))
        };
        let ((x, rx), (y, ry)) = (around(a, b), around(b, c));
        contains(&x, &rx, "a");
        contains(&x.add(&y, bits).unwrap(), &(&rx + &ry), "sum");
        contains(&x.add(&y.neg(), bits).unwrap(), &(&rx - &ry), "difference");
        contains(&x.mul(&y, bits).unwrap(), &(&rx * &ry), "product");
        if let Some(q) = x.div(&y, bits) {
            contains(&q, &(&rx / &ry), "quotient");
        } else {
            assert!(
                abs(ratio(b)) <= ratio((c.abs() * 1e-3).min(1e12) + 0.1) + ratio(b.abs() * 1e-5),
                "{b} ± {c} is clear of 0"
            );
        }
        let (s, rs) = (x.mul(&x, 53).unwrap(), &rx * &rx);
        if let Some(root) = s.sqrt(bits) {
            contains(&root, &abs(rx), "root");
        }
        let fine = Ball::exact(a).mul(&Ball::exact(b), 128).unwrap();
        let fine = fine.add(&Ball::exact(c), 128).unwrap();
        contains(&fine, &(ratio(a) * ratio(b) + ratio(c)), "fine");
        if rs > ratio(0.0) && a != 0.0 && b != 0.0 {
            let q = Ball::exact(a)
                .div(&Ball::exact(b), 128)
                .unwrap()
                .mul(&Ball::exact(b), 128)
                .unwrap();
            let off = q.add(&Ball::exact(-a), 128).unwrap();
            assert_eq!(off.sign(), None, "{a} / {b}");
            let off = off.bounded();
            widest = widest.max((off.error + off.value.abs()) / a.abs());
        }
    }
    assert!(
        widest < 1e-36 && widest > 1e-40,
        "128 bits are good for {widest}"
    );
}

#[test]
fn balls_round_to_the_nearest_integer() {
    for (value, whole) in [
        (2.4, 2),
        (2.6, 3),
        (-2.4, -2),
        (-2.6, -3),
        (0.2, 0),
        (-0.2, 0),
        (1e15, 1_000_000_000_000_000_i64),
    ] {
        assert_eq!(
            Ball::exact(value).integer(),
            Some(IBig::from(whole)),
            "{value}"
        );
    }
}

#[test]
fn balls_in_f64_keep_what_they_stand_for() {
    let mut next = random();
    for i in 0..20_000 {
        let (a, b) = (next(), next());
        let scale = i % 2200 - 1100;
        let product = Ball::exact(a).mul(&Ball::exact(b), 300).unwrap();
        let scaled = product
            .mul(&Ball::new(IBig::ONE, i64::from(scale), Mag::ZERO), 300)
            .unwrap();
        let exact = ratio(a) * ratio(b) * power_of_two(scale);
        let near = scaled.bounded();
        if near.error.is_finite() {
            assert!(
                abs(ratio(near.value) - exact.clone()) <= ratio(near.error),
                "{a}·{b}·2^{scale}"
            );
        }
        if near.value != 0.0 && near.value.is_normal() && near.value.abs() > 1e-290 {
            assert!(near.error <= 1e-15 * near.value.abs());
        }
    }
}

#[test]
fn cosines_are_near_the_librarys_and_their_own() {
    for i in 0..=720 {
        let angle = f64::from(i) / 4.0;
        let near = cosine::cosine(angle, 128).bounded();
        let library = angle.to_radians().cos();
        assert!(
            (near.value - library).abs() <= near.error + 1e-15,
            "{angle}"
        );
        assert!(near.error < 1e-15);
        assert_eq!(cosine::by_roots(angle), i % 3 == 0, "{angle}");
        let lazy = Lazy::cos_degrees(angle);
        let fine = with(|arena| arena.ball(lazy, 256));
        let other = cosine::cosine(angle, 256).neg();
        let off = fine.unwrap().add(&other, 256).unwrap();
        assert_ne!(off.sign(), Some(Ordering::Greater), "{angle}");
        assert_ne!(off.sign(), Some(Ordering::Less), "{angle}");
        assert!(off.bounded().error < 1e-70, "{angle}");
    }
    // cos 36° − cos 72° = ½, and cos 15° = (√6 + √2)/4.
    let half = Lazy::cos_degrees(36.0) - Lazy::cos_degrees(72.0) - number(0.5);
    assert_eq!(half.sign(), Ok(Ordering::Equal));
    let fifteen = (root(6.0) + root(2.0)) * number(0.25) - Lazy::cos_degrees(15.0);
    assert_eq!(fifteen.sign(), Ok(Ordering::Equal));
    let twenty_two = (number(2.0) + root(2.0)).sqrt() * number(0.5) - Lazy::cos_degrees(22.5);
    assert_eq!(twenty_two.sign(), Ok(Ordering::Equal));
    assert_eq!(Lazy::effort(), Effort::Proven);
    // cos 20° is no such number: what agrees with it to 3,000 bits is still told apart.
    let (whole, exp) = cosine::cosine(20.0, 3000).middle();
    let near = Lazy::ratio(&(Ratio::from(whole) * power_of_two(exp as i32)));
    assert_ne!((near - Lazy::cos_degrees(20.0)).sign(), Ok(Ordering::Equal));
    assert_eq!(Lazy::effort(), Effort::Precision);
}

#[test]
fn powers_are_products_and_roots() {
    let x = number(0.7);
    for (exponent, other) in [
        (3.0, x * x * x),
        (2.5, x * x * x.sqrt()),
        (0.25, x.sqrt().sqrt()),
        (0.0, number(1.0)),
    ] {
        assert_eq!(
            (x.pow(exponent) - other).sign(),
            Ok(Ordering::Equal),
            "{exponent}"
        );
    }
    for exponent in [12.3, 0.1, 77.7, 1e-9, 1e5 + 0.3] {
        let (lazy, bounded) = (x.pow(exponent).bounded(), Bounded::exact(0.7).pow(exponent));
        let library = 0.7_f64.powf(exponent);
        assert!(
            (lazy.value - library).abs() <= 1e-12 * library,
            "{exponent}"
        );
        assert!(
            (lazy.value - bounded.value).abs() <= lazy.error + bounded.error,
            "{exponent}"
        );
        assert!(
            bounded.error <= 1e-11 * bounded.value + 1e-300,
            "{exponent}: {bounded:?}"
        );
    }
}

/// Expressions at random: the f64 enclosure, the ball and the exact number agree.
#[test]
fn enclosures_contain_the_exact_number() {
    let mut next = random();
    for round in 0..3000 {
        let values: Vec<f64> = (0..4).map(|_| next()).collect();
        let ratios: Vec<Ratio> = values.iter().map(|&x| ratio(x)).collect();
        let lazies: Vec<Lazy> = values.iter().map(|&x| number(x)).collect();
        let x = lazies[0] * lazies[1] - lazies[2] / (lazies[3] * lazies[3] + number(1.0));
        let exact = &ratios[0] * &ratios[1] - &ratios[2] / (&ratios[3] * &ratios[3] + ratio(1.0));
        let near = with(|arena| arena.enclosure(x));
        assert!(
            abs(ratio(near.value) - exact.clone()) <= ratio(near.error * Bounded::GROW),
            "{values:?}"
        );
        assert_eq!(x.sign(), Ok(exact.cmp(&Ratio::ZERO)), "{values:?}");
        let whole = exact.clone().canonicalize().floor();
        if let Ok(floor) = x.floor() {
            assert_eq!(ratio(floor), Ratio::from(whole), "{values:?}");
        }
        let same = (x * x).sqrt() - x.abs().unwrap();
        assert_eq!(same.sign(), Ok(Ordering::Equal));
        if round % 100 == 99 {
            Lazy::clear();
        }
    }
}

//! What the self-test with f64 asks of a device, check by check.

use super::LITERALS;
use crate::gpu::selftest::judging::Check;

const U: f64 = 1.0 / (1_u64 << 53) as f64;

/// Whether a number is 0, or of a size at which no product of a few leaves f64's range.
fn ordinary(value: f64) -> bool {
    let domain = -300f64..=300.0;
    value == 0.0 || domain.contains(&value.abs().log2())
}

/// Whether a result is the nearest; where the exact one is of ordinary size.
fn nearest(right: f64, result: u64) -> Option<bool> {
    ordinary(right).then(|| f64::from_bits(result) == right)
}

/// Whether a result is within so many u of the nearest.
fn near(right: f64, result: u64, roundings: f64) -> Option<bool> {
    let off = (f64::from_bits(result) - right).abs();
    (right.is_normal() && ordinary(right)).then(|| off <= roundings * U * right.abs())
}

/// x + y and what it rounded off.
pub(super) fn two_sum(x: f64, y: f64) -> [f64; 2] {
    let sum = x + y;
    let back = sum - x;
    [sum, (x - (sum - back)) + (y - back)]
}

/// x · y and what it rounded off.
pub(super) fn two_product(x: f64, y: f64) -> [f64; 2] {
    let product = x * y;
    [product, x.mul_add(y, -product)]
}

/// Whether a result is an exact sum: that of the two f64 that are right.
fn parts(right: [f64; 2], results: &[u64]) -> Option<bool> {
    let found = [results[0], results[1]].map(f64::from_bits);
    let fine = |v: f64| v == 0.0 || v.is_normal();
    right
        .iter()
        .all(|v| ordinary(*v) || fine(*v))
        .then(|| two_sum(found[0], found[1]) == two_sum(right[0], right[1]))
}

/// 1/√x to 3 u: r²·x − 1 is twice what r is off by.
fn inverse_root(x: f64, result: u64) -> Option<bool> {
    let (r, x) = (f64::from_bits(result), x.abs());
    if x == 0.0 {
        return None;
    }
    let [square, rest] = two_product(r, r);
    let [one, least] = two_product(square, x);
    let off = 0.5 * ((one - 1.0) + (least + rest * x));
    Some(r.is_finite() && off.abs() <= 3.0 * U)
}

pub(super) const CHECKS: &[Check<[f64; 2], u64>] = &[
    Check {
        name: "f64: x + y",
        asked: "the nearest",
        words: 0..1,
        judge: |[x, y], w| nearest(x + y, w[0]),
    },
    Check {
        name: "f64: x - y",
        asked: "the nearest",
        words: 1..2,
        judge: |[x, y], w| nearest(x - y, w[0]),
    },
    Check {
        name: "f64: x * y",
        asked: "the nearest",
        words: 2..3,
        judge: |[x, y], w| nearest(x * y, w[0]),
    },
    Check {
        name: "f64: x / y",
        asked: "4 u, u = 2^-53",
        words: 3..4,
        judge: |[x, y], w| {
            if y == 0.0 {
                None
            } else {
                near(x / y, w[0], 4.0)
            }
        },
    },
    Check {
        name: "f64: sqrt",
        asked: "2 u",
        words: 4..5,
        judge: |[x, _], w| near(x.abs().sqrt(), w[0], 2.0),
    },
    Check {
        name: "f64: 1 / sqrt",
        asked: "3 u",
        words: 5..6,
        judge: |[x, _], w| inverse_root(x, w[0]),
    },
    Check {
        name: "f64: floor",
        asked: "exact",
        words: 6..7,
        judge: |[x, _], w| nearest(x.floor(), w[0]),
    },
    Check {
        name: "f64: round",
        asked: "exact, halves to even",
        words: 7..8,
        judge: |[x, _], w| nearest(x.round_ties_even(), w[0]),
    },
    Check {
        name: "f64(i32), f64(u32)",
        asked: "exact",
        words: 8..10,
        judge: |[x, _], w| {
            let low = x.to_bits() as u32;
            let right = [f64::from(low as i32), f64::from(low)];
            Some(right.iter().zip(w).all(|(r, w)| f64::from_bits(*w) == *r))
        },
    },
    Check {
        name: "f64: min, max, abs, select",
        asked: "exact",
        words: 10..14,
        judge: |[x, y], w| {
            let right = [x.min(y), x.max(y), x.abs(), if x > y { y } else { x }];
            Some(right.iter().zip(w).all(|(r, w)| f64::from_bits(*w) == *r))
        },
    },
    Check {
        name: "f64: comparisons",
        asked: "exact",
        words: 14..15,
        judge: |[x, y], w| {
            let holds = [x > y, x >= y, x.abs() > y.abs(), x == y];
            let bits = holds.iter().rev();
            let bits = bits.fold(0, |bits, holds| bits << 1 | u64::from(*holds));
            Some(w[0] == bits | u64::from(x.abs() > LITERALS[0]) << 32)
        },
    },
    Check {
        name: "i32(f64), u32(f64)",
        asked: "exact, towards 0",
        words: 15..16,
        judge: |[x, _], w| {
            let right = u64::from(x as i32 as u32) | u64::from(x.abs() as u32) << 32;
            (x.abs() < f64::from(i32::MAX)).then_some(w[0] == right)
        },
    },
    Check {
        name: "f32(f64)",
        asked: "one of the two nearest",
        words: 16..17,
        judge: |[x, _], w| {
            let found = f32::from_bits(w[0] as u32);
            let (below, above) = (found.next_down(), found.next_up());
            let inside = f64::from(below) < x && x < f64::from(above);
            (-100f64..100.0).contains(&x.abs().log2()).then_some(inside)
        },
    },
    Check {
        name: "f64(f32)",
        asked: "exact",
        words: 17..18,
        judge: |[x, _], w| {
            let single = f32::from_bits(x.to_bits() as u32);
            (single == 0.0 || single.is_normal()).then(|| f64::from_bits(w[0]) == f64::from(single))
        },
    },
    Check {
        name: "f64: barrier",
        asked: "the same bits",
        words: 18..19,
        judge: |[x, _], w| Some(w[0] == x.to_bits()),
    },
    Check {
        name: "f64: two_sum behind the barrier",
        asked: "sum + tail exact",
        words: 19..21,
        judge: |[x, y], w| parts(two_sum(x, y), w),
    },
    Check {
        name: "f64: two_prod behind the barrier",
        asked: "product + tail exact",
        words: 21..23,
        judge: |[x, y], w| parts(two_product(x, y), w),
    },
    Check {
        name: "f64: x * literal",
        asked: "the nearest",
        words: 23..24,
        judge: |[x, _], w| nearest(x * LITERALS[0], w[0]),
    },
    Check {
        name: "f64: x + literal",
        asked: "the nearest",
        words: 24..25,
        judge: |[x, _], w| nearest(x + LITERALS[1], w[0]),
    },
    Check {
        name: "f64: literals",
        asked: "the same bits",
        words: 25..26,
        judge: |_, w| Some(w[0] == LITERALS[1].to_bits()),
    },
    Check {
        name: "f64: dot",
        asked: "3 u of the sum of the terms' sizes",
        words: 26..27,
        judge: |[x, y], w| {
            let terms = [[x, y], LITERALS, [y, x]].map(|[a, b]| two_product(a, b));
            let sizes: f64 = terms.iter().map(|[high, _]| high.abs()).sum();
            // x·y comes twice, so that nothing is rounded but the sum with the literals' product.
            let [high, low] = two_sum(2.0 * terms[0][0], terms[1][0]);
            let right = high + (low + 2.0 * terms[0][1] + terms[1][1]);
            let off = (f64::from_bits(w[0]) - right).abs();
            ordinary(sizes).then(|| off <= 3.000_001 * U * sizes + U * right.abs() * 1e-6)
        },
    },
];

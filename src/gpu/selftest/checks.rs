//! What the self-test asks of a device, check by check.

use super::exact;
use super::judging::{Check, Operands};

/// Numbers that stand in the text of the shader, as those of small scenes do.
pub(super) const LITERALS: [f32; 4] = [
    f32::from_bits(0x3fff_ffff),
    f32::from_bits(0x3f80_0001),
    f32::from_bits(0x4040_0003),
    f32::from_bits(0x0080_0001),
];

/// A pair of operands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) a: u32,
    pub(super) b: u32,
}

impl Pair {
    pub(super) fn x(self) -> f32 {
        f32::from_bits(self.a)
    }

    pub(super) fn y(self) -> f32 {
        f32::from_bits(self.b)
    }

    /// Both, if neither is subnormal, so that flushing does not matter.
    fn ordinary(self) -> Option<[f32; 2]> {
        let [x, y] = [self.x(), self.y()];
        (!x.is_subnormal() && !y.is_subnormal()).then_some([x, y])
    }
}

impl Operands for Pair {
    fn shown(self) -> String {
        let (x, y) = (self.x(), self.y());
        format!("x = {x:e} ({:08x}), y = {y:e} ({:08x})", self.a, self.b)
    }
}

/// Every check. The words are in the order in which the shader writes them.
pub(super) const CHECKS: &[Check<Pair, u32>] = &[
    Check {
        name: "x + y",
        asked: "the nearest",
        words: 0..1,
        judge: |p, w| exact::sum(p.x(), p.y(), f32::from_bits(w[0])),
    },
    Check {
        name: "x - y",
        asked: "the nearest",
        words: 1..2,
        judge: |p, w| exact::sum(p.x(), -p.y(), f32::from_bits(w[0])),
    },
    Check {
        name: "x * y",
        asked: "the nearest",
        words: 2..3,
        judge: |p, w| exact::product(p.x(), p.y(), f32::from_bits(w[0])),
    },
    Check {
        name: "x / y",
        asked: "2.5 ulp for 2^-126 <= |y| <= 2^126",
        words: 3..4,
        judge: |p, w| exact::quotient(p.x(), p.y(), f32::from_bits(w[0])),
    },
    Check {
        name: "sqrt",
        asked: "9.2 u, u = 2^-24",
        words: 4..5,
        judge: |p, w| exact::root(p.x(), f32::from_bits(w[0])),
    },
    Check {
        name: "inverseSqrt",
        asked: "2 ulp",
        words: 5..6,
        judge: |p, w| exact::inverse_root(p.x(), f32::from_bits(w[0])),
    },
    Check {
        name: "floor",
        asked: "exact",
        words: 6..7,
        judge: |p, w| exact::whole(p.x(), f32::floor, f32::from_bits(w[0])),
    },
    Check {
        name: "round",
        asked: "exact, halves to even",
        words: 7..8,
        judge: |p, w| exact::whole(p.x(), f32::round_ties_even, f32::from_bits(w[0])),
    },
    Check {
        name: "i32(f32)",
        asked: "exact, towards 0",
        words: 8..9,
        judge: |p, w| {
            let [x, _] = p.ordinary()?;
            (x.abs() < exact::TWO_31).then(|| w[0] == x as i32 as u32)
        },
    },
    Check {
        name: "u32(f32)",
        asked: "exact, towards 0",
        words: 9..10,
        judge: |p, w| {
            let [x, _] = p.ordinary()?;
            (x.abs() < 2.0 * exact::TWO_31).then(|| w[0] == x.abs() as u32)
        },
    },
    Check {
        name: "f32(i32)",
        asked: "one of the two nearest",
        words: 10..11,
        judge: |p, w| {
            Some(exact::nearest_two(
                f64::from(p.a as i32),
                0.0,
                f32::from_bits(w[0]),
            ))
        },
    },
    Check {
        name: "f32(u32)",
        asked: "one of the two nearest",
        words: 11..12,
        judge: |p, w| {
            Some(exact::nearest_two(
                f64::from(p.a),
                0.0,
                f32::from_bits(w[0]),
            ))
        },
    },
    Check {
        name: "min, max, abs, select",
        asked: "exact",
        words: 12..16,
        judge: |p, w| {
            let [x, y] = p.ordinary()?;
            let want = [x.min(y), x.max(y), x.abs(), if x > y { y } else { x }];
            Some(
                want.iter()
                    .zip(w)
                    .all(|(want, word)| *want == f32::from_bits(*word)),
            )
        },
    },
    Check {
        name: "comparisons",
        asked: "exact",
        words: 16..17,
        judge: |p, w| {
            let [x, y] = p.ordinary()?;
            let holds = [x > y, x >= y, x.abs() > y.abs(), x == y];
            Some(
                w[0] == holds
                    .iter()
                    .rev()
                    .fold(0, |bits, holds| bits << 1 | u32::from(*holds)),
            )
        },
    },
    Check {
        name: "u32 arithmetic",
        asked: "exact modulo 2^32",
        words: 17..21,
        judge: |p, w| {
            let (a, b) = (p.a, p.b);
            let shifted = a << (b & 31) ^ a >> (b & 31);
            Some(
                w == [
                    a.wrapping_add(b),
                    a.wrapping_sub(b),
                    a.wrapping_mul(b),
                    shifted,
                ],
            )
        },
    },
    Check {
        name: "i32 arithmetic",
        asked: "exact modulo 2^32",
        words: 21..23,
        judge: |p, w| {
            let (a, b) = (p.a as i32, p.b as i32);
            Some(w == [a.wrapping_mul(b) as u32, (a >> (b & 31)) as u32])
        },
    },
    Check {
        name: "barrier",
        asked: "the same bits",
        words: 23..24,
        judge: |p, w| {
            let [x, _] = p.ordinary()?;
            Some(w[0] == x.to_bits())
        },
    },
    Check {
        name: "two_sum behind the barrier",
        asked: "sum + tail exact",
        words: 24..26,
        judge: |p, w| exact::two_sum(p.x(), p.y(), f32::from_bits(w[0]), f32::from_bits(w[1])),
    },
    Check {
        name: "two_prod behind the barrier",
        asked: "product + tail exact",
        words: 26..28,
        judge: |p, w| exact::two_prod(p.x(), p.y(), f32::from_bits(w[0]), f32::from_bits(w[1])),
    },
    Check {
        name: "literals",
        asked: "the same bits",
        words: 28..32,
        judge: |_, w| Some(w == LITERALS.map(f32::to_bits)),
    },
    Check {
        name: "literal * literal",
        asked: "the nearest",
        words: 32..33,
        judge: |_, w| exact::product(LITERALS[0], LITERALS[1], f32::from_bits(w[0])),
    },
    Check {
        name: "x * literal",
        asked: "the nearest",
        words: 33..34,
        judge: |p, w| exact::product(p.x(), LITERALS[0], f32::from_bits(w[0])),
    },
    Check {
        name: "x + literal",
        asked: "the nearest",
        words: 34..35,
        judge: |p, w| exact::sum(p.x(), LITERALS[1], f32::from_bits(w[0])),
    },
    Check {
        name: "x / literal",
        asked: "2.5 ulp",
        words: 35..36,
        judge: |p, w| exact::quotient(p.x(), LITERALS[2], f32::from_bits(w[0])),
    },
    Check {
        name: "abs(x) > literal",
        asked: "exact",
        words: 36..37,
        judge: |p, w| {
            let [x, _] = p.ordinary()?;
            Some(w[0] == u32::from(x.abs() > LITERALS[3]))
        },
    },
    Check {
        name: "dot",
        asked: "3 u of the sum of the terms' sizes, u = 2^-24",
        words: 37..38,
        judge: |p, w| {
            let [x, y] = p.ordinary()?;
            exact::dot(
                [x, LITERALS[0], y],
                [y, LITERALS[1], x],
                f32::from_bits(w[0]),
            )
        },
    },
    Check {
        name: "x * 2^-160 * 2^160, in a loop",
        asked: "0, or off by a subnormal's last place",
        words: 38..39,
        judge: |p, w| exact::chain(p.x(), f32::from_bits(w[0])),
    },
    Check {
        name: "exponent of x * y",
        asked: "that of the product or next to it, 254 or 255 where it overflows",
        words: 39..40,
        judge: |p, w| {
            let [x, y] = p.ordinary()?;
            Some(exact::exponent(x, y, w[0]))
        },
    },
    Check {
        name: "two_sum in a loop",
        asked: "sum + tails exact",
        words: 40..44,
        judge: |p, w| exact::sum_in_loop(p.x(), p.y(), w),
    },
    Check {
        name: "abs(x * y) < 2^100",
        asked: "exact, and false where the product overflows",
        words: 44..45,
        judge: |p, w| {
            let [x, y] = p.ordinary()?;
            let size = (f64::from(x) * f64::from(y)).abs();
            let border = 100f64.exp2();
            let near = (0.999_999 * border..1.000_001 * border).contains(&size);
            (!near).then_some(w[0] == u32::from(size < border))
        },
    },
];

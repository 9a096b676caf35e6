//! The self-test tested: right results pass, one wrong word does not.

use std::cell::Cell;

use super::*;

thread_local! {
    /// A word of the results that this thread's next self-tests get wrong.
    static SPOILED: Cell<Option<usize>> = const { Cell::new(None) };
    /// A result of its next self-tests with f64, likewise.
    static SPOILED_DOUBLE: Cell<Option<usize>> = const { Cell::new(None) };
}

/// Makes the self-tests that follow on this thread get a word wrong, or none.
pub(crate) fn spoil_next(word: Option<usize>) {
    SPOILED.set(word);
}

/// Makes the self-tests with f64 that follow on this thread get a result wrong, or none.
pub(crate) fn spoil_next_double(result: Option<usize>) {
    SPOILED_DOUBLE.set(result);
}

/// Makes another thread get wrong what this one does.
pub(crate) fn carry() -> Box<dyn FnOnce() + Send> {
    let (spoiled, double) = (SPOILED.get(), SPOILED_DOUBLE.get());
    Box::new(move || {
        SPOILED.set(spoiled);
        SPOILED_DOUBLE.set(double);
    })
}

/// What [`run_double`] does to the results under test.
pub(super) fn spoil_double(results: &mut [u64]) {
    if let Some(result) = SPOILED_DOUBLE.get() {
        results[result] ^= 1 << 20;
    }
}

/// What [`run`] does to the results under test.
pub(super) fn spoil(results: &mut [u32]) {
    if let Some(word) = SPOILED.get() {
        results[word] ^= 1 << 20;
    }
}

/// x · 2⁻¹⁶⁰ · 2¹⁶⁰ in steps of 2⁴⁰.
fn chain(x: f32) -> f32 {
    let steps = [-40f32, 40.0].map(|e| [e.exp2(); 4]);
    steps.as_flattened().iter().fold(x, |x, step| x * step)
}

/// The sum of x, y, y/2 and y/4, and the tails of the three sums.
fn sums_in_loop(x: f32, y: f32) -> [f32; 4] {
    let (mut sum, mut tails) = (x, [0.0; 3]);
    for (term, tail) in [y, 0.5 * y, 0.25 * y].into_iter().zip(&mut tails) {
        let next = sum + term;
        let back = next - sum;
        *tail = (sum - (next - back)) + (term - back);
        sum = next;
    }
    [sum, tails[2], tails[1], tails[0]]
}

/// What a device that rounds to nearest would write; `f32` operations of the host are such.
fn right(pairs: &[[u32; 2]]) -> Vec<u32> {
    pairs
        .iter()
        .flat_map(|&[a, b]| {
            let (x, y) = (f32::from_bits(a), f32::from_bits(b));
            let sum = x + y;
            let back = sum - x;
            let tail = (x - (sum - back)) + (y - back);
            let product = x * y;
            let rest = (f64::from(x) * f64::from(y) - f64::from(product)) as f32;
            let bits = f32::to_bits;
            let sums = sums_in_loop(x, y).map(bits);
            [
                bits(x + y),
                bits(x - y),
                bits(x * y),
                bits(x / y),
                bits(x.abs().sqrt()),
                bits((1.0 / f64::from(x.abs()).sqrt()) as f32),
                bits(x.floor()),
                bits(x.round_ties_even()),
                x as i32 as u32,
                x.abs() as u32,
                bits(a as i32 as f32),
                bits(a as f32),
                bits(x.min(y)),
                bits(x.max(y)),
                bits(x.abs()),
                bits(if x > y { y } else { x }),
                u32::from(x > y)
                    | u32::from(x >= y) << 1
                    | u32::from(x.abs() > y.abs()) << 2
                    | u32::from(x == y) << 3,
                a.wrapping_add(b),
                a.wrapping_sub(b),
                a.wrapping_mul(b),
                (a << (b & 31)) ^ (a >> (b & 31)),
                (a as i32).wrapping_mul(b as i32) as u32,
                (a as i32 >> (b & 31)) as u32,
                a,
                bits(sum),
                bits(tail),
                bits(product),
                bits(rest),
                bits(LITERALS[0]),
                bits(LITERALS[1]),
                bits(LITERALS[2]),
                bits(LITERALS[3]),
                bits(LITERALS[0] * LITERALS[1]),
                bits(x * LITERALS[0]),
                bits(x + LITERALS[1]),
                bits(x / LITERALS[2]),
                u32::from(x.abs() > LITERALS[3]),
                bits(x * y + LITERALS[0] * LITERALS[1] + y * x),
                bits(chain(x)),
                bits(x * y) >> 23 & 255,
                sums[0],
                sums[1],
                sums[2],
                sums[3],
                u32::from((x * y).abs() < 100f32.exp2()),
                0,
                0,
                0,
            ]
        })
        .collect()
}

#[test]
fn right_results_pass_and_every_check_has_cases() {
    let pairs = operands();
    assert_eq!(pairs.len() % WORKGROUP, 0);
    let outcomes = judge(&pairs, &right(&pairs));
    assert_eq!(failures(&outcomes), None);
    for outcome in &outcomes {
        assert!(outcome.cases > 1000, "{outcome:?}");
    }
    // Every word is looked at.
    let words: Vec<usize> = CHECKS.iter().flat_map(|c| c.words.clone()).collect();
    assert_eq!(words, (0..RESULTS - 3).collect::<Vec<_>>());
}

/// One word of one pair wrong: the check that looks at it fails, and no other.
#[test]
fn one_wrong_word_is_noticed() {
    let pairs = operands();
    let results = right(&pairs);
    for check in CHECKS {
        for word in check.words.clone() {
            // Finds a pair of operands that this check looks at.
            let row = (1..pairs.len())
                .rev()
                .find(|row| {
                    let words = &results[row * RESULTS..][check.words.clone()];
                    let pair = Pair {
                        a: pairs[*row][0],
                        b: pairs[*row][1],
                    };
                    (check.judge)(pair, words) == Some(true) && words[0] != 0
                })
                .unwrap();
            let mut wrong = results.clone();
            wrong[row * RESULTS + word] ^= 1 << 20;
            let outcomes = judge(&pairs, &wrong);
            for outcome in outcomes {
                assert_eq!(
                    outcome.failure.is_some(),
                    outcome.check == check.name,
                    "{outcome:?} for word {word} of row {row}"
                );
            }
        }
    }
}

/// The last place counts where exactness is asked for, and three of them where a quotient may be off by two and a half.
#[test]
fn a_last_place_is_noticed() {
    let at = |x: f32, y: f32| Pair {
        a: x.to_bits(),
        b: y.to_bits(),
    };
    let judged = |name: &str, pair, words: &[u32]| {
        let check = CHECKS.iter().find(|check| check.name == name).unwrap();
        (check.judge)(pair, words)
    };
    let third = 1.0_f32 / 3.0;
    for (places, passes) in [(0, true), (2, true), (3, false)] {
        let word = third.to_bits() + places;
        assert_eq!(
            judged("x / y", at(1.0, 3.0), &[word]),
            Some(passes),
            "{places}"
        );
    }
    // 1 + 2⁻²⁴ lies midway between two f32, both of which may stand; next to that only one may; and 1 + 1 is one.
    let half = f32::EPSILON / 2.0;
    for (y, passes) in [
        (half, [true, true, false]),
        (half.next_down(), [true, false, false]),
        (half.next_up(), [false, true, false]),
    ] {
        for (places, passes) in (0..).zip(passes) {
            let word = 1_f32.to_bits() + places;
            assert_eq!(judged("x + y", at(1.0, y), &[word]), Some(passes));
        }
    }
    // (1 + 2⁻²³)² = 1 + 2⁻²² + 2⁻⁴⁶ is rounded down; below a power of two places are half as large.
    let x = 1_f32.next_up();
    for (result, passes) in [
        (x.next_up(), true),
        (x.next_up().next_up(), false),
        (x, false),
    ] {
        assert_eq!(judged("x * y", at(x, x), &[result.to_bits()]), Some(passes));
    }
    let below = 1_f32.next_down();
    for (result, passes) in [(below.next_down(), true), (below, false)] {
        assert_eq!(
            judged("x * y", at(below, below), &[result.to_bits()]),
            Some(passes)
        );
    }
    assert_eq!(
        judged("x + y", at(1.0, 1.0), &[2_f32.to_bits()]),
        Some(true)
    );
    assert_eq!(
        judged("x + y", at(1.0, 1.0), &[2_f32.to_bits() + 1]),
        Some(false)
    );
    // Without a barrier compilers cancel tails to 0, which the test has to notice.
    let words = [1_f32.to_bits(), 0];
    assert_eq!(
        judged("two_sum behind the barrier", at(1.0, half), &words),
        Some(false)
    );
    let x = 1.0 + f32::EPSILON;
    let words = [(x * x).to_bits(), 0];
    assert_eq!(
        judged("two_prod behind the barrier", at(x, x), &words),
        Some(false)
    );
    // Flushing is allowed, to either side.
    let small = f32::MIN_POSITIVE;
    for word in [0, 1 << 22] {
        assert_eq!(judged("x * y", at(small, 0.5), &[word]), Some(true));
    }
    assert_eq!(judged("x * y", at(small, 2.0), &[0]), Some(false));
}

/// Answers of devices that take chains, overflow and compensated sums for something else.
#[test]
fn wrong_ranges_and_lost_tails_are_noticed() {
    let judged = |name: &str, x: f32, y: f32, words: &[u32]| {
        let pair = Pair {
            a: x.to_bits(),
            b: y.to_bits(),
        };
        let check = CHECKS.iter().find(|check| check.name == name).unwrap();
        (check.judge)(pair, words)
    };
    let chain =
        |x: f32, result: f32| judged("x * 2^-160 * 2^160, in a loop", x, 0.0, &[result.to_bits()]);
    // Kept, flushed, or rounded to the next subnormal.
    for result in [1.0, 0.0, 2048.0] {
        assert_eq!(chain(1.0, result), Some(true), "{result}");
    }
    // Lifted to the least normal number, or rounded where nothing is subnormal.
    assert_eq!(chain(1.0, 34f32.exp2()), Some(false));
    assert_eq!(chain(35f32.exp2(), 0.0), Some(false));
    assert_eq!(chain(35f32.exp2(), 35f32.exp2().next_up()), Some(false));
    let exponent = |x, y, found| judged("exponent of x * y", x, y, &[found]);
    let huge = 100f32.exp2();
    for (found, passes) in [(255, true), (254, true), (227, false), (0, false)] {
        assert_eq!(exponent(huge, huge, found), Some(passes), "{found}");
    }
    assert_eq!(exponent(1.0 / huge, 1.0 / huge, 0), Some(true));
    assert_eq!(exponent(1.0 / huge, 1.0 / huge, 27), Some(false));
    let below = |x, y, holds| judged("abs(x * y) < 2^100", x, y, &[holds]);
    assert_eq!(below(huge, huge, 0), Some(true));
    assert_eq!(below(huge, huge, 1), Some(false));
    // A compiler that knows sums of real numbers finds no tails.
    let (x, y) = (1.0, (1.0 / 512.0_f32).next_up());
    let words = sums_in_loop(x, y);
    let sums = |words: [f32; 4]| judged("two_sum in a loop", x, y, &words.map(f32::to_bits));
    assert_eq!(sums(words), Some(true));
    assert!(words[1..].iter().any(|tail| *tail != 0.0));
    assert_eq!(sums([words[0], 0.0, 0.0, 0.0]), Some(false));
}

/// The composed picture's judge: a wrong byte that is sure, pixels in doubt or missing; and a byte in doubt may be
/// anything.
#[test]
fn a_wrong_picture_is_noticed() {
    let tried = |change: &dyn Fn(&mut Vec<[u8; 4]>)| {
        let right = vec![[1, 2, 3]; 100];
        let mut found = vec![[1, 2, 3, 0]; 100];
        change(&mut found);
        composed::judge(&composed::Tried { right, found }).failure
    };
    assert_eq!(tried(&|_| ()), None);
    assert_eq!(tried(&|found| found[7] = [9, 9, 9, 255]), None);
    assert!(tried(&|found| found[7][1] = 3).unwrap().contains("pixel 7"));
    assert!(
        tried(&|found| found[..11].fill([1, 2, 3, 255]))
            .unwrap()
            .contains("only 89")
    );
    assert!(tried(&|found| _ = found.pop()).unwrap().contains("missing"));
}

#[test]
fn results_that_are_missing_are_noticed() {
    let pairs = operands();
    let results = right(&pairs);
    let outcomes = judge(&pairs, &results[..results.len() - RESULTS]);
    assert!(failures(&outcomes).unwrap().contains("missing"));
}

#[test]
fn the_shader_is_valid() {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let module = naga::front::wgsl::parse_str(&wgsl()).unwrap();
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).unwrap();
}

/// Needs an adapter, and fails without one.
#[test]
fn the_adapter_here_passes() {
    let gpu = crate::gpu::adapters::shared(None).unwrap();
    assert_eq!(failures(&run(&gpu).unwrap()), None, "{}", gpu.name);
}

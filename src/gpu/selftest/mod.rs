//! Whether a device computes as the certified path takes for granted: hard operands through `shaders/selftest.wgsl`, its
//! results against exact answers.
//!
//! Beside the flow: `render` asks before it trusts an adapter with certified pixels, `plumb doctor` prints the answer. The
//! results are judged as plain data (`judge`), so that a test can hand in wrong ones.

use std::ops::Range;

use serde::Serialize;

use super::GpuError;
use super::device::Gpu;
use crate::shader::literal::literal;

mod exact;
mod operands;

use operands::operands;

const SHADER: &str = include_str!("../../../shaders/selftest.wgsl");

/// Numbers that stand in the text of the shader, as those of small scenes do.
const LITERALS: [f32; 4] = [
    f32::from_bits(0x3fff_ffff),
    f32::from_bits(0x3f80_0001),
    f32::from_bits(0x4040_0003),
    f32::from_bits(0x0080_0001),
];

/// Words that the shader writes for each pair of operands, in fours; the last two are nothing.
const RESULTS: usize = 40;

/// Invocations of a workgroup, as the shader has it; the number of pairs is a multiple.
const WORKGROUP: usize = 64;

/// How one check went.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Outcome {
    /// What was tried.
    pub check: &'static str,
    /// What was asked of it.
    pub asked: &'static str,
    /// How many operands were in its domain.
    pub cases: usize,
    /// The first operands for which the result was not what was asked for, and the result.
    pub failure: Option<String>,
}

/// A check: which of the words of a pair it looks at, and whether they are right. None where the operands are outside what
/// the certified path needs.
struct Check {
    name: &'static str,
    asked: &'static str,
    words: Range<usize>,
    judge: fn(Pair, &[u32]) -> Option<bool>,
}

/// A pair of operands.
#[derive(Debug, Clone, Copy)]
struct Pair {
    a: u32,
    b: u32,
}

impl Pair {
    fn x(self) -> f32 {
        f32::from_bits(self.a)
    }

    fn y(self) -> f32 {
        f32::from_bits(self.b)
    }

    /// Both, if neither is subnormal, so that flushing does not matter.
    fn ordinary(self) -> Option<[f32; 2]> {
        let [x, y] = [self.x(), self.y()];
        (!x.is_subnormal() && !y.is_subnormal()).then_some([x, y])
    }
}

/// Runs the shader on the device and judges what it wrote. The device's own errors are errors here; wrong results are not.
pub fn run(gpu: &Gpu) -> Result<Vec<Outcome>, GpuError> {
    let pairs = operands();
    #[cfg_attr(not(test), expect(unused_mut, reason = "tests spoil a result"))]
    let mut results = compute(gpu, &pairs)?;
    #[cfg(test)]
    tests::spoil(&mut results);
    Ok(judge(&pairs, &results))
}

/// The checks that failed, in a line; none if all passed.
pub fn failures(outcomes: &[Outcome]) -> Option<String> {
    let failed: Vec<String> = outcomes
        .iter()
        .filter_map(|outcome| {
            let failure = outcome.failure.as_ref()?;
            Some(format!("{}: {failure}", outcome.check))
        })
        .collect();
    (!failed.is_empty()).then(|| failed.join("; "))
}

/// A number that changes when the self-test does: a device that passed another one is tested again.
pub fn version() -> u64 {
    use std::hash::{DefaultHasher, Hash as _, Hasher as _};
    let mut hasher = DefaultHasher::new();
    (SHADER, env!("CARGO_PKG_VERSION"), operands()).hash(&mut hasher);
    hasher.finish()
}

/// Compares the words that a device wrote for these pairs with what they have to be.
fn judge(pairs: &[[u32; 2]], results: &[u32]) -> Vec<Outcome> {
    let outcome = |check: &Check| {
        let mut cases = 0;
        let mut failure = None;
        for (pair, words) in pairs.iter().zip(results.chunks_exact(RESULTS)) {
            let pair = Pair {
                a: pair[0],
                b: pair[1],
            };
            let words = &words[check.words.clone()];
            let Some(right) = (check.judge)(pair, words) else {
                continue;
            };
            cases += 1;
            if !right && failure.is_none() {
                failure = Some(format!(
                    "x = {:e} ({:08x}), y = {:e} ({:08x}) gave {words:08x?}",
                    pair.x(),
                    pair.a,
                    pair.y(),
                    pair.b
                ));
            }
        }
        if results.len() != RESULTS * pairs.len() {
            failure = Some("results are missing".into());
        }
        Outcome {
            check: check.name,
            asked: check.asked,
            cases,
            failure,
        }
    };
    CHECKS.iter().map(outcome).collect()
}

/// The text of the shader.
fn wgsl() -> String {
    let mut text = format!("const RESULTS = {RESULTS}u;\n");
    for (i, value) in LITERALS.into_iter().enumerate() {
        text += &format!("const LITERAL_{i} = {};\n", literal(value));
    }
    text + SHADER
}

/// What the device makes of the pairs: [`RESULTS`] words for each.
fn compute(gpu: &Gpu, pairs: &[[u32; 2]]) -> Result<Vec<u32>, GpuError> {
    use wgpu::BufferUsages;
    use wgpu::util::DeviceExt as _;
    let device = &gpu.device;
    let pipeline = gpu.compile(&wgsl(), "main")?;
    let filled = |contents: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("self-test"),
            contents,
            usage: BufferUsages::STORAGE,
        })
    };
    let size = (RESULTS * pairs.len() * size_of::<u32>()) as u64;
    let operands = filled(bytemuck::cast_slice(pairs));
    let unknown = filled(&[0; 4]);
    let results = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("self-test"),
        size,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = gpu.bind(&pipeline, &[(0, &operands), (1, &results), (2, &unknown)]);
    let groups = [(pairs.len() / WORKGROUP) as u32, 1];
    let words = gpu.run_once(&pipeline, &group, groups, &results)?;
    Ok(bytemuck::pod_collect_to_vec(&words))
}

/// Every check. The words are in the order in which the shader writes them.
#[rustfmt::skip]
const CHECKS: &[Check] = &[
    Check { name: "x + y", asked: "one of the two nearest", words: 0..1, judge: |p, w| exact::sum(p.x(), p.y(), f32::from_bits(w[0])) },
    Check { name: "x - y", asked: "one of the two nearest", words: 1..2, judge: |p, w| exact::sum(p.x(), -p.y(), f32::from_bits(w[0])) },
    Check { name: "x * y", asked: "one of the two nearest", words: 2..3, judge: |p, w| exact::product(p.x(), p.y(), f32::from_bits(w[0])) },
    Check { name: "x / y", asked: "2.5 ulp for 2^-126 <= |y| <= 2^126", words: 3..4, judge: |p, w| exact::quotient(p.x(), p.y(), f32::from_bits(w[0])) },
    Check { name: "sqrt", asked: "4.6 u, u = 2^-23", words: 4..5, judge: |p, w| exact::root(p.x(), f32::from_bits(w[0])) },
    Check { name: "inverseSqrt", asked: "2 ulp", words: 5..6, judge: |p, w| exact::inverse_root(p.x(), f32::from_bits(w[0])) },
    Check { name: "floor", asked: "exact", words: 6..7, judge: |p, w| exact::whole(p.x(), f32::floor, f32::from_bits(w[0])) },
    Check { name: "round", asked: "exact, halves to even", words: 7..8, judge: |p, w| exact::whole(p.x(), f32::round_ties_even, f32::from_bits(w[0])) },
    Check { name: "i32(f32)", asked: "exact, towards 0", words: 8..9, judge: |p, w| {
        let [x, _] = p.ordinary()?;
        (x.abs() < exact::TWO_31).then(|| w[0] == x as i32 as u32)
    } },
    Check { name: "u32(f32)", asked: "exact, towards 0", words: 9..10, judge: |p, w| {
        let [x, _] = p.ordinary()?;
        (x.abs() < 2.0 * exact::TWO_31).then(|| w[0] == x.abs() as u32)
    } },
    Check { name: "f32(i32)", asked: "one of the two nearest", words: 10..11, judge: |p, w| Some(exact::nearest_two(f64::from(p.a as i32), 0.0, f32::from_bits(w[0]))) },
    Check { name: "f32(u32)", asked: "one of the two nearest", words: 11..12, judge: |p, w| Some(exact::nearest_two(f64::from(p.a), 0.0, f32::from_bits(w[0]))) },
    Check { name: "min, max, abs, select", asked: "exact", words: 12..16, judge: |p, w| {
        let [x, y] = p.ordinary()?;
        let want = [x.min(y), x.max(y), x.abs(), if x > y { y } else { x }];
        Some(want.iter().zip(w).all(|(want, word)| *want == f32::from_bits(*word)))
    } },
    Check { name: "comparisons", asked: "exact", words: 16..17, judge: |p, w| {
        let [x, y] = p.ordinary()?;
        let holds = [x > y, x >= y, x.abs() > y.abs(), x == y];
        Some(w[0] == holds.iter().rev().fold(0, |bits, holds| bits << 1 | u32::from(*holds)))
    } },
    Check { name: "u32 arithmetic", asked: "exact modulo 2^32", words: 17..21, judge: |p, w| {
        let (a, b) = (p.a, p.b);
        let shifted = a << (b & 31) ^ a >> (b & 31);
        Some(w == [a.wrapping_add(b), a.wrapping_sub(b), a.wrapping_mul(b), shifted])
    } },
    Check { name: "i32 arithmetic", asked: "exact modulo 2^32", words: 21..23, judge: |p, w| {
        let (a, b) = (p.a as i32, p.b as i32);
        Some(w == [a.wrapping_mul(b) as u32, (a >> (b & 31)) as u32])
    } },
    Check { name: "barrier", asked: "the same bits", words: 23..24, judge: |p, w| {
        let [x, _] = p.ordinary()?;
        Some(w[0] == x.to_bits())
    } },
    Check { name: "two_sum behind the barrier", asked: "sum + tail exact", words: 24..26, judge: |p, w| exact::two_sum(p.x(), p.y(), f32::from_bits(w[0]), f32::from_bits(w[1])) },
    Check { name: "two_prod behind the barrier", asked: "product + tail exact", words: 26..28, judge: |p, w| exact::two_prod(p.x(), p.y(), f32::from_bits(w[0]), f32::from_bits(w[1])) },
    Check { name: "literals", asked: "the same bits", words: 28..32, judge: |_, w| Some(w == LITERALS.map(f32::to_bits)) },
    Check { name: "literal * literal", asked: "one of the two nearest", words: 32..33, judge: |_, w| exact::product(LITERALS[0], LITERALS[1], f32::from_bits(w[0])) },
    Check { name: "x * literal", asked: "one of the two nearest", words: 33..34, judge: |p, w| exact::product(p.x(), LITERALS[0], f32::from_bits(w[0])) },
    Check { name: "x + literal", asked: "one of the two nearest", words: 34..35, judge: |p, w| exact::sum(p.x(), LITERALS[1], f32::from_bits(w[0])) },
    Check { name: "x / literal", asked: "2.5 ulp", words: 35..36, judge: |p, w| exact::quotient(p.x(), LITERALS[2], f32::from_bits(w[0])) },
    Check { name: "abs(x) > literal", asked: "exact", words: 36..37, judge: |p, w| {
        let [x, _] = p.ordinary()?;
        Some(w[0] == u32::from(x.abs() > LITERALS[3]))
    } },
    Check { name: "dot", asked: "3 u of the sum of the terms' sizes, u = 2^-23", words: 37..38, judge: |p, w| {
        let [x, y] = p.ordinary()?;
        exact::dot([x, LITERALS[0], y], [y, LITERALS[1], x], f32::from_bits(w[0]))
    } },
];

#[cfg(test)]
pub(crate) mod tests;

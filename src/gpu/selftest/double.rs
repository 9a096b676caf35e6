//! Whether a device computes with f64 as the stage behind f32 takes for granted: Vulkan promises little of it. Operands
//! go through `shaders/selftest_double.wgsl`, and the results are judged by the host's f64, which is IEEE's; and a
//! small scene through its composed shader.

mod checks;

use super::operands::{all_with_all, random};
use super::{Outcome, WORKGROUP, composed, judging};
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::shader::literal::literal_of_f64;
use checks::CHECKS;

const SHADER: &str = include_str!("../../../shaders/selftest_double.wgsl");

/// Results of a pair of operands.
const RESULTS: usize = 27;

/// Numbers that stand in the text of the shader.
const LITERALS: [f64; 2] = [
    f64::from_bits(0x3fff_ffff_ffff_ffff),
    f64::from_bits(0x3ff0_0000_0000_0001),
];

/// Numbers that are paired with each other, all with all: 0, neighbours of powers of two, halves, large and small ones.
const SPECIAL: [u64; 24] = [
    0x0000_0000_0000_0000,
    0x8000_0000_0000_0000,
    0x3ff0_0000_0000_0000,
    0x3ff0_0000_0000_0001,
    0x3fef_ffff_ffff_ffff,
    0xbff0_0000_0000_0000,
    0xbff0_0000_0000_0001,
    0x3fe0_0000_0000_0000,
    0x3fdf_ffff_ffff_ffff,
    0xbfe0_0000_0000_0001,
    0x3ff8_0000_0000_0000,
    0x4004_0000_0000_0000,
    0xc004_0000_0000_0000,
    0x3fff_ffff_ffff_ffff,
    0x4008_0000_0000_0000,
    0x3fd5_5555_5555_5555,
    0x3fb9_9999_9999_999a,
    0x41a0_0000_0200_0000, // 134,217,729
    0x432f_ffff_ffff_ffff, // 2⁵² − ½
    0x4330_0000_0000_0001, // 2⁵² + 1
    0x4340_0000_0000_0000, // 2⁵³
    0xc1df_ffff_ffc0_0000, // −2³¹ + 1
    0x4630_0000_0000_0000, // 2¹⁰⁰
    0x39b0_0000_0000_0000, // 2⁻¹⁰⁰
];

/// Random pairs, of five kinds in turn.
const RANDOM: usize = 1472;

/// All pairs: always the same, finite, a multiple of 64 of them.
fn operands() -> Vec<[f64; 2]> {
    let mut pairs = all_with_all(&SPECIAL);
    let mut next = random();
    for i in 0..RANDOM {
        let (p, q, r) = (next(), next(), next());
        // Sign and fraction of `bits`, an exponent of `width` values around 0.
        let number = |bits: u64, r: u64, width: u64| {
            bits & 0x800f_ffff_ffff_ffff | (1023 - width / 2 + r % width) << 52
        };
        pairs.push(match i % 5 {
            // Operands of about the same size.
            0 => [number(p, 0, 2), number(q, r, 2)],
            // Operands of any ordinary size.
            1 => [number(p, r, 120), number(q, r >> 32, 120)],
            // Operands that are nearly opposite: all but their last bits cancel.
            2 => {
                let x = number(p, r, 80);
                [x, (x ^ 1 << 63).wrapping_add(q % 9).wrapping_sub(4)]
            }
            // Short fractions, whose sums and products end near a half of the last place.
            3 => [
                number(p & !0x3ff_ffff, r, 48),
                number(q & !0x3ff_ffff | 0x200_0000, r >> 32, 48),
            ],
            // Long runs of ones, whose roots and quotients end near a half of the last place.
            _ => [
                number(0xf_ffff_ffff_ffff ^ 1 << (p % 52), r, 60),
                number(0xf_ffff_ffff_ffff >> (q % 52), r >> 32, 60),
            ],
        });
    }
    pairs.iter().map(|pair| pair.map(f64::from_bits)).collect()
}

/// A number that changes when the test does.
pub(super) fn version() -> u64 {
    let bits: Vec<_> = operands()
        .iter()
        .map(|pair| pair.map(f64::to_bits))
        .collect();
    judging::version(CHECKS, (SHADER, composed::LIT_SCENE, bits))
}

/// Runs the shader on the device and judges what it wrote. Only for devices that have f64.
pub(super) fn run(gpu: &Gpu) -> Result<Vec<Outcome>, GpuError> {
    let pairs = operands();
    #[cfg_attr(not(test), expect(unused_mut, reason = "tests spoil a result"))]
    let mut results = compute(gpu, &pairs)?;
    #[cfg(test)]
    super::tests::spoil_double(&mut results);
    let mut outcomes = judge(&pairs, &results);
    outcomes.push(composed::judge(&composed::run_double(gpu)?));
    Ok(outcomes)
}

fn compute(gpu: &Gpu, pairs: &[[f64; 2]]) -> Result<Vec<u64>, GpuError> {
    let words: Vec<u64> = pairs.iter().flatten().map(|v| v.to_bits()).collect();
    let text = super::with_literals(SHADER, RESULTS, &LITERALS.map(literal_of_f64));
    let bytes = super::on_device(
        gpu,
        &text,
        bytemuck::cast_slice(&words),
        pairs.len() / WORKGROUP,
        pairs.len() * RESULTS * size_of::<u64>(),
    )?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

/// Compares what a device wrote for these pairs with what it has to be.
fn judge(pairs: &[[f64; 2]], results: &[u64]) -> Vec<Outcome> {
    judging::judge(CHECKS, pairs, results, RESULTS)
}

impl judging::Operands for [f64; 2] {
    fn shown(self) -> String {
        let [x, y] = self;
        format!("x = {x:e}, y = {y:e}")
    }
}

#[cfg(test)]
mod tests;

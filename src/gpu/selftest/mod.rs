//! Whether a device computes as the certified path takes for granted: hard operands through `shaders/selftest.wgsl`,
//! its results against exact answers, and a small scene through its composed shader.
//!
//! Beside the flow: `render` asks before it trusts an adapter with certified pixels, `plumb doctor` prints the answer.
//! The results are judged as plain data (`judge`), so that a test can hand in wrong ones.

use serde::Serialize;

use super::GpuError;
use super::device::Gpu;
use crate::shader::literal::literal;

mod checks;
mod composed;
mod double;
mod exact;
mod judging;
mod operands;

use checks::{CHECKS, LITERALS, Pair};
use operands::operands;

const SHADER: &str = include_str!("../../../shaders/selftest.wgsl");

/// Words that the shader writes for each pair of operands, in fours; the last three are nothing.
const RESULTS: usize = 48;

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

/// Runs the shader on the device and judges what it wrote. The device's own errors are errors here; wrong results are
/// not.
pub fn run(gpu: &Gpu) -> Result<Vec<Outcome>, GpuError> {
    let pairs = operands();
    #[cfg_attr(not(test), expect(unused_mut, reason = "tests spoil a result"))]
    let mut results = compute(gpu, &pairs)?;
    #[cfg(test)]
    tests::spoil(&mut results);
    let mut outcomes = judge(&pairs, &results);
    outcomes.push(composed::judge(&composed::run(gpu)?));
    Ok(outcomes)
}

/// The same with f64, of a device that has it: for the stage behind f32.
pub fn run_double(gpu: &Gpu) -> Result<Vec<Outcome>, GpuError> {
    double::run(gpu)
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
    judging::version(CHECKS, (SHADER, composed::SCENE, operands()))
}

/// The same for the self-test with f64.
pub fn double_version() -> u64 {
    double::version()
}

/// Compares the words that a device wrote for these pairs with what they have to be.
fn judge(pairs: &[[u32; 2]], results: &[u32]) -> Vec<Outcome> {
    let pairs: Vec<Pair> = pairs.iter().map(|&[a, b]| Pair { a, b }).collect();
    judging::judge(CHECKS, &pairs, results, RESULTS)
}

/// The text of the shader.
fn wgsl() -> String {
    with_literals(SHADER, RESULTS, &LITERALS.map(literal))
}

/// A shader's text, with the number of its results and literals before it.
fn with_literals(shader: &str, results: usize, literals: &[String]) -> String {
    let mut text = format!("const RESULTS = {results}u;\n");
    for (i, literal) in literals.iter().enumerate() {
        text += &format!("const LITERAL_{i} = {literal};\n");
    }
    text + shader
}

/// What the device makes of the pairs: [`RESULTS`] words for each.
fn compute(gpu: &Gpu, pairs: &[[u32; 2]]) -> Result<Vec<u32>, GpuError> {
    let size = RESULTS * size_of_val(pairs) / 2;
    let groups = pairs.len() / WORKGROUP;
    let words = on_device(gpu, &wgsl(), bytemuck::cast_slice(pairs), groups, size)?;
    Ok(bytemuck::pod_collect_to_vec(&words))
}

/// So many bytes that so many workgroups of a shader make of operands.
fn on_device(
    gpu: &Gpu,
    wgsl: &str,
    operands: &[u8],
    groups: usize,
    size: usize,
) -> Result<Vec<u8>, GpuError> {
    use wgpu::BufferUsages;
    use wgpu::util::DeviceExt as _;
    let device = &gpu.device;
    let pipeline = gpu.compile(wgsl, "main")?;
    let filled = |contents: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("self-test"),
            contents,
            usage: BufferUsages::STORAGE,
        })
    };
    let (operands, unknown) = (filled(operands), filled(&[0; 4]));
    let results = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("self-test"),
        size: size as u64,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = gpu.bind(&pipeline, &[(0, &operands), (1, &results), (2, &unknown)]);
    gpu.run_once(&pipeline, &group, [groups as u32, 1], &results)
}

#[cfg(test)]
pub(crate) mod tests;

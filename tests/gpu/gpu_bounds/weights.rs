//! Which weights of rays are followed: at both ends of f32's range.

use plumb::gpu::device::Gpu;

use crate::gpu_bounds::support::run;

/// The verdicts of `ordinary` on a product of two factors, as the shader forms it: 1 where it is followed.
fn verdicts(gpu: &Gpu, wgsl: &str, factors: &[[f32; 2]]) -> Vec<bool> {
    let items: Vec<f32> = factors
        .iter()
        .flat_map(|&[a, b]| [a, b, 0.0, 0.0])
        .collect();
    let body = "
    let before = vec3f(items[i].x, 1.0, 0.0);
    let factor = vec3f(items[i].y, 1.0, 1.0);
    let weight = barrier(before * factor);
    answers[i] = vec4f(select(0.0, 1.0, ordinary(before, factor, weight)));";
    let answers = run(gpu, wgsl, body, &items, &[], factors.len(), 1);
    answers.iter().map(|answer| answer[0] == 1.0).collect()
}

/// A weight that f32 cannot hold, or that it holds inaccurately, is left to the CPU; one that a factor of 0 makes 0 is
/// not.
pub(crate) fn are_followed(gpu: &Gpu, wgsl: &str) {
    let two = |exponent: i32| 2.0_f64.powi(exponent) as f32;
    // (two factors, whether their product is followed)
    let cases = [
        ([1.0, 1.0], true),
        ([0.3, 0.7], true),
        ([1.0, 0.0], true),
        ([0.0, two(40)], true),
        ([two(-46), two(-40)], true),
        ([two(-47), two(-40)], false),
        ([two(-86), two(-40)], false),
        // Below the normal numbers, and below all.
        ([two(-86), two(-60)], false),
        ([two(-100), two(-100)], false),
        ([31.9, 1.0], true),
        ([32.0, 1.0], false),
        ([31.9, two(40)], false),
        // More than f32 can hold.
        ([two(100), two(100)], false),
    ];
    let factors: Vec<[f32; 2]> = cases.iter().map(|(factors, _)| *factors).collect();
    for ((factors, followed), verdict) in cases.iter().zip(verdicts(gpu, wgsl, &factors)) {
        assert_eq!(verdict, *followed, "{factors:?}");
    }
    // A comparison of floats, as it stood here before, does not notice what was flushed, or too large.
    let naive = wgsl.replacen(
        "return all(inside |",
        "return all((weight >= vec3f(0.0)) |",
        1,
    );
    assert_ne!(naive, wgsl);
    let missed = verdicts(gpu, &naive, &factors);
    assert!(
        cases
            .iter()
            .zip(missed)
            .any(|((_, followed), verdict)| verdict != *followed)
    );
}

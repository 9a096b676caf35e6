//! Weights of rays: which are followed, at both ends of f32's range, and how well they are known after long paths.

use glam::DVec3;
use plumb::gpu::device::Gpu;
use plumb::shader::records;

use super::support::{BoundStatistics, Rng, rounded, run, with_constant};
use super::world::World;

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

/// Mirrors, or panes, one behind another.
const LONG: usize = 2_000;

/// Weights after many mirrors or panes, each of which takes less than 10⁻⁵, and their bounds.
fn after(gpu: &Gpu, world: &World, wgsl: &str, panes: bool) -> BoundStatistics {
    let lit = world.packed.lit.as_ref().unwrap();
    let is_pane =
        |object: &&records::LitObject| lit.materials[object.material as usize].transparency > 0.0;
    let object = lit
        .objects
        .iter()
        .position(|object| is_pane(&object))
        .unwrap();
    let tint = lit.materials[lit.objects[object].material as usize].tint;
    let mut rng = Rng(13);
    let mut items = Vec::new();
    let count = 4_096;
    let truth: Vec<DVec3> = (0..count)
        .map(|_| {
            let (start, start_near) = rounded(rng.within(0.5) + DVec3::splat(1.5));
            // What the host rounds.
            let factor = DVec3::from_array([0; 3].map(|_| 1.0 - rng.log(-7.5, -5.0)));
            let factor = if panes {
                DVec3::splat(factor.x)
            } else {
                factor
            };
            let (told, _) = rounded(factor);
            items.extend([
                start[0], start[1], start[2], 0.0, told[0], told[1], told[2], 0.0,
            ]);
            let all = factor.to_array().map(|f| f.powi(LONG as i32));
            start_near * DVec3::from_array(all)
        })
        .collect();
    let step = if panes {
        "through_branch(branch, at, items[2u * i + 1u].x)"
    } else {
        "mirror_branch(branch, at, items[2u * i + 1u].xyz)"
    };
    let body = format!(
        "
    var at: PathPoint;
    at.point.object = {object}u;
    var branch: Branch;
    branch.weight = items[2u * i].xyz;
    for (var k = 0u; k < {LONG}u; k += 1u) {{
        branch = {step};
    }}
    answers[i] = vec4f(branch.weight, branch.weight_error);"
    );
    // What tints panes.
    let inputs = [
        (2, bytemuck::cast_slice(&lit.objects)),
        (8, bytemuck::cast_slice(&world.packed.tiled_planes)),
        (12, bytemuck::cast_slice(&lit.materials)),
    ];
    let inputs = if panes { &inputs[..] } else { &[] };
    let answers = run(gpu, wgsl, &body, &items, inputs, count, 1);
    let name = if panes {
        "weights after panes"
    } else {
        "weights after mirrors"
    };
    let mut seen = BoundStatistics::new(name);
    for (answer, truth) in answers.iter().zip(truth) {
        let [x, y, z, error] = answer.map(f64::from);
        for (found, truth, tint) in [
            (x, truth.x, tint[0]),
            (y, truth.y, tint[1]),
            (z, truth.z, tint[2]),
        ] {
            // Panes tint but for one channel.
            if !panes || tint == 1.0 {
                seen.error((truth / found - 1.0).abs(), error);
            }
        }
    }
    seen
}

/// Along a path of two thousand mirrors or panes the weight is as well known as its bound says.
pub(crate) fn are_known(gpu: &Gpu, world: &World) {
    for (panes, constant) in [(false, "WEIGHT_ROUNDINGS"), (true, "PANE_WEIGHT_ROUNDINGS")] {
        after(gpu, world, &world.wgsl, panes).judge(4_000, 1.0 / 12.0);
        let without = with_constant(&world.wgsl, constant, "0f");
        let violations = after(gpu, world, &without, panes).violations();
        assert!(violations > 4_000, "{constant} = 0 is not noticed");
    }
}

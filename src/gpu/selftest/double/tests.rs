//! The self-test with f64 tested: right results pass, wrong ones do not.

use super::checks::{two_product, two_sum};
use super::*;

/// What a device that rounds as IEEE asks would write.
fn right(pairs: &[[f64; 2]]) -> Vec<u64> {
    let of_pair = |&[x, y]: &[f64; 2]| {
        let low = x.to_bits() as u32;
        let [sum, tail] = two_sum(x, y);
        let [product, rest] = two_product(x, y);
        let holds = [x > y, x >= y, x.abs() > y.abs(), x == y];
        let holds = holds.iter().rev();
        let holds = holds.fold(0, |bits, holds| bits << 1 | u64::from(*holds));
        let single = u64::from((x as f32).to_bits());
        let whole = u64::from(x as i32 as u32) | u64::from(x.abs() as u32) << 32;
        let bits = f64::to_bits;
        vec![
            bits(x + y),
            bits(x - y),
            bits(x * y),
            bits(x / y),
            bits(x.abs().sqrt()),
            bits(1.0 / x.abs().sqrt()),
            bits(x.floor()),
            bits(x.round_ties_even()),
            bits(f64::from(low as i32)),
            bits(f64::from(low)),
            bits(x.min(y)),
            bits(x.max(y)),
            bits(x.abs()),
            bits(if x > y { y } else { x }),
            holds | u64::from(x.abs() > LITERALS[0]) << 32,
            whole,
            single,
            bits(f32::from_bits(low).into()),
            x.to_bits(),
            bits(sum),
            bits(tail),
            bits(product),
            bits(rest),
            bits(x * LITERALS[0]),
            bits(x + LITERALS[1]),
            bits(LITERALS[1]),
            bits(x * y + LITERALS[0] * LITERALS[1] + y * x),
        ]
    };
    pairs.iter().flat_map(of_pair).collect()
}

#[test]
fn right_results_pass_and_every_check_has_cases() {
    let pairs = operands();
    assert_eq!(pairs.len() % WORKGROUP, 0);
    for outcome in judge(&pairs, &right(&pairs)) {
        assert_eq!(outcome.failure, None, "{}", outcome.check);
        assert!(outcome.cases > 500, "{}: {}", outcome.check, outcome.cases);
    }
}

/// Each result off by a few units of its last place, in one pair that is not special, is noticed.
#[test]
fn a_wrong_result_is_noticed() {
    let pairs = operands();
    let right = right(&pairs);
    for at in 0..RESULTS {
        let noticed = (0..pairs.len()).step_by(7).any(|pair| {
            let mut wrong = right.clone();
            wrong[pair * RESULTS + at] ^= 8;
            judge(&pairs, &wrong).iter().any(|o| o.failure.is_some())
        });
        assert!(noticed, "{at}");
    }
    let missing = judge(&pairs, &right[1..]);
    assert!(missing.iter().all(|outcome| outcome.failure.is_some()));
}

/// The device of these tests has f64, and computes with it as it should.
#[test]
fn the_device_passes() {
    let gpu = crate::gpu::adapters::open(None).unwrap();
    if gpu.doubles {
        for outcome in run(&gpu).unwrap() {
            assert_eq!(outcome.failure, None, "{}", outcome.check);
        }
    } else {
        let lacks = gpu.device.features();
        assert!(!lacks.contains(wgpu::Features::SHADER_F64 | wgpu::Features::SHADER_INT64));
    }
}

//! What results have to be, by f64, in which sums, products and comparisons of f32 operands are exact enough to tell.
//!
//! Each answers None outside its domain, else whether the result may stand. Subnormal operands may be taken for 0, and
//! subnormal results too.

use std::cmp::Ordering;

/// 2³¹.
pub(super) const TWO_31: f32 = 2_147_483_648.0;

/// What rounding to nearest may take, relatively.
const U: f64 = 0.5 * f32::EPSILON as f64;

/// Results above this are not asked for: the certified path has none.
const HUGE: f64 = 1e38;

/// What a device may take an operand for.
fn flushed(v: f32) -> impl Iterator<Item = f32> + Clone {
    [Some(v), v.is_subnormal().then_some(0.0)]
        .into_iter()
        .flatten()
}

/// How `high + low` compares with a border; where |low| is at most half a last place of `high`. (That is `high + low`
/// rounded, and rounding keeps the order.) With what is no number nothing compares.
fn beside(high: f64, low: f64, border: f64) -> Option<Ordering> {
    Some(high.partial_cmp(&border)?.then(low.partial_cmp(&0.0)?))
}

/// Whether a device may have flushed a result of this size to 0.
fn may_be_flushed(high: f64, result: f32) -> bool {
    result == 0.0 && high.abs() <= f64::from(f32::MIN_POSITIVE)
}

/// Whether `result` is one of the two f32 nearest to `high + low`, the only one if that is an f32. A subnormal sum may
/// be 0.
pub(super) fn nearest_two(high: f64, low: f64, result: f32) -> bool {
    let (below, above) = (f64::from(result.next_down()), f64::from(result.next_up()));
    may_be_flushed(high, result)
        || beside(high, low, below).is_some_and(Ordering::is_gt)
            && beside(high, low, above).is_some_and(Ordering::is_lt)
}

/// Whether `result` is the f32 nearest to `high + low`, either one where two are as near. A subnormal sum may be 0.
pub(super) fn nearest(high: f64, low: f64, result: f32) -> bool {
    let midway = |next: f32| 0.5 * (f64::from(next) + f64::from(result));
    let (least, most) = (midway(result.next_down()), midway(result.next_up()));
    may_be_flushed(high, result)
        || beside(high, low, least).is_some_and(Ordering::is_ge)
            && beside(high, low, most).is_some_and(Ordering::is_le)
}

/// x + y.
pub(super) fn sum(x: f32, y: f32, result: f32) -> Option<bool> {
    if (f64::from(x) + f64::from(y)).abs() > HUGE {
        return None;
    }
    let mut all = flushed(x).flat_map(|x| flushed(y).map(move |y| [x, y]));
    Some(all.any(|[x, y]| {
        let (x, y) = (f64::from(x), f64::from(y));
        let high = x + y;
        let b = high - x;
        nearest(high, (x - (high - b)) + (y - b), result)
    }))
}

/// x · y, which f64 holds exactly.
pub(super) fn product(x: f32, y: f32, result: f32) -> Option<bool> {
    if (f64::from(x) * f64::from(y)).abs() > HUGE {
        return None;
    }
    let mut all = flushed(x).flat_map(|x| flushed(y).map(move |y| [x, y]));
    Some(all.any(|[x, y]| nearest(f64::from(x) * f64::from(y), 0.0, result)))
}

/// x / y, to 2.5 units of the last place, for divisors from 2⁻¹²⁶ to 2¹²⁶.
pub(super) fn quotient(x: f32, y: f32, result: f32) -> Option<bool> {
    let size = f64::from(y.abs());
    let domain = f64::from(f32::MIN_POSITIVE)..=126f64.exp2();
    let exact = f64::from(x) / f64::from(y);
    if !domain.contains(&size) || exact.abs() > HUGE {
        return None;
    }
    Some(flushed(x).any(|x| within(f64::from(x) / f64::from(y), result, 2.5)))
}

/// 1/√|x|, to 2 units of the last place.
pub(super) fn inverse_root(x: f32, result: f32) -> Option<bool> {
    x.is_normal()
        .then(|| within(1.0 / f64::from(x.abs()).sqrt(), result, 2.0))
}

/// √|x|: 1 over an inverse root of 2 units, divided with 2.5 units; all in all 9.2 u relative, u = 2⁻²⁴.
pub(super) fn root(x: f32, result: f32) -> Option<bool> {
    let exact = f64::from(x.abs()).sqrt();
    x.is_normal()
        .then(|| (f64::from(result) - exact).abs() <= 9.2 * U * exact)
}

/// Whether `result` is within so many units of the last place of `exact`; 0 may stand for what is subnormal.
fn within(exact: f64, result: f32, units: f64) -> bool {
    let smallest = f64::from(f32::MIN_POSITIVE);
    if exact.abs() < smallest * (1.0 + 1e-6) && (result == 0.0 || result.is_subnormal()) {
        return true;
    }
    // Below the power of two, places are half as large; the exact value's own binade counts.
    let last_place = (exact.abs().max(smallest).log2().floor() - 23.0).exp2();
    (f64::from(result) - exact).abs() <= units * last_place
}

/// A whole number next to x, as `function` finds it.
pub(super) fn whole(x: f32, function: fn(f32) -> f32, result: f32) -> Option<bool> {
    (!x.is_subnormal() && x.abs() < TWO_31).then(|| result == function(x))
}

/// A dot product: each product and each of the two sums rounded, in any order, where none of them is subnormal.
pub(super) fn dot(a: [f32; 3], b: [f32; 3], result: f32) -> Option<bool> {
    let terms: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a, b)| f64::from(*a) * f64::from(b))
        .collect();
    let sizes: f64 = terms.iter().map(|term| term.abs()).sum();
    let small = |term: &f64| *term != 0.0 && term.abs() < f64::from(f32::MIN_POSITIVE);
    if sizes > HUGE || terms.iter().any(small) {
        return None;
    }
    Some((f64::from(result) - terms.iter().sum::<f64>()).abs() <= 3.0 * U * (1.0 + U) * sizes)
}

/// x + y = sum + tail, where no part of them is subnormal or overflows.
pub(super) fn two_sum(x: f32, y: f32, sum: f32, tail: f32) -> Option<bool> {
    let domain = -60f64..=100.0;
    let inside = |v: f32| v == 0.0 || domain.contains(&f64::from(v.abs()).log2());
    if !inside(x) || !inside(y) {
        return None;
    }
    let (x, y) = (f64::from(x), f64::from(y));
    // Both x + y and the device's sum are written as two f64 in normal form, so they are equal if their parts are.
    let exact = normal(x, y);
    Some(sum.is_finite() && exact == normal(f64::from(sum), f64::from(tail)))
}

/// x · y = product + tail, likewise.
pub(super) fn two_prod(x: f32, y: f32, product: f32, tail: f32) -> Option<bool> {
    let domain = -30f64..=60.0;
    let inside = |v: f32| v == 0.0 || domain.contains(&f64::from(v.abs()).log2());
    if !inside(x) || !inside(y) {
        return None;
    }
    // The product has 48 bits; two f32 that make it up are added without rounding.
    let sum = normal(f64::from(product), f64::from(tail));
    Some(sum == (f64::from(x) * f64::from(y), 0.0))
}

/// x · 2⁻¹⁶⁰ · 2¹⁶⁰, by powers of two in any order: exact while nothing is subnormal, else 0 or within a last place of
/// what is.
pub(super) fn chain(x: f32, result: f32) -> Option<bool> {
    // 2⁻¹²⁶ and 2⁻¹⁴⁹, times 2¹⁶⁰. Around the latter an answer says little.
    let (smallest, place) = (34f32.exp2(), 11f32.exp2());
    let size = x.abs();
    if x.is_subnormal() || (place / 8.0..32.0 * place).contains(&size) {
        return None;
    }
    // What was subnormal is a multiple of that place.
    let near = (f64::from(result) - f64::from(x)).abs() <= f64::from(place);
    let rounded = result == 0.0 || near && (result / place).fract() == 0.0;
    Some(result == x || size < smallest && rounded)
}

/// The biased exponent of x · y.
pub(super) fn exponent(x: f32, y: f32, found: u32) -> bool {
    let size = (f64::from(x) * f64::from(y)).abs();
    if size < f64::from(f32::MIN_POSITIVE) {
        return found <= 1;
    }
    let right = size.log2().floor() + 127.0;
    if right >= 255.0 {
        return found == 254 || found == 255;
    }
    (f64::from(found) - right).abs() <= 1.0
}

/// x + y + y/2 + y/4, as the last sum and the tails of all three.
pub(super) fn sum_in_loop(x: f32, y: f32, words: &[u32]) -> Option<bool> {
    // Then f64 holds whatever is added here.
    let inside = |v: f32| (-10f64..=12.0).contains(&f64::from(v.abs()).log2());
    if !inside(x) || !inside(y) {
        return None;
    }
    let parts: Vec<f32> = words.iter().map(|word| f32::from_bits(*word)).collect();
    let fine = parts.iter().all(|v| *v == 0.0 || v.is_normal());
    let found: f64 = parts.iter().map(|v| f64::from(*v)).sum();
    Some(fine && found == f64::from(x) + 1.75 * f64::from(y))
}

/// a + b as an f64 and what is left (Knuth).
fn normal(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

//! Exact rational arithmetic: what `prepare` decides facts of the scene by, and the field that `lazy`'s towers stand
//! on.

use dashu_base::{Sign, SquareRoot as _};
use dashu_int::{IBig, UBig};
use glam::DVec3;

pub use dashu_ratio::Relaxed as Ratio;

/// The rational number that a finite f64 is.
pub fn ratio(value: f64) -> Ratio {
    // The scene's numbers are finite by its limits, and every finite f64 is rational.
    Ratio::try_from(value).unwrap_or(Ratio::ZERO)
}

/// The three rationals that a vector is.
pub fn ratio3(v: DVec3) -> [Ratio; 3] {
    [ratio(v.x), ratio(v.y), ratio(v.z)]
}

/// The inner product.
pub fn dot(a: &[Ratio; 3], b: &[Ratio; 3]) -> Ratio {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The outer product.
pub fn cross(a: &[Ratio; 3], b: &[Ratio; 3]) -> [Ratio; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// a − b.
pub fn sub(a: &[Ratio; 3], b: &[Ratio; 3]) -> [Ratio; 3] {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// Whether the number is 0.
pub fn is_zero(value: &Ratio) -> bool {
    *value == Ratio::ZERO
}

/// Whether the number is > 0.
pub fn is_positive(value: &Ratio) -> bool {
    *value > Ratio::ZERO
}

/// The absolute value.
pub fn abs(value: Ratio) -> Ratio {
    if is_positive(&value) { value } else { -value }
}

/// The square root of a number that is not negative, if that is rational.
pub fn root(square: &Ratio) -> Option<Ratio> {
    let lowest = square.clone().canonicalize();
    let whole = |n: &UBig| {
        let root = n.sqrt();
        (&root * &root == *n).then_some(root)
    };
    let numerator = UBig::try_from(lowest.numerator().clone()).ok()?;
    let (top, bottom) = (whole(&numerator)?, whole(lowest.denominator())?);
    Some(Ratio::from_parts(IBig::from(top), bottom))
}

/// The parity (0 or 1) of an integer.
pub fn parity(n: &IBig) -> u32 {
    let (_, words) = n.as_sign_words();
    // Two's complement keeps the parity of the magnitude.
    (words.first().copied().unwrap_or(0) & 1) as u32
}

/// 2^exponent.
pub fn power_of_two(exponent: i32) -> Ratio {
    let power = UBig::ONE << exponent.unsigned_abs() as usize;
    if exponent >= 0 {
        Ratio::from(IBig::from_parts(Sign::Positive, power))
    } else {
        Ratio::from_parts(IBig::ONE, power)
    }
}

/// The exponent of the power of two next below |value|, which is finite and not 0.
pub fn exponent(value: f64) -> i32 {
    let bits = value.abs().to_bits();
    match (bits >> 52) as i32 {
        0 => -1011 - bits.leading_zeros().cast_signed(),
        biased => biased - 1023,
    }
}

/// 2^exponent as an f64, exactly; |exponent| ≤ 1022.
pub fn two_to(exponent: i32) -> f64 {
    f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_those_of_the_power_below() {
        for (value, want) in [
            (1.0, 0),
            (-1.5, 0),
            (0.75, -1),
            (f64::MAX, 1023),
            (f64::MIN_POSITIVE, -1022),
            (f64::from_bits(1), -1074),
            (f64::from_bits(0x000f_ffff_ffff_ffff), -1023),
        ] {
            assert_eq!(exponent(value), want, "{value:e}");
        }
    }
}

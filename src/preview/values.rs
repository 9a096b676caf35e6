//! Numbers as a person would write them.

/// `number` rounded to a power of ten that is about a ten-thousandth of `size`, or less: 1.1 and not
/// 1.1000000000000001.
pub(super) fn neat(number: f64, size: f64) -> f64 {
    let digits = (4.0 - size.abs().log10()).ceil();
    if !digits.is_finite() {
        return number;
    }
    // Through decimal digits, which is what the file will have.
    let text = if digits >= 0.0 {
        let digits = (digits as usize).min(320);
        format!("{number:.digits$}")
    } else {
        let zeros = -digits as i32;
        format!("{:.0}e{zeros}", number / 10_f64.powi(zeros))
    };
    // A zero without a sign.
    text.parse::<f64>().map_or(number, |number| number + 0.0)
}

/// A number for a label: five digits, no more than it has.
pub(super) fn short(number: f64) -> String {
    let rounded = neat(number, number.abs().max(1e-300) * 1.0);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_decimals() {
        assert_eq!(neat(0.1 + 0.2, 1.0), 0.3);
        assert_eq!(neat(1.23456789, 8.0), 1.2346);
        assert_eq!(neat(123456.0, 1e8), 120000.0);
        assert_eq!(neat(-0.00001, 1.0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(neat(5.0, 0.0), 5.0);
        assert!(neat(1e300, 1e300) == 1e300);
        assert_eq!(neat(1.5e-310, 1e-310), 1.5e-310);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!(short(6.0), "6");
        assert_eq!(short(0.1 + 0.2), "0.3");
        assert_eq!(short(1.0 / 3.0), "0.33333");
        assert_eq!(short(-1.0 / 3e9), "-3.3333e-10");
        assert_eq!(short(0.0), "0");
    }
}

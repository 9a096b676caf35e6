//! Numbers and lines for people to read, as `plumb probe` and reports print them.

use std::io::{self, Write};

use crate::real::V3;

/// Every digit that tells an f64 from its neighbours.
const ALL: usize = 17;
/// Enough to tell an f32 from its neighbours, and short enough for many in a line.
const SOME: usize = 9;

/// The number in full, `%.17g` in C's terms.
pub fn full(value: f64) -> String {
    significant(value, ALL)
}

/// The number to nine digits.
pub fn short(value: f64) -> String {
    significant(value, SOME)
}

/// Three numbers in full.
pub fn triple(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(full);
    format!("({x}, {y}, {z})")
}

/// Three numbers to nine digits.
pub fn short_triple(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(short);
    format!("({x}, {y}, {z})")
}

/// The components of a vector.
pub fn components(v: V3<f64>) -> [f64; 3] {
    [v.x, v.y, v.z]
}

/// A line with its heading.
pub fn line(to: &mut dyn Write, what: &str, value: String) -> io::Result<()> {
    writeln!(to, "{what:<13}{value}")
}

/// `1 object`, `2 objects`.
pub fn count(n: usize, what: &str) -> String {
    if n == 1 {
        format!("1 {what}")
    } else {
        format!("{n} {what}s")
    }
}

/// C's `%.Ng` less trailing zeros, and never "-0".
fn significant(value: f64, count: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let last = count - 1;
    let scientific = format!("{value:.last$e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-5..count as i32).contains(&power) {
        let decimals = (last as i32 - power).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// Without zeros at the end of the fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_enough_and_not_more() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.25, "1.25"),
            (-4.0, "-4"),
            (0.1, "0.10000000000000001"),
            (1.0 / 3.0, "0.33333333333333331"),
            (100.0, "100"),
            (1e300, "1.0000000000000001e300"),
            (-2.5e-7, "-2.4999999999999999e-7"),
        ] {
            assert_eq!(full(value), text, "{value:?}");
        }
        for value in [
            std::f64::consts::PI,
            1.0 / 7.0,
            6.02e23,
            1.6e-19,
            123_456.789,
        ] {
            assert_eq!(full(value).parse(), Ok(value));
        }
    }

    #[test]
    fn short_numbers_have_nine_digits() {
        for (value, text) in [
            (-0.0, "0"),
            (0.1, "0.1"),
            (1.0 / 3.0, "0.333333333"),
            (999_999_999.9, "1e9"),
            (123_456_789.0, "123456789"),
            (8.000_000_000_1, "8"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(short(value), text, "{value:?}");
        }
    }
}

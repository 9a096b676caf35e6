//! Tokens to numbers, the way C's `%lf` and `%d` take a whole token; and what is decided exactly about numbers.
//!
//! Used by the parser (text → lex → parse → [`Scene`](super::Scene)) for each value of an attribute. Every number is
//! the f64 nearest to its text, ties to even, decimal or hexadecimal; zero is never negative.

/// Why a token is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberError {
    /// Not a number at all.
    Malformed,
    /// `inf` or `nan`, in any of C's spellings.
    NotFinite,
    /// Beyond the largest f64.
    TooLarge,
}

/// More digits than this never decide a rounding (767 suffice for f64): the rest matters only as "more than zero".
const SIGNIFICANT: usize = 800;

/// Reads a token as a finite f64.
///
/// # Errors
/// When the token is not as a whole a number, or not finite.
pub(super) fn parse_number(token: &[u8]) -> Result<f64, NumberError> {
    let (negative, digits) = split_sign(token);
    let magnitude = match digits {
        _ if let Some(short) = short_decimal(digits) => short,
        [b'0', b'x' | b'X', hexadecimal @ ..] => parse_hexadecimal(hexadecimal)?,
        _ if is_not_finite(digits) => return Err(NumberError::NotFinite),
        _ => parse_decimal(digits)?,
    };
    if magnitude.is_infinite() {
        return Err(NumberError::TooLarge);
    }
    // Adding 0 turns -0 into 0.
    Ok(if negative { -magnitude } else { magnitude } + 0.0)
}

/// Reads a token as a whole number; beyond i64 it is the nearest i64.
///
/// # Errors
/// [`NumberError::Malformed`] when the token is not an optional sign and decimal digits.
pub(super) fn parse_integer(token: &[u8]) -> Result<i64, NumberError> {
    let (negative, digits) = split_sign(token);
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return Err(NumberError::Malformed);
    }
    let shift = |value: i64, digit: &u8| {
        value
            .saturating_mul(10)
            .saturating_add(i64::from(digit - b'0'))
    };
    let magnitude = digits.iter().fold(0, shift);
    Ok(if negative { -magnitude } else { magnitude })
}

/// Would somebody who wrote this token have meant a number?
pub(super) fn looks_numeric(token: &[u8]) -> bool {
    let (_, digits) = split_sign(token);
    match digits {
        _ if split_dash(token).is_some() => true,
        [b'0'..=b'9', ..] | [b'.' | b',', b'0'..=b'9', ..] => true,
        [] => true,
        _ => is_not_finite(digits) || digits.len() < token.len(),
    }
}

/// A minus sign or dash of a word processor in front of a digit or point, and what follows it.
pub(super) fn split_dash(token: &[u8]) -> Option<(char, &[u8])> {
    ['\u{2212}', '\u{2013}', '\u{2014}']
        .into_iter()
        .find_map(|dash| {
            let digits = token.strip_prefix(dash.encode_utf8(&mut [0; 4]).as_bytes())?;
            matches!(digits, [b'0'..=b'9' | b'.', ..]).then_some((dash, digits))
        })
}

fn split_sign(token: &[u8]) -> (bool, &[u8]) {
    match token {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    }
}

/// C's spellings of infinity and of what is not a number; `nan(…)` may carry a payload.
fn is_not_finite(digits: &[u8]) -> bool {
    let head = |name: &[u8]| {
        digits
            .get(..name.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(name))
    };
    let whole = |name: &[u8]| digits.len() == name.len() && head(name);
    whole(b"inf")
        || whole(b"infinity")
        || whole(b"nan")
        || (head(b"nan(") && digits.ends_with(b")"))
}

/// Splits `123.456` (either side may be empty, not both) from what follows.
fn split_digits(text: &[u8], is_digit: fn(&u8) -> bool) -> Option<(&[u8], &[u8], &[u8])> {
    let length = text
        .iter()
        .position(|byte| !is_digit(byte))
        .unwrap_or(text.len());
    let (whole, rest) = text.split_at(length);
    let (fraction, rest) = match rest {
        [b'.', rest @ ..] => rest.split_at(
            rest.iter()
                .position(|byte| !is_digit(byte))
                .unwrap_or(rest.len()),
        ),
        _ => (&rest[..0], rest),
    };
    (!whole.is_empty() || !fraction.is_empty()).then_some((whole, fraction, rest))
}

/// Reads `e12`, `p-3` or nothing (0) to the end of the token.
fn parse_exponent(text: &[u8], letter: u8) -> Option<i64> {
    match text {
        [] => Some(0),
        [first, rest @ ..] if first.eq_ignore_ascii_case(&letter) => parse_integer(rest).ok(),
        _ => None,
    }
}

/// The powers of ten below that many places.
const TENS: [f64; SHORT] = {
    let mut tens = [1.0; SHORT];
    let mut place = 1;
    while place < SHORT {
        // Up to 10²² each of them is an f64, and so is each product here.
        tens[place] = 10.0 * tens[place - 1];
        place += 1;
    }
    tens
};

/// So many characters at most has what [`short_decimal`] reads: 16 digits and a point.
const SHORT: usize = 17;

/// Reads a decimal number without exponent whose digits, as one whole number, are an f64, as those of nearly all
/// numbers of a scene are: that and the power of ten are exact, and dividing them rounds once. None for any other text.
fn short_decimal(digits: &[u8]) -> Option<f64> {
    if digits.len() > SHORT {
        return None;
    }
    let (mut whole, mut point) = (0_u64, None);
    for (place, byte) in digits.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            whole = 10 * whole + u64::from(digit);
        } else if *byte == b'.' && point.is_none() {
            point = Some(place);
        } else {
            return None;
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    if count == 0 || whole > 1 << f64::MANTISSA_DIGITS {
        return None;
    }
    let places = point.map_or(0, |point| digits.len() - point - 1);
    Some(whole as f64 / TENS[places])
}

fn parse_decimal(text: &[u8]) -> Result<f64, NumberError> {
    let (whole, fraction, rest) =
        split_digits(text, u8::is_ascii_digit).ok_or(NumberError::Malformed)?;
    let exponent = parse_exponent(rest, b'e').ok_or(NumberError::Malformed)?;
    let standard = |text: &[u8]| {
        std::str::from_utf8(text)
            .ok()
            .and_then(|text| text.parse().ok())
    };
    if text.len() <= SIGNIFICANT && exponent.abs() < 10_000 {
        return standard(text).ok_or(NumberError::Malformed);
    }
    // The standard library saturates exponents somewhere, and a token may be any number of megabytes; so here the
    // digits are cut to those that count, and the exponent is computed.
    let mut digits = whole
        .iter()
        .chain(fraction)
        .skip_while(|digit| **digit == b'0');
    let leading = whole.len() + fraction.len() - digits.clone().count();
    let mut short = vec![b'.'];
    short.extend(digits.by_ref().take(SIGNIFICANT));
    if short.len() == 1 {
        return Ok(0.0);
    }
    short.push(if digits.any(|digit| *digit != b'0') {
        b'1'
    } else {
        b'0'
    });
    let point = exponent
        .saturating_add(whole.len() as i64 - leading as i64)
        .clamp(-5_000, 5_000);
    short.extend_from_slice(format!("e{point}").as_bytes());
    standard(&short).ok_or(NumberError::Malformed)
}

/// Reads what follows `0x`.
fn parse_hexadecimal(text: &[u8]) -> Result<f64, NumberError> {
    let (whole, fraction, rest) =
        split_digits(text, u8::is_ascii_hexdigit).ok_or(NumberError::Malformed)?;
    let exponent = parse_exponent(rest, b'p').ok_or(NumberError::Malformed)?;
    // The value is (mantissa + a bit below, if sticky) * 2^scale.
    let mut mantissa = 0_u64;
    let mut sticky = false;
    let mut scale = exponent.saturating_sub(4 * fraction.len() as i64);
    for byte in whole.iter().chain(fraction) {
        let digit = u64::from((*byte as char).to_digit(16).unwrap_or(0));
        if mantissa >> 60 == 0 {
            mantissa = mantissa << 4 | digit;
        } else {
            sticky |= digit != 0;
            scale = scale.saturating_add(4);
        }
    }
    Ok(round(mantissa, sticky, scale))
}

/// The f64 nearest to `mantissa * 2^scale` (a little more if `sticky`), ties to even.
fn round(mantissa: u64, sticky: bool, scale: i64) -> f64 {
    if mantissa == 0 {
        return 0.0;
    }
    // Normalise: the value is 1.xxx * 2^top with the 1 at bit 63.
    let zeros = i64::from(mantissa.leading_zeros());
    let mantissa = mantissa << zeros;
    let top = scale.saturating_sub(zeros).saturating_add(63);
    if top > 1023 {
        return f64::INFINITY;
    }
    // 53 bits are kept, fewer where the result is subnormal; `kept` is at least 0 with the value at least half of the
    // least subnormal.
    let kept = 53.min(top + 1075);
    if kept < 0 {
        return 0.0;
    }
    let dropped = 64 - kept as u32;
    let wide = u128::from(mantissa);
    let integer = (wide >> dropped) as u64;
    let rest = wide & ((1 << dropped) - 1);
    let half = 1_u128 << (dropped - 1);
    let up = rest > half || (rest == half && (sticky || integer & 1 == 1));
    // In the bits of an f64 a carry out of the fraction is a step of the exponent, up to infinity.
    let base = if kept == 53 {
        ((top + 1022) as u64) << 52
    } else {
        0
    };
    f64::from_bits(base + integer + u64::from(up))
}

/// Are two vectors of exact f64 parallel, or is one of them zero? Nothing is rounded.
pub(super) fn parallel(a: &[f64], b: &[f64]) -> bool {
    let zero = |i: usize, j: usize| product(a[i], b[j]) == product(a[j], b[i]);
    zero(0, 1) && zero(1, 2) && zero(2, 0)
}

/// An exact product of two finite f64 as (negative, odd mantissa, exponent of 2); zero is (false, 0, 0).
fn product(a: f64, b: f64) -> (bool, u128, i32) {
    let ((a_negative, a_mantissa, a_exponent), (b_negative, b_mantissa, b_exponent)) =
        (parts(a), parts(b));
    let mantissa = u128::from(a_mantissa) * u128::from(b_mantissa);
    if mantissa == 0 {
        return (false, 0, 0);
    }
    let twos = mantissa.trailing_zeros();
    (
        a_negative != b_negative,
        mantissa >> twos,
        a_exponent + b_exponent + twos as i32,
    )
}

/// A finite f64 as (negative, mantissa, exponent of 2).
fn parts(value: f64) -> (bool, u64, i32) {
    let bits = value.to_bits();
    let fraction = bits & ((1 << 52) - 1);
    let exponent = (bits >> 52 & 0x7FF) as i32;
    let mantissa = if exponent == 0 {
        fraction
    } else {
        fraction | 1 << 52
    };
    (value.is_sign_negative(), mantissa, exponent.max(1) - 1075)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(token: &str) -> Result<f64, NumberError> {
        parse_number(token.as_bytes())
    }

    #[test]
    fn decimal_numbers_are_those_of_c() {
        let good = [
            ("1", 1.0),
            ("-1.5", -1.5),
            ("+.5", 0.5),
            ("5.", 5.0),
            ("1e2", 100.0),
            ("1E+2", 100.0),
            ("1.e-2", 0.01),
        ];
        for (token, value) in good {
            assert_eq!(number(token), Ok(value), "{token}");
        }
        for token in [
            "", "+", "-", ".", "e5", "1e", "1e+", "5abc", "1_000", "1,5", "--1", "+-1", "0x",
            "0x.", "0xg", "0x1p", "0x1p+", "0x1e+5", "1p3", "1.2.3", "\u{661}",
        ] {
            assert_eq!(number(token), Err(NumberError::Malformed), "{token}");
        }
        for token in ["inf", "-INF", "Infinity", "nan", "+NaN", "nan(123)"] {
            assert_eq!(number(token), Err(NumberError::NotFinite), "{token}");
        }
        for token in [
            "1e999",
            "-1e309",
            "1.7976931348623159e308",
            "0x1p1024",
            "0x.1p99999999999999999999",
            "0x1.fffffffffffff8p1023",
        ] {
            assert_eq!(number(token), Err(NumberError::TooLarge), "{token}");
        }
    }

    /// Numbers of few digits take a way of their own; the standard library's is another.
    #[test]
    fn short_numbers_are_the_nearest() {
        let mut seed = 1_u64;
        let mut short = 0;
        for _ in 0..200_000 {
            // Knuth's MMIX generator.
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let (digits, places) = (1 + seed % 18, (seed >> 8) % 19);
            let whole = seed.rotate_right(20) % 10_u64.pow(digits as u32);
            let mut text = whole.to_string();
            if places as usize <= text.len() {
                text.insert(text.len() - places as usize, '.');
            }
            short += u32::from(short_decimal(text.as_bytes()).is_some());
            let nearest: f64 = text.parse().unwrap();
            assert_eq!(
                number(&text).map(f64::to_bits),
                Ok(nearest.to_bits()),
                "{text}"
            );
        }
        assert!((100_000..199_000).contains(&short), "{short}");
        for (text, value) in [
            ("9007199254740992", Some(9_007_199_254_740_992.0)),
            ("9007199254740993", None),
        ] {
            assert_eq!(short_decimal(text.as_bytes()), value);
        }
    }

    #[test]
    fn underflow_is_the_nearest_number() {
        assert_eq!(number("1e-999"), Ok(0.0));
        assert_eq!(number("4.9e-324"), Ok(f64::from_bits(1)));
        assert_eq!(
            number("2.4703282292062327e-324"),
            Ok(0.0),
            "just below half of the least"
        );
        assert_eq!(
            number("2.4703282292062328e-324"),
            Ok(f64::from_bits(1)),
            "just above"
        );
        for token in ["-0", "-0.0", "-1e-999", "-0x0p0", "-0x1p-9999"] {
            assert_eq!(
                number(token).map(f64::to_bits),
                Ok(0),
                "{token}: zero is never negative"
            );
        }
    }

    #[test]
    fn hexadecimal_numbers_are_rounded_to_nearest_even() {
        let tiny = f64::from_bits(1);
        let good = [
            ("0x1.8p3", 12.0),
            ("0X.8P-2", 0.125),
            ("0x10", 16.0),
            ("-0xAp+1", -20.0),
            ("0x1.p0", 1.0),
            ("0x1e5", 485.0),
            ("0x1.fffffffffffffp1023", f64::MAX),
            ("0x1.fffffffffffff7fffffffffp1023", f64::MAX),
            ("0x1.00000000000008p0", 1.0),
            ("0x1.000000000000080000000001p0", 1.0 + f64::EPSILON),
            ("0x1.00000000000018p0", 1.0 + 2.0 * f64::EPSILON),
            ("0x1p-1074", tiny),
            ("0x1p-1075", 0.0),
            ("0x1.0000000000000000001p-1075", tiny),
            ("0x1.8p-1074", 2.0 * tiny),
            ("0x1p-1076", 0.0),
            ("0x0.fffffffffffff8p-1022", f64::MIN_POSITIVE),
            ("0x1p-1022", f64::MIN_POSITIVE),
            ("0x0p99999999999999999999999", 0.0),
        ];
        for (token, value) in good {
            assert_eq!(number(token), Ok(value), "{token}");
        }
    }

    #[test]
    fn long_numbers_keep_their_value() {
        let zeros = |count: usize| "0".repeat(count);
        assert_eq!(number(&format!("0.{}1e700001", zeros(700_000))), Ok(1.0));
        assert_eq!(number(&format!("1{}e-700000", zeros(700_000))), Ok(1.0));
        assert_eq!(number(&format!("{}1", zeros(2_000))), Ok(1.0));
        assert_eq!(number(&format!("0.{}", zeros(2_000))), Ok(0.0));
        assert_eq!(number(&format!("0x{}1", zeros(2_000))), Ok(1.0));
        assert_eq!(number(&format!("0x.{}1p8004", zeros(2_000))), Ok(1.0));
        // Half way between 1 and the next, and a little more, far behind.
        let half = "1.00000000000000011102230246251565404236316680908203125";
        assert_eq!(number(half), Ok(1.0));
        assert_eq!(number(&format!("{half}{}", zeros(3_000))), Ok(1.0));
        assert_eq!(
            number(&format!("{half}{}1", zeros(3_000))),
            Ok(1.0 + f64::EPSILON)
        );
    }

    #[test]
    fn integers_are_those_of_c() {
        let integer = |token: &str| parse_integer(token.as_bytes());
        assert_eq!(integer("+007"), Ok(7));
        assert_eq!(integer("-0"), Ok(0));
        assert_eq!(integer("99999999999999999999"), Ok(i64::MAX));
        for token in ["", "+", "1.0", "1e2", "0x10", " 1", "1-"] {
            assert_eq!(integer(token), Err(NumberError::Malformed), "{token}");
        }
    }

    #[test]
    fn parallel_is_exact() {
        assert!(parallel(&[0.1, 0.2, 0.3], &[-0.2, -0.4, -0.6]));
        assert!(
            !parallel(&[0.1, 0.2, 0.3], &[1.0, 2.0, 3.0]),
            "0.3 is not 3 times 0.1"
        );
        assert!(parallel(&[1e300, 0.0, 1e300], &[1e-320, 0.0, 1e-320]));
        assert!(parallel(&[5e-324, 0.0, 0.0], &[1e308, 0.0, 0.0]));
        assert!(!parallel(&[1e300, 0.0, 1e300], &[1e-320, 5e-324, 1e-320]));
        assert!(!parallel(&[1.0, 0.0, 0.0], &[-0.0, 1.0, 0.0]));
        assert!(!parallel(
            &[1.0, 2.0, 3.0],
            &[1.0, 2.0, 3.0 + 4.0 * f64::EPSILON]
        ));
    }
}

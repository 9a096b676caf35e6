//! Numbers as C reads them, to the last bit, and what is decided exactly about them.

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
        "", "+", "-", ".", "e5", "1e", "1e+", "5abc", "1_000", "1,5", "--1", "+-1", "0x", "0x.",
        "0xg", "0x1p", "0x1p+", "0x1e+5", "1p3", "1.2.3", "\u{661}",
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

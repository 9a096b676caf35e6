//! What the values of options may be: every refusal says what is allowed.

use std::ops::{Range, RangeInclusive};

use anyhow::{Result, bail};

/// The most pixels a side, as `pixeldim` has it.
const MOST_PIXELS: u32 = 1_000_000;
/// More threads than any machine has; a typing error is told here, not by the system running out of them.
const MOST_THREADS: usize = 4096;

/// `640x480`.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| {
        text.parse::<u32>()
            .ok()
            .filter(|n| (1..=MOST_PIXELS).contains(n))
    };
    let sides = text
        .split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some([side(w)?, side(h)?]));
    sides.ok_or_else(|| "say columns x rows, each 1 to 1000000, like 640x480".to_owned())
}

/// A whole number in a range.
pub(crate) fn whole(
    range: RangeInclusive<u32>,
) -> impl Fn(&str) -> Result<u32, String> + Clone + Send + Sync {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| {
            format!(
                "say a whole number from {} to {}",
                range.start(),
                range.end()
            )
        })
    }
}

/// A column or a row, of which only the picture knows how many there are.
pub(crate) fn pixel(text: &str) -> Result<i64, String> {
    let number = text.parse().ok();
    number
        .ok_or_else(|| "say a column and a row, whole numbers from 0 at the lower left".to_owned())
}

/// Rows of a picture whose height is not known yet: from the first, or from 0; to before the last, or to the top.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rows {
    start: u32,
    end: Option<u32>,
}

impl Rows {
    /// The rows in a picture so high.
    pub(crate) fn of(self, height: u32) -> Result<Range<u32>> {
        let Self { start, end } = self;
        if let Some(end) = end.filter(|end| *end > height) {
            bail!(
                "--rows {start}..{end}: the picture has {height} rows, so B is at most {height} (rows count from 0 at \
                the bottom)"
            );
        }
        if start >= height {
            bail!(
                "--rows {start}..: the picture has {height} rows, so A is at most {} (rows count from 0 at the bottom)",
                height - 1
            );
        }
        Ok(start..end.unwrap_or(height))
    }
}

/// `0..120`, `..120`, `40..`.
pub(crate) fn rows(text: &str) -> Result<Rows, String> {
    let teach = || {
        "say the first row and the row after the last, from 0 at the bottom, like 0..120; ..120 starts at the bottom, \
        40.. ends at the top"
            .to_owned()
    };
    let (a, b) = text
        .split_once("..")
        .filter(|bounds| *bounds != ("", ""))
        .ok_or_else(teach)?;
    let bound = |text: &str| match text {
        "" => Ok(None),
        text => text.parse::<u32>().map(Some).map_err(|_| teach()),
    };
    let (start, end) = (bound(a)?.unwrap_or(0), bound(b)?);
    if end.is_some_and(|end| start >= end) {
        return Err(
            "A must be less than B: A is the first row, B the row after the last".to_owned(),
        );
    }
    Ok(Rows { start, end })
}

/// Which part of a picture, from 1, and of how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Share {
    pub(crate) number: u32,
    pub(crate) parts: u32,
}

/// `3/16`.
pub(crate) fn share(text: &str) -> Result<Share, String> {
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    numbers
        .filter(|(number, parts)| {
            (1..=MOST_PIXELS).contains(parts) && (1..=*parts).contains(number)
        })
        .map(|(number, parts)| Share { number, parts })
        .ok_or_else(|| "say which part and of how many, like 3/16: part 1 is at the top".to_owned())
}

/// Into how many parts a picture is cut.
pub(crate) fn parts(text: &str) -> Result<u32, String> {
    whole(1..=MOST_PIXELS)(text)
}

/// A finite number.
pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "say a finite number, like 0.01".to_owned())
}

/// A length of a path: finite, not negative.
pub(crate) fn path(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    let length = number.filter(|number| number.is_finite() && *number >= 0.0);
    // Adding 0 makes −0 and 0 the same.
    length
        .map(|length| length + 0.0)
        .ok_or_else(|| "say a length in world units, 0 or more, like 20".to_owned())
}

/// At least one thread.
pub(crate) fn threads(text: &str) -> Result<usize, String> {
    let number = text
        .parse::<usize>()
        .ok()
        .filter(|n| (1..=MOST_THREADS).contains(n));
    number.ok_or_else(|| {
        format!("say a number from 1 to {MOST_THREADS}; without --threads all cores are used")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert_eq!(size("1X1000000"), Ok([1, 1_000_000]));
        for bad in [
            "",
            "640",
            "640x",
            "x480",
            "0x1",
            "1x0",
            "1000001x1",
            "-1x1",
            "1x1x1",
            "1 x 1",
            "1e3x1",
            "4294967297x1",
        ] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn whole_numbers_have_a_range() {
        let parse = whole(1..=100);
        assert_eq!((parse("1"), parse("100")), (Ok(1), Ok(100)));
        for bad in ["0", "101", "-1", "4.5", "4294967296", "", "many"] {
            let told = parse(bad).unwrap_err();
            assert_eq!(told, "say a whole number from 1 to 100", "{bad}");
        }
        assert_eq!((pixel("-1"), pixel("7")), (Ok(-1), Ok(7)));
        assert!(pixel("1.5").is_err() && pixel("x").is_err());
    }

    #[test]
    fn shares() {
        let (number, parts) = (3, 16);
        assert_eq!(share("3/16"), Ok(Share { number, parts }));
        assert!(share("1/1").is_ok() && share("16/16").is_ok());
        for bad in [
            "",
            "3",
            "/",
            "0/16",
            "17/16",
            "1/0",
            "-1/2",
            "1/2/3",
            "1/1000001",
            "1.5/2",
        ] {
            assert!(share(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn row_ranges() {
        for (text, start, end) in [
            ("0..120", 0, Some(120)),
            ("..5", 0, Some(5)),
            ("7..", 7, None),
        ] {
            assert_eq!(rows(text), Ok(Rows { start, end }));
        }
        for bad in [
            "",
            "..",
            "..0",
            "5..5",
            "6..5",
            "-1..5",
            "0-5",
            "0..=5",
            "0..4294967296",
        ] {
            assert!(rows(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn rows_are_of_the_picture() {
        let of = |text: &str| rows(text).unwrap().of(30).ok();
        assert_eq!(of("..5"), Some(0..5));
        assert_eq!(of("25.."), Some(25..30));
        assert_eq!(of("0..30"), Some(0..30));
        assert_eq!(of("0..31"), None);
        assert_eq!(of("30.."), None);
    }

    #[test]
    fn tolerances_are_finite() {
        assert_eq!(tolerance("-0.5"), Ok(-0.5));
        for bad in ["nan", "inf", "-inf", "1e999", "", "x"] {
            assert!(tolerance(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn paths_are_finite_and_not_negative() {
        for (text, length) in [
            ("0", 0.0),
            ("-0", 0.0),
            ("20", 20.0),
            ("1e6", 1e6),
            ("1e300", 1e300),
            ("0.5", 0.5),
        ] {
            assert_eq!(path(text), Ok(length));
        }
        assert!(path("-0").is_ok_and(f64::is_sign_positive));
        for bad in ["-1", "nan", "inf", "1e999", "", "far"] {
            assert!(path(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn threads_are_at_least_one() {
        assert_eq!(threads("1"), Ok(1));
        for bad in ["0", "-1", "", "5000", "1.5"] {
            assert!(threads(bad).is_err(), "{bad}");
        }
    }
}

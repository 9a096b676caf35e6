//! Numbers as a job array takes them: `3,17-19`.

use std::fmt::Write as _;

/// Rising numbers in short: runs of them by their ends.
pub fn list(numbers: &[u32]) -> String {
    let mut text = String::new();
    for run in numbers.chunk_by(|a, b| a + 1 == *b) {
        let comma = if text.is_empty() { "" } else { "," };
        // Writing into a text does not fail.
        let _ = match run {
            [first, .., last] => write!(text, "{comma}{first}-{last}"),
            [only] => write!(text, "{comma}{only}"),
            [] => Ok(()),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_told_by_their_ends() {
        for (numbers, text) in [
            (&[][..], ""),
            (&[3], "3"),
            (&[3, 17, 18, 19], "3,17-19"),
            (&[1, 2, 4, 6, 7], "1-2,4,6-7"),
        ] {
            assert_eq!(list(numbers), text);
        }
    }
}

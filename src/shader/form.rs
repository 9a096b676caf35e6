//! What a picture's shader leaves of a rectangle of pixels: the one place that says how its buffer is laid out.
//!
//! First come the counters of records, if there are records. Then come the pixels, in rows from the top, in one of
//! three forms; rows are filled up to whole *groups*.
//!
//! - **Packed**, for a file: 16 pixels are a group, of twelve words with red, green, blue of one pixel after the other,
//!   as PPM has them. Behind the last row stands a word for each group, row by row, with a bit for each pixel, from the
//!   lowest up, that is set where the CPU has to decide: so 3 + ¼ bytes a pixel.
//! - **Words**, for a canvas, since a window's shader looks up single pixels: red, green, blue from the lowest byte up,
//!   and in the highest not 0 where the CPU has to decide. A group is as many pixels as an invocation makes.
//! - **Values**: red, green, blue as f32 (255 is a full byte), then such a word.
//!
//! Records of pixels in doubt come last: of those of which some samples are sure (`gpu/bands/partial.rs`), or, for f64,
//! of all (`gpu/bands/listed.rs`).

use super::feature::{Feature, Features};
use super::feature_set::{FeatureSet, QUAD};

/// Pixels of a packed group: a workgroup has as many columns.
pub const GROUP: u32 = 16;
/// Words of its bytes; one more has its verdicts.
pub const GROUP_WORDS: u32 = GROUP * 3 / 4;

/// How pixels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pixels {
    /// Three bytes each, and verdicts behind them.
    Packed,
    /// A word each.
    Words,
    /// Four words each.
    Values,
}

/// What a shader makes of pixels, and needs for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    /// How they are stored.
    pub pixels: Pixels,
    /// Pixels side by side that an invocation makes.
    pub across: u32,
    /// Samples whose offsets the shader reads, for each pixel; 0 where it does not.
    pub offsets: u32,
    /// Words of a record of a pixel that is in doubt; 0 where there are none.
    pub record_words: u32,
    /// Whether the records are those of all pixels in doubt, for f64; else of those with sure and doubtful samples.
    pub listed: bool,
}

impl Form {
    /// Of a shader with these features.
    pub fn of(set: &FeatureSet) -> Self {
        let features: Features = set.features();
        let has = |feature: Feature| features.contains(&feature);
        let pixels = match (has(Feature::Packed), set.values) {
            (true, _) => Pixels::Packed,
            (false, true) => Pixels::Values,
            (false, false) => Pixels::Words,
        };
        Self {
            pixels,
            across: if has(Feature::Quad) { QUAD } else { 1 },
            offsets: if has(Feature::Course) { set.samples } else { 0 },
            record_words: set.record_words(),
            listed: set.is_listed(),
        }
    }

    /// Pixels of a group, to whole ones of which rows are filled up.
    pub fn group(&self) -> u32 {
        match self.pixels {
            Pixels::Packed => GROUP,
            Pixels::Words | Pixels::Values => self.across,
        }
    }

    /// Bytes of a group, with its verdicts.
    pub fn group_bytes(&self) -> u64 {
        let group = u64::from(self.group());
        match self.pixels {
            Pixels::Packed => 4 * u64::from(GROUP_WORDS + 1),
            Pixels::Words => 4 * group,
            Pixels::Values => 16 * group,
        }
    }

    /// Bytes of so many pixels, rows filled up already.
    pub fn bytes(&self, pixels: u64) -> u64 {
        pixels / u64::from(self.group()) * self.group_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::constants::WORKGROUP;

    #[test]
    fn a_packed_pixel_takes_three_bytes_and_a_quarter() {
        let form = |pixels, across| Form {
            pixels,
            across,
            offsets: 0,
            record_words: 0,
            listed: false,
        };
        assert_eq!(GROUP, WORKGROUP, "a row of a workgroup is a group");
        assert_eq!(
            form(Pixels::Packed, 4).bytes(3840 * 2160),
            3840 * 2160 * 13 / 4
        );
        assert_eq!(form(Pixels::Words, 4).bytes(640), 2560);
        assert_eq!(form(Pixels::Values, 1).bytes(3), 48);
    }
}

//! Which rows each part has: a pure function of the scene and the settings, so that all who make parts agree without
//! talking.

use std::ops::Range;

use super::work::Work;

/// Why a picture cannot be cut so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{parts} parts are too many for a picture of {rows} rows: each has at least one")]
pub struct Uncuttable {
    /// Parts asked for.
    pub parts: u32,
    /// Rows that there are.
    pub rows: u32,
}

/// The rows of each part. Parts are numbered from 1, from the top of the picture, as pictures are written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// The picture's rows, counted from the bottom.
    picture: Range<u32>,
    /// How many rows lie above the end of each part, the last one's end among them.
    ends: Vec<u32>,
}

impl Cut {
    /// Cuts the rows into parts of about equal work.
    ///
    /// # Errors
    /// Where there are more parts than rows.
    pub fn new(picture: Range<u32>, work: &Work, parts: u32) -> Result<Self, Uncuttable> {
        let rows = picture.len() as u32;
        if parts == 0 || parts > rows {
            return Err(Uncuttable { parts, rows });
        }
        let mut ends: Vec<u32> = Vec::with_capacity(parts as usize);
        let total = work.of(rows, rows);
        let mut end = 0;
        for number in 1..=parts {
            let before = ends.last().copied().unwrap_or(0);
            let share = total * u128::from(number) / u128::from(parts);
            while end < rows && work.of(rows, end) < share {
                end += 1;
            }
            // Each has a row at least, the ones to come too.
            end = end.clamp(before + 1, rows - (parts - number));
            ends.push(end);
        }
        if let Some(last) = ends.last_mut() {
            *last = rows;
        }
        Ok(Self { picture, ends })
    }

    /// The rows of the whole picture, counted from the bottom.
    pub fn picture(&self) -> Range<u32> {
        self.picture.clone()
    }

    /// How many parts there are.
    pub fn parts(&self) -> u32 {
        self.ends.len() as u32
    }

    /// The rows of a part, counted from the bottom; of none that there is, none.
    pub fn rows(&self, number: u32) -> Range<u32> {
        let top = self.picture.end;
        let end = |number: u32| {
            let index = (number as usize).checked_sub(1);
            index.map_or(Some(0), |index| self.ends.get(index).copied())
        };
        match (end(number.wrapping_sub(1)), end(number)) {
            (Some(above), Some(below)) if number > 0 => top - below..top - above,
            _ => 0..0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_dealt_by_their_work() {
        // The upper half costs three times as much as the lower one.
        let work = Work::of_blocks(vec![3, 1]);
        let cut = Cut::new(10..110, &work, 4).unwrap();
        let rows: Vec<_> = (0..=5).map(|number| cut.rows(number)).collect();
        assert_eq!(rows[0], 0..0);
        assert_eq!(rows[1..5], [93..110, 76..93, 60..76, 10..60]);
        assert_eq!(rows[5], 0..0);
    }

    #[test]
    fn every_part_has_a_row_wherever_the_work_is() {
        for blocks in [
            vec![0, 0, 0],
            vec![1_000_000, 0, 0],
            vec![0, 0, u64::from(u32::MAX)],
            vec![1],
        ] {
            let work = Work::of_blocks(blocks);
            for (rows, parts) in [(7, 7), (7, 6), (7, 1), (1, 1), (1000, 999)] {
                let cut = Cut::new(0..rows, &work, parts).unwrap();
                let mut top = rows;
                for number in 1..=parts {
                    let part = cut.rows(number);
                    assert_eq!(part.end, top, "{rows} rows, part {number} of {parts}");
                    assert!(!part.is_empty());
                    top = part.start;
                }
                assert_eq!(top, 0);
            }
        }
        let refused = Cut::new(0..7, &Work::of_blocks(vec![1]), 8);
        assert_eq!(refused, Err(Uncuttable { parts: 8, rows: 7 }));
        assert!(Cut::new(0..7, &Work::of_blocks(vec![1]), 0).is_err());
    }
}

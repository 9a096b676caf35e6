//! Which parts of the window look otherwise than in the last frame.
//!
//! The window is divided into tiles. All that is painted over a tile, in its order, makes a number; where that is the
//! same as in the last frame, the tile looks the same. Two different frames give the same number once in 2⁶⁴ times.

use super::Part;

/// Columns and rows of a tile: a line of text changes few of them.
const TILE: [u32; 2] = [64, 16];

/// What makes a number of all that was painted. The multiplier is odd, so that no bit is lost, and its bits are spread
/// (the golden ratio).
pub(super) fn mix(number: u64, with: u64) -> u64 {
    (number.rotate_left(29) ^ with).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

/// A frame as it is going to be: a number a tile, rows from the top.
#[derive(Debug, Default)]
pub(super) struct Seen {
    size: [u32; 2],
    across: u32,
    numbers: Vec<u64>,
}

impl Seen {
    /// One of so many columns and rows with nothing in it.
    pub(super) fn new(size: [u32; 2]) -> Self {
        let [across, down] = [0, 1].map(|i| size[i].div_ceil(TILE[i]));
        Self {
            size,
            across,
            numbers: vec![0; across as usize * down as usize],
        }
    }

    /// Something is painted over all of this part; what is painted there otherwise has another number.
    pub(super) fn add(&mut self, part: Part, number: u64) {
        if part.is_empty() {
            return;
        }
        let first = [0, 1].map(|i| part.from[i] / TILE[i]);
        let end = [0, 1].map(|i| part.to[i].div_ceil(TILE[i]));
        for y in first[1]..end[1] {
            let row = y as usize * self.across as usize;
            for seen in &mut self.numbers[row + first[0] as usize..row + end[0] as usize] {
                *seen = mix(*seen, number);
            }
        }
    }

    /// Tiles beside each other, from `first` to before `end`, in rows from `top` to before `bottom`.
    fn part(&self, [first, end]: [u32; 2], [top, bottom]: [u32; 2]) -> Part {
        Part {
            from: [first * TILE[0], top * TILE[1]],
            to: [
                (end * TILE[0]).min(self.size[0]),
                (bottom * TILE[1]).min(self.size[1]),
            ],
        }
    }
}

/// The last frame.
#[derive(Debug, Default)]
pub(super) struct Tiles(Seen);

impl Tiles {
    /// The parts of a frame that look otherwise than in the last one, which it becomes.
    pub(super) fn differ(&mut self, seen: Seen) -> Vec<Part> {
        let last = std::mem::replace(&mut self.0, seen);
        let seen = &self.0;
        let is_other = |i: usize| last.size != seen.size || last.numbers[i] != seen.numbers[i];
        let mut parts = Vec::new();
        // Runs of a row of tiles that go on below are one part: their columns, and the row in which they begin.
        let mut open: Vec<([u32; 2], u32)> = Vec::new();
        let down = seen.size[1].div_ceil(TILE[1]);
        for y in 0..=down {
            let mut runs: Vec<[u32; 2]> = Vec::new();
            for x in 0..if y < down { seen.across } else { 0 } {
                if is_other(y as usize * seen.across as usize + x as usize) {
                    match runs.last_mut() {
                        Some(run) if run[1] == x => run[1] = x + 1,
                        _ => runs.push([x, x + 1]),
                    }
                }
            }
            open.retain(|&(run, top)| {
                let goes_on = runs.contains(&run);
                if !goes_on {
                    parts.push(seen.part(run, [top, y]));
                }
                goes_on
            });
            for run in runs {
                if !open.iter().any(|(other, _)| *other == run) {
                    open.push((run, y));
                }
            }
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [200, 50];

    fn part(from: [u32; 2], to: [u32; 2]) -> Part {
        Part { from, to }
    }

    #[test]
    fn what_changed_is_found_and_nothing_else() {
        let mut tiles = Tiles::default();
        let frame = |things: &[(Part, u64)]| {
            let mut seen = Seen::new(SIZE);
            for (part, number) in things {
                seen.add(*part, *number);
            }
            seen
        };
        let ground = (Part::whole(SIZE), 1);
        let text = part([70, 20], [130, 30]);
        assert_eq!(tiles.differ(frame(&[ground])), [Part::whole(SIZE)]);
        assert_eq!(tiles.differ(frame(&[ground])), []);
        // The text lies on two columns of tiles and in one row of them.
        let two = [part([64, 16], [192, 32])];
        assert_eq!(tiles.differ(frame(&[ground, (text, 2)])), two);
        assert_eq!(tiles.differ(frame(&[ground, (text, 2)])), []);
        assert_eq!(tiles.differ(frame(&[ground, (text, 3)])), two);
        // Another order is another look.
        assert_eq!(tiles.differ(frame(&[(text, 3), ground])), two);
        // The last tiles are not whole, and rows that have the same columns are one part.
        let tall = part([190, 20], [200, 50]);
        let with = frame(&[(text, 3), ground, (tall, 4)]);
        assert_eq!(tiles.differ(with), [part([128, 16], [200, 50])]);
        assert_eq!(tiles.differ(Seen::new([64, 16])), [part([0, 0], [64, 16])]);
    }
}

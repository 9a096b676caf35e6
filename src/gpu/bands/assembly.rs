//! The band under way: rectangles of pixels come in, a band goes out, with the places of the pixels that are in doubt.

use std::ops::Range;

use super::listed;
use super::partial::{Layout, Partials};
use super::plan::Rectangle;
use super::slot::Took;
use crate::frame::{Band, spare};
use crate::shader::feature_set::LISTED_WORDS;
use crate::shader::form::{GROUP, GROUP_WORDS, Pixels};

/// A band as the GPU has it.
#[derive(Debug)]
pub struct Rendered {
    /// Its pixels, without verdicts.
    pub band: Band,
    /// The places of the pixels that the GPU leaves to the CPU, counted from the band's top left, in rising order.
    pub doubtful: Vec<u32>,
    /// What it has of those of them that have sure samples too.
    pub partials: Partials,
    /// The places of the pixels that were doubtful in f32 and are sure in f64, in rising order.
    pub doubled: Vec<u32>,
    /// Seconds that its kernels took.
    pub kernel: f64,
    /// Seconds of those that went into f64.
    pub double: f64,
    /// How many pixels f64 was asked for.
    pub listed: u64,
}

/// The band under way, put together from its rectangles.
#[derive(Debug)]
pub(super) struct Assembly {
    width: usize,
    pixels: Pixels,
    under_way: Option<Rendered>,
    /// What f64 made of pixels of it.
    found: Vec<(u32, [u8; 3])>,
    complete: bool,
}

/// Where a rectangle's pixels go.
struct Target<'a> {
    /// Columns of the band.
    width: usize,
    columns: Range<usize>,
    rgb: &'a mut [u8],
    values: Option<&'a mut Vec<[f32; 3]>>,
    doubtful: &'a mut Vec<u32>,
}

impl Assembly {
    pub(super) fn new(width: u32, pixels: Pixels) -> Self {
        Self {
            width: width as usize,
            pixels,
            under_way: None,
            found: Vec::new(),
            complete: false,
        }
    }

    /// Copies a rectangle's pixels to their place, notes which the GPU leaves to the CPU, and takes the records of
    /// those with sure and doubtful samples.
    pub(super) fn take(&mut self, rectangle: &Rectangle, layout: &Layout, bytes: &[u8]) {
        let [counter, bytes, records] = layout.split(bytes);
        #[cfg(test)]
        let bytes = &tests::tampered(rectangle, bytes, self.pixels);
        let rows = (rectangle.band.end - rectangle.band.start) as usize;
        let pixels = rows * self.width;
        let values = self.pixels == Pixels::Values;
        let Rendered {
            band,
            doubtful,
            partials,
            ..
        } = self.under_way.get_or_insert_with(|| Rendered {
            band: Band {
                rows: rectangle.band.clone(),
                rgb: spare::take(3 * pixels),
                values: values.then(|| vec![[0.0; 3]; pixels]),
                verdicts: None,
            },
            doubtful: Vec::new(),
            partials: Partials::default(),
            doubled: Vec::new(),
            kernel: 0.0,
            double: 0.0,
            listed: 0,
        });
        let list = [counter, records];
        if layout.words > LISTED_WORDS {
            partials.take(rectangle, self.width as u32, layout.words, list);
        }
        let mut target = Target {
            width: self.width,
            columns: rectangle.columns.start as usize..rectangle.columns.end as usize,
            rgb: &mut band.rgb,
            values: band.values.as_mut(),
            doubtful,
        };
        match self.pixels {
            Pixels::Packed => target.take_packed(rows, bytes),
            Pixels::Words => target.take_words::<4>(rows, bytes),
            Pixels::Values => target.take_words::<16>(rows, bytes),
        }
        let found = listed::decided(rectangle, self.width as u32, layout, list);
        self.found.extend(found);
        self.complete = rectangle.last;
    }

    /// What the kernels of a rectangle that was taken took.
    pub(super) fn took(&mut self, took: &Took) {
        if let Some(rendered) = &mut self.under_way {
            rendered.kernel += took.kernel;
            rendered.double += took.double;
            rendered.listed += u64::from(took.listed);
        }
    }

    /// The band, if all its rectangles have come.
    pub(super) fn finished(&mut self) -> Option<Rendered> {
        if !std::mem::take(&mut self.complete) {
            return None;
        }
        let mut rendered = self.under_way.take()?;
        // Rectangles side by side bring their rows one after the other.
        rendered.doubtful.sort_unstable();
        let found = std::mem::take(&mut self.found);
        rendered.doubled = listed::settle(found, &mut rendered.band.rgb, &mut rendered.doubtful);
        rendered.partials.finish();
        Some(rendered)
    }
}

/// The last word of a pixel.
fn last(pixel: &[u8]) -> [u8; 4] {
    pixel.last_chunk().copied().unwrap_or_default()
}

impl Target<'_> {
    /// Of rows of groups of bytes as they are wanted, and their verdicts behind them.
    fn take_packed(&mut self, rows: usize, bytes: &[u8]) {
        let groups = self.columns.len().div_ceil(GROUP as usize);
        let (rgb, verdicts) = bytes.split_at(4 * GROUP_WORDS as usize * groups * rows);
        // A row of the buffer may be longer than the row of pixels that it holds.
        let line = rgb.len() / rows;
        let wanted = 3 * self.columns.len();
        if line == 3 * self.width {
            self.rgb.copy_from_slice(rgb);
        } else {
            for (row, line) in rgb.chunks_exact(line).enumerate() {
                let place = row * self.width + self.columns.start;
                self.rgb[3 * place..][..wanted].copy_from_slice(&line[..wanted]);
            }
        }
        for (row, words) in verdicts.chunks_exact(4 * groups).enumerate() {
            let place = row * self.width + self.columns.start;
            for (group, word) in words.as_chunks().0.iter().enumerate() {
                let mut bits = u32::from_le_bytes(*word);
                while bits != 0 {
                    let column = group * GROUP as usize + bits.trailing_zeros() as usize;
                    if column < self.columns.len() {
                        self.doubtful.push((place + column) as u32);
                    }
                    bits &= bits - 1;
                }
            }
        }
    }

    /// Of rows of pixels of so many bytes. The last one of each is its verdict, 0 if it is sure: the bytes before it
    /// have to be taken apart anyway.
    fn take_words<const BYTES: usize>(&mut self, rows: usize, bytes: &[u8]) {
        // A row of the buffer may be longer than the row of pixels that it holds.
        for (row, line) in bytes.chunks_exact(bytes.len() / rows).enumerate() {
            let line = &line.as_chunks::<BYTES>().0[..self.columns.len()];
            let start = row * self.width + self.columns.start;
            let place = start..start + self.columns.len();
            let rgb = self.rgb[3 * place.start..3 * place.end].as_chunks_mut().0;
            let mut verdicts = 0;
            for (pixel, to) in line.iter().zip(rgb) {
                let [r, g, b, verdict] = last(pixel);
                *to = [r, g, b];
                verdicts |= verdict;
            }
            if verdicts != 0 {
                let pixels = line.iter().enumerate();
                let doubtful = pixels.filter(|(_, pixel)| pixel[BYTES - 1] != 0);
                self.doubtful
                    .extend(doubtful.map(|(i, _)| (start + i) as u32));
            }
            if let Some(values) = &mut self.values {
                for (pixel, to) in line.iter().zip(&mut values[place]) {
                    let words = pixel.as_chunks().0;
                    let channel = |i: usize| f32::from_bits(u32::from_le_bytes(words[i])) / 255.0;
                    *to = [channel(0), channel(1), channel(2)];
                }
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::cell::RefCell;

    use super::super::partial::tests::form;
    use super::*;

    thread_local! {
        /// Pixels (column, row from the bottom) that the GPU gets wrong, of what is rendered on this thread next, and
        /// the verdict that comes with them.
        static TAMPERED: RefCell<(Vec<[u32; 2]>, u8)> = const { RefCell::new((Vec::new(), 0)) };
    }

    /// Makes the GPU get the red of these pixels wrong by one, in what this thread renders next, with a verdict.
    pub(crate) fn tamper_with(pixels: &[[u32; 2]], verdict: u8) {
        TAMPERED.set((pixels.to_vec(), verdict));
    }

    /// Makes another thread get wrong what this one does.
    pub(crate) fn carry() -> Box<dyn FnOnce() + Send> {
        let tampered = TAMPERED.with_borrow(Clone::clone);
        Box::new(move || TAMPERED.set(tampered))
    }

    /// What [`Assembly::take`] gets under test.
    pub(super) fn tampered(rectangle: &Rectangle, bytes: &[u8], form: Pixels) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        let (pixels, verdict) = TAMPERED.with_borrow(Clone::clone);
        for [x, y] in pixels {
            if !rectangle.band.contains(&y) || !rectangle.columns.contains(&x) {
                continue;
            }
            let row = (rectangle.band.end - 1 - y) as usize;
            let column = (x - rectangle.columns.start) as usize;
            match form {
                Pixels::Packed => {
                    let groups = rectangle.columns.len().div_ceil(GROUP as usize);
                    let verdicts = 48 * groups * rectangle.band.len();
                    bytes[48 * groups * row + 3 * column] ^= 1;
                    let at = verdicts + 4 * (groups * row + column / 16) + column % 16 / 8;
                    let bit = 1 << (column % 8);
                    bytes[at] = bytes[at] & !bit | if verdict == 0 { 0 } else { bit };
                }
                Pixels::Words => {
                    let at = row * (bytes.len() / rectangle.band.len()) + 4 * column;
                    bytes[at] ^= 1;
                    bytes[at + 3] = verdict;
                }
                Pixels::Values => {}
            }
        }
        bytes
    }

    /// Two rectangles side by side, a band of two rows: every pixel at its place, and no doubtful one dropped.
    #[test]
    fn rectangles_side_by_side_are_one_band() {
        let mut assembly = Assembly::new(5, Pixels::Words);
        let mut rectangle = Rectangle {
            band: 10..12,
            columns: 0..3,
            last: false,
        };
        let pixel = |n: u8, verdict: u8| [n, n + 100, n + 200, verdict];
        let left = [
            pixel(0, 0),
            pixel(1, 1),
            pixel(2, 0),
            pixel(5, 255),
            pixel(6, 0),
            pixel(7, 0),
        ];
        assembly.take(
            &rectangle,
            &Layout::new(&form(Pixels::Words, 0), 6),
            left.as_flattened(),
        );
        assert!(assembly.finished().is_none());
        rectangle.columns = 3..5;
        rectangle.last = true;
        let right = [pixel(3, 1), pixel(4, 0), pixel(8, 0), pixel(9, 2)];
        assembly.take(
            &rectangle,
            &Layout::new(&form(Pixels::Words, 0), 4),
            right.as_flattened(),
        );
        let rendered = assembly.finished().unwrap();
        let rgb: Vec<u8> = (0..10).flat_map(|n| [n, n + 100, n + 200]).collect();
        assert_eq!(rendered.band.rgb, rgb);
        assert_eq!(rendered.band.rows, 10..12);
        assert_eq!(rendered.doubtful, [1, 3, 5, 9]);
        assert!(assembly.finished().is_none());
    }

    /// The same packed, of all widths around a group's: what rows are filled up with is dropped, verdicts and all.
    #[test]
    fn packed_rectangles_side_by_side_are_one_band() {
        for widths in [[1, 1], [16, 1], [16, 16], [17, 15], [5, 48], [33, 64]] {
            let width = widths[0] + widths[1];
            let byte = |row: u32, column: u32, i: u32| (row * 71 + column * 3 + i) as u8;
            let is_doubtful = |row: u32, column: u32| (row + column).is_multiple_of(5);
            let mut assembly = Assembly::new(width, Pixels::Packed);
            let mut start = 0;
            for columns in widths {
                let filled = columns.next_multiple_of(GROUP);
                let mut bytes = Vec::new();
                for row in 0..3 {
                    let inside = (start..start + columns).flat_map(|c| (0..3).map(move |i| (c, i)));
                    bytes.extend(inside.map(|(column, i)| byte(row, column, i)));
                    bytes.extend(vec![77; 3 * (filled - columns) as usize]);
                }
                for (row, group) in
                    (0..3).flat_map(|row| (0..filled / GROUP).map(move |g| (row, g)))
                {
                    // Whatever is behind the last column is in doubt.
                    let bit = |i: u32| {
                        let column = group * GROUP + i;
                        u32::from(column >= columns || is_doubtful(row, start + column)) << i
                    };
                    bytes.extend((0..GROUP).map(bit).sum::<u32>().to_le_bytes());
                }
                let rectangle = Rectangle {
                    band: 4..7,
                    columns: start..start + columns,
                    last: start + columns == width,
                };
                let layout = Layout::new(&form(Pixels::Packed, 0), u64::from(3 * filled));
                assembly.take(&rectangle, &layout, &bytes);
                start += columns;
            }
            let rendered = assembly.finished().unwrap();
            let places = (0..3).flat_map(|row| (0..width).map(move |column| (row, column)));
            let rgb = places
                .clone()
                .flat_map(|(row, c)| (0..3).map(move |i| byte(row, c, i)));
            assert!(rendered.band.rgb == rgb.collect::<Vec<_>>(), "{widths:?}");
            let doubtful = places.filter(|(row, column)| is_doubtful(*row, *column));
            let doubtful: Vec<u32> = doubtful.map(|(row, c)| row * width + c).collect();
            assert_eq!(rendered.doubtful, doubtful, "{widths:?}");
        }
    }
}

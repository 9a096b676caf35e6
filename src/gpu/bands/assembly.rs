//! The band under way: rectangles of pixels come in, a band goes out, with the places of the pixels that are in doubt.

use super::partial::{Layout, Partials};
use super::plan::Rectangle;
use crate::frame::Band;

/// A band as the GPU has it.
#[derive(Debug)]
pub struct Rendered {
    /// Its pixels, without verdicts.
    pub band: Band,
    /// The places of the pixels that the GPU leaves to the CPU, counted from the band's top left, in rising order.
    pub doubtful: Vec<u32>,
    /// What it has of those of them that have sure samples too.
    pub partials: Partials,
}

/// The band under way, put together from its rectangles.
#[derive(Debug)]
pub(super) struct Assembly {
    width: usize,
    values: bool,
    under_way: Option<Rendered>,
    complete: bool,
}

impl Assembly {
    pub(super) fn new(width: u32, values: bool) -> Self {
        Self {
            width: width as usize,
            values,
            under_way: None,
            complete: false,
        }
    }

    /// Copies a rectangle's pixels to their place. Each comes with its verdict in its highest byte, 0 if it is sure:
    /// the bytes below it have to be taken apart anyway. Behind them are the records of those with sure and doubtful
    /// samples.
    pub(super) fn take(&mut self, rectangle: &Rectangle, layout: &Layout, bytes: &[u8]) {
        let [counter, bytes, records] = layout.split(bytes);
        #[cfg(test)]
        let bytes = &tests::tampered(rectangle, bytes, self.values);
        let rows = (rectangle.band.end - rectangle.band.start) as usize;
        let pixels = rows * self.width;
        let Rendered {
            band,
            doubtful,
            partials,
        } = self.under_way.get_or_insert_with(|| Rendered {
            band: Band {
                rows: rectangle.band.clone(),
                rgb: vec![0; 3 * pixels],
                values: self.values.then(|| vec![[0.0; 3]; pixels]),
                verdicts: None,
            },
            doubtful: Vec::new(),
            partials: Partials::default(),
        });
        let list = [counter, records];
        partials.take(rectangle, self.width as u32, layout.words, list);
        let columns = rectangle.columns.start as usize..rectangle.columns.end as usize;
        let pixel_bytes = if self.values { 16 } else { 4 };
        // A row of the buffer may be longer than the row of pixels that it holds.
        for (row, line) in bytes.chunks_exact(bytes.len() / rows).enumerate() {
            let line = &line[..columns.len() * pixel_bytes];
            let place = row * self.width + columns.start..row * self.width + columns.end;
            let rgb = &mut band.rgb[3 * place.start..3 * place.end];
            let mut verdicts = 0;
            for (pixel, to) in line.chunks_exact(pixel_bytes).zip(rgb.chunks_exact_mut(3)) {
                to.copy_from_slice(&pixel[pixel_bytes - 4..pixel_bytes - 1]);
                verdicts |= pixel[pixel_bytes - 1];
            }
            if verdicts != 0 {
                let pixels = line.chunks_exact(pixel_bytes).enumerate();
                doubtful.extend(
                    pixels
                        .filter(|(_, p)| p[pixel_bytes - 1] != 0)
                        .map(|(i, _)| (place.start + i) as u32),
                );
            }
            if let Some(values) = &mut band.values {
                for (pixel, to) in line.chunks_exact(pixel_bytes).zip(&mut values[place]) {
                    let channel = |i: usize| -> f32 {
                        let word = pixel[4 * i..4 * i + 4]
                            .try_into()
                            .map_or(0, u32::from_le_bytes);
                        f32::from_bits(word) / 255.0
                    };
                    *to = [channel(0), channel(1), channel(2)];
                }
            }
        }
        self.complete = rectangle.last;
    }

    /// The band, if all its rectangles have come.
    pub(super) fn finished(&mut self) -> Option<Rendered> {
        if !std::mem::take(&mut self.complete) {
            return None;
        }
        let mut rendered = self.under_way.take()?;
        // Rectangles side by side bring their rows one after the other.
        rendered.doubtful.sort_unstable();
        rendered.partials.finish();
        Some(rendered)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::cell::RefCell;

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
    pub(super) fn tampered(rectangle: &Rectangle, bytes: &[u8], values: bool) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        let (pixels, verdict) = TAMPERED.with_borrow(Clone::clone);
        for [x, y] in pixels {
            if !values && rectangle.band.contains(&y) && rectangle.columns.contains(&x) {
                let row = rectangle.band.end - 1 - y;
                let line = bytes.len() / rectangle.band.len();
                let at = row as usize * line + 4 * (x - rectangle.columns.start) as usize;
                bytes[at] ^= 1;
                bytes[at + 3] = verdict;
            }
        }
        bytes
    }

    /// Two rectangles side by side, a band of two rows: every pixel at its place, and no doubtful one dropped.
    #[test]
    fn rectangles_side_by_side_are_one_band() {
        let mut assembly = Assembly::new(5, false);
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
        assembly.take(&rectangle, &Layout::of(4, 0, 6), left.as_flattened());
        assert!(assembly.finished().is_none());
        rectangle.columns = 3..5;
        rectangle.last = true;
        let right = [pixel(3, 1), pixel(4, 0), pixel(8, 0), pixel(9, 2)];
        assembly.take(&rectangle, &Layout::of(4, 0, 4), right.as_flattened());
        let rendered = assembly.finished().unwrap();
        let rgb: Vec<u8> = (0..10).flat_map(|n| [n, n + 100, n + 200]).collect();
        assert_eq!(rendered.band.rgb, rgb);
        assert_eq!(rendered.band.rows, 10..12);
        assert_eq!(rendered.doubtful, [1, 3, 5, 9]);
        assert!(assembly.finished().is_none());
    }
}

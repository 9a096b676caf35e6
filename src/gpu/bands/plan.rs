//! Which rectangle of the frame is dispatched next, and how large it is: bounded in time by what the last ones took.

use std::ops::Range;

use super::Order;
use crate::jitter::Jitter;
use crate::shader::constants::WORKGROUP;

/// Ray–object tests of the first dispatch, whose speed is not known yet, for each second that it may take: what two CPU
/// cores do at least.
const FIRST_TESTS: f64 = 56e6;
/// What a pixel costs beside its objects, in tests.
const PIXEL_TESTS: u64 = 8;

/// Most pixels of a dispatch in a direction: every device has so many workgroups.
const MOST_ACROSS: u32 = 65_535 * WORKGROUP;

/// A rectangle of a band: columns of rows `band` (from the bottom).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) band: Range<u32>,
    pub(super) columns: Range<u32>,
    /// Whether the band is complete with it.
    pub(super) last: bool,
}

impl Rectangle {
    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.band.end - self.band.start)
            * u64::from(self.columns.end - self.columns.start)
    }

    /// The offsets of the samples of its pixels, top row first.
    pub(super) fn offsets(&self, jitter: &Jitter, samples: u32) -> Vec<[f32; 2]> {
        let columns = self.columns.start as usize * samples as usize
            ..self.columns.end as usize * samples as usize;
        let rows = self.band.clone().rev().filter_map(|y| jitter.row(y));
        rows.flat_map(|row| {
            row[columns.clone()]
                .iter()
                .map(|[a, b]| [*a as f32, *b as f32])
                .collect::<Vec<_>>()
        })
        .collect()
    }
}

/// What comes next.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// This.
    Rectangle(Rectangle),
    /// Nothing yet.
    Later,
    /// Nothing any more.
    End,
}

/// Which rectangle comes next, and how large it is to be.
#[derive(Debug)]
pub(super) struct Plan {
    width: u32,
    largest: u64,
    pixels: u64,
    /// Rows of a band, if that was asked for.
    band_rows: Option<u32>,
    /// A dispatch is made larger or smaller so that it takes about so many seconds.
    seconds: f64,
    /// The band under way and its next column.
    pub(super) band: Option<(Range<u32>, u32)>,
}

impl Plan {
    pub(super) fn new(
        width: u32,
        largest: u64,
        tests: usize,
        band_rows: Option<u32>,
        seconds: f64,
    ) -> Self {
        let first = (FIRST_TESTS * seconds) as u64;
        let pixels = (first / (tests as u64 + PIXEL_TESTS)).clamp(1, largest);
        Self {
            width,
            largest,
            pixels,
            band_rows,
            seconds,
            band: None,
        }
    }

    /// Learns that a dispatch of so many pixels took so long.
    pub(super) fn took(&mut self, pixels: u64, seconds: f64) {
        let ideal = pixels as f64 * self.seconds / seconds.max(1e-6);
        // The size changes by a factor of four at most: one measurement says little, and the next rectangle may cost
        // differently.
        let (least, most) = (self.pixels as f64 / 4.0, self.pixels as f64 * 4.0);
        self.pixels = (ideal.clamp(least, most) as u64).clamp(1, self.largest);
    }

    /// Rows that a band should have: whole workgroups of them if they fit.
    fn wish(&self) -> u32 {
        let fitting = self.largest / u64::from(self.width);
        let fitting = fitting.clamp(1, u64::from(MOST_ACROSS)) as u32;
        let timely = (self.pixels / u64::from(self.width)) as u32 / WORKGROUP * WORKGROUP;
        let wish = self.band_rows.unwrap_or(timely.max(WORKGROUP));
        wish.clamp(1, fitting)
    }

    /// The next rectangle; `rows` is asked for another band, of about so many rows, where one is complete. Its columns
    /// are cut where even a row of workgroups takes too long.
    pub(super) fn next(&mut self, rows: &mut dyn FnMut(u32) -> Order) -> Next {
        let (band, column) = match self.band.take() {
            Some(under_way) => under_way,
            None => match rows(self.wish()) {
                Order::Rows(band) => (band, 0),
                Order::Later => return Next::Later,
                Order::End => return Next::End,
            },
        };
        let height = u64::from(band.end - band.start);
        let cut = (self.pixels / height) as u32 / WORKGROUP * WORKGROUP;
        let end = column + cut.clamp(WORKGROUP, MOST_ACROSS).min(self.width - column);
        let last = end == self.width;
        if !last {
            self.band = Some((band.clone(), end));
        }
        Next::Rectangle(Rectangle {
            band,
            columns: column..end,
            last,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MAX_PIXELS, from_the_top};
    use super::*;

    /// Every pixel exactly once, bands from the top down, and no dispatch larger than allowed.
    fn covers(
        width: u32,
        rows: Range<u32>,
        largest: u64,
        tested: usize,
        seconds: impl Fn(u64) -> f64,
    ) {
        for band_rows in [None, Some(1), Some(7), Some(1_000_000)] {
            covers_in_bands(width, rows.clone(), largest, tested, &seconds, band_rows);
        }
    }

    fn covers_in_bands(
        width: u32,
        rows: Range<u32>,
        largest: u64,
        tested: usize,
        seconds: &dyn Fn(u64) -> f64,
        band_rows: Option<u32>,
    ) {
        let mut plan = Plan::new(width, largest, tested, band_rows, 0.15);
        let mut source = from_the_top(rows.clone());
        let mut top = rows.end;
        let mut column = 0;
        while let Next::Rectangle(r) = plan.next(&mut |wish| source(wish, true)) {
            assert_eq!(r.columns.start, column);
            assert_eq!(r.band.end, top);
            assert!(r.pixels() <= largest && r.pixels() > 0, "{r:?}");
            assert!(r.columns.len() as u32 <= MOST_ACROSS && r.band.len() as u32 <= MOST_ACROSS);
            let fitting = (largest / u64::from(width)).clamp(1, u64::from(MOST_ACROSS));
            if let Some(band_rows) = band_rows {
                let height = u64::from(band_rows)
                    .min(fitting)
                    .min(u64::from(top - rows.start));
                assert_eq!(u64::from(r.band.end - r.band.start), height);
            }
            if r.last {
                assert_eq!(r.columns.end, width);
                top = r.band.start;
                column = 0;
            } else {
                column = r.columns.end;
            }
            plan.took(r.pixels(), seconds(r.pixels()));
        }
        assert_eq!((top, column), (rows.start, 0));
    }

    #[test]
    fn rectangles_cover_the_rows_once() {
        let fast = |pixels: u64| pixels as f64 * 1e-8;
        let slow = |pixels: u64| pixels as f64 * 1e-3;
        covers(640, 0..480, MAX_PIXELS, 3, fast);
        covers(640, 0..480, MAX_PIXELS, 100_000, slow);
        covers(1, 0..1, 1, 3, fast);
        covers(1_000_000, 3..57, MAX_PIXELS, 3, fast);
        covers(1_000_000, 0..40, MAX_PIXELS, 1_000_000, slow);
        covers(7, 100..1_000_000, MAX_PIXELS, 3, fast);
        // More rows, and more columns, than there can be workgroups for in one dispatch.
        covers(1, 0..1_000_000, MAX_PIXELS, 3, fast);
        covers(1_000_000, 5..6, MAX_PIXELS, 3, fast);
    }

    #[test]
    fn a_slow_scene_gets_small_dispatches() {
        let mut plan = Plan::new(1000, MAX_PIXELS, 3, None, 0.15);
        let mut source = from_the_top(0..1_000_000);
        let mut pixels = || match plan.next(&mut |wish| source(wish, true)) {
            Next::Rectangle(r) => {
                plan.took(r.pixels(), r.pixels() as f64 * 1e-4);
                r.pixels()
            }
            other => panic!("{other:?}"),
        };
        for _ in 0..10 {
            pixels();
        }
        let pixels = pixels();
        assert!(pixels as f64 * 1e-4 <= 0.5, "{pixels}");
    }
}

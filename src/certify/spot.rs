//! Which of the pixels that the GPU is sure of are computed again on the CPU: one in 4,096, and at least one a band.
//!
//! The choice depends on the pixel's place in the picture alone, so the same pixels are checked whatever the bands are
//! (but for those of bands that would have none); it is spread evenly, and follows no column, row or workgroup.

use std::ops::Range;

/// One pixel is checked of this many that follow each other in their rows.
pub const CELL: u64 = 4096;

/// The places (counted from the band's top left) of the pixels to check, in a band of these rows whose doubtful pixels
/// stand at the places `doubtful`, in rising order.
pub fn spots(width: u32, rows: &Range<u32>, doubtful: &[u32]) -> Vec<u32> {
    let (width, top) = (u64::from(width), u64::from(rows.end) - 1);
    let (start, end) = (u64::from(rows.start) * width, u64::from(rows.end) * width);
    let sure = |place: &u32| doubtful.binary_search(place).is_err();
    let mut places: Vec<u32> = (start / CELL..=(end - 1) / CELL)
        .map(|cell| cell * CELL + mix(cell) % CELL)
        .filter(|number| (start..end).contains(number))
        .map(|number| ((top - number / width) * width + number % width) as u32)
        .filter(sure)
        .collect();
    if places.is_empty() {
        let pixels = (end - start) as u32;
        let first = (mix(start ^ end << 32) % u64::from(pixels)) as u32;
        places.extend((first..pixels).chain(0..first).find(sure));
    }
    places.sort_unstable();
    places
}

/// A hash of a number: the finaliser of MurmurHash3.
fn mix(mut v: u64) -> u64 {
    v ^= v >> 33;
    v = v.wrapping_mul(0xff51_afd7_ed55_8ccd);
    v ^= v >> 33;
    v = v.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    v ^ v >> 33
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column and row of a place.
    fn at(width: u32, rows: &Range<u32>, place: u32) -> [u32; 2] {
        [place % width, rows.end - 1 - place / width]
    }

    #[test]
    fn one_in_4096_whatever_the_bands() {
        let (width, height) = (640, 480);
        let whole = spots(width, &(0..height), &[]);
        assert_eq!(whole.len(), 75);
        let mut from_whole: Vec<_> = whole.iter().map(|p| at(width, &(0..height), *p)).collect();
        let mut from_bands = Vec::new();
        // Bands of this height each have some pixels to check.
        for start in (0..height).step_by(96) {
            let rows = start..start + 96;
            from_bands.extend(
                spots(width, &rows, &[])
                    .iter()
                    .map(|p| at(width, &rows, *p)),
            );
        }
        from_whole.sort_unstable();
        from_bands.sort_unstable();
        assert_eq!(from_whole, from_bands);
        let columns: std::collections::BTreeSet<_> =
            from_whole.iter().map(|[x, _]| x / 64).collect();
        assert_eq!(columns.len(), 10, "they are spread over the columns");
    }

    #[test]
    fn every_band_has_one_if_it_has_a_sure_pixel() {
        for width in [1, 7, 100] {
            for y in 0..50 {
                let all: Vec<u32> = (0..width).collect();
                assert_eq!(spots(width, &(y..y + 1), &[]).len(), 1);
                assert!(spots(width, &(y..y + 1), &all).is_empty());
                let but_one: Vec<u32> = all.iter().copied().filter(|p| *p != width / 2).collect();
                assert_eq!(spots(width, &(y..y + 1), &but_one), [width / 2]);
            }
        }
    }

    #[test]
    fn doubtful_pixels_are_not_checked_twice() {
        let rows = 0..200;
        let all = spots(640, &rows, &[]);
        let fewer = spots(640, &rows, &all[..5]);
        assert_eq!(fewer, all[5..]);
    }

    #[test]
    fn the_largest_picture_does_not_overflow() {
        let rows = 999_999..1_000_000;
        let places = spots(1_000_000, &rows, &[]);
        assert!((230..260).contains(&places.len()));
        assert!(places.iter().all(|p| *p < 1_000_000));
    }
}

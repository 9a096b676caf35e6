//! Which of the pixels that the GPU is sure of are computed again on the CPU: one in 4,096, and at least one a band.
//!
//! Where a pixel stands decides by itself about every second of them, so the same pixels are checked whatever the bands
//! are (but for those of bands that would have none); they are spread evenly, and follow no column, row or workgroup.
//! The others go on from such a place to where margins are smallest. A margin, be it to a byte's border, an edge or a
//! tile's end, shrinks steadily along a row until something changes: it is the smallest beside a pixel that is in
//! doubt, else where the colour changes. That costs nothing on the GPU.

use std::ops::Range;

/// One pixel is checked of this many that follow each other in their rows.
pub const CELL: u64 = 4096;

/// How many pixels a place is moved by at most to where the colour changes, in the order of the band's bytes.
const NEAR: usize = 256;

/// The places (counted from the band's top left) of the pixels to check, in a band of these rows with the bytes `rgb`,
/// whose doubtful pixels stand at the places `doubtful`, in rising order.
pub fn spots(width: u32, rows: &Range<u32>, rgb: &[u8], doubtful: &[u32]) -> Vec<u32> {
    let (width, top) = (u64::from(width), u64::from(rows.end) - 1);
    let (start, end) = (u64::from(rows.start) * width, u64::from(rows.end) * width);
    let sure = |place: &u32| doubtful.binary_search(place).is_err();
    let mut places: Vec<u32> = (start / CELL..=(end - 1) / CELL)
        .map(|cell| (cell, cell * CELL + mix(cell) % CELL))
        .filter(|(_, number)| (start..end).contains(number))
        .map(|(cell, number)| {
            let place = ((top - number / width) * width + number % width) as u32;
            let moved = !cell.is_multiple_of(2);
            moved
                .then(|| narrow(place, rgb, doubtful))
                .flatten()
                .unwrap_or(place)
        })
        .filter(sure)
        .collect();
    if places.is_empty() {
        let pixels = (end - start) as u32;
        let first = (mix(start ^ end << 32) % u64::from(pixels)) as u32;
        places.extend((first..pixels).chain(0..first).find(sure));
    }
    places.sort_unstable();
    places.dedup();
    places
}

/// From a place on, the next pixel that is sure and beside one that is not, in so many as one is checked of; else the
/// next whose colour is not that of the one before, not so far away.
fn narrow(place: u32, rgb: &[u8], doubtful: &[u32]) -> Option<u32> {
    let next = doubtful.partition_point(|doubt| *doubt <= place);
    // The first of a run of doubtful pixels, with a sure one before it.
    if let Some(doubt) = doubtful[next..].first()
        && u64::from(doubt - place) < CELL
    {
        return Some(doubt - 1);
    }
    let (pixels, _) = rgb.as_chunks::<3>();
    let (start, end) = (place as usize, pixels.len().min(place as usize + NEAR));
    let pairs = pixels.get(start..end)?.windows(2);
    let change = pairs.take_while(|pair| pair[0] == pair[1]).count();
    (start + change + 1 < end).then(|| place + 1 + change as u32)
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
        let whole = spots(width, &(0..height), &[], &[]);
        assert_eq!(whole.len(), 75);
        let mut from_whole: Vec<_> = whole.iter().map(|p| at(width, &(0..height), *p)).collect();
        let mut from_bands = Vec::new();
        // Bands of this height each have some pixels to check.
        for start in (0..height).step_by(96) {
            let rows = start..start + 96;
            from_bands.extend(
                spots(width, &rows, &[], &[])
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
                assert_eq!(spots(width, &(y..y + 1), &[], &[]).len(), 1);
                assert!(spots(width, &(y..y + 1), &[], &all).is_empty());
                let but_one: Vec<u32> = all.iter().copied().filter(|p| *p != width / 2).collect();
                assert_eq!(spots(width, &(y..y + 1), &[], &but_one), [width / 2]);
            }
        }
    }

    #[test]
    fn doubtful_pixels_are_not_checked_twice() {
        let rows = 0..200;
        let all = spots(640, &rows, &[], &[]);
        let fewer = spots(640, &rows, &[], &all[..5]);
        assert!(fewer.len() >= all.len() - 5);
        assert!(fewer.iter().all(|place| !all[..5].contains(place)));
    }

    /// A wrong area of a few dozen pixels is missed by places alone, most often; where it ends in doubt it is found.
    #[test]
    fn every_second_check_is_where_margins_are_smallest() {
        let (width, rows) = (640, 0..480);
        let by_place = spots(width, &rows, &[], &[]);
        let common = |moved: &[u32]| moved.iter().filter(|p| by_place.contains(p)).count();
        // Every 1,000th pixel is doubtful.
        let doubtful: Vec<u32> = (500..307_200).step_by(1000).collect();
        let beside = spots(width, &rows, &[], &doubtful);
        let moved = beside.iter().filter(|p| (*p + 1) % 1000 == 500).count();
        assert!((36..=38).contains(&moved), "{moved}");
        assert!(moved + common(&beside) >= beside.len());
        // The colour changes by one at every 200th pixel.
        let rgb: Vec<u8> = (0..3 * 307_200).map(|i| (i / 600 % 251) as u8).collect();
        let at_changes = spots(width, &rows, &rgb, &[]);
        let moved = at_changes.iter().filter(|p| *p % 200 == 0).count();
        assert!((36..=38).contains(&moved), "{moved}");
        assert!(moved + common(&at_changes) >= at_changes.len());
        // Where it changes too far away, or not at all, the place stays.
        assert_eq!(spots(width, &rows, &vec![7; 3 * 307_200], &[]), by_place);
    }

    #[test]
    fn the_largest_picture_does_not_overflow() {
        let rows = 999_999..1_000_000;
        let places = spots(1_000_000, &rows, &[], &[]);
        assert!((230..260).contains(&places.len()));
        assert!(places.iter().all(|p| *p < 1_000_000));
    }
}

//! Pixels that were in doubt in f32, and what f64 made of them on the GPU.
//!
//! The picture's shader lists them, in an order that changes from run to run, as long as there is room; another one
//! takes them from the list and writes what becomes of them beside their places (`shaders/entry/listed.wgsl`): of
//! several samples it traces those that f32 left. What it is not sure of either, and what had no room, is left to the
//! CPU.

use super::partial::Layout;
use super::plan::Rectangle;

fn word(bytes: &[u8; 4]) -> u32 {
    u32::from_le_bytes(*bytes)
}

/// How many pixels were listed, as the counters before the pixels say.
pub(super) fn count(layout: &Layout, counters: &[u8]) -> u32 {
    let count = counters.as_chunks().0.first().map_or(0, word);
    if layout.listed {
        count.min(layout.room)
    } else {
        0
    }
}

/// The pixels of a rectangle that f64 is sure of: places in a band of this width, and bytes.
pub(super) fn decided<'a>(
    rectangle: &'a Rectangle,
    width: u32,
    layout: &Layout,
    [counters, records]: [&'a [u8]; 2],
) -> impl Iterator<Item = (u32, [u8; 3])> + 'a {
    let count = count(layout, counters);
    let columns = rectangle.columns.len() as u32;
    let list = records.chunks_exact(4 * layout.words.max(1) as usize);
    list.take(count as usize).filter_map(move |record| {
        let [place, pixel, ..] = record.as_chunks().0 else {
            return None;
        };
        let place = word(place);
        let [red, green, blue, verdict] = *pixel;
        let inside = u64::from(place) < rectangle.pixels();
        (verdict == 0 && inside).then(|| {
            let (row, column) = (place / columns, place % columns);
            let place = row * width + rectangle.columns.start + column;
            (place, [red, green, blue])
        })
    })
}

/// Takes what f64 found into a band: its bytes where f32 was in doubt, and nowhere else. Returns the places, in rising
/// order, which are doubtful no more.
pub(super) fn settle(
    mut found: Vec<(u32, [u8; 3])>,
    rgb: &mut [u8],
    doubtful: &mut Vec<u32>,
) -> Vec<u32> {
    if found.is_empty() {
        return Vec::new();
    }
    found.sort_unstable();
    found.dedup_by_key(|(place, _)| *place);
    found.retain(|(place, _)| doubtful.binary_search(place).is_ok());
    let rgb = rgb.as_chunks_mut::<3>().0;
    for (place, bytes) in &found {
        rgb[*place as usize] = *bytes;
    }
    let places: Vec<u32> = found.into_iter().map(|(place, _)| place).collect();
    doubtful.retain(|place| places.binary_search(place).is_err());
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::feature_set::LISTED_WORDS;
    use crate::shader::form::{Form, Pixels};

    fn layout(pixels: u64) -> Layout {
        let form = Form {
            pixels: Pixels::Words,
            across: 1,
            offsets: 0,
            record_words: LISTED_WORDS,
            listed: true,
        };
        Layout::new(&form, pixels)
    }

    fn bytes(words: &[u32]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    const OPEN: u32 = 0xff00_0000;

    /// The right one of two rectangles, of 3 columns and 2 rows, in a band 8 wide.
    #[test]
    fn pixels_are_found_at_their_places() {
        let rectangle = Rectangle {
            band: 4..6,
            columns: 5..8,
            last: true,
        };
        let layout = layout(6);
        assert_eq!(layout.room, 6);
        let list = [
            4,
            0x0003_0201,
            1,
            OPEN,
            77,
            0x0003_0201,
            0,
            0x0009_0807,
            2,
            0x1,
        ];
        let found = |count: u32| -> Vec<_> {
            let counters = bytes(&[count, 1]);
            decided(&rectangle, 8, &layout, [&counters, &bytes(&list)]).collect()
        };
        // One that f64 is not sure of, one at no place, one that the counter does not count.
        assert_eq!(found(4), [(14, [1, 2, 3]), (5, [7, 8, 9])]);
        assert_eq!(found(5).len(), 3);
        // The counter counts those too that had no room.
        assert_eq!(found(500).len(), 3);
        assert_eq!(count(&layout, &bytes(&[500, 8])), 6);
        let unlisted = Layout {
            listed: false,
            ..layout
        };
        let counters = bytes(&[5, 1]);
        let list = bytes(&list);
        assert_eq!(
            decided(&rectangle, 8, &unlisted, [&counters, &list]).count(),
            0
        );
    }

    /// A place that comes twice counts once, one that was dropped stays in doubt, one that was sure stays as it was.
    #[test]
    fn only_what_was_in_doubt_is_settled() {
        let mut rgb = vec![0; 18];
        let mut doubtful = vec![1, 3, 4];
        let found = vec![
            (4, [7, 8, 9]),
            (2, [5, 5, 5]),
            (1, [1, 2, 3]),
            (4, [7, 8, 9]),
        ];
        let settled = settle(found, &mut rgb, &mut doubtful);
        assert_eq!((settled, doubtful), (vec![1, 4], vec![3]));
        assert_eq!(rgb, [0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 7, 8, 9, 0, 0, 0]);
    }
}

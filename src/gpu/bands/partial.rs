//! Pixels of which the GPU is sure of some samples only: the list of what it has of them.
//!
//! The shader appends a record for each (`Pixels` in `shaders/bindings.wgsl`), in an order that changes from run to
//! run, as long as there is room. A pixel without a record loses nothing but time: the CPU traces all of its samples.

use super::plan::Rectangle;
use crate::frame::Part;
use crate::shader::feature_set::{LISTED_WORDS, RECORD_HEAD};
use crate::shader::form::Form;

/// Bytes of the counters of records and of workgroups for them, before the pixels.
const COUNTER: u64 = 8;
/// Most bytes of the records of one dispatch: as many as its packed pixels have at most.
const MAX_BYTES: u64 = 8 << 20;
/// Most bytes that the list adds to the pixels.
pub(super) const MOST: u64 = COUNTER + MAX_BYTES;
/// So many records have room in any dispatch that has as many pixels.
const LEAST: u64 = 256;

/// Where a dispatch leaves what in its buffer: the counter of records, the pixels, the records (see
/// [`Form`]). Pixels alone where there are no records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    /// Bytes of the counter.
    pub(super) counter: u64,
    /// Bytes of the pixels.
    pub(super) pixels: u64,
    /// Words of a record.
    pub(super) words: u32,
    /// Whether the records are of all pixels in doubt, for f64.
    pub(super) listed: bool,
    /// Records that there is room for.
    pub(super) room: u32,
    /// Bytes of all.
    pub(super) bytes: u64,
}

impl Layout {
    /// Of a dispatch of so many pixels, with those that rows are filled up with.
    pub(super) fn new(form: &Form, pixels: u64) -> Self {
        let words = form.record_words;
        let (counter, room) = match words {
            0 => (0, 0),
            LISTED_WORDS => (COUNTER, room(pixels, LISTED_SHARE, words)),
            words => (COUNTER, room(pixels, PARTIAL_SHARE, words)),
        };
        let record = 4 * u64::from(words);
        Self {
            counter,
            pixels: form.bytes(pixels),
            words,
            listed: form.listed,
            room,
            bytes: counter + form.bytes(pixels) + u64::from(room) * record,
        }
    }

    /// Counter, pixels and records of what a dispatch left.
    pub(super) fn split<'a>(&self, bytes: &'a [u8]) -> [&'a [u8]; 3] {
        let (counter, rest) = bytes.split_at(self.counter as usize);
        let (pixels, records) = rest.split_at(self.pixels as usize);
        [counter, pixels, records]
    }
}

/// Of so many pixels one may be doubtful, where there are several samples. (Of our scenes at 16 samples up to an eighth
/// are, but they stand close together.)
const PARTIAL_SHARE: u64 = 2;
/// The same with a sample each: of ordinary scenes a fiftieth is.
const LISTED_SHARE: u64 = 8;

/// How many records a dispatch of so many pixels has room for, of so many words each, one in `share`.
fn room(pixels: u64, share: u64, words: u32) -> u32 {
    let most = MAX_BYTES / (4 * u64::from(words.max(1)));
    let room = (pixels / share).max(LEAST).min(pixels).min(most) as u32;
    #[cfg(test)]
    let room = tests::allowed(room);
    room
}

/// What is known of the pixels of a band.
#[derive(Debug, Clone, Default)]
pub struct Partials {
    /// Words of a record.
    stride: usize,
    words: Vec<u32>,
    /// The places of the pixels in the band, in rising order once it is finished, and the numbers of their records.
    places: Vec<(u32, u32)>,
}

impl Partials {
    /// What is known of the pixel at a place of the band (counted from its top left).
    pub fn get(&self, place: u32) -> Option<Part<'_>> {
        let found = self.places.binary_search_by_key(&place, |(at, _)| *at);
        let (_, record) = self.places.get(found.ok()?)?;
        let words = self.words.chunks_exact(self.stride).nth(*record as usize)?;
        let (head, summed) = words.split_at_checked(RECORD_HEAD as usize)?;
        let three = |first: u32| [0, 1, 2].map(|i| f32::from_bits(head[(first + i) as usize]));
        Some(Part {
            sum: three(LISTED_WORDS),
            error: three(LISTED_WORDS + 3),
            summed,
        })
    }

    /// Adds what is known of the pixel at a place, which comes behind all others.
    pub fn push(&mut self, place: u32, part: &Part<'_>) {
        self.places.push((place, self.places.len() as u32));
        self.stride = RECORD_HEAD as usize + part.summed.len();
        // Nobody looks at what became of it in f64.
        self.words.extend([place, 0]);
        let numbers = part.sum.iter().chain(&part.error);
        self.words.extend(numbers.map(|number| number.to_bits()));
        self.words.extend(part.summed);
    }

    /// How many words all that takes.
    pub fn words(&self) -> usize {
        self.words.len()
    }

    /// Adds the records that a dispatch left for its rectangle of a band of this width, of `stride` words each.
    pub(super) fn take(
        &mut self,
        rectangle: &Rectangle,
        width: u32,
        stride: u32,
        [counter, records]: [&[u8]; 2],
    ) {
        let words = |bytes: &'_ [u8]| -> Vec<u32> {
            let words = bytes.as_chunks().0.iter();
            words.map(|word| u32::from_le_bytes(*word)).collect()
        };
        let [count, _] = words(counter)[..] else {
            return;
        };
        self.stride = stride as usize;
        let before = self.words.len();
        // The counter may exceed the room that there was; then the list ends where the room does.
        let wanted = (count as usize).saturating_mul(4 * self.stride);
        self.words
            .extend(words(&records[..wanted.min(records.len())]));
        #[cfg(test)]
        tests::spoil(&mut self.words[before..], self.stride);
        let columns = rectangle.columns.end - rectangle.columns.start;
        for (i, record) in self.words[before..].chunks_exact(self.stride).enumerate() {
            let (row, column) = (record[0] / columns, record[0] % columns);
            // Of some nothing is known: they are listed for f64.
            let is_part = record[RECORD_HEAD as usize..].iter().any(|bits| *bits != 0);
            if is_part && u64::from(record[0]) < rectangle.pixels() {
                let place = row * width + rectangle.columns.start + column;
                self.places.push((place, (before / self.stride + i) as u32));
            }
        }
    }

    /// Puts the records in order.
    pub(super) fn finish(&mut self) {
        self.places.sort_unstable();
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::shader::form::Pixels;

    /// What may be wrong with every record.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub(crate) enum Fault {
        /// A doubtful sample counts as if it were in the sum.
        Bit,
        /// The red of the sum is off by a byte.
        Sum,
    }

    thread_local! {
        static ROOM: Cell<Option<u32>> = const { Cell::new(None) };
        static FAULT: Cell<Option<Fault>> = const { Cell::new(None) };
    }

    /// Lets no dispatch of this thread have room for more records.
    pub(crate) fn leave_room_for(records: Option<u32>) {
        ROOM.set(records);
    }

    /// Makes another thread get wrong what this one does.
    pub(crate) fn carry() -> Box<dyn FnOnce() + Send> {
        let (room, fault) = (ROOM.get(), FAULT.get());
        Box::new(move || {
            ROOM.set(room);
            FAULT.set(fault);
        })
    }

    /// Spoils the records that this thread gets.
    pub(crate) fn spoil_records(fault: Option<Fault>) {
        FAULT.set(fault);
    }

    pub(super) fn allowed(room: u32) -> u32 {
        ROOM.get().map_or(room, |least| least.min(room))
    }

    pub(super) fn spoil(words: &mut [u32], stride: usize) {
        for record in words.chunks_exact_mut(stride.max(1)) {
            match FAULT.get() {
                None => {}
                Some(Fault::Bit) => {
                    let bits = &mut record[RECORD_HEAD as usize];
                    *bits |= bits.wrapping_add(1);
                }
                Some(Fault::Sum) => {
                    let sum = &mut record[LISTED_WORDS as usize];
                    *sum = (f32::from_bits(*sum) + 1.0).to_bits();
                }
            }
        }
    }

    /// Of a shader that makes a pixel an invocation.
    pub(in crate::gpu::bands) fn form(pixels: Pixels, record_words: u32) -> Form {
        Form {
            pixels,
            across: 1,
            offsets: 0,
            record_words,
            listed: false,
        }
    }

    #[test]
    fn half_of_the_pixels_have_room_and_the_list_is_bounded() {
        assert_eq!(room(1, 2, 8), 1);
        assert_eq!(room(300, 2, 8), 256);
        assert_eq!(room(4000, 2, 8), 2000);
        assert_eq!(u64::from(room(2 << 20, 2, 8)) * 32, MAX_BYTES);
        for words in [8, 39] {
            for pixels in [Pixels::Packed, Pixels::Words] {
                let layout = Layout::new(&form(pixels, words), 2 << 20);
                assert!(layout.bytes <= layout.pixels + MOST);
            }
        }
        assert_eq!(Layout::new(&form(Pixels::Values, 0), 10).bytes, 160);
    }

    /// Two rectangles side by side, records in any order, one list too long for its room, one place that is none.
    #[test]
    fn records_are_found_at_their_places() {
        let record = |place: u32, sum: f32, bits: [u32; 2]| {
            let mut words = [sum.to_bits(); 10];
            [words[0], words[1], words[8], words[9]] = [place, 0xff00_0000, bits[0], bits[1]];
            words
        };
        let bytes =
            |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|w| w.to_le_bytes()).collect() };
        let mut rectangle = Rectangle {
            band: 10..12,
            columns: 0..3,
            last: false,
        };
        let mut partials = Partials::default();
        let left = [record(4, 1.5, [5, 1]), record(2, 2.5, [1, 2]), [9; 10]];
        partials.take(
            &rectangle,
            5,
            10,
            [&bytes(&[2, 1]), &bytes(left.as_flattened())],
        );
        rectangle.columns = 3..5;
        // One that is listed for f64 alone, and one at no place.
        let right = [
            record(3, 3.5, [3, 4]),
            record(0, 5.5, [0, 0]),
            record(4, 4.5, [3, 4]),
        ];
        partials.take(
            &rectangle,
            5,
            10,
            [&bytes(&[7, 1]), &bytes(right.as_flattened())],
        );
        partials.finish();
        let places: Vec<u32> = partials.places.iter().map(|(place, _)| *place).collect();
        assert_eq!(places, [2, 6, 9]);
        for (place, sum, bits) in [(2, 2.5, [1, 2]), (6, 1.5, [5, 1]), (9, 3.5, [3, 4])] {
            let part = partials.get(place).unwrap();
            assert_eq!((part.sum, part.error), ([sum; 3], [sum; 3]));
            assert_eq!(part.summed, bits);
        }
        let part = partials.get(6).unwrap();
        let held: Vec<u32> = (0..70).filter(|sample| part.holds(*sample)).collect();
        assert_eq!((held, part.samples()), (vec![0, 2, 32], 3));
        assert_eq!(partials.get(3), None);
        assert_eq!(Partials::default().get(0), None);
    }
}

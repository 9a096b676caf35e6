//! The layout of a part's file, and what its header says.
//!
//! ```text
//! header   magic, version, rules, identity, width, the picture's rows, number, parts, the part's rows, values?, texts
//! chunks   some rows each, from the top: their bytes (r, g, b), then their values (three f32 each) if there are any
//! footer   presumed pixels; a hash of each chunk; a hash of header and footer
//! ```
//!
//! All numbers are little endian. The header tells how long the file is, to the byte: what is not so long is not read.

use std::ops::Range;

use super::identity::{Identity, RULES};

/// What a part's file begins with.
const MAGIC: [u8; 8] = *b"plumb\0pt";
/// The version of this layout.
const VERSION: u32 = 1;
/// Bytes of a header without its texts.
pub(super) const FIXED: usize = 92;
/// Bytes of a hash.
pub(super) const HASH: usize = 32;
/// About so many bytes are hashed together, and held in memory together: as many rows as fit, one at least.
const CHUNK: u64 = 1 << 20;
/// More bytes of texts than any scene's picture has.
const MOST_TEXTS: u32 = 1 << 20;
/// The most pixels a side, as pictures have.
const MOST_SIDE: u32 = crate::scene::MAX_PIXELDIM;

/// What a part says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    /// What it is a part of.
    pub identity: Identity,
    /// Columns.
    pub width: u32,
    /// The rows of the whole picture, counted from the bottom.
    pub picture: Range<u32>,
    /// Which part it is, from 1 at the top.
    pub number: u32,
    /// How many there are.
    pub parts: u32,
    /// Its rows, counted from the bottom.
    pub rows: Range<u32>,
    /// Whether the values before quantising are there too.
    pub values: bool,
    /// What a picture's file tells of how it was made, but for the program's name: keys and texts.
    pub texts: Vec<(String, String)>,
}

/// Where what is in a part's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    width: u32,
    rows: u32,
    values: bool,
    /// Bytes of the header.
    header: u64,
}

impl Layout {
    /// Bytes of a row.
    fn row(self) -> u64 {
        u64::from(self.width) * if self.values { 3 + 12 } else { 3 }
    }

    /// Rows of a chunk.
    pub fn chunk_rows(self) -> u32 {
        (CHUNK / self.row()).clamp(1, u64::from(u32::MAX)) as u32
    }

    /// How many chunks there are.
    pub(super) fn chunks(self) -> u32 {
        self.rows.div_ceil(self.chunk_rows())
    }

    /// Rows of a chunk, counted from the top of the part.
    pub(super) fn rows_of(self, chunk: u32) -> Range<u32> {
        let start = u64::from(chunk) * u64::from(self.chunk_rows());
        let end = start + u64::from(self.chunk_rows());
        let row = |row: u64| row.min(u64::from(self.rows)) as u32;
        row(start)..row(end)
    }

    /// Bytes of a chunk, counted from the start of the file.
    pub(super) fn bytes_of(self, chunk: u32) -> Range<u64> {
        let Range { start, end } = self.rows_of(chunk);
        let at = |row: u32| self.header + u64::from(row) * self.row();
        at(start)..at(end)
    }

    /// Where the footer begins.
    pub(super) fn footer(self) -> u64 {
        self.header + u64::from(self.rows) * self.row()
    }

    /// Bytes of the footer.
    pub(super) fn footer_length(self) -> u64 {
        8 + (u64::from(self.chunks()) + 1) * HASH as u64
    }

    /// Bytes of the whole file.
    pub fn length(self) -> u64 {
        self.footer() + self.footer_length()
    }
}

/// What is wrong with a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Malformed {
    /// It is no part at all.
    Magic,
    /// It is a part of another version of plumb; how.
    Version(String),
    /// Its numbers cannot be; which.
    Numbers(&'static str),
}

impl Header {
    /// As it stands in the file.
    pub(super) fn encode(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        let mut number = |number: u32| bytes.extend(number.to_le_bytes());
        number(VERSION);
        number(RULES);
        bytes.extend(self.identity.0);
        let mut texts = Vec::new();
        for text in self.texts.iter().flat_map(|(key, text)| [key, text]) {
            texts.extend((text.len() as u32).to_le_bytes());
            texts.extend(text.as_bytes());
        }
        for number in [
            self.width,
            self.picture.start,
            self.picture.end,
            self.number,
            self.parts,
            self.rows.start,
            self.rows.end,
            u32::from(self.values),
            0,
            0,
            texts.len() as u32,
        ] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(texts);
        bytes
    }

    /// Reads the part of a header that has a fixed length; returns how many bytes of texts follow.
    pub(super) fn decode(bytes: &[u8; FIXED]) -> Result<(Self, u32), Malformed> {
        let number = |at: usize| {
            let mut four = [0; 4];
            four.copy_from_slice(&bytes[at..at + 4]);
            u32::from_le_bytes(four)
        };
        if bytes[..8] != MAGIC {
            return Err(Malformed::Magic);
        }
        if number(8) != VERSION {
            let what = format!("its file has layout {}, not {VERSION}", number(8));
            return Err(Malformed::Version(what));
        }
        if number(12) != RULES {
            let what = format!(
                "it was made by version {} of the rules, not {RULES}",
                number(12)
            );
            return Err(Malformed::Version(what));
        }
        let mut identity = [0; HASH];
        identity.copy_from_slice(&bytes[16..48]);
        let header = Self {
            identity: Identity(identity),
            width: number(48),
            picture: number(52)..number(56),
            number: number(60),
            parts: number(64),
            rows: number(68)..number(72),
            values: number(76) == 1,
            texts: Vec::new(),
        };
        let texts = number(88);
        let Self {
            picture,
            rows,
            parts,
            ..
        } = &header;
        let wrong = if header.width == 0 || header.width > MOST_SIDE || picture.end > MOST_SIDE {
            "its picture's size"
        } else if picture.is_empty()
            || rows.is_empty()
            || rows.start < picture.start
            || rows.end > picture.end
        {
            "its rows"
        } else if header.number == 0 || header.number > *parts || *parts > picture.len() as u32 {
            "its number"
        } else if number(76) > 1 || number(80) != 0 || number(84) != 0 || texts > MOST_TEXTS {
            "what follows its rows"
        } else {
            return Ok((header, texts));
        };
        Err(Malformed::Numbers(wrong))
    }

    /// Reads the texts.
    pub(super) fn decode_texts(bytes: &[u8]) -> Option<Vec<(String, String)>> {
        let mut rest = bytes;
        let mut text = || -> Option<String> {
            let (length, behind) = rest.split_first_chunk::<4>()?;
            let (text, behind) = behind.split_at_checked(u32::from_le_bytes(*length) as usize)?;
            rest = behind;
            String::from_utf8(text.to_vec()).ok()
        };
        let mut texts = Vec::new();
        let mut left = bytes.len();
        while left > 0 {
            let (key, value) = (text()?, text()?);
            left = left.checked_sub(8 + key.len() + value.len())?;
            texts.push((key, value));
        }
        Some(texts)
    }

    /// Where what is in the file of this part.
    pub fn layout(&self) -> Layout {
        let texts = |(key, text): &(String, String)| 8 + key.len() + text.len();
        let texts: usize = self.texts.iter().map(texts).sum();
        self.layout_with(texts as u32)
    }

    /// The same, where so many bytes of texts are still to be read.
    pub(super) fn layout_with(&self, texts: u32) -> Layout {
        Layout {
            width: self.width,
            rows: self.rows.len() as u32,
            values: self.values,
            header: FIXED as u64 + u64::from(texts),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header() -> Header {
        let text = |key: &str, text: &str| (key.to_owned(), text.to_owned());
        Header {
            identity: Identity([7; 32]),
            width: 640,
            picture: 10..490,
            number: 3,
            parts: 16,
            rows: 400..430,
            values: true,
            texts: vec![text("plumb:scene", "wände.txt"), text("plumb:note", "")],
        }
    }

    fn decode(bytes: &[u8]) -> Result<Header, Malformed> {
        let (fixed, rest) = bytes.split_first_chunk::<FIXED>().unwrap();
        let (header, texts) = Header::decode(fixed)?;
        assert_eq!(rest.len(), texts as usize);
        let texts = Header::decode_texts(rest).ok_or(Malformed::Numbers("texts"))?;
        Ok(Header { texts, ..header })
    }

    #[test]
    fn what_is_written_is_read() {
        for values in [false, true] {
            let header = Header { values, ..header() };
            let bytes = header.encode();
            assert_eq!(decode(&bytes), Ok(header.clone()));
            let layout = header.layout();
            assert_eq!(layout.header, bytes.len() as u64);
            assert_eq!(layout.bytes_of(0).start, layout.header);
            let last = layout.chunks() - 1;
            assert_eq!(layout.bytes_of(last).end, layout.footer());
            assert_eq!(layout.rows_of(last).end, 30);
            assert!(layout.rows_of(last + 1).is_empty());
        }
    }

    #[test]
    fn numbers_that_cannot_be_are_refused() {
        let good = header().encode();
        for (at, number) in [
            (0, 0),
            (8, 2),
            (12, RULES + 1),
            (48, 0),
            (48, u32::MAX),
            (52, 490),
            (56, u32::MAX),
            (60, 0),
            (60, 17),
            (64, 2),
            (64, u32::MAX),
            (68, 9),
            (68, 430),
            (72, 491),
            (76, 2),
            (80, 1),
            (84, 1),
            (88, u32::MAX),
            // Lengths of texts: longer than what there is.
            (FIXED, 1 << 30),
            (FIXED, 10),
        ] {
            let mut bytes = good.clone();
            bytes[at..at + 4].copy_from_slice(&u32::to_le_bytes(number));
            assert!(decode(&bytes).is_err(), "{number} at {at}");
        }
        let mut text = good.clone();
        text[FIXED + 4] = 0xFF;
        assert!(decode(&text).is_err(), "no UTF-8");
    }

    /// A chunk is a row at least, however long that is.
    #[test]
    fn chunks_are_whole_rows() {
        for (width, rows) in [(1, 1 << 20), (640, 546), (1_000_000, 1)] {
            let header = Header {
                width,
                values: false,
                ..header()
            };
            let chunk = header.layout().chunk_rows();
            assert_eq!(
                chunk,
                if width == 1 { (1 << 20) / 3 } else { rows },
                "{width}"
            );
        }
    }
}

//! PNG, as the rows come: 8 bits a channel, RGB, the metadata in text chunks.
//!
//! Below `output`. The picture's hash is known only after its last row, so it stands in a text chunk behind the image
//! data, which the format allows.
//!
//! The rows are compressed in strips, each for itself, on all cores: a strip ends with an empty block at a whole byte, so
//! that what follows it can be put behind it, and all strips together are one stream as the format wants it. Where a
//! strip ends follows from the picture's width alone, so neither the number of threads nor how rows come changes a byte.

use std::io::{self, Write};
use std::mem;
use std::sync::{Arc, Mutex, PoisonError};

use ::png::text_metadata::{EncodableTextChunk, ITXtChunk, TEXtChunk};
use ::png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent, Writer, chunk};
use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;

use crate::cores;

/// About how many bytes of pixels a strip has: matches are not looked for beyond its beginning, which costs 1 % of the
/// size, and a 4K picture has strips for a hundred cores.
const STRIP: usize = 1 << 18;

/// Bytes of pixels that are gathered at most, unless a single strip has more.
const GATHERED: usize = 1 << 24;

/// Bytes a pixel.
const PIXEL: usize = 3;

/// The number of Paeth's filter, which stands before each row.
const PAETH: u8 = 4;

/// How a stream of zlib begins that was made for speed: deflate, 32 KiB, no dictionary.
const ZLIB: [u8; 2] = [0x78, 0x01];

/// A PNG being written.
pub(super) struct Png {
    writer: Writer<Gathered>,
    gathered: Gathered,
    /// Bytes a row, and those of a strip.
    row: usize,
    strip: usize,
    /// Bytes that are gathered before they are compressed together.
    together: usize,
    /// Bytes of pixels to come.
    left: u64,
    /// The row above those of `rows`: black at first.
    above: Vec<u8>,
    rows: Vec<u8>,
    /// The checksum of what is compressed, filter bytes included; none before the first strip.
    sum: Option<u32>,
}

/// What the encoder has written and we have not. The library's writer owns what it writes to and ends the file by
/// itself; this stands between, so that errors are ours to tell and nothing is ended that is not whole.
#[derive(Clone, Default)]
struct Gathered(Arc<Mutex<Vec<u8>>>);

impl Gathered {
    fn take(&self) -> Vec<u8> {
        mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for Gathered {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A strip that was compressed, with the checksum of what it was made from and the length of that.
struct Strip {
    deflated: Vec<u8>,
    sum: u32,
    length: usize,
}

impl Png {
    /// Starts a PNG of `width` × `height` pixels (both at least 1 and below 2³¹) with these texts.
    ///
    /// Deflate's first level behind the Paeth filter: measured 0.8 to 2 GB/s on one core, and a twelfth to a fiftieth
    /// of the size, on pictures of ours. Choosing the filter row by row is a sixth slower and gains less than 1 %. The
    /// second level takes twice as long for three quarters of the size. The encoder made for PNG is half as fast again,
    /// but its files are a fifth to a half larger, and where it meets noise, which jitter is, larger than the picture.
    pub(super) fn new(width: u32, height: u32, texts: &[(String, String)]) -> io::Result<Self> {
        let gathered = Gathered::default();
        let mut encoder = Encoder::new(gathered.clone(), width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        // What programs take bytes without a word about their colours for, and what they are meant as; said, since some
        // take them for what their own screen shows.
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        let writer = encoder.write_header()?;
        for (key, text) in texts {
            write_text(key, text, &mut gathered.clone())?;
        }
        let row = PIXEL * width as usize;
        let strip = row * (STRIP / row).max(1);
        Ok(Self {
            writer,
            gathered,
            row,
            strip,
            together: strip,
            left: row as u64 * u64::from(height),
            above: vec![0; row],
            rows: Vec::new(),
            sum: None,
        })
    }

    /// Takes whole rows, the top one first.
    pub(super) fn write(&mut self, mut rgb: &[u8], to: &mut impl Write) -> io::Result<()> {
        if self.sum.is_none() && self.rows.is_empty() && cores::are_several() {
            // Two strips a core, since some take longer than others.
            let strips = (2 * rayon::current_num_threads()).min(GATHERED / self.strip);
            self.together = self.strip * strips.max(1);
        }
        while !rgb.is_empty() {
            let (now, later) = rgb.split_at(rgb.len().min(self.together - self.rows.len()));
            self.rows.extend_from_slice(now);
            self.left -= now.len() as u64;
            rgb = later;
            if self.rows.len() == self.together || self.left == 0 {
                self.compress()?;
                to.write_all(&self.gathered.take())?;
            }
        }
        Ok(())
    }

    /// Compresses the rows that are gathered, and writes a chunk for each strip of them.
    fn compress(&mut self) -> io::Result<()> {
        let count = self.rows.len().div_ceil(self.strip);
        let last = (self.left == 0).then(|| count - 1);
        let strip = |index: usize| {
            let start = index * self.strip;
            let end = self.rows.len().min(start + self.strip);
            let above = match start {
                0 => &self.above,
                _ => &self.rows[start - self.row..start],
            };
            let filtered = filter(above, &self.rows[start..end]);
            Ok::<_, io::Error>(Strip {
                deflated: deflate(&filtered, Some(index) == last)?,
                sum: simd_adler32::adler32(&filtered.as_slice()),
                length: filtered.len(),
            })
        };
        let strips: io::Result<Vec<_>> = if count > 1 && cores::are_several() {
            (0..count).into_par_iter().map(strip).collect()
        } else {
            (0..count).map(strip).collect()
        };
        for (index, strip) in strips?.into_iter().enumerate() {
            let mut data = Vec::with_capacity(strip.deflated.len() + 8);
            let sum = match self.sum {
                None => {
                    data.extend_from_slice(&ZLIB);
                    strip.sum
                }
                Some(sum) => joined(sum, strip.sum, strip.length),
            };
            self.sum = Some(sum);
            data.extend_from_slice(&strip.deflated);
            if Some(index) == last {
                data.extend_from_slice(&sum.to_be_bytes());
            }
            self.writer.write_chunk(chunk::IDAT, &data)?;
        }
        let last_row = self.rows.len() - self.row;
        self.above.copy_from_slice(&self.rows[last_row..]);
        self.rows.clear();
        Ok(())
    }

    /// Ends the picture, with one more text.
    pub(super) fn finish(self, key: &str, text: &str, to: &mut impl Write) -> io::Result<()> {
        write_text(key, text, &mut self.gathered.clone())?;
        self.writer.finish()?;
        to.write_all(&self.gathered.take())
    }
}

/// Rows behind Paeth's filter, each with the number of the filter before it; `above` is the row above the first.
fn filter<'a>(mut above: &'a [u8], rows: &'a [u8]) -> Vec<u8> {
    let row = above.len();
    let mut filtered = Vec::with_capacity(rows.len() + rows.len() / row);
    for row in rows.chunks_exact(row) {
        filtered.push(PAETH);
        // Left of the first pixel all is 0, and the one above is always as near.
        filtered.extend(
            row.iter()
                .zip(above)
                .take(PIXEL)
                .map(|(x, b)| x.wrapping_sub(*b)),
        );
        let left = row.iter().zip(above);
        let here = row.iter().zip(above).skip(PIXEL);
        filtered.extend(
            left.zip(here)
                .map(|((a, c), (x, b))| x.wrapping_sub(paeth(*a, *b, *c))),
        );
        above = row;
    }
    filtered
}

/// Of left, above and above left the one that is nearest to a + b − c; of equally near ones the first.
fn paeth(a: u8, b: u8, c: u8) -> u8 {
    let [x, y, z] = [a, b, c].map(i16::from);
    let (from_a, from_b, from_c) = ((y - z).abs(), (x - z).abs(), (x + y - 2 * z).abs());
    if from_a <= from_b && from_a <= from_c {
        a
    } else if from_b <= from_c {
        b
    } else {
        c
    }
}

/// The bytes compressed: the end of the stream if they are the last ones, else up to a whole byte.
fn deflate(bytes: &[u8], last: bool) -> io::Result<Vec<u8>> {
    let mut compress = Compress::new(Compression::fast(), false);
    let flush = if last {
        FlushCompress::Finish
    } else {
        FlushCompress::Sync
    };
    let mut deflated = Vec::with_capacity(bytes.len() / 8 + 1024);
    loop {
        let taken = compress.total_in() as usize;
        let status = compress
            .compress_vec(&bytes[taken..], &mut deflated, flush)
            .map_err(io::Error::other)?;
        // Where there is room left, all that was to come has come.
        let is_all =
            compress.total_in() as usize == bytes.len() && deflated.len() < deflated.capacity();
        if if last {
            status == Status::StreamEnd
        } else {
            is_all
        } {
            return Ok(deflated);
        }
        deflated.reserve(deflated.capacity());
    }
}

/// The Adler-32 of two texts, one behind the other, from theirs and the length of the second.
fn joined(first: u32, second: u32, length: usize) -> u32 {
    const PRIME: u64 = 65_521;
    let halves = |sum: u32| (u64::from(sum & 0xFFFF), u64::from(sum >> 16));
    let ((a1, b1), (a2, b2)) = (halves(first), halves(second));
    // a is 1 and the bytes; b the sum of all values that a had, to each of which the first text adds a1 − 1.
    let before = a1 + PRIME - 1;
    let a = (before + a2) % PRIME;
    let b = (b1 + b2 + length as u64 % PRIME * before) % PRIME;
    (b as u32) << 16 | a as u32
}

/// A text chunk: the plain one if it can hold the text, which is Latin-1, else the one for UTF-8.
fn write_text(key: &str, text: &str, to: &mut impl Write) -> io::Result<()> {
    let plain = |c: char| matches!(c, '\n' | ' '..='~' | '\u{A0}'..='\u{FF}');
    if text.chars().all(plain) {
        TEXtChunk::new(key, text).encode(to)?;
    } else {
        ITXtChunk::new(key, text).encode(to)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;

//! EXR: the values before quantising, 32-bit floats, in scan lines, the metadata as attributes.
//!
//! Below `output`. Blocks of scan lines are compressed, on all cores, and written as the rows come, so that memory does
//! not grow with the picture's height. What is known only at the end (where each block is, the picture's hash) has its
//! place at the start of the file, and is written there then.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Cursor, Read, Seek, SeekFrom, Write};

use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::meta::{BlockDescription, MetaData, magic_number};
use ::exr::prelude::Compression;
use rayon::prelude::*;

use super::sink::Sink;
use crate::cores;

/// Rows of a block, as ZIP16 has them.
const BLOCK: usize = 16;
/// The most bytes of a block, which the format counts in 32 bits.
const BLOCK_BYTES: u32 = i32::MAX as u32;
/// The most columns that a block's bytes leave room for: 16 rows of three floats each.
pub(super) const MAX_WIDTH: u32 = BLOCK_BYTES / (BLOCK as u32 * 12);
/// The most rows, which the format counts in 32 bits.
pub(super) const MAX_ROWS: u32 = i32::MAX as u32;
/// About so many pixels are compressed together, 12 MB of them: as many blocks as fit, one at least.
const GATHERED: usize = 1 << 20;

/// An EXR picture on its way.
pub(super) struct Exr {
    header: Header,
    /// The attribute that holds the picture's hash.
    hash: Text,
    /// Values of rows that have come, and are not compressed yet.
    waiting: Vec<[f32; 3]>,
    /// Where each block is that was written.
    places: Vec<u64>,
    /// Bytes written.
    length: u64,
    /// Where the file is put together whose start cannot be written later: a pipe's, a device's.
    aside: Option<BufWriter<File>>,
}

impl Exr {
    /// For a picture of this size, at most [`MAX_WIDTH`] × [`MAX_ROWS`], with these attributes; `hash` is the key of
    /// its hash.
    pub(super) fn new(width: u32, rows: u32, entries: &[(String, String)], hash: &str) -> Self {
        let text = |text: &str| Text::from_slice_unchecked(text.as_bytes());
        let mut layer = LayerAttributes::default();
        for (key, told) in entries {
            layer
                .other
                .insert(text(key), AttributeValue::Text(text(told)));
        }
        let channel = |name| ChannelDescription::named(name, SampleType::F32);
        let channels = ["B", "G", "R"].map(channel).into_iter().collect();
        // Every reader knows this encoding. The order of lines is fixed, so that the same picture is the same file.
        let header = Header::new(text(""), (width as usize, rows as usize), channels)
            .with_encoding(
                Compression::ZIP16,
                BlockDescription::ScanLines,
                LineOrder::Increasing,
            )
            .with_attributes(layer);
        Self {
            header,
            hash: text(hash),
            waiting: Vec::new(),
            places: Vec::new(),
            length: 0,
            aside: None,
        }
    }

    /// Takes whole rows, the top one first.
    pub(super) fn write(&mut self, values: &[[f32; 3]], to: &mut Sink) -> io::Result<()> {
        if self.length == 0 {
            if !to.is_beside() {
                self.aside = Some(BufWriter::new(tempfile::tempfile()?));
            }
            // As long as it will be, whatever the hash is, and nothing in the table.
            let start = self.start(&"0".repeat(64))?;
            self.put(&start, to)?;
        }
        self.waiting.extend_from_slice(values);
        let Vec2(width, height) = self.header.layer_size;
        let is_last = self.places.len() * BLOCK + self.waiting.len() / width == height;
        if is_last || self.waiting.len() >= (BLOCK * width).max(GATHERED) {
            self.compress(is_last, to)?;
        }
        Ok(())
    }

    /// Compresses and writes the blocks that are whole; the last one is, whatever its height.
    fn compress(&mut self, all: bool, to: &mut Sink) -> io::Result<()> {
        let size = BLOCK * self.header.layer_size.0;
        let waiting = std::mem::take(&mut self.waiting);
        let whole = if all {
            waiting.len()
        } else {
            waiting.len() / size * size
        };
        let first = self.places.len();
        let block = |(index, values): (usize, &[[f32; 3]])| self.block(first + index, values);
        let blocks = waiting[..whole].chunks(size);
        let blocks: Vec<io::Result<Vec<u8>>> = if cores::are_several() {
            let blocks: Vec<_> = blocks.enumerate().collect();
            blocks.into_par_iter().map(block).collect()
        } else {
            blocks.enumerate().map(block).collect()
        };
        for bytes in blocks {
            self.places.push(self.length);
            self.put(&bytes?, to)?;
        }
        self.waiting = waiting;
        self.waiting.drain(..whole);
        Ok(())
    }

    /// The bytes of a block in the file.
    fn block(&self, number: usize, values: &[[f32; 3]]) -> io::Result<Vec<u8>> {
        let width = self.header.layer_size.0;
        let mut data = Vec::with_capacity(size_of_val(values));
        for row in values.chunks(width) {
            // Channels in the order of their names.
            for channel in [2, 1, 0] {
                data.extend(row.iter().flat_map(|value| value[channel].to_ne_bytes()));
            }
        }
        let index = BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, number * BLOCK),
            pixel_size: Vec2(width, values.len() / width),
            level: Vec2(0, 0),
        };
        let headers = std::slice::from_ref(&self.header);
        let chunk = UncompressedBlock { index, data }.compress_to_chunk(headers);
        let mut bytes = Vec::new();
        chunk
            .and_then(|chunk| chunk.write(&mut bytes, headers.len()))
            .map_err(into_io)?;
        Ok(bytes)
    }

    /// Writes on.
    fn put(&mut self, bytes: &[u8], to: &mut Sink) -> io::Result<()> {
        self.length += bytes.len() as u64;
        match &mut self.aside {
            Some(aside) => aside.write_all(bytes),
            None => to.write_all(bytes),
        }
    }

    /// What the file begins with: the header, and where each block is.
    fn start(&mut self, hash: &str) -> io::Result<Vec<u8>> {
        let told = AttributeValue::Text(Text::from_slice_unchecked(hash.as_bytes()));
        let attributes = &mut self.header.own_attributes.other;
        attributes.insert(self.hash.clone(), told);
        let headers = std::slice::from_ref(&self.header);
        let mut bytes = Cursor::new(Vec::new());
        MetaData::validate(headers, true)
            .and_then(|requirements| {
                magic_number::write(&mut bytes)?;
                requirements.write(&mut bytes)?;
                Header::write_all(headers, &mut bytes, requirements.has_multiple_layers)
            })
            .map_err(into_io)?;
        sort_attributes(&mut bytes)?;
        let mut bytes = bytes.into_inner();
        let places = self.places.iter().copied().chain(std::iter::repeat(0));
        bytes.extend(
            places
                .take(self.header.chunk_count)
                .flat_map(u64::to_le_bytes),
        );
        Ok(bytes)
    }

    /// All rows have come: writes what is known now. Returns the number of bytes of the file.
    pub(super) fn finish(mut self, hash: &str, to: &mut Sink) -> io::Result<u64> {
        let start = self.start(hash)?;
        if let Some(mut aside) = self.aside {
            write_start(&mut aside, &start)?;
            let mut file = aside.into_inner().map_err(io::IntoInnerError::into_error)?;
            file.seek(SeekFrom::Start(0))?;
            io::copy(&mut file, to)?;
        } else {
            write_start(to.seekable(), &start)?;
        }
        Ok(self.length)
    }
}

/// Writes over the start of a file.
fn write_start(file: &mut (impl Write + Seek), start: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    file.write_all(start)?;
    file.flush()
}

fn into_io(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// Puts the attributes of the header in the order of their names, in place. The library keeps them in a hash map, so
/// that otherwise the same picture would be another file every time.
fn sort_attributes(file: &mut (impl Read + Write + Seek)) -> io::Result<()> {
    // Behind the magic number and the version.
    const START: u64 = 8;
    file.seek(SeekFrom::Start(START))?;
    let mut from = BufReader::new(&mut *file);
    let mut attributes = Vec::new();
    loop {
        // Each one is a name and a type, both ended by a zero, a length, and that many bytes; an empty name ends all.
        let mut attribute = Vec::new();
        if read_name(&mut from, &mut attribute)? == 0 {
            break;
        }
        read_name(&mut from, &mut attribute)?;
        let mut length = [0; 4];
        from.read_exact(&mut length)?;
        attribute.extend_from_slice(&length);
        let length = u64::from(u32::from_le_bytes(length));
        if (&mut from).take(length).read_to_end(&mut attribute)? as u64 != length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        attributes.push(attribute);
    }
    drop(from);
    // The names come first, and no two are the same.
    attributes.sort();
    file.seek(SeekFrom::Start(START))?;
    file.write_all(&attributes.concat())
}

/// Appends a text with the zero that ends it; returns its length without.
fn read_name(from: &mut impl Read, to: &mut Vec<u8>) -> io::Result<usize> {
    let start = to.len();
    loop {
        let mut byte = [0];
        from.read_exact(&mut byte)?;
        to.push(byte[0]);
        if byte[0] == 0 {
            return Ok(to.len() - start - 1);
        }
    }
}

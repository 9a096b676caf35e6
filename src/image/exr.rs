//! EXR: the values before quantising, 32-bit floats, in scan lines, the metadata as attributes.
//!
//! Below `output`. Unlike PPM and PNG the picture is held in memory until it is whole, because the library takes it as
//! a whole; hence [`MAX_PIXELS`].

use std::collections::TryReserveError;
use std::io::{self, BufReader, BufWriter, Cursor, Read, Seek, SeekFrom, Write};

use ::exr::image::Blocks;
use ::exr::image::{Encoding, Image, Layer, SpecificChannels, write::WritableImage};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{AttributeValue, LineOrder, Text};
use ::exr::meta::header::LayerAttributes;
use ::exr::prelude::Compression;

use super::sink::Sink;

/// The most pixels an EXR picture may have: 1.2 GB of values.
pub const MAX_PIXELS: u64 = 100_000_000;

/// An EXR picture being gathered.
pub(super) struct Exr {
    width: usize,
    height: usize,
    values: Vec<[f32; 3]>,
}

impl Exr {
    /// Takes the memory for `width` × `height` pixels, at most [`MAX_PIXELS`].
    pub(super) fn new(width: u32, height: u32) -> Result<Self, TryReserveError> {
        let (width, height) = (width as usize, height as usize);
        let mut values = Vec::new();
        values.try_reserve_exact(width * height)?;
        Ok(Self {
            width,
            height,
            values,
        })
    }

    /// Takes whole rows, the top one first.
    pub(super) fn write(&mut self, values: &[[f32; 3]]) {
        self.values.extend_from_slice(values);
    }

    /// Encodes the picture with these attributes. Returns the number of bytes of the file.
    pub(super) fn finish(self, attributes: &[(String, String)], to: &mut Sink) -> io::Result<u64> {
        if let Some(file) = to.seekable() {
            self.encode(attributes, file)
        } else {
            let mut bytes = Cursor::new(Vec::new());
            let length = self.encode(attributes, &mut bytes)?;
            to.write_all(bytes.get_ref())?;
            Ok(length)
        }
    }

    fn encode(
        self,
        attributes: &[(String, String)],
        to: &mut (impl Read + Write + Seek),
    ) -> io::Result<u64> {
        let mut layer = LayerAttributes::default();
        for (key, text) in attributes {
            let text = AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes()));
            layer
                .other
                .insert(Text::from_slice_unchecked(key.as_bytes()), text);
        }
        let Self {
            width,
            height,
            values,
        } = self;
        let pixel = |Vec2(x, y): Vec2<usize>| {
            let [r, g, b] = values[y * width + x];
            (r, g, b)
        };
        // Every reader knows this encoding. The order of lines is fixed, so that the same picture is the same file.
        let encoding = Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        };
        let image = Image::from_layer(Layer::new(
            (width, height),
            layer,
            encoding,
            SpecificChannels::rgb(pixel),
        ));
        let mut buffered = BufWriter::with_capacity(1 << 20, &mut *to);
        image.write().to_buffered(&mut buffered).map_err(into_io)?;
        buffered.flush()?;
        drop(buffered);
        sort_attributes(to)?;
        to.seek(SeekFrom::End(0))
    }
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

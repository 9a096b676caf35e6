//! PNG, as the rows come: 8 bits a channel, RGB, the metadata in text chunks.
//!
//! Below `output`. The picture's hash is known only after its last row, so it stands in a text chunk behind the image
//! data, which the format allows.

use std::io::{self, Write};
use std::mem;
use std::sync::{Arc, Mutex, PoisonError};

use ::png::text_metadata::{EncodableTextChunk, ITXtChunk, TEXtChunk};
use ::png::{
    BitDepth, ColorType, DeflateCompression, Encoder, Filter, SrgbRenderingIntent, StreamWriter,
};

/// Bytes of compressed data a chunk; also about what is kept before it is written.
const CHUNK: usize = 1 << 18;

/// The last chunk of every PNG: no data, its name, its checksum.
const END: [u8; 12] = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xAE, 0x42, 0x60, 0x82];

/// A PNG being written.
pub(super) struct Png {
    stream: StreamWriter<'static, Gathered>,
    gathered: Gathered,
    /// Bytes a row.
    row: usize,
}

/// What the encoder has written and we have not. The library's stream writer owns what it writes to and ends the file
/// by itself; this stands between, so that errors are ours to tell and a chunk can follow the image data.
#[derive(Clone, Default)]
struct Gathered(Arc<Mutex<Vec<u8>>>);

impl Gathered {
    fn take(&self) -> Vec<u8> {
        mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn len(&self) -> usize {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).len()
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
        encoder.set_deflate_compression(DeflateCompression::Level(1));
        encoder.set_filter(Filter::Paeth);
        // What programs take bytes without a word about their colours for, and what they are meant as; said, since some
        // take them for what their own screen shows.
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        let writer = encoder.write_header()?;
        for (key, text) in texts {
            write_text(key, text, &mut gathered.clone())?;
        }
        let stream = writer.into_stream_writer_with_size(CHUNK)?;
        Ok(Self {
            stream,
            gathered,
            row: 3 * width as usize,
        })
    }

    /// Takes whole rows, the top one first.
    pub(super) fn write(&mut self, rgb: &[u8], to: &mut impl Write) -> io::Result<()> {
        for row in rgb.chunks(self.row) {
            self.stream.write_all(row)?;
            if self.gathered.len() >= CHUNK {
                to.write_all(&self.gathered.take())?;
            }
        }
        Ok(())
    }

    /// Ends the picture, with one more text.
    pub(super) fn finish(self, key: &str, text: &str, to: &mut impl Write) -> io::Result<()> {
        self.stream.finish()?;
        let mut rest = self.gathered.take();
        // The end chunk was written when the stream writer went; the text belongs before it.
        if !rest.ends_with(&END) {
            return Err(io::Error::other("the PNG encoder did not end the file"));
        }
        rest.truncate(rest.len() - END.len());
        write_text(key, text, &mut rest)?;
        rest.extend_from_slice(&END);
        to.write_all(&rest)
    }
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

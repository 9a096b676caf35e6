//! Pictures back from files: PPM, PNG or EXR, told apart by how they start, not by name.
//!
//! Before `compare`. A file's header may claim any size; memory is taken only for what the length of the file makes
//! possible, and never for more than [`MAX_PIXELS`] pixels.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use ::exr::meta::MetaData;
use ::image::codecs::openexr::OpenExrDecoder;
use ::image::codecs::png::PngDecoder;
use ::image::{ColorType, DynamicImage, ImageDecoder, ImageError};

use crate::files::reason;
use crate::frame::Band;
use crate::ppm::{self, Ppm, PpmError};

/// The most pixels that are read: 3.2 GB of bytes.
pub const MAX_PIXELS: u64 = 1 << 30;

/// The most that a file may grow when unpacked: deflate (PNG, EXR) reaches 1032 : 1, and EXR's other ways less.
const MAX_GROWTH: u64 = 1100;

/// A picture in memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Red, green, blue of every pixel, the top row first: 3 · width · height bytes.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// The picture as one band of all its rows, to be written.
    #[must_use]
    pub fn into_band(self) -> Band {
        Band {
            rows: 0..self.height,
            rgb: self.rgb,
            values: None,
            verdicts: None,
        }
    }
}

/// Why a picture cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The system does not let us open or read the file.
    #[error("cannot read {}: {}", .path.display(), reason(.source))]
    Io {
        /// The name as given.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is no picture, a damaged one, or one of another kind than ours.
    #[error("cannot read {}: {problem}", .path.display())]
    Picture {
        /// The name as given.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
}

/// What is known inside this module when something is wrong: everything but the name.
enum Wrong {
    Io(io::Error),
    Picture(String),
}

impl From<io::Error> for Wrong {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Picture("it ends too early".into()),
            _ => Self::Io(error),
        }
    }
}

impl From<ImageError> for Wrong {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::IoError(error) => error.into(),
            other => Self::Picture(other.to_string()),
        }
    }
}

impl From<&str> for Wrong {
    fn from(problem: &str) -> Self {
        Self::Picture(problem.into())
    }
}

/// Reads a picture.
///
/// PPM must be binary with 8 bits a channel. PNG may have at most 8 bits a channel and no transparent pixel; grey and
/// palettes become RGB. EXR's values are quantised as a rendering's are: floor(255·v), at least 0 and at most 255, not
/// a number being 0. That is exact for the 32-bit values in the file; a rendering quantises before it rounds to 32
/// bits, so a byte may differ by one from that of its own PPM.
///
/// # Errors
/// [`ReadError::Io`] if the system does not let us, [`ReadError::Picture`] if the file is not such a picture.
pub fn read(path: &Path) -> Result<Picture, ReadError> {
    read_with_remark(path).map(|(picture, _)| picture)
}

/// The same as [`read`], with what is odd about the file though it can be read, in words that come after its name.
///
/// # Errors
/// As [`read`].
pub fn read_with_remark(path: &Path) -> Result<(Picture, Option<String>), ReadError> {
    open(path).map_err(|wrong| match wrong {
        Wrong::Io(source) => ReadError::Io {
            path: path.to_owned(),
            source,
        },
        Wrong::Picture(problem) => ReadError::Picture {
            path: path.to_owned(),
            problem,
        },
    })
}

fn open(path: &Path) -> Result<(Picture, Option<String>), Wrong> {
    let file = File::open(path)?;
    let about = file.metadata()?;
    // A pipe's length is known only when it has ended.
    let length = about.is_file().then_some(about.len());
    let mut from = BufReader::with_capacity(1 << 16, file);
    let start = from.fill_buf()?;
    if start.starts_with(b"P6") {
        return read_ppm(&mut from, length);
    }
    let png = start.starts_with(b"\x89PNG");
    if !png && !start.starts_with(b"\x76\x2f\x31\x01") {
        return Err("it is neither a binary PPM nor a PNG nor an EXR".into());
    }
    let bytes = read_up_to(&mut from, length.unwrap_or(3 * MAX_PIXELS))?;
    let length = bytes.len() as u64;
    let bytes = Cursor::new(bytes);
    if png {
        return Ok((unpack(PngDecoder::new(bytes)?, length)?, None));
    }
    check_layers(bytes.get_ref(), length)?;
    Ok((unpack(OpenExrDecoder::new(bytes)?, length)?, None))
}

/// A PPM, from its first byte, and what is odd about it; `length` is the whole file's, if known.
fn read_ppm(
    from: &mut impl BufRead,
    length: Option<u64>,
) -> Result<(Picture, Option<String>), Wrong> {
    let read = ppm::read(from, length, 3 * MAX_PIXELS).map_err(|why| match why {
        PpmError::Io(error) => error.into(),
        PpmError::Other(what) | PpmError::Broken(what) => Wrong::Picture(format!("it {what}")),
    })?;
    let Ppm {
        width,
        height,
        rgb,
        remark,
    } = read;
    Ok((Picture { width, height, rgb }, remark))
}

/// At most `most` bytes, in memory that grows with what really comes.
fn read_up_to(from: &mut impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A picture's number of pixels, if it has any and not too many.
fn checked_pixels(width: u32, height: u32) -> Result<u64, Wrong> {
    match u64::from(width) * u64::from(height) {
        0 => Err("it has no pixels".into()),
        pixels if pixels > MAX_PIXELS => Err(Wrong::Picture(format!(
            "{width} × {height} pixels are too many to compare; the most is {MAX_PIXELS}"
        ))),
        pixels => Ok(pixels),
    }
}

/// Whether `unpacked` bytes, which hold this many pixels, may come out of a file of `length` bytes.
fn check_growth(width: u64, height: u64, unpacked: u64, length: u64) -> Result<(), Wrong> {
    if unpacked > length.saturating_mul(MAX_GROWTH) {
        return Err(Wrong::Picture(format!(
            "{width} × {height} pixels cannot come out of {length} bytes"
        )));
    }
    Ok(())
}

/// A PNG or EXR out of a file of `length` bytes.
fn unpack(mut decoder: impl ImageDecoder, length: u64) -> Result<Picture, Wrong> {
    let (width, height) = decoder.dimensions();
    let pixels = checked_pixels(width, height)?;
    let unpacked = decoder.total_bytes();
    // A pixel may be 1 bit in the file (a palette's index) and 32 when unpacked.
    check_growth(u64::from(width), u64::from(height), unpacked / 32, length)?;
    let mut limits = ::image::Limits::no_limits();
    limits.max_alloc = Some(unpacked.saturating_mul(2).max(1 << 26));
    decoder.set_limits(limits)?;
    if matches!(
        decoder.color_type(),
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16
    ) {
        return Err("it has 16 bits a channel; only 8 can be compared".into());
    }
    let rgb = match DynamicImage::from_decoder(decoder)? {
        DynamicImage::ImageRgb32F(image) => image.into_raw().into_iter().map(quantise).collect(),
        DynamicImage::ImageRgba32F(image) => {
            opaque(image.pixels().all(|pixel| pixel.0[3] == 1.0))?;
            image
                .pixels()
                .flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]])
                .map(quantise)
                .collect()
        }
        DynamicImage::ImageRgb8(image) => image.into_raw(),
        image => {
            opaque(
                !image.color().has_alpha()
                    || image.to_rgba8().pixels().all(|pixel| pixel.0[3] == 255),
            )?;
            image.into_rgb8().into_raw()
        }
    };
    if rgb.len() as u64 != 3 * pixels {
        return Err("it has another size than its header says".into());
    }
    Ok(Picture { width, height, rgb })
}

/// Refuses an EXR whose layers claim what cannot be in it. The picture's size, which is checked as for PNG, is another
/// thing than its layers' sizes, and the library takes memory for these as they are claimed.
fn check_layers(bytes: &[u8], length: u64) -> Result<(), Wrong> {
    let headers = MetaData::read_from_buffered(bytes, false)
        .map_err(|error| Wrong::Picture(error.to_string()))?
        .headers;
    for header in headers {
        let (width, height) = (
            header.layer_size.width() as u64,
            header.layer_size.height() as u64,
        );
        let claimed = width
            .saturating_mul(height)
            .saturating_mul(header.channels.bytes_per_pixel as u64);
        check_growth(width, height, claimed, length)?;
    }
    Ok(())
}

fn opaque(yes: bool) -> Result<(), Wrong> {
    if yes {
        Ok(())
    } else {
        Err("it has transparent pixels, which cannot be compared".into())
    }
}

/// The byte of a value, 1.0 being 255: floor(255·v), in f64, where the product is exact.
fn quantise(value: f32) -> u8 {
    // A cast clamps, truncates, and takes what is not a number for 0.
    (255.0 * f64::from(value)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_quantised_as_the_contract_says() {
        let cases = [
            (0.0, 0),
            (-0.0, 0),
            (-1.0, 0),
            (1.0 / 255.0, 1),
            (0.999_999_94, 254),
            (1.0, 255),
            (1e30, 255),
            (f32::INFINITY, 255),
            (f32::NEG_INFINITY, 0),
            (f32::NAN, 0),
        ];
        for (value, byte) in cases {
            assert_eq!(quantise(value), byte, "{value}");
        }
    }
}

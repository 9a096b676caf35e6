//! Pictures: finished bands of rows on their way into a file, and files on their way back to be compared.
//!
//! The last step of a rendering. [`Output`] is the front: it is opened before the first ray is traced (so that a name
//! that cannot be written costs no rendering), takes [`Band`](crate::render::Band)s from the top of the picture
//! downwards, and at the end either puts a whole picture under its name or leaves nothing:
//!
//! ```text
//! Band ─► output: counts rows, hashes ─► ppm / png / exr: bytes ─► sink: written beside ─► renamed to its name
//!                                                                   ▲
//!                                           target: what the name is: file, link, device, pipe, stdout
//! file ─► read: Picture ─► compare: Comparison, difference Picture
//! ```
//!
//! Pictures are written as the bands come; memory does not grow with their height.
//!
//! The picture's hash is the SHA-256 of the picture's PPM file, whatever the format of the file that is written: two
//! pictures with the same hash have the same size and the same bytes, and `sha256sum picture.ppm` tells it too.

pub mod compare;
mod document;
mod error;
mod exr;
mod flow;
mod left;
mod output;
mod png;
pub mod read;
mod sink;
mod size;
mod target;

use std::fmt;
use std::path::Path;

pub use compare::{Comparison, SizesDiffer, compare, difference};
pub use document::Document;
pub use error::OutputError;
pub use left::remove_left;
pub use output::{Finished, HASH_KEY, Metadata, Output};
pub use read::{Picture, ReadError, read, read_with_remark};
pub use sink::remove_unfinished;
pub use size::check_size;
pub use target::Target;

/// The formats that pictures are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// Binary PPM (`P6`), 8 bits a channel, nothing but the header and the bytes.
    Ppm,
    /// PNG, 8 bits a channel, RGB, with the metadata as text chunks.
    Png,
    /// OpenEXR, 32-bit floats, RGB: the values before quantising (1.0 is byte 255), with the metadata as attributes.
    Exr,
}

impl Format {
    /// The format that the path's ending names, in any case of letters.
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`] if that is none of `.ppm`, `.png` and `.exr`. What has no ending because it is no
    /// file (stdout, a device) is answered by [`Target::format`].
    pub fn from_path(path: &Path) -> Result<Self, OutputError> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("ppm") => Ok(Self::Ppm),
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(OutputError::UnknownEnding {
                path: path.to_owned(),
            }),
        }
    }

    /// Whether a picture in this format needs the values before quantising
    /// ([`Band::values`](crate::render::Band::values)).
    #[must_use]
    pub fn wants_values(self) -> bool {
        self == Self::Exr
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ppm => "PPM",
            Self::Png => "PNG",
            Self::Exr => "EXR",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_names_the_format_in_any_case() {
        for (path, format) in [
            ("a.ppm", Format::Ppm),
            ("b.c/a.PNG", Format::Png),
            ("a.ppm.Exr", Format::Exr),
        ] {
            assert_eq!(
                Format::from_path(Path::new(path)).unwrap(),
                format,
                "{path}"
            );
        }
    }

    #[test]
    fn an_unknown_ending_is_refused_and_the_known_ones_named() {
        for path in ["a", "a.jpg", "ppm", ".png", "a.png/"] {
            let known = Format::from_path(Path::new(path));
            if path == "a.png/" {
                // The name ends as a folder's does; only opening it will tell.
                assert!(known.is_ok());
                continue;
            }
            let message = known.unwrap_err().to_string();
            assert!(message.contains(".ppm, .png or .exr"), "{message}");
        }
    }
}

//! Reads the pictures of textures: binary PPM (P6) with maxval 255, by the rules of [`ppm`].
//!
//! Used by the parser for the value of `filename`, and by the builder. A picture that several textures use is read
//! once.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::draft::TexturePicture;
use super::encoding;
use super::model::Texels;
use crate::diagnostic::quote;
use crate::files;
use crate::ppm::{self, Ppm, PpmError};

/// The most bytes that the texels of one texture may take.
const MAX_TEXELS: u64 = 1 << 30;

/// Why a texture could not be read, and what would help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TextureError {
    /// What is wrong, after "texture `name`: ".
    pub(super) message: String,
    /// What would mend it.
    pub(super) help: Option<String>,
}

const CONVERT: &str = "textures are binary PPM (P6) with maxval 255; convert the picture to that";

fn error(message: impl Into<String>) -> TextureError {
    TextureError {
        message: message.into(),
        help: None,
    }
}

fn convert(message: impl Into<String>) -> TextureError {
    TextureError {
        message: message.into(),
        help: Some(CONVERT.into()),
    }
}

/// Texels, and what is odd about their file.
type Told = (Arc<Texels>, Option<String>);

/// The pictures read so far, by where they are.
#[derive(Debug, Default)]
pub(super) struct Pictures(HashMap<PathBuf, Result<Told, TextureError>>);

impl Pictures {
    /// Reads a picture, unless it was read before.
    pub(super) fn read(
        &mut self,
        folder: &Path,
        filename: &str,
    ) -> Result<TexturePicture, TextureError> {
        let path = folder.join(filename);
        let key = path.canonicalize().unwrap_or_else(|_| path.clone());
        let read = || {
            let told = |ppm: Ppm| {
                let Ppm {
                    width,
                    height,
                    rgb,
                    remark,
                } = ppm;
                (Arc::new(Texels { width, height, rgb }), remark)
            };
            read_file(&path).map(told)
        };
        let read = self.0.entry(key).or_insert_with(read).clone();
        let (texels, remark) = read.map_err(|error| TextureError {
            help: error.help.or_else(|| looked_for(&path, folder, filename)),
            ..error
        })?;
        Ok(TexturePicture {
            filename: filename.to_owned(),
            path,
            texels,
            remark,
        })
    }
}

/// Where a file was looked for that is not there, if its name alone does not say so.
fn looked_for(path: &Path, folder: &Path, filename: &str) -> Option<String> {
    if ['"', '\''].iter().any(|mark| filename.starts_with(*mark)) {
        return Some(String::from("a file name stands without quotation marks"));
    }
    if path.exists() || Path::new(filename).is_absolute() {
        return None;
    }
    let start = if folder.as_os_str().is_empty() {
        "in the current folder"
    } else {
        "since the names of textures start at the folder of the scene"
    };
    let path = path.to_string_lossy();
    Some(format!("looked for at {}, {start}", quote(path.as_bytes())))
}

fn read_file(path: &Path) -> Result<Ppm, TextureError> {
    // Asked first, since some systems refuse to open a directory with a reason that misleads.
    if path.is_dir() {
        return Err(error("is a directory, not a picture"));
    }
    let file = File::open(path).map_err(io_error)?;
    let metadata = file.metadata().map_err(io_error)?;
    // Only a regular file has a length to hold the header against; elsewhere memory grows with what arrives.
    let length = metadata.is_file().then_some(metadata.len());
    read_ppm(&mut BufReader::new(file), length)
}

fn io_error(source: io::Error) -> TextureError {
    error(match source.kind() {
        io::ErrorKind::IsADirectory => String::from("is a directory, not a picture"),
        _ => files::reason(&source),
    })
}

/// Reads a picture from a reader over `length` bytes, if that is known.
fn read_ppm(input: &mut impl BufRead, length: Option<u64>) -> Result<Ppm, TextureError> {
    let start = input.fill_buf().map_err(io_error)?;
    match start {
        [] => return Err(convert("is empty")),
        [b'P', b'6', ..] => {}
        [b'P', b'3', ..] => return Err(convert("is a text PPM (P3), not a binary one (P6)")),
        _ => {
            let what = encoding::signature(start).unwrap_or("no picture that is known");
            return Err(convert(format!("is {what}, not a binary PPM (P6)")));
        }
    }
    ppm::read(input, length, MAX_TEXELS).map_err(|why| match why {
        PpmError::Io(source) => io_error(source),
        PpmError::Other(what) => convert(what),
        PpmError::Broken(what) => error(what),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_pictures_are_named() {
        let message = |mut bytes: &[u8]| read_ppm(&mut bytes, None).unwrap_err();
        assert_eq!(message(b""), convert("is empty"));
        for (bytes, what) in [
            (
                &b"P3 1 1 255\n1 2 3"[..],
                "is a text PPM (P3), not a binary one (P6)",
            ),
            (
                b"P5 1 1 255\nx",
                "is a PBM or PGM picture, not a binary PPM (P6)",
            ),
            (
                b"\xFF\xD8\xFF\xE0",
                "is a JPEG picture, not a binary PPM (P6)",
            ),
            (
                b"hello",
                "is no picture that is known, not a binary PPM (P6)",
            ),
            (b"P6 1 1 65535\nabcdef", "has maxval 65535; it must be 255"),
        ] {
            assert_eq!(message(bytes), convert(what));
        }
        assert_eq!(message(b"P6 1 1 255"), error("ends within its header"));
    }
}

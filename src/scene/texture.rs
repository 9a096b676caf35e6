//! Reads the pictures of textures: binary PPM (P6) with maxval 255.
//!
//! Used by the parser for the value of `filename`, and by the builder. No memory is taken for what a header claims
//! before the bytes are known to be there; a picture that several textures use is read once.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::draft::TexturePicture;
use super::encoding;
use super::model::Texels;

/// The most bytes that the texels of one texture may take.
const MAX_TEXELS: u64 = 1 << 30;
/// The most bytes that a header may take, comments included.
const MAX_HEADER: usize = 1 << 16;

/// Why a texture could not be read, and what would help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TextureError {
    /// What is wrong, after "texture `name`: ".
    pub(super) message: String,
    /// What would mend it.
    pub(super) help: Option<&'static str>,
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
        help: Some(CONVERT),
    }
}

/// The pictures read so far, by where they are.
#[derive(Debug, Default)]
pub(super) struct Pictures(HashMap<PathBuf, Result<Arc<Texels>, TextureError>>);

impl Pictures {
    /// Reads a picture, unless it was read before.
    pub(super) fn read(
        &mut self,
        folder: &Path,
        filename: &str,
    ) -> Result<TexturePicture, TextureError> {
        let path = folder.join(filename);
        let key = path.canonicalize().unwrap_or_else(|_| path.clone());
        let texels = self
            .0
            .entry(key)
            .or_insert_with(|| read_file(&path).map(Arc::new))
            .clone()?;
        Ok(TexturePicture {
            filename: filename.to_owned(),
            path,
            texels,
        })
    }
}

fn read_file(path: &Path) -> Result<Texels, TextureError> {
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
        io::ErrorKind::NotFound => String::from("there is no such file"),
        io::ErrorKind::PermissionDenied => String::from("permission denied"),
        io::ErrorKind::IsADirectory => String::from("is a directory, not a picture"),
        _ => source.to_string(),
    })
}

/// Reads a binary PPM from a reader over `length` bytes, if that is known.
fn read_ppm(input: &mut impl BufRead, length: Option<u64>) -> Result<Texels, TextureError> {
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
    input.consume(2);
    let mut header = Header { input, used: 2 };
    if !header.byte()?.is_ascii_whitespace() {
        return Err(convert(
            "is no binary PPM (P6): white space must follow `P6`",
        ));
    }
    let [width, height, maxval] = [
        header.number("width")?,
        header.number("height")?,
        header.number("maxval")?,
    ];
    let used = header.used as u64;
    if maxval != 255 {
        return Err(convert(format!("has maxval {maxval}; it must be 255")));
    }
    if width == 0 || height == 0 {
        return Err(error(format!("has no texels: it is {width} x {height}")));
    }
    let need = (u64::from(width) * u64::from(height)).saturating_mul(3);
    if let Some(length) = length
        && length.saturating_sub(used) < need
    {
        let have = length.saturating_sub(used);
        return Err(error(format!(
            "ends early: {width} x {height} texels are {need} bytes, and there are {have}"
        )));
    }
    if need > MAX_TEXELS {
        return Err(error(format!(
            "is too large: {width} x {height} texels are over {} MiB",
            MAX_TEXELS >> 20
        )));
    }
    let mut rgb = Vec::new();
    if length.is_some() {
        rgb.reserve_exact(need as usize);
    }
    let have = input
        .by_ref()
        .take(need)
        .read_to_end(&mut rgb)
        .map_err(io_error)? as u64;
    if have < need {
        return Err(error(format!(
            "ends early: {width} x {height} texels are {need} bytes, and there are {have}"
        )));
    }
    Ok(Texels { width, height, rgb })
}

/// The header of a PPM, byte by byte, without its comments.
struct Header<'r, R> {
    input: &'r mut R,
    used: usize,
}

impl<R: BufRead> Header<'_, R> {
    /// The next byte; a comment reads as the end of its line.
    fn byte(&mut self) -> Result<u8, TextureError> {
        let mut byte = self.raw()?;
        if byte == b'#' {
            while !matches!(byte, b'\n' | b'\r') {
                byte = self.raw()?;
            }
        }
        Ok(byte)
    }

    fn raw(&mut self) -> Result<u8, TextureError> {
        let mut byte = [0];
        if self.used >= MAX_HEADER {
            return Err(convert("has a header of more than 64 KiB"));
        }
        match self.input.read_exact(&mut byte) {
            Ok(()) => self.used += 1,
            Err(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
                return Err(error("ends within its header"));
            }
            Err(source) => return Err(io_error(source)),
        }
        Ok(byte[0])
    }

    /// A number and the one white space behind it.
    fn number(&mut self, name: &str) -> Result<u32, TextureError> {
        let mut byte = self.byte()?;
        while byte.is_ascii_whitespace() || byte == 0x0B {
            byte = self.byte()?;
        }
        let mut value: Option<u32> = None;
        while byte.is_ascii_digit() {
            let shifted = value
                .unwrap_or(0)
                .checked_mul(10)
                .and_then(|value| value.checked_add(u32::from(byte - b'0')));
            value = Some(shifted.ok_or_else(|| error(format!("has too large a {name}")))?);
            byte = self.byte()?;
        }
        match value {
            Some(value) if byte.is_ascii_whitespace() || byte == 0x0B => Ok(value),
            _ => Err(convert(format!(
                "has a broken header: its {name} is no number"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Texels, String> {
        let known =
            read_ppm(&mut &bytes[..], Some(bytes.len() as u64)).map_err(|error| error.message);
        let piped = read_ppm(&mut &bytes[..], None).map_err(|error| error.message);
        assert_eq!(known, piped, "the length of a file only saves work");
        known
    }

    #[test]
    fn comments_may_stand_anywhere_in_the_header() {
        let texels = Texels {
            width: 2,
            height: 1,
            rgb: b"abcdef".to_vec(),
        };
        for header in [
            "P6 2 1 255\n",
            "P6\n#c\n2 #x\n1\n255\t",
            "P6#\n2#\n1#\r255#\n",
            "P6 02\x0C0001 0255 ",
        ] {
            let bytes = [header.as_bytes(), b"abcdef"].concat();
            assert_eq!(read(&bytes).as_ref(), Ok(&texels), "{header:?}");
            let trailing = [&bytes[..], b"\n P6"].concat();
            assert_eq!(
                read(&trailing).as_ref(),
                Ok(&texels),
                "{header:?}, with bytes behind"
            );
        }
    }

    #[test]
    fn texels_that_look_like_a_comment_are_texels() {
        assert_eq!(
            read(b"P6 1 1 255\n#\n#").map(|texels| texels.rgb),
            Ok(b"#\n#".to_vec())
        );
    }

    #[test]
    fn wrong_pictures_are_named() {
        let message = |bytes: &[u8]| read(bytes).unwrap_err();
        assert_eq!(message(b""), "is empty");
        assert_eq!(message(b"P6"), "ends within its header");
        assert_eq!(message(b"P6 1 1"), "ends within its header");
        assert_eq!(message(b"P6 1 1 #"), "ends within its header");
        assert_eq!(
            message(b"P61 1 255\nabc"),
            "is no binary PPM (P6): white space must follow `P6`"
        );
        assert_eq!(
            message(b"P6 1 x 255\nabc"),
            "has a broken header: its height is no number"
        );
        assert_eq!(
            message(b"P6 -1 1 255\nabc"),
            "has a broken header: its width is no number"
        );
        assert_eq!(
            message(b"P6 1 1 255abc"),
            "has a broken header: its maxval is no number"
        );
        assert_eq!(message(b"P6 99999999999 1 255\n"), "has too large a width");
        assert_eq!(message(b"P6 0 0 255\n"), "has no texels: it is 0 x 0");
        assert_eq!(
            message(b"P6 1 1 65535\nabcdef"),
            "has maxval 65535; it must be 255"
        );
        assert_eq!(
            message(b"P3 1 1 255\n1 2 3"),
            "is a text PPM (P3), not a binary one (P6)"
        );
        assert_eq!(
            message(b"P5 1 1 255\nx"),
            "is a PBM or PGM picture, not a binary PPM (P6)"
        );
        assert_eq!(
            message(b"\xFF\xD8\xFF\xE0"),
            "is a JPEG picture, not a binary PPM (P6)"
        );
        assert_eq!(
            message(b"hello"),
            "is no picture that is known, not a binary PPM (P6)"
        );
        let comment = [b"P6 #".as_slice(), &[b'x'; 70_000]].concat();
        assert_eq!(message(&comment), "has a header of more than 64 KiB");
    }

    #[test]
    fn a_header_that_claims_too_much_takes_no_memory() {
        let bytes = b"P6 65536 65536 255\n0123456789";
        let claim = "65536 x 65536 texels are";
        let known = read_ppm(&mut &bytes[..], Some(bytes.len() as u64))
            .unwrap_err()
            .message;
        assert_eq!(
            known,
            format!("ends early: {claim} 12884901888 bytes, and there are 10")
        );
        let piped = read_ppm(&mut &bytes[..], None).unwrap_err().message;
        assert_eq!(piped, format!("is too large: {claim} over 1024 MiB"));
        let huge = b"P6 4294967295 4294967295 255\n";
        assert!(
            read_ppm(&mut &huge[..], None)
                .unwrap_err()
                .message
                .contains("over 1024 MiB")
        );
    }
}

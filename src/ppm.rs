//! Binary PPM (P6) of 8 bits a channel: its header as we write it, and whole pictures as anybody wrote them.
//!
//! On the lowest floor, since two read with it: `scene` the textures, `image` the pictures to compare. It keeps
//! netpbm's rules, so that a file is the same picture here and there. No memory is taken for what a header claims
//! before the bytes are known to be there.

use std::io::{self, BufRead, Read};

/// The most bytes that a header may take, comments included.
const MAX_HEADER: u64 = 1 << 16;

/// The header of a picture: all that a PPM file has besides its bytes.
pub(crate) fn header(width: u32, height: u32) -> String {
    format!("P6 {width} {height} 255\n")
}

/// A picture that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ppm {
    /// Columns, at least 1.
    pub(crate) width: u32,
    /// Rows, at least 1.
    pub(crate) height: u32,
    /// Red, green, blue of each pixel, top row first: 3 · width · height bytes.
    pub(crate) rgb: Vec<u8>,
    /// What is odd about the file, though it can be read; after its name.
    pub(crate) remark: Option<String>,
}

/// Why a picture cannot be read.
#[derive(Debug)]
pub(crate) enum PpmError {
    /// The system fails.
    Io(io::Error),
    /// It is a file of another kind, or another kind of PPM; what it is, after its name.
    Other(String),
    /// It is damaged, empty or too large; how, after its name.
    Broken(String),
}

impl From<io::Error> for PpmError {
    fn from(source: io::Error) -> Self {
        Self::Io(source)
    }
}

/// Reads a picture of at most `most` bytes. `length` is the whole file's, if it is known.
///
/// Bytes behind the last pixel mean nothing, as for netpbm, whose files may hold several pictures; but they are a
/// remark, since a header that is longer than it should be leaves some.
pub(crate) fn read(
    input: &mut impl BufRead,
    length: Option<u64>,
    most: u64,
) -> Result<Ppm, PpmError> {
    if !input.fill_buf()?.starts_with(b"P6") {
        return Err(PpmError::Other("is no binary PPM (P6)".into()));
    }
    input.consume(2);
    let mut header = Header { input, used: 2 };
    if !is_space(header.byte()?) {
        let what = "is no binary PPM (P6): white space must follow `P6`";
        return Err(PpmError::Other(what.into()));
    }
    let (width, _) = header.number("width")?;
    let (height, _) = header.number("height")?;
    let (maxval, end) = header.number("maxval")?;
    let used = header.used;
    if maxval != 255 {
        let what = format!("has maxval {maxval}; it must be 255");
        return Err(PpmError::Other(what));
    }
    let size = format!("{width} x {height} pixels");
    if width == 0 || height == 0 {
        return Err(PpmError::Broken(format!(
            "has no pixels: it is {width} x {height}"
        )));
    }
    let need = (u64::from(width) * u64::from(height)).saturating_mul(3);
    let early = |have: u64| {
        let what = format!("ends early: {size} are {need} bytes, and there are {have}");
        Err(PpmError::Broken(what))
    };
    if let Some(have) = length.map(|length| length.saturating_sub(used))
        && have < need
    {
        return early(have);
    }
    if need > most {
        let what = format!("is too large: {size} are over {} MiB", most >> 20);
        return Err(PpmError::Broken(what));
    }
    let mut rgb = Vec::new();
    if length.is_some() {
        rgb.reserve_exact(need as usize);
    }
    let have = input.by_ref().take(need).read_to_end(&mut rgb)? as u64;
    if have < need {
        return early(have);
    }
    // Two are enough to tell one from many: what has no length may have no end.
    let mut surplus = Vec::new();
    input.by_ref().take(2).read_to_end(&mut surplus)?;
    let remark = match (surplus.len(), end, rgb.first()) {
        (0, ..) => None,
        (1, b'\r', Some(b'\n')) => Some(format!(
            "has a header that ends with CR LF: the CR ends it, so the LF is the first pixel's red, and every channel \
             has its neighbour's value; write {} and LF alone before the {need} bytes of its pixels",
            self::header(width, height).trim_end()
        )),
        _ => Some(format!(
            "goes on behind its pixels: {size} are {need} bytes, and what follows is not read"
        )),
    };
    Ok(Ppm {
        width,
        height,
        rgb,
        remark,
    })
}

/// White space of a header: that of C's `isspace`.
fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0B | 0x0C)
}

/// The header of a PPM, byte by byte, without its comments.
struct Header<'r, R> {
    input: &'r mut R,
    used: u64,
}

impl<R: BufRead> Header<'_, R> {
    /// The next byte; a comment, which may stand in the middle of a number too, reads as the end of its line.
    fn byte(&mut self) -> Result<u8, PpmError> {
        let mut byte = self.raw()?;
        if byte == b'#' {
            while !matches!(byte, b'\n' | b'\r') {
                byte = self.raw()?;
            }
        }
        Ok(byte)
    }

    fn raw(&mut self) -> Result<u8, PpmError> {
        let mut byte = [0];
        if self.used >= MAX_HEADER {
            return Err(PpmError::Other("has a header of more than 64 KiB".into()));
        }
        match self.input.read_exact(&mut byte) {
            Ok(()) => self.used += 1,
            Err(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
                return Err(PpmError::Broken("ends within its header".into()));
            }
            Err(source) => return Err(source.into()),
        }
        Ok(byte[0])
    }

    /// A number, and the one white space behind it.
    fn number(&mut self, name: &str) -> Result<(u32, u8), PpmError> {
        let mut byte = self.byte()?;
        while is_space(byte) {
            byte = self.byte()?;
        }
        let mut value: Option<u32> = None;
        while byte.is_ascii_digit() {
            let shifted = value
                .unwrap_or(0)
                .checked_mul(10)
                .and_then(|value| value.checked_add(u32::from(byte - b'0')));
            let large = || PpmError::Broken(format!("has too large a {name}"));
            value = Some(shifted.ok_or_else(large)?);
            byte = self.byte()?;
        }
        match value {
            Some(value) if is_space(byte) => Ok((value, byte)),
            _ => {
                let what = format!("has a broken header: its {name} is no number");
                Err(PpmError::Other(what))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: u64 = 1 << 30;

    fn message(error: PpmError) -> String {
        match error {
            PpmError::Io(source) => panic!("{source}"),
            PpmError::Other(what) | PpmError::Broken(what) => what,
        }
    }

    fn read(bytes: &[u8]) -> Result<Ppm, String> {
        let read = |length| super::read(&mut &bytes[..], length, MOST).map_err(message);
        let known = read(Some(bytes.len() as u64));
        assert_eq!(known, read(None), "the length of a file only saves work");
        known
    }

    #[test]
    fn the_header_is_exactly_the_contracts() {
        assert_eq!(header(640, 480), "P6 640 480 255\n");
        let bytes = [header(1, 2).as_bytes(), b"\n#x\n#x"].concat();
        let picture = read(&bytes).unwrap();
        assert_eq!((picture.width, picture.height), (1, 2));
        assert_eq!((&picture.rgb[..], picture.remark), (&b"\n#x\n#x"[..], None));
    }

    #[test]
    fn headers_are_read_by_netpbms_rules() {
        for header in [
            "P6 2 1 255\n",
            "P6\n#c\n2 #x\n1\n255\t",
            "P6#\n2#\n1#\r255#\n",
            "P6 02\x0C0001 0255 ",
            "P6\r\n2 1\r\n255\n",
            "P6\x0B2\x0C1\t\r\n 255\x0B",
            "P6 2 1 255\x0C",
            "P6 2 1 255\r",
            "P6 2# in the middle of a number\n1 255 ",
        ] {
            let bytes = [header.as_bytes(), b"abcdef"].concat();
            let texels = read(&bytes).unwrap_or_else(|why| panic!("{header:?} {why}"));
            assert_eq!((texels.width, texels.height), (2, 1), "{header:?}");
            assert_eq!((&texels.rgb[..], texels.remark), (&b"abcdef"[..], None));
            let more = read(&[&bytes[..], b"\n P6"].concat()).unwrap();
            assert_eq!(more.rgb, b"abcdef", "{header:?}, with bytes behind");
            assert!(
                more.remark
                    .unwrap()
                    .starts_with("goes on behind its pixels")
            );
        }
    }

    /// One white space ends the header. A text editor or a transfer that made it two shifts every channel, which nobody
    /// would see in a picture of grey.
    #[test]
    fn a_header_that_was_made_longer_is_told() {
        let shifted = read(b"P6 2 1 255\r\nabcdef").unwrap();
        assert_eq!(shifted.rgb, b"\nabcde");
        let remark = shifted.remark.unwrap();
        assert!(remark.contains("write P6 2 1 255 and LF alone"), "{remark}");
        let spaced = read(b"P6 2 1 255 \nabcdef").unwrap();
        assert!(spaced.remark.unwrap().contains("2 x 1 pixels are 6 bytes"));
        assert_eq!(read(b"P6 1 1 255\n#\n#").unwrap().remark, None);
    }

    #[test]
    fn wrong_pictures_are_named() {
        let message = |bytes: &[u8]| read(bytes).unwrap_err();
        for bytes in ["P6", "P6 1 1", "P6 1 1 #", "P6 1 1 # 255\n", "P6 1 1 255"] {
            assert_eq!(message(bytes.as_bytes()), "ends within its header");
        }
        for bytes in ["", "P", "P5 1 1 255\nx", "hello"] {
            assert_eq!(message(bytes.as_bytes()), "is no binary PPM (P6)");
        }
        let space = "is no binary PPM (P6): white space must follow `P6`";
        assert_eq!(message(b"P61 1 255\nabc"), space);
        for (bytes, name) in [
            ("P6 -1 1 255\nabc", "width"),
            ("P6 1 x 255\nabc", "height"),
            ("P6 1.5 1 255\nabc", "width"),
            ("P6 1 1 255abc", "maxval"),
            ("P6 1 255\nabc", "maxval"),
        ] {
            let told = format!("has a broken header: its {name} is no number");
            assert_eq!(message(bytes.as_bytes()), told, "{bytes}");
        }
        assert_eq!(message(b"P6 99999999999 1 255\n"), "has too large a width");
        assert_eq!(message(b"P6 0 5 255\n"), "has no pixels: it is 0 x 5");
        for maxval in [254, 256, 65535] {
            let told = format!("has maxval {maxval}; it must be 255");
            assert_eq!(message(format!("P6 1 1 {maxval}\nabcdef").as_bytes()), told);
        }
        let comment = [b"P6 #".as_slice(), &[b'x'; 70_000]].concat();
        assert_eq!(message(&comment), "has a header of more than 64 KiB");
    }

    #[test]
    fn a_header_that_claims_too_much_takes_no_memory() {
        let bytes = b"P6 65536 65536 255\n0123456789";
        let claim = "65536 x 65536 pixels are";
        let read =
            |mut bytes: &[u8], length| message(super::read(&mut bytes, length, MOST).unwrap_err());
        let known = read(bytes, Some(bytes.len() as u64));
        assert_eq!(
            known,
            format!("ends early: {claim} 12884901888 bytes, and there are 10")
        );
        let large = format!("is too large: {claim} over 1024 MiB");
        assert_eq!(read(bytes, None), large);
        assert!(read(b"P6 4294967295 4294967295 255\n", None).contains("over 1024 MiB"));
    }
}

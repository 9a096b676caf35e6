//! PPM: the header, and after it the bytes as they are.
//!
//! Below `output`, which hashes exactly these bytes for every format, and `read`, which takes the header apart again.

use std::io::{self, Read};

/// The header of a picture: all that a PPM file has besides its bytes.
pub(super) fn header(width: u32, height: u32) -> String {
    format!("P6 {width} {height} 255\n")
}

/// Reads a header: width and height, in pixels. Reads on to exactly where the bytes start.
///
/// Any blanks may separate the numbers, and comments (`#` to the end of the line) may follow them, as other programs
/// write them; but 8 bits a channel it must be.
pub(super) fn read_header(from: &mut impl Read) -> io::Result<Result<(u32, u32), &'static str>> {
    let mut magic = [0; 2];
    from.read_exact(&mut magic)?;
    if magic != *b"P6" {
        return Ok(Err("it is no binary PPM: it does not start with P6"));
    }
    let mut numbers = [0; 3];
    for number in &mut numbers {
        match read_number(from)? {
            Some(read) => *number = read,
            None => return Ok(Err("its PPM header is not `P6 width height 255`")),
        }
    }
    let [width, height, most] = numbers;
    Ok(match most {
        255 => Ok((width, height)),
        _ => Err(
            "it is a PPM, but not one of 8 bits a channel (the header's last number must be 255)",
        ),
    })
}

/// One number, the blanks and comments before it, and the one blank after it. None if there is something else.
fn read_number(from: &mut impl Read) -> io::Result<Option<u32>> {
    let mut byte = read_byte(from)?;
    if !byte.is_ascii_whitespace() && !byte.is_ascii_digit() && byte != b'#' {
        return Ok(None);
    }
    loop {
        match byte {
            b'#' => while read_byte(from)? != b'\n' {},
            _ if byte.is_ascii_whitespace() => {}
            _ => break,
        }
        byte = read_byte(from)?;
    }
    let mut number: Option<u32> = None;
    while byte.is_ascii_digit() {
        let Some(longer) = number
            .unwrap_or(0)
            .checked_mul(10)
            .and_then(|n| n.checked_add(u32::from(byte - b'0')))
        else {
            return Ok(None);
        };
        number = Some(longer);
        byte = read_byte(from)?;
    }
    Ok(number.filter(|_| byte.is_ascii_whitespace()))
}

fn read_byte(from: &mut impl Read) -> io::Result<u8> {
    let mut byte = [0];
    from.read_exact(&mut byte)?;
    Ok(byte[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(mut bytes: &[u8]) -> Option<((u32, u32), &[u8])> {
        let size = read_header(&mut bytes).ok()?.ok()?;
        Some((size, bytes))
    }

    #[test]
    fn the_header_is_exactly_the_contracts() {
        assert_eq!(header(640, 480), "P6 640 480 255\n");
        assert_eq!(
            read(b"P6 640 480 255\n\n#x"),
            Some(((640, 480), b"\n#x".as_slice()))
        );
    }

    #[test]
    fn headers_of_other_programs_are_read() {
        assert_eq!(
            read(b"P6\n# made by\n# hand\n3 4\n255\nabc"),
            Some(((3, 4), b"abc".as_slice()))
        );
        assert_eq!(read(b"P6\t3\r\n4 255 #"), Some(((3, 4), b"#".as_slice())));
    }

    #[test]
    fn what_is_no_header_is_refused() {
        for bytes in [
            "",
            "P",
            "P6",
            "P5 1 1 255\n",
            "P6 1 1 65535\n",
            "P6 1 1 256\n",
            "P6 1 1 255",
            "P6 1 1 255x",
            "P6 1 255\n",
            "P6 -1 1 255\n",
            "P6 4294967296 1 255\n",
            "P6 1.5 1 255\n",
            "P6x1 1 255\n",
            "P6 1 1 # 255\n",
        ] {
            assert_eq!(read(bytes.as_bytes()), None, "{bytes:?}");
        }
    }
}

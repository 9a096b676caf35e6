//! Is this a text at all? What is looked at before the lexer sees a byte of text → lex → parse →
//! [`Scene`](super::Scene).
//!
//! A picture, an archive or UTF-16 text in place of a scene is one mistake and gets one message. Bytes that are not
//! UTF-8 inside what else is a scene are one more mistake among others.

use super::bytes::is_space;
use crate::diagnostic::Diagnostic;

/// How files begin that people hand over by mistake, and what to call them.
const SIGNATURES: &[(&[u8], &str)] = &[
    (b"\xFF\xD8\xFF", "a JPEG picture"),
    (b"\x89PNG\r\n\x1A\n", "a PNG picture"),
    (b"GIF87a", "a GIF picture"),
    (b"GIF89a", "a GIF picture"),
    (b"\x76\x2F\x31\x01", "an EXR picture"),
    (b"%PDF-", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1F\x8B", "a gzip archive"),
    (b"\x7FELF", "a program"),
];

/// Encodings that begin with a mark of their own; UTF-32's little-endian mark begins with UTF-16's.
const MARKS: &[(&[u8], &str)] = &[
    (b"\xFF\xFE\0\0", "UTF-32"),
    (b"\0\0\xFE\xFF", "UTF-32"),
    (b"\xFF\xFE", "UTF-16"),
    (b"\xFE\xFF", "UTF-16"),
];

/// What a file that begins like this is, where it is known and no scene.
pub(super) fn signature(bytes: &[u8]) -> Option<&'static str> {
    if let [b'P', digit @ b'1'..=b'6', space, ..] = bytes
        && (is_space(*space) || *space == b'#')
    {
        return Some(if matches!(digit, b'3' | b'6') {
            "a PPM picture"
        } else {
            "a PBM or PGM picture"
        });
    }
    SIGNATURES
        .iter()
        .find(|(magic, _)| bytes.starts_with(magic))
        .map(|(_, name)| *name)
}

/// Why these bytes are no scene, where that is plain before reading on.
pub(super) fn not_a_scene(bytes: &[u8]) -> Option<Diagnostic> {
    if let Some(name) = signature(bytes) {
        let message = format!("this is {name}, not a scene");
        return Some(Diagnostic::new(0..0, message).help("a scene is a text file"));
    }
    if let Some((_, name)) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark)) {
        let message = format!("this text is encoded in {name}; a scene is UTF-8");
        return Some(Diagnostic::new(0..0, message).help("save it as UTF-8"));
    }
    let nul = memchr::memchr(0, bytes)?;
    let message = "this is not a scene: it holds a NUL byte";
    let help = "a scene is a text file in UTF-8; this may be UTF-16, or no text at all";
    Some(
        Diagnostic::new(nul..nul + 1, message)
            .label("the first one")
            .help(help),
    )
}

/// The first bytes that are not UTF-8, as an error.
pub(super) fn not_utf8(bytes: &[u8]) -> Option<Diagnostic> {
    let error = std::str::from_utf8(bytes).err()?;
    let start = error.valid_up_to();
    let end = start + error.error_len().unwrap_or(bytes.len() - start);
    let message = format!(
        "this text is not UTF-8: byte 0x{:02X} cannot stand here",
        bytes[start]
    );
    Some(
        Diagnostic::new(start..end, message)
            .help("save it as UTF-8; it may be Latin-1 or Windows-1252"),
    )
}

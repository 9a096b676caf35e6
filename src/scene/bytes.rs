//! What single bytes mean in a scene's text, for everything that looks at bytes: `encoding`, `lex` and `places`.

/// UTF-8's byte order mark.
const UTF8_BOM: &[u8] = b"\xEF\xBB\xBF";

/// The length of the byte order mark that the text starts with; 0 if it has none.
pub(super) fn mark_length(text: &[u8]) -> usize {
    if text.starts_with(UTF8_BOM) {
        UTF8_BOM.len()
    } else {
        0
    }
}

/// White space of the scene language: that of C's `isspace`.
pub(super) const fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0B | 0x0C)
}

//! Bytes to tokens: the first step of text → lex → parse → [`Scene`](super::Scene).
//!
//! A token is a slice of the text; nothing is copied, whatever the length. White space is what C's `isspace` takes in
//! the C locale; `{` and `}` are tokens wherever they stand; `#` starts a comment wherever it stands, since a name
//! cannot hold one.

use std::ops::Range;

use memchr::memchr2;

use super::bytes::{is_space, mark_length};

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// `{`
    Open,
    /// `}`
    Close,
    /// A keyword, a name or a number.
    Word,
    /// The end of the text.
    End,
}

/// One token: a slice of the text, and where it starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'t> {
    /// What it is.
    pub(super) kind: TokenKind,
    /// Its bytes; none at the end of the text.
    pub(super) text: &'t [u8],
    /// Its first byte in the text.
    pub(super) start: usize,
}

impl Token<'_> {
    /// The byte after its last.
    pub(super) fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Its bytes in the text.
    pub(super) fn span(&self) -> Range<usize> {
        self.start..self.end()
    }

    /// Is it a word?
    pub(super) fn is_word(&self) -> bool {
        self.kind == TokenKind::Word
    }

    /// The token for a message.
    pub(super) fn quoted(&self) -> String {
        match self.kind {
            TokenKind::End => String::from("the end of the file"),
            _ => crate::diagnostic::quote(self.text),
        }
    }
}

/// Which bytes end a word.
const ENDS_WORD: [bool; 256] = {
    let mut ends = [false; 256];
    let mut byte = 0;
    while byte < 256 {
        ends[byte] = is_space(byte as u8) || matches!(byte as u8, b'{' | b'}' | b'#');
        byte += 1;
    }
    ends
};

/// Walks over a text, token by token.
#[derive(Debug, Clone)]
pub(super) struct Lexer<'t> {
    text: &'t [u8],
    at: usize,
}

impl<'t> Lexer<'t> {
    /// Starts at the beginning of a text, behind its byte order mark.
    pub(super) fn new(text: &'t [u8]) -> Self {
        Self {
            text,
            at: mark_length(text),
        }
    }

    /// Starts at a byte of a text, the first of a token.
    pub(super) fn at(text: &'t [u8], at: usize) -> Self {
        Self {
            text,
            at: at.min(text.len()),
        }
    }

    /// The next token; [`TokenKind::End`] again and again at the end.
    pub(super) fn token(&mut self) -> Token<'t> {
        self.skip_space();
        let start = self.at;
        let rest = &self.text[start..];
        let (kind, length) = match rest.first() {
            None => (TokenKind::End, 0),
            Some(b'{') => (TokenKind::Open, 1),
            Some(b'}') => (TokenKind::Close, 1),
            Some(_) => (
                TokenKind::Word,
                rest.iter()
                    .position(|byte| ENDS_WORD[usize::from(*byte)])
                    .unwrap_or(rest.len()),
            ),
        };
        self.at += length;
        Token {
            kind,
            text: &rest[..length],
            start,
        }
    }

    /// Moves over white space and comments; returns where the next token starts.
    pub(super) fn skip_space(&mut self) -> usize {
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'#' => self.at = line_end(self.text, self.at),
                byte if is_space(*byte) => self.at += 1,
                _ => break,
            }
        }
        self.at
    }

    /// Moves behind the next `}`, whatever comes before it; false if there is none.
    pub(super) fn skip_block(&mut self) -> bool {
        while let Some(found) = memchr2(b'}', b'#', &self.text[self.at..]) {
            self.at += found;
            if self.text[self.at] == b'}' {
                self.at += 1;
                return true;
            }
            self.at = line_end(self.text, self.at);
        }
        self.at = self.text.len();
        false
    }
}

/// Where the line ends that this byte is in.
fn line_end(text: &[u8], at: usize) -> usize {
    memchr2(b'\n', b'\r', &text[at..]).map_or(text.len(), |length| at + length)
}

/// The first place from `at` on where a `}` ends that is not in a comment, as far as a line end before it tells: the
/// first line is passed over, since it may be one.
pub(super) fn after_block(text: &[u8], at: usize) -> usize {
    let mut lexer = Lexer::at(text, line_end(text, at));
    lexer.skip_block();
    lexer.at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        let mut lexer = Lexer::new(text.as_bytes());
        let mut words = Vec::new();
        loop {
            let token = lexer.token();
            if token.kind == TokenKind::End {
                assert_eq!(lexer.token(), token);
                return words;
            }
            assert_eq!(&text.as_bytes()[token.span()], token.text);
            words.push(String::from_utf8_lossy(token.text).into_owned());
        }
    }

    #[test]
    fn white_space_of_every_kind_separates() {
        assert_eq!(
            words(" a\tb\nc\r\nd\x0Be\x0Cf "),
            ["a", "b", "c", "d", "e", "f"]
        );
        assert_eq!(words("a\u{A0}b"), ["a\u{A0}b"], "white space is ASCII's");
    }

    #[test]
    fn braces_need_no_space() {
        assert_eq!(
            words("plane left{normal 0 0 1}"),
            ["plane", "left", "{", "normal", "0", "0", "1", "}"]
        );
    }

    #[test]
    fn comments_end_with_the_line() {
        assert_eq!(words("a#b c\nd # e\r\nf # { }\rg #"), ["a", "d", "f", "g"]);
    }

    #[test]
    fn a_byte_order_mark_is_skipped_only_in_front() {
        assert_eq!(words("\u{FEFF}a \u{FEFF}b"), ["a", "\u{FEFF}b"]);
        assert_eq!(words("\u{FEFF}"), Vec::<String>::new());
    }
}

//! Bytes to tokens: the first step of text → lex → parse → [`Scene`](super::Scene).
//!
//! A token is a slice of the text; nothing is copied, whatever the length. White space is what C's `isspace` takes in
//! the C locale; `{` and `}` are tokens wherever they stand; `#` starts a comment wherever it stands, since a name
//! cannot hold one.

use std::ops::Range;

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

/// Does this byte end a word?
fn ends_word(byte: u8) -> bool {
    is_space(byte) || matches!(byte, b'{' | b'}' | b'#')
}

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
                    .position(|byte| ends_word(*byte))
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

    /// Moves over white space and comments.
    fn skip_space(&mut self) {
        let mut comment = false;
        for byte in &self.text[self.at..] {
            match byte {
                b'\n' | b'\r' => comment = false,
                _ if comment => {}
                b'#' => comment = true,
                byte if is_space(*byte) => {}
                _ => return,
            }
            self.at += 1;
        }
    }
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

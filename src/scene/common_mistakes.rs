//! Slips of writing that are known by their look: spaces and minus signs of a word processor, comments and brackets of
//! other languages.
//!
//! Nothing is forgiven here: the parser (text → lex → parse → [`Scene`](super::Scene)) asks only about a token that is
//! wrong, to say what would mend it.

use std::ops::Range;

use super::lex::{Lexer, Token, TokenKind};
use super::number::{self, split_dash};
use super::parser::Parser;
use crate::diagnostic::Diagnostic;

/// What to say where another language's comment stands.
pub(super) const COMMENT_HELP: &str = "comments begin with `#`";

/// Tokens of a vector with punctuation, brackets and commas standing alone: no more are looked at.
const MAX_VECTOR: usize = 24;

/// A space that separates nothing, since it is not ASCII's: its bytes in the token, and what it is called.
fn strange_space(token: &[u8]) -> Option<(Range<usize>, String)> {
    let text = std::str::from_utf8(token).ok()?;
    let (start, space) = text.char_indices().find(|(_, c)| is_strange_space(*c))?;
    let name = match space {
        '\u{A0}' => "no-break space",
        '\u{202F}' => "narrow no-break space",
        '\u{200B}' | '\u{FEFF}' => "space of no width",
        _ => "space of another kind",
    };
    let name = format!("{name} (U+{:04X})", u32::from(space));
    Some((start..start + space.len_utf8(), name))
}

fn is_strange_space(c: char) -> bool {
    c.is_whitespace() || matches!(c, '\u{200B}' | '\u{FEFF}')
}

/// The complaint about a space in a token that is not ASCII's, if it holds one.
pub(super) fn strange_space_error(token: Token<'_>) -> Option<Diagnostic> {
    let (place, name) = strange_space(token.text)?;
    let span = token.start + place.start..token.start + place.end;
    let message = format!("there is a {name} in {}", token.quoted());
    Some(Diagnostic::new(span, message).help("use a plain space"))
}

/// The words that were meant where a token holds spaces that are not ASCII's.
pub(super) fn words_of<'t>(token: Token<'t>) -> impl Iterator<Item = Token<'t>> {
    let text = std::str::from_utf8(token.text).unwrap_or_default();
    text.split(is_strange_space)
        .filter(|word| !word.is_empty())
        .map(move |word| Token {
            text: word.as_bytes(),
            start: token.start + (word.as_ptr().addr() - text.as_ptr().addr()),
            ..token
        })
}

/// Does this token begin a comment in other languages, or point at something as handwriting does?
pub(super) fn is_comment(token: &[u8]) -> bool {
    [b"//".as_slice(), b"/*", "←".as_bytes()]
        .iter()
        .any(|mark| token.starts_with(mark))
}

/// What would mend a token that is no number, or no whole one where one must be.
pub(super) fn number_help(token: &[u8], whole: bool) -> Option<String> {
    if is_comment(token) {
        return Some(String::from(COMMENT_HELP));
    }
    if token.contains(&b',') {
        return Some(String::from(
            "numbers have a decimal point, and white space between them",
        ));
    }
    let is_number = |text: &[u8]| {
        if whole {
            number::parse_integer(text).is_ok()
        } else {
            number::parse_number(text).is_ok()
        }
    };
    if let Some((dash, digits)) = split_dash(token) {
        let digits = std::str::from_utf8(digits).ok()?;
        let code = u32::from(dash);
        return is_number(digits.as_bytes())
            .then(|| format!("`{dash}` is U+{code:04X}; write -{digits}"));
    }
    let text = std::str::from_utf8(token).ok()?;
    if let Some((above, below)) = text.split_once('/')
        && number::parse_number(above.as_bytes()).is_ok()
        && number::parse_number(below.as_bytes()).is_ok()
    {
        return (!whole).then(|| String::from("write a quotient as a decimal number"));
    }
    let alone = text
        .trim_start_matches(['(', '['])
        .trim_end_matches([')', ']', ';']);
    if alone.len() < text.len() && is_number(alone.as_bytes()) {
        return Some(format!("write the number alone, like {alone}"));
    }
    match number::parse_number(token) {
        // Up to here each whole f64 is the number that was written.
        Ok(value) if whole && value.fract() == 0.0 && value.abs() < 1e15 => {
            Some(format!("write {value}"))
        }
        _ => None,
    }
}

/// Numbers that are written as other languages write vectors: `<4, 3, 4>`.
pub(super) struct Punctuated {
    /// All of it.
    pub(super) span: Range<usize>,
    /// The same for a message.
    pub(super) quoted: String,
    /// What to write.
    pub(super) help: String,
}

/// Punctuation around and between numbers, and what it is called.
const PUNCTUATION: [(&[char], &str); 4] = [
    (&['<', '>'], "angle brackets"),
    (&['(', ')'], "parentheses"),
    (&['[', ']'], "brackets"),
    (&[','], "commas"),
];

/// The numbers in a token, if there is nothing else in it but punctuation.
fn numbers_in(token: Token<'_>) -> Option<Vec<&str>> {
    let text = std::str::from_utf8(token.text)
        .ok()
        .filter(|_| token.is_word())?;
    let is_punctuation = |c| PUNCTUATION.iter().any(|(marks, _)| marks.contains(&c));
    let numbers = text.split(is_punctuation).filter(|part| !part.is_empty());
    numbers
        .map(|part| {
            number::parse_number(part.as_bytes())
                .is_ok()
                .then_some(part)
        })
        .collect()
}

/// What to say where a file begins with numbers: that is how the course's scenes were written before entities had
/// names. Its numbers mean something by their order alone, so nothing else is said of it.
pub(super) fn older_language(text: &[u8]) -> Option<Diagnostic> {
    let mut lexer = Lexer::new(text);
    let [first, second] = [lexer.token(), lexer.token()];
    let is_number = |token: Token<'_>| token.is_word() && number::parse_number(token.text).is_ok();
    let is_older = is_number(first) && (is_number(second) || !text.contains(&b'{'));
    let message = "this looks like the course's older language, without names: plumb reads the one with names";
    let example: Vec<&str> = EXAMPLE
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .take(EXAMPLE_LINES)
        .collect();
    let help = format!(
        "a scene begins like this one, scenes/notes/walls.txt:\n{}",
        example.join("\n")
    );
    is_older.then(|| Diagnostic::new(first.span(), message).help(help))
}

/// The notes' first example, and how many of its lines show what the language looks like.
const EXAMPLE: &str = include_str!("../../scenes/notes/walls.txt");
const EXAMPLE_LINES: usize = 10;

impl Parser<'_> {
    /// Takes numbers with punctuation around or between them, if that is what comes next. `count` is how many numbers
    /// the attribute takes at most: with commas alone so many have to be there, since a comma may be meant as a point.
    pub(super) fn punctuated_numbers(&mut self, count: usize) -> Option<Punctuated> {
        let bracket = matches!(self.window[0].text, [b'<' | b'(' | b'[', ..]);
        let comma = |token: &Token<'_>| token.text.contains(&b',');
        if !bracket && !self.window.iter().any(comma) {
            return None;
        }
        let closes = |token: &Token<'_>| token.text.iter().any(|byte| b">)]".contains(byte));
        let mut numbers = Vec::new();
        let mut tokens = Vec::new();
        for token in self.ahead() {
            let Some(mut found) = numbers_in(token) else {
                break;
            };
            numbers.append(&mut found);
            tokens.push(token);
            if closes(&token) || tokens.len() > MAX_VECTOR {
                break;
            }
        }
        let span = tokens.first()?.start..tokens.last()?.end();
        let all = &self.text[span.clone()];
        let commas = numbers.len() == count && all.contains(&b',');
        if numbers.len() < 2 || !(bracket || commas) {
            return None;
        }
        let all = String::from_utf8_lossy(all);
        let marks: Vec<&str> = PUNCTUATION
            .iter()
            .filter(|(marks, _)| all.contains(*marks))
            .map(|(_, name)| *name)
            .collect();
        let help = format!("no {}: write `{}`", marks.join(" or "), numbers.join(" "));
        let quoted = crate::diagnostic::quote(all.as_bytes());
        tokens.iter().for_each(|_| {
            self.bump();
        });
        Some(Punctuated { span, quoted, help })
    }

    /// Skips what is left of a comment of another language, behind its first token; inside a block no brace of it.
    pub(super) fn skip_comment(&mut self, first: Token<'_>, in_block: bool) {
        let long = first.text.starts_with(b"/*");
        let mut last = first.text;
        loop {
            let next = self.window[0].kind;
            let ends = if long {
                last.ends_with(b"*/")
            } else {
                self.starts_line()
            };
            if ends || next == TokenKind::End || (in_block && next != TokenKind::Word) {
                return;
            }
            last = self.bump().text;
            if next == TokenKind::Open {
                self.skip_block();
            }
        }
    }
}

//! What the parser knows while it reads: the tokens in view, and what was read so far. [`parse`](super::parse) takes it
//! through a text, and what is read, skipped and checked on the way is in `values`, `recover` and `check`.

use std::iter;
use std::ops::Range;
use std::path::Path;

use super::draft::{Assembly, Draft};
use super::errors::Errors;
use super::lex::{Lexer, Token, TokenKind};
use super::names::Names;
use super::number::looks_numeric;
use super::table::{self, Entity, MAX_ROWS};
use super::texture::Pictures;

/// The parser: three tokens in view, and what was read so far.
pub(super) struct Parser<'t> {
    pub(super) text: &'t [u8],
    pub(super) lexer: Lexer<'t>,
    /// The next three tokens.
    pub(super) window: [Token<'t>; 3],
    /// The end of the last token that was read.
    pub(super) last_end: usize,
    pub(super) errors: Errors,
    pub(super) assembly: Assembly,
    pub(super) materials: Names<'t>,
    pub(super) textures: Names<'t>,
    /// Where the first camera is, or something that was meant to be one.
    pub(super) camera: Option<Range<usize>>,
    /// Pictures read so far, and the folder that their names start from; without one they are not read.
    pub(super) pictures: Pictures,
    pub(super) folder: Option<&'t Path>,
}

/// An entity while its block is read.
pub(super) struct Block {
    pub(super) entity: &'static Entity,
    pub(super) draft: Draft,
    /// For each row where it was given.
    pub(super) given: [Option<Range<usize>>; MAX_ROWS],
    /// For each row: was it given, and is it right?
    pub(super) good: [bool; MAX_ROWS],
    /// The first complaint about an attribute that resembles none.
    pub(super) stranger: Option<usize>,
    /// In which way it is spelt, and by which attribute that is known.
    pub(super) way: Option<(usize, Range<usize>)>,
}

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t [u8], folder: Option<&'t Path>) -> Self {
        let mut lexer = Lexer::new(text);
        let window = [lexer.token(), lexer.token(), lexer.token()];
        Self {
            text,
            lexer,
            window,
            last_end: 0,
            errors: Errors::default(),
            assembly: Assembly::default(),
            materials: Names::new("material"),
            textures: Names::new("texture"),
            camera: None,
            pictures: Pictures::default(),
            folder,
        }
    }

    /// Takes the next token.
    pub(super) fn bump(&mut self) -> Token<'t> {
        let token = self.window[0];
        self.window = [self.window[1], self.window[2], self.lexer.token()];
        self.last_end = token.end();
        token
    }

    /// The tokens to come, without taking them.
    pub(super) fn ahead(&self) -> impl Iterator<Item = Token<'t>> + use<'t> {
        let mut lexer = self.lexer.clone();
        self.window
            .into_iter()
            .chain(iter::repeat_with(move || lexer.token()))
    }

    /// Does an entity start here? `inside` is the entity whose block this is in: a word may be its attribute.
    pub(super) fn starts_entity(&self, inside: Option<&Entity>) -> bool {
        let [first, second, third] = &self.window;
        if !first.is_word() || looks_numeric(first.text) {
            return false;
        }
        let named = second.is_word() && third.kind == TokenKind::Open;
        match table::find(first.text) {
            Some(entity) => {
                let headless =
                    second.is_word() && third.is_word() && entity.row(third.text).is_some();
                named || headless || second.kind == TokenKind::Open
            }
            None => {
                let is_attribute = inside.is_some_and(|entity| entity.row(first.text).is_some());
                named && !is_attribute && !looks_numeric(second.text)
            }
        }
    }
}

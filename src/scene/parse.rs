//! Tokens to a [`Scene`]: entities and their blocks. What is inside a block is read in [`values`](super::values), what
//! is not understood is skipped in [`recover`](super::recover), and a whole entity is checked in
//! [`check`](super::check).
//!
//! Every mistake of a file is reported in one run, and one mistake once: what was not understood is skipped up to
//! where an entity or an attribute begins again, a missing brace is seen by what follows it, and what depends on
//! something misunderstood is not complained about.

use std::path::Path;

use super::bulk::{Reader, Starts};
use super::common_mistakes;
use super::draft::Draft;
use super::encoding;
use super::kind::EntityKind;
use super::lex::{Lexer, Token, TokenKind};
use super::model::Scene;
use super::number::looks_numeric;
use super::parser::{Block, Parser};
use super::table::{self, Entity, MAX_ROWS};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Reads a scene from its text.
///
/// `name` is what diagnostics call the text (a path, or `<stdin>`); the file names of textures start at `folder`.
///
/// # Errors
/// Everything that is wrong with the scene, in the order of the text.
pub fn parse(name: &str, bytes: &[u8], folder: &Path) -> Result<Scene, Diagnostics> {
    read(name, bytes, Some(folder), Starts::of(bytes))
}

/// Reads a scene but for the pictures of its textures, which stay empty: for who asks about the text alone.
///
/// # Errors
/// As [`parse`], but for textures.
pub(crate) fn parse_text(name: &str, bytes: &[u8]) -> Result<Scene, Diagnostics> {
    read(name, bytes, None, Starts::of(bytes))
}

/// Reads a scene; where `starts` are known, many objects at once.
fn read(
    name: &str,
    bytes: &[u8],
    folder: Option<&Path>,
    starts: Starts,
) -> Result<Scene, Diagnostics> {
    if let Some(error) = encoding::not_a_scene(bytes) {
        return Err(Diagnostics::new(name, bytes, vec![error], 1));
    }
    if let Some(error) = common_mistakes::older_language(bytes) {
        return Err(Diagnostics::new(name, bytes, vec![error], 1));
    }
    let mut parser = Parser::new(bytes, folder);
    let mut is_text = true;
    if let Some(error) = encoding::not_utf8(bytes) {
        parser.errors.report(error);
        // Bytes that do not even begin like a scene get no further complaints.
        is_text = table::find(parser.window[0].text).is_some();
    }
    if is_text {
        parser.file(starts);
        parser.end_of_file();
    }
    let Parser {
        errors, assembly, ..
    } = parser;
    let complete = errors.is_empty();
    let (list, total) = errors.into_parts();
    match assembly.finish() {
        Some(scene) if complete => Ok(scene),
        _ => Err(Diagnostics::new(name, bytes, list, total)),
    }
}

impl<'t> Parser<'t> {
    fn file(&mut self, mut starts: Starts) {
        while !self.errors.are_too_many() {
            self.objects(&mut starts);
            let token = self.window[0];
            match token.kind {
                TokenKind::End => return,
                TokenKind::Word => self.entity(),
                TokenKind::Close => {
                    self.bump();
                    let error =
                        Diagnostic::new(token.span(), "`}` closes nothing: no block is open here");
                    self.errors.report(
                        error.help("remove it, or see whether a block before it ends too early"),
                    );
                }
                TokenKind::Open => {
                    self.bump();
                    let error = Diagnostic::new(token.span(), "`{` opens a block of no entity");
                    self.errors
                        .report(error.help("an entity is written `type name { attributes }`"));
                    self.skip_block();
                }
            }
        }
    }

    /// Takes the objects that come next, if they are many and there is nothing to say about them; but for the last one,
    /// so that what follows it is looked at here.
    fn objects(&mut self, starts: &mut Starts) {
        let parallel = starts.is_parallel();
        if let Some(objects) = starts.objects_from(self.window[0].start)
            && let Some(last) = objects.last()
            && self.errors.is_empty()
        {
            let reader = Reader::new(self.text, &self.materials, &self.textures, parallel);
            if reader.read(objects, &mut self.assembly.objects) {
                self.lexer = Lexer::at(self.text, *last as usize);
                self.window = std::array::from_fn(|_| self.lexer.token());
            }
        }
    }

    fn entity(&mut self) {
        let head = self.bump();
        match table::find(head.text) {
            Some(entity) => self.known_entity(entity, head),
            None => self.unknown_entity(head),
        }
    }

    fn known_entity(&mut self, entity: &'static Entity, head: Token<'t>) {
        let [first, second, third] = self.window;
        let is_row = |token: Token<'_>| token.is_word() && entity.row(token.text).is_some();
        let wrong = |token: Token<'t>, message: String| {
            Diagnostic::new(token.span(), message)
                .help("an entity is written `type name { attributes }`")
        };
        let kind = entity.name;
        let mut name = Some(first);
        if first.kind == TokenKind::Open {
            self.errors.report(
                wrong(first, format!("this `{kind}` has no name"))
                    .label("expected a name before it"),
            );
            name = None;
        } else if first.is_word() && second.kind == TokenKind::Open {
            self.bump();
        } else if is_row(first) && second.is_word() && (looks_numeric(second.text) || is_row(third))
        {
            let error = wrong(first, format!("this `{kind}` has no name and no `{{`"));
            self.errors
                .report(error.label("expected a name and `{` before it"));
            return self.block(entity, head, None);
        } else if first.is_word() && is_row(second) {
            let error = wrong(
                second,
                format!("missing `{{` after `{kind}` {}", first.quoted()),
            );
            self.errors.report(error.label("expected `{` before it"));
            self.bump();
            return self.block(entity, head, name);
        } else if first.is_word()
            && second.is_word()
            && third.kind == TokenKind::Open
            && !self.meets_entity()
        {
            let error = Diagnostic::new(second.span(), "a name is one word")
                .label("expected `{`, found another word");
            let glued = [first.text, b"_", second.text].concat();
            self.errors
                .report(error.help(format!("perhaps {}", crate::diagnostic::quote(&glued))));
            self.excuse(first);
            self.excuse(second);
            self.bump();
            self.bump();
        } else {
            return self.headless(entity, head);
        }
        self.bump();
        self.block(entity, head, name);
    }

    /// Does an entity begin with one of the next two tokens, by its type?
    fn meets_entity(&self) -> bool {
        let [first, second, third] = &self.window;
        table::find(first.text).is_some() || (table::find(second.text).is_some() && third.is_word())
    }

    /// Is the next token a `}` that is followed by an attribute that the block lacks?
    fn closes_early(&self, block: &Block) -> bool {
        let [_, key, value] = &self.window;
        let lacks = block
            .entity
            .row(key.text)
            .is_some_and(|(index, _)| block.given[index].is_none());
        let starts_entity = table::find(key.text).is_some();
        key.is_word() && value.is_word() && lacks && !starts_entity
    }

    /// Reads a block behind its `{`.
    fn block(&mut self, entity: &'static Entity, head: Token<'t>, name: Option<Token<'t>>) {
        let text = name.map_or_else(String::new, |name| {
            String::from_utf8_lossy(name.text).into_owned()
        });
        let title = head.start..name.map_or(head.end(), |name| name.end());
        let draft = Draft {
            name: text,
            ..Draft::default()
        };
        let mut block = Block {
            entity,
            draft,
            given: [const { None }; MAX_ROWS],
            good: [false; MAX_ROWS],
            stranger: None,
            way: None,
        };
        let mut extra = 0;
        let closed = loop {
            let token = self.window[0];
            match token.kind {
                _ if self.errors.are_too_many() => return,
                TokenKind::End => break false,
                TokenKind::Close if self.closes_early(&block) => {
                    self.bump();
                    let message =
                        format!("`}}` ends the block of this `{}` too early", entity.name);
                    self.errors
                        .report(Diagnostic::new(token.span(), message).help("remove it"));
                }
                TokenKind::Close => {
                    self.bump();
                    // If there are as many `}` as stray `{`, the last `}` ends the block.
                    if extra == 0
                        || self.window[0].kind == TokenKind::End
                        || self.starts_entity(None)
                    {
                        break true;
                    }
                    extra -= 1;
                }
                TokenKind::Open => {
                    self.bump();
                    extra += 1;
                    let message =
                        format!("`{{` cannot stand inside the block of a `{}`", entity.name);
                    self.errors
                        .report(Diagnostic::new(token.span(), message).help("remove it"));
                }
                TokenKind::Word if self.starts_entity(Some(entity)) => break false,
                TokenKind::Word => self.attribute(&mut block),
            }
        };
        if closed {
            self.check_complete(&block, &title);
        } else {
            self.report_open_block(entity, &title);
        }
        self.check_relation(&block);
        match entity.kind {
            EntityKind::Camera => self.check_first_camera(&title),
            EntityKind::Material => self.materials.define(name),
            EntityKind::Texture => self.textures.define(name),
            EntityKind::Object(_) | EntityKind::Light(_) => {}
        }
        self.assembly.add(entity.kind, block.draft);
    }

    fn end_of_file(&mut self) {
        let (materials, textures) = (&self.materials, &self.textures);
        materials.complain(&mut self.errors);
        textures.complain(&mut self.errors);
        if self.camera.is_some() || self.errors.are_too_many() {
            return;
        }
        let end = self
            .text
            .iter()
            .rposition(|byte| !super::bytes::is_space(*byte))
            .map_or(0, |last| last + 1);
        let empty = self.last_end == 0;
        let message = if empty {
            "this scene is empty: it has no camera"
        } else {
            "this scene has no camera"
        };
        let help = "a scene needs `camera name { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }`, for example";
        self.errors
            .report(Diagnostic::new(end..end, message).help(help));
    }
}

#[cfg(test)]
mod tests;

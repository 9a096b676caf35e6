//! What the parser (text → lex → parse → [`Scene`](super::Scene)) does where an entity is not understood: says so
//! once, and skips to where one may begin.

use super::common_mistakes;
use super::kind::EntityKind;
use super::lex::{Token, TokenKind};
use super::names::nearest;
use super::parser::Parser;
use super::table::{self, ENTITIES, Entity, UNSUPPORTED};
use crate::diagnostic::Diagnostic;

impl<'t> Parser<'t> {
    pub(super) fn unknown_entity(&mut self, head: Token<'t>) {
        let word = head.quoted();
        if common_mistakes::is_comment(head.text) {
            let error = Diagnostic::new(head.span(), format!("there is no entity {word}"));
            self.errors
                .report(error.help(common_mistakes::COMMENT_HELP));
            self.skip_comment(head, false);
            return;
        }
        if let Some(error) = common_mistakes::strange_space_error(head) {
            self.errors.report(error);
            for word in common_mistakes::words_of(head) {
                self.excuse(word);
                if table::find(word.text).is_some_and(|entity| entity.kind == EntityKind::Camera) {
                    self.camera.get_or_insert(word.span());
                }
            }
            self.skip_unknown(head);
            return;
        }
        let meant = nearest(
            head.text,
            ENTITIES.iter().map(|entity| entity.name.as_bytes()),
        )
        .and_then(table::find);
        let unsupported = UNSUPPORTED.iter().any(|name| name.as_bytes() == head.text);
        let all = || {
            ENTITIES
                .iter()
                .map(|entity| entity.name)
                .collect::<Vec<_>>()
                .join(", ")
        };
        let has_block =
            self.window[0].kind == TokenKind::Open || self.window[1].kind == TokenKind::Open;
        let stray_attribute = ENTITIES
            .iter()
            .find(|entity| entity.row(head.text).is_some());
        let error = match (meant, stray_attribute) {
            _ if unsupported => Diagnostic::new(head.span(), format!("{word} is not supported"))
                .help(format!("the entities are {}", all())),
            (Some(meant), _) => Diagnostic::new(head.span(), format!("there is no entity {word}"))
                .help(format!("did you mean `{}`?", meant.name)),
            (None, Some(_)) if !has_block => {
                Diagnostic::new(head.span(), format!("attribute {word} is in no block"))
                    .help("attributes stand between the `{` and `}` of an entity")
            }
            _ => Diagnostic::new(head.span(), format!("there is no entity {word}"))
                .help(format!("the entities are {}", all())),
        };
        self.errors.report(error);
        if meant.is_some_and(|meant| meant.kind == EntityKind::Camera) {
            self.camera.get_or_insert(head.span());
        }
        self.skip_unknown(head);
    }

    /// Skips the name and the block of an entity that was not understood.
    fn skip_unknown(&mut self, head: Token<'t>) {
        let [first, second, _] = self.window;
        if first.kind == TokenKind::Open {
            // This word may be the name, and the type is missing.
            self.excuse(head);
        }
        if first.is_word() && second.kind == TokenKind::Open {
            self.excuse(first);
            self.bump();
        }
        if self.window[0].kind == TokenKind::Open {
            self.bump();
            self.skip_block();
        } else {
            self.skip_junk();
        }
    }

    /// Something of this name was not understood: no complaint when it is referred to.
    pub(super) fn excuse(&mut self, name: Token<'t>) {
        self.materials.excuse(name);
        self.textures.excuse(name);
    }

    /// An entity type that is followed by nothing that looks like its block.
    pub(super) fn headless(&mut self, entity: &'static Entity, head: Token<'t>) {
        let mut place = self.window[0];
        let named = place.is_word() && !self.starts_entity(None);
        if named {
            self.bump();
            self.excuse(place);
            place = self.window[0];
        }
        let expected = if named { "`{`" } else { "a name" };
        let found = place.quoted();
        let span = if place.kind == TokenKind::End {
            self.last_end..self.last_end
        } else {
            place.span()
        };
        let error = Diagnostic::new(
            span,
            format!("expected {expected} after `{}`, found {found}", entity.name),
        );
        let error = error.also(head.span(), "this entity");
        self.errors
            .report(error.help("an entity is written `type name { attributes }`"));
        if entity.kind == EntityKind::Camera {
            self.camera.get_or_insert(head.span());
        }
        self.skip_junk();
    }

    /// Skips to where an entity may start; takes the end of a block with it.
    pub(super) fn skip_junk(&mut self) {
        while self.window[0].kind != TokenKind::End && !self.starts_entity(None) {
            match self.bump().kind {
                TokenKind::Close => return,
                TokenKind::Open => return self.skip_block(),
                TokenKind::Word | TokenKind::End => {}
            }
        }
    }

    /// Skips to the end of a block, or to where an entity starts in it.
    pub(super) fn skip_block(&mut self) {
        let mut depth = 1;
        while depth > 0 && self.window[0].kind != TokenKind::End {
            if self.starts_entity(None) && table::find(self.window[0].text).is_some() {
                return;
            }
            match self.bump().kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth -= 1,
                TokenKind::Word | TokenKind::End => {}
            }
        }
    }
}

//! The attributes inside a block: looks their rows up in the `table`, reads their values, checks limits.
//!
//! The inner half of the parser, text → lex → parse → [`Scene`](super::Scene).

use super::common_mistakes;
use super::draft::TexturePicture;
use super::lex::{Lexer, Token};
use super::names::nearest;
use super::number::looks_numeric;
use super::parser::{Block, Parser};
use super::table::{Attribute, ENTITIES, Entity, Take};
use crate::diagnostic::Diagnostic;

/// More than a right block has of an entity whose attributes are spelt in several ways.
const MOST_TOKENS: usize = 64;

impl<'t> Parser<'t> {
    /// Reads an attribute and its values.
    pub(super) fn attribute(&mut self, block: &mut Block) {
        let key = self.bump();
        let (index, row) = match self.known_attribute(block, key) {
            Some(found) => {
                if let Some(first) = &block.given[found.0] {
                    let error =
                        Diagnostic::new(key.span(), format!("{} is given twice", key.quoted()));
                    self.errors.report(
                        error
                            .also(first.clone(), "first given here")
                            .help("remove one of them"),
                    );
                    // Its values are read and forgotten, but what is wrong with them is said.
                    let mut again = Block {
                        draft: block.draft.clone(),
                        given: block.given.clone(),
                        way: block.way.clone(),
                        ..*block
                    };
                    self.values(&mut again, found.0, found.1, key);
                    return;
                }
                found
            }
            None => match self.unknown_attribute(block, key) {
                Some(found) => found,
                None => return,
            },
        };
        let given = block.given[index].is_some();
        self.values(block, index, row, key);
        if !given {
            block.given[index] = Some(key.start..self.last_end);
        }
    }

    /// The row of an attribute, if the entity has it. Complains where it is spelt in another way than those before it.
    fn known_attribute(
        &mut self,
        block: &mut Block,
        key: Token<'t>,
    ) -> Option<(usize, &'static Attribute)> {
        let entity = block.entity;
        let mut way = block.way.as_ref().map(|(way, _)| *way);
        if way.is_none() && entity.spelt(key.text).nth(1).is_some() {
            let ahead = keys_ahead(self.text, self.window[0].start);
            way = entity.way_of(ahead.into_iter());
        }
        let (index, row, own) = entity.spelt_in(way, key.text)?;
        // What is given twice is told as that.
        if row.other_names.is_empty() || block.given[index].is_some() {
            return Some((index, row));
        }
        match &block.way {
            Some((way, first)) if *way != own => {
                let other = String::from_utf8_lossy(&self.text[first.clone()]).into_owned();
                let message = format!(
                    "{} beside `{other}`: an entity is spelt in one way",
                    key.quoted()
                );
                let help = row.spelling(*way).map(|name| format!("write `{name}`"));
                let error = Diagnostic::new(key.span(), message);
                let error = error.also(first.clone(), "spelt in another way here");
                self.errors.report(match help {
                    Some(help) => error.help(help),
                    None => error,
                });
            }
            Some(_) => {}
            None => block.way = Some((own, key.span())),
        }
        Some((index, row))
    }

    /// Complains about an attribute that the entity does not have; returns what it was meant to be, if that is plain.
    fn unknown_attribute(
        &mut self,
        block: &mut Block,
        key: Token<'t>,
    ) -> Option<(usize, &'static Attribute)> {
        let entity = block.entity;
        let word = key.quoted();
        if let Some(error) = common_mistakes::strange_space_error(key) {
            self.errors.report(error);
            return self.spaced_attribute(block, key);
        }
        let meant = meant_row(entity, key.text);
        if looks_numeric(key.text) {
            let message = format!(
                "expected an attribute of this `{}`, found {word}",
                entity.name
            );
            self.errors
                .report(Diagnostic::new(key.span(), message).help(attributes_of(entity)));
            self.skip_numbers();
            return None;
        }
        if common_mistakes::is_comment(key.text) {
            let message = format!("`{}` has no attribute {word}", entity.name);
            self.errors
                .report(Diagnostic::new(key.span(), message).help(common_mistakes::COMMENT_HELP));
            self.skip_comment(key, true);
            return None;
        }
        let owners: Vec<_> = ENTITIES
            .iter()
            .filter(|other| other.row(key.text).is_some())
            .map(|e| e.name)
            .collect();
        let error = Diagnostic::new(
            key.span(),
            format!("`{}` has no attribute {word}", entity.name),
        );
        let place = self.errors.report(match meant {
            Some((_, row)) => error.help(format!("did you mean `{}`?", row.name)),
            None if owners.is_empty() => {
                error.help(colours_of(entity, key.text).unwrap_or_else(|| attributes_of(entity)))
            }
            None => error.help(format!(
                "{word} belongs to {}; {}",
                owners.join(", "),
                attributes_of(entity)
            )),
        });
        if meant.is_none() {
            block.stranger.get_or_insert(place);
            self.skip_strange_values(entity);
        }
        meant
    }

    /// Goes on behind an attribute with a space in it that is not ASCII's, which was said: returns its row where
    /// nothing else is in the token, otherwise skips its values.
    fn spaced_attribute(
        &mut self,
        block: &mut Block,
        key: Token<'t>,
    ) -> Option<(usize, &'static Attribute)> {
        let mut words = common_mistakes::words_of(key);
        let found = block.entity.row(words.next()?.text);
        if found.is_some_and(|(index, _)| block.given[index].is_none()) && words.next().is_none() {
            return found;
        }
        give_rows_in(block, key);
        self.skip_numbers();
        None
    }

    fn skip_numbers(&mut self) {
        while self.window[0].is_word() && looks_numeric(self.window[0].text) {
            self.bump();
        }
    }

    /// Skips the values of an attribute that resembles none: numbers, or one word that is no attribute.
    fn skip_strange_values(&mut self, entity: &'static Entity) {
        let start = self.last_end;
        self.skip_numbers();
        if self.last_end == start && self.is_value_word(entity) {
            self.bump();
        }
    }

    /// Is the next token a word that is no attribute, nor was meant as one, nor starts an entity?
    fn is_value_word(&self, entity: &'static Entity) -> bool {
        let [first, second, _] = &self.window;
        let starts_attribute =
            second.is_word() && looks_numeric(second.text) && !looks_numeric(first.text);
        first.is_word()
            && !starts_attribute
            && !common_mistakes::is_comment(first.text)
            && entity.row(first.text).is_none()
            && meant_row(entity, first.text).is_none()
            && !self.starts_entity(Some(entity))
    }

    /// Does the next token, a word, look like the next attribute, or the next entity? It does when it resembles one, or
    /// starts a line and is followed by a number.
    pub(super) fn may_be_attribute(&self, entity: &'static Entity) -> bool {
        let [first, second, _] = &self.window;
        meant_row(entity, first.text).is_some()
            || self.starts_entity(Some(entity))
            || (self.starts_line() && second.is_word() && looks_numeric(second.text))
    }

    /// Is the next token the first of its line?
    pub(super) fn starts_line(&self) -> bool {
        self.text[self.last_end..self.window[0].start]
            .iter()
            .any(|byte| matches!(byte, b'\n' | b'\r'))
    }

    /// Reads the values of a row into the draft.
    fn values(&mut self, block: &mut Block, index: usize, row: &'static Attribute, key: Token<'t>) {
        self.skip_sign(block.entity, row);
        block.good[index] = match row.take {
            Take::Numbers(count, field) => {
                self.numbers(block, row, key, count..count + 1, false, field)
            }
            Take::Integers(count, field) => {
                self.numbers(block, row, key, count..count + 1, true, field)
            }
            Take::OneOrThree(field) => self.numbers(block, row, key, 1..4, false, field),
            Take::Material(_) | Take::Texture(_) | Take::Picture => {
                match self.name(block.entity, row, key) {
                    Some(token) => self.refer(block, row, token),
                    None => false,
                }
            }
        };
    }

    /// Complains about a sign between an attribute and its values, and skips it. A name may be such a sign too: then
    /// no other follows.
    fn skip_sign(&mut self, entity: &'static Entity, row: &Attribute) {
        let [sign, value, _] = self.window;
        let is_name = matches!(
            row.take,
            Take::Material(_) | Take::Texture(_) | Take::Picture
        );
        let is_followed = value.is_word() && entity.row(value.text).is_none();
        if matches!(sign.text, b"=" | b":") && (is_followed || !is_name) {
            let message = format!("{} cannot stand behind `{}`", sign.quoted(), row.name);
            self.errors
                .report(Diagnostic::new(sign.span(), message).help("remove it"));
            self.bump();
        }
    }

    /// Looks a name up that an attribute gives.
    fn refer(&mut self, block: &mut Block, row: &'static Attribute, token: Token<'t>) -> bool {
        let found = match row.take {
            Take::Material(index) => self
                .materials
                .find(token, &mut self.errors)
                .map(|found| (index, found)),
            Take::Texture(index) => self
                .textures
                .find(token, &mut self.errors)
                .map(|found| (index, found)),
            Take::Numbers(..) | Take::Integers(..) | Take::OneOrThree(_) | Take::Picture => {
                return self.picture(block, token);
            }
        };
        if let Some((index, found)) = found {
            *index(&mut block.draft) = found;
        }
        found.is_some()
    }

    fn picture(&mut self, block: &mut Block, token: Token<'t>) -> bool {
        // Bytes that are not UTF-8 were complained about.
        let Ok(filename) = std::str::from_utf8(token.text) else {
            return false;
        };
        let read = match self.folder {
            Some(folder) => self.pictures.read(folder, filename),
            None => Ok(TexturePicture::unread(filename)),
        };
        match read {
            Ok(picture) => block.draft.picture = Some(picture),
            Err(why) => {
                let mut error = Diagnostic::new(
                    token.span(),
                    format!("texture {}: {}", token.quoted(), why.message),
                );
                if let Some(help) = why.help {
                    error = error.help(help);
                }
                self.errors.report(error);
            }
        }
        block.draft.picture.is_some()
    }

    /// Reads the one name that an attribute takes.
    fn name(
        &mut self,
        entity: &'static Entity,
        row: &Attribute,
        key: Token<'t>,
    ) -> Option<Token<'t>> {
        let [first, second, _] = self.window;
        let next_attribute =
            entity.row(first.text).is_some() && second.is_word() && looks_numeric(second.text);
        if !first.is_word() || next_attribute || self.starts_entity(Some(entity)) {
            let what = if matches!(row.take, Take::Picture) {
                "a file name"
            } else {
                "a name"
            };
            self.errors.report(Diagnostic::new(
                key.span(),
                format!("`{}` takes {what}, found none", row.name),
            ));
            return None;
        }
        self.bump();
        let extra = self.window[0];
        while self.is_value_word(entity) {
            self.bump();
        }
        if self.last_end > extra.start {
            let error = Diagnostic::new(
                extra.start..self.last_end,
                format!("`{}` takes one name", row.name),
            );
            self.errors.report(
                error
                    .label("more than one word")
                    .help("names hold no white space"),
            );
            return None;
        }
        Some(first)
    }
}

/// The attributes in the rest of the block that goes on at this byte, as far as their spelling can matter.
pub(super) fn keys_ahead(text: &[u8], at: usize) -> Vec<&[u8]> {
    let mut lexer = Lexer::at(text, at);
    let mut keys = Vec::new();
    let mut token = lexer.token();
    for _ in 0..MOST_TOKENS {
        if !token.is_word() {
            break;
        }
        let next = lexer.token();
        // A name may be any word, and an attribute's own name follows it.
        if next.is_word() && looks_numeric(next.text) && !looks_numeric(token.text) {
            keys.push(token.text);
        }
        token = next;
    }
    keys
}

/// The row that a misspelt attribute means.
fn meant_row(entity: &'static Entity, word: &[u8]) -> Option<(usize, &'static Attribute)> {
    nearest(word, entity.rows().map(|row| row.name.as_bytes())).and_then(|name| entity.row(name))
}

/// Notes the attributes that were meant in a token with spaces that are not ASCII's: they are not missing.
pub(super) fn give_rows_in(block: &mut Block, token: Token<'_>) {
    for word in common_mistakes::words_of(token) {
        if let Some((index, _)) = block.entity.row(word.text) {
            block.given[index].get_or_insert(word.span());
        }
    }
}

/// What to write for a word that means colour.
fn colours_of(entity: &Entity, word: &[u8]) -> Option<String> {
    if !word.eq_ignore_ascii_case(b"color") && !word.eq_ignore_ascii_case(b"colour") {
        return None;
    }
    let names: Vec<_> = entity
        .rows()
        .filter(|row| row.is_colour())
        .map(|row| format!("`{}`", row.name))
        .collect();
    match &names[..] {
        [] => None,
        [one] => Some(format!("colour is {one}: red, green, blue")),
        _ => Some(format!(
            "colour is {}, each red, green, blue",
            names.join(" and ")
        )),
    }
}

fn attributes_of(entity: &Entity) -> String {
    let names: Vec<_> = entity.rows().map(|row| format!("`{}`", row.name)).collect();
    format!("`{}` has {}", entity.name, names.join(", "))
}

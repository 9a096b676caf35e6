//! The attributes inside a block: looks their rows up in the `table`, reads their values, checks limits.
//!
//! The inner half of the parser, text → lex → parse → [`Scene`](super::Scene).

use std::ops::Range;

use super::draft::Picture;
use super::lex::{Kind as Lexeme, Token};
use super::names::nearest;
use super::number::{self, NumberError, looks_numeric};
use super::parse::{Block, Parser};
use super::slips;
use super::table::{Attribute, ENTITIES, Entity, Take};
use crate::diagnostic::Diagnostic;

/// Numbers as they are read: their values, their tokens, and whether all was well.
struct Numbers<'t> {
    values: [f64; 3],
    tokens: Vec<Token<'t>>,
    good: bool,
}

impl<'t> Parser<'t> {
    /// Reads an attribute and its values.
    pub(super) fn attribute(&mut self, block: &mut Block) {
        let entity = block.entity;
        let key = self.bump();
        let (index, row) = match entity.row(key.text) {
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

    /// Complains about an attribute that the entity does not have; returns what it was meant to be, if that is plain.
    fn unknown_attribute(
        &mut self,
        block: &mut Block,
        key: Token<'t>,
    ) -> Option<(usize, &'static Attribute)> {
        let entity = block.entity;
        let word = key.quoted();
        if let Some(error) = slips::strange_space_error(key) {
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
        if slips::is_comment(key.text) {
            let message = format!("`{}` has no attribute {word}", entity.name);
            self.errors
                .report(Diagnostic::new(key.span(), message).help(slips::COMMENT_HELP));
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
        let mut words = slips::words_of(key);
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
            && !slips::is_comment(first.text)
            && entity.row(first.text).is_none()
            && meant_row(entity, first.text).is_none()
            && !self.starts_entity(Some(entity))
    }

    /// Does the next token, a word, look like the next attribute, or the next entity? It does when it resembles one, or
    /// starts a line and is followed by a number.
    fn may_be_attribute(&self, entity: &'static Entity) -> bool {
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
        block.good[index] = match row.take {
            Take::Numbers(count, field) => {
                self.numbers(block, row, key, count..count + 1, false, field)
            }
            Take::Integers(count, field) => {
                self.numbers(block, row, key, count..count + 1, true, field)
            }
            Take::Spread(field) => self.numbers(block, row, key, 1..4, false, field),
            Take::Material(_) | Take::Texture(_) | Take::Picture => {
                match self.name(block.entity, row, key) {
                    Some(token) => self.refer(block, row, token),
                    None => false,
                }
            }
        };
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
            Take::Numbers(..) | Take::Integers(..) | Take::Spread(_) | Take::Picture => {
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
            None => Ok(Picture::unread(filename)),
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

    /// Reads numbers, checks how many and whether they keep the row's limit, and puts them where they go.
    fn numbers(
        &mut self,
        block: &mut Block,
        row: &'static Attribute,
        key: Token<'t>,
        counts: Range<usize>,
        whole: bool,
        field: super::table::Field,
    ) -> bool {
        let mut numbers = Numbers {
            values: [0.0; 3],
            tokens: Vec::with_capacity(3),
            good: true,
        };
        let max = counts.end - 1;
        let mut extra = 0;
        let mut extra_start = 0;
        let mut spaced = false;
        while self.window[0].kind == Lexeme::Word {
            let token = self.window[0];
            let count = numbers.tokens.len();
            // A word that is no number is a wrong value while values lack, unless it may be the next attribute.
            if !looks_numeric(token.text)
                && (count >= counts.start || self.may_be_attribute(block.entity))
            {
                break;
            }
            self.bump();
            if let Some(error) = slips::strange_space_error(token) {
                self.errors.report(error);
                give_rows_in(block, token);
                spaced = true;
                continue;
            }
            if count == max {
                extra_start = if extra == 0 { token.start } else { extra_start };
                extra += 1;
                continue;
            }
            numbers.tokens.push(token);
            match read(token, whole) {
                Ok(value) => numbers.values[count] = value,
                Err(error) => {
                    self.errors.report(*error);
                    numbers.good = false;
                }
            }
        }
        // How many were meant is not known where one token held more than one.
        if spaced {
            return false;
        }
        let found = numbers.tokens.len() + extra;
        // A row of one or three numbers does not take two.
        if found != max && found != counts.start {
            let mut takes = if max == 1 {
                String::from("1 number")
            } else {
                format!("{max} numbers")
            };
            if counts.start < max {
                takes = String::from("1 or 3 numbers");
            }
            let span = if extra > 0 {
                extra_start..self.last_end
            } else {
                key.start..self.last_end
            };
            let label = if extra > 0 { "too many" } else { "too few" };
            let error =
                Diagnostic::new(span, format!("`{}` takes {takes}, found {found}", row.name));
            let error = error.label(label);
            self.errors.report(match (&numbers.tokens[..], extra) {
                ([one], 0) if row.is_colour() && numbers.good => {
                    let one = String::from_utf8_lossy(one.text);
                    error.help(format!("a colour is red, green, blue: `{one} {one} {one}`"))
                }
                (_, 0) if row.is_colour() => error.help("a colour is red, green, blue"),
                _ => error,
            });
            return false;
        }
        if !numbers.good {
            return false;
        }
        if found < max {
            numbers.values = [numbers.values[0]; 3];
        }
        let kept = self.check_limit(row, &numbers, max);
        field(&mut block.draft).copy_from_slice(&numbers.values[..max]);
        kept
    }

    fn check_limit(&mut self, row: &Attribute, numbers: &Numbers<'t>, max: usize) -> bool {
        let tokens = &numbers.tokens;
        let mut broken = row.limit.broken(&numbers.values[..max]);
        // One value that stands for three is wrong once.
        broken.retain(|index| *index < tokens.len());
        let (Some(first), Some(last)) = (broken.first(), broken.last()) else {
            return true;
        };
        let message = format!("`{}` must be {}", row.name, row.limit.wording());
        let together = broken.len() == last - first + 1;
        let error = if together {
            Diagnostic::new(tokens[*first].start..tokens[*last].end(), message)
        } else {
            Diagnostic::new(tokens[*first].span(), message)
                .also(tokens[*last].span(), "and this one")
        };
        self.errors.report(error);
        false
    }
}

/// The row that a misspelt attribute means.
fn meant_row(entity: &'static Entity, word: &[u8]) -> Option<(usize, &'static Attribute)> {
    nearest(word, entity.rows().map(|row| row.name.as_bytes())).and_then(|name| entity.row(name))
}

/// Notes the attributes that were meant in a token with spaces that are not ASCII's: they are not missing.
fn give_rows_in(block: &mut Block, token: Token<'_>) {
    for word in slips::words_of(token) {
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

/// Reads one number.
fn read(token: Token<'_>, whole: bool) -> Result<f64, Box<Diagnostic>> {
    let value = if whole {
        number::parse_integer(token.text).map(|value| value as f64)
    } else {
        number::parse_number(token.text)
    };
    if let Ok(value) = value {
        return Ok(value);
    }
    let word = token.quoted();
    let error = match number::parse_number(token.text) {
        Err(NumberError::NotFinite) => format!("{word} is not a finite number"),
        _ if whole => format!("{word} is not a whole number"),
        Err(NumberError::TooLarge) => {
            format!("{word} is too large a number: the largest is about 1.8e308")
        }
        _ => format!("{word} is not a number"),
    };
    let error = Diagnostic::new(token.span(), error);
    Err(Box::new(match slips::number_help(token.text, whole) {
        Some(help) => error.help(help),
        None => error,
    }))
}

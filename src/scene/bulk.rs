//! Many objects at once: what follows the rows of the `table` to the letter is read on all cores.
//!
//! Beside `values` in the flow text → lex → parse → [`Scene`](super::Scene), for long texts. An object here is what the
//! parser would make of it without a word; wherever the parser might have something to say nothing is read, and the
//! parser reads that object itself. So what a scene means, and every complaint, is decided there and by the rows alone:
//! this only asks less, and must never take what the parser refuses, or otherwise than it does.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::draft::Draft;
use super::kind::{Class, EntityKind};
use super::lex::{Lexer, Token, TokenKind, after_block};
use super::model::Object;
use super::names::Names;
use super::number;
use super::table::{self, Attribute, Entity, MAX_ROWS, Take};
use super::values::keys_ahead;
use crate::cores;

/// Bytes of text from which on looking for objects first is worth it.
const WORTHWHILE: usize = 1 << 15;

/// Bytes of text from which on it is worth it to ask other cores.
pub(super) const MANY: usize = 1 << 20;

/// Objects that are read together: if the parser has to read one of them, it reads all of these.
const TOGETHER: usize = 1 << 16;

/// The bit of a start that says that no object starts there.
const OTHER: u32 = 1 << 31;

/// Where the entities of a text start, in its order, as long as it has no mistakes.
#[derive(Debug, Default)]
pub(super) struct Starts {
    /// The first byte of each entity, with [`OTHER`] if it is no object.
    all: Vec<u32>,
    /// The first of them that has not been passed.
    next: usize,
    /// Whether other cores are asked.
    parallel: bool,
}

impl Starts {
    /// Looks for the entities of a text; for none where that is not worth it.
    pub(super) fn of(text: &[u8]) -> Self {
        if text.len() < WORTHWHILE || text.len() >= OTHER as usize {
            return Self::default();
        }
        Self::found(text, text.len() >= MANY && cores::are_several())
    }

    /// Finds the entities of a text, however short it is.
    pub(super) fn found(text: &[u8], parallel: bool) -> Self {
        let all = if parallel {
            // More pieces than cores, so that none waits long for the last.
            let pieces = 4 * rayon::current_num_threads();
            let cut = |piece: usize| match piece {
                0 => 0,
                _ => after_block(text, text.len() / pieces * piece),
            };
            let pieces = (0..pieces).into_par_iter().map(|piece| {
                let end = if piece + 1 == pieces {
                    text.len()
                } else {
                    cut(piece + 1)
                };
                starts(text, cut(piece), end)
            });
            pieces.collect::<Vec<_>>().concat()
        } else {
            starts(text, 0, text.len())
        };
        Self {
            all,
            next: 0,
            parallel,
        }
    }

    /// The objects from this byte on that can be read together, by where they start; what follows the last of them is
    /// an object too, and where that starts is the last number. Nothing unless there are two. They are told once: who
    /// cannot read them together reads them one by one.
    pub(super) fn objects_from(&mut self, at: usize) -> Option<&[u32]> {
        let ahead = self.all.get(self.next..)?;
        self.next += ahead
            .iter()
            .take_while(|start| ((**start & !OTHER) as usize) < at)
            .count();
        let from = self.next;
        let ahead = &self.all[from..];
        let objects = ahead
            .iter()
            .take(TOGETHER)
            .take_while(|start| **start & OTHER == 0);
        let count = objects.count();
        if count < 2 || ahead[0] as usize != at {
            return None;
        }
        self.next += count - 1;
        Some(&self.all[from..from + count])
    }

    /// Whether other cores are asked.
    pub(super) fn is_parallel(&self) -> bool {
        self.parallel
    }
}

/// Where the entities start that begin in a part of a text.
fn starts(text: &[u8], from: usize, end: usize) -> Vec<u32> {
    let mut lexer = if from == 0 {
        Lexer::new(text)
    } else {
        Lexer::at(text, from)
    };
    let mut starts = Vec::new();
    let mut last: Option<&Entity> = None;
    loop {
        let head = lexer.token();
        if head.kind == TokenKind::End || head.start >= end {
            return starts;
        }
        if last.is_none_or(|last| last.name.as_bytes() != head.text) {
            last = table::find(head.text);
        }
        let is_object = last.is_some_and(|entity| matches!(entity.kind, EntityKind::Object(_)));
        starts.push(head.start as u32 | if is_object { 0 } else { OTHER });
        if !lexer.skip_block() {
            return starts;
        }
    }
}

/// Reads objects of a text, with the names that are known where they stand.
pub(super) struct Reader<'a, 't> {
    text: &'t [u8],
    materials: &'a Names<'t>,
    textures: &'a Names<'t>,
    doubles: Vec<&'static [u8]>,
    parallel: bool,
}

impl<'a, 't> Reader<'a, 't> {
    /// Reads from this text; all that objects refer to was defined before them. `parallel` asks other cores.
    pub(super) fn new(
        text: &'t [u8],
        materials: &'a Names<'t>,
        textures: &'a Names<'t>,
        parallel: bool,
    ) -> Self {
        Self {
            text,
            materials,
            textures,
            doubles: doubles(),
            parallel,
        }
    }

    /// Reads objects, appends them and says true; or leaves the list as it was, if the parser has to read one of them.
    /// `starts` says where they are, and at last where they end.
    pub(super) fn read(&self, starts: &[u32], objects: &mut Vec<Object>) -> bool {
        let before = objects.len();
        let failed = AtomicBool::new(false);
        let object = |place: &[u32]| {
            let ends = [place[0], place[1]].map(|place| place as usize);
            self.object(ends[0], ends[1]).unwrap_or_else(|| {
                failed.store(true, Ordering::Relaxed);
                nothing()
            })
        };
        if self.parallel {
            objects.par_extend(starts.par_windows(2).map(object));
        } else {
            objects.extend(starts.windows(2).map(object));
        }
        let good = !failed.into_inner();
        if !good {
            objects.truncate(before);
        }
        good
    }

    /// Reads the object between these bytes, behind which another one starts.
    fn object(&self, start: usize, end: usize) -> Option<Object> {
        let mut lexer = Lexer::at(self.text, start);
        let entity = table::find(lexer.token().text)?;
        let EntityKind::Object(class) = entity.kind else {
            return None;
        };
        let (name, open) = (lexer.token(), lexer.token());
        if !name.is_word() || open.kind != TokenKind::Open {
            return None;
        }
        let mut draft = Draft {
            name: String::from_utf8_lossy(name.text).into_owned(),
            ..Draft::default()
        };
        self.block(entity, &mut lexer, &mut draft)?;
        (lexer.skip_space() == end).then(|| draft.into_object(class))
    }

    /// Reads a block behind its `{`, with its `}`.
    fn block(&self, entity: &Entity, lexer: &mut Lexer<'t>, draft: &mut Draft) -> Option<()> {
        let mut given = [false; MAX_ROWS];
        let (mut way, mut expected) = (None, 0);
        let mut key = lexer.token();
        while key.is_word() {
            let (index, row) = self.row(entity, expected, key, &mut way, lexer)?;
            if std::mem::replace(&mut given[index], true) {
                return None;
            }
            expected = index + 1;
            let first = lexer.token();
            let next = self.values(entity, row, first, lexer, draft)?;
            // An attribute that is an entity type too starts an entity where one of that one's attributes follows.
            if self.doubles.contains(&key.text)
                && table::find(key.text).is_some_and(|other| other.row(next.text).is_some())
            {
                return None;
            }
            key = next;
        }
        let complete = entity
            .rows()
            .zip(given)
            .all(|(row, given)| given || !row.required);
        let agrees = !entity
            .relations
            .iter()
            .any(|relation| (relation.broken)(draft));
        (key.kind == TokenKind::Close && complete && agrees).then_some(())
    }

    /// The row of an attribute; `expected` is the one that would come next in the order of the table.
    fn row(
        &self,
        entity: &Entity,
        expected: usize,
        key: Token<'t>,
        way: &mut Option<usize>,
        lexer: &Lexer<'t>,
    ) -> Option<(usize, &'static Attribute)> {
        let (index, row, own) = match entity.rows().nth(expected) {
            // Its own name is no spelling of another.
            Some(row) if row.name.as_bytes() == key.text => (expected, row, 0),
            _ => {
                let mut spelt_in = *way;
                if way.is_none() && entity.spelt(key.text).nth(1).is_some() {
                    let ahead = keys_ahead(self.text, lexer.clone().skip_space());
                    spelt_in = entity.way_of(ahead.into_iter());
                }
                entity.spelt_in(spelt_in, key.text)?
            }
        };
        let in_one_way = row.other_names.is_empty() || *way.get_or_insert(own) == own;
        in_one_way.then_some((index, row))
    }

    /// Reads the values of a row, of which `first` is the first token; returns the token behind them.
    fn values(
        &self,
        entity: &Entity,
        row: &Attribute,
        first: Token<'t>,
        lexer: &mut Lexer<'t>,
        draft: &mut Draft,
    ) -> Option<Token<'t>> {
        let (count, field, whole) = match row.take {
            Take::Numbers(count, field) => (count, field, false),
            Take::Integers(count, field) => (count, field, true),
            Take::Material(index) => {
                *index(draft) = refer(self.materials, entity, first)?;
                return Some(lexer.token());
            }
            Take::Texture(index) => {
                *index(draft) = refer(self.textures, entity, first)?;
                return Some(lexer.token());
            }
            // No object has these.
            Take::OneOrThree(_) | Take::Picture => return None,
        };
        let mut token = first;
        let values = field(draft);
        for value in values[..count].iter_mut() {
            *value = if whole {
                number::parse_integer(token.text).ok()? as f64
            } else {
                number::parse_number(token.text).ok()?
            };
            token = lexer.token();
        }
        row.limit.broken(values).is_empty().then_some(token)
    }
}

/// What a reference is to, if its name could not be taken for anything else.
fn refer(names: &Names<'_>, entity: &Entity, name: Token<'_>) -> Option<usize> {
    let found = names.known(name.text)?;
    let is_sign = matches!(name.text, b"=" | b":");
    let is_other = is_sign || entity.row(name.text).is_some() || table::find(name.text).is_some();
    (!is_other).then_some(found)
}

/// The words that are an attribute and an entity type too.
fn doubles() -> Vec<&'static [u8]> {
    let rows = table::ENTITIES.iter().flat_map(Entity::rows);
    let words = rows.flat_map(|row| row.other_names.iter().chain([&row.name]));
    let mut doubles: Vec<_> = words
        .map(|word| word.as_bytes())
        .filter(|word| table::find(word).is_some())
        .collect();
    doubles.sort_unstable();
    doubles.dedup();
    doubles
}

/// What stands for an object that could not be read, until all of them are given up.
fn nothing() -> Object {
    Draft::default().into_object(Class::Sphere)
}

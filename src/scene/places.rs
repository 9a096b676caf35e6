//! Where things stand in the text of a scene: beside the flow text → lex → parse → [`Scene`](super::Scene), for who
//! shows a place in the file or changes a number there.
//!
//! The walk is over the tokens of `lex` by the rows of the `table`, and has nothing to complain about: the text went
//! through the parser. For each entity only its first byte is kept; what is inside is read again when it is asked for,
//! so that a file of a million spheres costs 8 MB.

use std::ops::Range;

use super::bytes::mark_length;
use super::kind::EntityKind;
use super::lex::{Lexer, Token, TokenKind};
use super::number::{looks_numeric, parse_number};
use super::table::{self, Entity, Take};

/// One entity of a [`Scene`](super::Scene), by the list it is in and its number there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EntityId {
    /// The camera.
    Camera,
    /// A material, by its index in [`Scene::materials`](super::Scene::materials).
    Material(usize),
    /// A texture, by its index in [`Scene::textures`](super::Scene::textures).
    Texture(usize),
    /// An object, by its index in [`Scene::objects`](super::Scene::objects).
    Object(usize),
    /// A light, by its index in [`Scene::lights`](super::Scene::lights).
    Light(usize),
}

/// Where the entities of a text start. It does not hold the text: that is handed in again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Places {
    camera: Option<usize>,
    materials: Vec<usize>,
    textures: Vec<usize>,
    objects: Vec<usize>,
    lights: Vec<usize>,
}

/// Where one entity stands: bytes of the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// All of it, from its type to its `}`.
    pub span: Range<usize>,
    /// Its type, as `sphere`.
    pub kind: Range<usize>,
    /// Its name.
    pub name: Range<usize>,
    /// Its `{`.
    pub open: usize,
    /// Its `}`.
    pub close: usize,
    /// What is given in its block, in the order of the text.
    pub given: Vec<Given>,
}

/// Where an attribute is given: bytes of the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Given {
    /// What it is called, in the spelling of docs/SCENE.md's tables.
    pub name: &'static str,
    /// Its word in the text.
    pub key: Range<usize>,
    /// Its values; at least one. There may be lines and comments between them.
    pub values: Vec<Range<usize>>,
}

/// Where the entities stand in a text that [`parse`](super::parse()) accepts. In any other text those are found that
/// stand before what is not understood.
///
/// Takes time in the length of the text, and 8 bytes an entity.
pub fn places(text: &[u8]) -> Places {
    let mut places = Places::default();
    let mut lexer = Lexer::new(text);
    while let Some((start, kind)) = skim(&mut lexer) {
        match kind {
            EntityKind::Camera => {
                places.camera.get_or_insert(start);
            }
            EntityKind::Material => places.materials.push(start),
            EntityKind::Texture => places.textures.push(start),
            EntityKind::Object(_) => places.objects.push(start),
            EntityKind::Light(_) => places.lights.push(start),
        }
    }
    places
}

/// Moves over one entity: where it starts and what it is.
fn skim(lexer: &mut Lexer<'_>) -> Option<(usize, EntityKind)> {
    let (head, entity, _, _) = title(lexer)?;
    loop {
        match lexer.token().kind {
            TokenKind::Close => return Some((head.start, entity.kind)),
            TokenKind::Word => {}
            TokenKind::Open | TokenKind::End => return None,
        }
    }
}

/// Reads `type name {`: the tokens, and the entity type.
fn title<'t>(lexer: &mut Lexer<'t>) -> Option<(Token<'t>, &'static Entity, Token<'t>, Token<'t>)> {
    let [head, name, open] = [lexer.token(), lexer.token(), lexer.token()];
    let entity = table::find(head.text)?;
    (name.is_word() && open.kind == TokenKind::Open).then_some((head, entity, name, open))
}

impl Places {
    /// Where an entity stands, in the text that the places are of; nothing if it has no such entity. In another text
    /// the answer means nothing.
    pub fn of(&self, text: &[u8], id: EntityId) -> Option<Place> {
        let start = match id {
            EntityId::Camera => self.camera?,
            EntityId::Material(index) => *self.materials.get(index)?,
            EntityId::Texture(index) => *self.textures.get(index)?,
            EntityId::Object(index) => *self.objects.get(index)?,
            EntityId::Light(index) => *self.lights.get(index)?,
        };
        read(text, start)
    }
}

impl Place {
    /// Where an attribute is given, by its name in docs/SCENE.md's tables.
    pub fn given(&self, name: &str) -> Option<&Given> {
        self.given.iter().find(|given| given.name == name)
    }
}

/// Reads the entity that starts at a byte.
fn read(text: &[u8], start: usize) -> Option<Place> {
    let mut lexer = Lexer::at(text, start);
    let (head, entity, name, open) = title(&mut lexer)?;
    let mut found = Vec::new();
    let mut token = lexer.token();
    while token.is_word() {
        // Where one spelling is two attributes', both have values of the same kind.
        let (_, row) = entity.row(token.text)?;
        let key = token;
        let mut values = Vec::new();
        token = lexer.token();
        // A name is one word, whatever it looks like; numbers go on while there are numbers, as in the parser.
        match row.take {
            Take::Material(_) | Take::Texture(_) | Take::Picture => {
                values.push(token.is_word().then(|| token.span())?);
                token = lexer.token();
            }
            Take::Numbers(..) | Take::Integers(..) | Take::OneOrThree(_) => {
                while token.is_word() && looks_numeric(token.text) {
                    values.push(token.span());
                    token = lexer.token();
                }
            }
        }
        if values.is_empty() {
            return None;
        }
        found.push((key, values));
    }
    let way = entity.way_of(found.iter().map(|(key, _)| key.text));
    let given = found.into_iter().map(|(key, values)| {
        let (_, row, _) = entity.spelt_in(way, key.text)?;
        Some(Given {
            name: row.name,
            key: key.span(),
            values,
        })
    });
    let given = given.collect::<Option<Vec<_>>>()?;
    (token.kind == TokenKind::Close).then(|| Place {
        span: head.start..token.end(),
        kind: head.span(),
        name: name.span(),
        open: open.start,
        close: token.start,
        given,
    })
}

/// The number that stands at these bytes, as the parser reads it.
pub(crate) fn number_at(text: &[u8], place: &Range<usize>) -> Option<f64> {
    parse_number(text.get(place.clone())?).ok()
}

/// The line and the column of a byte, from 1, as diagnostics count them: a line ends with a newline, a carriage return
/// or both together, a column is a character, and a byte order mark is none.
pub fn line(text: &[u8], offset: usize) -> (usize, usize) {
    let before = &text[..offset.min(text.len())];
    // There may be 80 MB of them: counts that fit a byte are summed many at once.
    let ends = |byte: u8| -> usize {
        let in_chunk = |chunk: &[u8]| -> u8 { chunk.iter().map(|b| u8::from(*b == byte)).sum() };
        let chunks = before.chunks(usize::from(u8::MAX));
        chunks.map(|chunk| usize::from(in_chunk(chunk))).sum()
    };
    let (newlines, returns) = (ends(b'\n'), ends(b'\r'));
    let pairs = match returns {
        0 => 0,
        _ => {
            let pairs = before.iter().zip(text.iter().skip(1));
            pairs.filter(|pair| *pair == (&b'\r', &b'\n')).count()
        }
    };
    let lines = newlines + returns - pairs;
    // The newline of a pair that starts here ends the line that the carriage return stands in.
    let start = before
        .iter()
        .enumerate()
        .rposition(|(at, byte)| {
            *byte == b'\n' || (*byte == b'\r' && text.get(at + 1) != Some(&b'\n'))
        })
        .map_or(0, |end| end + 1);
    let skipped = if start == 0 { mark_length(text) } else { 0 };
    let column = before[start..]
        .iter()
        .skip(skipped)
        .filter(|byte| **byte & 0xC0 != 0x80)
        .count();
    (lines + 1, column + 1)
}

#[cfg(test)]
mod tests;

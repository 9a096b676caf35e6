//! Changes into the text of their scene: the numbers are exchanged where they stand, all other bytes stay.

use std::ops::Range;

use super::changes::Changes;
use super::spell;
use super::target::{Target, Value};
use crate::diagnostic::Diagnostics;
use crate::scene::{
    EntityId, Given, MAX_FILE, Place, Scene, number_at, number_rows, parse_text, places,
};

/// Why changes could not be written into a text. Nothing of it is changed then.
#[derive(Debug, thiserror::Error)]
pub enum EditError {
    /// The text has mistakes, and where something stands in it is not known.
    #[error("a scene with mistakes cannot be changed\n{0}")]
    Scene(#[from] Diagnostics),
    /// The text has no such entity: the changes are of another.
    #[error("{} cannot be written: this text has no {} with it", .0.attribute(), numbered(.0.entity()))]
    Missing(Target),
    /// It would be larger than a scene may be.
    #[error("with the changes the scene would be too large: more than {} MiB", MAX_FILE >> 20)]
    TooLarge,
}

/// An entity that is not there, by its number in its list, from 1.
fn numbered(id: EntityId) -> String {
    match id {
        EntityId::Camera => String::from("camera"),
        EntityId::Material(index) => format!("material number {}", index + 1),
        EntityId::Texture(index) => format!("texture number {}", index + 1),
        EntityId::Object(index) => format!("object number {}", index + 1),
        EntityId::Light(index) => format!("light number {}", index + 1),
    }
}

/// Bytes to put in the place of others.
struct Edit {
    place: Range<usize>,
    bytes: Vec<u8>,
}

impl Changes {
    /// The text with the changes written into it: [`parse`](crate::scene::parse()) makes of it what [`Changes::apply`]
    /// makes of the scene of `text`, to the last bit.
    ///
    /// Only numbers whose value changes are exchanged. Where an attribute is not given, it is added to the block in the
    /// layout of its neighbours, and one that is left out is removed as if it had been added; where `specular` is one
    /// number for all three and they come to differ, it becomes three. Everything else, comments, order and the ends of
    /// lines, stays byte for byte, but for comments between the numbers of what is removed. Textures are not read.
    ///
    /// # Errors
    /// When the text has mistakes, or has not what is changed, or would become too large.
    pub fn write(&self, text: &[u8]) -> Result<Vec<u8>, EditError> {
        let scene = parse_text("the scene", text)?;
        let places = places(text);
        let mut edits = Vec::new();
        let mut changes: Vec<_> = self.iter().collect();
        // In the order in which one writes them.
        changes.sort_by_cached_key(|(target, _)| (target.entity(), row_number(&scene, *target)));
        for (target, value) in changes {
            let missing = || EditError::Missing(target);
            if target.value_in(&scene).ok_or_else(missing)? == value {
                continue;
            }
            let place = places.of(text, target.entity()).ok_or_else(missing)?;
            match place.given(target.attribute()) {
                Some(given) if value == Value::LEFT_OUT => {
                    edits.push(remove(text, &place, given));
                }
                Some(given) => respell(text, given, value.numbers(), &mut edits),
                // It has a value, so it is one that may be left out.
                None => {
                    let edit = add(text, &place, &names_before(&scene, target), value.numbers());
                    edits.push(edit.ok_or_else(missing)?);
                }
            }
        }
        // Several that are added in one place stay in their order, before what is removed behind it.
        edits.sort_by_key(|edit| (edit.place.start, edit.place.end));
        exchange(text, &edits, MAX_FILE).ok_or(EditError::TooLarge)
    }
}

/// The text with edits in it, which are in order and do not overlap; nothing if that is more than `limit` bytes.
fn exchange(text: &[u8], edits: &[Edit], limit: u64) -> Option<Vec<u8>> {
    let added: usize = edits.iter().map(|edit| edit.bytes.len()).sum();
    let removed: usize = edits.iter().map(|edit| edit.place.len()).sum();
    let length = text.len() + added - removed;
    if length as u64 > limit {
        return None;
    }
    let mut written = Vec::with_capacity(length);
    let mut done = 0;
    for Edit { place, bytes } in edits {
        written.extend_from_slice(&text[done..place.start]);
        written.extend_from_slice(bytes);
        done = place.end;
    }
    written.extend_from_slice(&text[done..]);
    Some(written)
}

/// Exchanges the numbers of an attribute that differ from what is given.
fn respell(text: &[u8], given: &Given, values: &[f64], edits: &mut Vec<Edit>) {
    let spelt = |place: &Range<usize>, value: f64| {
        if number_at(text, place) == Some(value) {
            text[place.clone()].to_vec()
        } else {
            spell::number(value).into_bytes()
        }
    };
    if let ([one], [red, green, blue]) = (&given.values[..], values) {
        let bytes = if red == green && green == blue {
            spelt(one, *red)
        } else {
            [red, green, blue]
                .map(|value| spelt(one, *value))
                .join(&b' ')
        };
        let place = one.clone();
        edits.push(Edit { place, bytes });
        return;
    }
    for (place, value) in given.values.iter().zip(values) {
        if number_at(text, place) != Some(*value) {
            let place = place.clone();
            let bytes = spell::number(*value).into_bytes();
            edits.push(Edit { place, bytes });
        }
    }
}

/// The place of an attribute among the numbers of its entity, in the order of docs/SCENE.md.
fn row_number(scene: &Scene, target: Target) -> Option<usize> {
    number_rows(scene, target.entity()).position(|row| row.name() == target.attribute())
}

/// The names of an entity's numbers up to an attribute, in the order of docs/SCENE.md.
fn names_before(scene: &Scene, target: Target) -> Vec<&'static str> {
    let end = row_number(scene, target).map_or(0, |number| number + 1);
    let rows = number_rows(scene, target.entity()).take(end);
    rows.map(|row| row.name()).collect()
}

/// Adds an attribute to the block of an entity that does not give it: the last one of these `names`, behind the last
/// one given of those before it, or at the end. Nothing for an empty block, which no entity has.
fn add(text: &[u8], place: &Place, names: &[&'static str], values: &[f64]) -> Option<Edit> {
    let given = &place.given;
    let (name, before) = names.split_last()?;
    let index = before
        .iter()
        .rev()
        .find_map(|other| given.iter().position(|given| given.name == *other))
        .or(given.len().checked_sub(1))?;
    let anchor = given.get(index)?;
    let end = last_byte(anchor);
    let next = given.get(index + 1);
    let next_start = next.map_or(place.close, |next| next.key.start);
    let break_after = text[end..next_start].iter().position(is_break);
    let line = match line_of(text, place, anchor) {
        // The attribute gets a line of its own where its neighbour has one.
        Some(line) if break_after.is_some() || next.is_none() => line,
        _ => {
            let previous = index.checked_sub(1).and_then(|index| given.get(index));
            let separators = [
                previous.map(|previous| last_byte(previous)..anchor.key.start),
                next.map(|next| end..next.key.start),
            ];
            let separator = separators
                .into_iter()
                .flatten()
                .map(|separator| &text[separator])
                .find(|separator| separator.iter().all(is_blank))
                .unwrap_or(b" ");
            let bytes = [separator, &entry(b" ", name, values)].concat();
            return Some(Edit {
                place: end..end,
                bytes,
            });
        }
    };
    // The new text goes behind the comment, if any, that ends the neighbour's line.
    let at = end + break_after.unwrap_or(0);
    let line_end = match break_after {
        Some(_) if text[at..].starts_with(b"\r\n") => &text[at..at + 2],
        Some(_) => &text[at..=at],
        None if text[..line.start].ends_with(b"\r\n") => b"\r\n",
        None => &text[line.start - 1..line.start],
    };
    let gap = gap(text, place, anchor, name);
    let entry = entry(&gap, name, values);
    let bytes = [line_end, &text[line], &entry].concat();
    Some(Edit {
        place: at..at,
        bytes,
    })
}

/// Removes an attribute from its block, and with it what [`add`] would have put before it: the end of the line before,
/// or blanks. Where a comment stands there, the comment's line stays as it is.
fn remove(text: &[u8], place: &Place, given: &Given) -> Edit {
    let end = last_byte(given);
    // If the block's end came behind a comment on the line before, it would be part of that.
    let line_end = text[end..place.close].iter().position(is_break);
    let is_alone = line_end.is_some_and(|length| text[end..end + length].iter().all(is_blank));
    let start = match line_of(text, place, given) {
        Some(line) if is_alone => {
            let before = &text[..line.start];
            line.start - if before.ends_with(b"\r\n") { 2 } else { 1 }
        }
        Some(_) => given.key.start,
        None => {
            let before = text[place.open..given.key.start].iter();
            let blanks = before.rev().take_while(|byte| is_blank(byte)).count();
            given.key.start - blanks
        }
    };
    Edit {
        place: start..end,
        bytes: Vec::new(),
    }
}

/// An attribute as it is written.
fn entry(gap: &[u8], name: &str, values: &[f64]) -> Vec<u8> {
    [name.as_bytes(), gap, spell::numbers(values).as_bytes()].concat()
}

/// The indentation of the line that an attribute of a block begins; nothing if it does not begin one. Its start is not
/// 0, as the line before ends there.
fn line_of(text: &[u8], place: &Place, given: &Given) -> Option<Range<usize>> {
    // The search goes no further back than the block, so that a file on one line takes linear time.
    let inside = place.open..given.key.start;
    let line_end = text[inside].iter().rposition(is_break)?;
    let indentation = place.open + line_end + 1..given.key.start;
    text[indentation.clone()]
        .iter()
        .all(is_blank)
        .then_some(indentation)
}

/// What stands between an added name and its values: as behind a neighbour's name, so that values line up where those
/// of the block do.
fn gap(text: &[u8], place: &Place, anchor: &Given, name: &str) -> Vec<u8> {
    let gap_of = |given: &Given| &text[given.key.end..given.values[0].start];
    let gap = gap_of(anchor);
    if gap.contains(&b'\t') && gap.iter().all(is_blank) {
        return gap.to_vec();
    }
    let is_spaces = |gap: &[u8]| gap.iter().all(|byte| *byte == b' ');
    let in_columns = |given: &Given| gap_of(given).len() > 1 && is_spaces(gap_of(given));
    let column = anchor.key.len() + gap.len();
    let width = column.saturating_sub(name.len());
    if is_spaces(gap) && place.given.iter().any(in_columns) {
        vec![b' '; width.max(1)]
    } else {
        vec![b' ']
    }
}

/// The byte after an attribute's last value.
fn last_byte(given: &Given) -> usize {
    given.values.last().map_or(given.key.end, |value| value.end)
}

fn is_break(byte: &u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

fn is_blank(byte: &u8) -> bool {
    matches!(byte, b' ' | b'\t')
}

#[cfg(test)]
mod tests;

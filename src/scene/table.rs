//! The scene language as a table: one row an attribute, one list of rows a level of the class hierarchy.
//!
//! The parser, the builder and the listing all walk these rows, so an attribute is named, limited and placed here and
//! nowhere else. In the flow text → lex → parse → [`Scene`](super::Scene) this is what `parse` looks words up in.

use super::draft::Draft;
use super::kind::EntityKind;
use super::limit::Limit;

mod relations;
mod rows;

pub use super::limit::MAX_PIXELDIM;
pub(super) use rows::ENTITIES;

// The tables of shaders are made from the folder of shaders, in one place.
pub use crate::procedural::{PPLANE_SHADERS, PSPHERE_SHADERS};

/// One row: an attribute of an entity.
pub(super) struct Attribute {
    /// Its name in the file.
    pub(super) name: &'static str,
    /// Other spellings of its name. Where several attributes of an entity have them, those of the same place in the
    /// lists go together: an entity is spelt in one way.
    pub(super) other_names: &'static [&'static str],
    /// How many values of which type, and where they go.
    pub(super) take: Take,
    /// What the values must keep.
    pub(super) limit: Limit,
    /// Values to show where a required one is missing.
    pub(super) example: &'static str,
    /// Is it an error to leave it out?
    pub(super) required: bool,
    /// Where it may be left out and that means something else than zero: the field, which is none then.
    pub(super) omitted: Option<Omitted>,
}

/// The values of an attribute: their type, their number, and the field that they go to.
pub(super) enum Take {
    /// So many numbers.
    Numbers(usize, Field),
    /// So many whole numbers.
    Integers(usize, Field),
    /// Three numbers, or one that stands for all three.
    OneOrThree(Field),
    /// The name of a material.
    Material(Index),
    /// The name of a texture.
    Texture(Index),
    /// The file name of a picture.
    Picture,
}

/// Where numbers go: as long as there are values.
pub(super) type Field = fn(&mut Draft) -> &mut [f64];
/// Where the numbers of an attribute are that need not be there.
pub(super) type Omitted = fn(&mut Draft) -> &mut Option<[f64; 3]>;
/// Where a reference goes.
pub(super) type Index = fn(&mut Draft) -> &mut usize;

/// Attributes that contradict each other.
pub(super) struct Relation {
    /// The attribute that the error points at.
    pub(super) attribute: &'static str,
    /// The attributes that it contradicts.
    pub(super) others: &'static [&'static str],
    /// Do they?
    pub(super) broken: fn(&Draft) -> bool,
    /// What is wrong, after "`attribute` ".
    pub(super) message: &'static str,
}

/// An entity type: its name, and its rows, base class first.
pub(super) struct Entity {
    /// Its name in the file.
    pub(super) name: &'static str,
    /// Another spelling of its name.
    pub(super) other_name: Option<&'static str>,
    /// What it makes.
    pub(super) kind: EntityKind,
    /// Its rows, a list for each level of the class hierarchy.
    levels: &'static [&'static [Attribute]],
    /// What its attributes must keep between them.
    pub(super) relations: &'static [Relation],
}

/// Entity types of the language's later life that are known and not supported.
pub(super) const UNSUPPORTED: &[&str] = &["revsurf"];

/// The most rows that an entity has: see the test.
pub(super) const MAX_ROWS: usize = 8;

/// The entity type of this name.
pub(super) fn find(name: &[u8]) -> Option<&'static Entity> {
    let found = ENTITIES.iter().find(|entity| {
        let mut names = entity.other_name.into_iter().chain([entity.name]);
        names.any(|own| own.as_bytes() == name)
    });
    found.filter(|entity| !UNSUPPORTED.contains(&entity.name))
}

/// The entity type that makes this.
pub(super) fn of(kind: EntityKind) -> &'static Entity {
    // Every kind has its entity (tested); the first stands in for the compiler's sake.
    ENTITIES
        .iter()
        .find(|entity| entity.kind == kind)
        .unwrap_or(&ENTITIES[0])
}

impl Entity {
    /// Its rows, base class first.
    pub(super) fn rows(&self) -> impl Iterator<Item = &'static Attribute> + use<> {
        self.levels.iter().copied().flatten()
    }

    /// The row of this name, by any spelling, and its number.
    pub(super) fn row(&self, name: &[u8]) -> Option<(usize, &'static Attribute)> {
        self.rows().enumerate().find(|(_, row)| row.is_called(name))
    }

    /// The rows of this name, each with its number and the way in which it is spelt: 0 is its own name. They are more
    /// than one where a spelling of one attribute is another's too.
    pub(super) fn spelt(
        &self,
        name: &[u8],
    ) -> impl Iterator<Item = (usize, &'static Attribute, usize)> {
        let rows = self.rows().enumerate();
        rows.filter_map(move |(index, row)| Some((index, row, row.way(name)?)))
    }

    /// The row of this name, its number and the way in which it is spelt: this way, if there is such a row.
    pub(super) fn spelt_in(
        &self,
        way: Option<usize>,
        name: &[u8],
    ) -> Option<(usize, &'static Attribute, usize)> {
        let in_way = self.spelt(name).find(|found| Some(found.2) == way);
        in_way.or_else(|| self.spelt(name).next())
    }

    /// The way in which these attributes are spelt, by the first one whose spelling tells it.
    pub(super) fn way_of<'n>(&self, mut names: impl Iterator<Item = &'n [u8]>) -> Option<usize> {
        names.find_map(|name| {
            let mut rows = self
                .spelt(name)
                .filter(|(_, row, _)| !row.other_names.is_empty());
            let (_, _, way) = rows.next()?;
            rows.next().is_none().then_some(way)
        })
    }
}

impl Attribute {
    /// Is it a colour: three numbers of which none is negative?
    pub(super) fn is_colour(&self) -> bool {
        matches!(self.take, Take::Numbers(3, _)) && self.limit == Limit::NotNegative
    }

    /// Is it left out, where that means something else than zero?
    pub(super) fn is_left_out(&self, draft: &mut Draft) -> bool {
        self.omitted.is_some_and(|field| field(draft).is_none())
    }

    fn is_called(&self, name: &[u8]) -> bool {
        self.way(name).is_some()
    }

    /// Its name, spelt in this way.
    pub(super) fn spelling(&self, way: usize) -> Option<&'static str> {
        let mut names = std::iter::once(&self.name).chain(self.other_names);
        names.nth(way).copied()
    }

    /// The number of this spelling, if it is one: 0 is its own name.
    fn way(&self, name: &[u8]) -> Option<usize> {
        let mut names = std::iter::once(&self.name).chain(self.other_names);
        names.position(|own| own.as_bytes() == name)
    }
}

#[cfg(test)]
mod tests;

//! The scene language as a table: one row an attribute, one list of rows a level of the class hierarchy.
//!
//! The parser, the builder and the listing all walk these rows, so an attribute is named, limited and placed here and
//! nowhere else. In the flow text → lex → parse → [`Scene`](super::Scene) this is what `parse` looks words up in.

use super::draft::Draft;
use super::kind::{Class, EntityKind};
use super::limit::Limit;
use super::number;
use crate::procedural::Family;

pub use super::limit::MAX_PIXELDIM;

// The tables of shaders are made from the folder of shaders, in one place.
pub use crate::procedural::{PPLANE_SHADERS, PSPHERE_SHADERS};

/// One row: an attribute of an entity.
pub(super) struct Attribute {
    /// Its name in the file.
    pub(super) name: &'static str,
    /// Another spelling of its name.
    pub(super) other_name: Option<&'static str>,
    /// How many values of which type, and where they go.
    pub(super) take: Take,
    /// What the values must keep.
    pub(super) limit: Limit,
    /// Values to show where a required one is missing.
    pub(super) example: &'static str,
    /// Is it an error to leave it out?
    pub(super) required: bool,
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
/// Where a reference goes.
pub(super) type Index = fn(&mut Draft) -> &mut usize;

/// Two attributes that contradict each other.
pub(super) struct Relation {
    /// The attribute that the error points at.
    pub(super) attribute: &'static str,
    /// The attribute that it contradicts.
    pub(super) other: &'static str,
    /// Do they?
    pub(super) broken: fn(&Draft) -> bool,
    /// What is wrong, after "`attribute` ".
    pub(super) message: &'static str,
}

/// An entity type: its name, and its rows, base class first.
pub(super) struct Entity {
    /// Its name in the file.
    pub(super) name: &'static str,
    /// What it makes.
    pub(super) kind: EntityKind,
    /// Its rows, a list for each level of the class hierarchy.
    levels: &'static [&'static [Attribute]],
    /// What its attributes must keep between them.
    pub(super) relation: Option<Relation>,
}

const fn row(name: &'static str, example: &'static str, take: Take, limit: Limit) -> Attribute {
    Attribute {
        name,
        other_name: None,
        take,
        limit,
        example,
        required: true,
    }
}

const fn optional(name: &'static str, take: Take, limit: Limit) -> Attribute {
    Attribute {
        name,
        other_name: None,
        take,
        limit,
        example: "",
        required: false,
    }
}

const CAMERA: &[Attribute] = &[
    row(
        "pixeldim",
        "640 480",
        Take::Integers(2, |d| &mut d.pixeldim),
        Limit::Pixels,
    ),
    row(
        "worlddim",
        "8 6",
        Take::Numbers(2, |d| &mut d.worlddim),
        Limit::Positive,
    ),
    row(
        "viewpoint",
        "4 3 6",
        Take::Numbers(3, |d| &mut d.viewpoint),
        Limit::InFront,
    ),
];

const MATERIAL: &[Attribute] = &[
    optional(
        "ambient",
        Take::Numbers(3, |d| &mut d.ambient),
        Limit::NotNegative,
    ),
    optional(
        "diffuse",
        Take::Numbers(3, |d| &mut d.diffuse),
        Limit::NotNegative,
    ),
    optional(
        "specular",
        Take::OneOrThree(|d| &mut d.specular),
        Limit::NotNegative,
    ),
    optional(
        "shininess",
        Take::Numbers(1, |d| &mut d.shininess),
        Limit::NotNegative,
    ),
    optional(
        "transparency",
        Take::Numbers(1, |d| &mut d.transparency),
        Limit::Share,
    ),
];

const TEXTURE: &[Attribute] = &[row("filename", "wood.ppm", Take::Picture, Limit::None)];

const OBJECT: &[Attribute] = &[row(
    "material",
    "name",
    Take::Material(|d| &mut d.material),
    Limit::None,
)];

const PLANE: &[Attribute] = &[
    row(
        "normal",
        "0 1 0",
        Take::Numbers(3, |d| &mut d.normal),
        Limit::NotZero,
    ),
    row(
        "point",
        "0 0 0",
        Take::Numbers(3, |d| &mut d.point),
        Limit::None,
    ),
];

const SPHERE: &[Attribute] = &[
    row(
        "center",
        "0 0 0",
        Take::Numbers(3, |d| &mut d.center),
        Limit::None,
    ),
    row(
        "radius",
        "1",
        Take::Numbers(1, |d| &mut d.radius),
        Limit::Positive,
    ),
];

const TILED: &[Attribute] = &[
    row(
        "altmaterial",
        "name",
        Take::Material(|d| &mut d.altmaterial),
        Limit::None,
    ),
    Attribute {
        other_name: Some("dimensions"),
        ..row(
            "dimension",
            "1 1",
            Take::Numbers(2, |d| &mut d.dimension),
            Limit::Positive,
        )
    },
    optional(
        "xdir",
        Take::Numbers(3, |d| d.xdir.get_or_insert_default()),
        Limit::NotZero,
    ),
];

const PROCEDURAL_PLANE: &[Attribute] = &[row(
    "shader",
    "0",
    Take::Integers(1, |d| &mut d.shader),
    Limit::Shader(Family::Pplane),
)];

const PROCEDURAL_SPHERE: &[Attribute] = &[row(
    "shader",
    "0",
    Take::Integers(1, |d| &mut d.shader),
    Limit::Shader(Family::Psphere),
)];

const FINITE: &[Attribute] = &[
    row(
        "xdir",
        "1 0 0",
        Take::Numbers(3, |d| d.xdir.get_or_insert_default()),
        Limit::NotZero,
    ),
    row(
        "dimensions",
        "1 1",
        Take::Numbers(2, |d| &mut d.dimension),
        Limit::Positive,
    ),
];

const TEXTURED: &[Attribute] = &[
    row(
        "texname",
        "name",
        Take::Texture(|d| &mut d.texture),
        Limit::None,
    ),
    row(
        "mode",
        "0",
        Take::Integers(1, |d| &mut d.mode),
        Limit::Below(2),
    ),
];

const LIGHT: &[Attribute] = &[
    row(
        "location",
        "0 5 0",
        Take::Numbers(3, |d| &mut d.location),
        Limit::None,
    ),
    row(
        "emissivity",
        "5 5 5",
        Take::Numbers(3, |d| &mut d.emissivity),
        Limit::NotNegative,
    ),
];

const SPOT: &[Attribute] = &[
    row(
        "point",
        "0 0 0",
        Take::Numbers(3, |d| &mut d.point),
        Limit::None,
    ),
    row(
        "theta",
        "30",
        Take::Numbers(1, |d| &mut d.theta),
        Limit::HalfAngle,
    ),
];

const ALONG_NORMAL: Option<Relation> = Some(Relation {
    attribute: "xdir",
    other: "normal",
    broken: |d| {
        d.xdir
            .is_some_and(|xdir| number::parallel(&xdir, &d.normal))
    },
    message: "must not be parallel to `normal`: it is projected onto the plane",
});

const AIMLESS: Option<Relation> = Some(Relation {
    attribute: "point",
    other: "location",
    broken: |d| d.point == d.location,
    message: "must differ from `location`: the two give the direction of the light",
});

const fn entity(
    kind: EntityKind,
    levels: &'static [&'static [Attribute]],
    relation: Option<Relation>,
) -> Entity {
    Entity {
        name: kind.name(),
        kind,
        levels,
        relation,
    }
}

const fn object(
    class: Class,
    levels: &'static [&'static [Attribute]],
    relation: Option<Relation>,
) -> Entity {
    entity(EntityKind::Object(class), levels, relation)
}

/// All entity types.
pub(super) static ENTITIES: [Entity; 12] = [
    entity(EntityKind::Camera, &[CAMERA], None),
    entity(EntityKind::Material, &[MATERIAL], None),
    object(Class::Plane, &[OBJECT, PLANE], None),
    object(Class::Sphere, &[OBJECT, SPHERE], None),
    object(Class::Tiled, &[OBJECT, PLANE, TILED], ALONG_NORMAL),
    object(
        Class::ProceduralPlane,
        &[OBJECT, PLANE, PROCEDURAL_PLANE],
        None,
    ),
    object(
        Class::ProceduralSphere,
        &[OBJECT, SPHERE, PROCEDURAL_SPHERE],
        None,
    ),
    object(Class::Finite, &[OBJECT, PLANE, FINITE], ALONG_NORMAL),
    entity(EntityKind::Light { spot: false }, &[LIGHT], None),
    entity(EntityKind::Light { spot: true }, &[LIGHT, SPOT], AIMLESS),
    entity(EntityKind::Texture, &[TEXTURE], None),
    object(
        Class::Textured,
        &[OBJECT, PLANE, FINITE, TEXTURED],
        ALONG_NORMAL,
    ),
];

/// Entity types of the language's later life that are known and not supported.
pub(super) const UNSUPPORTED: [&str; 4] = ["quadric", "triangle", "projector", "revsurf"];

/// The most rows that an entity has: see the test.
pub(super) const MAX_ROWS: usize = 8;

/// The entity type of this name.
pub(super) fn find(name: &[u8]) -> Option<&'static Entity> {
    ENTITIES
        .iter()
        .find(|entity| entity.name.as_bytes() == name)
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

    /// The row of this name, by either spelling, and its number.
    pub(super) fn row(&self, name: &[u8]) -> Option<(usize, &'static Attribute)> {
        self.rows().enumerate().find(|(_, row)| row.is_called(name))
    }
}

impl Attribute {
    /// Is it a colour: three numbers of which none is negative?
    pub(super) fn is_colour(&self) -> bool {
        matches!(self.take, Take::Numbers(3, _)) && self.limit == Limit::NotNegative
    }

    fn is_called(&self, name: &[u8]) -> bool {
        self.name.as_bytes() == name
            || self
                .other_name
                .is_some_and(|other| other.as_bytes() == name)
    }
}

#[cfg(test)]
mod tests;

//! The scene language as a table: one row an attribute, one list of rows a level of the class hierarchy.
//!
//! The parser, the builder and the listing all walk these rows, so an attribute is named, limited and placed here and
//! nowhere else. In the flow text → lex → parse → [`Scene`](super::Scene) this is what `parse` looks words up in.

use super::draft::Draft;
use super::kind::{Class, EntityKind, LightClass};
use super::limit::Limit;
use super::number;
use super::triangle;
use crate::procedural::Family;

pub use super::limit::MAX_PIXELDIM;

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
    /// Was it left out, where that means something else than zero?
    pub(super) left_out: fn(&Draft) -> bool,
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

const fn row(name: &'static str, example: &'static str, take: Take, limit: Limit) -> Attribute {
    Attribute {
        name,
        other_names: &[],
        take,
        limit,
        example,
        required: true,
        left_out: |_| false,
    }
}

const fn optional(name: &'static str, take: Take, limit: Limit) -> Attribute {
    Attribute {
        name,
        other_names: &[],
        take,
        limit,
        example: "",
        required: false,
        left_out: |_| false,
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
        other_names: &["dimensions"],
        ..row(
            "dimension",
            "1 1",
            Take::Numbers(2, |d| &mut d.dimension),
            Limit::Positive,
        )
    },
    Attribute {
        left_out: |d| d.xdir.is_none(),
        ..optional(
            "xdir",
            Take::Numbers(3, |d| d.xdir.get_or_insert_default()),
            Limit::NotZero,
        )
    },
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

const fn vertex(
    name: &'static str,
    other_names: &'static [&'static str],
    example: &'static str,
    field: Field,
) -> Attribute {
    Attribute {
        other_names,
        ..row(name, example, Take::Numbers(3, field), Limit::None)
    }
}

const TRIANGLE: &[Attribute] = &[
    vertex("vertex1", &["point1", "v1", "v0"], "0 0 0", |d| {
        &mut d.vertices[0]
    }),
    vertex("vertex2", &["point2", "v2", "v1"], "1 0 0", |d| {
        &mut d.vertices[1]
    }),
    vertex("vertex3", &["point3", "v3", "v2"], "0 1 0", |d| {
        &mut d.vertices[2]
    }),
    Attribute {
        left_out: |d| d.facing.is_none(),
        ..optional(
            "normal",
            Take::Numbers(3, |d| d.facing.get_or_insert_default()),
            Limit::NotZero,
        )
    },
    Attribute {
        left_out: |d| d.idle_point.is_none(),
        ..optional(
            "point",
            Take::Numbers(3, |d| d.idle_point.get_or_insert_default()),
            Limit::None,
        )
    },
];

const QUADRIC: &[Attribute] = &[
    row(
        "coefficients",
        "1 1 1 0 0 0 0 0 0 1",
        Take::Numbers(10, |d| &mut d.coefficients),
        Limit::NotConstant,
    ),
    Attribute {
        left_out: |d| d.lower.is_none(),
        ..optional(
            "lower",
            Take::Numbers(3, |d| d.lower.get_or_insert_default()),
            Limit::None,
        )
    },
    Attribute {
        left_out: |d| d.upper.is_none(),
        ..optional(
            "upper",
            Take::Numbers(3, |d| d.upper.get_or_insert_default()),
            Limit::None,
        )
    },
];

const ALONG_NORMAL: &[Relation] = &[Relation {
    attribute: "xdir",
    others: &["normal"],
    broken: |d| {
        d.xdir
            .is_some_and(|xdir| number::parallel(&xdir, &d.normal))
    },
    message: "must not be parallel to `normal`: it is projected onto the plane",
}];

const AIMLESS: &[Relation] = &[Relation {
    attribute: "point",
    others: &["location"],
    broken: |d| d.point == d.location,
    message: "must differ from `location`: the two give the direction of the light",
}];

const FLAT: &[Relation] = &[
    Relation {
        attribute: "vertex3",
        others: &["vertex1", "vertex2"],
        broken: |d| triangle::in_line(&d.vertices),
        message: "must not lie in a line with `vertex1` and `vertex2`: they are no triangle",
    },
    Relation {
        attribute: "normal",
        others: &["vertex1", "vertex2", "vertex3"],
        broken: |d| {
            d.facing
                .is_some_and(|normal| triangle::is_in_plane(&normal, &d.vertices))
        },
        message: "must not lie in the plane of the triangle: it says which side is the front",
    },
];

const EMPTY_BOX: &[Relation] = &[Relation {
    attribute: "upper",
    others: &["lower"],
    broken: |d| {
        let ends = d.lower.iter().flatten().zip(d.upper.iter().flatten());
        ends.into_iter().any(|(lower, upper)| lower >= upper)
    },
    message: "must be greater than `lower` in x, y and z: nothing would be left between them",
}];

const fn entity(
    kind: EntityKind,
    levels: &'static [&'static [Attribute]],
    relations: &'static [Relation],
) -> Entity {
    Entity {
        name: kind.name(),
        other_name: None,
        kind,
        levels,
        relations,
    }
}

const fn object(
    class: Class,
    levels: &'static [&'static [Attribute]],
    relations: &'static [Relation],
) -> Entity {
    entity(EntityKind::Object(class), levels, relations)
}

const fn light(
    class: LightClass,
    levels: &'static [&'static [Attribute]],
    relations: &'static [Relation],
) -> Entity {
    entity(EntityKind::Light(class), levels, relations)
}

/// All entity types.
pub(super) static ENTITIES: [Entity; 17] = [
    entity(EntityKind::Camera, &[CAMERA], &[]),
    entity(EntityKind::Material, &[MATERIAL], &[]),
    object(Class::Plane, &[OBJECT, PLANE], &[]),
    object(Class::Sphere, &[OBJECT, SPHERE], &[]),
    object(Class::Tiled, &[OBJECT, PLANE, TILED], ALONG_NORMAL),
    object(
        Class::ProceduralPlane,
        &[OBJECT, PLANE, PROCEDURAL_PLANE],
        &[],
    ),
    object(
        Class::ProceduralSphere,
        &[OBJECT, SPHERE, PROCEDURAL_SPHERE],
        &[],
    ),
    object(Class::Finite, &[OBJECT, PLANE, FINITE], ALONG_NORMAL),
    light(LightClass::Light, &[LIGHT], &[]),
    light(LightClass::Spotlight, &[LIGHT, SPOT], AIMLESS),
    light(
        LightClass::Projector,
        &[LIGHT, PLANE, FINITE, TEXTURED],
        ALONG_NORMAL,
    ),
    entity(EntityKind::Texture, &[TEXTURE], &[]),
    object(
        Class::Textured,
        &[OBJECT, PLANE, FINITE, TEXTURED],
        ALONG_NORMAL,
    ),
    Entity {
        other_name: Some("tri"),
        ..object(Class::Triangle, &[OBJECT, TRIANGLE], FLAT)
    },
    object(
        Class::ProceduralTriangle,
        &[OBJECT, TRIANGLE, PROCEDURAL_PLANE],
        FLAT,
    ),
    object(Class::Quadric, &[OBJECT, QUADRIC], EMPTY_BOX),
    object(
        Class::ProceduralQuadric,
        &[OBJECT, QUADRIC, PROCEDURAL_PLANE],
        EMPTY_BOX,
    ),
];

/// Entity types of the language's later life that are known and not supported.
pub(super) const UNSUPPORTED: &[&str] = &["revsurf"];

/// The most rows that an entity has: see the test.
pub(super) const MAX_ROWS: usize = 8;

/// The entity type of this name.
pub(super) fn find(name: &[u8]) -> Option<&'static Entity> {
    let mut known = ENTITIES
        .iter()
        .filter(|entity| !UNSUPPORTED.contains(&entity.name));
    known.find(|entity| {
        let mut names = entity.other_name.into_iter().chain([entity.name]);
        names.any(|own| own.as_bytes() == name)
    })
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

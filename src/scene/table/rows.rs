//! The rows themselves: every attribute of every entity type, and what attributes must keep between them. Below
//! `table`, which looks them up.

use super::relations::{AIMLESS, ALONG_NORMAL, EMPTY_BOX, FLAT};
use super::{Attribute, Entity, Field, Relation, Take};
use crate::procedural::Family;
use crate::scene::kind::{Class, EntityKind, LightClass};
use crate::scene::limit::Limit;

const fn row(name: &'static str, example: &'static str, take: Take, limit: Limit) -> Attribute {
    Attribute {
        name,
        other_names: &[],
        take,
        limit,
        example,
        required: true,
        omitted: None,
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
        omitted: None,
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
        omitted: Some(|d| &mut d.xdir),
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
        omitted: Some(|d| &mut d.facing),
        ..optional(
            "normal",
            Take::Numbers(3, |d| d.facing.get_or_insert_default()),
            Limit::NotZero,
        )
    },
    Attribute {
        omitted: Some(|d| &mut d.idle_point),
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
        omitted: Some(|d| &mut d.lower),
        ..optional(
            "lower",
            Take::Numbers(3, |d| d.lower.get_or_insert_default()),
            Limit::None,
        )
    },
    Attribute {
        omitted: Some(|d| &mut d.upper),
        ..optional(
            "upper",
            Take::Numbers(3, |d| d.upper.get_or_insert_default()),
            Limit::None,
        )
    },
];

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
pub(in crate::scene) static ENTITIES: [Entity; 17] = [
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

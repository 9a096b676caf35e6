//! The numbers of a [`Scene`] by the rows of the `table`: which there are, what they are and what they must keep, and
//! the way to read one and to put another in its place. What the window's panels, their limits and
//! [`edit`](crate::edit) go by, so that an attribute of the language can be changed as soon as it has its row.

use super::check::{broken_relation, number_fault};
use super::draft::Draft;
use super::kind::EntityKind;
use super::limit::{Limit, MAX_PIXELDIM};
use super::model::Scene;
use super::places::EntityId;
use super::table::{self, Attribute, Field, Take};

/// What the numbers of an attribute are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A place in the world: x, y, z.
    Place,
    /// Lengths in the world's units.
    Length,
    /// A direction, x, y, z; its length means nothing.
    Direction,
    /// Shares of red, green and blue light.
    Colour,
    /// An angle in degrees.
    Degrees,
    /// Pixels of the picture: columns, rows.
    Pixels,
    /// The number of a thing in a list.
    Choice,
    /// The coefficients of an equation in x, y, z of degree two.
    Coefficients,
    /// A number without a unit.
    Number,
}

/// Between which numbers each number of an attribute lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Not below this.
    pub least: f64,
    /// Nor this itself.
    pub above_least: bool,
    /// Not above this.
    pub most: f64,
}

/// An attribute that is numbers, as the language's table has it.
#[derive(Clone, Copy)]
pub struct NumberRow {
    row: &'static Attribute,
    count: usize,
    field: Field,
}

impl NumberRow {
    fn new(row: &'static Attribute) -> Option<Self> {
        let (count, field) = match row.take {
            Take::Numbers(count, field) | Take::Integers(count, field) => (count, field),
            Take::OneOrThree(field) => (3, field),
            Take::Material(_) | Take::Texture(_) | Take::Picture => return None,
        };
        Some(Self { row, count, field })
    }

    /// Its name in the file.
    pub fn name(&self) -> &'static str {
        self.row.name
    }

    /// How many numbers it is.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether they are whole numbers.
    pub fn is_whole(&self) -> bool {
        matches!(self.row.take, Take::Integers(..))
    }

    /// What they are, which follows from what they must keep.
    pub fn quantity(&self) -> Quantity {
        match (self.row.limit, self.count) {
            (Limit::NotNegative, 3) => Quantity::Colour,
            (Limit::NotNegative | Limit::Share, _) => Quantity::Number,
            (Limit::Positive, _) => Quantity::Length,
            (Limit::None | Limit::InFront, _) => Quantity::Place,
            (Limit::NotZero, _) => Quantity::Direction,
            (Limit::Pixels, _) => Quantity::Pixels,
            (Limit::HalfAngle, _) => Quantity::Degrees,
            (Limit::Below(_) | Limit::Shader(_), _) => Quantity::Choice,
            (Limit::NotConstant, _) => Quantity::Coefficients,
        }
    }

    /// Between what the number of this index lies. That a direction is not 0 0 0 is not told by bounds.
    pub fn bounds(&self, index: usize) -> Bounds {
        let (least, above_least, most) = match self.row.limit {
            Limit::None | Limit::NotZero | Limit::NotConstant => {
                (f64::NEG_INFINITY, false, f64::INFINITY)
            }
            Limit::InFront if index < 2 => (f64::NEG_INFINITY, false, f64::INFINITY),
            Limit::InFront | Limit::Positive => (0.0, true, f64::INFINITY),
            Limit::NotNegative => (0.0, false, f64::INFINITY),
            Limit::Share => (0.0, false, 1.0),
            Limit::Pixels => (1.0, false, f64::from(MAX_PIXELDIM)),
            Limit::Below(count) => (0.0, false, f64::from(count) - 1.0),
            Limit::Shader(family) => (0.0, false, family.shaders().len() as f64 - 1.0),
            Limit::HalfAngle => (0.0, true, 180.0),
        };
        Bounds {
            least,
            above_least,
            most,
        }
    }

    /// Whether it may be left out, and that means something else than zero: it has no numbers then.
    pub fn may_be_left_out(&self) -> bool {
        self.row.omitted.is_some()
    }

    /// What the numbers must be, after "must be ".
    pub fn wording(&self) -> String {
        self.row.limit.wording()
    }

    /// What there is to choose from where the number is a choice: the word of each number, from 0; empty where it has
    /// none.
    pub fn choices(&self) -> Vec<&'static str> {
        match self.row.limit {
            Limit::Shader(family) => family.shaders().iter().map(|it| it.word()).collect(),
            _ => Vec::new(),
        }
    }
}

impl NumberRow {
    /// Whether these numbers say that it is left out.
    fn is_none(&self, values: &[f64]) -> bool {
        values.is_empty() && self.may_be_left_out()
    }

    /// Gives it numbers, as many as it has, or none where it may be left out.
    fn set(&self, draft: &mut Draft, values: &[f64]) {
        match self.row.omitted {
            Some(field) if values.is_empty() => *field(draft) = None,
            _ => (self.field)(draft).copy_from_slice(values),
        }
    }
}

/// The attributes of an entity that are numbers, in the table's order; none where a scene has no such entity.
pub fn number_rows(scene: &Scene, id: EntityId) -> impl Iterator<Item = NumberRow> + use<> {
    let rows = kind_of(scene, id).map(|kind| table::of(kind).rows());
    rows.into_iter().flatten().filter_map(NumberRow::new)
}

/// The numbers of an attribute, which are none where it is left out and that means something else than zero; nothing
/// where a scene has no such entity, or that has no such attribute.
pub fn numbers_of(scene: &Scene, id: EntityId, attribute: &str) -> Option<Vec<f64>> {
    let (kind, mut draft) = draft_of(scene, id)?;
    let row = number_row(kind, attribute)?;
    Some(if row.row.is_left_out(&mut draft) {
        Vec::new()
    } else {
        (row.field)(&mut draft).to_vec()
    })
}

/// What is wrong with an entity once these attributes of it are changed: that it has none such, a limit of their rows,
/// or what attributes must keep between them.
pub(crate) fn fault<'a>(
    scene: &Scene,
    id: EntityId,
    changed: impl IntoIterator<Item = (&'a str, &'a [f64])>,
) -> Option<String> {
    let Some((kind, mut draft)) = draft_of(scene, id) else {
        return Some(String::from("there is no such entity"));
    };
    let entity = table::of(kind);
    for (attribute, values) in changed {
        let Some(row) = number_row(kind, attribute) else {
            return Some(format!(
                "`{}` has no numbers called `{attribute}`",
                entity.name
            ));
        };
        if !row.is_none(values)
            && let Some(fault) = number_fault(row.row, values)
        {
            return Some(fault);
        }
        row.set(&mut draft, values);
    }
    broken_relation(entity, &draft)
}

/// Puts numbers that have no [`fault`] into their place. Of what a scene does not have nothing happens.
pub(crate) fn put(scene: &mut Scene, id: EntityId, attribute: &str, values: &[f64]) {
    let Some((kind, mut draft)) = draft_of(scene, id) else {
        return;
    };
    let row = number_row(kind, attribute);
    let Some(row) = row.filter(|row| row.count == values.len() || row.is_none(values)) else {
        return;
    };
    row.set(&mut draft, values);
    match (id, kind) {
        (EntityId::Camera, _) => scene.camera = draft.into_camera(),
        (EntityId::Material(index), _) => scene.materials[index] = draft.into_material(),
        (EntityId::Object(index), EntityKind::Object(class)) => {
            scene.objects[index] = draft.into_object(class);
        }
        (EntityId::Light(index), EntityKind::Light(class)) => {
            scene.lights[index] = draft.into_light(class);
        }
        // Textures have no numbers, and an index is one of its own list.
        (EntityId::Texture(_) | EntityId::Object(_) | EntityId::Light(_), _) => {}
    }
}

fn number_row(kind: EntityKind, attribute: &str) -> Option<NumberRow> {
    let mut rows = table::of(kind).rows().filter(|row| row.name == attribute);
    rows.next().and_then(NumberRow::new)
}

fn kind_of(scene: &Scene, id: EntityId) -> Option<EntityKind> {
    Some(match id {
        EntityId::Camera => EntityKind::Camera,
        EntityId::Material(index) => {
            scene.materials.get(index)?;
            EntityKind::Material
        }
        EntityId::Texture(index) => {
            scene.textures.get(index)?;
            EntityKind::Texture
        }
        EntityId::Object(index) => EntityKind::Object(scene.objects.get(index)?.class()),
        EntityId::Light(index) => scene.lights.get(index)?.kind(),
    })
}

fn draft_of(scene: &Scene, id: EntityId) -> Option<(EntityKind, Draft)> {
    Some(match id {
        EntityId::Camera => (EntityKind::Camera, Draft::of_camera(&scene.camera)),
        EntityId::Material(index) => {
            let material = scene.materials.get(index)?;
            (EntityKind::Material, Draft::of_material(material))
        }
        EntityId::Texture(index) => {
            let texture = scene.textures.get(index)?;
            (EntityKind::Texture, Draft::of_texture(texture))
        }
        EntityId::Object(index) => Draft::of_object(scene.objects.get(index)?),
        EntityId::Light(index) => Draft::of_light(scene.lights.get(index)?),
    })
}

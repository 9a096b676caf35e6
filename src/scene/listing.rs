//! The model listing: the other way round, from a [`Scene`] back to text.
//!
//! Camera, materials, textures, objects, lights, each list in file order; an entity is its type and name, then a line
//! for each row of the `table`, base class first, then an empty line. With `{` after each first line and
//! `}` before each empty one it is a scene again, the same to the last bit: numbers are the shortest text that reads
//! back as the same f64.

use std::io;

use super::draft::Draft;
use super::kind::EntityKind;
use super::model::Scene;
use super::table::{self, Attribute, Take};

/// Writes the model listing of a scene.
///
/// # Errors
/// When `out` fails.
pub fn list_model(scene: &Scene, out: &mut dyn io::Write) -> io::Result<()> {
    list(
        scene,
        EntityKind::Camera,
        Draft::of_camera(&scene.camera),
        out,
    )?;
    for material in &scene.materials {
        list(
            scene,
            EntityKind::Material,
            Draft::of_material(material),
            out,
        )?;
    }
    for texture in &scene.textures {
        list(scene, EntityKind::Texture, Draft::of_texture(texture), out)?;
    }
    for object in &scene.objects {
        let (kind, draft) = Draft::of_object(object);
        list(scene, kind, draft, out)?;
    }
    for light in &scene.lights {
        let (kind, draft) = Draft::of_light(light);
        list(scene, kind, draft, out)?;
    }
    Ok(())
}

fn list(
    scene: &Scene,
    kind: EntityKind,
    mut draft: Draft,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let entity = table::of(kind);
    writeln!(out, "{:<15} {}", entity.name, draft.name)?;
    for row in entity.rows() {
        if row.is_left_out(&mut draft) {
            continue;
        }
        // As the course's listing has it, what every object has stands under its type, its own attributes indented.
        match row.name {
            "material" => write!(out, "{:<15} ", row.name)?,
            name => write!(out, "    {name:<11} ")?,
        }
        writeln!(out, "{}", values(scene, row, &mut draft))?;
    }
    writeln!(out)
}

fn values(scene: &Scene, row: &Attribute, draft: &mut Draft) -> String {
    match row.take {
        Take::Numbers(_, field) | Take::OneOrThree(field) => {
            join(field(draft), |value| format!("{:?}", value + 0.0))
        }
        Take::Integers(_, field) => join(field(draft), |value| format!("{value:.0}")),
        Take::Material(index) => scene.materials[*index(draft)].name.clone(),
        Take::Texture(index) => scene.textures[*index(draft)].name.clone(),
        Take::Picture => draft
            .picture
            .as_ref()
            .map_or_else(String::new, |picture| picture.filename.clone()),
    }
}

fn join(values: &[f64], text: fn(f64) -> String) -> String {
    values
        .iter()
        .map(|value| text(*value))
        .collect::<Vec<_>>()
        .join("  ")
}

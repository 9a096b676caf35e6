//! What is allowed and yet seldom meant: said beside a good scene, never an error.
//!
//! Stands after the parser. `plumb check`, `plumb render` and the window show this one list: `sight` has what no ray
//! from the viewpoint meets, `lit` what no light reaches.

mod bounds;
mod lit;
mod sight;
#[cfg(test)]
mod tests;

use std::collections::HashSet;

use super::{EntityId, Places, Scene, line};
use crate::diagnostic::quote;

/// Most names that a remark lists.
const SHOWN: usize = 3;

/// What someone who wonders about the picture may want to know, in sentences.
///
/// `screen_tolerance` is that of the picture. `line` tells the line of the file in which an entity begins, where there
/// is a file; see [`lines_of`]. Takes time in the number of objects times that of lights.
pub fn remarks(
    scene: &Scene,
    screen_tolerance: f64,
    line: &dyn Fn(EntityId) -> Option<usize>,
) -> Vec<String> {
    let mut found = Vec::new();
    if scene.objects.is_empty() {
        found.push("there are no objects: the picture is black".to_owned());
    }
    let names = Names { scene, line };
    lit::remarks(scene, screen_tolerance, &names, &mut found);
    sight::remarks(scene, screen_tolerance, &names, &mut found);
    for texture in &scene.textures {
        if let Some(odd) = &texture.remark {
            let file = quote(texture.filename.as_bytes());
            found.push(format!("texture {file} {odd}"));
        }
    }
    for (what, ids) in [
        (
            "material",
            (0..scene.materials.len())
                .map(EntityId::Material)
                .collect::<Vec<_>>(),
        ),
        (
            "texture",
            (0..scene.textures.len()).map(EntityId::Texture).collect(),
        ),
    ] {
        let mut seen = HashSet::new();
        let mut told = HashSet::new();
        let mut again = List::default();
        for id in ids {
            let name = names.name(id);
            if !seen.insert(name) && told.insert(name) {
                again.push(id);
            }
        }
        if !again.is_empty() {
            found.push(format!(
                "{} is the name of more than one {what}: the first counts",
                names.list(&again)
            ));
        }
    }
    found
}

/// The lines of a text in which entities begin, for [`remarks`].
pub fn lines_of<'a>(text: &'a [u8], places: &'a Places) -> impl Fn(EntityId) -> Option<usize> + 'a {
    |id| Some(line(text, places.of(text, id)?.span.start).0)
}

/// Entities that a remark is about: the first few, and how many there are.
#[derive(Debug, Default)]
struct List {
    first: Vec<EntityId>,
    count: usize,
}

impl List {
    fn push(&mut self, id: EntityId) {
        if self.first.len() < SHOWN {
            self.first.push(id);
        }
        self.count += 1;
    }

    fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The verb for one, or for several.
    fn verb<'v>(&self, one: &'v str, several: &'v str) -> &'v str {
        if self.count == 1 { one } else { several }
    }
}

/// What entities are called in a remark.
struct Names<'a> {
    scene: &'a Scene,
    line: &'a dyn Fn(EntityId) -> Option<usize>,
}

impl<'a> Names<'a> {
    fn name(&self, id: EntityId) -> &'a str {
        let scene = self.scene;
        let name = match id {
            EntityId::Camera => Some(&scene.camera.name),
            EntityId::Material(i) => scene.materials.get(i).map(|it| &it.name),
            EntityId::Texture(i) => scene.textures.get(i).map(|it| &it.name),
            EntityId::Object(i) => scene.objects.get(i).map(|it| &it.name),
            EntityId::Light(i) => scene.lights.get(i).map(|it| &it.name),
        };
        name.map_or("", String::as_str)
    }

    /// `` `a` (line 3) ``.
    fn one(&self, id: EntityId) -> String {
        let name = quote(self.name(id).as_bytes());
        match (self.line)(id) {
            Some(line) => format!("{name} (line {line})"),
            None => name,
        }
    }

    /// The same with the type in front: `` sphere `a` (line 3) ``.
    fn typed(&self, id: EntityId) -> String {
        let kind = match id {
            EntityId::Object(i) => self.scene.objects.get(i).map(|it| it.entity()),
            EntityId::Light(i) => self.scene.lights.get(i).map(|it| it.entity()),
            EntityId::Camera => Some("camera"),
            EntityId::Material(_) => Some("material"),
            EntityId::Texture(_) => Some("texture"),
        };
        format!("{} {}", kind.unwrap_or_default(), self.one(id))
    }

    /// `` `a` (line 3), `b` (line 5) and 7 others ``.
    fn list(&self, list: &List) -> String {
        self.joined(list, |id| self.one(id))
    }

    /// The same with types.
    fn typed_list(&self, list: &List) -> String {
        self.joined(list, |id| self.typed(id))
    }

    fn joined(&self, list: &List, name: impl Fn(EntityId) -> String) -> String {
        let shown: Vec<String> = list.first.iter().map(|id| name(*id)).collect();
        let others = match list.count - list.first.len() {
            0 => String::new(),
            1 => " and one other".to_owned(),
            others => format!(" and {others} others"),
        };
        shown.join(", ") + &others
    }
}

//! What is selected: an entity, by its place in the scene and by its name, since the file may move it.

use super::entities::title;
use crate::scene::{Beam, EntityId, Object, Scene, Surface};

/// What is selected, if anything is.
#[derive(Debug, Default)]
pub(super) struct Selection {
    selected: Option<Selected>,
    /// Whether the lists still have to be scrolled to it.
    unseen: bool,
}

#[derive(Debug)]
struct Selected {
    entity: EntityId,
    kind: &'static str,
    name: String,
}

impl Selection {
    /// What is selected.
    pub(super) fn entity(&self) -> Option<EntityId> {
        self.selected.as_ref().map(|selected| selected.entity)
    }

    /// Selects this, or nothing. The lists scroll there.
    pub(super) fn select(&mut self, scene: &Scene, entity: Option<EntityId>) {
        self.selected = entity.and_then(|entity| {
            let (kind, name) = title(scene, entity)?;
            let name = name.to_owned();
            Some(Selected { entity, kind, name })
        });
        self.unseen = self.selected.is_some();
    }

    /// What is clicked in a list is selected, and once more not: the list stays where it is.
    pub(super) fn click(&mut self, scene: &Scene, entity: EntityId) {
        let again = self.entity() == Some(entity);
        self.select(scene, (!again).then_some(entity));
        self.unseen = false;
    }

    /// What the lists have to scroll to.
    pub(super) fn to_be_shown(&self) -> Option<EntityId> {
        self.entity().filter(|_| self.unseen)
    }

    /// They did.
    pub(super) fn was_shown(&mut self) {
        self.unseen = false;
    }

    /// Stays with what was selected where the scene has become another: the entity of the same list, type and name that
    /// is next to where it was. One that is no longer there is not selected.
    pub(super) fn follow(&mut self, scene: &Scene) {
        let Some(selected) = &mut self.selected else {
            return;
        };
        let is_it = |entity: EntityId| {
            title(scene, entity) == Some((selected.kind, selected.name.as_str()))
        };
        if is_it(selected.entity) {
            return;
        }
        type Made = fn(usize) -> EntityId;
        let (was, count, made): (usize, usize, Made) = match selected.entity {
            // There is one, whatever it is called.
            EntityId::Camera => return,
            EntityId::Material(i) => (i, scene.materials.len(), EntityId::Material),
            EntityId::Texture(i) => (i, scene.textures.len(), EntityId::Texture),
            EntityId::Object(i) => (i, scene.objects.len(), EntityId::Object),
            EntityId::Light(i) => (i, scene.lights.len(), EntityId::Light),
        };
        let same = (0..count).filter(|index| is_it(made(*index)));
        match same.min_by_key(|index| index.abs_diff(was)).map(made) {
            Some(entity) => selected.entity = entity,
            None => self.selected = None,
        }
    }
}

/// What an entity is made of: attributes that name another one, and that.
pub(super) fn made_of(scene: &Scene, entity: EntityId) -> Vec<(&'static str, EntityId)> {
    match entity {
        EntityId::Object(i) => {
            let Some(Object {
                material, surface, ..
            }) = scene.objects.get(i)
            else {
                return Vec::new();
            };
            let mut all = vec![("material", EntityId::Material(*material))];
            match surface {
                Surface::Plain | Surface::Procedural { .. } => {}
                Surface::Tiled { altmaterial, .. } => {
                    all.push(("altmaterial", EntityId::Material(*altmaterial)));
                }
                Surface::Textured { texture, .. } => {
                    all.push(("texname", EntityId::Texture(*texture)));
                }
            }
            all
        }
        EntityId::Light(i) => match scene.lights.get(i).map(|light| light.beam) {
            Some(Beam::Picture(picture)) => vec![("texname", EntityId::Texture(picture.texture))],
            Some(Beam::Everywhere | Beam::Cone(_)) | None => Vec::new(),
        },
        EntityId::Camera | EntityId::Material(_) | EntityId::Texture(_) => Vec::new(),
    }
}

#[cfg(test)]
mod tests;

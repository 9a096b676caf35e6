//! What a scene's entities are called, and which objects are made of which: what panels, messages and outlines ask.

use crate::scene::{EntityId, Object, Scene, Surface};

/// The type and the name of an entity, as the file says them.
pub(super) fn title(scene: &Scene, entity: EntityId) -> Option<(&'static str, &str)> {
    match entity {
        EntityId::Camera => Some(("camera", &scene.camera.name)),
        EntityId::Object(i) => scene.objects.get(i).map(|it| (it.entity(), &*it.name)),
        EntityId::Material(i) => scene.materials.get(i).map(|it| ("material", &*it.name)),
        EntityId::Light(i) => scene.lights.get(i).map(|it| (it.entity(), &*it.name)),
        EntityId::Texture(i) => scene.textures.get(i).map(|it| ("texture", &*it.name)),
    }
}

/// Whether an object is this entity, or made of it.
pub(super) fn shows(scene: &Scene, object: usize, entity: EntityId) -> bool {
    let Some(Object {
        material, surface, ..
    }) = scene.objects.get(object)
    else {
        return false;
    };
    match entity {
        EntityId::Object(i) => i == object,
        EntityId::Material(i) => {
            *material == i
                || match surface {
                    Surface::Tiled { altmaterial, .. } => *altmaterial == i,
                    Surface::Plain | Surface::Procedural { .. } | Surface::Textured { .. } => false,
                }
        }
        EntityId::Texture(i) => match surface {
            Surface::Textured { texture, .. } => *texture == i,
            Surface::Plain | Surface::Procedural { .. } | Surface::Tiled { .. } => false,
        },
        // Cameras and lights are not seen in the picture.
        EntityId::Camera | EntityId::Light(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn what_is_made_of_what() {
        let text = "camera cam { pixeldim 2 2 worlddim 8 6 viewpoint 4 3 6 } material a { ambient 1 1 1 }
            material b { ambient 2 2 2 } sphere ball { material a center 4 3 -5 radius 1 }
            tiled_plane floor { material b altmaterial a normal 0 1 0 point 0 -1 0 dimension 1 1 xdir 1 0 0 }
            light lamp { location 0 5 0 emissivity 1 1 1 }";
        let scene = crate::scene::parse("t", text.as_bytes(), Path::new("")).unwrap();
        let titled = |entity| title(&scene, entity);
        assert_eq!(titled(EntityId::Camera), Some(("camera", "cam")));
        assert_eq!(titled(EntityId::Object(1)), Some(("tiled_plane", "floor")));
        assert_eq!(titled(EntityId::Light(0)), Some(("light", "lamp")));
        assert_eq!(titled(EntityId::Material(2)), None);
        let made = |entity| [0, 1].map(|object| shows(&scene, object, entity));
        // Tiles are made of two materials.
        assert_eq!(made(EntityId::Material(0)), [true, true]);
        assert_eq!(made(EntityId::Material(1)), [false, true]);
        assert_eq!(made(EntityId::Object(0)), [true, false]);
        assert_eq!(made(EntityId::Light(0)), [false; 2]);
        assert!(!shows(&scene, 2, EntityId::Object(2)));
    }
}

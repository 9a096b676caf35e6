//! A scene built in code: the course's "static model", through the same checks as a file.
//!
//! In the flow text → lex → parse → [`Scene`] a [`SceneBuilder`] stands in for the first three: it fills the same
//! drafts, and the rows of the `table` say what they must keep. Objects and lights are in `objects`.

mod objects;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::check;
use super::draft::{Assembly, Draft, TexturePicture};
use super::kind::EntityKind;
use super::model::{Material, Scene, Texels};
use super::table;
use super::texture::Pictures;

/// A material of a [`SceneBuilder`]; of no use with another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MaterialId(usize);

/// A texture of a [`SceneBuilder`]; of no use with another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TextureId(usize);

/// What is wrong with one entity of a scene that was built in code.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{entity} {}: {message}", crate::diagnostic::quote(name.as_bytes()))]
pub struct BuildError {
    /// The entity type, as `sphere`.
    pub entity: &'static str,
    /// The name of the entity.
    pub name: String,
    /// What is wrong with it.
    pub message: String,
}

/// Everything that is wrong with a scene that was built in code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuildErrors(pub Vec<BuildError>);

impl fmt::Display for BuildErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            error.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for BuildErrors {}

/// Builds a scene in code.
///
/// Entities are added in the order that a file would have them in; what is wrong is told by [`SceneBuilder::build`],
/// all at once. Names are those of a file: no white space, no braces, no `#`. Since references in a file mean the first
/// material or texture of a name, each name is given once here.
///
/// ```
/// use plumb::scene::{Material, SceneBuilder};
///
/// let mut scene = SceneBuilder::new();
/// scene.camera("cam", [64, 48], [8.0, 6.0], [4.0, 3.0, 6.0]);
/// let ambient = [0.0, 5.0, 0.0].into();
/// let green = scene.material(Material { name: "green".into(), ambient, ..Material::default() });
/// scene.plane("floor", green, [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]);
/// assert_eq!(scene.build()?.objects.len(), 1);
/// # Ok::<(), plumb::scene::BuildErrors>(())
/// ```
#[derive(Debug, Default)]
pub struct SceneBuilder {
    assembly: Assembly,
    pictures: Pictures,
    names: HashMap<(Name, String), usize>,
    errors: Vec<BuildError>,
}

/// What a name is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Name {
    Material,
    Texture,
}

impl SceneBuilder {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the camera: columns and rows of the picture (1 to [`table::MAX_PIXELDIM`] each), size of the screen in
    /// world units (> 0), and where rays start (z > 0). A scene has exactly one.
    pub fn camera(
        &mut self,
        name: &str,
        pixeldim: [u32; 2],
        worlddim: impl Into<DVec2>,
        viewpoint: impl Into<DVec3>,
    ) -> &mut Self {
        if self.assembly.camera.is_some() {
            self.error(EntityKind::Camera, name, "a scene has exactly one camera");
        }
        let draft = Draft {
            pixeldim: pixeldim.map(f64::from),
            worlddim: worlddim.into().to_array(),
            viewpoint: viewpoint.into().to_array(),
            ..named(name)
        };
        self.add(EntityKind::Camera, draft)
    }

    /// Adds a material: every number ≥ 0, transparency ≤ 1.
    pub fn material(&mut self, material: Material) -> MaterialId {
        let index = self.assembly.materials.len();
        self.define(Name::Material, EntityKind::Material, &material.name, index);
        self.add(EntityKind::Material, Draft::of_material(&material));
        MaterialId(index)
    }

    /// Adds a texture from a binary PPM file (P6, maxval 255). An object may use it even if it cannot be read; that is
    /// told by [`SceneBuilder::build`].
    pub fn texture(&mut self, name: &str, path: &Path) -> TextureId {
        let filename = path.to_string_lossy();
        let picture = match self.pictures.read(Path::new(""), &filename) {
            Ok(picture) => Some(picture),
            Err(why) => {
                self.error(
                    EntityKind::Texture,
                    name,
                    format!(
                        "{} {}",
                        crate::diagnostic::quote(filename.as_bytes()),
                        why.message
                    ),
                );
                None
            }
        };
        self.add_texture(name, picture)
    }

    /// Adds a texture made in code; `filename` is what the model listing shows.
    pub fn texture_of(&mut self, name: &str, filename: &str, texels: Texels) -> TextureId {
        let bytes = (u64::from(texels.width) * u64::from(texels.height)).saturating_mul(3);
        if bytes == 0 || bytes != texels.rgb.len() as u64 {
            let (width, height, have) = (texels.width, texels.height, texels.rgb.len());
            self.error(
                EntityKind::Texture,
                name,
                format!("{width} x {height} texels do not fit {have} bytes"),
            );
        }
        let picture = TexturePicture {
            filename: filename.to_owned(),
            path: filename.into(),
            texels: Arc::new(texels),
        };
        self.add_texture(name, Some(picture))
    }

    fn add_texture(&mut self, name: &str, picture: Option<TexturePicture>) -> TextureId {
        let index = self.assembly.textures.len();
        self.define(Name::Texture, EntityKind::Texture, name, index);
        if let Some(picture) = &picture
            && !check::is_name(&picture.filename)
        {
            self.error(
                EntityKind::Texture,
                name,
                "a scene file cannot hold this file name",
            );
        }
        self.add(
            EntityKind::Texture,
            Draft {
                picture,
                ..named(name)
            },
        );
        TextureId(index)
    }

    /// The scene.
    ///
    /// # Errors
    /// Everything that is wrong with it, in the order in which it was added.
    pub fn build(mut self) -> Result<Scene, BuildErrors> {
        let assembly = std::mem::take(&mut self.assembly);
        if assembly.camera.is_none() {
            self.error(
                EntityKind::Camera,
                "",
                "a scene has exactly one camera, and this has none",
            );
        }
        match assembly.finish() {
            Some(scene) if self.errors.is_empty() => Ok(scene),
            _ => Err(BuildErrors(self.errors)),
        }
    }

    fn error(&mut self, kind: EntityKind, name: &str, message: impl Into<String>) {
        self.errors.push(BuildError {
            entity: table::of(kind).name,
            name: name.to_owned(),
            message: message.into(),
        });
    }

    fn define(&mut self, what: Name, kind: EntityKind, name: &str, index: usize) {
        match self.names.entry((what, name.to_owned())) {
            Entry::Vacant(entry) => {
                entry.insert(index);
            }
            Entry::Occupied(_) => self.error(
                kind,
                name,
                "this name is taken: in a file it means the first of that name",
            ),
        }
    }

    fn add(&mut self, kind: EntityKind, mut draft: Draft) -> &mut Self {
        let (materials, textures) = (self.assembly.materials.len(), self.assembly.textures.len());
        let faults = check::faults(kind, &mut draft, materials, textures);
        for fault in faults {
            self.error(kind, &draft.name, fault);
        }
        self.assembly.add(kind, check::positive_zeros(kind, draft));
        self
    }
}

fn named(name: &str) -> Draft {
    Draft {
        name: name.to_owned(),
        ..Draft::default()
    }
}

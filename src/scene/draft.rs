//! An entity while its attributes come in, and the scene while its entities come in.
//!
//! The rows of the `table` say which field of a [`Draft`] an attribute goes to; an [`Assembly`] turns a
//! finished draft into the data model. The listing goes the other way: from the model to a draft, to print row by row.
//! So this is the last step of text → lex → parse → [`Scene`]. On the way back the model is taken apart field by field,
//! here and wherever it is read as a whole, so that the compiler names each place that a new field has to reach.

mod of_model;

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::kind::{Class, EntityKind, LightClass};
use super::model::{
    Beam, Camera, Cone, Extent, Light, Material, Object, ProjectorPicture, Quadric, Rectangle,
    Scene, Shape, Surface, Texels, Texture, TextureMode, Triangle,
};

/// The fields of all entities; an entity uses those that its rows name.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    /// The name of the entity.
    pub(super) name: String,
    /// Index of the material.
    pub(super) material: usize,
    /// Index of the other material of tiles.
    pub(super) altmaterial: usize,
    /// Index of the texture.
    pub(super) texture: usize,
    /// The picture of a texture.
    pub(super) picture: Option<TexturePicture>,
    pub(super) pixeldim: [f64; 2],
    pub(super) worlddim: [f64; 2],
    pub(super) viewpoint: [f64; 3],
    pub(super) ambient: [f64; 3],
    pub(super) diffuse: [f64; 3],
    pub(super) specular: [f64; 3],
    pub(super) shininess: [f64; 1],
    pub(super) transparency: [f64; 1],
    pub(super) normal: [f64; 3],
    pub(super) point: [f64; 3],
    pub(super) center: [f64; 3],
    pub(super) radius: [f64; 1],
    pub(super) dimension: [f64; 2],
    pub(super) xdir: Option<[f64; 3]>,
    pub(super) shader: [f64; 1],
    pub(super) mode: [f64; 1],
    pub(super) location: [f64; 3],
    pub(super) emissivity: [f64; 3],
    pub(super) theta: [f64; 1],
    pub(super) vertices: [[f64; 3]; 3],
    /// The side that a triangle shows.
    pub(super) facing: Option<[f64; 3]>,
    /// A triangle's point.
    pub(super) idle_point: Option<[f64; 3]>,
    pub(super) coefficients: [f64; 10],
    pub(super) lower: Option<[f64; 3]>,
    pub(super) upper: Option<[f64; 3]>,
}

/// A picture that was read for a texture.
#[derive(Debug, Clone)]
pub(super) struct TexturePicture {
    /// The file name as the scene gives it.
    pub(super) filename: String,
    /// Where it was read from.
    pub(super) path: PathBuf,
    /// Its texels.
    pub(super) texels: Arc<Texels>,
    /// What is odd about its file.
    pub(super) remark: Option<String>,
}

impl TexturePicture {
    /// A picture of which only the name is known.
    pub(super) fn unread(filename: &str) -> Self {
        let texels = Texels {
            width: 0,
            height: 0,
            rgb: Vec::new(),
        };
        Self {
            filename: filename.to_owned(),
            path: PathBuf::from(filename),
            texels: Arc::new(texels),
            remark: None,
        }
    }
}

/// A scene while its entities come in.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    /// The first camera.
    pub(super) camera: Option<Camera>,
    /// Materials so far.
    pub(super) materials: Vec<Material>,
    /// Objects so far.
    pub(super) objects: Vec<Object>,
    /// Lights so far.
    pub(super) lights: Vec<Light>,
    /// Textures so far.
    pub(super) textures: Vec<Texture>,
}

impl Assembly {
    /// Adds an entity. That it keeps every limit was checked before, or the scene is not going to be used.
    pub(super) fn add(&mut self, kind: EntityKind, draft: Draft) {
        match kind {
            EntityKind::Camera => {
                self.camera.get_or_insert(draft.into_camera());
            }
            EntityKind::Material => self.materials.push(draft.into_material()),
            EntityKind::Texture => {
                // A texture without a picture is an error that was reported; its place in the list stays taken.
                let picture = draft.picture.unwrap_or_else(|| TexturePicture::unread(""));
                self.textures.push(Texture {
                    name: draft.name,
                    filename: picture.filename,
                    path: picture.path,
                    texels: picture.texels,
                    remark: picture.remark,
                });
            }
            EntityKind::Light(class) => self.lights.push(draft.into_light(class)),
            EntityKind::Object(class) => self.objects.push(draft.into_object(class)),
        }
    }

    /// The scene, once there is a camera.
    pub(super) fn finish(self) -> Option<Scene> {
        let Assembly {
            camera,
            mut materials,
            mut objects,
            lights,
            textures,
        } = self;
        materials.shrink_to_fit();
        objects.shrink_to_fit();
        camera.map(|camera| Scene {
            camera,
            materials,
            objects,
            lights,
            textures,
        })
    }
}

impl Draft {
    pub(super) fn into_camera(self) -> Camera {
        Camera {
            name: self.name,
            pixeldim: self.pixeldim.map(|pixels| pixels as u32),
            worlddim: self.worlddim.into(),
            viewpoint: self.viewpoint.into(),
        }
    }

    pub(super) fn into_material(self) -> Material {
        Material {
            name: self.name,
            ambient: self.ambient.into(),
            diffuse: self.diffuse.into(),
            specular: self.specular.into(),
            shininess: self.shininess[0],
            transparency: self.transparency[0],
        }
    }

    pub(super) fn into_light(self, class: LightClass) -> Light {
        let beam = self.beam(class);
        Light {
            name: self.name,
            location: self.location.into(),
            emissivity: self.emissivity.into(),
            beam,
        }
    }

    pub(super) fn into_object(self, class: Class) -> Object {
        let (shape, surface) = self.shape(class);
        Object {
            name: self.name,
            material: self.material,
            shape,
            surface,
        }
    }

    fn shape(&self, class: Class) -> (Shape, Surface) {
        let sphere = Shape::Sphere {
            center: self.center.into(),
            radius: self.radius[0],
        };
        let plane = |extent| Shape::Plane {
            normal: self.normal.into(),
            point: self.point.into(),
            extent,
        };
        let rectangle = Extent::Rectangle(self.rectangle());
        let triangle = Shape::Triangle(Triangle {
            vertices: self.vertices.map(DVec3::from),
            normal: self.facing.map(DVec3::from),
            point: self.idle_point.map(DVec3::from),
        });
        let quadric = Shape::Quadric(Quadric {
            coefficients: self.coefficients,
            lower: self.lower.map(DVec3::from),
            upper: self.upper.map(DVec3::from),
        });
        let procedural = Surface::Procedural {
            shader: self.shader[0] as u32,
        };
        match class {
            Class::Plane => (plane(Extent::Unbounded), Surface::Plain),
            Class::ProceduralPlane => (plane(Extent::Unbounded), procedural),
            Class::Finite => (plane(rectangle), Surface::Plain),
            Class::Sphere => (sphere, Surface::Plain),
            Class::ProceduralSphere => (sphere, procedural),
            Class::Triangle => (triangle, Surface::Plain),
            Class::ProceduralTriangle => (triangle, procedural),
            Class::Quadric => (quadric, Surface::Plain),
            Class::ProceduralQuadric => (quadric, procedural),
            Class::Tiled => {
                let (dimension, xdir) = (DVec2::from(self.dimension), self.xdir.map(DVec3::from));
                (
                    plane(Extent::Unbounded),
                    Surface::Tiled {
                        dimension,
                        altmaterial: self.altmaterial,
                        xdir,
                    },
                )
            }
            Class::Textured => (
                plane(rectangle),
                Surface::Textured {
                    texture: self.texture,
                    mode: self.texture_mode(),
                },
            ),
        }
    }

    fn beam(&self, class: LightClass) -> Beam {
        match class {
            LightClass::Light => Beam::Everywhere,
            LightClass::Spotlight => Beam::Cone(Cone {
                point: self.point.into(),
                theta: self.theta[0],
            }),
            LightClass::Projector => Beam::Picture(ProjectorPicture {
                normal: self.normal.into(),
                point: self.point.into(),
                rectangle: self.rectangle(),
                texture: self.texture,
                mode: self.texture_mode(),
            }),
        }
    }

    fn rectangle(&self) -> Rectangle {
        Rectangle {
            xdir: self.xdir.unwrap_or_default().into(),
            dimensions: self.dimension.into(),
        }
    }

    fn texture_mode(&self) -> TextureMode {
        if self.mode[0] == 0.0 {
            TextureMode::Fit
        } else {
            TextureMode::Tile
        }
    }

    pub(super) fn set_texture(&mut self, texture: usize, mode: TextureMode) {
        self.texture = texture;
        self.mode = [if mode == TextureMode::Fit { 0.0 } else { 1.0 }];
    }
}

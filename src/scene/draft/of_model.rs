//! The way back, from the model to a [`Draft`]: to list an entity, to check it, or to change a number of it.

use super::{Draft, TexturePicture};
use crate::scene::kind::EntityKind;
use crate::scene::model::{
    Beam, Camera, Cone, Extent, Light, Material, Object, ProjectorPicture, Quadric, Rectangle,
    Shape, Surface, Texture, Triangle,
};

impl Draft {
    fn set_rectangle(&mut self, rectangle: &Rectangle) {
        let Rectangle { xdir, dimensions } = *rectangle;
        self.xdir = Some(xdir.to_array());
        self.dimension = dimensions.to_array();
    }

    /// A camera, to list or to check.
    pub(in crate::scene) fn of_camera(camera: &Camera) -> Self {
        let Camera {
            name,
            pixeldim,
            worlddim,
            viewpoint,
        } = camera;
        Self {
            name: name.clone(),
            pixeldim: pixeldim.map(f64::from),
            worlddim: worlddim.to_array(),
            viewpoint: viewpoint.to_array(),
            ..Self::default()
        }
    }

    /// A material, to list or to check.
    pub(in crate::scene) fn of_material(material: &Material) -> Self {
        let Material {
            name,
            ambient,
            diffuse,
            specular,
            shininess,
            transparency,
        } = material;
        Self {
            name: name.clone(),
            ambient: ambient.to_array(),
            diffuse: diffuse.to_array(),
            specular: specular.to_array(),
            shininess: [*shininess],
            transparency: [*transparency],
            ..Self::default()
        }
    }

    /// A texture, to list or to check.
    pub(in crate::scene) fn of_texture(texture: &Texture) -> Self {
        let Texture {
            name,
            filename,
            path,
            texels,
            remark,
        } = texture.clone();
        Self {
            name,
            picture: Some(TexturePicture {
                filename,
                path,
                texels,
                remark,
            }),
            ..Self::default()
        }
    }

    /// A light, to list or to check, and its kind.
    pub(in crate::scene) fn of_light(light: &Light) -> (EntityKind, Self) {
        let Light {
            name,
            location,
            emissivity,
            beam,
        } = light;
        let mut draft = Self {
            name: name.clone(),
            location: location.to_array(),
            emissivity: emissivity.to_array(),
            ..Self::default()
        };
        match beam {
            Beam::Everywhere => {}
            Beam::Cone(Cone { point, theta }) => {
                (draft.point, draft.theta) = (point.to_array(), [*theta]);
            }
            Beam::Picture(ProjectorPicture {
                normal,
                point,
                rectangle,
                texture,
                mode,
            }) => {
                (draft.normal, draft.point) = (normal.to_array(), point.to_array());
                draft.set_rectangle(rectangle);
                draft.set_texture(*texture, *mode);
            }
        }
        (light.kind(), draft)
    }

    /// An object, to list or to check, and its class.
    pub(in crate::scene) fn of_object(object: &Object) -> (EntityKind, Self) {
        let Object {
            name,
            material,
            shape,
            surface,
        } = object;
        let mut draft = Self {
            name: name.clone(),
            material: *material,
            ..Self::default()
        };
        match *shape {
            Shape::Sphere { center, radius } => {
                (draft.center, draft.radius) = (center.to_array(), [radius]);
            }
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                (draft.normal, draft.point) = (normal.to_array(), point.to_array());
                match extent {
                    Extent::Unbounded => {}
                    Extent::Rectangle(rectangle) => draft.set_rectangle(&rectangle),
                }
            }
            Shape::Triangle(Triangle {
                vertices,
                normal,
                point,
            }) => {
                draft.vertices = vertices.map(|vertex| vertex.to_array());
                draft.facing = normal.map(|normal| normal.to_array());
                draft.idle_point = point.map(|point| point.to_array());
            }
            Shape::Quadric(Quadric {
                coefficients,
                lower,
                upper,
            }) => {
                draft.coefficients = coefficients;
                draft.lower = lower.map(|lower| lower.to_array());
                draft.upper = upper.map(|upper| upper.to_array());
            }
        }
        match *surface {
            Surface::Plain => {}
            Surface::Procedural { shader } => draft.shader = [f64::from(shader)],
            Surface::Tiled {
                dimension,
                altmaterial,
                xdir,
            } => {
                (draft.dimension, draft.altmaterial) = (dimension.to_array(), altmaterial);
                draft.xdir = xdir.map(|xdir| xdir.to_array());
            }
            Surface::Textured { texture, mode } => draft.set_texture(texture, mode),
        }
        (EntityKind::Object(object.class()), draft)
    }
}

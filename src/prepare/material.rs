//! Materials and lights in the tracer's number type.

use super::extent::of_size_one;
use super::projector::Projector;
use crate::real::rational::two_to;
use crate::real::{Real, V3};
use crate::scene;

/// How a surface answers light.
#[derive(Debug, Clone, Copy)]
pub struct Material<R> {
    /// Ambient reflectivity.
    pub ambient: V3<R>,
    /// Diffuse reflectivity.
    pub diffuse: V3<R>,
    /// Specular reflectivity: of the mirror image and of the glint.
    pub specular: V3<R>,
    /// Exponent of the glint; 0 for none.
    pub shininess: f64,
    /// Share of light that goes straight through.
    pub transparency: R,
    /// What tints light that goes through: K/max(K), K the diffuse reflectivity; white where that is black.
    pub tint: V3<R>,
    /// Which channels of the mirror image count for anything.
    pub mirrored: [bool; 3],
    /// The same of what comes through.
    pub passed: [bool; 3],
    /// Whether any light goes through.
    pub transparent: bool,
    /// Whether there is a mirror image.
    pub mirror: bool,
}

impl<R: Real> Material<R> {
    /// Prepares a material.
    pub fn new(material: &scene::Material) -> Self {
        let scene::Material {
            name: _,
            ambient,
            diffuse: color,
            specular,
            shininess,
            transparency,
        } = *material;
        let diffuse = V3::<R>::exact(color);
        let largest = color.max_element();
        let one = R::exact(1.0);
        let tint = if largest > 0.0 {
            let by = R::exact(largest);
            V3::new(diffuse.x / by, diffuse.y / by, diffuse.z / by)
        } else {
            V3::new(one, one, one)
        };
        Self {
            ambient: V3::exact(ambient),
            diffuse,
            specular: V3::exact(specular),
            shininess,
            transparency: R::exact(transparency),
            tint,
            mirrored: specular.to_array().map(|c| c > 0.0),
            passed: color.to_array().map(|c| c > 0.0 || largest <= 0.0),
            transparent: transparency != 0.0,
            mirror: specular.max_element() > 0.0,
        }
    }
}

/// A light.
#[derive(Debug, Clone)]
pub struct Light<R> {
    /// From the viewpoint, in units of 2^scale.
    pub location: V3<R>,
    /// How bright it is.
    pub emissivity: V3<R>,
    /// A spotlight's axis, of unit length, and the cosine of its half angle.
    pub cone: Option<(V3<R>, R)>,
    /// 1 − that cosine, of a cone so narrow that the difference from 1 is what counts.
    pub narrow: Option<R>,
    /// What a projector throws.
    pub projector: Option<Box<Projector<R>>>,
}

impl<R: Real> Light<R> {
    /// Prepares a light.
    pub fn new(scene: &scene::Scene, scale: i32, light: &scene::Light) -> Self {
        let scene::Light {
            name: _,
            location,
            emissivity,
            beam,
        } = *light;
        let (cone, projector) = match beam {
            scene::Beam::Everywhere => (None, None),
            scene::Beam::Cone(cone) => (Some(cone), None),
            scene::Beam::Picture(picture) => {
                let projector = Projector::new(scene, location, &picture);
                (None, Some(Box::new(projector)))
            }
        };
        let unit = R::exact(two_to(-scale));
        let at = location;
        let location = V3::exact(at);
        let narrow = cone.and_then(|cone| R::versine_degrees(cone.theta));
        let cone = cone.map(|scene::Cone { point, theta }| {
            let axis = of_size_one(V3::exact(point) - location, point - at);
            (axis.unit(), R::cos_degrees(theta))
        });
        Self {
            location: (location - V3::exact(scene.camera.viewpoint)) * unit,
            emissivity: V3::exact(emissivity),
            cone,
            narrow,
            projector,
        }
    }
}

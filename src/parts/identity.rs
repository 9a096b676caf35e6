//! What a picture's parts have in common, as one hash: two parts with the same hash are parts of the same picture, cut
//! in the same way.
//!
//! Hashed is what changes bytes: the scene as it was read (no names, no comments, textures by their texels), the
//! settings, the rules. What changes none (devices, threads, bands) is not.

use std::fmt;
use std::ops::Range;

use glam::{DVec2, DVec3};
use sha2::{Digest, Sha256};

use super::cut::Cut;
use crate::scene::{
    Beam, Camera, Cone, Extent, Light, Material, Object, ProjectorPicture, Quadric, Rectangle,
    Scene, Shape, Surface, Texels, Texture, TextureMode, Triangle,
};
use crate::settings::{SamplePattern, Settings};

/// The version of the rules by which a scene becomes bytes. Whoever changes a byte of any scene's picture raises it:
/// parts made by different rules do not fit together. A test holds pictures against it.
pub const RULES: u32 = 1;

/// What the parts of one picture have in common.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Identity(pub [u8; 32]);

impl fmt::Debug for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl Identity {
    /// Of the scene's picture, as the settings ask for it, cut into these parts.
    pub fn new(scene: &Scene, settings: &Settings, cut: &Cut) -> Self {
        let mut hash = Hasher(Sha256::new());
        hash.number(RULES);
        hash.scene(scene);
        hash.settings(settings);
        let Range { start, end } = cut.picture();
        hash.number(start);
        hash.number(end);
        hash.count(cut.parts() as usize);
        for number in 1..=cut.parts() {
            hash.number(cut.rows(number).start);
        }
        Self(hash.0.finalize().into())
    }
}

/// Hashes what a scene is made of. Everything is taken apart by name, so that the compiler asks what is to be done with
/// what is new. Each thing has a fixed length, or begins with its length or its kind.
struct Hasher(Sha256);

impl Hasher {
    fn number(&mut self, number: u32) {
        self.0.update(number.to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        self.0.update((count as u64).to_le_bytes());
    }

    fn real(&mut self, real: f64) {
        self.0.update(real.to_bits().to_le_bytes());
    }

    fn pair(&mut self, pair: DVec2) {
        pair.to_array().into_iter().for_each(|real| self.real(real));
    }

    fn vector(&mut self, vector: DVec3) {
        vector
            .to_array()
            .into_iter()
            .for_each(|real| self.real(real));
    }

    /// A vector that may be missing.
    fn option(&mut self, vector: Option<DVec3>) {
        self.number(u32::from(vector.is_some()));
        if let Some(vector) = vector {
            self.vector(vector);
        }
    }

    /// A list's length, then what is in it.
    fn list<T>(&mut self, list: &[T], each: impl Fn(&mut Self, &T)) {
        self.count(list.len());
        list.iter().for_each(|item| each(self, item));
    }

    fn settings(&mut self, settings: &Settings) {
        let Settings {
            screen_tolerance,
            samples,
            limits,
            values,
            // Parts are certified, and of rows that are told by the cut.
            precision: _,
            rows: _,
            jitter: _,
            // These change no byte.
            backend: _,
            adapter: _,
            threads: _,
            verdicts: _,
            band_rows: _,
            cache: _,
        } = settings;
        self.real(*screen_tolerance);
        self.number(*samples);
        self.number(
            match settings.supersampling().map(|several| several.spread) {
                None => 0,
                Some(SamplePattern::Hash) => 1,
                Some(SamplePattern::Course) => 2,
            },
        );
        self.real(limits.max_path);
        self.number(u32::from(*values));
    }

    fn scene(&mut self, scene: &Scene) {
        let Scene {
            camera,
            materials,
            objects,
            lights,
            textures,
        } = scene;
        let Camera {
            name: _,
            pixeldim,
            worlddim,
            viewpoint,
        } = camera;
        pixeldim.iter().for_each(|side| self.number(*side));
        self.pair(*worlddim);
        self.vector(*viewpoint);
        self.list(materials, Self::material);
        self.list(objects, Self::object);
        self.list(lights, Self::light);
        self.list(textures, Self::texture);
    }

    fn material(&mut self, material: &Material) {
        let Material {
            name: _,
            ambient,
            diffuse,
            specular,
            shininess,
            transparency,
        } = material;
        for reflectivity in [ambient, diffuse, specular] {
            self.vector(*reflectivity);
        }
        self.real(*shininess);
        self.real(*transparency);
    }

    fn object(&mut self, object: &Object) {
        let Object {
            name: _,
            material,
            shape,
            surface,
        } = object;
        self.count(*material);
        self.shape(shape);
        match surface {
            Surface::Plain => self.number(0),
            Surface::Tiled {
                dimension,
                altmaterial,
                xdir,
            } => {
                self.number(1);
                self.pair(*dimension);
                self.count(*altmaterial);
                self.option(*xdir);
            }
            Surface::Procedural { shader } => {
                self.number(2);
                self.number(*shader);
            }
            Surface::Textured { texture, mode } => {
                self.number(3);
                self.count(*texture);
                self.mode(*mode);
            }
        }
    }

    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                self.number(0);
                self.vector(*normal);
                self.vector(*point);
                match extent {
                    Extent::Unbounded => self.number(0),
                    Extent::Rectangle(rectangle) => {
                        self.number(1);
                        self.rectangle(rectangle);
                    }
                }
            }
            Shape::Sphere { center, radius } => {
                self.number(1);
                self.vector(*center);
                self.real(*radius);
            }
            Shape::Triangle(Triangle {
                vertices,
                normal,
                point: _,
            }) => {
                self.number(2);
                vertices.iter().for_each(|vertex| self.vector(*vertex));
                self.option(*normal);
            }
            Shape::Quadric(Quadric {
                coefficients,
                lower,
                upper,
            }) => {
                self.number(3);
                coefficients.iter().for_each(|real| self.real(*real));
                self.option(*lower);
                self.option(*upper);
            }
        }
    }

    fn rectangle(&mut self, rectangle: &Rectangle) {
        let Rectangle { xdir, dimensions } = rectangle;
        self.vector(*xdir);
        self.pair(*dimensions);
    }

    fn mode(&mut self, mode: TextureMode) {
        self.number(match mode {
            TextureMode::Fit => 0,
            TextureMode::Tile => 1,
        });
    }

    fn light(&mut self, light: &Light) {
        let Light {
            name: _,
            location,
            emissivity,
            beam,
        } = light;
        self.vector(*location);
        self.vector(*emissivity);
        match beam {
            Beam::Everywhere => self.number(0),
            Beam::Cone(Cone { point, theta }) => {
                self.number(1);
                self.vector(*point);
                self.real(*theta);
            }
            Beam::Picture(ProjectorPicture {
                normal,
                point,
                rectangle,
                texture,
                mode,
            }) => {
                self.number(2);
                self.vector(*normal);
                self.vector(*point);
                self.rectangle(rectangle);
                self.count(*texture);
                self.mode(*mode);
            }
        }
    }

    fn texture(&mut self, texture: &Texture) {
        let Texture {
            name: _,
            filename: _,
            path: _,
            texels,
            remark: _,
        } = texture;
        let Texels { width, height, rgb } = &**texels;
        self.number(*width);
        self.number(*height);
        self.count(rgb.len());
        self.0.update(rgb);
    }
}

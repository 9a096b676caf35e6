//! The scene in flat f32 records for `textbook.wgsl`: taken from the viewpoint and worked out in f64, or as it is.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use crate::scene::{self, Extent, Scene, Shape, Surface, TextureMode};

/// An object, as the shader has it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Object {
    normal: [f32; 3],
    is_sphere: u32,
    point: [f32; 3],
    radius: f32,
    xdir: [f32; 3],
    surface: u32,
    ydir: [f32; 3],
    distance: f32,
    extent: [f32; 2],
    dimension: [f32; 2],
    begins: [f32; 3],
    material: u32,
    odd: [f32; 3],
    altmaterial: u32,
    texels: [u32; 4],
}

/// A material, as the shader has it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Material {
    ambient: [f32; 3],
    transparency: f32,
    diffuse: [f32; 3],
    shininess: f32,
    specular: [f32; 3],
    unused: u32,
}

/// A light, as the shader has it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Light {
    location: [f32; 3],
    theta: f32,
    emissivity: [f32; 3],
    unused: u32,
    point: [f32; 3],
    picture: u32,
}

/// What `Object::surface` says; the shader has the same numbers.
const PLAIN: u32 = 0;
const TILED: u32 = 1;
const TILED_ALONG: u32 = 2;
const TEXTURED: u32 = 3;
const PPLANE: u32 = 16;
const PSPHERE: u32 = 32;

/// The notes' number that keeps tile indices from being negative.
const TILES_BEGIN: f64 = 10_000.0;

/// All records of a scene; none of the lists is empty, as no buffer may be.
#[derive(Debug)]
pub(super) struct Records {
    pub(super) objects: Vec<Object>,
    pub(super) materials: Vec<Material>,
    pub(super) lights: Vec<Light>,
    pub(super) texels: Vec<u32>,
}

impl Records {
    /// Of a scene; `prepared` in f64 and from the viewpoint.
    pub(super) fn new(scene: &Scene, prepared: bool) -> Self {
        let mut texels = Vec::new();
        let firsts: Vec<u32> = scene
            .textures
            .iter()
            .map(|texture| {
                let first = texels.len() as u32;
                let three = texture.texels.rgb.as_chunks::<3>().0;
                texels.extend(
                    three
                        .iter()
                        .map(|&[r, g, b]| u32::from_le_bytes([r, g, b, 0])),
                );
                first
            })
            .collect();
        let view = if prepared {
            scene.camera.viewpoint
        } else {
            DVec3::ZERO
        };
        let pack = Pack {
            scene,
            view,
            prepared,
            firsts,
        };
        Self {
            objects: pack.objects(),
            materials: or_zero(
                scene
                    .materials
                    .iter()
                    .map(|m| Material {
                        ambient: f32s(m.ambient),
                        transparency: m.transparency as f32,
                        diffuse: f32s(m.diffuse),
                        shininess: m.shininess as f32,
                        specular: f32s(m.specular),
                        unused: 0,
                    })
                    .collect(),
            ),
            lights: or_zero((0..scene.lights.len()).map(|i| pack.light(i)).collect()),
            texels: or_zero(texels),
        }
    }
}

struct Pack<'a> {
    scene: &'a Scene,
    /// What lengths are taken from.
    view: DVec3,
    prepared: bool,
    /// Where the texels of each texture begin.
    firsts: Vec<u32>,
}

/// A plane's directions, for what goes along them.
struct Frame {
    /// Of unit length.
    normal: DVec3,
    /// The direction that a rectangle or tiles follow, if there is one.
    xdir: Option<DVec3>,
    /// Lengths of a rectangle's sides.
    sides: DVec2,
}

impl Pack<'_> {
    /// All objects; behind them, and one more where there are none, the pictures of projectors.
    fn objects(&self) -> Vec<Object> {
        let objects = self.scene.objects.iter();
        let mut records = or_zero(objects.map(|object| self.object(object)).collect());
        let pictures = self.scene.lights.iter().filter_map(projected);
        records.extend(pictures.map(|object| self.object(&object)));
        records
    }

    fn object(&self, object: &scene::Object) -> Object {
        let mut record = Object {
            material: object.material as u32,
            altmaterial: object.material as u32,
            ..Object::zeroed()
        };
        let mut frame = self.shape(&mut record, &object.shape);
        record.surface = self.surface(&mut record, object.surface, &mut frame);
        if let Some(along) = frame.xdir {
            let [x, y] = if self.prepared {
                directions(frame.normal, along)
            } else {
                [along, DVec3::ZERO]
            };
            (record.xdir, record.ydir) = (f32s(x), f32s(y));
        }
        record
    }

    /// Packs where the object is.
    fn shape(&self, record: &mut Object, shape: &Shape) -> Frame {
        let mut frame = Frame {
            normal: DVec3::ZERO,
            xdir: None,
            sides: DVec2::ONE,
        };
        match *shape {
            Shape::Sphere { center, radius } => {
                record.is_sphere = 1;
                record.point = f32s(center - self.view);
                record.radius = radius as f32;
            }
            Shape::Triangle(_) | Shape::Quadric(_) => {}
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                let unit = normal.normalize();
                frame.normal = unit;
                record.normal = f32s(if self.prepared { unit } else { normal });
                record.point = f32s(point - self.view);
                record.distance = unit.dot(point - self.view) as f32;
                match extent {
                    Extent::Unbounded => {}
                    Extent::Rectangle(rectangle) => {
                        frame.xdir = Some(rectangle.xdir);
                        frame.sides = rectangle.dimensions;
                        record.extent = rectangle.dimensions.as_vec2().to_array();
                    }
                }
            }
        }
        frame
    }

    /// Packs what the object looks like, and returns its `surface`.
    fn surface(&self, record: &mut Object, surface: Surface, frame: &mut Frame) -> u32 {
        let scene = self.scene;
        match surface {
            Surface::Plain => PLAIN,
            Surface::Procedural { shader } if record.is_sphere != 0 => PSPHERE + shader,
            Surface::Procedural { shader } => {
                self.begin(record, &DVec3::AXES, [2.0; 3], 1000.0);
                PPLANE + shader
            }
            Surface::Tiled {
                dimension,
                altmaterial,
                xdir,
            } => {
                record.altmaterial = altmaterial as u32;
                record.dimension = dimension.as_vec2().to_array();
                let per_unit = [1.0 / dimension.x, 1.0 / dimension.y, 0.0];
                let (surface, [x, y]) = match xdir {
                    None => (TILED, [DVec3::X, DVec3::Z]),
                    Some(along) => {
                        frame.xdir = Some(along);
                        (TILED_ALONG, directions(frame.normal, along))
                    }
                };
                let begins = [TILES_BEGIN; 2];
                self.begin_at(record, &[x, y, DVec3::ZERO], per_unit, begins);
                surface
            }
            Surface::Textured { texture, mode } => {
                let texels = &scene.textures[texture].texels;
                record.texels = [
                    self.firsts[texture],
                    texels.width,
                    texels.height,
                    u32::from(mode == TextureMode::Tile),
                ];
                let sizes = DVec2::new(f64::from(texels.width), f64::from(texels.height));
                let pixels = DVec2::from(scene.camera.pixeldim.map(f64::from));
                let per_unit = match mode {
                    TextureMode::Fit => sizes / frame.sides,
                    TextureMode::Tile => pixels / scene.camera.worlddim,
                };
                record.dimension = per_unit.as_vec2().to_array();
                TEXTURED
            }
        }
    }

    /// Where the indices of tiles begin, as seen from the viewpoint: floor(row·H·per_unit + ...).
    fn begin_at(
        &self,
        record: &mut Object,
        rows: &[DVec3; 3],
        per_unit: [f64; 3],
        begins: [f64; 2],
    ) {
        let at = |i: usize| (rows[i].dot(self.view) + begins.get(i).unwrap_or(&0.0)) * per_unit[i];
        self.split(record, [at(0), at(1), at(2)]);
    }

    /// The same of blocks, whose index is floor(row·H·per_unit + offset).
    fn begin(&self, record: &mut Object, rows: &[DVec3; 3], per_unit: [f64; 3], offset: f64) {
        let at = |i: usize| rows[i].dot(self.view) * per_unit[i] + offset;
        self.split(record, [at(0), at(1), at(2)]);
    }

    /// Indices at p = 0 as a fraction and the parity of the whole part.
    fn split(&self, record: &mut Object, at: [f64; 3]) {
        if self.prepared {
            record.begins = at.map(|at| (at - at.floor()) as f32);
            record.odd = at.map(|at| at.floor().rem_euclid(2.0) as f32);
        }
    }

    fn light(&self, index: usize) -> Light {
        let scene::Light {
            name: _,
            location,
            emissivity,
            beam,
        } = self.scene.lights[index];
        let mut record = Light {
            location: f32s(location - self.view),
            emissivity: f32s(emissivity),
            theta: if self.prepared { -2.0 } else { 0.0 },
            ..Light::zeroed()
        };
        if let scene::Beam::Picture(_) = beam {
            let before = self.scene.lights[..index].iter().filter_map(projected);
            record.picture = (self.scene.objects.len().max(1) + before.count()) as u32;
        }
        if let scene::Beam::Cone(scene::Cone { point, theta }) = beam {
            if self.prepared {
                record.theta = theta.to_radians().cos() as f32;
                record.point = f32s((point - location).normalize());
            } else {
                record.theta = theta as f32;
                record.point = f32s(point);
            }
        }
        record
    }
}

/// The picture of a projector, as a rectangle.
fn projected(light: &scene::Light) -> Option<scene::Object> {
    let scene::Beam::Picture(picture) = light.beam else {
        return None;
    };
    let scene::ProjectorPicture {
        normal,
        point,
        rectangle,
        texture,
        mode,
    } = picture;
    Some(scene::Object {
        name: String::new(),
        material: 0,
        shape: Shape::Plane {
            normal,
            point,
            extent: Extent::Rectangle(rectangle),
        },
        surface: Surface::Textured { texture, mode },
    })
}

/// The two directions of a plane with this unit normal.
fn directions(unit: DVec3, xdir: DVec3) -> [DVec3; 2] {
    let x = (xdir - unit.dot(xdir) * unit).normalize();
    [x, unit.cross(x)]
}

fn f32s(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn or_zero<T: Zeroable>(mut records: Vec<T>) -> Vec<T> {
    if records.is_empty() {
        records.push(T::zeroed());
    }
    records
}

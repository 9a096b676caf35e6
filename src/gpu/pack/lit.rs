//! What a lit scene needs beside: materials, lights, and every object for rays from anywhere.

use super::{Light, LitObject, Material, Packed, WorldPlane, WorldSphere, f32x3};
use crate::prepare::{self, Prepared, World, world};
use crate::real::V3;

/// The records of a lit scene, and what its materials can do.
#[derive(Debug, Clone)]
pub struct Lit {
    /// One for each object of the scene.
    pub objects: Vec<LitObject>,
    /// The scene's materials.
    pub materials: Vec<Material>,
    /// The scene's lights.
    pub lights: Vec<Light>,
    /// Every plane.
    pub planes: Vec<WorldPlane>,
    /// Every sphere; those of the tree come first.
    pub spheres: Vec<WorldSphere>,
    /// How many of the spheres the tree holds.
    pub in_tree: usize,
    /// A hit on a plane counts only up to this z.
    pub highest: f32,
    /// Some object is a mirror.
    pub mirror: bool,
    /// Some object lets light through.
    pub clear: bool,
    /// Some object glints.
    pub glint: bool,
}

/// Marks a sphere in [`LitObject::place`].
const SPHERE_BIT: u32 = 1 << 31;

impl Lit {
    pub(super) fn new(scene: &Prepared<f64>, world: &World<f64>, packed: &Packed) -> Self {
        let mut seen = vec![0; scene.surfaces.len()];
        for (number, sphere) in (1..).zip(&packed.small_spheres) {
            seen[sphere.object as usize] = number;
        }
        let place = |object: usize| {
            world.places[object] as u32
                | if scene.is_plane[object] {
                    0
                } else {
                    SPHERE_BIT
                }
        };
        let used = || scene.materials.iter().map(|&index| &scene.palette[index]);
        Self {
            objects: (0..scene.surfaces.len())
                .map(|object| LitObject {
                    material: scene.materials[object] as u32,
                    kind: packed.objects[object].kind,
                    group: world.groups[object],
                    place: place(object),
                })
                .collect(),
            materials: scene.palette.iter().map(material).collect(),
            lights: world.lights.iter().map(light).collect(),
            planes: world
                .planes
                .iter()
                .map(|plane| world_plane(world, plane))
                .collect(),
            spheres: world
                .spheres
                .iter()
                .map(|s| world_sphere(world, s, seen[s.object]))
                .collect(),
            in_tree: world.bvh.as_ref().map_or(0, |bvh| bvh.len),
            // An axis plane's own z meets the rule exactly, so its rounding must not cross it.
            highest: world.highest as f32,
            mirror: used().any(|material| material.mirror),
            clear: used().any(|material| material.clear),
            glint: used().any(|material| material.mirror && material.shininess != 0.0),
        }
    }

    /// Iterations of the loops over objects outside the tree, for one ray.
    pub fn loop_iterations(&self) -> usize {
        self.planes.len() + self.spheres.len() - self.in_tree
    }
}

fn material(material: &prepare::Material<f64>) -> Material {
    Material {
        ambient: f32x3(material.ambient),
        transparency: material.transparency as f32,
        diffuse: f32x3(material.diffuse),
        shininess: if material.mirror {
            material.shininess as f32
        } else {
            0.0
        },
        specular: f32x3(material.specular),
        unused_0: 0,
        tint: f32x3(material.tint),
        unused_1: 0,
    }
}

fn light(light: &prepare::Light<f64>) -> Light {
    let zero = V3::new(0.0, 0.0, 0.0);
    let (axis, cosine) = light.cone.unwrap_or((zero, -2.0));
    Light {
        location: f32x3(light.location),
        cosine: cosine as f32,
        emissivity: f32x3(light.emissivity),
        unused_0: 0,
        axis: f32x3(axis),
        unused_1: 0,
    }
}

/// The bits of the first 32 lights in a list. Beyond them f32's own rounding decides: fast rendering only.
fn bits(level: &[usize]) -> u32 {
    level
        .iter()
        .filter(|&&light| light < 32)
        .map(|light| 1 << light)
        .sum()
}

fn world_plane(world: &World<f64>, plane: &world::WorldPlane<f64>) -> WorldPlane {
    let mut keep = [1.0; 3];
    let mut own = [0.0; 3];
    if let Some((axis, at)) = plane.own {
        keep[axis] = 0.0;
        own[axis] = at as f32;
    }
    let zero = V3::new(0.0, 0.0, 0.0);
    let (rows, origin, dimensions) = plane
        .extent
        .as_ref()
        .map_or(([zero; 2], [0.0; 2], [0.0; 2]), |e| {
            (e.rows, e.origin, e.dimensions)
        });
    WorldPlane {
        normal: f32x3(plane.normal),
        offset: plane.offset as f32,
        keep,
        group: world.groups[plane.object],
        own,
        object: plane.object as u32,
        row_0: f32x3(rows[0]),
        origin_0: origin[0] as f32,
        row_1: f32x3(rows[1]),
        origin_1: origin[1] as f32,
        lengths: dimensions.map(|d| d as f32),
        level: bits(&plane.level),
        bounded: u32::from(plane.extent.is_some()),
    }
}

fn world_sphere(world: &World<f64>, sphere: &world::WorldSphere<f64>, seen: u32) -> WorldSphere {
    WorldSphere {
        center: f32x3(sphere.center),
        radius: sphere.radius as f32,
        group: world.groups[sphere.object],
        object: sphere.object as u32,
        level: bits(&sphere.level),
        seen,
    }
}

//! What a lit scene needs beside: materials, lights, and every object for rays from anywhere.

use super::{Packed, f32x3, factor, factors};
use crate::prepare::extent::{Extent, HalfPlane};
use crate::prepare::{self, Prepared, World};
use crate::real::{Bounded, Real, V3};
use crate::shader::bounds::{LARGEST, MOST_SHININESS, SIDES_ROUNDINGS, U, round_up, upper_bound};
use crate::shader::records::{Light, LitObject, Material, Projector, WorldPlane, WorldSphere};

/// The records of a lit scene, and what its materials can do.
#[derive(Debug, Clone)]
pub struct Lit {
    /// One for each object of the scene.
    pub objects: Vec<LitObject>,
    /// The scene's materials.
    pub materials: Vec<Material>,
    /// The scene's lights.
    pub lights: Vec<Light>,
    /// The projectors among them that light anything.
    pub projectors: Vec<Projector>,
    /// Every plane, rectangle and triangle.
    pub planes: Vec<WorldPlane>,
    /// The third sides of the triangles among them: row and origin, as the other sides have them.
    pub third_sides: Vec<[f32; 4]>,
    /// Every sphere; those of the tree come first.
    pub spheres: Vec<WorldSphere>,
    /// How many of the spheres their tree holds.
    pub in_tree: usize,
    /// How many of the planes are in no tree: the first.
    pub loose_planes: usize,
    /// Some object is a mirror.
    pub mirror: bool,
    /// Some object lets light through.
    pub transparent: bool,
    /// Some object glints.
    pub glint: bool,
    /// A light beyond those that have a bit lies on a surface.
    pub unnumbered_light_on_surface: bool,
}

/// Marks a sphere in [`LitObject::place`].
const SPHERE_BIT: u32 = 1 << 31;
/// Marks a quadric there.
const QUADRIC_BIT: u32 = 1 << 30;

impl Lit {
    /// With the record of each light that is a projector and lights anything.
    pub(super) fn new(
        scene: &Prepared<Bounded>,
        world: &World<Bounded>,
        packed: &Packed,
        projectors: &[Option<Projector>],
    ) -> Self {
        let used = || scene.materials.iter().map(|&index| &scene.palette[index]);
        let in_tree = world.sphere_tree.as_ref().map_or(0, |bvh| bvh.len);
        let (planes, spheres) = (&world.planes, &world.spheres);
        let mut places = vec![0; scene.surfaces.len()];
        for (place, plane) in (0..).zip(planes) {
            places[plane.object] = place;
        }
        for (place, sphere) in (0..).zip(spheres) {
            places[sphere.object] = place | SPHERE_BIT;
        }
        for (place, quadric) in (0..).zip(world.quadrics.iter()) {
            places[quadric.object] = place | QUADRIC_BIT;
        }
        let mut third_sides = Vec::new();
        let on_surfaces = planes
            .iter()
            .map(|p| &p.lights_on_surface)
            .chain(spheres.iter().map(|s| &s.lights_on_surface))
            .chain(world.quadrics.iter().map(|q| &q.lights_on_surface));
        Self {
            unnumbered_light_on_surface: on_surfaces.flatten().any(|light| *light >= 32),
            objects: (0..scene.surfaces.len())
                .map(|object| LitObject {
                    material: scene.materials[object] as u32,
                    kind: packed.objects[object].kind,
                    group: world.groups[object],
                    place: places[object],
                })
                .collect(),
            materials: scene.palette.iter().map(material).collect(),
            lights: lights(world, projectors),
            projectors: projectors.iter().flatten().copied().collect(),
            planes: planes
                .iter()
                .map(|p| world_plane(world, p, &mut third_sides))
                .collect(),
            third_sides,
            spheres: spheres.iter().map(|s| world_sphere(world, s)).collect(),
            in_tree,
            loose_planes: world.loose_planes(),
            mirror: used().any(|material| material.mirror),
            transparent: used().any(|material| material.transparent),
            glint: used().any(|material| material.mirror && material.shininess != 0.0),
        }
    }

    /// The third sides as they stand behind the objects: the bits of their numbers.
    pub fn third_sides(&self) -> impl Iterator<Item = LitObject> {
        let sides = self.third_sides.iter().map(|side| side.map(f32::to_bits));
        sides.map(|[material, kind, group, place]| LitObject {
            material,
            kind,
            group,
            place,
        })
    }

    /// Iterations of the loops over objects outside the tree, for one ray.
    pub fn loop_iterations(&self) -> usize {
        self.loose_planes + self.spheres.len() - self.in_tree
    }
}

fn material(material: &prepare::Material<Bounded>) -> Material {
    // Which channels a secondary ray changes is asked by the CPU alone.
    let prepare::Material {
        ambient,
        diffuse,
        specular,
        shininess,
        transparency,
        tint,
        mirrored: _,
        passed: _,
        transparent: _,
        mirror,
    } = *material;
    Material {
        ambient: factors(ambient),
        transparency: factor(transparency.value),
        diffuse: factors(diffuse),
        shininess: if mirror {
            factor(shininess.min(2.0 * MOST_SHININESS))
        } else {
            0.0
        },
        specular: factors(specular),
        pad: Default::default(),
        tint: factors(tint),
        kept: factor((Bounded::exact(1.0) - transparency).value),
    }
}

/// The lights, with their places among the projectors.
fn lights(world: &World<Bounded>, projectors: &[Option<Projector>]) -> Vec<Light> {
    let mut place = 0;
    let mut numbered = |(record, projector): (&prepare::Light<Bounded>, &Option<Projector>)| {
        place += u32::from(projector.is_some());
        light(record, if projector.is_some() { place } else { 0 })
    };
    let lights = world.lights.iter().zip(projectors);
    lights.map(&mut numbered).collect()
}

fn light(light: &prepare::Light<Bounded>, place: u32) -> Light {
    let prepare::Light {
        location,
        emissivity,
        cone,
        ref projector,
        // Narrow cones are told by their sines on the CPU alone.
        narrow: _,
    } = *light;
    let zero = V3::exact(glam::DVec3::ZERO);
    let (axis, cosine) = cone.unwrap_or((zero, Bounded::exact(-2.0)));
    Light {
        location: f32x3(location),
        cosine: cosine.value as f32,
        // A projector that lights nothing is as good as a dark light.
        emissivity: if projector.is_some() && place == 0 {
            [0.0; 3]
        } else {
            factors(emissivity)
        },
        size: size(location),
        axis: f32x3(axis),
        projector: place,
    }
}

/// The length, or a little more.
pub(super) fn size(v: V3<Bounded>) -> f32 {
    round_up(upper_bound(v.dot(v).sqrt()))
}

/// The bits of the first 32 lights in a list. Beyond them f32's own rounding decides: fast rendering only.
pub(super) fn bits(lights_on_surface: &[usize]) -> u32 {
    lights_on_surface
        .iter()
        .filter(|&&light| light < 32)
        .map(|light| 1 << light)
        .sum()
}

/// The bit of the light that is next to the plane, and its height, if f32 can have it.
fn low_light(plane: &prepare::WorldPlane<Bounded>) -> Option<(u32, f32)> {
    let (light, height) = plane.low_light?;
    let size = height.value.abs();
    // The rounding to f32 is u; a light in the plane has no height to be known.
    let known = size > 1.0 / LARGEST && height.error < 0.25 * U * size;
    known.then_some((1 << light, height.value as f32))
}

/// The end of a plane, as its record has it.
struct Bounds {
    bounded: u32,
    rows: [V3<Bounded>; 2],
    origin: [Bounded; 2],
    lengths: [Bounded; 2],
    /// The largest of the numbers that are subtracted.
    most: f64,
}

/// The end of a plane; a triangle's third side is put among the others.
fn bounds(extent: &Extent<Bounded>, third_sides: &mut Vec<[f32; 4]>) -> Bounds {
    let (none, zero) = (Bounded::zero(), V3::exact(glam::DVec3::ZERO));
    let larger_bound = |values: [Bounded; 2]| upper_bound(values[0]).max(upper_bound(values[1]));
    match extent {
        Extent::Unbounded => Bounds {
            bounded: 0,
            rows: [zero; 2],
            origin: [none; 2],
            lengths: [none; 2],
            most: 0.0,
        },
        Extent::Rectangle(r) => Bounds {
            bounded: 1,
            rows: r.rows,
            origin: r.origin,
            lengths: r.dimensions,
            most: larger_bound(r.origin) + larger_bound(r.dimensions),
        },
        Extent::Triangle(sides) => {
            let unit = |side: &HalfPlane<Bounded>| {
                let length = side.row.dot(side.row).sqrt();
                (
                    side.row * (Bounded::exact(1.0) / length),
                    side.origin / length,
                )
            };
            let [first, second, third] = sides.each_ref().map(unit);
            let [x, y, z] = f32x3(third.0);
            third_sides.push([x, y, z, third.1.value as f32]);
            let origin = upper_bound(third.1);
            Bounds {
                bounded: 1 + third_sides.len() as u32,
                rows: [first.0, second.0],
                origin: [first.1, second.1],
                lengths: [Bounded::exact(LARGEST); 2],
                // No record has the third one, whose range would be looked at.
                most: if origin <= LARGEST {
                    larger_bound([first.1, second.1]).max(origin)
                } else {
                    f64::INFINITY
                },
            }
        }
    }
}

fn world_plane(
    world: &World<Bounded>,
    plane: &prepare::WorldPlane<Bounded>,
    third_sides: &mut Vec<[f32; 4]>,
) -> WorldPlane {
    let mut axis_mask = [1.0; 3];
    let mut fixed_coordinate = [0.0; 3];
    let mut highest = world.highest.value as f32;
    if let Some((axis, at)) = plane.fixed_coordinate {
        axis_mask[axis] = 0.0;
        fixed_coordinate[axis] = at.value as f32;
        if axis == 2 {
            // The whole plane is below; otherwise no ray could hit it and it would have been dropped.
            highest = f32::MAX;
        }
    }
    let Bounds {
        bounded,
        rows,
        origin,
        lengths,
        most,
    } = bounds(&plane.extent, third_sides);
    let (low_light, height) = low_light(plane).unwrap_or((0, 0.0));
    WorldPlane {
        normal: f32x3(plane.normal),
        offset: plane.offset.value as f32,
        axis_mask,
        group: world.groups[plane.object],
        fixed_coordinate,
        object: plane.object as u32,
        row_0: f32x3(rows[0]),
        origin_0: origin[0].value as f32,
        row_1: f32x3(rows[1]),
        origin_1: origin[1].value as f32,
        lengths: lengths.map(|d| d.value as f32),
        lights_on_surface: bits(&plane.lights_on_surface),
        bounded,
        highest,
        sides_error: round_up(SIDES_ROUNDINGS * U * most),
        low_light,
        height,
    }
}

fn world_sphere(world: &World<Bounded>, sphere: &prepare::WorldSphere<Bounded>) -> WorldSphere {
    WorldSphere {
        center: f32x3(sphere.center),
        radius: factor(sphere.radius.value),
        group: world.groups[sphere.object],
        object: sphere.object as u32,
        lights_on_surface: bits(&sphere.lights_on_surface),
        size: size(sphere.center),
        inverse_radius: (Bounded::exact(1.0) / sphere.radius).value as f32,
        pad: Default::default(),
    }
}

//! What a lit scene needs beside: materials, lights, and every object for rays from anywhere.

use super::numbers::larger;
use super::{Packed, factor, factors, nearest};
use crate::prepare::extent::{Extent, HalfPlane};
use crate::prepare::{self, Prepared, World};
use crate::real::{Real as _, V3};
use crate::shader::bounds::{FLOOR, GROWTH, LARGEST, MOST_SHININESS, SIDES_ROUNDINGS, upper_bound};
use crate::shader::format::{Format, Known, Single};
use crate::shader::records::wide::{
    Light, LitObject, Material, Projector, WorldPlane, WorldSphere,
};

/// The records of a lit scene, and what its materials can do.
#[derive(Debug, Clone)]
pub struct Lit<F: Format = Single> {
    /// One for each object of the scene.
    pub objects: Vec<F::Record<LitObject>>,
    /// The scene's materials.
    pub materials: Vec<F::Record<Material>>,
    /// The scene's lights.
    pub lights: Vec<F::Record<Light>>,
    /// The projectors among them that light anything.
    pub projectors: Vec<F::Record<Projector>>,
    /// Every plane, rectangle and triangle.
    pub planes: Vec<F::Record<WorldPlane>>,
    /// The third sides of the triangles among them: row and origin, as the other sides have them.
    pub third_sides: Vec<[f64; 4]>,
    /// Every sphere; those of the tree come first.
    pub spheres: Vec<F::Record<WorldSphere>>,
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

impl<F: Format> Lit<F> {
    /// With the record of each light that is a projector and lights anything.
    pub(super) fn new(
        scene: &Prepared<F::Number>,
        world: &World<F::Number>,
        packed: &Packed<F>,
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
                .map(|object| {
                    F::record(LitObject {
                        material: scene.materials[object] as u32,
                        kind: F::wide(&packed.objects[object]).kind,
                        group: world.groups[object],
                        place: places[object],
                    })
                })
                .collect(),
            materials: scene
                .palette
                .iter()
                .map(|m| F::record(material::<F>(m)))
                .collect(),
            lights: lights::<F>(world, projectors),
            projectors: projectors
                .iter()
                .flatten()
                .map(|projector| F::record(*projector))
                .collect(),
            planes: planes
                .iter()
                .map(|p| F::record(world_plane::<F>(world, p, &mut third_sides)))
                .collect(),
            third_sides,
            spheres: spheres
                .iter()
                .map(|s| F::record(world_sphere::<F>(world, s)))
                .collect(),
            in_tree,
            loose_planes: world.loose_planes(),
            mirror: used().any(|material| material.mirror),
            transparent: used().any(|material| material.transparent),
            glint: used().any(|material| material.mirror && material.shininess != 0.0),
        }
    }

    /// The third sides as they stand behind the objects: the bits of their numbers, the lower half of an f64 first.
    pub fn third_sides(&self) -> impl Iterator<Item = F::Record<LitObject>> {
        let words = self.third_sides.iter().flat_map(|side| {
            let bits = side.map(|number| {
                if F::DOUBLE {
                    number.to_bits()
                } else {
                    (number as f32).to_bits().into()
                }
            });
            let [a, b, c, d] = bits.map(|bits| bits as u32);
            let [e, f, g, h] = bits.map(|bits| (bits >> 32) as u32);
            if F::DOUBLE {
                vec![[a, e, b, f], [c, g, d, h]]
            } else {
                vec![[a, b, c, d]]
            }
        });
        let record = |[material, kind, group, place]: [u32; 4]| LitObject {
            material,
            kind,
            group,
            place,
        };
        words.map(move |words| F::record(record(words)))
    }

    /// Iterations of the loops over objects outside the tree, for one ray.
    pub fn loop_iterations(&self) -> usize {
        self.loose_planes + self.spheres.len() - self.in_tree
    }
}

fn material<F: Format>(material: &prepare::Material<F::Number>) -> Material {
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
        transparency: factor(transparency.nearest()),
        diffuse: factors(diffuse),
        shininess: if mirror {
            factor(shininess.min(2.0 * MOST_SHININESS))
        } else {
            0.0
        },
        specular: factors(specular),
        pad: Default::default(),
        tint: factors(tint),
        kept: factor((F::Number::exact(1.0) - transparency).nearest()),
    }
}

/// The lights, with their places among the projectors.
fn lights<F: Format>(
    world: &World<F::Number>,
    projectors: &[Option<Projector>],
) -> Vec<F::Record<Light>> {
    let mut place = 0;
    let mut numbered = |(record, projector): (&prepare::Light<F::Number>, &Option<Projector>)| {
        place += u32::from(projector.is_some());
        F::record(light::<F>(
            record,
            if projector.is_some() { place } else { 0 },
        ))
    };
    let lights = world.lights.iter().zip(projectors);
    lights.map(&mut numbered).collect()
}

fn light<F: Format>(light: &prepare::Light<F::Number>, place: u32) -> Light {
    let prepare::Light {
        location,
        emissivity,
        cone,
        ref projector,
        // Narrow cones are told by their sines on the CPU alone.
        narrow: _,
    } = *light;
    let zero = V3::exact(glam::DVec3::ZERO);
    let (axis, cosine) = cone.unwrap_or((zero, F::Number::exact(-2.0)));
    Light {
        location: nearest(location),
        cosine: cosine.nearest(),
        // A projector that lights nothing is as good as a dark light.
        emissivity: if projector.is_some() && place == 0 {
            [0.0; 3]
        } else {
            factors(emissivity)
        },
        size: size::<F>(location),
        axis: nearest(axis),
        projector: place,
    }
}

/// The length, or a little more.
pub(super) fn size<F: Format>(v: V3<F::Number>) -> f64 {
    F::round_up(upper_bound(v.dot(v).sqrt()))
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
fn low_light<F: Format>(plane: &prepare::WorldPlane<F::Number>) -> Option<(u32, f64)> {
    let (light, height) = plane.low_light?;
    let size = height.nearest().abs();
    // The rounding to the format is u; a light in the plane has no height to be known.
    let known = size > 1.0 / LARGEST && height.off() < 0.25 * F::U * size;
    known.then_some((1 << light, height.nearest()))
}

/// Beyond every position that is looked at, also where f64 knows it: stands for no border, or no end.
pub(super) const BEYOND: f64 = (1_u128 << 96) as f64;

/// Whether what is known of numbers of this size is so much that their rounding to the format is more than all the
/// rest: bounds count a rounding, and have little room beside.
fn known<F: Format>(numbers: &[F::Number], size: f64) -> bool {
    // A NaN fails this comparison.
    numbers.iter().all(|n| n.off() <= F::U / 64.0 * size)
}

/// The same of a vector of unit length.
fn known_direction<F: Format>(v: V3<F::Number>) -> bool {
    known::<F>(&[v.x, v.y, v.z], 1.0)
}

/// The end of a plane, as its record has it.
struct Bounds<F: Format> {
    bounded: u32,
    rows: [V3<F::Number>; 2],
    origin: [F::Number; 2],
    lengths: [F::Number; 2],
    /// The largest of the numbers that are subtracted; infinite where they are not known well enough.
    most: f64,
    /// How far these may be off before they are rounded.
    off: f64,
}

/// The end of a plane; a triangle's third side is put among the others.
fn bounds<F: Format>(extent: &Extent<F::Number>, third_sides: &mut Vec<[f64; 4]>) -> Bounds<F> {
    let (none, zero) = (F::Number::zero(), V3::exact(glam::DVec3::ZERO));
    let larger_bound = |values: [F::Number; 2]| larger(values.map(upper_bound));
    match extent {
        Extent::Unbounded => Bounds {
            bounded: 0,
            rows: [zero; 2],
            origin: [none; 2],
            lengths: [none; 2],
            most: 0.0,
            off: 0.0,
        },
        Extent::Rectangle(r) => Bounds {
            bounded: 1,
            rows: r.rows,
            origin: r.origin,
            lengths: r.dimensions,
            // Lengths alone are not looked at for their range, as triangles have none.
            most: if larger_bound(r.dimensions) <= LARGEST {
                larger_bound(r.origin) + larger_bound(r.dimensions)
            } else {
                f64::INFINITY
            },
            off: larger(r.origin.map(Known::off)) + larger(r.dimensions.map(Known::off)),
        },
        Extent::Triangle(sides) => {
            let unit = |side: &HalfPlane<F::Number>| {
                let length = side.row.dot(side.row).sqrt();
                (
                    side.row * (F::Number::exact(1.0) / length),
                    side.origin / length,
                )
            };
            let [first, second, third] = sides.each_ref().map(unit);
            let [x, y, z] = nearest(third.0);
            third_sides.push([x, y, z, third.1.nearest()]);
            let origin = upper_bound(third.1);
            let sides = [first, second, third];
            let rows = sides.iter().all(|side| known_direction::<F>(side.0));
            Bounds {
                bounded: 1 + third_sides.len() as u32,
                rows: [first.0, second.0],
                origin: [first.1, second.1],
                lengths: [F::Number::exact(BEYOND); 2],
                // No record has the third one, whose range would be looked at.
                most: if rows && origin <= LARGEST {
                    larger([larger_bound([first.1, second.1]), origin])
                } else {
                    f64::INFINITY
                },
                off: sides.iter().map(|side| side.1.off()).fold(0.0, f64::max),
            }
        }
    }
}

fn world_plane<F: Format>(
    world: &World<F::Number>,
    plane: &prepare::WorldPlane<F::Number>,
    third_sides: &mut Vec<[f64; 4]>,
) -> WorldPlane {
    let mut axis_mask = [1.0; 3];
    let mut fixed_coordinate = [0.0; 3];
    let mut highest = world.highest.nearest().clamp(-BEYOND, BEYOND);
    if let Some((axis, at)) = plane.fixed_coordinate {
        axis_mask[axis] = 0.0;
        fixed_coordinate[axis] = at.nearest();
        if axis == 2 {
            // The whole plane is below; otherwise no ray could hit it and it would have been dropped.
            highest = f32::MAX.into();
        }
    }
    let Bounds {
        bounded,
        rows,
        origin,
        lengths,
        most,
        off,
    } = bounds::<F>(&plane.extent, third_sides);
    let offset = plane.offset.nearest().abs();
    // An offset of 0 is a quotient whose bound is not 0.
    let is_known = known_direction::<F>(plane.normal)
        && known::<F>(&[plane.offset], offset.max(FLOOR))
        && !highest.is_nan();
    let most = if is_known { most } else { f64::INFINITY };
    let (low_light, height) = low_light::<F>(plane).unwrap_or((0, 0.0));
    WorldPlane {
        normal: nearest(plane.normal),
        offset: plane.offset.nearest(),
        axis_mask,
        group: world.groups[plane.object],
        fixed_coordinate,
        object: plane.object as u32,
        row_0: nearest(rows[0]),
        origin_0: origin[0].nearest(),
        row_1: nearest(rows[1]),
        origin_1: origin[1].nearest(),
        lengths: lengths.map(|d| d.nearest()),
        lights_on_surface: bits(&plane.lights_on_surface),
        bounded,
        highest,
        sides_error: F::round_up(SIDES_ROUNDINGS * F::U * most + GROWTH * off),
        low_light,
        height,
    }
}

fn world_sphere<F: Format>(
    world: &World<F::Number>,
    sphere: &prepare::WorldSphere<F::Number>,
) -> WorldSphere {
    WorldSphere {
        center: nearest(sphere.center),
        radius: factor(sphere.radius.nearest()),
        group: world.groups[sphere.object],
        object: sphere.object as u32,
        lights_on_surface: bits(&sphere.lights_on_surface),
        size: size::<F>(sphere.center),
        inverse_radius: (F::Number::exact(1.0) / sphere.radius).nearest(),
        pad: Default::default(),
    }
}

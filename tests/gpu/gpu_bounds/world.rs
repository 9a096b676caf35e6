//! Running bounds: rays from anywhere against planes, rectangles and spheres.

use glam::{DQuat, DVec2, DVec3};
use plumb::gpu::device::Gpu;
use plumb::render::Settings;
use plumb::scene::{Camera, Extent, Material, Object, Rectangle, Scene, Shape, Surface, Triangle};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;

use super::support::{BoundStatistics, Rng, TrueRay, run};
use crate::common::light;

pub(crate) const VIEWPOINT: DVec3 = DVec3::new(3.7, 2.9, 6.3);
/// Lengths on the GPU are in units of the power of two next below the viewpoint's z.
pub(crate) const UNIT: f64 = 4.0;

pub(crate) fn object(shape: Shape, surface: Surface, material: usize) -> Object {
    Object {
        name: "o".into(),
        material,
        shape,
        surface,
    }
}

/// Materials: plain, mirror, glass, with a glint.
pub(crate) fn materials() -> Vec<Material> {
    let plain = Material {
        name: "m".into(),
        ambient: DVec3::new(0.9, 0.7, 0.4),
        diffuse: DVec3::new(0.4, 0.8, 0.6),
        ..Material::default()
    };
    let specular = DVec3::splat(0.5);
    vec![
        plain.clone(),
        Material {
            specular,
            ..plain.clone()
        },
        Material {
            transparency: 0.5,
            ..plain.clone()
        },
        Material {
            specular,
            shininess: 20.0,
            ..plain
        },
    ]
}

pub(crate) fn camera(pixeldim: [u32; 2]) -> Camera {
    Camera {
        name: "c".into(),
        pixeldim,
        worlddim: DVec2::new(8.0, 6.0),
        viewpoint: VIEWPOINT,
    }
}

/// A lit scene of many planes, rectangles and spheres of all sizes, plain, tiled and procedural.
pub(crate) fn scene(rng: &mut Rng, planes: usize, spheres: usize) -> Scene {
    let mut objects = Vec::new();
    for i in 0..planes {
        let axis = rng.chance(0.2);
        let normal = if axis {
            DVec3::AXES[rng.below(3)] * rng.sign() * rng.log(-1.0, 1.0)
        } else {
            rng.unit() * rng.log(-2.0, 2.0)
        };
        let size = rng.log(-1.0, 2.0);
        let mut point = VIEWPOINT + rng.within(size);
        // A wall before the screen is none.
        point.z = point.z.min(-0.5 * size.min(1.0));
        let across = normal.cross(rng.unit());
        if rng.chance(0.15) {
            let shape = triangle(rng, normal, point);
            let surface = match i % 2 {
                0 => Surface::Plain,
                _ => Surface::Procedural { shader: 2 },
            };
            objects.push(object(shape, surface, i % 4));
            continue;
        }
        let extent = if rng.chance(0.6) {
            Extent::Rectangle(Rectangle {
                xdir: across + normal * rng.uniform(0.0, 0.5),
                dimensions: DVec2::new(rng.log(-1.5, 1.5), rng.log(-1.5, 1.5)),
            })
        } else {
            Extent::Unbounded
        };
        let surface = match i % 4 {
            0 => Surface::Tiled {
                dimension: DVec2::new(rng.log(-1.0, 1.0), rng.log(-1.0, 1.0)),
                altmaterial: 1,
                xdir: rng.chance(0.5).then_some(across),
            },
            1 => Surface::Procedural { shader: 2 },
            _ => Surface::Plain,
        };
        let shape = Shape::Plane {
            normal,
            point,
            extent,
        };
        objects.push(object(shape, surface, i % 4));
    }
    for i in 0..spheres {
        let (center, radius) = (VIEWPOINT + rng.within(100.0), rng.log(-2.0, 2.0));
        let surface = match i % 2 {
            0 => Surface::Procedural { shader: 0 },
            _ => Surface::Plain,
        };
        objects.push(object(Shape::Sphere { center, radius }, surface, i % 4));
    }
    Scene {
        camera: camera([64, 48]),
        materials: materials(),
        objects,
        lights: vec![light(DVec3::new(4.1, 6.3, 2.2))],
        textures: vec![],
    }
}

/// A triangle with a corner, of any size and form, in the plane of this normal but for the rounding of its vertices.
pub(crate) fn triangle(rng: &mut Rng, normal: DVec3, corner: DVec3) -> Shape {
    let along = normal.cross(rng.unit()).normalize() * rng.log(-1.5, 1.5);
    let angle = rng.sign() * rng.log(-2.0, 0.4);
    let turned = DQuat::from_axis_angle(normal.normalize(), angle) * along;
    let mut vertices = [corner, corner + along, corner + turned * rng.log(-1.0, 1.0)];
    if normal.to_array().iter().filter(|c| **c != 0.0).count() == 1 {
        let axis = normal.abs().max_position();
        vertices.iter_mut().for_each(|v| v[axis] = corner[axis]);
    }
    Shape::Triangle(Triangle {
        vertices,
        normal: rng.chance(0.5).then_some(-normal),
        point: None,
    })
}

/// A scene with its shader and records.
pub(crate) struct World {
    pub(crate) scene: Scene,
    pub(crate) packed: Packed,
    pub(crate) wgsl: String,
    /// The objects with what stands behind them.
    objects: Vec<u8>,
}

impl World {
    pub(crate) fn of(scene: Scene, settings: &Settings) -> Self {
        let packed = Packed::new(&scene, settings);
        assert_eq!(packed.unprovable, None);
        let wgsl = compose(
            &packed,
            &FeatureSet::new(&packed, settings, 8),
            Entry::Picture,
        );
        let lit = packed.lit.iter();
        let objects = lit.flat_map(|lit| lit.objects.iter().copied().chain(lit.third_sides()));
        let objects: Vec<_> = objects.collect();
        Self {
            scene,
            objects: bytemuck::cast_slice(&objects).to_vec(),
            packed,
            wgsl,
        }
    }

    /// Centers, seen from the viewpoint, and radii of the spheres, in the order of their records.
    pub(crate) fn true_spheres(&self) -> Vec<(DVec3, f64)> {
        let records = self.packed.lit.iter().flat_map(|lit| &lit.spheres);
        records
            .map(|r| match self.scene.objects[r.object as usize].shape {
                Shape::Sphere { center, radius } => (seen_from_viewpoint(center), radius / UNIT),
                Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => panic!("no sphere"),
            })
            .collect()
    }

    pub(crate) fn many() -> Self {
        let scene = scene(&mut Rng(1), 4096, 4096);
        Self::of(scene, &Settings::default())
    }
}

/// A point of the scene as the GPU has it.
pub(crate) fn seen_from_viewpoint(point: DVec3) -> DVec3 {
    (point - VIEWPOINT) / UNIT
}

/// Planes' numbers, as they truly are.
pub(crate) struct TruePlane {
    pub(crate) normal: DVec3,
    /// From the viewpoint.
    point: DVec3,
    sides: TrueSides,
}

/// Where a plane ends.
enum TrueSides {
    None,
    /// Directions of the sides, and their lengths.
    Rectangle([DVec3; 2], DVec2),
    /// The vertices, from the viewpoint.
    Triangle([DVec3; 3]),
}

/// Whether a point of the plane of a triangle is in it.
pub(crate) fn is_between(vertices: &[DVec3; 3], hit: DVec3) -> bool {
    let [a, b, c] = *vertices;
    let whole = (b - a).cross(c - a);
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| (to - from).cross(hit - from).dot(whole) >= 0.0)
}

/// A place in the plane of a triangle: in it, next to it, at an edge, next to a vertex.
pub(crate) fn about_triangle(rng: &mut Rng, vertices: &[DVec3; 3]) -> DVec3 {
    let mut share = [0, 1].map(|_| rng.uniform(0.0, 1.0));
    if share[0] + share[1] > 1.0 && rng.chance(0.8) {
        share = share.map(|s| 1.0 - s);
    }
    if rng.chance(0.3) {
        share[rng.below(2)] = rng.sign() * rng.log(-9.0, -3.0);
    }
    let first = rng.below(3);
    let [a, b, c] = [0, 1, 2].map(|i| vertices[(first + i) % 3]);
    a + (b - a) * share[0] + (c - a) * share[1]
}

impl TruePlane {
    /// How far along the ray it is met, if it is.
    pub(crate) fn meets(&self, base: DVec3, dir: DVec3) -> Option<f64> {
        let t = self.normal.dot(self.point - base) / self.normal.dot(dir);
        let hit = base + t * dir;
        let axis = self.normal.abs().max_element() == 1.0 && self.normal.z != 0.0;
        let inside = match &self.sides {
            TrueSides::None => true,
            TrueSides::Rectangle(rows, lengths) => {
                let from = hit - self.point;
                (0.0..=lengths.x).contains(&from.dot(rows[0]))
                    && (0.0..=lengths.y).contains(&from.dot(rows[1]))
            }
            TrueSides::Triangle(vertices) => is_between(vertices, hit),
        };
        let below = axis || hit.z <= -VIEWPOINT.z / UNIT;
        (t > 0.0 && inside && below).then_some(t)
    }
}

pub(crate) fn true_plane(shape: &Shape) -> TruePlane {
    let (normal, point, extent) = match shape {
        Shape::Plane {
            normal,
            point,
            extent,
        } => (normal, point, extent),
        Shape::Triangle(triangle) => {
            let [a, b, c] = triangle.vertices;
            let normal = (b - a).cross(c - a).normalize();
            let facing = triangle.normal.unwrap_or(normal);
            return TruePlane {
                normal: normal * normal.dot(facing).signum(),
                point: seen_from_viewpoint(a),
                sides: TrueSides::Triangle(triangle.vertices.map(seen_from_viewpoint)),
            };
        }
        Shape::Sphere { .. } | Shape::Quadric(_) => panic!("no plane"),
    };
    let normal = normal.normalize();
    TruePlane {
        normal,
        point: seen_from_viewpoint(*point),
        sides: match extent {
            Extent::Unbounded => TrueSides::None,
            Extent::Rectangle(r) => {
                let first = (r.xdir - normal * normal.dot(r.xdir)).normalize();
                TrueSides::Rectangle([first, normal.cross(first)], r.dimensions / UNIT)
            }
        },
    }
}

/// Rays that are known to be where they are; that are off by as much as they may be; by up to a third of a radian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RayErrors {
    Exact,
    Off,
    Wild,
}

pub(crate) fn ray(
    rng: &mut Rng,
    errors: RayErrors,
    base: DVec3,
    dir: DVec3,
    hint: DVec3,
) -> TrueRay {
    match errors {
        RayErrors::Exact => TrueRay::exact(base, dir),
        RayErrors::Off | RayErrors::Wild => {
            TrueRay::off(rng, base, dir, hint, errors == RayErrors::Wild)
        }
    }
}

/// A ray to the plane: steep or grazing, to its middle or to its edges, from near or far, or away from it.
fn toward_plane(rng: &mut Rng, plane: &TruePlane, errors: RayErrors) -> TrueRay {
    let target = match &plane.sides {
        TrueSides::Triangle(vertices) => about_triangle(rng, vertices),
        TrueSides::None => {
            plane.point + {
                let size = rng.log(-1.0, 1.0);
                let way = rng.within(size);
                way - plane.normal * plane.normal.dot(way)
            }
        }
        TrueSides::Rectangle(rows, lengths) => {
            plane.point + {
                let mut p = [0, 1].map(|_| rng.uniform(-0.2, 1.2));
                if rng.chance(0.3) {
                    p[rng.below(2)] =
                        f64::from(rng.below(2) as u32) + rng.sign() * rng.log(-8.0, -2.0);
                }
                rows[0] * p[0] * lengths.x + rows[1] * p[1] * lengths.y
            }
        }
    };
    let mut dir = rng.unit();
    if rng.chance(0.3) {
        dir = dir - plane.normal * plane.normal.dot(dir)
            + plane.normal * rng.sign() * rng.log(-6.0, -1.0);
    }
    let dir = dir.normalize();
    let distance = rng.log(-3.0, 2.5) * if rng.chance(0.85) { 1.0 } else { -1.0 };
    ray(rng, errors, target - dir * distance, dir, plane.normal)
}

pub(crate) const CALL: &str = "
    let a = items[3u * i];
    let b = items[3u * i + 1u];
    let c = items[3u * i + 2u];
    let record = bitcast<u32>(a.w);
    let ray = SecondaryRay(a.xyz, b.xyz, b.w, c.x, 0.0, c.y);
    let range = Range(NOTHING, 0u, 0.0, T_MAX, 0.0, 0.0);
";

const INTERSECTION: &str = "
    answers[4u * i] = vec4f(m.t, m.error, m.low, m.high);
    answers[4u * i + 1u] = vec4f(select(0.0, 1.0, m.hit), select(0.0, 1.0, m.possible), 0.0, 0.0);
    var hit: SecondaryHit;
    hit.t = m.t;
    hit.error = m.error;
    hit.object = object;
    let p = locate_secondary(ray, hit);
    answers[4u * i + 3u] = vec4f(p.position, p.error);
";

pub(crate) fn told(items: &mut Vec<f32>, ray: &TrueRay, record: usize) {
    let start = items.len();
    items.extend(ray.told);
    items[start + 3] = f32::from_bits(record as u32);
}

/// An intersection that the shader claims, against whether and where the ray truly meets the surface.
fn judge(seen: &mut BoundStatistics, answers: &[[f32; 4]], hits: bool, t: f64) -> bool {
    let [found, error, low, high] = answers[0].map(f64::from);
    let [sure, possible, ..] = answers[1].map(|flag| flag == 1.0);
    seen.decision(sure, possible, hits);
    if sure {
        seen.error((found - t).abs(), error);
    }
    if possible && hits {
        seen.must(low <= t && t <= high);
    }
    sure
}

/// Where the shader says that a ray meets a surface.
fn place(seen: &mut BoundStatistics, answer: [f32; 4], truth: DVec3) {
    let [x, y, z, error] = answer.map(f64::from);
    seen.error((DVec3::new(x, y, z) - truth).length(), error);
}

/// What the shader makes a point of an intersection with.
pub(crate) fn inputs(world: &World) -> [(u32, &[u8]); 3] {
    let lit = world.packed.lit.as_ref().unwrap();
    [
        (2, &world.objects),
        (14, bytemuck::cast_slice(&lit.planes)),
        (15, bytemuck::cast_slice(&lit.spheres)),
    ]
}

/// Intersections with planes and rectangles, and where they are, where they are certain.
pub(crate) fn planes(
    gpu: &Gpu,
    world: &World,
    wgsl: &str,
    errors: RayErrors,
    count: usize,
    names: [&'static str; 2],
) -> [BoundStatistics; 2] {
    let records = &world.packed.lit.as_ref().unwrap().planes;
    let truth: Vec<_> = records
        .iter()
        .map(|r| true_plane(&world.scene.objects[r.object as usize].shape))
        .collect();
    let mut rng = Rng(2);
    let mut items = Vec::new();
    let rays: Vec<_> = (0..count)
        .map(|i| {
            let record = i % records.len();
            let ray = toward_plane(&mut rng, &truth[record], errors);
            told(&mut items, &ray, record);
            ray
        })
        .collect();
    let body = format!(
        "{CALL}let m = plane_hits_from(world_planes[record], ray, range);
    let object = world_planes[record].object;{INTERSECTION}"
    );
    let inputs = inputs(world);
    let answers = run(gpu, wgsl, &body, &items, &inputs, count, 4);
    let [mut seen, mut points] = names.map(BoundStatistics::new);
    for (i, ray) in rays.iter().enumerate() {
        let plane = &truth[i % records.len()];
        let t = plane.normal.dot(plane.point - ray.base) / plane.normal.dot(ray.dir);
        let hits = plane.meets(ray.base, ray.dir).is_some();
        if judge(&mut seen, &answers[4 * i..], hits, t) {
            place(&mut points, answers[4 * i + 3], ray.base + t * ray.dir);
        }
    }
    [seen, points]
}

/// A ray past the sphere's middle, or past its edge, from near or far, from inside, from the sphere itself.
pub(crate) fn toward_sphere(
    rng: &mut Rng,
    center: DVec3,
    radius: f64,
    errors: RayErrors,
) -> TrueRay {
    let dir = rng.unit();
    let across = dir.cross(rng.unit()).normalize();
    let apart = match rng.below(8) {
        0 => 0.0,
        1 | 2 => 1.0 + rng.sign() * rng.log(-8.0, -1.0),
        _ => rng.uniform(0.0, 1.1),
    };
    let far = match rng.below(8) {
        // From the sphere itself, or nearly.
        0 => radius * ((1.0 - apart * apart).max(0.0).sqrt() + rng.sign() * rng.log(-8.0, -2.0)),
        1 => -rng.log(-1.0, 2.0),
        2 => rng.uniform(0.0, 2.0) * radius,
        _ => rng.log(-2.0, 2.5) + radius,
    };
    let base = center + across * apart * radius - dir * far;
    ray(rng, errors, base, dir, across)
}

/// r² less the square of how far the ray passes from the center, and how far along it the nearer hit is.
pub(crate) fn true_hit(ray: &TrueRay, center: DVec3, radius: f64) -> (f64, f64) {
    let to_center = center - ray.base;
    let along = to_center.dot(ray.dir);
    let apart = (to_center - along * ray.dir).length();
    let disc = (radius - apart) * (radius + apart);
    (disc, along - disc.max(0.0).sqrt())
}

/// Intersections with spheres, and the normals and places where they are certain.
pub(crate) fn spheres(
    gpu: &Gpu,
    world: &World,
    wgsl: &str,
    errors: RayErrors,
    count: usize,
    names: [&'static str; 3],
) -> [BoundStatistics; 3] {
    let records = &world.packed.lit.as_ref().unwrap().spheres;
    let truth = world.true_spheres();
    let mut rng = Rng(3);
    let mut items = Vec::new();
    let rays: Vec<_> = (0..count)
        .map(|i| {
            let (center, radius) = truth[i % records.len()];
            let ray = toward_sphere(&mut rng, center, radius, errors);
            told(&mut items, &ray, i % records.len());
            ray
        })
        .collect();
    let body = format!(
        "{CALL}let m = sphere_hits_from(world_spheres[record], ray, range);
    let object = world_spheres[record].object;{INTERSECTION}
    answers[4u * i + 2u] = sphere_normal_from(world_spheres[record], ray);"
    );
    let inputs = inputs(world);
    let answers = run(gpu, wgsl, &body, &items, &inputs, count, 4);
    let [mut intersections, mut normals, mut points] = names.map(BoundStatistics::new);
    for (i, ray) in rays.iter().enumerate() {
        let (center, radius) = truth[i % records.len()];
        let (disc, t) = true_hit(ray, center, radius);
        if judge(
            &mut intersections,
            &answers[4 * i..],
            disc > 0.0 && t > 0.0,
            t,
        ) {
            let normal = (ray.base + t * ray.dir - center) / radius;
            let [x, y, z, error] = answers[4 * i + 2].map(f64::from);
            normals.error((DVec3::new(x, y, z) - normal).length(), error);
            place(&mut points, answers[4 * i + 3], ray.base + t * ray.dir);
        }
    }
    [intersections, normals, points]
}

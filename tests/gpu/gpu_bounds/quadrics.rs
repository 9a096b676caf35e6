//! Running bounds: rays from anywhere against quadrics of all kinds, and the normals where they are met.

use glam::{DMat3, DVec3};
use plumb::gpu::device::Gpu;
use plumb::render::Settings;
use plumb::scene::{Quadric, Scene, Shape, Surface};

use super::support::{BoundStatistics, Rng, TrueRay, run};
use super::world::{RayErrors, UNIT, VIEWPOINT, World, camera, inputs, materials, object, ray};
use crate::common::light;

/// So many quadrics: more than stand in a shader's text.
const QUADRICS: usize = 256;

/// Squares along the axes of a shape, a slope along the third one, and the right side.
const FORMS: [([f64; 3], f64, f64); 12] = [
    ([1.0, 1.0, 1.0], 0.0, 1.0),
    ([1.0, 0.25, 4.0], 0.0, 1.0),
    ([1.0, 1e-8, 1.0], 0.0, 1.0),
    ([1e-8, 1e-8, 1.0], 0.0, 1.0),
    ([1.0, 1.0, 0.0], 0.0, 1.0),
    ([1.0, 1.0, -1.0], 0.0, 0.0),
    ([1.0, 1.0, -0.01], 0.0, 0.0),
    ([1.0, 1.0, -0.5], 0.0, 1.0),
    ([-1.0, -1.0, 1.0], 0.0, 1.0),
    ([1.0, 0.5, 0.0], 1.0, 0.0),
    ([1.0, -0.5, 0.0], 1.0, 0.0),
    ([0.0, 1.0, 0.0], 0.0, 1.0),
];

/// A quadric as it truly is: (M·X + slope)·X = right in the scene's own coordinates.
struct TrueQuadric {
    matrix: DMat3,
    slope: DVec3,
    right: f64,
    lower: DVec3,
    upper: DVec3,
    /// A point next to it, from the viewpoint.
    middle: DVec3,
    /// About how large it is.
    size: f64,
}

impl TrueQuadric {
    fn new(quadric: &Quadric, middle: DVec3, size: f64) -> Self {
        let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients;
        let [d, e, f] = [d / 2.0, e / 2.0, f / 2.0];
        let open = DVec3::splat(f64::INFINITY);
        Self {
            matrix: DMat3::from_cols_array(&[a, d, e, d, b, f, e, f, c]),
            slope: DVec3::new(g, h, i),
            right: j,
            lower: quadric.lower.unwrap_or(-open),
            upper: quadric.upper.unwrap_or(open),
            middle: (middle - VIEWPOINT) / UNIT,
            size: size / UNIT,
        }
    }

    /// Where the ray meets it first, if it does: the distance and the unit normal.
    fn meets(&self, base: DVec3, dir: DVec3) -> Option<(f64, DVec3)> {
        let start = VIEWPOINT + base * UNIT;
        let a = dir.dot(self.matrix * dir);
        let b = 2.0 * start.dot(self.matrix * dir) + self.slope.dot(dir);
        let c = start.dot(self.matrix * start) + self.slope.dot(start) - self.right;
        let discriminant = b * b - 4.0 * a * c;
        if discriminant <= 0.0 {
            return None;
        }
        let sum = -0.5 * (b + b.signum() * discriminant.sqrt());
        let mut roots = [c / sum, sum / a];
        roots.sort_by(f64::total_cmp);
        roots.into_iter().find_map(|t| {
            let hit = start + t * dir;
            let inside = t > 0.0
                && t.is_finite()
                && hit.z <= 0.0
                && hit.cmpge(self.lower).all()
                && hit.cmple(self.upper).all();
            let normal = 2.0 * (self.matrix * hit) + self.slope;
            inside.then(|| (t / UNIT, normal.normalize()))
        })
    }
}

/// A lit scene of quadrics alone.
fn quadrics(rng: &mut Rng) -> (Scene, Vec<TrueQuadric>) {
    let (mut objects, mut truth) = (Vec::new(), Vec::new());
    for i in 0..QUADRICS {
        let (squares, slope, right) = FORMS[i % FORMS.len()];
        let axis = rng.below(3);
        let turned = |j: usize| squares[(j + axis) % 3];
        let squares = DVec3::new(turned(0), turned(1), turned(2));
        // Coefficients of few digits, so that f64 has the truth.
        let size = [0.25, 0.5, 1.0, 2.0, 8.0][rng.below(5)];
        let mut middle = (rng.within(12.0) * 8.0).round() / 8.0;
        middle.z = -middle.z.abs() - size;
        let mut along = DVec3::ZERO;
        along[(2 + 3 - axis) % 3] = slope * size;
        let slopes = -2.0 * squares * middle + along;
        let right = right * size * size - middle.dot(squares * middle) + along.dot(middle);
        let cut = rng.chance(0.4);
        let quadric = Quadric {
            coefficients: [
                squares.x, squares.y, squares.z, 0.0, 0.0, 0.0, slopes.x, slopes.y, slopes.z, right,
            ],
            lower: cut.then(|| middle - DVec3::new(2.0, 0.5, 2.0) * size),
            upper: cut.then(|| middle + DVec3::new(0.5, 2.0, 2.0) * size),
        };
        truth.push(TrueQuadric::new(&quadric, middle, size));
        objects.push(object(Shape::Quadric(quadric), Surface::Plain, i % 4));
    }
    let scene = Scene {
        camera: camera([64, 48]),
        materials: materials(),
        objects,
        lights: vec![light(DVec3::new(4.1, 6.3, 2.2))],
        textures: vec![],
    };
    (scene, truth)
}

/// A ray past a quadric, from near or far; some of them touch it nearly, some start on it nearly.
fn toward(rng: &mut Rng, quadric: &TrueQuadric, errors: RayErrors) -> TrueRay {
    let dir = rng.unit();
    let target = quadric.middle + rng.within(1.5 * quadric.size);
    let base = target - dir * quadric.size * rng.log(-1.0, 1.5);
    let Some((t, normal)) = quadric.meets(base, dir) else {
        return ray(rng, errors, base, dir, dir);
    };
    let hit = base + t * dir;
    match rng.below(4) {
        0 => {
            let along = normal.cross(rng.unit()).normalize();
            let dir = (along + normal * rng.sign() * rng.log(-6.0, -1.0)).normalize();
            let base = hit - dir * quadric.size * rng.log(-2.0, 1.0);
            ray(rng, errors, base, dir, normal)
        }
        1 => {
            let base = hit + normal * quadric.size * rng.sign() * rng.log(-6.0, -2.0);
            let dir = rng.unit();
            ray(rng, errors, base, dir, normal)
        }
        _ => ray(rng, errors, base, dir, normal),
    }
}

const BODY: &str = "
    let a = items[3u * i];
    let b = items[3u * i + 1u];
    let c = items[3u * i + 2u];
    let record = bitcast<u32>(a.w);
    let ray = SecondaryRay(a.xyz, b.xyz, b.w, c.x, 0.0, c.y);
    let range = Range(NOTHING, 0u, 0.0, T_MAX, 0.0, 0.0);
    let m = quadric_hits_from(quadrics[record], ray, range);
    answers[4u * i] = vec4f(m.t, m.error, m.low, m.high);
    answers[4u * i + 1u] = vec4f(select(0.0, 1.0, m.hit), select(0.0, 1.0, m.possible), 0.0, 0.0);
    var hit: SecondaryHit;
    hit.t = m.t;
    hit.error = m.error;
    hit.object = quadrics[record].object;
    let p = locate_secondary(ray, hit);
    answers[4u * i + 2u] = vec4f(p.normal, p.normal_error);
    answers[4u * i + 3u] = vec4f(p.position, p.error);
";

/// Intersections, normals and places, where they are certain.
pub(crate) fn measured(
    gpu: &Gpu,
    change: impl Fn(&str) -> String,
    errors: RayErrors,
    count: usize,
    names: [&'static str; 3],
) -> [BoundStatistics; 3] {
    let mut rng = Rng(7);
    let (scene, truth) = quadrics(&mut rng);
    let world = World::of(scene, &Settings::default());
    let wgsl = change(&world.wgsl);
    let mut items = Vec::new();
    let rays: Vec<_> = (0..count)
        .map(|i| {
            let ray = toward(&mut rng, &truth[i % QUADRICS], errors);
            let start = items.len();
            items.extend(ray.told);
            items[start + 3] = f32::from_bits((i % QUADRICS) as u32);
            ray
        })
        .collect();
    let records = bytemuck::cast_slice(&world.packed.quadrics);
    let objects = inputs(&world)[0];
    let answers = run(
        gpu,
        &wgsl,
        BODY,
        &items,
        &[objects, (18, records)],
        count,
        4,
    );
    let [mut seen, mut normals, mut places] = names.map(BoundStatistics::new);
    for (i, (ray, answers)) in rays.iter().zip(answers.chunks_exact(4)).enumerate() {
        let met = truth[i % QUADRICS].meets(ray.base, ray.dir);
        let [found, error, low, high] = answers[0].map(f64::from);
        let [sure, possible, ..] = answers[1].map(|flag| flag == 1.0);
        seen.decision(sure, possible, met.is_some());
        let Some((t, normal)) = met else { continue };
        if possible {
            seen.must(low <= t && t <= high);
        }
        if !sure {
            continue;
        }
        seen.error((found - t).abs(), error);
        let vector = |[x, y, z, error]: [f32; 4]| {
            let v = [x, y, z].map(f64::from);
            (DVec3::from_array(v), f64::from(error))
        };
        let (near, error) = vector(answers[2]);
        // A direction that is not known says nothing.
        if error < 1.0 {
            normals.error((near - normal).length(), error);
        }
        let (near, error) = vector(answers[3]);
        places.error((near - (ray.base + t * ray.dir)).length(), error);
    }
    [seen, normals, places]
}

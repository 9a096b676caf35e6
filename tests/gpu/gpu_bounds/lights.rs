//! What a light brings to a point that is off as far as it may be, near the light and far away.

use glam::DVec3;
use plumb::gpu::device::Gpu;
use plumb::render::Settings;
use plumb::scene::{Beam, Camera, Extent, Light, Scene, Shape, Surface};
use plumb::shader::bounds::round_up;

use super::support::{BoundStatistics, Rng, rounded, run};
use super::world::{UNIT, VIEWPOINT, World, camera, materials, object, seen_from_viewpoint};

const LIGHT: DVec3 = DVec3::new(4.1, 6.3, 2.2);

/// A light, and a wall that stands in no ray's way.
fn world() -> World {
    let wall = Shape::Plane {
        normal: DVec3::Z,
        point: DVec3::new(0.0, 0.0, -1e6),
        extent: Extent::Unbounded,
    };
    let light = Light {
        name: "l".into(),
        location: LIGHT,
        emissivity: DVec3::ONE,
        beam: Beam::Everywhere,
    };
    let scene = Scene {
        camera: Camera { ..camera([64, 48]) },
        materials: materials(),
        objects: vec![object(wall, Surface::Plain, 0)],
        lights: vec![light],
        textures: vec![],
    };
    World::of(scene, &Settings::default())
}

/// A number that is nearly `most`, most often.
fn up_to(rng: &mut Rng, most: f64) -> f64 {
    most * (1.0 - rng.log(-6.0, 0.0))
}

/// What light_term makes of points, exact and off, against the truth.
pub(crate) fn terms(
    gpu: &Gpu,
    change: impl Fn(&str) -> String,
    count: usize,
) -> [BoundStatistics; 2] {
    let world = world();
    let lit = world.packed.lit.as_ref().unwrap();
    let (mut rng, mut items) = (Rng(10), Vec::new());
    let light = seen_from_viewpoint(LIGHT);
    let truth: Vec<f64> = (0..count)
        .map(|i| {
            let off = i % 2 == 1;
            let distance = rng.log(-2.0, 1.0);
            let toward = rng.unit();
            let (told, near) = rounded(light - toward * distance);
            // Above the light the normal may be anything, and is often nearly at right angles.
            let across = toward.cross(rng.unit()).normalize();
            let leaning = if rng.chance(0.5) {
                rng.uniform(0.0, 1.0)
            } else {
                rng.log(-6.0, -1.0)
            };
            let normal = (across + toward * leaning * rng.sign()).normalize();
            let (told_normal, near_normal) = rounded(normal);
            let ways = [toward, across, normal, rng.unit()].map(|way| way * rng.sign());
            let (error, turn) = if off {
                (up_to(&mut rng, 0.249) * distance, up_to(&mut rng, 0.5))
            } else {
                (0.0, 0.0)
            };
            let point = near + ways[rng.below(4)] * error;
            let true_normal = (near_normal + ways[rng.below(4)] * turn).normalize();
            let size: f32 = told.iter().map(|x| x.abs()).sum();
            items.extend(told);
            items.push(round_up((point - near).length()));
            items.extend(told_normal);
            items.push(round_up((true_normal - near_normal).length()));
            items.extend([size, 0.0, 0.0, 0.0]);
            let v = light - point;
            (true_normal.dot(v) / v.length_squared()).max(0.0) / UNIT
        })
        .collect();
    let body = "
    var point: Point;
    point.position = items[3u * i].xyz;
    point.error = items[3u * i].w;
    point.normal = items[3u * i + 1u].xyz;
    point.normal_error = items[3u * i + 1u].w;
    point.size = items[3u * i + 2u].x;
    point.group = NOTHING;
    var seen: SecondaryRay;
    doubt = false;
    let term = light_term(0u, point, seen, vec3f(1.0));
    answers[i] = vec4f(term.color.x, term.error.x, select(0.0, 1.0, doubt), 0.0);";
    let inputs = [(13, bytemuck::cast_slice(&lit.lights))];
    let answers = run(gpu, &change(&world.wgsl), body, &items, &inputs, count, 1);
    let mut seen =
        ["light_term, exact point", "light_term, point is off"].map(BoundStatistics::new);
    let gain = f64::from(world.packed.camera.numbers.unit) * UNIT;
    assert!((gain - 1.0).abs() < 1e-6, "{VIEWPOINT}");
    for (i, (answer, truth)) in answers.iter().zip(truth).enumerate() {
        let [found, error, doubt, _] = answer.map(f64::from);
        if doubt == 0.0 {
            seen[i % 2].error((found - truth).abs(), error);
        } else {
            seen[i % 2].decision(false, true, true);
        }
    }
    seen
}

//! Bounds at a hit point: indices of tiles and blocks, the colour wheel, the glint's power.

use glam::DVec3;
use plumb::gpu::device::Gpu;
use plumb::prepare::extent::rows;
use plumb::real::V3;
use plumb::scene::{Object, Shape, Surface};
use plumb::shader::bounds::round_up;

use super::support::{BoundStatistics, Rng, rounded, run};
use super::world::{UNIT, VIEWPOINT, World};

/// The text is there for the entry point of the test to repeat it: else the test tests nothing.
fn assert_has(wgsl: &str, lines: &[&str]) {
    for line in lines {
        assert!(wgsl.contains(line), "no longer in the shader: {line}");
    }
}

/// A point as the shader has it, and truly, from the viewpoint: every other one is exact, and they may be off by as
/// much as they are said to be.
fn point(rng: &mut Rng, items: &mut Vec<f32>, number: usize) -> DVec3 {
    let size = rng.log(-1.0, 3.0);
    let (told, near) = rounded(rng.within(size));
    let way = rng.unit();
    let truth = near
        + way
            * if number.is_multiple_of(2) {
                0.0
            } else {
                rng.log(-7.0, -2.0)
            };
    items.extend(told);
    items.push(round_up((near - truth).length()));
    truth
}

const POINT: &str = "
    var point: Point;
    point.position = items[i].xyz;
    point.error = items[i].w;
    point.size = abs(point.position.x) + abs(point.position.y) + abs(point.position.z);
";

/// Objects whose surface is modulated, by the number of their record.
fn modulated(world: &World, code: u32) -> Vec<&Object> {
    let objects = &world.packed.lit.as_ref().unwrap().objects;
    let mut found: Vec<(u32, &Object)> = objects
        .iter()
        .zip(&world.scene.objects)
        .filter(|(o, _)| o.kind & 255 == code)
        .map(|(o, object)| (o.kind >> 8, object))
        .collect();
    found.sort_by_key(|(record, _)| *record);
    found.into_iter().map(|(_, object)| object).collect()
}

/// The difference modulo `period`, in ±period/2. (The host folds even parts of an index away.)
fn apart(found: f64, truth: f64, period: f64) -> f64 {
    let d = found - truth;
    (d - period * (d / period).round()).abs()
}

/// Notes an index that may decide something: bounds from ½ up never do.
fn index(seen: &mut BoundStatistics, off: f64, bound: f64) {
    if bound < 0.5 {
        seen.error(off, bound);
    } else {
        seen.decision(false, true, false);
    }
}

/// Indices of tiles.
pub(crate) fn tiles(gpu: &Gpu, world: &World, wgsl: &str, count: usize) -> [BoundStatistics; 2] {
    assert_has(
        wgsl,
        &[
            "var index = vec2f(dot(plane.row_0, position) + plane.fraction_0, dot(plane.row_1, position) + plane.fraction_1);",
            "var margin = abs(index - round(index)) - (plane.row_lengths * index_error(point) + plane.errors);",
        ],
    );
    let objects = modulated(world, 1);
    // An odd number, so that every record gets points of both kinds.
    let n = (objects.len() - 1) | 1;
    let (mut rng, mut items) = (Rng(6), Vec::new());
    let points: Vec<_> = (0..count).map(|i| point(&mut rng, &mut items, i)).collect();
    let body = format!(
        "{POINT}
    let plane = tiled_planes[i % {n}u];
    let position = point.position;
    let index = vec2f(dot(plane.row_0, position) + plane.fraction_0, dot(plane.row_1, position) + plane.fraction_1);
    answers[i] = vec4f(index, plane.row_lengths * index_error(point) + plane.errors);"
    );
    let records = &world.packed.tiled_planes;
    assert_eq!(records.len(), objects.len());
    let inputs = [(8, bytemuck::cast_slice(records))];
    let answers = run(gpu, wgsl, &body, &items, &inputs, count, 1);
    let mut seen = [
        "index of a tile, exact point",
        "index of a tile, point is off",
    ]
    .map(BoundStatistics::new);
    for (i, (answer, p)) in answers.iter().zip(points).enumerate() {
        let (
            Surface::Tiled {
                dimension, xdir, ..
            },
            Shape::Plane { normal, .. },
        ) = (objects[i % n].surface, &objects[i % n].shape)
        else {
            panic!("no tiles")
        };
        let hit = p * UNIT + VIEWPOINT;
        let truth = match xdir {
            None => [
                (hit.x + 10_000.0) / dimension.x,
                (hit.z + 10_000.0) / dimension.y,
            ],
            Some(xdir) => {
                let rows: [V3<f64>; 2] = rows(*normal, xdir);
                [
                    (rows[0].to_f64().dot(hit) + 10_000.0) / dimension.x,
                    (rows[1].to_f64().dot(hit) + 10_000.0) / dimension.y,
                ]
            }
        };
        let record = &records[i % n];
        let rows = [record.row_0, record.row_1];
        let answer = answer.map(f64::from);
        for k in 0..2 {
            // Along the plane's own coordinate there is nothing to decide.
            if rows[k] != [0.0; 3] {
                index(
                    &mut seen[i % 2],
                    apart(answer[k], truth[k], 1.0),
                    answer[k + 2],
                );
            }
        }
    }
    seen
}

/// Indices of blocks, and the components of H − point.
pub(crate) fn blocks(
    gpu: &Gpu,
    world: &World,
    wgsl: &str,
    count: usize,
) -> [[BoundStatistics; 2]; 2] {
    assert_has(
        wgsl,
        &[
            "var index = at.point.position * at.plane.per_unit + at.plane.fraction;",
            "var margin = abs(index - round(index)) - (abs(at.plane.per_unit) * index_error(at.point) + at.plane.index_error);",
        ],
    );
    let objects = modulated(world, 64 + 2);
    // An odd number, so that every record gets points of both kinds.
    let n = (objects.len() - 1) | 1;
    let (mut rng, mut items) = (Rng(7), Vec::new());
    let points: Vec<_> = (0..count).map(|i| point(&mut rng, &mut items, i)).collect();
    let body = format!(
        "{POINT}
    let at = PlanePoint(point, vec3f(1.0), pplanes[i % {n}u]);
    let index = at.point.position * at.plane.per_unit + at.plane.fraction;
    let bound = abs(at.plane.per_unit) * index_error(at.point) + at.plane.index_error;
    answers[3u * i] = vec4f(index, 0.0);
    answers[3u * i + 1u] = vec4f(bound, 0.0);
    answers[3u * i + 2u] = vec4f(pplane_from_point(at), 0.0);"
    );
    let records = &world.packed.pplanes;
    assert_eq!(records.len(), objects.len());
    let inputs = [(9, bytemuck::cast_slice(records))];
    let answers = run(gpu, wgsl, &body, &items, &inputs, count, 3);
    let mut seen = [
        [
            "index of a block, exact point",
            "index of a block, point is off",
        ],
        [
            "pplane_from_point, exact point",
            "pplane_from_point, point is off",
        ],
    ]
    .map(|names| names.map(BoundStatistics::new));
    for (i, (answer, p)) in answers.chunks(3).zip(points).enumerate() {
        let record = &records[i % n];
        let hit = p * UNIT + VIEWPOINT;
        let point = match &objects[i % n].shape {
            Shape::Plane { point, .. } => point,
            Shape::Triangle(triangle) => &triangle.vertices[0],
            Shape::Sphere { .. } | Shape::Quadric(_) => panic!("no plane"),
        };
        for k in 0..3 {
            if record.per_unit[k] == 0.0 {
                continue;
            }
            let truth = 2.0 * hit[k] + 1000.0 - f64::from(record.parity[k]);
            let off = apart(f64::from(answer[0][k]), truth, 2.0);
            index(&mut seen[0][i % 2], off, f64::from(answer[1][k]));
            if k < 2 {
                let off = f64::from(answer[2][k]) - (hit[k] - point[k]);
                seen[1][i % 2].error(off.abs(), f64::from(answer[2][2]));
            }
        }
    }
    seen
}

/// The colour wheel, at components that are off by as much as they may be, or are exact.
pub(crate) fn wheel(gpu: &Gpu, wgsl: &str, count: usize) -> [BoundStatistics; 2] {
    let (mut rng, mut items) = (Rng(8), Vec::new());
    let truth: Vec<_> = (0..count)
        .map(|i| {
            let (size, angle) = (rng.log(-6.0, 4.0), rng.uniform(0.0, std::f64::consts::TAU));
            let angle = if rng.chance(0.2) {
                // Where a channel is 0, or components are alike.
                f64::from(rng.below(24) as u32) * std::f64::consts::PI / 12.0 + rng.log(-8.0, -2.0)
            } else {
                angle
            };
            let told = [size * angle.cos(), size * angle.sin()].map(|x| x as f32);
            let error = if i % 2 == 0 {
                0.0
            } else {
                (size * rng.log(-7.0, -1.0)) as f32
            };
            items.extend([told[0], told[1], error, 0.0]);
            told.map(|x| f64::from(x) + rng.sign() * f64::from(error))
        })
        .collect();
    let body = "
    let shade = color_wheel(items[i].x, items[i].y, items[i].z);
    answers[2u * i] = vec4f(shade.color, select(0.0, 1.0, doubt));
    answers[2u * i + 1u] = vec4f(shade.error, 0.0);";
    let answers = run(gpu, wgsl, body, &items, &[], count, 2);
    let mut seen =
        ["color_wheel, exact place", "color_wheel, place is off"].map(BoundStatistics::new);
    for (i, (answer, [x, y])) in answers.chunks(2).zip(truth).enumerate() {
        let seen = &mut seen[i % 2];
        if answer[0][3] == 1.0 {
            seen.decision(false, true, false);
            continue;
        }
        let square = x * x + y * y;
        let (cosine, sine) = ((x - y) * (x + y) / square, 2.0 * x * y / square);
        let root = 0.75_f64.sqrt();
        let colors = [
            1.0 + cosine,
            1.0 - 0.5 * cosine - root * sine,
            1.0 - 0.5 * cosine + root * sine,
        ];
        for k in 0..3 {
            seen.error(
                (f64::from(answer[0][k]) - colors[k]).abs(),
                f64::from(answer[1][k]),
            );
        }
    }
    seen
}

/// Powers of 1 − y by themselves.
pub(crate) fn power(gpu: &Gpu, wgsl: &str, count: usize) -> BoundStatistics {
    let (mut rng, mut items) = (Rng(10), Vec::new());
    let truth: Vec<_> = (0..count)
        .map(|_| {
            let y = match rng.below(3) {
                0 => rng.uniform(0.0, 1.0),
                1 => 1.0 - rng.log(-7.0, 0.0),
                _ => rng.log(-12.0, 0.0),
            } as f32;
            let y = y.min(1.0_f32.next_down());
            // log₂ of the result, most often.
            let log = (-f64::from(y)).ln_1p();
            let n = (rng.log(-2.0, 2.0) / -log).clamp(1e-3, 1e6) as f32;
            items.extend([y, n, 0.0, 0.0]);
            (f64::from(n) * log).exp()
        })
        .collect();
    let body = "answers[i] = vec4f(power(items[i].x, items[i].y), 0.0, 0.0);";
    let answers = run(gpu, wgsl, body, &items, &[], count, 1);
    let mut seen = BoundStatistics::new("power");
    for (answer, truth) in answers.iter().zip(truth) {
        let [value, share] = [answer[0], answer[1]].map(f64::from);
        if share < 1.0 {
            seen.error((value - truth).abs(), value * share);
        } else {
            seen.must((0.0..=value * 1.001).contains(&truth));
        }
    }
    seen
}

/// The glint's power of the cosine between two directions that are off by as much as they may be, or are exact.
pub(crate) fn glint(gpu: &Gpu, wgsl: &str, count: usize) -> [BoundStatistics; 2] {
    let (mut rng, mut items) = (Rng(9), Vec::new());
    let truth: Vec<_> = (0..count)
        .map(|i| {
            let n = match rng.below(4) {
                0 => rng.log(0.0, 3.0).floor(),
                1 => rng.log(3.0, 6.0),
                _ => rng.log(-1.0, 3.0),
            } as f32;
            let normal = rng.unit();
            let across = normal.cross(rng.unit()).normalize();
            // Where the power is neither 1 nor next to 0, as a rule.
            let angle = match rng.below(8) {
                0 => rng.uniform(0.0, 1.6),
                _ => (rng.uniform(0.0, 6.0) / f64::from(n)).sqrt().min(1.6),
            };
            let length = rng.uniform(0.2, 2.0);
            let half = (normal * angle.cos() + across * angle.sin()) * length;
            let is_off = if i % 2 == 0 { 0.0 } else { 1.0 };
            let errors = [0; 2].map(|_| rng.log(-7.0, -2.0));
            let mut tell = |truth: DVec3, error: f64| {
                let way = [rng.unit(), across * rng.sign()];
                let off = truth + way[rng.below(2)] * error * is_off;
                let (told, near) = rounded(off);
                items.extend(told);
                items.push(round_up((near - truth).length()));
            };
            tell(half, errors[0] * length);
            tell(normal, errors[1]);
            items.extend([n, 0.0, 0.0, 0.0]);
            let cosine = half.dot(normal) / length;
            cosine.max(0.0).powf(f64::from(n))
        })
        .collect();
    let body = "
    let half = items[3u * i];
    let normal = items[3u * i + 1u];
    let most = glint_power(half.xyz, half.w, normal.xyz, normal.w, items[3u * i + 2u].x);
    answers[i] = vec4f(most, select(0.0, 1.0, doubt), 0.0);";
    let answers = run(gpu, wgsl, body, &items, &[], count, 1);
    let mut seen =
        ["power, exact directions", "power, directions are off"].map(BoundStatistics::new);
    for (i, (answer, truth)) in answers.iter().zip(truth).enumerate() {
        let [glint, share, doubt, _] = answer.map(f64::from);
        if doubt == 1.0 {
            seen[i % 2].decision(false, true, false);
        } else if share < 1.0 {
            seen[i % 2].error((glint - truth).abs(), glint * share);
        } else {
            seen[i % 2].must((0.0..=glint * (1.0 + share)).contains(&truth));
        }
    }
    seen
}

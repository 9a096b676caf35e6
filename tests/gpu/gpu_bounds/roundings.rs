//! What single constants count, by itself: expressions of the shaders on operands that are exact, in units of U.

use glam::DVec3;
use plumb::gpu::device::Gpu;
use plumb::shader::bounds::{NAMED, ROUNDING};

use super::support::{Rng, rounded, run};

/// What a constant counts the roundings of.
struct Counted {
    constant: &'static str,
    /// The expression, over `a`, `b` and `c`.
    wgsl: &'static str,
    /// Its operands.
    operands: fn(&mut Rng) -> [DVec3; 3],
    /// Its true value, and what a unit of the constant is there, but for U.
    truth: fn([DVec3; 3]) -> (DVec3, f64),
}

/// Three vectors, the last of them of positive numbers.
fn any(rng: &mut Rng) -> [DVec3; 3] {
    let size = rng.log(-3.0, 3.0);
    let positive = DVec3::from_array([0; 3].map(|_| rng.log(-3.0, 3.0)));
    [rng.within(size), rng.unit(), positive]
}

fn units(rng: &mut Rng) -> [DVec3; 3] {
    [rng.unit(), rng.unit(), DVec3::ONE]
}

/// Directions whose length is off by as much as that of a primary ray's may be.
fn nearly_units(rng: &mut Rng) -> [DVec3; 3] {
    let length = 1.0 + rng.uniform(-5e-5, 5e-5);
    [rng.unit(), rng.unit() * length, DVec3::ONE]
}

/// What leads from a center at right angles to a ray; the ray's direction; the radius, its inverse and the root.
fn past_a_sphere(rng: &mut Rng) -> [DVec3; 3] {
    let (r, share, dir) = (rng.log(-2.0, 2.0), rng.uniform(0.0, 1.0), rng.unit());
    let across = dir.cross(rng.unit()).normalize();
    let root = r * (1.0 - share * share).sqrt();
    [across * share * r, dir, DVec3::new(r, 1.0 / r, root)]
}

/// Two directions, and a cosine that is nearly theirs.
fn in_a_cone(rng: &mut Rng) -> [DVec3; 3] {
    let [a, b] = [rng.unit(), rng.unit()];
    [a, b, alone(-a.dot(b) + rng.uniform(-0.1, 0.1))]
}

/// The longest path, and one of its size.
fn nearly_a_path(rng: &mut Rng) -> [DVec3; 3] {
    let longest = rng.log(-3.0, 3.0);
    let path = longest * rng.uniform(0.0, 1.5);
    [rng.unit(), rng.unit(), DVec3::new(longest, path, 0.0)]
}

fn alone(value: f64) -> DVec3 {
    DVec3::new(value, 0.0, 0.0)
}

const COUNTED: &[Counted] = &[
    Counted {
        constant: "HIT_ROUNDINGS",
        wgsl: "a * (1.0 / c.x)",
        operands: any,
        truth: |[a, _, c]| (a / c.x, a.length() / c.x),
    },
    Counted {
        constant: "DISTANCE_ROUNDINGS",
        wgsl: "vec3f(c.y * (1.0 / c.x), 0.0, 0.0)",
        operands: any,
        truth: |[_, _, c]| (alone(c.y / c.x), c.y / c.x),
    },
    Counted {
        constant: "POSITION_ROUNDINGS",
        wgsl: "a + c.x * b",
        operands: any,
        truth: |[a, b, c]| (a + c.x * b, a.length() + c.x),
    },
    Counted {
        constant: "DISC_ROUNDINGS",
        wgsl: "vec3f(c.x * c.x - dot(a, a), 0.0, 0.0)",
        operands: past_a_sphere,
        truth: |[a, _, c]| (alone(c.x * c.x - a.dot(a)), c.x * c.x),
    },
    Counted {
        constant: "ROOT_ROUNDINGS",
        wgsl: "vec3f(c.x * (c.y + c.z * inverseSqrt(c.z)), 0.0, 0.0)",
        operands: any,
        truth: |[_, _, c]| {
            let value = c.x * (c.y + c.z.sqrt());
            (alone(value), value)
        },
    },
    Counted {
        constant: "NORMAL_ROUNDINGS",
        wgsl: "(a + c.z * b) * -c.y",
        operands: past_a_sphere,
        truth: |[a, b, c]| ((a + c.z * b) * -c.y, 1.0),
    },
    Counted {
        constant: "DIRECTION_ROUNDINGS",
        wgsl: "a * inverseSqrt(max(dot(a, a), TINY_SQUARE))",
        operands: any,
        truth: |[a, ..]| (a.normalize(), 1.0),
    },
    Counted {
        constant: "AIM_ROUNDINGS",
        wgsl: "unit_step(barrier(a * barrier1(inverseSqrt(max(dot(a, a), TINY_SQUARE)))))",
        operands: any,
        truth: |[a, ..]| (a.normalize(), 1.0),
    },
    Counted {
        constant: "UNIT_ROUNDINGS",
        wgsl: "unit_step(b)",
        operands: nearly_units,
        truth: |[_, b, _]| (b.normalize(), 1.0),
    },
    Counted {
        constant: "DOT_ROUNDINGS",
        wgsl: "vec3f(dot(a, b), 0.0, 0.0)",
        operands: units,
        truth: |[a, b, _]| (alone(a.dot(b)), 1.0),
    },
    Counted {
        constant: "BEYOND_ROUNDINGS",
        wgsl: "vec3f(dot(a, b), 0.0, 0.0)",
        operands: any,
        truth: |[a, b, _]| (alone(a.dot(b)), a.length()),
    },
    Counted {
        constant: "PICTURE_ROUNDINGS",
        wgsl: "vec3f(c.x / c.y * barrier(vec3f(dot(a, b), 0.0, 0.0)).x, 0.0, 0.0)",
        operands: any,
        truth: |[a, b, c]| (alone(c.x / c.y * a.dot(b)), c.x / c.y * a.length()),
    },
    Counted {
        constant: "HALF_ROUNDINGS",
        wgsl: "a - b",
        operands: units,
        truth: |[a, b, _]| (a - b, 1.0),
    },
    Counted {
        constant: "APART_ROUNDINGS",
        wgsl: "vec3f(dot(barrier(a - b), barrier(a - b)) * inverseSqrt(dot(barrier(a - b), barrier(a - b))), 0.0, 0.0)",
        operands: units,
        truth: |[a, b, _]| (alone((a - b).length()), (a - b).length()),
    },
    Counted {
        constant: "HEIGHT_ROUNDINGS",
        wgsl: "vec3f(c.x * c.y, 0.0, 0.0)",
        operands: any,
        truth: |[_, _, c]| (alone(c.x * c.y), c.x * c.y),
    },
    Counted {
        // Without the sums in which it is compared: a difference has the sign of the exact one.
        constant: "LIMIT_ROUNDINGS",
        wgsl: "vec3f(dot(a, a) * inverseSqrt(max(dot(a, a), TINY_SQUARE)), 0.0, 0.0)",
        operands: any,
        truth: |[a, ..]| (alone(a.length()), a.length()),
    },
    Counted {
        constant: "CONE_ROUNDINGS",
        wgsl: "vec3f(-dot(a, b) - c.x, 0.0, 0.0)",
        operands: in_a_cone,
        truth: |[a, b, c]| (alone(-a.dot(b) - c.x), 1.0),
    },
    Counted {
        constant: "PANE_ROUNDINGS",
        wgsl: "c * (b * c.x)",
        operands: any,
        truth: |[_, b, c]| (c * (b * c.x), (c * (b * c.x)).length()),
    },
    Counted {
        constant: "SHARE_ROUNDINGS",
        wgsl: "a * (b * (c.x / c.y * c.z))",
        operands: any,
        truth: |[a, b, c]| {
            let value = a * b * (c.x / c.y * c.z);
            (value, value.length())
        },
    },
    Counted {
        constant: "PATH_ROUNDINGS",
        wgsl: "vec3f(c.x - c.y, 0.0, 0.0)",
        operands: nearly_a_path,
        truth: |[_, _, c]| (alone(c.x - c.y), c.x),
    },
    Counted {
        constant: "BOX_ROUNDINGS",
        wgsl: "a - b",
        operands: any,
        truth: |[a, b, _]| (a - b, a.length() + b.length()),
    },
    Counted {
        constant: "MIRROR_ROUNDINGS",
        wgsl: "unit_step(barrier(2.0 * barrier1(-dot(a, b)) * a + b))",
        operands: units,
        truth: |[a, b, _]| ((b - 2.0 * a.dot(b) * a).normalize(), 1.0),
    },
];

/// For each of them its name, what it has to be at least, and the most roundings that were seen.
pub(crate) fn seen(gpu: &Gpu, wgsl: &str, count: usize) -> Vec<(&'static str, f64, f64)> {
    let measured = |counted: &Counted| {
        let (mut rng, mut items) = (Rng(11), Vec::new());
        let truth: Vec<(DVec3, f64)> = (0..count)
            .map(|_| {
                let near = (counted.operands)(&mut rng).map(rounded);
                items.extend(
                    near.iter()
                        .flat_map(|(told, _)| [told[0], told[1], told[2], 0.0]),
                );
                (counted.truth)(near.map(|(_, near)| near))
            })
            .collect();
        let body = format!(
            "let a = items[3u * i].xyz;
    let b = items[3u * i + 1u].xyz;
    let c = items[3u * i + 2u].xyz;
    answers[i] = vec4f({}, 0.0);",
            counted.wgsl
        );
        let answers = run(gpu, wgsl, &body, &items, &[], count, 1);
        let off = answers.iter().zip(truth).map(|(answer, (value, unit))| {
            let [x, y, z, _] = answer.map(f64::from);
            (DVec3::new(x, y, z) - value).length() / (unit * ROUNDING)
        });
        let constant = NAMED
            .iter()
            .find(|constant| constant.name == counted.constant);
        let least = constant.map_or(0.0, |constant| constant.least);
        (counted.constant, least, off.fold(0.0, f64::max))
    };
    COUNTED.iter().map(measured).collect()
}

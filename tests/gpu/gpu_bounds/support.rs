//! Random operands, runs on the GPU, and the tables of what was measured.

use std::sync::Arc;

use glam::DVec3;
use plumb::gpu::adapters;
use plumb::gpu::device::Gpu;
use plumb::shader::bounds::{ROUNDING, round_up};
use plumb::shader::records::Dispatch;
use wgpu::util::DeviceExt as _;

/// SplitMix64.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// 10 to a power between the two.
    pub(crate) fn log(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.uniform(low, high))
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.uniform(0.0, 1.0) < share
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    pub(crate) fn within(&mut self, size: f64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.uniform(-size, size)))
    }

    pub(crate) fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.within(1.0);
            if (0.01..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }
}

/// The vector in f32, and as what it then is.
pub(crate) fn rounded(v: DVec3) -> ([f32; 3], DVec3) {
    let near = v.to_array().map(|x| x as f32);
    (near, DVec3::from_array(near.map(f64::from)))
}

/// A ray as it truly is, and as the shader is told about it.
pub(crate) struct TrueRay {
    pub(crate) base: DVec3,
    pub(crate) dir: DVec3,
    /// base, a number that is free, dir, base_error, dir_error, size.
    pub(crate) told: [f32; 12],
}

impl TrueRay {
    /// The shader is told a ray that is off by `errors` (base, direction) toward `way`, and bounds that are `slack`
    /// times as large. Without an error the base is one that f32 has.
    pub(crate) fn new(
        base: DVec3,
        dir: DVec3,
        errors: [f64; 2],
        ways: [DVec3; 2],
        slack: f64,
    ) -> Self {
        let stretch = 1.0 + 2.5 * ROUNDING * (1e3 * (base.x + dir.y)).sin();
        let base = if errors[0] > 0.0 {
            base
        } else {
            rounded(base).1
        };
        let dir = dir.normalize();
        let (told_base, near_base) = rounded(base + errors[0] * ways[0]);
        // Directions that the shaders make are of unit length, but for a few roundings.
        let (told_dir, near_dir) = rounded((dir + errors[1] * ways[1]).normalize() * stretch);
        let base_error = round_up((near_base - base).length() * slack);
        let dir_error = round_up((near_dir - dir).length() * slack);
        let size = told_base.iter().map(|x| x.abs()).sum();
        let ([a, b, c], [d, e, f]) = (told_base, told_dir);
        Self {
            base,
            dir,
            told: [a, b, c, 0.0, d, e, f, base_error, dir_error, size, 0.0, 0.0],
        }
    }

    /// One of the ways in which rays are off: a little, or (`wild`) as far as a ray to a light may be.
    pub(crate) fn off(rng: &mut Rng, base: DVec3, dir: DVec3, hint: DVec3, wild: bool) -> Self {
        let [b, d] = [0; 2].map(|_| {
            let way = [rng.unit(), hint * rng.sign(), dir * rng.sign()];
            way[rng.below(3)]
        });
        let errors = if wild {
            [rng.log(-7.0, 0.0), rng.log(-2.0, -0.46)]
        } else {
            [rng.log(-7.0, -2.0), rng.log(-7.0, -2.5)]
        };
        let slack = if wild || rng.chance(0.5) {
            1.0
        } else {
            rng.uniform(1.0, 3.0)
        };
        Self::new(base, dir, errors, [b, d], slack)
    }

    pub(crate) fn exact(base: DVec3, dir: DVec3) -> Self {
        Self::new(base, dir, [0.0; 2], [DVec3::ZERO; 2], 1.0)
    }
}

/// An open adapter; without one there is no test.
pub(crate) fn open() -> Arc<Gpu> {
    adapters::shared(None).unwrap_or_else(|error| {
        panic!("{error}. This test needs a GPU adapter, a software one will do: `sh scripts/test.sh` sees to it")
    })
}

/// The shader with a constant of its own replaced.
pub(crate) fn with_constant(wgsl: &str, name: &str, value: &str) -> String {
    let start = format!("const {name} = ");
    let mut found = false;
    let lines: Vec<String> = wgsl
        .lines()
        .map(|line| {
            if line.starts_with(&start) {
                found = true;
                format!("{start}{value};")
            } else {
                line.to_owned()
            }
        })
        .collect();
    assert!(found, "the shader has no constant {name}");
    lines.join("\n")
}

/// Runs `body` once for each of the `count` items on the functions of a composed shader. It may name `i`, the buffer
/// `items` of vec4f, and `answers`, of `vectors` vec4f for each item. `inputs` are the other buffers that it reaches,
/// by binding.
pub(crate) fn run(
    gpu: &Gpu,
    wgsl: &str,
    body: &str,
    items: &[f32],
    inputs: &[(u32, &[u8])],
    count: usize,
    vectors: usize,
) -> Vec<[f32; 4]> {
    let wgsl = format!(
        "{wgsl}
@group(0) @binding(100) var<storage, read> items: array<vec4f>;
@group(0) @binding(101) var<storage, read_write> answers: array<vec4f>;
@compute @workgroup_size(64) fn test(@builtin(global_invocation_id) id: vec3u) {{
    let i = id.x + dispatch.zero;
    if i >= {count}u {{
        return;
    }}
{body}
}}
"
    );
    let device = &gpu.device;
    let pipeline = gpu
        .compile(&wgsl, "test")
        .unwrap_or_else(|error| panic!("{error}"));
    let filled = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("input"),
            contents,
            usage,
        })
    };
    let size = (count * vectors * 16) as u64;
    let answers = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let dispatch = dispatch();
    let mut buffers: Vec<(u32, wgpu::Buffer)> = inputs
        .iter()
        .chain([&(0, dispatch.as_slice())])
        .map(|(binding, bytes)| {
            let usage = if *binding == 0 {
                wgpu::BufferUsages::UNIFORM
            } else {
                wgpu::BufferUsages::STORAGE
            };
            (*binding, filled(bytes, usage))
        })
        .collect();
    let storage = wgpu::BufferUsages::STORAGE;
    buffers.push((100, filled(bytemuck::cast_slice(items), storage)));
    let bound = buffers.iter().map(|(binding, buffer)| (*binding, buffer));
    let bound: Vec<_> = bound.chain([(101, &answers)]).collect();
    let group = gpu.bind(&pipeline, &bound);
    let left = gpu
        .run_once(
            &pipeline,
            &group,
            [(count as u32).div_ceil(64), 1],
            &answers,
        )
        .unwrap_or_else(|error| panic!("{error}"));
    bytemuck::pod_collect_to_vec(&left)
}

/// What `barrier` asks for.
fn dispatch() -> Vec<u8> {
    let dispatch = Dispatch {
        first: [0; 2],
        size: [1; 2],
        ..bytemuck::Zeroable::zeroed()
    };
    bytemuck::bytes_of(&dispatch).to_vec()
}

/// What was seen of one quantity.
pub(crate) struct BoundStatistics {
    name: &'static str,
    /// |value − true| / bound.
    ratios: Vec<f64>,
    /// Decisions that were wrong.
    wrong: usize,
    /// Operands for which nothing was decided.
    open: usize,
}

impl BoundStatistics {
    pub(crate) fn new(name: &'static str) -> Self {
        Self {
            name,
            ratios: Vec::new(),
            wrong: 0,
            open: 0,
        }
    }

    pub(crate) fn error(&mut self, off: f64, bound: f64) {
        // A NaN is no bound.
        self.ratios.push(match (off <= bound, bound == 0.0) {
            (true, true) => 0.0,
            (_, false) if !off.is_nan() && !bound.is_nan() => off / bound,
            _ => f64::INFINITY,
        });
    }

    /// What was claimed (for sure, and not impossible) against what is so.
    pub(crate) fn decision(&mut self, sure: bool, possible: bool, truth: bool) {
        self.wrong += usize::from(if truth { !possible } else { sure } || (sure && !possible));
        self.open += usize::from(possible && !sure);
    }

    pub(crate) fn must(&mut self, holds: bool) {
        self.wrong += usize::from(!holds);
    }

    pub(crate) fn worst(&self) -> f64 {
        self.ratios.iter().copied().fold(0.0, f64::max)
    }

    pub(crate) fn violations(&self) -> usize {
        self.wrong + self.ratios.iter().filter(|r| **r > 1.0).count()
    }

    fn median(&self) -> f64 {
        let mut sorted = self.ratios.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Prints the row of the table, and asks for containment, and for a worst ratio of at least `tight`.
    pub(crate) fn judge(&self, least_count: usize, tight: f64) {
        println!(
            "{:<34} {:>8} {:>8.4} {:>8.4} {:>7} {:>5}",
            self.name,
            self.ratios.len(),
            self.worst(),
            self.median(),
            self.open,
            self.wrong
        );
        assert_eq!(self.violations(), 0, "{}: the bound is broken", self.name);
        assert!(
            self.ratios.len() >= least_count,
            "{}: only {} were decided",
            self.name,
            self.ratios.len()
        );
        assert!(
            self.worst() >= tight,
            "{}: a bound {} times too large",
            self.name,
            1.0 / self.worst()
        );
    }
}

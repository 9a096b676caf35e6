//! The known answers of the notes (docs/SCENE.md, "The notes' known answers") in WGSL, on the GPU: the vector
//! operations that plumb's shaders are made of, and the ray of a pixel by `shaders/camera.wgsl` itself, as plumb
//! composes it. Without an adapter they fail.

mod operations;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use plumb::gpu::GpuError;
use plumb::gpu::adapters;
use plumb::gpu::device::Gpu;
use plumb::prepare;
use plumb::render::Settings;
use plumb::scene::{Camera, Extent, Material, Object, Scene, Shape, Surface};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;
use wgpu::util::DeviceExt as _;

/// The notes' operations in WGSL. What WGSL has itself (dot, cross, length, +, −, scalar ·, matrix ·) is used as it is.
const OPERATIONS: &str = "
fn unit(v: vec3f) -> vec3f {
    return v / sqrt(dot(v, v));
}

fn project(n: vec3f, v: vec3f) -> vec3f {
    return v - dot(n, v) * n;
}

fn reflect_ray(unitin: vec3f, unitnorm: vec3f) -> vec3f {
    let u = -unitin;
    return 2.0 * unitnorm * dot(u, unitnorm) - u;
}

// WGSL's matrices are given by columns, the notes' by rows.
fn rows(r0: vec3f, r1: vec3f, r2: vec3f) -> mat3x3f {
    return transpose(mat3x3f(r0, r1, r2));
}

fn row(m: mat3x3f, i: u32) -> vec3f {
    return transpose(m)[i];
}

fn rotation(v: vec3f, w: vec3f) -> mat3x3f {
    let x = unit(cross(v, w));
    let z = unit(w);
    return rows(x, cross(z, x), z);
}
";

/// An open adapter; without one there is no test.
fn open(wanted: Option<&str>) -> Arc<Gpu> {
    adapters::shared(wanted).unwrap_or_else(|error| {
        panic!("{error}. This test needs a GPU adapter, a software one will do: `sh scripts/test.sh` sees to it")
    })
}

/// Runs one invocation of the entry point `test`, which reads `input` at binding 100 and writes `count` of vec4f
/// at 101.
fn run(wgsl: &str, input: &[u8], count: usize) -> Vec<DVec3> {
    let gpu = open(None);
    let gpu_device = &gpu.device;
    let pipeline = gpu
        .compile(wgsl, "test")
        .unwrap_or_else(|error| panic!("{error}\n{wgsl}"));
    let inputs = gpu_device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("inputs"),
        contents: input,
        usage: wgpu::BufferUsages::STORAGE,
    });
    let size = (count * size_of::<[f32; 4]>()) as u64;
    let answers = gpu_device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = gpu.bind(&pipeline, &[(100, &inputs), (101, &answers)]);
    let left = gpu.run_once(&pipeline, &group, [1, 1], &answers).unwrap();
    left.chunks_exact(16)
        .map(bytemuck::pod_read_unaligned::<[f32; 4]>)
        .map(|[x, y, z, written]| {
            assert_eq!(written, 1.0, "an answer was not written");
            DVec3::new(x.into(), y.into(), z.into())
        })
        .collect()
}

/// The shader whose answers are those of the function bodies, which call the inputs `a`, `b`, `c` and `d`.
fn shader(operations: &str, bodies: &[&str]) -> String {
    let mut functions = String::new();
    let mut main = String::new();
    for (i, body) in bodies.iter().enumerate() {
        functions += &format!(
            "fn answer_{i}(a: vec3f, b: vec3f, c: vec3f, d: vec3f) -> vec3f {{ {body} }}\n"
        );
        main += &format!("    answers[{i}] = vec4f(answer_{i}(a, b, c, d), 1.0);\n");
    }
    format!(
        "@group(0) @binding(100) var<storage, read> inputs: array<vec4f, 4>;
@group(0) @binding(101) var<storage, read_write> answers: array<vec4f>;
{operations}
{functions}
@compute @workgroup_size(1) fn test() {{
    let a = inputs[0].xyz;
    let b = inputs[1].xyz;
    let c = inputs[2].xyz;
    let d = inputs[3].xyz;
{main}}}
"
    )
}

/// What the function bodies give on the GPU, for inputs that no compiler knows: they come from a buffer.
fn answers<const N: usize>(inputs: &[[f32; 3]], bodies: [&str; N]) -> [DVec3; N] {
    answers_with(OPERATIONS, inputs, bodies)
}

fn answers_with<const N: usize>(
    operations: &str,
    inputs: &[[f32; 3]],
    bodies: [&str; N],
) -> [DVec3; N] {
    let mut vectors = [[0.0_f32; 4]; 4];
    for (vector, [x, y, z]) in vectors.iter_mut().zip(inputs) {
        *vector = [*x, *y, *z, 0.0];
    }
    let found = run(
        &shader(operations, &bodies),
        bytemuck::cast_slice(&vectors),
        N,
    );
    found.try_into().unwrap()
}

/// `%8.3lf` three times, as the notes print a vector. A GPU need not keep the sign of a zero.
fn prn(v: DVec3) -> String {
    format!("{:8.3}{:8.3}{:8.3}", v.x, v.y, v.z).replace("-0.000", " 0.000")
}

fn vec(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

mod pixel_to_ray {
    use super::*;

    const VIEWPOINT: DVec3 = DVec3::new(4.0, 3.0, 6.0);

    /// The camera of the notes' example, with a plane so that there are rays.
    fn scene(pixeldim: [u32; 2]) -> Scene {
        let shape = Shape::Plane {
            normal: DVec3::Z,
            point: DVec3::new(0.0, 0.0, -5.0),
            extent: Extent::Unbounded,
        };
        Scene {
            camera: Camera {
                name: "c".into(),
                pixeldim,
                worlddim: DVec2::new(8.0, 6.0),
                viewpoint: VIEWPOINT,
            },
            materials: vec![Material {
                name: "m".into(),
                ambient: DVec3::ONE,
                ..Material::default()
            }],
            objects: vec![Object {
                name: "wall".into(),
                material: 0,
                shape,
                surface: Surface::Plain,
            }],
            lights: vec![],
            textures: vec![],
        }
    }

    /// The shader that plumb composes for the scene, and a second entry point that calls its camera.
    fn composed(scene: &Scene) -> String {
        let packed = Packed::new(scene, &Settings::default());
        let mut wgsl = compose(
            &packed,
            &FeatureSet::new(&packed, &Settings::default(), 8),
            Entry::Picture,
        );
        wgsl += "
@group(0) @binding(100) var<storage, read> test_pixels: array<vec2i>;
@group(0) @binding(101) var<storage, read_write> test_rays: array<vec4f>;
@compute @workgroup_size(1) fn test() {
    for (var i = 0u; i < arrayLength(&test_pixels); i++) {
        test_rays[i] = vec4f(camera_getdir(test_pixels[i]).w, 1.0);
    }
}
";
        wgsl
    }

    /// From the viewpoint to the world points of the pixels: what the shader says, in the scene's units.
    fn rays<const N: usize>(
        scene: &Scene,
        pixels: [[i32; 2]; N],
        edit: impl Fn(String) -> String,
    ) -> [DVec3; N] {
        let unit = 2.0_f64.powi(prepare::Camera::<f64>::new(&scene.camera).scale);
        let found = run(&edit(composed(scene)), bytemuck::cast_slice(&pixels), N);
        let found: [DVec3; N] = found.try_into().unwrap();
        found.map(|w| w * unit)
    }

    fn two_digits(v: DVec3) -> [String; 3] {
        v.normalize().to_array().map(|x| format!("{x:.2}"))
    }

    const EXPECTED: [&str; 3] = ["-0.39", "-0.35", "-0.85"];

    #[test]
    fn by_the_second_formula() {
        let [ray, corner, opposite] = rays(
            &scene([640, 480]),
            [[100, 40], [0, 0], [639, 479]],
            |wgsl| wgsl,
        );
        assert_eq!(two_digits(ray), EXPECTED);
        assert!(ray.z < 0.0);
        let close =
            |a: DVec3, b: DVec3| assert!((a - b).abs().max_element() < 4e-6, "{a} is not {b}");
        close(
            VIEWPOINT + ray,
            DVec3::new(800.0 / 639.0, 240.0 / 479.0, 0.0),
        );
        close(VIEWPOINT + corner, DVec3::ZERO);
        close(VIEWPOINT + opposite, DVec3::new(8.0, 6.0, 0.0));
    }

    /// A picture one pixel wider and higher has the first formula's numbers.
    #[test]
    fn by_the_first_formula() {
        let [ray, last] = rays(&scene([641, 481]), [[100, 40], [639, 240]], |wgsl| wgsl);
        assert_eq!(ray, DVec3::new(-2.75, -2.5, -6.0));
        assert_eq!(format!("{:.2}", ray.length()), "7.06");
        assert_eq!(two_digits(ray), EXPECTED);
        // The notes print 7.988 for 8 · 639/640 = 7.9875.
        assert!(((VIEWPOINT + last).x - 7.9875).abs() < 1e-6, "{last}");
    }

    #[test]
    fn a_wrong_camera_is_noticed() {
        let halved = |wgsl: String| {
            let edited = wgsl.replace("* CAMERA_STEP", "* (0.5 * CAMERA_STEP)");
            assert_ne!(
                edited, wgsl,
                "the camera no longer reads as this test thinks"
            );
            edited
        };
        let [ray] = rays(&scene([640, 480]), [[100, 40]], halved);
        assert_ne!(two_digits(ray), EXPECTED);
    }
}

mod a_wrong_answer_is_noticed {
    use super::*;

    /// What reflect and project give on the GPU when a text of the operations is replaced.
    fn edited(from: &str, to: &str) -> [String; 2] {
        let operations = OPERATIONS.replace(from, to);
        assert!(OPERATIONS.contains(from));
        let inputs = [[1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
        answers_with(
            &operations,
            &inputs,
            ["return reflect_ray(unit(a), b);", "return project(b, c);"],
        )
        .map(prn)
    }

    const RIGHT: [&str; 2] = ["   0.707   0.707   0.000", "   1.000   0.000   1.000"];

    #[test]
    fn in_the_shader() {
        assert_eq!(edited("", ""), RIGHT);
        let [reflect, project] = edited("let u = -unitin;", "let u = unitin;");
        assert_ne!(reflect, RIGHT[0]);
        assert_eq!(project, RIGHT[1]);
        let [reflect, project] = edited("v - dot(n, v) * n", "v + dot(n, v) * n");
        assert_eq!(reflect, RIGHT[0]);
        assert_ne!(project, RIGHT[1]);
        assert_ne!(edited("sqrt(dot(v, v))", "dot(v, v)")[0], RIGHT[0]);
    }

    #[test]
    #[should_panic(expected = "0.425")]
    fn in_the_last_digit() {
        let [unit] = answers(&[[3.0, 4.0, 5.0]], ["return unit(a);"]);
        assert_eq!(prn(unit), "   0.425   0.566   0.707");
    }

    #[test]
    #[should_panic(expected = "was not written")]
    fn when_nothing_is_written() {
        let wgsl =
            shader(OPERATIONS, &["return a;"]).replace("a, b, c, d), 1.0)", "a, b, c, d), 0.0)");
        run(&wgsl, &[0; 64], 1);
    }

    #[test]
    #[should_panic(expected = "no_such_function")]
    fn when_the_shader_does_not_compile() {
        answers(&[], ["return no_such_function(a);"]);
    }

    /// The other tests compute on the same device meanwhile.
    #[test]
    fn by_the_one_whose_shader_does_not_compile_alone() {
        let gpu = open(None);
        let refused = gpu.compile(
            "@compute @workgroup_size(1) fn main() { nothing(); }",
            "main",
        );
        assert!(matches!(refused, Err(GpuError::Refused { .. })));
        let missing = gpu.compile("@compute @workgroup_size(1) fn main() {}", "other");
        assert!(matches!(missing, Err(GpuError::Refused { .. })));
        gpu.check().unwrap();
        assert!(Arc::ptr_eq(&gpu, &open(None)));
    }

    #[test]
    #[should_panic(expected = "This test needs a GPU adapter")]
    fn without_an_adapter() {
        open(Some("an adapter that nobody has"));
    }
}

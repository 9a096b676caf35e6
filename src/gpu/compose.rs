//! The WGSL for exactly one scene, put together from the files of `shaders/`.
//!
//! A line `//#if name` … `//#else` … `//#end` keeps its lines where the feature holds; `//#insert name` is replaced by what
//! is written here: the camera's numbers, the objects of a small scene as literals, the procedural shaders used. Helpers
//! that only some shaders call (`color_wheel`, `pplane_odd`, …) come in when a text that does come in names them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::features::FeatureSet;
use super::pack::{Kind, Packed, Plane, SmallSphere, WideSphere};
use crate::cpu::procedural::{PPLANE_WGSL, PSPHERE_WGSL};

/// Side of the square workgroup: 16×16 or 256×1 were a fifth faster than 8×8 on lavapipe.
pub const WORKGROUP: u32 = 16;

const BINDINGS: &str = include_str!("../../shaders/bindings.wgsl");
const CAMERA: &str = include_str!("../../shaders/camera.wgsl");
const BVH: &str = include_str!("../../shaders/bvh.wgsl");
const PLANE: &str = include_str!("../../shaders/plane.wgsl");
const SPHERE: &str = include_str!("../../shaders/sphere.wgsl");
const SURFACE: &str = include_str!("../../shaders/surface.wgsl");
const TRACE: &str = include_str!("../../shaders/trace.wgsl");

/// Writes the shader for a packed scene.
pub fn compose(packed: &Packed, features: &FeatureSet) -> String {
    let procedural = procedural(features);
    let mut names = features.names();
    // A helper comes in where a chosen shader names it, or another helper does.
    let used = |name: &str| procedural.contains(name);
    let helpers = [
        ("color_wheel", used("color_wheel(")),
        ("pplane_odd", used("pplane_odd(")),
        ("pplane_from_point", used("pplane_from_point(")),
        ("odd", names.contains("tiled") || used("pplane_odd(")),
    ];
    names.extend(helpers.into_iter().filter_map(|(name, holds)| holds.then_some(name)));

    let mut files = vec![BINDINGS];
    if features.any_object() {
        files.push(CAMERA);
        if features.planes {
            files.push(PLANE);
        }
        if features.small_spheres || features.wide_spheres {
            files.push(SPHERE);
        }
        if features.bvh {
            files.push(BVH);
        }
        files.push(SURFACE);
    } else {
        files.push(CAMERA);
    }
    files.push(TRACE);
    let insert = |name: &str| match name {
        "procedural" => procedural.clone(),
        "procedural_cases" => procedural_cases(features),
        "unrolled" => unrolled(packed, features),
        _ => unreachable!("shaders/ asks for the insertion `{name}`"),
    };
    let mut text = constants(packed, features);
    for file in files {
        text.push('\n');
        preprocess(file, &names, &insert, &mut text);
    }
    text
}

/// The numbers that the text refers to by name.
fn constants(packed: &Packed, features: &FeatureSet) -> String {
    let camera = &packed.camera;
    let mut lines = vec![format!("const WORKGROUP = {WORKGROUP};")];
    if features.any_object() {
        lines.push(format!("const CAMERA_ANCHOR = vec2i({}, {});", camera.anchor[0], camera.anchor[1]));
        lines.push(format!("const CAMERA_STEP = {};", vector(&camera.step)));
        lines.push(format!("const CAMERA_OFFSET = {};", vector(&camera.offset)));
        lines.push(format!("const CAMERA_DISTANCE = {};", literal(camera.distance)));
        lines.push(format!("const CAMERA_GAIN = {};", literal(camera.gain)));
    }
    let counts = [
        ("PLANES", packed.planes.len(), features.planes),
        ("SMALL_SPHERES", packed.small_spheres.len(), features.small_spheres),
        ("WIDE_SPHERES", packed.wide_spheres.len(), features.wide_spheres),
    ];
    for (name, count, present) in counts {
        if present && !features.unrolled {
            lines.push(format!("const {name} = {count}u;"));
        }
    }
    if features.bvh {
        lines.push(format!("const BVH_DEPTH = {}u;", packed.bvh_depth));
        lines.push(format!("const BVH_STEPS = {}u;", bvh_steps(packed)));
    }
    for kind in features.kinds.iter().filter(|kind| **kind != Kind::Plain) {
        lines.push(format!("const {} = {}u;", kind.name(), kind.code()));
    }
    lines.join("\n") + "\n"
}

/// lavapipe ends every loop of an invocation, without a word, once they have gone round 65,535 times together.
const LOOP_LIMIT: usize = 65_535;

/// Iterations that the loops outside the tree may take, with half the limit left for the tree.
pub const LOOP_ITERATIONS: usize = LOOP_LIMIT / 2;

/// Steps down the tree after which a pixel is handed to the CPU. A step is one iteration and as many as its leaf holds.
fn bvh_steps(packed: &Packed) -> usize {
    let leaf = packed.bvh.iter().map(|node| node.count as usize).max().unwrap_or(0);
    (LOOP_LIMIT - LOOP_ITERATIONS) / (1 + leaf)
}

/// The procedural shaders used, and those that they call.
fn procedural(features: &FeatureSet) -> String {
    let mut text = String::new();
    for (table, used) in [(PPLANE_WGSL, features.pplanes()), (PSPHERE_WGSL, features.pspheres())] {
        let mut chosen: BTreeSet<usize> = used.into_iter().map(|n| n as usize).collect();
        loop {
            let called: BTreeSet<usize> = (0..table.len())
                .filter(|&i| chosen.iter().any(|&c| c != i && table[c].1.contains(&format!("{}(", table[i].0))))
                .collect();
            let before = chosen.len();
            chosen.extend(called);
            if chosen.len() == before {
                break;
            }
        }
        for i in chosen {
            text.push('\n');
            text.push_str(table[i].1);
        }
    }
    text
}

/// The cases of `getamb` for the procedural shaders.
fn procedural_cases(features: &FeatureSet) -> String {
    let mut text = String::new();
    for kind in &features.kinds {
        let (point, family, shader) = match *kind {
            Kind::Plain | Kind::Tiled => continue,
            Kind::Pplane(shader) => (
                "PlanePoint(ray.w / hit.inverse, object.ambient, pplanes[record])",
                PPLANE_WGSL,
                shader,
            ),
            Kind::SmallPsphere(shader) => (
                "SpherePoint(small_sphere_from_center(small_spheres[record], ray, hit.inverse), object.ambient)",
                PSPHERE_WGSL,
                shader,
            ),
            Kind::WidePsphere(shader) => (
                "SpherePoint(wide_sphere_from_center(wide_spheres[record], ray, hit.inverse), object.ambient)",
                PSPHERE_WGSL,
                shader,
            ),
        };
        let function = family.get(shader as usize).map_or("", |entry| entry.0);
        writeln!(text, "        case {}: {{ return {function}({point}); }}", kind.name()).unwrap_or_default();
    }
    text
}

/// The objects of a small scene as literals: no load, no loop.
fn unrolled(packed: &Packed, features: &FeatureSet) -> String {
    let mut text = String::new();
    if !features.unrolled {
        return text;
    }
    let mut line = |hits: &str, record: String, object: u32| {
        writeln!(text, "    nearer(&closest, {hits}({record}, ray), {object}u);").unwrap_or_default();
    };
    for p in &packed.planes {
        line("plane_hits", plane_literal(p), p.object);
    }
    for s in &packed.small_spheres {
        line("small_sphere_hits", small_sphere_literal(s), s.object);
    }
    for s in &packed.wide_spheres {
        line("wide_sphere_hits", wide_sphere_literal(s), s.object);
    }
    text
}

fn plane_literal(p: &Plane) -> String {
    format!("Plane({}, {}u, {}, 0u)", vector(&p.inverse), p.object, vector(&p.front))
}

fn small_sphere_literal(s: &SmallSphere) -> String {
    format!(
        "SmallSphere({}, {}, {}, {}, {}, vec2i({}, {}), {}u, 0u)",
        vector(&s.toward),
        literal(s.rho2),
        literal(s.gain),
        literal(s.distance),
        vector(&s.offset),
        s.anchor[0],
        s.anchor[1],
        s.object
    )
}

fn wide_sphere_literal(s: &WideSphere) -> String {
    format!(
        "WideSphere({}, {}, {}, {}, {}u, 0u)",
        vector(&s.toward),
        literal(s.kappa2),
        literal(s.gain),
        literal(s.distance),
        s.object
    )
}

/// The f32 as a WGSL literal that means exactly it: a hexadecimal one, since a decimal one may be rounded either way.
pub fn literal(value: f32) -> String {
    let bits = value.to_bits();
    let sign = if bits >> 31 == 1 { "-" } else { "" };
    let exponent = (bits >> 23) & 0xff;
    let fraction = (bits & 0x7f_ffff) << 1;
    match exponent {
        // Subnormals may be flushed anyway; zero keeps the text short.
        0 => "0f".into(),
        // Larger than any f32: no scene that keeps its limits gets here but through overflow; the largest stands for it.
        255 => format!("{sign}0x1.fffffep+127f"),
        _ => {
            let digits = format!("{fraction:06x}");
            let digits = digits.trim_end_matches('0');
            let point = if digits.is_empty() { "" } else { "." };
            format!("{sign}0x1{point}{digits}p{:+}f", exponent as i32 - 127)
        }
    }
}

fn vector(values: &[f32]) -> String {
    let list: Vec<String> = values.iter().map(|v| literal(*v)).collect();
    format!("vec{}f({})", values.len(), list.join(", "))
}

/// Copies the lines of `file` that the features ask for.
fn preprocess(file: &str, names: &BTreeSet<&str>, insert: &dyn Fn(&str) -> String, text: &mut String) {
    let mut keep = vec![true];
    for line in file.lines() {
        let all = keep.iter().all(|k| *k);
        match line.trim_start().strip_prefix("//#") {
            None if all => {
                text.push_str(line);
                text.push('\n');
            }
            None => {}
            Some(directive) => match directive.split_once(' ').unwrap_or((directive, "")) {
                ("if", name) => keep.push(names.contains(name)),
                ("else", _) => {
                    if let Some(last) = keep.last_mut() {
                        *last = !*last;
                    }
                }
                ("end", _) => {
                    keep.pop();
                }
                ("insert", name) if all => text.push_str(&insert(name)),
                ("insert", _) => {}
                (other, _) => unreachable!("shaders/ has the line `//#{other}`"),
            },
        }
    }
}

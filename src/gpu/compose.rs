//! The WGSL for exactly one scene, put together from the files of `shaders/`.
//!
//! A line `//#if name` … `//#else` … `//#end` keeps its lines where the feature holds; `//#insert name` is replaced by what
//! is written here: the camera's numbers, the objects of a small scene as literals, the procedural shaders used. Helpers
//! that only some shaders call (`color_wheel`, `pplane_odd`, …) come in when a text that does come in names them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::features::FeatureSet;
use super::literal::{
    literal, plane_literal, rectangle_literal, small_sphere_literal, vector, wide_sphere_literal,
    world_plane_literal, world_sphere_literal,
};
use super::pack::{Kind, Packed};
use crate::cpu::procedural::{PPLANE_WGSL, PSPHERE_WGSL};

/// Side of the square workgroup: 16×16 or 256×1 were a fifth faster than 8×8 on lavapipe.
pub const WORKGROUP: u32 = 16;

/// Most rays that wait while another is followed; a pixel that needs more is handed to the CPU.
const STACK: usize = 24;

const BINDINGS: &str = include_str!("../../shaders/bindings.wgsl");
const CAMERA: &str = include_str!("../../shaders/camera.wgsl");
const BVH: &str = include_str!("../../shaders/bvh.wgsl");
const JITTER: &str = include_str!("../../shaders/jitter.wgsl");
const LIGHT: &str = include_str!("../../shaders/light.wgsl");
const PLANE: &str = include_str!("../../shaders/plane.wgsl");
const SPHERE: &str = include_str!("../../shaders/sphere.wgsl");
const SURFACE: &str = include_str!("../../shaders/surface.wgsl");
const TRACE: &str = include_str!("../../shaders/trace.wgsl");
const WORLD: &str = include_str!("../../shaders/world.wgsl");

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
    names.extend(
        helpers
            .into_iter()
            .filter_map(|(name, holds)| holds.then_some(name)),
    );

    let lit = names.contains("lit");
    let files = [
        (BINDINGS, true),
        (CAMERA, true),
        (
            JITTER,
            names.contains("samples") && !names.contains("course"),
        ),
        (PLANE, features.planes || features.rectangles || lit),
        (
            SPHERE,
            features.small_spheres || features.wide_spheres || names.contains("lit_sphere"),
        ),
        (BVH, features.bvh),
        (SURFACE, features.any_object()),
        (WORLD, lit),
        (LIGHT, lit),
        (TRACE, true),
    ];
    let insert = |name: &str| match name {
        "procedural" => procedural.clone(),
        "procedural_cases" => procedural_cases(features),
        "from_center_cases" => from_center_cases(features),
        "unrolled" => unrolled(packed, features),
        "unrolled_closest" => unrolled_world(packed, features, |hits| {
            format!("met_nearer(&closest, {hits});")
        }),
        "unrolled_any" => unrolled_world(packed, features, |hits| {
            // The object's number, which comes last, is not asked for.
            let call = hits.rsplit_once(',').map_or(hits, |(call, _)| call);
            format!("hit = hit || {call} > 0.0;")
        }),
        _ => unreachable!("shaders/ asks for the insertion `{name}`"),
    };
    let mut text = constants(packed, features);
    for (file, _) in files.iter().filter(|(_, needed)| *needed) {
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
        lines.push(format!(
            "const CAMERA_ANCHOR = vec2i({}, {});",
            camera.anchor[0], camera.anchor[1]
        ));
        lines.push(format!("const CAMERA_STEP = {};", vector(&camera.step)));
        lines.push(format!("const CAMERA_OFFSET = {};", vector(&camera.offset)));
        lines.push(format!(
            "const CAMERA_DISTANCE = {};",
            literal(camera.distance)
        ));
        lines.push(format!("const CAMERA_GAIN = {};", literal(camera.gain)));
    }
    let names = features.names();
    let mut count = |name: &str, constant: &str, value: usize| {
        if names.contains(name) {
            lines.push(format!("const {constant} = {value}u;"));
        }
    };
    count("plane_loop", "PLANES", packed.planes.len());
    count("rectangle_loop", "RECTANGLES", packed.rectangles.len());
    count(
        "small_sphere_loop",
        "SMALL_SPHERES",
        packed.small_spheres.len(),
    );
    count(
        "wide_sphere_loop",
        "WIDE_SPHERES",
        packed.wide_spheres.len(),
    );
    count("bvh", "BVH_DEPTH", packed.bvh_depth);
    count("samples", "SAMPLES", features.samples as usize);
    // The last round of each of up to four loops only finds its end.
    count("counted", "LANES", features.lanes as usize);
    count(
        "counted",
        "PRIMARY_STEPS",
        if features.unrolled {
            0
        } else {
            packed.loop_iterations() + 4
        },
    );
    if let Some(lit) = &packed.lit {
        count("lit", "LIGHTS", lit.lights.len());
        // The last round of either loop only finds its end.
        count("world_loop", "WORLD_STEPS", lit.loop_iterations() + 2);
        let in_shadows = names.contains("world_loop") && names.contains("any_hit");
        count(
            "lit",
            "SHADOW_STEPS",
            if in_shadows {
                lit.loop_iterations() + 2
            } else {
                0
            },
        );
        count("world_plane_loop", "WORLD_PLANES", lit.planes.len());
        count("world_sphere_loop", "WORLD_TREE", lit.in_tree);
        count("world_sphere_loop", "WORLD_SPHERES", lit.spheres.len());
        count("stack", "STACK", STACK);
        if names.contains("lit") {
            lines.push(format!("const UNIT = {};", literal(camera.unit)));
            lines.push(format!("const HIGHEST = {};", literal(lit.highest)));
        }
    }
    if let (Some(lit), true) = (features.lit, names.contains("branches")) {
        lines.push(format!("const MAX_PATH = {};", literal(lit.max_path)));
        lines.push(format!("const MAX_RAYS = {}u;", lit.max_rays));
    }
    for kind in features.kinds.iter().filter(|kind| **kind != Kind::Plain) {
        lines.push(format!("const {} = {}u;", kind.name(), kind.code()));
    }
    lines.join("\n") + "\n"
}

/// lavapipe ends every loop, without a word, once the loops of an invocation have gone round 65,535 times together; and
/// counts for all invocations that are lanes of one vector, as long as any of them goes round.
const LOOP_LIMIT: usize = 65_535;

/// Most iterations of the loops outside the tree, for one primary ray. The shader counts those of the others.
pub const LOOP_ITERATIONS: usize = LOOP_LIMIT / 2;

/// The procedural shaders used, and those that they call.
fn procedural(features: &FeatureSet) -> String {
    let mut text = String::new();
    for (table, used) in [
        (PPLANE_WGSL, features.pplanes()),
        (PSPHERE_WGSL, features.pspheres()),
    ] {
        let mut chosen: BTreeSet<usize> = used.into_iter().map(|n| n as usize).collect();
        loop {
            let called: BTreeSet<usize> = (0..table.len())
                .filter(|&i| {
                    chosen
                        .iter()
                        .any(|&c| c != i && table[c].1.contains(&format!("{}(", table[i].0)))
                })
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
            Kind::Plain | Kind::Tiled | Kind::Textured => continue,
            Kind::Pplane(shader) => (
                "PlanePoint(point.position, ambient, pplanes[record])",
                PPLANE_WGSL,
                shader,
            ),
            Kind::SmallPsphere(shader) | Kind::WidePsphere(shader) | Kind::LitPsphere(shader) => (
                "SpherePoint(point.from_center, ambient)",
                PSPHERE_WGSL,
                shader,
            ),
        };
        let function = family.get(shader as usize).map_or("", |entry| entry.0);
        writeln!(
            text,
            "        case {}: {{ return {function}({point}); }}",
            kind.name()
        )
        .unwrap_or_default();
    }
    text
}

/// How `locate` finds H − C on a sphere, by what a record says of it.
fn from_center_cases(features: &FeatureSet) -> String {
    if features.lit.is_some() {
        // The form for small spheres is the more accurate one; `complete` has filled in the other.
        return if features.small_spheres {
            "    if (object.place & SPHERE_BIT) != 0u {
        let seen = world_spheres[object.place & ~SPHERE_BIT].seen;
        if seen != 0u {
            point.from_center = small_sphere_from_center(small_spheres[seen - 1u], ray, hit.inverse);
        }
    }
"
            .into()
        } else {
            String::new()
        };
    }
    let mut text = "    switch object.kind & 255u {\n".to_owned();
    for kind in &features.kinds {
        let size = match kind {
            Kind::SmallPsphere(_) => "small",
            Kind::WidePsphere(_) => "wide",
            _ => continue,
        };
        let call = format!(
            "{size}_sphere_from_center({size}_spheres[object.kind >> 8u], ray, hit.inverse)"
        );
        writeln!(
            text,
            "        case {}: {{ point.from_center = {call}; }}",
            kind.name()
        )
        .unwrap_or_default();
    }
    text + "        default: {}\n    }\n"
}

/// The objects of a small scene as literals, for primary rays: no load, no loop.
fn unrolled(packed: &Packed, features: &FeatureSet) -> String {
    let mut text = String::new();
    if !features.unrolled {
        return text;
    }
    let mut line = |hits: &str, record: String, object: u32| {
        writeln!(
            text,
            "    nearer(&closest, {hits}({record}, ray), {object}u);"
        )
        .unwrap_or_default();
    };
    for p in &packed.planes {
        line("plane_hits", plane_literal(p), p.object);
    }
    for r in &packed.rectangles {
        line("rectangle_hits", rectangle_literal(r), r.object);
    }
    for s in &packed.small_spheres {
        line("small_sphere_hits", small_sphere_literal(s), s.object);
    }
    for s in &packed.wide_spheres {
        line("wide_sphere_hits", wide_sphere_literal(s), s.object);
    }
    text
}

/// The objects of a small scene as literals, for rays from anywhere: a statement for each call of its hits function.
fn unrolled_world(
    packed: &Packed,
    features: &FeatureSet,
    statement: impl Fn(&str) -> String,
) -> String {
    let mut text = String::new();
    let (true, Some(lit)) = (features.unrolled, &packed.lit) else {
        return text;
    };
    let mut line = |call: String| writeln!(text, "    {}", statement(&call)).unwrap_or_default();
    for p in &lit.planes {
        line(format!(
            "plane_hits_from({}, base, dir, range), {}u",
            world_plane_literal(p),
            p.object
        ));
    }
    for s in &lit.spheres {
        line(format!(
            "sphere_hits_from({}, base, dir, range), {}u",
            world_sphere_literal(s),
            s.object
        ));
    }
    text
}

/// Copies the lines of `file` that the features ask for.
fn preprocess(
    file: &str,
    names: &BTreeSet<&str>,
    insert: &dyn Fn(&str) -> String,
    text: &mut String,
) {
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

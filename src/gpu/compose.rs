//! The WGSL for exactly one scene, put together from the files of `shaders/`.
//!
//! A line `//#if name` … `//#else` … `//#end` keeps its lines where the feature holds, and a line that ends in `//~` stays
//! only where pixels are certified; `//#insert name` is replaced by what
//! is written here: the camera's numbers, the objects of a small scene as literals, the procedural shaders used. Helpers
//! that only some shaders call (`color_wheel`, `pplane_odd`, …) come in when a text that does come in names them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::bounds;
use super::features::{FeatureSet, PARTIAL_HEAD};
use super::literal::{
    literal, plane_literal, rectangle_literal, sphere_literal, vector, world_plane_literal,
    world_sphere_literal,
};
use super::pack::{Kind, Packed};
use crate::cpu::procedural::{PPLANE_WGSL, PSPHERE_WGSL};

/// Side of the square workgroup: 16×16 or 256×1 were a fifth faster than 8×8 on lavapipe.
pub const WORKGROUP: u32 = 16;

/// Most rays that wait while another is followed; a pixel that needs more is handed to the CPU.
const STACK: usize = 8;

/// Of a pixel that the GPU does not decide, samples off by more than this (255 is a full byte) are left to the CPU too: what
/// they leave open would cost all others. Tried from 1/1000 to 1: around 1/8 the CPU has the fewest samples to compute.
const FINE: f32 = 0.125;

const BINDINGS: &str = include_str!("../../shaders/bindings.wgsl");
const CLOSEST: &str = include_str!("../../shaders/closest.wgsl");
const CAMERA: &str = include_str!("../../shaders/camera.wgsl");
const BVH: &str = include_str!("../../shaders/bvh.wgsl");
const JITTER: &str = include_str!("../../shaders/jitter.wgsl");
const LIGHT: &str = include_str!("../../shaders/light.wgsl");
const MAIN: &str = include_str!("../../shaders/main.wgsl");
const POINT: &str = include_str!("../../shaders/point.wgsl");
const PLANE: &str = include_str!("../../shaders/plane.wgsl");
const SPHERE: &str = include_str!("../../shaders/sphere.wgsl");
const SURFACE: &str = include_str!("../../shaders/surface.wgsl");
const TRACE: &str = include_str!("../../shaders/trace.wgsl");
const WORLD: &str = include_str!("../../shaders/world.wgsl");

/// Constants that are fields of `Job` while the camera moves.
const MOVING: [(&str, &str); 6] = [
    ("CAMERA_ANCHOR", "job.camera_anchor"),
    ("CAMERA_STEP", "job.camera_step"),
    ("CAMERA_OFFSET", "job.camera_offset"),
    ("CAMERA_DISTANCE", "job.camera_distance"),
    ("CAMERA_GAIN", "job.camera_gain"),
    ("* UNIT)", "* job.unit)"),
];

/// Writes the shader for a packed scene.
pub fn compose(packed: &Packed, features: &FeatureSet) -> String {
    let procedural = if features.any_object() {
        procedural(features)
    } else {
        String::new()
    };
    let mut names = features.names();
    // A helper comes in where a chosen shader names it, or another helper does.
    let used = |name: &str| procedural.contains(name);
    let helpers = [
        ("color_wheel", used("color_wheel(")),
        ("pplane_odd", used("pplane_odd(")),
        ("pplane_from_point", used("pplane_from_point(")),
        ("odd", names.contains("tiled") || used("pplane_odd(")),
        (
            "whole",
            names.contains("tiled") || names.contains("textured") || used("pplane_odd("),
        ),
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
        (SPHERE, features.spheres || names.contains("lit_sphere")),
        (BVH, names.contains("bvh")),
        (SURFACE, features.any_object()),
        (WORLD, lit),
        (LIGHT, lit),
        (CLOSEST, features.any_object()),
        (POINT, features.any_object()),
        (TRACE, true),
        (MAIN, true),
    ];
    let insert = |name: &str| match name {
        "procedural" => procedural.clone(),
        "procedural_cases" => procedural_cases(features),
        "unrolled" => unrolled(packed, features),
        "unrolled_closest" => unrolled_world(packed, features, |hits, object, group| {
            format!("met_nearer(&closest, {hits}, {object}u, {group}u, range);")
        }),
        "unrolled_any" => unrolled_world(packed, features, |hits, _, _| {
            format!("found = max(found, stands_before({hits}, range));")
        }),
        _ => unreachable!("shaders/ asks for the insertion `{name}`"),
    };
    let mut text = String::new();
    for (file, _) in files.iter().filter(|(_, needed)| *needed) {
        text.push('\n');
        preprocess(file, &names, &insert, &mut text);
    }
    if names.contains("moving") {
        for (constant, field) in MOVING {
            text = text.replace(constant, field);
        }
    }
    constants(packed, features) + &text
}

/// The numbers that the text refers to by name.
fn constants(packed: &Packed, features: &FeatureSet) -> String {
    let camera = &packed.camera.numbers;
    let mut lines = vec![format!("const WORKGROUP = {WORKGROUP};")];
    let names = features.names();
    if features.any_object() && !names.contains("moving") {
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
    if features.any_object() {
        lines.extend(error_constants(packed, &names));
    }
    let mut count = |name: &str, constant: &str, value: usize| {
        if names.contains(name) {
            lines.push(format!("const {constant} = {value}u;"));
        }
    };
    count("plane_loop", "PLANES", packed.planes.len());
    count("rectangle_loop", "RECTANGLES", packed.rectangles.len());
    count("sphere_loop", "SPHERES", packed.spheres.len());
    if let Some(tiles) = &packed.tiles {
        count("tiles", "TILE_WIDTH", tiles.sides[0] as usize);
        count("tiles", "TILE_HEIGHT", tiles.sides[1] as usize);
        count("tiles", "TILE_COLUMNS", tiles.count[0] as usize);
    }
    count("tables", "TABLES", packed.objects.len());
    count("tables", "COLUMNS", packed.tables.columns as usize);
    count("bvh", "BVH_DEPTH", packed.bvh_depth);
    count("samples", "SAMPLES", features.samples as usize);
    let words = features.partial_words();
    count("partial", "PARTIAL_WORDS", words as usize);
    let summed = words.saturating_sub(PARTIAL_HEAD);
    count("partial", "SUMMED_WORDS", summed as usize);
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
        if names.contains("lit") && !names.contains("moving") {
            lines.push(format!("const UNIT = {};", literal(camera.unit)));
        }
    }
    if let (Some(lit), true) = (features.lit, names.contains("branches")) {
        lines.push(format!("const MAX_PATH = {};", literal(lit.max_path)));
        lines.push(format!("const MAX_RAYS = {}u;", lit.max_rays));
    }
    for kind in features.kinds.iter().filter(|kind| **kind != Kind::Plain) {
        lines.push(format!("const {} = {}u;", kind.name(), kind.code()));
    }
    if names.contains("partial") {
        lines.push(format!("const FINE = {};", literal(FINE)));
    }
    lines.join("\n") + "\n"
}

/// What the error bounds in the shader refer to by name.
fn error_constants(packed: &Packed, names: &BTreeSet<&str>) -> Vec<String> {
    let line = |name: &str, value: f64| format!("const {name} = {};", literal(bounds::up(value)));
    if !names.contains("certified") {
        let tiny = bounds::NAMED
            .iter()
            .filter(|(name, _)| *name == "TINY_SQUARE");
        return tiny.map(|(name, value)| line(name, *value)).collect();
    }
    let mut lines: Vec<String> = bounds::NAMED
        .iter()
        .map(|(name, value)| line(name, *value))
        .collect();
    let camera = &packed.camera;
    let spread = f64::from(camera.spread);
    lines.push(line("W_ERROR", f64::from(camera.w_error)));
    lines.push(line(
        "LENGTH_ERROR",
        bounds::LENGTH_ROUNDINGS * spread * bounds::U,
    ));
    lines.push(line(
        "DIR_ERROR",
        bounds::DIR_ROUNDINGS * spread * bounds::U,
    ));
    lines.push(line(
        "VALUE_ERROR",
        bounds::VALUE_ROUNDINGS * spread * bounds::U,
    ));
    lines.push(format!("const DARK = {};", literal(packed.dark)));
    let most = (0.9 / f64::from(packed.dark)).min(f64::from(f32::MAX));
    lines.push(line("BRIGHT", most));
    if names.contains("bvh") {
        lines.push(line("BVH_SIZE", f64::from(packed.tree_size)));
    }
    lines
}

/// lavapipe ends every loop, without a word, once the loops of an invocation have gone round 65,535 times together; and
/// counts for all invocations that are lanes of one vector, as long as any of them goes round.
const LOOP_LIMIT: usize = 65_535;

/// Most iterations of the loops outside the tiles, for one primary ray. The shader counts those of the others.
pub const LOOP_ITERATIONS: usize = LOOP_LIMIT / 2;

/// The procedural shaders used, and those that they call.
fn procedural(features: &FeatureSet) -> String {
    let mut text = String::new();
    for (table, used) in [
        (PPLANE_WGSL, features.pplanes()),
        (PSPHERE_WGSL, features.pspheres()),
    ] {
        for i in with_called(table, used) {
            text.push('\n');
            text.push_str(table[i].1);
        }
    }
    text
}

/// Shaders of a table by number, and those that they call.
fn with_called(table: &[(&str, &str)], used: BTreeSet<u32>) -> BTreeSet<usize> {
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
            return chosen;
        }
    }
}

/// Whether a `pplane` shader, or one that it calls, names `helper`.
pub fn pplane_asks(shader: u32, helper: &str) -> bool {
    with_called(PPLANE_WGSL, BTreeSet::from([shader]))
        .into_iter()
        .any(|i| PPLANE_WGSL[i].1.contains(helper))
}

/// The cases of `getamb` for the procedural shaders.
fn procedural_cases(features: &FeatureSet) -> String {
    let mut text = String::new();
    for kind in &features.kinds {
        let (point, family, shader) = match *kind {
            Kind::Plain | Kind::Tiled | Kind::Textured => continue,
            Kind::Pplane(shader) => (
                "PlanePoint(point, shade.color, pplanes[record])",
                PPLANE_WGSL,
                shader,
            ),
            Kind::Psphere(shader) if features.certified => (
                "SpherePoint(point.from_center, point.from_center_error, shade.color)",
                PSPHERE_WGSL,
                shader,
            ),
            Kind::Psphere(shader) => (
                "SpherePoint(point.from_center, 0.0, shade.color)",
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

/// The objects of a small scene as literals, for primary rays: no load, no loop. Rectangles come first: of objects that
/// share a surface a plane without end is the last that counts.
fn unrolled(packed: &Packed, features: &FeatureSet) -> String {
    let mut text = String::new();
    if !features.unrolled {
        return text;
    }
    let mut line = |hits: &str, record: String, object: u32, index: usize, group: u32| {
        writeln!(
            text,
            "    nearer(&closest, {hits}({record}, ray), {object}u, {index}u, {group}u);"
        )
        .unwrap_or_default();
    };
    for (i, r) in packed.rectangles.iter().enumerate() {
        line("rectangle_hits", rectangle_literal(r), r.object, i, r.group);
    }
    for (i, p) in packed.planes.iter().enumerate() {
        line("plane_hits", plane_literal(p), p.object, i, p.group);
    }
    for (i, s) in packed.spheres.iter().enumerate() {
        line("sphere_hits", sphere_literal(s), s.object, i, 0);
    }
    text
}

/// The objects of a small scene as literals, for rays from anywhere: a statement for each call of its hits function, with
/// the object and its group.
fn unrolled_world(
    packed: &Packed,
    features: &FeatureSet,
    statement: impl Fn(&str, u32, u32) -> String,
) -> String {
    let mut text = String::new();
    let (true, Some(lit)) = (features.unrolled, &packed.lit) else {
        return text;
    };
    let mut line = |call: String, object: u32, group: u32| {
        writeln!(text, "    {}", statement(&call, object, group)).unwrap_or_default();
    };
    for p in &lit.planes {
        let call = format!("plane_hits_from({}, beam, range)", world_plane_literal(p));
        line(call, p.object, p.group);
    }
    for s in &lit.spheres {
        let call = format!("sphere_hits_from({}, beam, range)", world_sphere_literal(s));
        line(call, s.object, s.group);
    }
    text
}

/// Copies the lines of `file` that the features ask for.
pub(crate) fn preprocess(
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
                let bound = line.strip_suffix("//~");
                if bound.is_none() || names.contains("certified") {
                    text.push_str(bound.unwrap_or(line).trim_end());
                    text.push('\n');
                }
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
                ("insert", name) if all => preprocess(&insert(name), names, insert, text),
                ("insert", _) => {}
                (other, _) => unreachable!("shaders/ has the line `//#{other}`"),
            },
        }
    }
}

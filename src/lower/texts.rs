//! What the lowering is told of the two texts, for scenes without and with lights; and the Rust of a text as a whole.

use std::fmt::Write as _;
use std::process::{Command, Stdio};

use super::module::{ByHand, Shader, Told};
use super::statement::Writer;
use crate::shader::bounds;
use crate::shader::format::{Double, Format as _};

const RECORDS: &[(&str, &str)] = &[
    ("Light", "Light"),
    ("Material", "Material"),
    ("Plane", "Plane"),
    ("Polygon", "Polygon"),
    ("Pplane", "ProceduralPlane"),
    ("Projector", "Projector"),
    ("Quadric", "Quadric"),
    ("Sphere", "Sphere"),
    ("SphereAndHit", "SphereAndHit"),
    ("SphereHit", "SphereHit"),
    ("Texplane", "Texplane"),
    ("Tiled", "TiledPlane"),
    ("WorldPlane", "WorldPlane"),
    ("WorldSphere", "WorldSphere"),
    ("BvhNode", "BvhNode"),
];

/// With the struct of an object, which scenes with lights have another one of.
const AMBIENT_RECORDS: &[(&str, &str)] = &with(("Object", "Object"));
const LIT_RECORDS: &[(&str, &str)] = &with(("Object", "LitObject"));

const fn with(object: (&'static str, &'static str)) -> [(&'static str, &'static str); 16] {
    let mut all = [object; 16];
    let mut i = 0;
    while i < RECORDS.len() {
        all[i] = RECORDS[i];
        i += 1;
    }
    all
}

const UNIFORM: &[(&str, &str)] = &[
    ("closest_hit", "weight"),
    ("light_term", "number"),
    ("passage", "projector"),
    ("passed_texel", "projector"),
    ("plane_hits", "plane"),
    ("plane_hits_from", "plane"),
    ("polygon_hits", "polygon"),
    ("quadric_hits", "quadric"),
    ("quadric_hits_from", "quadric"),
    ("quadric_meets", "quadric"),
    ("quadric_root", "quadric"),
    ("sphere_hits", "sphere"),
    ("sphere_hits_from", "sphere"),
    ("third_side", "bounded"),
];

pub(super) const AMBIENT: Told = Told {
    double: false,
    roots: &[
        "camera_getdir",
        "camera_setpix",
        "jitter_hash",
        "nearer",
        "plane_hits",
        "polygon_hits",
        "quadric_hits",
        "ray_trace",
        "sphere_hits",
    ],
    by_hand: &[ByHand {
        name: "find_closest_object",
        state: false,
        on: false,
        goes_on: false,
    }],
    uniform: UNIFORM,
    apart: &["ray_trace", "quadric_meets", "quadric_normal"],
    unmasked: &["nearer"],
    identity: &["barrier", "barrier1"],
    objects: "objects",
    records: AMBIENT_RECORDS,
};

const fn by_hand(name: &'static str, state: bool, goes_on: bool) -> ByHand {
    ByHand {
        name,
        state,
        on: true,
        goes_on,
    }
}

/// The same in f64.
pub(super) const LIT_DOUBLE: Told = Told {
    double: true,
    by_hand: &[
        LIT.by_hand[0],
        LIT.by_hand[1],
        LIT.by_hand[2],
        LIT.by_hand[3],
        ByHand {
            name: "double_of",
            state: false,
            on: false,
            goes_on: false,
        },
    ],
    ..LIT
};

pub(super) const LIT: Told = Told {
    double: false,
    roots: &[
        "camera_getdir",
        "camera_setpix",
        "jitter_hash",
        "nearer",
        "nearer_secondary",
        "occludes",
        "plane_hits",
        "plane_hits_from",
        "quadric_hits_from",
        "polygon_hits",
        "quadric_hits",
        "ray_trace",
        "shadow",
        "sphere_hits",
        "sphere_hits_from",
    ],
    by_hand: &[
        ByHand {
            name: "find_closest_object",
            state: false,
            on: false,
            goes_on: false,
        },
        by_hand("closest_hit", false, false),
        by_hand("any_hit", false, false),
        by_hand("shadow", true, true),
    ],
    uniform: UNIFORM,
    apart: &[
        "ray_trace",
        "light_term",
        "shadow",
        "locate_secondary",
        "glint_power",
        "passage",
        "passed_texel",
        "texel",
        "getamb",
        "getdiff",
        "quadric_meets",
        "quadric_normal",
    ],
    unmasked: &["nearer", "nearer_secondary"],
    identity: &["barrier", "barrier1"],
    objects: "lit_objects",
    records: LIT_RECORDS,
};

/// The Rust of a text.
pub(super) fn lowered(about: &str, wgsl: &str, told: Told) -> String {
    let mut shader = Shader::new(wgsl, told);
    let functions = shader.functions();
    for function in &functions {
        shader.note_needs(*function);
    }
    let mut text = heading(about);
    text += &constants(&shader);
    text += &state(&shader);
    for (struct_name, ty) in shader.structs() {
        text += &shader.struct_text(&struct_name, ty);
    }
    for function in functions {
        text += &Writer::function(&shader, function);
    }
    formatted(&text)
}

/// What stands before all else.
fn heading(about: &str) -> String {
    format!(
        "//! {about}: `shaders/` for the lanes of a vector, written by `src/lower` from the WGSL. Change that, and \
         run\n//! its test with `UPDATE_EXPECT=1`.\n\n\
         use std::mem::offset_of;\n\n\
         use fearless_simd::Simd;\n\n\
         use super::{{Scene, by_hand, records}};\n\
         use crate::certify::lanes::gather::Gather;\n\
         use crate::certify::lanes::vector::*;\n\n"
    )
}

/// The constants, those of the bounds among them.
fn constants(shader: &Shader<'_>) -> String {
    let mut text =
        String::from("/// What the text refers to by name.\npub(super) mod constants {\n");
    for constant in bounds::NAMED {
        let used = shader.wgsl.matches(constant.name).count() > 1;
        if used {
            let (name, value) = (constant.name, constant.value);
            let (ty, value) = if shader.told.double {
                let value = if name == "U" { Double::U } else { value };
                ("f64", format!("{:?}", Double::round_up(value)))
            } else {
                ("f32", format!("{:?}", bounds::round_up(value)))
            };
            writeln!(
                text,
                "    pub(in crate::certify::lanes) const {name}: {ty} = {value};"
            )
            .unwrap();
        }
    }
    for (_, constant) in shader.module.constants.iter() {
        let value = &shader.module.global_expressions[constant.init];
        if let (Some(name), naga::Expression::Literal(literal)) = (&constant.name, value) {
            let (ty, value) = match literal {
                naga::Literal::F32(value) => ("f32", format!("{value:?}")),
                naga::Literal::F64(value) => ("f64", format!("{value:?}")),
                naga::Literal::U32(value) => ("u32", format!("{value}")),
                naga::Literal::I32(value) => ("i32", format!("{value}")),
                _ => continue,
            };
            writeln!(
                text,
                "    pub(in crate::certify::lanes) const {name}: {ty} = {value};"
            )
            .unwrap();
        }
    }
    text += "}\n";
    text
}

/// The variables of the module, one of each for each lane.
fn state(shader: &Shader<'_>) -> String {
    let mut text =
        String::from("\n/// What is private to the lanes.\npub(super) struct State<S: Simd> {\n");
    let private = shader.module.global_variables.iter().filter(|(_, global)| {
        global.space == naga::AddressSpace::Private
            && matches!(global.name.as_deref(), Some("doubt" | "stack" | "waiting"))
    });
    let mut zeros = String::new();
    for (_, global) in private {
        let field = global.name.as_deref().unwrap();
        let (ty, zero) = match &shader.module.types[global.ty].inner {
            naga::TypeInner::Array {
                base,
                size: naga::ArraySize::Constant(size),
                ..
            } => {
                let of = shader.rust_type(*base);
                (
                    format!("[{of}; {size}]"),
                    format!("[<{of}>::zero(simd); {size}]"),
                )
            }
            _ => {
                let of = shader.rust_type(global.ty);
                (of.clone(), format!("<{of}>::zero(simd)"))
            }
        };
        writeln!(text, "    pub {field}: {ty},").unwrap();
        writeln!(zeros, "            {field}: {zero},").unwrap();
    }
    write!(
        text,
        "}}\n\nimpl<S: Simd> State<S> {{\n    #[inline(always)]\n    pub(super) fn new(simd: S) -> Self {{\n        \
         Self {{\n{zeros}        }}\n    }}\n}}\n"
    )
    .unwrap();
    text
}

/// As rustfmt has it.
fn formatted(text: &str) -> String {
    use std::io::Write as _;
    let mut rustfmt = Command::new("rustfmt")
        .args(["--edition", "2024"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    rustfmt
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let output = rustfmt.wait_with_output().unwrap();
    assert!(output.status.success(), "{text}");
    String::from_utf8(output.stdout).unwrap()
}

//! Packed records as WGSL literals, for the scenes whose objects stand in the text of the shader.

use super::pack::{Plane, Rectangle, Sphere, WorldPlane, WorldSphere};

pub(super) fn plane_literal(p: &Plane) -> String {
    format!(
        "Plane({}, {}u, {}, {}u, {}, {}, vec2f())",
        vector(&p.inverse),
        p.object,
        vector(&p.front),
        p.group,
        literal(p.inverse_error),
        literal(p.front_error)
    )
}

pub(super) fn rectangle_literal(r: &Rectangle) -> String {
    format!(
        "Rectangle({}, {}u, {}, {}u, {}, {}, {}, {}, {}, 0u, {}, 0u, {})",
        vector(&r.inverse),
        r.object,
        vector(&r.front),
        r.group,
        vector(&r.side_0),
        literal(r.inverse_error),
        vector(&r.side_1),
        literal(r.front_error),
        vector(&r.side_2),
        vector(&r.side_3),
        vector(&r.side_errors)
    )
}

pub(super) fn world_plane_literal(p: &WorldPlane) -> String {
    format!(
        "WorldPlane({}, {}, {}, {}u, {}, {}u, {}, {}, {}, {}, {}, {}u, {}u, {}, {}, vec2f())",
        vector(&p.normal),
        literal(p.offset),
        vector(&p.keep),
        p.group,
        vector(&p.own),
        p.object,
        vector(&p.row_0),
        literal(p.origin_0),
        vector(&p.row_1),
        literal(p.origin_1),
        vector(&p.lengths),
        p.level,
        p.bounded,
        literal(p.highest),
        literal(p.sides_error)
    )
}

pub(super) fn world_sphere_literal(s: &WorldSphere) -> String {
    format!(
        "WorldSphere({}, {}, {}u, {}u, {}u, {}, {}, 0u, 0u, 0u)",
        vector(&s.center),
        literal(s.radius),
        s.group,
        s.object,
        s.level,
        literal(s.size),
        literal(s.inverse_radius)
    )
}

pub(super) fn sphere_literal(s: &Sphere) -> String {
    format!(
        "Sphere({}, {}, {}, {}u, {}, {}, vec2i({}, {}), {}, 0f)",
        vector(&s.along),
        literal(s.gain),
        vector(&s.square),
        s.object,
        vector(&s.affine),
        literal(s.along_error),
        s.anchor[0],
        s.anchor[1],
        literal(s.disc_error)
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

pub(crate) fn vector(values: &[f32]) -> String {
    let list: Vec<String> = values.iter().map(|v| literal(*v)).collect();
    format!("vec{}f({})", values.len(), list.join(", "))
}

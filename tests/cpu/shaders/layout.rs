//! Offsets and sizes of the packed records are those that naga computes for the WGSL structs.

use std::mem::offset_of;

use plumb::gpu::pack;

use super::*;

/// Struct members by name with their offsets, and the array stride or span of the struct.
fn wgsl_struct(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no struct {name}"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct")
    };
    let offsets = members
        .iter()
        .map(|m| (m.name.clone().unwrap(), m.offset as usize))
        .collect();
    (offsets, *span as usize)
}

macro_rules! same_layout {
    ($module:expr, $wgsl:literal, $rust:ty, $($field:ident),+) => {{
        let (members, span) = wgsl_struct(&$module, $wgsl);
        let ours = vec![$((stringify!($field).to_owned(), offset_of!($rust, $field))),+];
        assert_eq!(members, ours, "{}", $wgsl);
        assert_eq!(span, size_of::<$rust>(), "{}", $wgsl);
    }};
}

#[test]
fn records_are_laid_out_as_naga_says() {
    let all = ingredients();
    let module = assert_valid(&composed(&all).0, "all");
    let dark: Vec<_> = all
        .into_iter()
        .filter(|i| !matches!(i, Lamp | Spotlight | LampInFloor | Mirror | Glass | Glint))
        .collect();
    let dark = assert_valid(&composed(&dark).0, "all without lights");
    let sampled = assert_valid(&composed(&[Plane, Samples]).0, "samples");
    same_layout!(sampled, "Job", pack::Job, first, size, zero, room);
    // Without samples the last word is not read.
    assert_eq!(wgsl_struct(&module, "Job").1, size_of::<pack::Job>());
    same_layout!(dark, "Object", pack::Object, ambient, kind);
    same_layout!(
        module,
        "Object",
        pack::LitObject,
        material,
        kind,
        group,
        place
    );
    same_layout!(
        dark,
        "Plane",
        pack::Plane,
        inverse,
        object,
        front,
        group,
        inverse_error,
        front_error,
        unused
    );
    same_layout!(
        dark,
        "Rectangle",
        pack::Rectangle,
        inverse,
        object,
        front,
        group,
        side_0,
        inverse_error,
        side_1,
        front_error,
        side_2,
        unused_0,
        side_3,
        unused_1,
        side_errors
    );
    same_layout!(
        dark,
        "Sphere",
        pack::Sphere,
        along,
        gain,
        square,
        object,
        affine,
        along_error,
        anchor,
        disc_error,
        most
    );
    same_layout!(
        dark,
        "SphereHit",
        pack::SphereHit,
        form_x,
        form_error,
        form_y,
        center_size,
        form_z,
        unused_0,
        center,
        unused_1
    );
    same_layout!(module, "BvhNode", pack::BvhNode, min, first, max, count);
    same_layout!(
        module,
        "Tiled",
        pack::TiledPlane,
        row_0,
        fraction_0,
        row_1,
        fraction_1,
        altmaterial,
        altindex,
        parity,
        spread,
        errors
    );
    same_layout!(
        module,
        "Pplane",
        pack::ProceduralPlane,
        per_unit,
        index_error,
        fraction,
        from_point_error,
        parity,
        unused,
        from_point
    );
    same_layout!(
        module,
        "Texplane",
        pack::Texplane,
        row_0,
        origin_0,
        row_1,
        origin_1,
        size,
        first,
        repeats,
        spread,
        errors
    );
    same_layout!(
        module,
        "Material",
        pack::Material,
        ambient,
        transparency,
        diffuse,
        shininess,
        specular,
        power,
        tint,
        kept
    );
    same_layout!(
        module,
        "Light",
        pack::Light,
        location,
        cosine,
        emissivity,
        size,
        axis,
        unused
    );
    same_layout!(
        module,
        "WorldPlane",
        pack::WorldPlane,
        normal,
        offset,
        keep,
        group,
        own,
        object,
        row_0,
        origin_0,
        row_1,
        origin_1,
        lengths,
        level,
        bounded,
        highest,
        sides_error,
        unused
    );
    same_layout!(
        module,
        "WorldSphere",
        pack::WorldSphere,
        center,
        radius,
        group,
        object,
        level,
        size,
        inverse_radius,
        unused_0,
        unused_1,
        unused_2
    );
}

#[test]
fn a_camera_that_moves_stands_behind_the_job() {
    let (packed, features) = packed(&[Plane, Lamp, Fast]);
    let wgsl = compose(&packed, &features.while_moving());
    let (members, span) = wgsl_struct(&assert_valid(&wgsl, "moving"), "Job");
    let job = size_of::<pack::Job>();
    let behind = |offset: usize| job + offset;
    let ours = [
        ("camera_anchor", offset_of!(pack::CameraNumbers, anchor)),
        ("camera_step", offset_of!(pack::CameraNumbers, step)),
        ("camera_offset", offset_of!(pack::CameraNumbers, offset)),
        ("camera_distance", offset_of!(pack::CameraNumbers, distance)),
        ("camera_gain", offset_of!(pack::CameraNumbers, gain)),
        ("unit", offset_of!(pack::CameraNumbers, unit)),
        ("camera_unused", offset_of!(pack::CameraNumbers, unused)),
    ]
    .map(|(name, offset)| (name.to_owned(), behind(offset)));
    assert_eq!(members[4..], ours);
    assert_eq!(span, job + size_of::<pack::CameraNumbers>());
}

#[test]
fn a_shifted_field_is_noticed() {
    let wgsl = composed(&[Plane, ManyPlanes]).0.replace(
        "    inverse: vec3f,\n",
        "    extra: u32,\n    inverse: vec3f,\n",
    );
    let module = naga::front::wgsl::parse_str(&wgsl).unwrap();
    let (members, _) = wgsl_struct(&module, "Plane");
    assert_ne!(members[1].1, offset_of!(pack::Plane, inverse));
}

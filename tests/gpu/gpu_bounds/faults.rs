//! The same measurements with a bound set to zero: it has to be noticed.

use plumb::gpu::device::Gpu;
use plumb::shader::pack::Packed;

use super::primary::SampledPicture;
use super::support::{BoundStatistics, with_constant};
use super::world::{self, RayErrors, World};
use super::{branches, surfaces};

/// Operands for each fault.
const COUNT: usize = 1 << 16;

/// Violations among what is measured of rays from anywhere and of surfaces with constants set to zero, by constant.
pub(crate) fn running(gpu: &Gpu) -> Vec<(&'static str, usize)> {
    let world = World::many();
    let zero = |name| with_constant(&world.wgsl, name, "0f");
    let planes = |name| {
        total(&world::planes(
            gpu,
            &world,
            &zero(name),
            RayErrors::Exact,
            COUNT,
            [name; 2],
        ))
    };
    let spheres = |name| {
        total(&world::spheres(
            gpu,
            &world,
            &zero(name),
            RayErrors::Exact,
            COUNT,
            [name; 3],
        ))
    };
    let mut found: Vec<(&str, usize)> = vec![
        ("U in planes", planes("U")),
        ("U in spheres", spheres("U")),
        ("PLANE_ROUNDINGS", planes("PLANE_ROUNDINGS")),
        ("POSITION_ROUNDINGS", planes("POSITION_ROUNDINGS")),
        (
            "PERPENDICULAR_ROUNDINGS",
            spheres("PERPENDICULAR_ROUNDINGS"),
        ),
        ("DISC_ROUNDINGS", spheres("DISC_ROUNDINGS")),
        ("ROOT_ROUNDINGS", spheres("ROOT_ROUNDINGS")),
        ("NORMAL_ROUNDINGS", spheres("NORMAL_ROUNDINGS")),
    ];
    let bounced = branches::branches(
        gpu,
        &world,
        &zero("BOUNCE_ROUNDINGS"),
        RayErrors::Exact,
        COUNT,
        ["BOUNCE_ROUNDINGS"; 4],
    );
    found.push(("BOUNCE_ROUNDINGS", total(&bounced)));
    let wgsl = zero("INDEX_ROUNDINGS");
    found.push((
        "INDEX_ROUNDINGS in tiles",
        total(&surfaces::tiles(gpu, &world, &wgsl, COUNT)),
    ));
    let [blocks, from_point] = surfaces::blocks(gpu, &world, &wgsl, COUNT);
    found.push(("INDEX_ROUNDINGS in blocks", total(&blocks)));
    found.push(("INDEX_ROUNDINGS from the point", total(&from_point)));
    found.push((
        "WHEEL_ROUNDINGS",
        total(&surfaces::wheel(gpu, &zero("WHEEL_ROUNDINGS"), COUNT)),
    ));
    for (name, constant) in [
        ("U in a glint", "U"),
        ("APART_ROUNDINGS", "APART_ROUNDINGS"),
    ] {
        let seen = surfaces::glint(gpu, &zero(constant), COUNT);
        found.push((name, total(&seen)));
    }
    for name in ["LOG_ROUNDINGS", "POWER_ROUNDINGS"] {
        let seen = surfaces::power(gpu, &zero(name), COUNT);
        found.push((name, seen.violations()));
    }
    let mut world = World::many();
    for plane in &mut world.packed.tiled_planes {
        plane.errors = [0.0; 2];
    }
    for plane in &mut world.packed.pplanes {
        (plane.index_error, plane.from_point_error) = (0.0, 0.0);
    }
    let wgsl = &world.wgsl;
    found.push((
        "a tiled plane's errors",
        total(&surfaces::tiles(gpu, &world, wgsl, COUNT)),
    ));
    let [blocks, from_point] = surfaces::blocks(gpu, &world, wgsl, COUNT);
    found.push(("a pplane's index_error", total(&blocks)));
    found.push(("a pplane's from_point_error", total(&from_point)));
    found
}

/// The same for primary rays: constants, and bounds in records.
pub(crate) fn literal(gpu: &Gpu) -> Vec<(&'static str, usize)> {
    let picture = || SampledPicture::all().remove(1);
    let mut found = Vec::new();
    for (i, name) in ["W_ERROR", "LENGTH_ERROR", "DIR_ERROR", "VALUE_ERROR"]
        .into_iter()
        .enumerate()
    {
        let picture = picture();
        let mut seen = [name; 4].map(BoundStatistics::new);
        picture.camera(
            gpu,
            &with_constant(&picture.world.wgsl, name, "0f"),
            COUNT,
            &mut seen,
        );
        found.push((name, seen[i].violations()));
    }
    let mut planes = |name, fault: fn(&mut Packed), kind: usize| {
        let mut picture = picture();
        fault(&mut picture.world.packed);
        let mut seen = [name; 3].map(BoundStatistics::new);
        picture.planes(gpu, &picture.world.wgsl, COUNT, &mut seen);
        found.push((name, seen[kind].violations()));
    };
    planes(
        "a plane's inverse_error",
        |p| p.planes.iter_mut().for_each(|p| p.inverse_error = 0.0),
        0,
    );
    planes(
        "a rectangle's inverse_error",
        |p| p.rectangles.iter_mut().for_each(|r| r.inverse_error = 0.0),
        1,
    );
    planes(
        "a rectangle's side_errors",
        |p| {
            p.rectangles
                .iter_mut()
                .for_each(|r| r.side_errors = [0.0; 4])
        },
        1,
    );
    let mut spheres = |name, fault: fn(&mut Packed), kind: usize| {
        let mut picture = picture();
        fault(&mut picture.world.packed);
        let mut seen = [name; 2].map(BoundStatistics::new);
        picture.spheres(gpu, &picture.world.wgsl, COUNT, &mut seen);
        found.push((name, seen[kind].violations()));
    };
    spheres(
        "a sphere's disc_error",
        |p| p.spheres.iter_mut().for_each(|s| s.disc_error = 0.0),
        0,
    );
    spheres(
        "a sphere's along_error",
        |p| p.spheres.iter_mut().for_each(|s| s.along_error = 0.0),
        0,
    );
    spheres(
        "a sphere's form_error",
        |p| p.sphere_points.iter_mut().for_each(|s| s.form_error = 0.0),
        1,
    );
    found
}

fn total(seen: &[BoundStatistics]) -> usize {
    seen.iter().map(BoundStatistics::violations).sum()
}

//! The same measurements with a bound set to zero: it has to be noticed. All other constants are then at what they have
//! to be at least, so that what they have to spare hides nothing.

use plumb::gpu::device::Gpu;
use plumb::shader::bounds::NAMED;
use plumb::shader::pack::Packed;

use super::primary::SampledPicture;
use super::support::{BoundStatistics, with_constant};
use super::world::{self, RayErrors, World};
use super::{branches, surfaces};

/// Operands for each fault.
const COUNT: usize = 1 << 16;

/// The shader with every constant at what it has to be at least. What bounds' own roundings take stays.
pub(crate) fn at_least(wgsl: &str) -> String {
    let own = ["GROWTH", "U"];
    let others = NAMED
        .iter()
        .filter(|constant| !own.contains(&constant.name));
    others.fold(wgsl.to_owned(), |wgsl, constant| {
        with_constant(&wgsl, constant.name, &format!("{:e}f", constant.least))
    })
}

/// Violations among what is measured where all constants are at what they have to be at least.
pub(crate) fn of_the_least(gpu: &Gpu) -> Vec<(&'static str, usize)> {
    let world = World::many();
    let wgsl = at_least(&world.wgsl);
    let mut found = Vec::new();
    for errors in [RayErrors::Exact, RayErrors::Off] {
        let planes = world::planes(gpu, &world, &wgsl, errors, COUNT, ["planes"; 2]);
        let spheres = world::spheres(gpu, &world, &wgsl, errors, COUNT, ["spheres"; 3]);
        let paths = branches::branches(gpu, &world, &wgsl, errors, COUNT, ["paths"; 4]);
        let mirrors = branches::at_spheres(gpu, &world, &wgsl, errors, COUNT, ["spheres"; 3]);
        found.extend([
            ("planes", total(&planes)),
            ("spheres", total(&spheres)),
            ("mirrors and panes", total(&paths)),
            ("mirrors that are spheres", total(&mirrors)),
        ]);
    }
    let [blocks, from_point] = surfaces::blocks(gpu, &world, &wgsl, COUNT);
    found.extend([
        ("tiles", total(&surfaces::tiles(gpu, &world, &wgsl, COUNT))),
        ("blocks", total(&blocks)),
        ("from the point", total(&from_point)),
        (
            "the colour wheel",
            total(&surfaces::wheel(gpu, &wgsl, COUNT)),
        ),
        ("glints", total(&surfaces::glint(gpu, &wgsl, COUNT))),
        ("powers", surfaces::power(gpu, &wgsl, COUNT).violations()),
    ]);
    for picture in SampledPicture::all() {
        let wgsl = at_least(&picture.world.wgsl);
        let mut planes = ["", "", ""].map(BoundStatistics::new);
        picture.planes(gpu, &wgsl, COUNT, &mut planes);
        let mut spheres = ["", ""].map(BoundStatistics::new);
        picture.spheres(gpu, &wgsl, COUNT, &mut spheres);
        found.extend([
            ("planes of primary rays", total(&planes)),
            ("spheres of primary rays", total(&spheres)),
        ]);
    }
    found
}

/// Violations among what is measured of rays from anywhere and of surfaces with constants set to zero, by constant.
pub(crate) fn running(gpu: &Gpu) -> Vec<(&'static str, usize)> {
    let world = World::many();
    let least = at_least(&world.wgsl);
    let zero = |name| with_constant(&least, name, "0f");
    // A constant shows where rays are exact, or where they are off as far as they may be.
    let both = [RayErrors::Exact, RayErrors::Off];
    let planes = |name| {
        let wgsl = zero(name);
        let seen =
            both.map(|errors| total(&world::planes(gpu, &world, &wgsl, errors, COUNT, [name; 2])));
        seen.iter().sum()
    };
    let spheres = |name| {
        let wgsl = zero(name);
        let seen = both.map(|errors| {
            total(&world::spheres(
                gpu, &world, &wgsl, errors, COUNT, [name; 3],
            ))
        });
        seen.iter().sum()
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
        ("GROWTH", planes("GROWTH")),
        ("STEEP_SLOPE", planes("STEEP_SLOPE")),
        ("DISTANCE_ROUNDINGS", planes("DISTANCE_ROUNDINGS")),
        ("TURN", spheres("TURN")),
        ("SQUARE_SLOPE", spheres("SQUARE_SLOPE")),
        ("ROOT_NEAR", spheres("ROOT_NEAR")),
        ("ROOT_FAR", spheres("ROOT_FAR")),
        ("SECOND_ORDER", spheres("SECOND_ORDER")),
        (
            "WHEEL_SLOPE",
            total(&surfaces::wheel(gpu, &zero("WHEEL_SLOPE"), COUNT)),
        ),
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
    let wgsl = &least;
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
    let (mut found, mut of_primary_rays) = (Vec::new(), Vec::new());
    for (i, name) in ["W_ERROR", "LENGTH_ERROR", "DIR_ERROR", "VALUE_ERROR"]
        .into_iter()
        .enumerate()
    {
        let picture = picture();
        let mut seen = [name; 4].map(BoundStatistics::new);
        picture.camera(
            gpu,
            &with_constant(&at_least(&picture.world.wgsl), name, "0f"),
            COUNT,
            &mut seen,
        );
        found.push((name, seen[i].violations()));
    }
    let mut planes = |name, fault: fn(&mut Packed), kind: usize| {
        let mut picture = picture();
        fault(&mut picture.world.packed);
        let mut seen = [name; 3].map(BoundStatistics::new);
        picture.planes(gpu, &at_least(&picture.world.wgsl), COUNT, &mut seen);
        found.push((name, seen[kind].violations()));
    };
    planes(
        "a plane's inverse_error",
        |p| p.planes.iter_mut().for_each(|p| p.inverse_error = 0.0),
        0,
    );
    planes(
        "a rectangle's inverse_error",
        |p| p.polygons.iter_mut().for_each(|r| r.inverse_error = 0.0),
        1,
    );
    planes(
        "a rectangle's side_errors",
        |p| p.polygons.iter_mut().for_each(|r| r.side_errors = [0.0; 4]),
        1,
    );
    let mut spheres = |name, fault: fn(&mut Packed), kind: usize| {
        let mut picture = picture();
        fault(&mut picture.world.packed);
        let mut seen = [name; 2].map(BoundStatistics::new);
        picture.spheres(gpu, &at_least(&picture.world.wgsl), COUNT, &mut seen);
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
    for name in ["HIT_ROUNDINGS", "ROOT_ROUNDINGS", "NORMAL_ROUNDINGS"] {
        let picture = picture();
        let wgsl = with_constant(&at_least(&picture.world.wgsl), name, "0f");
        let mut planes = [name; 3].map(BoundStatistics::new);
        picture.planes(gpu, &wgsl, COUNT, &mut planes);
        let mut seen = [name; 2].map(BoundStatistics::new);
        picture.spheres(gpu, &wgsl, COUNT, &mut seen);
        of_primary_rays.push((name, total(&planes) + total(&seen)));
    }
    spheres(
        "a sphere's form_error",
        |p| p.sphere_points.iter_mut().for_each(|s| s.form_error = 0.0),
        1,
    );
    found.extend(of_primary_rays);
    found
}

fn total(seen: &[BoundStatistics]) -> usize {
    seen.iter().map(BoundStatistics::violations).sum()
}

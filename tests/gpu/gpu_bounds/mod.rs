//! The error bounds of the shaders, on the GPU: what they bound is within them, they are no larger than they need to
//! be, and without them pixels that are called certain are wrong. Without an adapter these tests fail.
//!
//! Operands are random and adversarial; the truth is f64, whose own error is 10⁻⁸ of f32's. With `--nocapture` the
//! tables are printed: how many values were compared, the worst and the median of |value − truth| / bound, for how many
//! operands nothing was decided, and how many decisions were wrong.

#![allow(clippy::print_stdout, reason = "the tables, with --nocapture")]

mod branches;
mod faults;
mod lanes;
mod lights;
mod pictures;
mod primary;
mod projectors;
mod quadrics;
mod roundings;
mod support;
mod surfaces;
mod weights;
mod world;

use plumb::gpu::device::Gpu;
use plumb::render::Backend;

use pictures::{Count, Fault};
use primary::SampledPicture;
use support::BoundStatistics;
use world::{RayErrors, World};

use crate::common;

/// Operands for each bound.
const MANY: usize = 1 << 18;
/// So many of them must have been decided.
const DECIDED: usize = 50_000;
/// The worst ratio must be at least this, for bounds that follow a ray, and for those of a whole picture: measured are
/// 0.07 and more, and 0.05 and more. A bound far too large would do no harm but to speed.
const TIGHT: f64 = 1.0 / 25.0;
const TIGHT_LITERAL: f64 = 1.0 / 40.0;
/// The same for quadrics, whose coefficients are sums of many terms, of which bounds take the sizes: measured is 0.029.
const TIGHT_MOMENT: f64 = 1.0 / 80.0;
/// Where rays, points or places are off by all that they may be, bounds are nearly reached.
const TIGHT_OFF: f64 = 0.8;
/// The same after several mirrors and panes, each of which may be off its own way.
const TIGHT_BOUNCED: f64 = 0.5;
/// Of a light the bounds of direction and distance add up, which its errors do not.
const TIGHT_LIGHT: f64 = 0.5;

#[test]
fn rays_from_anywhere() {
    let gpu = support::open();
    println!("{}", gpu.name);
    let world = World::many();
    let wgsl = &world.wgsl;
    let exact = [
        "plane_hits_from, exact ray",
        "locate_secondary on planes, exact ray",
    ];
    let off = [
        "plane_hits_from, ray off",
        "locate_secondary on planes, ray off",
    ];
    let planes = |errors, names| world::planes(&gpu, &world, wgsl, errors, MANY, names);
    let mut sure = Vec::from(planes(RayErrors::Exact, exact));
    let mut wide = Vec::from(planes(RayErrors::Off, off));
    let exact = [
        "sphere_hits_from, exact ray",
        "sphere_normal_from, exact ray",
        "locate_secondary on spheres, exact ray",
    ];
    let off = [
        "sphere_hits_from, ray off",
        "sphere_normal_from, ray off",
        "locate_secondary on spheres, ray off",
    ];
    let spheres = |errors, names| world::spheres(&gpu, &world, wgsl, errors, MANY, names);
    sure.extend(spheres(RayErrors::Exact, exact));
    wide.extend(spheres(RayErrors::Off, off));
    let wild = [
        "plane_hits_from, ray far off",
        "locate_secondary on planes, ray far off",
    ];
    let mut far = Vec::from(planes(RayErrors::Wild, wild));
    let wild = [
        "sphere_hits_from, ray far off",
        "sphere_normal_from, ray far off",
        "locate_secondary on spheres, ray far off",
    ];
    far.extend(spheres(RayErrors::Wild, wild));
    for seen in sure {
        seen.judge(DECIDED, TIGHT);
    }
    // Little is decided of them, and some of that at the very edge.
    for seen in far {
        seen.judge(1_000, TIGHT);
    }
    for seen in wide {
        seen.judge(DECIDED, TIGHT_OFF);
    }
}

#[test]
fn rays_to_quadrics() {
    let gpu = support::open();
    let exact = [
        "quadric_hits_from, exact ray",
        "quadric_normal, exact ray",
        "locate_secondary on quadrics",
    ];
    let off = [
        "quadric_hits_from, ray off",
        "quadric_normal, ray off",
        "locate on quadrics, ray off",
    ];
    let measured = |errors, names| quadrics::measured(&gpu, str::to_owned, errors, MANY, names);
    for seen in measured(RayErrors::Exact, exact) {
        seen.judge(DECIDED, TIGHT_MOMENT);
    }
    for seen in measured(RayErrors::Off, off) {
        seen.judge(10_000, TIGHT);
    }
    for name in ["U", "TURN", "QUOTIENT_GROWTH"] {
        let without = |wgsl: &str| support::with_constant(wgsl, name, "0f");
        let seen = [RayErrors::Exact, RayErrors::Off]
            .map(|errors| quadrics::measured(&gpu, without, errors, MANY / 4, exact));
        let violations: usize = seen.iter().flatten().map(BoundStatistics::violations).sum();
        assert!(violations > 0, "{name} = 0 is not noticed");
    }
}

#[test]
fn rays_after_mirrors_and_panes() {
    let gpu = support::open();
    let world = World::many();
    let branches =
        |errors, names| branches::branches(&gpu, &world, &world.wgsl, errors, MANY / 2, names);
    let exact = [
        "line after bounces, exact ray",
        "direction after bounces, exact ray",
        "start after bounces, exact ray",
        "length after bounces, exact ray",
    ];
    for seen in branches(RayErrors::Exact, exact) {
        seen.judge(DECIDED, TIGHT);
    }
    let off = [
        "line after bounces, ray off",
        "direction after bounces, ray off",
        "start after bounces, ray off",
        "length after bounces, ray off",
    ];
    for seen in branches(RayErrors::Off, off) {
        seen.judge(10_000, TIGHT_BOUNCED);
    }
    let spheres = |wgsl: &str, errors, names| {
        branches::at_spheres(&gpu, &world, wgsl, errors, MANY / 2, names)
    };
    let exact = [
        "direction after a sphere, exact ray",
        "line after a sphere, exact ray",
        "length after a sphere, exact ray",
    ];
    for seen in spheres(&world.wgsl, RayErrors::Exact, exact) {
        seen.judge(DECIDED, TIGHT);
    }
    let off = [
        "direction after a sphere, ray off",
        "line after a sphere, ray off",
        "length after a sphere, ray off",
    ];
    let [direction, line, length] = spheres(&world.wgsl, RayErrors::Off, off);
    direction.judge(10_000, TIGHT_BOUNCED);
    line.judge(10_000, TIGHT_BOUNCED);
    length.judge(10_000, TIGHT);
    for name in ["MIRROR_TURN", "TURN"] {
        let without = support::with_constant(&faults::at_least(&world.wgsl), name, "0f");
        let [direction, ..] = spheres(&without, RayErrors::Off, off);
        assert!(direction.violations() > 0, "{name} = 0 is not noticed");
    }
}

#[test]
fn primary_rays() {
    let gpu = support::open();
    let mut camera =
        ["W_ERROR", "LENGTH_ERROR", "DIR_ERROR", "VALUE_ERROR"].map(BoundStatistics::new);
    let mut planes = ["plane_hits", "polygon_hits", "locate on planes"].map(BoundStatistics::new);
    let mut spheres = ["sphere_hits", "sphere_normal"].map(BoundStatistics::new);
    for picture in SampledPicture::all() {
        let wgsl = &picture.world.wgsl;
        picture.camera(&gpu, wgsl, MANY / 2, &mut camera);
        picture.planes(&gpu, wgsl, MANY / 2, &mut planes);
        picture.spheres(&gpu, wgsl, MANY / 2, &mut spheres);
    }
    for seen in camera.iter().chain(&planes).chain(&spheres) {
        seen.judge(DECIDED, TIGHT_LITERAL);
    }
}

#[test]
fn at_a_hit_point() {
    let gpu = support::open();
    let world = World::many();
    let wgsl = &world.wgsl;
    let mut pairs = vec![
        surfaces::tiles(&gpu, &world, wgsl, MANY),
        surfaces::wheel(&gpu, wgsl, MANY),
        surfaces::glint(&gpu, wgsl, MANY),
    ];
    surfaces::power(&gpu, wgsl, MANY).judge(DECIDED, TIGHT);
    pairs.extend(surfaces::blocks(&gpu, &world, wgsl, MANY));
    for [exact, off] in pairs {
        exact.judge(DECIDED, TIGHT);
        off.judge(DECIDED, TIGHT_OFF);
    }
}

#[test]
fn weights_of_ordinary_size_are_followed() {
    weights::are_followed(&support::open(), &World::many().wgsl);
}

#[test]
fn weights_of_long_paths_are_known() {
    weights::are_known(&support::open(), &World::many());
}

/// Constants are no smaller than they have to be: at what they have to be at least, by their derivation, nothing is
/// outside its bound.
#[test]
fn every_constant_by_itself() {
    let gpu = support::open();
    for (name, violations) in faults::of_the_least(&gpu) {
        println!("{name:<34} {violations:>8}");
        assert_eq!(violations, 0, "{name}: the derivation is wrong");
    }
}

#[test]
fn what_a_light_brings() {
    let gpu = support::open();
    let [exact, off] = lights::terms(&gpu, str::to_owned, MANY);
    exact.judge(DECIDED, TIGHT);
    off.judge(DECIDED, TIGHT_LIGHT);
    for name in ["CLOSE", "U"] {
        let without = lights::terms(
            &gpu,
            |wgsl| support::with_constant(wgsl, name, "0f"),
            MANY / 4,
        );
        let violations = without.iter().map(BoundStatistics::violations);
        assert!(violations.sum::<usize>() > 0, "{name} = 0 is not noticed");
    }
}

#[test]
fn through_a_picture() {
    let gpu = support::open();
    let [exact, off] = projectors::passages(&gpu, str::to_owned, true, MANY);
    exact.judge(DECIDED, TIGHT);
    off.judge(DECIDED, TIGHT_OFF);
    let violations = |change: &dyn Fn(&str) -> String, own| {
        let without = projectors::passages(&gpu, change, own, MANY / 4);
        let violations = without.iter().map(BoundStatistics::violations);
        violations.sum::<usize>()
    };
    assert_eq!(
        violations(&faults::at_least, true),
        0,
        "the derivation is wrong"
    );
    assert!(
        violations(&faults::at_least, false) > 0,
        "a projector's errors = 0 are not noticed"
    );
    for name in ["CLOSE", "U"] {
        let without = |wgsl: &str| support::with_constant(wgsl, name, "0f");
        assert!(violations(&without, true) > 0, "{name} = 0 is not noticed");
    }
}

/// Operands are exact here, and no other term can hide what a constant counts.
#[test]
fn roundings_one_by_one() {
    let gpu = support::open();
    let world = World::many();
    for (name, least, most) in roundings::seen(&gpu, &world.wgsl, MANY) {
        println!("{name:<34} at least {least:>5}, seen {most:>7.3}");
        assert!(most <= least, "{name}: more roundings than are counted");
        assert!(most >= least / 12.0, "{name}: counts too many");
    }
}

/// What need not be noticed: without it the other terms of its sum, each at what it has to be at least, still cover the
/// roundings that random operands make: several of the worst of them would have to come together. Of those that have a
/// name `roundings_one_by_one` measures what they count by itself.
const COVERED: &[&str] = &[
    "POSITION_ROUNDINGS",
    "DISC_ROUNDINGS",
    "ROOT_ROUNDINGS",
    "NORMAL_ROUNDINGS",
    "APART_ROUNDINGS",
    "DISTANCE_ROUNDINGS",
    "HIT_ROUNDINGS",
    "a sphere's along_error",
    "a sphere's form_error",
];

#[test]
fn without_a_bound() {
    let gpu = support::open();
    let mut found = faults::running(&gpu);
    found.extend(faults::literal(&gpu));
    for (name, violations) in &found {
        println!("{name:<34} {violations:>8}");
    }
    for (name, violations) in found {
        assert!(
            violations > 0 || COVERED.contains(&name),
            "{name} = 0 is not noticed"
        );
    }
}

/// Scenes in which bytes, edges, ties, shadows, mirrors and textures go wrong without bounds.
const PICTURES: &[&str] = &[
    "gallery/procedural_all",
    "gallery/quadric_chess",
    "gallery/tiles_floor",
    "hard/coincident_tiles",
    "hard/crossing_on_diagonal",
    "hard/edge_frame_31x17",
    "hard/lit_glint_exponents",
    "hard/lit_half_mirrors_wedge",
    "hard/lit_lamp_at_hit",
    "hard/lit_lamp_over_floor",
    "hard/lit_panes_coplanar",
    "hard/lit_projector_tied",
    "hard/lit_shadow_tangent",
    "hard/lit_spot_45",
    "hard/pplane_2_floor_tie",
    "hard/sphere_by_a_hair",
    "hard/sphere_tiny_far",
    "hard/tangent_rays",
    "hard/tied_lines",
    "lit/kaleidoscope",
    "lit/magic_lantern",
    "lit/mirror_floor",
    "lit/texture_repeated",
    "lit/tiles_xdir",
];

#[test]
fn whole_pictures() {
    let gpu = support::open();
    let (mut with, mut without, mut noticed) = (Count::default(), Count::default(), 0);
    for name in PICTURES {
        let mut scene = common::read(&common::scenes().join(name).with_extension("txt"));
        let [width, height] = scene.camera.pixeldim;
        if width * height > 20_000 {
            scene.camera.pixeldim = [160.min(width), 120.min(height)];
        }
        let (rgb, _) = common::picture(&scene, &common::on(Backend::Cpu));
        let settings = common::on(Backend::Gpu);
        let count = |fault| pictures::count(&gpu, &scene, &settings, fault, &rgb);
        let (right, bare) = (count(Fault::Right), count(Fault::NoBounds));
        println!("{name:<28} {right:?}\n{:<28} {bare:?}", "  without bounds");
        assert_eq!(right.wrong, 0, "{name}: certain, and wrong");
        noticed += usize::from(bare.wrong > 0);
        with += right;
        without += bare;
    }
    println!("{with:?}, without bounds {without:?} in {noticed} pictures");
    assert!(4 * with.sure > 3 * with.pixels, "little is certain");
    assert!(without.wrong > 100 && 2 * noticed > PICTURES.len());
}

/// The picture of a hard scene with a fault or without.
fn of_hard(gpu: &Gpu, name: &str, fault: Fault) -> Count {
    let path = common::scenes().join("hard").join(name);
    let scene = common::read(&path.with_extension("txt"));
    let (rgb, _) = common::picture(&scene, &common::on(Backend::Cpu));
    pictures::count(gpu, &scene, &common::on(Backend::Gpu), fault, &rgb)
}

/// Scenes that were left to the CPU, wholly or for the most part, before their bounds were derived as they are; and how
/// many pixels in a hundred may be in doubt.
const MOSTLY_SURE: &[(&str, usize)] = &[
    ("lit_glint_exponents", 8),
    ("lit_half_mirrors_wedge", 3),
    ("lit_lamp_over_floor", 2),
    ("viewpoint_far_aside", 2),
];

#[test]
fn little_is_left_in_doubt() {
    let gpu = support::open();
    for (name, most) in MOSTLY_SURE {
        let count = of_hard(&gpu, name, Fault::Right);
        println!("{name}: {count:?}");
        assert_eq!(count.wrong, 0, "{name}");
        assert!(
            100 * (count.pixels - count.sure) <= most * count.pixels,
            "{name}: {count:?}"
        );
    }
}

#[test]
fn tables_decide_what_runs_along_columns_and_rows() {
    let gpu = support::open();
    // Every pixel is on the corner of a tile, and the middle one on a byte's border.
    let with = of_hard(&gpu, "tile_edges_wall", Fault::Right);
    let without = of_hard(&gpu, "tile_edges_wall", Fault::NoTables);
    assert_eq!((with.wrong, without.wrong), (0, 0));
    assert!(with.sure + 1 >= with.pixels, "{with:?}");
    assert_eq!(without.sure, 0);
    for name in ["tied_lines", "lit_tied_lines"] {
        let with = of_hard(&gpu, name, Fault::Right);
        let without = of_hard(&gpu, name, Fault::NoTables);
        println!("{name}: {with:?}, without tables {without:?}");
        assert_eq!((with.wrong, without.wrong), (0, 0));
        assert!(2 * (with.pixels - with.sure) < without.pixels - without.sure);
    }
}

#[test]
fn wrong_tables_are_noticed() {
    let gpu = support::open();
    // Rows of tied pixels that tables alone decide. (In row 4 the floor meets the wall, and every pixel is doubtful.)
    for row in [0, 2, 3] {
        let count = of_hard(&gpu, "tied_lines", Fault::Entry(row));
        assert!(count.wrong > 0, "row {row}: {count:?}");
    }
    let count = of_hard(&gpu, "lit_tied_lines", Fault::ForAllRays);
    assert!(count.wrong > 0, "{count:?}");
}

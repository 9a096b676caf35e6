//! The error bounds of the shaders, on the GPU: what they bound is within them, they are no larger than they need to be, and
//! without them pixels that are called certain are wrong. Without an adapter these tests fail.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the tables, with --nocapture")]

#[path = "../common/mod.rs"]
mod common;
mod faults;
mod pictures;
mod primary;
mod support;
mod surfaces;
mod world;

use primary::Picture;
use support::Seen;
use world::{Beams, World};

/// Operands for each running bound.
const MANY: usize = 1 << 18;

#[test]
fn rays_from_anywhere() {
    let gpu = support::open();
    let world = World::many();
    println!("{}", gpu.name);
    let seen = [
        world::planes(
            &gpu,
            &world,
            &world.wgsl,
            Beams::Exact,
            MANY,
            "plane_hits_from, exact ray",
        ),
        world::planes(
            &gpu,
            &world,
            &world.wgsl,
            Beams::Off,
            MANY,
            "plane_hits_from, ray is off",
        ),
    ];
    let [a, b] = world::spheres(
        &gpu,
        &world,
        &world.wgsl,
        Beams::Exact,
        MANY,
        ["sphere_hits_from, exact ray", "sphere_met, exact ray"],
    );
    let [c, d] = world::spheres(
        &gpu,
        &world,
        &world.wgsl,
        Beams::Off,
        MANY,
        ["sphere_hits_from, ray is off", "sphere_met, ray is off"],
    );
    for seen in seen.iter().chain([&a, &b, &c, &d]) {
        seen.judge(20_000, 0.02);
    }
}

#[test]
fn primary_rays() {
    let gpu = support::open();
    let mut camera = [
        "camera_getdir w",
        "LENGTH_ERROR",
        "DIR_ERROR",
        "VALUE_ERROR",
    ]
    .map(Seen::new);
    let mut planes = ["plane_hits", "rectangle_hits"].map(Seen::new);
    let mut spheres = ["sphere_hits", "sphere_normal"].map(Seen::new);
    for picture in Picture::all() {
        let wgsl = &picture.world.wgsl;
        picture.camera(&gpu, wgsl, MANY / 2, &mut camera);
        picture.planes(&gpu, wgsl, MANY / 2, &mut planes);
        picture.spheres(&gpu, wgsl, MANY / 2, &mut spheres);
    }
    for seen in camera.iter().chain(&planes).chain(&spheres) {
        seen.judge(20_000, 0.02);
    }
}

#[test]
fn at_a_hit_point() {
    let gpu = support::open();
    let world = World::many();
    let wgsl = &world.wgsl;
    let mut seen = Vec::from(surfaces::tiles(&gpu, &world, wgsl, MANY));
    seen.extend(
        surfaces::blocks(&gpu, &world, wgsl, MANY)
            .into_iter()
            .flatten(),
    );
    seen.extend(surfaces::wheel(&gpu, wgsl, MANY));
    seen.extend(surfaces::glint(&gpu, wgsl, MANY));
    for seen in seen {
        seen.judge(20_000, 0.02);
    }
}

#[test]
fn without_a_bound() {
    let gpu = support::open();
    let mut found = faults::running(&gpu);
    found.extend(faults::literal(&gpu));
    for (name, violations) in &found {
        println!("{name:<34} {violations:>8}");
    }
}

#[test]
fn whole_pictures_without_bounds() {
    let gpu = support::open();
    for path in common::good_scenes() {
        let start = std::time::Instant::now();
        let mut scene = common::read(&path);
        let [w, h] = scene.camera.pixeldim;
        if w * h > 20_000 {
            scene.camera.pixeldim = [160.min(w), 120.min(h)];
        }
        if path.to_str().unwrap().contains("half_mirrors_three") {
            continue;
        }
        let (rgb, _) = common::picture(&scene, &common::on(plumb::render::Backend::Cpu));
        let settings = common::on(plumb::render::Backend::Gpu);
        let with = pictures::count(&gpu, &scene, &settings, true, &rgb);
        let without = pictures::count(&gpu, &scene, &settings, false, &rgb);
        println!(
            "{:<30} {:?} {:?} {:.2}",
            path.file_stem().unwrap().display(),
            with.map(|c| (c.pixels, c.sure, c.wrong)),
            without.map(|c| (c.sure, c.wrong)),
            start.elapsed().as_secs_f64()
        );
    }
}

//! The error bounds of the shaders, on the GPU: what they bound is within them, they are no larger than they need to be, and
//! without them pixels that are called certain are wrong. Without an adapter these tests fail.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the tables, with --nocapture")]

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
        world::planes(&gpu, &world, &world.wgsl, Beams::Exact, MANY, "plane_hits_from, exact ray"),
        world::planes(&gpu, &world, &world.wgsl, Beams::Off, MANY, "plane_hits_from, ray is off"),
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
    let mut camera = ["camera_getdir w", "LENGTH_ERROR", "DIR_ERROR", "VALUE_ERROR"].map(Seen::new);
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
    let mut seen = vec![surfaces::tiles(&gpu, &world, wgsl, MANY)];
    seen.extend(surfaces::blocks(&gpu, &world, wgsl, MANY));
    seen.extend(surfaces::wheel(&gpu, wgsl, MANY));
    seen.extend(surfaces::glint(&gpu, wgsl, MANY));
    for seen in seen {
        seen.judge(20_000, 0.02);
    }
}

//! The GPU's f32 against the CPU on every scene of ours.
//!
//! Pixels that f64 itself cannot decide (an exact tie, or nearly one: found with error bounds) are counted apart. Of
//! the others at least 99.95 % have to be the same. Scenes made so that f32 must fail are named here, with how much
//! they may.

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::Limits;
use plumb::frame::DecidedBy;
use plumb::jitter::Sampling;
use plumb::prepare::ViewParameters;
use plumb::render::{Backend, Precision, Settings, render};

use crate::common;

/// Hard cases whose margins lie below what f32 resolves, with the share of sure pixels that may differ, in per cent.
const BEYOND_F32: &[(&str, f64)] = &[
    // Tile edges run through rows of pixels: exact ties, moved by the 10⁻¹⁷ that 0.001 and 10¹⁶ differ from their
    // doubles.
    ("light_years", 1.0),
    // Shares of a light that are below what f32 can hold.
    ("lit_faint_panes", 0.3),
    // A quadric and a plane in one place: which is nearer is a rounding.
    ("lit_flat_quadrics_first", 25.0),
    // The height of a lamp 10⁻⁶ above a floor, as a difference of positions.
    ("lit_lamp_over_floor", 0.6),
    // All light passes one picture within 10⁻⁸ of the corner of four texels.
    ("lit_projector_grazing", 48.0),
    ("millimetres", 1.0),
    // A screen 10⁻⁶ high before a grazing plane: rows whose values miss a byte's border by 10⁻⁷.
    ("plane_grazing_extreme", 1.5),
    // Planes 5·10⁻³²⁴ apart.
    ("plane_z_around_zero", 100.0),
    // Four rays that hit by 5·10⁻¹³ of the radius.
    ("sphere_tiny_far", 0.2),
    // Tiles at 10⁵ units, smaller than a pixel: f32's step there is a hundredth of a unit.
    ("tiles_far_unresolved", 10.0),
];

/// Whether f64 with error bounds is sure of a pixel's bytes.
fn is_sure(exact_tracer: &ExactTracer<'_>, x: u32, y: u32) -> bool {
    let decided = exact_tracer.trace(&Limits::default(), Sampling::Once, x, y);
    decided.is_ok_and(|decided| decided.by == DecidedBy::Bounded)
}

/// Scenes that need more rays than a sample may have: both tracers have to say so.
const REFUSED: &[&str] = &["lit_half_mirrors_three"];

struct Row {
    name: String,
    pixels: usize,
    unsure: usize,
    differ: usize,
    worst: u8,
}

fn measure(path: &std::path::Path) -> Row {
    let scene = common::read(path);
    let [width, height] = scene.camera.pixeldim;
    let fast = Settings {
        precision: Precision::Fast,
        ..common::on(Backend::Gpu)
    };
    let (gpu, report) = common::picture(&scene, &fast);
    assert_eq!(report.backend, Backend::Gpu);
    let (cpu, _) = common::picture(&scene, &common::on(Backend::Cpu));
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let mut row = Row {
        name: path.file_stem().unwrap().display().to_string(),
        pixels: gpu.len() / 3,
        unsure: 0,
        differ: 0,
        worst: 0,
    };
    assert_eq!(gpu.len(), 3 * width as usize * height as usize);
    for (i, (g, c)) in gpu.chunks_exact(3).zip(cpu.chunks_exact(3)).enumerate() {
        // Doubt is looked for where the pictures differ; elsewhere it changes nothing.
        if g == c {
            continue;
        }
        let (x, y) = (i as u32 % width, height - 1 - i as u32 / width);
        if !is_sure(&exact_tracer, x, y) {
            row.unsure += 1;
        } else {
            row.differ += 1;
            row.worst = row
                .worst
                .max(g.iter().zip(c).map(|(a, b)| a.abs_diff(*b)).max().unwrap());
        }
    }
    row
}

#[test]
fn f32_agrees_with_f64() {
    let mut failures = Vec::new();
    let (mut pixels, mut differ) = (0, 0);
    println!(
        "{:28} {:>8} {:>8} {:>8} {:>9} {:>6}",
        "scene", "pixels", "unsure", "differ", "per cent", "worst"
    );
    for path in common::good_scenes() {
        if REFUSED
            .iter()
            .any(|name| path.file_stem().is_some_and(|stem| stem == *name))
        {
            for backend in [Backend::Gpu, Backend::Cpu] {
                let error = render(&common::read(&path), &common::on(backend), &mut |_| Ok(()))
                    .unwrap_err();
                assert!(
                    error.to_string().contains("more than 65536 rays"),
                    "{error}"
                );
            }
            continue;
        }
        let row = measure(&path);
        let percent = 100.0 * row.differ as f64 / row.pixels as f64;
        println!(
            "{:28} {:8} {:8} {:8} {percent:9.4} {:6}",
            row.name, row.pixels, row.unsure, row.differ, row.worst
        );
        pixels += row.pixels;
        differ += row.differ;
        let allowed = BEYOND_F32
            .iter()
            .find(|(name, _)| *name == row.name)
            .map_or(0.05, |(_, percent)| *percent);
        // One pixel of a small picture is no share.
        if percent > allowed && row.differ > 1 {
            failures.push(format!(
                "{}: {percent:.3} % of {} pixels, {allowed} % allowed",
                row.name, row.pixels
            ));
        }
    }
    let percent = 100.0 * differ as f64 / pixels as f64;
    println!("all: {differ} of {pixels} differ, {percent:.5} %");
    assert!(percent < 0.01, "{percent} % differ over all scenes");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_bounds_are_sure_of_nearly_every_pixel() {
    let scene = common::read(&common::scenes().join("gallery/showcase.txt"));
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let [width, height] = scene.camera.pixeldim;
    let mut unsure = 0;
    for y in 0..height {
        for x in 0..width {
            unsure += usize::from(!is_sure(&exact_tracer, x, y));
        }
    }
    // A bound that always answers "undecided" would make the comparison above empty.
    assert!(
        unsure * 200 < (width * height) as usize,
        "{unsure} pixels unsure"
    );
}

//! Every scene of ours against the tests' own oracle: 0 differing bytes, on every backend that is certified.
//!
//! Large pictures are made smaller, everything else is kept; `PLUMB_CERTIFY_FULL=1` leaves them as they are (5
//! minutes).

use std::path::{Path, PathBuf};
use std::time::Instant;

use plumb::render::{Backend, SamplePattern, Settings};
use plumb::scene::Scene;

use crate::common;
use crate::doubles::{with_doubles, with_lanes};
use crate::oracle::{self, Answer, Failure, Fault, Rules, differences, picture, pixels_of};

/// Scenes that need more rays than a sample may have, unless paths are as short as this.
const MANY_RAYS: &[(&str, f64)] = &[("lit_half_mirrors_three", 7.0)];

/// Without being asked for full sizes, the GPU gets one scene in so many, as compiling its shader takes longer than all
/// else: `tests/gpu/drivers.rs` renders the others.
const ONE_ON_GPU: u32 = 2;

/// The same of the GPU's f64.
const ONE_IN_F64: u32 = 8;

/// Pixels of a picture that is not made smaller.
const SMALL: u32 = 8_000;

fn name(path: &Path) -> String {
    path.file_stem().unwrap().display().to_string()
}

fn hard(name: &str) -> PathBuf {
    common::scenes()
        .join("hard")
        .join(name)
        .with_extension("txt")
}

/// What a scene is rendered with by default; those that must stop early do.
fn settings_of(path: &Path, backend: Backend) -> Settings {
    let mut settings = common::on(backend);
    if let Some((_, path)) = MANY_RAYS.iter().find(|(scene, _)| *scene == name(path)) {
        settings.limits.max_path = *path;
    }
    settings
}

/// Makes a picture of more than `most` pixels smaller, in the same proportion.
fn shrink(scene: &mut Scene, most: u32) {
    let [width, height] = scene.camera.pixeldim;
    if width * height <= most {
        return;
    }
    scene.camera.pixeldim = if height < 10 {
        [most / height, height]
    } else {
        let factor = (f64::from(most) / f64::from(width * height)).sqrt();
        [width, height].map(|n| (f64::from(n) * factor) as u32)
    };
}

/// Complaints about a picture, and about what the GPU's f64 makes of it if that is asked for: pixels that differ,
/// pixels that the oracle does not decide.
fn complaints(scene: &Scene, answer: &Answer, settings: &Settings, in_f64: bool) -> Vec<String> {
    let (rgb, report) = common::picture(scene, settings);
    oracle::rendered_as_asked(&report, settings.backend);
    let mut found: Vec<String> = differences(scene, answer, &rgb).collect();
    if in_f64 && let Some(rgb) = with_doubles(scene, settings, &rgb) {
        found.extend(differences(scene, answer, &rgb));
    }
    if settings.backend == Backend::Cpu {
        for (by, rgb) in with_lanes(scene, settings, &rgb) {
            let all = differences(scene, answer, &rgb);
            found.extend(all.map(|complaint| format!("{by}: {complaint}")));
        }
    }
    let undecided = answer.pixels.iter().filter(|pixel| pixel.is_err()).count();
    if undecided > 0 {
        found.push(format!("{undecided} pixels are not decided by the oracle"));
    }
    found
}

#[test]
fn every_scene_is_certified() {
    let full = std::env::var_os("PLUMB_CERTIFY_FULL").is_some();
    let start = Instant::now();
    let (mut scenes, mut pixels, mut effort) = (0_u32, 0, oracle::real::Effort::default());
    let mut failures = Vec::new();
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        if !full {
            let most = if path.parent().unwrap().ends_with("hard") {
                SMALL
            } else {
                SMALL / 4
            };
            shrink(&mut scene, most);
        }
        let rules = Rules::from(&settings_of(&path, Backend::Cpu));
        let answer = picture(&scene, &rules);
        scenes += 1;
        pixels += answer.pixels.len();
        effort += answer.effort;
        for &backend in oracle::CERTIFIED {
            if backend == Backend::Gpu && !full && scenes % ONE_ON_GPU != 0 {
                continue;
            }
            // Compiling that shader takes longer than all else.
            let in_f64 = backend == Backend::Gpu && (full || scenes % ONE_IN_F64 == 0);
            let found = complaints(&scene, &answer, &settings_of(&path, backend), in_f64);
            for complaint in found.iter().take(8) {
                failures.push(format!("{} on {backend:?}: {complaint}", name(&path)));
            }
            if found.len() > 8 {
                failures.push(format!("{}: {} in all", name(&path), found.len()));
            }
        }
    }
    println!(
        "{scenes} scenes, {pixels} pixels, {:.1} s, {effort:?}",
        start.elapsed().as_secs_f64()
    );
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // Without ties nothing hard was tried.
    assert!(effort.ties > 1_000, "{effort:?}");
}

#[test]
fn the_oracle_gives_the_stated_pixels() {
    let mut count = 0;
    for path in common::good_scenes() {
        let text = std::fs::read_to_string(&path).unwrap();
        let stated: Vec<[u32; 5]> = text
            .lines()
            .filter_map(|line| line.strip_prefix("#="))
            .map(|line| {
                let numbers = line.split_whitespace().map(|n| n.parse().unwrap());
                numbers.collect::<Vec<u32>>().try_into().unwrap()
            })
            .collect();
        let scene = common::read(&path);
        let places: Vec<[u32; 2]> = stated.iter().map(|[x, y, ..]| [*x, *y]).collect();
        let answer = pixels_of(&scene, &Rules::default(), &places);
        for ([x, y, r, g, b], found) in stated.into_iter().zip(answer.pixels) {
            let want = [r, g, b].map(|byte| u8::try_from(byte).unwrap());
            assert_eq!(found, Ok(want), "{}: pixel ({x}, {y})", name(&path));
            count += 1;
        }
    }
    println!("{count} stated pixels");
    assert!(count > 400, "only {count}");
}

#[test]
fn tolerances_and_samples_are_certified() {
    let gallery = |name: &str| common::scenes().join(name).with_extension("txt");
    let cases = [
        (hard("plane_z_at_tolerance"), 0.01, 1, SamplePattern::Hash),
        (
            hard("plane_z_at_tolerance"),
            0.010000000000000002,
            1,
            SamplePattern::Hash,
        ),
        (
            hard("plane_z_within_tolerance"),
            0.01,
            1,
            SamplePattern::Hash,
        ),
        (hard("plane_z_around_zero"), 1e-9, 1, SamplePattern::Hash),
        (hard("lit_mirror_shows_screen"), 0.5, 1, SamplePattern::Hash),
        (hard("edge_frame_31x17"), 0.0, 3, SamplePattern::Course),
        (hard("lit_painting_under_lamp"), 0.0, 4, SamplePattern::Hash),
        (hard("size_1x37"), 0.0, 2, SamplePattern::Hash),
        (hard("tile_edges"), 0.0, 16, SamplePattern::Course),
        (gallery("lit/samples"), 0.01, 4, SamplePattern::Hash),
        (
            gallery("lit/mirror_and_glass"),
            0.0,
            2,
            SamplePattern::Course,
        ),
        (
            gallery("gallery/procedural_all"),
            -8.0,
            4,
            SamplePattern::Hash,
        ),
    ];
    for (path, tolerance, samples, jitter) in cases {
        let mut scene = common::read(&path);
        shrink(&mut scene, 500);
        for &backend in oracle::CERTIFIED {
            let settings = Settings {
                screen_tolerance: tolerance,
                samples,
                jitter,
                ..common::on(backend)
            };
            let answer = picture(&scene, &Rules::from(&settings));
            let found = complaints(&scene, &answer, &settings, false);
            assert!(
                found.is_empty(),
                "{}, {samples} samples, τ {tolerance}: {}",
                name(&path),
                found.join("\n")
            );
        }
    }
}

#[test]
fn the_first_evaluation_decides_nothing_wrongly() {
    let wide = Rules {
        first_bits: 1_024,
        ..Rules::default()
    };
    for path in common::good_scenes() {
        let mut scene = common::read(&path);
        shrink(&mut scene, 130);
        let rules = Rules::from(&settings_of(&path, Backend::Cpu));
        let wide = Rules {
            max_path: rules.max_path,
            ..wide.clone()
        };
        let narrow = picture(&scene, &rules);
        let wide = picture(&scene, &wide);
        assert_eq!(narrow.pixels, wide.pixels, "{}", name(&path));
    }
}

#[test]
fn too_many_rays_are_noticed() {
    let mut scene = common::read(&hard("lit_half_mirrors_three"));
    shrink(&mut scene, 12);
    let answer = picture(&scene, &Rules::default());
    assert!(answer.pixels.contains(&Err(Failure::TooManyRays)));
    let settings = common::on(Backend::Cpu);
    let error = plumb::render::render(&scene, &settings, &mut |_| Ok(())).unwrap_err();
    assert!(
        error.to_string().contains("more than 65536 rays"),
        "{error}"
    );
}

#[test]
fn one_wrong_byte_is_noticed() {
    let scene = common::read(&hard("lit_spot_45"));
    let answer = picture(&scene, &Rules::default());
    let (mut rgb, _) = common::picture(&scene, &common::on(Backend::Cpu));
    assert_eq!(differences(&scene, &answer, &rgb).count(), 0);
    for at in [0, 100, rgb.len() - 1] {
        rgb[at] ^= 1;
        assert_eq!(differences(&scene, &answer, &rgb).count(), 1, "byte {at}");
        rgb[at] ^= 1;
    }
}

/// For every rule that could be off by an equality: a scene of ours that shows it.
#[test]
fn wrong_rules_are_noticed() {
    let right = Rules::default();
    let broken = |fault| Rules {
        fault: Some(fault),
        ..right.clone()
    };
    let cases = [
        ("tangent_rays", broken(Fault::TangentHits)),
        ("lit_shadow_tangent", broken(Fault::TangentHits)),
        ("coincident_walls", broken(Fault::LaterOfEquals)),
        ("spheres_equal", broken(Fault::LaterOfEquals)),
        ("lit_panes_coplanar", broken(Fault::LaterOfEquals)),
        ("lit_spot_45", broken(Fault::ConeEdgeLit)),
        ("lit_spot_180_slanted", broken(Fault::ConeEdgeLit)),
        ("lit_lamp_on_ball", broken(Fault::BlocksAtLamp)),
        ("lit_mirrors_path_exactly_20", broken(Fault::PathEnds)),
        ("lit_painting_under_lamp", broken(Fault::OpenRectangle)),
        ("lit_shadow_edges", broken(Fault::OpenRectangle)),
        ("lit_projector_tied", broken(Fault::OpenRectangle)),
        ("lit_projector_tied", broken(Fault::PictureBehind)),
        ("lit_projector_grazing", broken(Fault::GlintWithoutPicture)),
        ("lit_glint_grazing", broken(Fault::Rounds)),
        (
            "plane_z_at_tolerance",
            Rules {
                tolerance: 0.01,
                ..right.clone()
            },
        ),
        (
            "plane_z_zero",
            Rules {
                tolerance: -5e-324,
                ..right.clone()
            },
        ),
    ];
    for (scene, wrong) in cases {
        let scene_of = common::read(&hard(scene));
        let (rgb, _) = common::picture(&scene_of, &common::on(Backend::Cpu));
        let found = |rules| differences(&scene_of, &picture(&scene_of, rules), &rgb).count();
        assert_eq!(found(&right), 0, "{scene}");
        assert!(
            found(&wrong) > 0,
            "{scene}: {:?} is not noticed",
            wrong.fault
        );
    }
}

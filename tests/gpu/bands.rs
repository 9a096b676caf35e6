//! How a picture is cut into pieces changes no byte of it: bands of different heights, rows rendered alone, one thread
//! or many, the CPU or the GPU. Needs an adapter, and fails without one.

use std::ops::Range;

use plumb::certify::DecidedBy;
use plumb::gpu::pipeline::Pipeline;
use plumb::gpu::{adapters, bands};
use plumb::render::{
    Backend, Band, Precision, Report, SamplePattern, Settings, render, render_with,
};
use plumb::scene::{Camera, Scene};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::form::Pixels;
use plumb::shader::pack::Packed;

use crate::common;

/// Scenes of different kinds, some of whose pixels are hard.
const SCENES: &[&str] = &[
    "notes/walls.txt",
    "gallery/spheres_over_tiles.txt",
    "gallery/procedural_all.txt",
    "hard/tied_lines.txt",
    "lit/shadows_balls.txt",
    "lit/mirror_and_glass.txt",
];

fn scene(name: &str) -> Scene {
    let mut scene = common::read(&common::scenes().join(name));
    scene.camera.pixeldim = [93, 71];
    scene
}

fn bands(scene: &Scene, settings: &Settings) -> (Vec<Band>, Report) {
    let mut bands = Vec::new();
    let report = render_with(scene, settings, common::devices(), &mut |band| {
        bands.push(band.clone());
        Ok(())
    });
    (bands, report.unwrap_or_else(|error| panic!("{error}")))
}

fn rgb(bands: &[Band]) -> Vec<u8> {
    bands.iter().flat_map(|band| band.rgb.clone()).collect()
}

fn settings(backend: Backend, band_rows: Option<u32>) -> Settings {
    Settings {
        backend,
        band_rows,
        ..Settings::default()
    }
}

#[test]
fn bands_have_the_height_that_was_asked_for() {
    let scene = scene("notes/walls.txt");
    for backend in [Backend::Gpu, Backend::Cpu] {
        for height in [1, 7, 71, 500] {
            let (bands, report) = bands(&scene, &settings(backend, Some(height)));
            let mut top = 71;
            for band in &bands {
                assert_eq!(band.rows.end, top);
                assert_eq!(band.rows.len() as u32, height.min(top));
                top = band.rows.start;
            }
            assert_eq!(top, 0);
            assert_eq!(report.bands as usize, bands.len());
        }
    }
}

/// Certified, a picture is the same whoever renders it.
#[test]
fn the_gpu_and_the_cpu_render_the_same() {
    for name in SCENES {
        let scene = scene(name);
        for (samples, jitter) in [
            (1, SamplePattern::Hash),
            (3, SamplePattern::Hash),
            (3, SamplePattern::Course),
        ] {
            let on = |backend| Settings {
                samples,
                jitter,
                ..settings(backend, None)
            };
            let (gpu, report) = bands(&scene, &on(Backend::Gpu));
            assert_eq!(report.revoked, None, "{name}, {samples} samples");
            let (cpu, _) = bands(&scene, &on(Backend::Cpu));
            assert!(
                rgb(&gpu) == rgb(&cpu),
                "{name}, {samples} samples, {jitter:?}"
            );
        }
    }
}

/// Nor does it matter in which pieces, or on how many threads.
#[test]
fn pieces_are_pieces_of_the_whole() {
    for name in SCENES {
        let scene = scene(name);
        for (samples, jitter) in [
            (1, SamplePattern::Hash),
            (3, SamplePattern::Hash),
            (3, SamplePattern::Course),
        ] {
            for backend in [Backend::Gpu, Backend::Cpu] {
                let mut whole = None;
                for (band_rows, threads) in [
                    (None, None),
                    (Some(1), Some(1)),
                    (Some(16), Some(3)),
                    (Some(29), None),
                ] {
                    let all = Settings {
                        threads,
                        samples,
                        jitter,
                        ..settings(backend, band_rows)
                    };
                    let part = |rows: Range<u32>| Settings {
                        rows: Some(rows),
                        ..all.clone()
                    };
                    let picture = rgb(&bands(&scene, &all).0);
                    let whole = whole.get_or_insert_with(|| picture.clone());
                    let what = format!("{name}, {samples} samples, {backend:?}, {band_rows:?}");
                    assert!(picture == *whole, "{what}");
                    let pieces: Vec<u8> = [40..71, 39..40, 0..39]
                        .into_iter()
                        .flat_map(|rows| rgb(&bands(&scene, &part(rows)).0))
                        .collect();
                    assert!(pieces == *whole, "{what}: rows alone");
                }
            }
        }
    }
}

/// Raw f32 depends on no band either.
#[test]
fn fast_pictures_have_no_seams() {
    let scene = scene("lit/mirror_and_glass.txt");
    let fast = |band_rows| Settings {
        precision: Precision::Fast,
        ..settings(Backend::Gpu, band_rows)
    };
    let whole = rgb(&bands(&scene, &fast(None)).0);
    for height in [1, 13, 70] {
        assert!(rgb(&bands(&scene, &fast(Some(height))).0) == whole);
    }
}

/// The values of a certified picture are computed on the CPU; the GPU alone cannot have them.
#[test]
fn certified_values_are_the_cpus() {
    let scene = scene("notes/walls.txt");
    let values = |backend, precision| Settings {
        values: true,
        precision,
        ..settings(backend, None)
    };
    let (auto, report) = bands(&scene, &values(Backend::Auto, Precision::Certified));
    assert_eq!(report.backend, Backend::Cpu);
    assert!(report.fallback.unwrap().contains("--precision fast"));
    assert!(auto[0].values.is_some());
    let (fast, report) = bands(&scene, &values(Backend::Gpu, Precision::Fast));
    assert_eq!(report.backend, Backend::Gpu);
    assert!(fast[0].values.is_some());
    let refused = render(
        &scene,
        &values(Backend::Gpu, Precision::Certified),
        &mut |_| Ok(()),
    );
    let error = refused.unwrap_err().to_string();
    assert!(error.contains("--precision fast"), "{error}");
}

/// Every pixel is counted once, and its verdict is what it was counted for.
#[test]
fn verdicts_and_counts_agree() {
    for name in SCENES {
        let scene = scene(name);
        for backend in [Backend::Gpu, Backend::Cpu] {
            let wanted = Settings {
                verdicts: true,
                ..settings(backend, Some(10))
            };
            let (bands, report) = bands(&scene, &wanted);
            let verdicts: Vec<DecidedBy> = bands
                .iter()
                .flat_map(|band| band.verdicts.clone().unwrap())
                .collect();
            assert_eq!(verdicts.len(), 93 * 71);
            assert_eq!(report.pixels, 93 * 71);
            for by in DecidedBy::ALL {
                let count = verdicts.iter().filter(|verdict| **verdict == by).count();
                assert_eq!(report.decided.count(by), count as u64, "{name}: {by:?}");
            }
            let by_device = [DecidedBy::Gpu, DecidedBy::Double];
            let by_gpu: u64 = by_device.iter().map(|by| report.decided.count(*by)).sum();
            match report.backend {
                Backend::Gpu => assert_eq!(report.refined, 93 * 71 - by_gpu),
                _ => assert_eq!((report.refined, by_gpu), (0, 0)),
            }
        }
    }
}

/// What a device makes of a scene in one form, band by band: bytes, and of doubtful pixels the place and what is known.
fn stored(scene: &Scene, settings: &Settings, for_a_file: bool) -> Vec<(Vec<u8>, Vec<u32>, usize)> {
    let gpu = adapters::shared(None).unwrap_or_else(|error| panic!("{error}"));
    let packed = Packed::new(scene, settings);
    let mut features = FeatureSet::new(&packed, settings, gpu.lanes);
    if for_a_file {
        features = features.for_a_file(false);
    }
    let wgsl = compose(&packed, &features, Entry::Picture);
    let pipeline = Pipeline::new(&gpu, &packed, &features, &wgsl).unwrap();
    let expected = [Pixels::Words, Pixels::Packed][usize::from(for_a_file)];
    assert_eq!(pipeline.form.pixels, expected);
    let [width, height] = scene.camera.pixeldim;
    let jitter = settings.sampling(width, height);
    let frame = bands::Frame {
        width,
        rows: 0..height,
        tests: packed.tests(),
        jitter: &jitter,
        band_rows: Some(17),
        // So short that rectangles are cut by columns.
        dispatch_seconds: 1e-4,
        double: None,
        canvas: None,
    };
    let mut stored = Vec::new();
    common::bands_of(&gpu, &pipeline, &frame, |rendered| {
        let parts = rendered.doubtful.iter();
        let parts = parts.filter_map(|place| rendered.partials.get(*place));
        let known = parts.map(|part| part.samples() as usize).sum();
        stored.push((rendered.band.rgb, rendered.doubtful, known));
    });
    stored
}

/// Packed for a file or in words for a canvas, with a pixel an invocation or four, records behind them or none,
/// whatever the width: the same bytes, and the same of them in doubt.
#[test]
fn both_forms_of_pixels_hold_the_same() {
    let kinds = [
        "notes/walls.txt",
        "gallery/procedural_all.txt",
        "lit/mirror_and_glass.txt",
    ];
    for name in kinds {
        for pixeldim in [[93, 31], [1, 40], [333, 5]] {
            let scene = Scene {
                camera: Camera {
                    pixeldim,
                    ..scene(name).camera
                },
                ..scene(name)
            };
            for (samples, jitter) in [(1, SamplePattern::Hash), (3, SamplePattern::Course)] {
                let settings = Settings {
                    samples,
                    jitter,
                    ..settings(Backend::Gpu, None)
                };
                let [words, packed] = [false, true].map(|packed| stored(&scene, &settings, packed));
                assert!(words == packed, "{name}, {pixeldim:?}, {samples} samples");
            }
        }
    }
}

//! What several tests need: our scenes, and a picture of one.
#![allow(dead_code, reason = "every test uses a part")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

pub(crate) mod drivers;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use glam::DVec3;
use plumb::certify::lanes::doubles::DoubleLanes;
use plumb::certify::lanes::{Lanes, OPEN};
use plumb::cpu::pixel::ExactTracer;
use plumb::frame::{Decided, Part};
use plumb::gpu::bands::{Frame, Rendered, from_the_top, run};
use plumb::gpu::device::Gpu;
use plumb::gpu::pipeline::Pipeline;
use plumb::jitter::Jitter;
use plumb::render::{Backend, Devices, Report, Settings, render_with};
use plumb::scene::{Beam, Light, Scene, load};
use plumb::stopwatch::Stopwatch;

/// The folder `scenes/`.
pub(crate) fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// The scenes of ours that are right, by folder and name.
pub(crate) fn good_scenes() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["notes", "gallery", "known", "hard", "lit"] {
        let Ok(entries) = std::fs::read_dir(scenes().join(folder)) else {
            panic!("no folder scenes/{folder}")
        };
        found.extend(
            entries
                .map(|e| e.unwrap().path())
                .filter(|p| p.extension().is_some_and(|e| e == "txt")),
        );
    }
    found.sort();
    assert!(found.len() > 100, "only {} scenes found", found.len());
    found
}

/// Reads a scene that has to be right.
pub(crate) fn read(path: &Path) -> Scene {
    load(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The devices of all tests of a process that do not test how one is opened.
pub(crate) fn devices() -> &'static Devices {
    static DEVICES: OnceLock<Devices> = OnceLock::new();
    DEVICES.get_or_init(Devices::new)
}

/// Renders a whole picture; top row first, three bytes a pixel.
pub(crate) fn picture(scene: &Scene, settings: &Settings) -> (Vec<u8>, Report) {
    let mut rgb = Vec::new();
    let report = render_with(scene, settings, devices(), &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
    (rgb, report)
}

/// Renders a frame by itself, and hands its bands on from the top.
pub(crate) fn bands_of(
    gpu: &Gpu,
    pipeline: &Pipeline,
    frame: &Frame<'_>,
    mut take: impl FnMut(Rendered),
) {
    let hand_on = &mut |rendered| {
        take(rendered);
        ControlFlow::Continue(())
    };
    let rows = &mut from_the_top(frame.rows.clone());
    let watch = &mut Stopwatch::start();
    run(gpu, pipeline, frame, rows, &|| false, watch, hand_on).unwrap();
}

/// The words of a row that lanes make: bytes where they are sure.
pub(crate) fn row_by_lanes(lanes: &Lanes, jitter: &Jitter, y: u32, words: &mut [u32]) {
    let Some(mut means) = lanes.means() else {
        return lanes.strip([0, y], words);
    };
    let (offsets, at_once) = (jitter.row(y), means.at_once());
    for (k, words) in words.chunks_mut(at_once).enumerate() {
        let first = (k * at_once) as u32;
        lanes.sampled([first, y], offsets.as_deref(), words, &mut means);
    }
}

/// The words of pixels that lanes make in f64, whether f32 is sure of them or not: bytes where they are sure, of
/// several samples of all of them.
pub(crate) fn words_in_f64(
    lanes: &DoubleLanes,
    exact_tracer: &ExactTracer<'_>,
    settings: &Settings,
    places: &[[u32; 2]],
    [width, height]: [u32; 2],
) -> Vec<u32> {
    let mut words = vec![OPEN; places.len()];
    if settings.supersampling().is_none() {
        lanes.pixels(places, &mut words);
        return words;
    }
    let (limits, jitter) = (settings.sample_limits(), settings.sampling(width, height));
    let rows: Vec<_> = (0..height).map(|y| jitter.row(y)).collect();
    let sampling = |[x, y]: [u32; 2]| {
        let row = rows[y as usize].as_deref();
        jitter.pixel(row, width as usize, x as usize)
    };
    for (places, words) in places.chunks(64).zip(words.chunks_mut(64)) {
        let (mut all, mut offsets) = (Vec::new(), Vec::new());
        for at in places {
            for offset in sampling(*at).rounded_offsets(at[0], at[1]) {
                all.push(*at);
                offsets.push(offset);
            }
        }
        let mut brought = vec![None; all.len()];
        lanes.samples(&all, &offsets, &mut brought);
        let brought = brought.chunks(settings.samples as usize);
        for ((at, brought), word) in places.iter().zip(brought).zip(words) {
            if brought.iter().all(Option::is_some) {
                let (sampling, nothing) = (sampling(*at), &Part::NOTHING);
                let mean = exact_tracer.complete(&limits, sampling, *at, nothing, brought);
                if let Some(Decided {
                    bytes: [r, g, b], ..
                }) = mean.unwrap()
                {
                    *word = u32::from_le_bytes([r, g, b, 0]);
                }
            }
        }
    }
    words
}

/// A white light; the only one that tests make of its fields, so that another field is given a value here alone.
pub(crate) fn light(location: DVec3) -> Light {
    Light {
        name: "l".into(),
        location,
        emissivity: DVec3::ONE,
        beam: Beam::Everywhere,
    }
}

/// Settings for one backend.
pub(crate) fn on(backend: Backend) -> Settings {
    Settings {
        backend,
        ..Settings::default()
    }
}

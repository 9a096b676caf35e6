//! Faults that certified rendering has to notice: a device that fails the self-test, bytes that it is sure of and gets
//! wrong. They need an adapter, and fail without one.

mod leaving;
mod seconds;

use std::cell::RefCell;
use std::time::Duration;

use super::device_thread::Line;
use super::*;
use crate::certify::DecidedBy;
use crate::certify::spot::spots;
use crate::certify::trust;
use crate::certify::trust::tests::forget_all;
use crate::gpu::adapters;
use crate::gpu::bands::assembly::tests::tamper_with;
use crate::gpu::bands::partial::tests::{Fault, leave_room_for, spoil_records};
use crate::gpu::bands::{assembly, partial};
use crate::gpu::selftest;
use crate::gpu::selftest::tests::spoil_next;
use crate::scene::load_from;

const WIDTH: u32 = 64;
const HEIGHT: u32 = 48;

/// Verdicts that come with a pixel.
const SURE: u8 = 0;
const DOUBTFUL: u8 = 1;

/// What a device does after a number of bands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    /// It is lost.
    Lost,
    /// It has no memory left.
    Memory,
    /// It does not answer any more.
    Silent,
}

/// What devices do wrong that this thread starts.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct DeviceFault {
    /// How many bands are right, and what comes then.
    after: Option<(u32, Ends)>,
    /// How long they may be silent.
    patience: Option<Duration>,
}

thread_local! {
    static DEVICE_FAULT: RefCell<DeviceFault> = const { RefCell::new(DeviceFault { after: None, patience: None }) };
}

/// What a device of this thread does wrong.
pub(super) fn device_fault() -> DeviceFault {
    DEVICE_FAULT.with_borrow(|fault| *fault)
}

/// How long this thread's devices may be silent, if not as long as usual.
pub(super) fn patience() -> Option<Duration> {
    device_fault().patience
}

/// Whether the fault keeps this band back.
pub(super) fn breaks(fault: &mut DeviceFault) -> bool {
    match &mut fault.after {
        Some((0, _)) => true,
        Some((bands, _)) => {
            *bands -= 1;
            false
        }
        None => false,
    }
}

/// Fails as the fault says, if it came to that.
pub(super) fn fail(fault: &DeviceFault, gpu: &Gpu, line: &Line) -> Result<(), GpuError> {
    let adapter = gpu.name.clone();
    let reason = "of a test".to_owned();
    match fault.after {
        Some((0, Ends::Lost)) => Err(GpuError::Lost { adapter, reason }),
        Some((0, Ends::Memory)) => Err(GpuError::OutOfMemory { adapter, reason }),
        Some((0, Ends::Silent)) => {
            while line.orders.recv().is_ok() {}
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The same work on another thread, with all the faults of this one.
pub(super) fn with_faults<T>(work: impl FnOnce() -> T + Send) -> impl FnOnce() -> T + Send {
    let fault = device_fault();
    let carried = [
        assembly::tests::carry(),
        partial::tests::carry(),
        selftest::tests::carry(),
        trust::tests::carry(),
        Box::new(move || DEVICE_FAULT.set(fault)),
    ];
    move || {
        for carry in carried {
            carry();
        }
        work()
    }
}

/// A wall whose bytes are far from any border but where it changes.
fn scene() -> Scene {
    let text = "camera c { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 }
         material red { ambient 6.037 3.001 1.007 }
         plane wall { material red normal 0 0 1 point 0 0 -3.017 }
         sphere ball { material red center 5.003 3.001 -1.013 radius 1.007 }";
    load_from("scene", text.as_bytes(), std::path::Path::new(".")).unwrap()
}

fn settings(backend: Backend) -> Settings {
    Settings {
        backend,
        band_rows: Some(8),
        ..Settings::default()
    }
}

fn rendered(settings: &Settings) -> (Result<Report, Error>, Vec<Band>) {
    let mut bands = Vec::new();
    let report = render(&scene(), settings, &mut |band| {
        bands.push(band.clone());
        Ok(())
    });
    (report, bands)
}

fn rgb(bands: &[Band]) -> Vec<u8> {
    bands.iter().flat_map(|band| band.rgb.clone()).collect()
}

/// Column and row of a pixel that is checked in the band with these rows.
fn checked(rows: std::ops::Range<u32>) -> [u32; 2] {
    let place = spots(WIDTH, &rows, &[], &[])[0];
    [place % WIDTH, rows.end - 1 - place / WIDTH]
}

#[test]
fn nothing_is_wrong_by_itself() {
    let (report, bands) = rendered(&settings(Backend::Gpu));
    let report = report.unwrap();
    assert_eq!(report.backend, Backend::Gpu);
    assert_eq!((report.bands, report.revoked), (6, None));
    assert!(report.spot_checks >= 6, "at least one a band");
    assert_eq!(report.pixels, u64::from(WIDTH * HEIGHT));
    assert_eq!(rgb(&bands), rgb(&rendered(&settings(Backend::Cpu)).1));
}

#[test]
fn a_wrong_byte_in_the_first_band_makes_the_cpu_render() {
    let right = rgb(&rendered(&settings(Backend::Cpu)).1);
    tamper_with(&[checked(40..48)], SURE);
    let (report, bands) = rendered(&settings(Backend::Gpu));
    tamper_with(&[], SURE);
    let report = report.unwrap();
    assert_eq!(report.backend, Backend::Cpu);
    let revoked = report.revoked.unwrap();
    assert!(revoked.contains("was sure that pixel"), "{revoked}");
    assert!(rgb(&bands) == right);
    assert_eq!(report.decided.count(DecidedBy::Gpu), 0);
    assert_eq!(report.pixels, u64::from(WIDTH * HEIGHT));
}

/// Rows that were handed on and are right are not handed on again.
#[test]
fn a_wrong_byte_later_makes_the_cpu_go_on() {
    let right = rgb(&rendered(&settings(Backend::Cpu)).1);
    tamper_with(&[checked(16..24)], SURE);
    let (report, bands) = rendered(&settings(Backend::Gpu));
    tamper_with(&[], SURE);
    assert!(report.unwrap().revoked.is_some());
    assert!(rgb(&bands) == right);
    let mut top = HEIGHT;
    for band in &bands {
        assert_eq!(band.rows.end, top);
        top = band.rows.start;
    }
    assert_eq!(top, 0);
}

/// A wrong byte that was handed on before another one is noticed: an error, since it cannot be taken back. (That it is
/// found is tested with certainty in `bag`.)
#[test]
fn wrong_bytes_that_were_handed_on_are_found() {
    let [x, y] = checked(40..48);
    tamper_with(&[[(x + 1) % WIDTH, y], checked(16..24)], SURE);
    let (report, bands) = rendered(&settings(Backend::Gpu));
    tamper_with(&[], SURE);
    // Whether they were handed on when it was found depends on who was quicker.
    match report {
        Ok(report) => {
            assert!(report.revoked.is_some());
            assert!(rgb(&bands) == rgb(&rendered(&settings(Backend::Cpu)).1));
        }
        Err(error) => {
            assert!(matches!(error, Error::Revoked(_)), "{error:?}");
            assert!((1..=3).contains(&bands.len()));
        }
    }
}

/// A panic of whoever takes the bands goes on to who asked for the picture.
#[test]
fn nobody_waits_for_ever_for_who_panics() {
    let large = {
        let mut scene = scene();
        scene.camera.pixeldim = [4000, 4000];
        scene
    };
    let ended = std::panic::catch_unwind(|| {
        render(&large, &settings(Backend::Cpu), &mut |_| {
            panic!("of a test")
        })
    });
    assert!(ended.is_err());
}

/// Doubtful pixels are decided on the CPU, few and many, with one sample and with several; and a single one that is not
/// is seen in the picture.
#[test]
fn doubtful_pixels_are_decided_and_none_is_dropped() {
    let all: Vec<[u32; 2]> = (0..WIDTH * HEIGHT)
        .map(|n| [n % WIDTH, n / WIDTH])
        .collect();
    for (samples, jitter) in [
        (1, SamplePattern::Hash),
        (3, SamplePattern::Hash),
        (3, SamplePattern::Course),
    ] {
        for few in [all.as_slice(), &all[70..75], &all[1000..1200]] {
            let on = |backend| Settings {
                samples,
                jitter,
                ..settings(backend)
            };
            let right = rgb(&rendered(&on(Backend::Cpu)).1);
            tamper_with(few, DOUBTFUL);
            let (report, bands) = rendered(&on(Backend::Gpu));
            // The last of these pixels is handed back as if the GPU were sure of it.
            tamper_with(&few[few.len() - 1..], SURE);
            let (_, dropped) = rendered(&Settings {
                precision: Precision::Fast,
                ..on(Backend::Gpu)
            });
            tamper_with(&[], SURE);
            let report = report.unwrap();
            assert_eq!(report.revoked, None);
            // Pixels that the shader itself is not sure of are counted too; some of them f64 may have decided.
            let in_f64 = report.decided.count(DecidedBy::Double);
            assert!(report.refined + in_f64 >= few.len() as u64);
            assert!(rgb(&bands) == right, "{samples} samples, {jitter:?}");
            assert!(rgb(&dropped) != right);
        }
    }
}

/// Without certificates nothing is checked.
#[test]
fn fast_takes_the_bytes_as_they_come() {
    tamper_with(&[checked(40..48)], SURE);
    let fast = Settings {
        precision: Precision::Fast,
        ..settings(Backend::Gpu)
    };
    let report = rendered(&fast).0.unwrap();
    tamper_with(&[], SURE);
    assert_eq!((report.revoked, report.spot_checks), (None, 0));
}

#[test]
fn a_device_that_fails_the_self_test_is_not_trusted() {
    spoil_next(Some(0));
    forget_all(true);
    let (error, _) = rendered(&settings(Backend::Gpu));
    let name = adapters::open(None).unwrap().name;
    // Named, since software is not asked for where the CPU is quicker.
    let auto = Settings {
        adapter: Some(name),
        ..settings(Backend::Auto)
    };
    let (report, bands) = rendered(&auto);
    let fast = Settings {
        precision: Precision::Fast,
        ..settings(Backend::Gpu)
    };
    let (unasked, _) = rendered(&fast);
    spoil_next(None);
    forget_all(false);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("does not compute as WGSL asks"), "{error}");
    let report = report.unwrap();
    assert_eq!(report.backend, Backend::Cpu);
    assert!(report.fallback.unwrap().contains("x + y: "));
    assert!(rgb(&bands) == rgb(&rendered(&settings(Backend::Cpu)).1));
    assert_eq!(unasked.unwrap().backend, Backend::Gpu);
}

/// Mirrors, glass and shadows, some of whose samples are in doubt; and quadrics that mirror, where many are.
const SOME: &str = "lit/mirror_and_glass";
const MANY: &str = "gallery/quadric_chess";

fn small(name: &str) -> Scene {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scene = crate::scene::load(&scenes.join(name).with_extension("txt")).unwrap();
    scene.camera.pixeldim = [93, 71];
    scene
}

fn antialiased(
    name: &str,
    backend: Backend,
    samples: u32,
    jitter: SamplePattern,
    band_rows: u32,
) -> (Result<Report, Error>, Vec<u8>) {
    let wanted = Settings {
        samples,
        jitter,
        band_rows: Some(band_rows),
        ..settings(backend)
    };
    let mut rgb = Vec::new();
    let report = render(&small(name), &wanted, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    });
    (report, rgb)
}

/// Of pixels with doubtful samples the CPU computes those alone; all of them where the list has no room. The bytes are
/// the same.
#[test]
fn only_doubtful_samples_are_computed() {
    for (samples, jitter) in [
        (16, SamplePattern::Hash),
        (40, SamplePattern::Hash),
        (16, SamplePattern::Course),
    ] {
        let (_, right) = antialiased(SOME, Backend::Cpu, samples, jitter, 30);
        let (report, bytes) = antialiased(SOME, Backend::Gpu, samples, jitter, 30);
        let report = report.unwrap();
        assert_eq!((report.backend, &report.revoked), (Backend::Gpu, &None));
        assert!(bytes == right, "{samples} samples, {jitter:?}");
        let computed = |room| {
            leave_room_for(Some(room));
            let (report, bytes) = antialiased(SOME, Backend::Gpu, samples, jitter, 30);
            leave_room_for(None);
            let report = report.unwrap();
            assert_eq!(report.revoked, None);
            assert!(
                bytes == right,
                "{samples} samples, {jitter:?}, room for {room}"
            );
            report
        };
        let (few, one) = (computed(20), computed(1));
        // The same pixels are in doubt, however much room the list has.
        assert_eq!([few.refined, one.refined], [report.refined; 2]);
        let all = report.refined * u64::from(samples);
        println!(
            "{samples} samples: {} of {} pixels, {} samples of them, with room for 20 a dispatch {}, for one {}, all \
            are {all}",
            report.refined,
            report.pixels,
            report.refined_samples,
            few.refined_samples,
            one.refined_samples
        );
        assert!(report.refined_samples < few.refined_samples);
        assert!(few.refined_samples < one.refined_samples);
        assert!(one.refined_samples <= all);
        // Many pixels are in doubt for a few of their samples only.
        assert!(4 * report.refined_samples < 3 * all, "{report:?}");
    }
}

/// A doubtful sample that is dropped is seen in the picture, and so is a sum that is off; and plumb sees it itself
/// where one of these pixels is checked: one row a band has a checked pixel in each row.
#[test]
fn wrong_parts_are_seen() {
    let (_, right) = antialiased(MANY, Backend::Cpu, 16, SamplePattern::Hash, 71);
    for fault in [Fault::Bit, Fault::Sum] {
        spoil_records(Some(fault));
        let (few, bytes) = antialiased(MANY, Backend::Gpu, 16, SamplePattern::Hash, 71);
        let (many, _) = antialiased(MANY, Backend::Gpu, 16, SamplePattern::Hash, 1);
        spoil_records(None);
        let few = few.unwrap();
        assert!(few.revoked.is_some() || bytes != right, "{fault:?}");
        let noticed = match many {
            Ok(report) => report.revoked.is_some(),
            Err(error) => matches!(error, Error::Revoked(_)),
        };
        assert!(noticed, "{fault:?}");
    }
}

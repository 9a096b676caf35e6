//! The report says where the time went: its phases follow each other, so they add up to the whole. Needs an adapter,
//! and fails without one.

use std::time::Instant;

use serde_json::{Map, Value};

use super::*;
use crate::stopwatch::Phase::{self, *};

/// The largest share of a rendering's time that may be in none of the phases.
const MOST: f64 = 0.02;

/// What a rendering took, as seen from outside, and its report as it is printed.
struct Timed {
    seconds: f64,
    report: Value,
}

impl Timed {
    fn new(render: impl FnOnce() -> Result<Report, Error>) -> Self {
        let start = Instant::now();
        let report = render();
        let seconds = start.elapsed().as_secs_f64();
        let report = serde_json::to_value(report.unwrap()).unwrap();
        let total = report["seconds"]["total"].as_f64().unwrap();
        assert!(share(seconds - total, seconds) <= MOST, "{report}");
        Self { seconds, report }
    }

    /// All of it is in these phases and no others; and each worker's life is in what it says of its time.
    fn consists_of(&self, name: &str, workers: &[(&str, &[Phase])]) {
        let thread = [Threads, Prepare, Devices, Bands, Emit, Drain, Release];
        Times::of(&self.report["seconds"]["phases"]).add_up(name, self.seconds, &thread);
        let found = self.report["workers"].as_array().unwrap();
        assert_eq!(found.len(), workers.len(), "{name}: {found:?}");
        for (worker, (called, phases)) in found.iter().zip(workers) {
            assert!(
                worker["name"].as_str().unwrap().contains(called),
                "{name}: {worker}"
            );
            let Value::Object(seconds) = &worker["seconds"] else {
                panic!("{worker}");
            };
            let life: f64 = seconds.values().map(|part| part.as_f64().unwrap()).sum();
            assert!(life <= (1.0 + MOST) * self.seconds, "{name}: {worker}");
            let times = Times::of(&worker["phases"]);
            times.are_of(name, phases);
            if *called == "CPU" {
                times.add_up(name, life, phases);
            }
        }
    }
}

/// Phases as they are printed.
struct Times<'a>(&'a Map<String, Value>);

impl<'a> Times<'a> {
    fn of(value: &'a Value) -> Self {
        Self(value.as_object().unwrap())
    }

    fn phase(&self, name: &str) -> f64 {
        self.0[name].as_f64().unwrap()
    }

    /// The share of the time that is in none of the phases, or of no phase but this one.
    fn missing(&self, of: f64, without: Option<&str>) -> f64 {
        let counted = self.0.keys().filter(|name| Some(name.as_str()) != without);
        let sum: f64 = counted.map(|name| self.phase(name)).sum();
        share(of - sum, of)
    }

    fn are_of(&self, name: &str, expected: &[Phase]) {
        for phase in Phase::ALL {
            let seconds = self.phase(phase.name());
            assert_eq!(
                seconds > 0.0,
                expected.contains(&phase),
                "{name}: {phase:?}"
            );
        }
    }

    /// They are so much together; and it would be noticed if one of them were left out that takes more than may be
    /// missing.
    fn add_up(&self, name: &str, to: f64, expected: &[Phase]) {
        self.are_of(name, expected);
        assert!(self.missing(to, None) <= MOST, "{name}: {:?}", self.0);
        for phase in Phase::ALL {
            if share(self.phase(phase.name()), to) > 2.0 * MOST {
                assert!(
                    self.missing(to, Some(phase.name())) > MOST,
                    "{name}: {phase:?}"
                );
            }
        }
    }
}

fn share(part: f64, whole: f64) -> f64 {
    part.abs() / whole
}

const ON_CPU: [Phase; 3] = [Pack, Trace, Held];
const ON_DEVICE: [Phase; 9] = [
    Pack, Upload, Compile, Buffers, Submit, Wait, Readback, Held, Release,
];
const OPENING: [Phase; 3] = [Instance, Device, Selftest];

fn timed(scene: &Scene, settings: &Settings) -> Timed {
    // Closing them is waited for when the picture is there.
    let devices = crate::render::Devices::new();
    Timed::new(|| render_with(scene, settings, &devices, &mut |_| Ok(())))
}

#[test]
fn all_time_of_a_picture_is_in_the_phases_of_its_report() {
    let mut unlit = scene();
    unlit.camera.pixeldim = [400, 300];
    for (lit, scene) in [(false, unlit), (true, small(SOME))] {
        for samples in [1, 4] {
            for (precision, jitter) in [
                (Precision::Certified, SamplePattern::Hash),
                (Precision::Fast, SamplePattern::Course),
            ] {
                let on = |backend| Settings {
                    samples,
                    jitter,
                    precision,
                    ..settings(backend)
                };
                let name = format!("lit: {lit}, {samples} samples, {precision:?}");
                let timed = |backend| timed(&scene, &on(backend));
                timed(Backend::Cpu).consists_of(&name, &[("CPU", &ON_CPU)]);
                let phases = [&OPENING[..], &ON_DEVICE].concat();
                timed(Backend::Gpu).consists_of(&name, &[("", &phases)]);
            }
        }
    }
}

#[test]
fn so_is_that_of_a_picture_on_an_open_device() {
    let gpu = adapters::open(None).unwrap();
    let timed = Timed::new(|| {
        render_live(
            &small(SOME),
            &settings(Backend::Gpu),
            &Live::on(&gpu),
            &mut |_| Ok(()),
        )
    });
    timed.consists_of("live", &[("", &ON_DEVICE)]);
}

#[test]
fn so_is_that_of_a_picture_that_the_cpu_renders_again() {
    tamper_with(&[checked(16..24)], SURE);
    let timed = timed(&scene(), &settings(Backend::Gpu));
    tamper_with(&[], SURE);
    // What a device did that was wrong is not told.
    timed.consists_of("revoked", &[("CPU", &ON_CPU), ("", &OPENING)]);
}

//! The report says where the time went: its phases follow each other, so they add up to the whole. Needs an adapter,
//! and fails without one.

use std::time::Instant;

use serde_json::{Map, Value};

use super::*;
use crate::stopwatch::Phase::{self, *};

/// The largest share of a rendering's time that may be in none of the phases.
const MOST: f64 = 0.02;

/// What a rendering took, as seen from outside, and its phases, as the report prints them.
struct Timed {
    seconds: f64,
    phases: Map<String, Value>,
}

impl Timed {
    fn new(render: impl FnOnce() -> Result<Report, Error>) -> Self {
        let start = Instant::now();
        let report = render();
        let seconds = start.elapsed().as_secs_f64();
        let report = serde_json::to_value(report.unwrap().seconds).unwrap();
        let total = report["total"].as_f64().unwrap();
        assert!(share(seconds - total, seconds) <= MOST, "{report}");
        let phases = report["phases"].as_object().unwrap().clone();
        Self { seconds, phases }
    }

    fn phase(&self, name: &str) -> f64 {
        self.phases[name].as_f64().unwrap()
    }

    /// The share of the time that is in none of the phases, or of no phase but this one.
    fn missing(&self, without: Option<&str>) -> f64 {
        let counted = self
            .phases
            .keys()
            .filter(|name| Some(name.as_str()) != without);
        let sum: f64 = counted.map(|name| self.phase(name)).sum();
        share(self.seconds - sum, self.seconds)
    }

    /// All of it is in these phases and no others; and it would be noticed if one of them were left out that takes more
    /// than may be missing.
    fn consists_of(&self, name: &str, expected: &[Phase]) {
        assert!(self.missing(None) <= MOST, "{name}: {:?}", self.phases);
        for phase in Phase::ALL {
            let seconds = self.phase(phase.name());
            assert_eq!(
                seconds > 0.0,
                expected.contains(&phase),
                "{name}: {phase:?}"
            );
            if share(seconds, self.seconds) > 2.0 * MOST {
                assert!(self.missing(Some(phase.name())) > MOST, "{name}: {phase:?}");
            }
        }
    }
}

fn share(part: f64, whole: f64) -> f64 {
    part.abs() / whole
}

const OPENING: [Phase; 3] = [Instance, Device, Selftest];
const ON_CPU: [Phase; 6] = [Threads, Prepare, Pack, Trace, Emit, Release];
const ON_GPU: [Phase; 12] = [
    Threads, Prepare, Pack, Upload, Compile, Buffers, Submit, Wait, Readback, Held, Drain, Release,
];

fn timed(scene: &Scene, settings: &Settings) -> Timed {
    Timed::new(|| render(scene, settings, &mut |_| Ok(())))
}

#[test]
fn all_time_of_a_picture_is_in_the_phases_of_its_report() {
    let mut unlit = scene();
    unlit.camera.pixeldim = [400, 300];
    for (lit, scene) in [(false, unlit), (true, hard_scene())] {
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
                timed(Backend::Cpu).consists_of(&name, &ON_CPU);
                let phases = [&OPENING[..], &ON_GPU].concat();
                timed(Backend::Gpu).consists_of(&name, &phases);
            }
        }
    }
}

#[test]
fn so_is_that_of_a_picture_on_an_open_device() {
    let gpu = adapters::shared(None).unwrap();
    let timed = Timed::new(|| {
        render_live(
            &hard_scene(),
            &settings(Backend::Gpu),
            &Live::on(&gpu),
            &mut |_| Ok(()),
        )
    });
    timed.consists_of("live", &[&[Selftest][..], &ON_GPU].concat());
}

#[test]
fn so_is_that_of_a_picture_that_the_cpu_renders_again() {
    tamper_with(&[checked(16..24)], SURE);
    let timed = timed(&scene(), &settings(Backend::Gpu));
    tamper_with(&[], SURE);
    let phases = [&OPENING[..], &ON_GPU, &[Trace, Emit]].concat();
    timed.consists_of("revoked", &phases);
}

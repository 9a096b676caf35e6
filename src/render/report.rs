//! How a rendering went: put together at its end, from what was asked for, what was found, and where the time went.

use std::fmt::Display;

use serde::Serialize;

use super::bag::Activity;
use super::{Backend, Precision, SamplePattern, Settings};
use crate::certify::{CpuSeconds, DecidedBy, Tally};
use crate::scene::Scene;
use crate::stopwatch::{Phases, Stopwatch};

/// How a rendering went: what `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The rows rendered, from the bottom, half-open.
    pub rows: [u32; 2],
    /// The screen tolerance τ.
    pub screen_tolerance: f64,
    /// Rays a pixel.
    pub samples: u32,
    /// How several samples were spread.
    pub jitter: Option<SamplePattern>,
    /// The longest path, in world units, if there were lights to make paths.
    pub max_path: Option<f64>,
    /// What was asked of the bytes.
    pub precision: Precision,
    /// What rendered: `gpu` if bands of an adapter are in the picture, else `cpu`.
    pub backend: Backend,
    /// Adapter and driver of the first device that worked on it, if one did.
    pub adapter: Option<String>,
    /// Which devices did not stay to the end, or never came, and why.
    pub fallback: Option<String>,
    /// A pixel that a device was sure of, and got wrong: others made its bands, and the picture is right.
    pub revoked: Option<String>,
    /// The adapter that was left out because it is software, and slower than the CPU is by itself.
    pub left_out: Option<String>,
    /// Who made the picture, and how long that took each of them.
    pub workers: Vec<WorkerReport>,
    /// CPU threads that were there to be used.
    pub threads: Option<usize>,
    /// Pixels rendered.
    pub pixels: u64,
    /// Pixels that the GPU handed to the CPU, because it was in doubt or had no room.
    pub refined: u64,
    /// The same, in hundredths of all pixels.
    pub refined_percent: f64,
    /// Samples that the CPU traced for them: of a pixel of which the GPU is sure of some only the others, if that was
    /// enough.
    pub refined_samples: u64,
    /// The same, in hundredths of all samples.
    pub refined_samples_percent: f64,
    /// How many pixels each kind of arithmetic decided.
    pub decided: Tally,
    /// Pixels proven to lie on a border exactly.
    pub ties: u64,
    /// Pixels so near a border that they are presumed to lie on it.
    pub presumed: u64,
    /// Column and row (from the bottom) of the first of them.
    pub presumed_at: Vec<[u32; 2]>,
    /// Pixels that the GPU was sure of, computed again on the CPU and found right.
    pub spot_checks: u64,
    /// Number of bands.
    pub bands: u32,
    /// Where the time went.
    pub seconds: Seconds,
}

/// What is said of workers that left, or never came.
#[derive(Debug, Default)]
pub(super) struct Told {
    /// By their numbers.
    pub(super) workers: Vec<(usize, WorkerReport)>,
    pub(super) left: Vec<String>,
    pub(super) revoked: Vec<String>,
    /// The name of an adapter that is software and was left out.
    pub(super) left_out: Option<String>,
}

/// Who makes what a device does not.
#[derive(Debug, Clone, Copy)]
pub(super) enum Instead {
    /// The CPU, all of it.
    Cpu,
    /// Other devices, all of it.
    Devices,
    /// Whoever is there, what the device had not made when it left.
    Rest,
}

/// Why a device did not stay to the end, or never came, and who makes its bands instead.
pub(super) fn without(why: &dyn Display, instead: Instead) -> String {
    match instead {
        Instead::Cpu => format!("{why}, so the CPU renders"),
        Instead::Devices => format!("{why}, so others render"),
        Instead::Rest => format!("{why}: others made what it had left"),
    }
}

/// What a worker did for a picture.
#[derive(Debug, Clone, Serialize)]
pub struct WorkerReport {
    /// `CPU`, or adapter and driver.
    pub name: String,
    /// Bands of it that are in the picture.
    pub bands: u32,
    /// Their pixels.
    pub pixels: u64,
    /// Where its time went.
    pub seconds: WorkerSeconds,
    /// The same, in more parts, of the thread that does the work.
    pub phases: Phases,
    /// Why it did not stay to the end, if so.
    pub left: Option<String>,
    #[serde(skip)]
    activity: Activity,
    /// What ran beside a device; none for the CPU.
    #[serde(skip)]
    beside: Option<Beside>,
}

/// Where the time of a worker went, in seconds: these follow each other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct WorkerSeconds {
    /// Until it could work: opening, compiling, packing.
    pub start: f64,
    /// Having bands to make.
    pub work: f64,
    /// Waiting for bands.
    pub wait: f64,
}

impl WorkerReport {
    pub(super) fn new(
        name: &str,
        beside: Option<Beside>,
        seconds: WorkerSeconds,
        phases: Phases,
        left: Option<String>,
    ) -> Self {
        Self {
            name: name.into(),
            bands: 0,
            pixels: 0,
            seconds,
            phases,
            left,
            activity: Activity::default(),
            beside,
        }
    }

    /// A device called this that made so many pixels, in a band.
    pub fn device(name: &str, pixels: u64) -> Self {
        let nothing = (WorkerSeconds::default(), Phases::default());
        Self {
            bands: 1,
            pixels,
            ..Self::new(name, Some(Beside::default()), nothing.0, nothing.1, None)
        }
    }

    /// Adds what it did.
    pub(super) fn did(&mut self, activity: Activity) {
        self.bands = activity.bands;
        self.pixels = activity.tally.pixels();
        self.activity = activity;
    }

    /// Whether it is a device.
    pub fn is_device(&self) -> bool {
        self.beside.is_some()
    }

    /// Whether it was tried, and the CPU was quicker without it.
    pub fn is_outrun(&self) -> bool {
        self.activity.outrun
    }
}

impl Report {
    /// Of a rendering that has ended, with so many CPU threads.
    pub(super) fn new(
        scene: &Scene,
        settings: &Settings,
        threads: usize,
        told: Told,
        watch: &Stopwatch,
    ) -> Self {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        let Told {
            workers,
            left,
            revoked,
            left_out,
        } = told;
        let mut workers: Vec<_> = workers.into_iter().map(|(_, worker)| worker).collect();
        // Threads end in any order.
        workers.sort_by(|a, b| (a.is_device(), &a.name).cmp(&(b.is_device(), &b.name)));
        let sum = |of: &dyn Fn(&WorkerReport) -> u64| workers.iter().map(of).sum::<u64>();
        let devices = || workers.iter().filter(|worker| worker.is_device());
        let tally = workers.iter().fold(Tally::default(), |tally, worker| {
            tally.merge(worker.activity.tally.clone())
        });
        let on_devices = devices().fold(Tally::default(), |tally, worker| {
            tally.merge(worker.activity.tally.clone())
        });
        let by_devices = [DecidedBy::Gpu, DecidedBy::Double].map(|by| on_devices.count(by));
        let refined = on_devices.pixels() - by_devices.iter().sum::<u64>();
        let refined_samples = on_devices.samples();
        let pixels = tally.pixels();
        let percent = |part: u64, whole: u64| 100.0 * part as f64 / whole.max(1) as f64;
        let made_some = devices().find(|worker| worker.bands > 0);
        Self {
            width,
            height,
            rows: [rows.start, rows.end],
            screen_tolerance: settings.screen_tolerance,
            samples: settings.samples,
            jitter: settings.supersampling().map(|several| several.spread),
            max_path: (!scene.lights.is_empty()).then_some(settings.limits.max_path),
            precision: settings.precision,
            backend: if made_some.is_some() {
                Backend::Gpu
            } else {
                Backend::Cpu
            },
            adapter: made_some
                .or(devices().next())
                .map(|worker| worker.name.clone()),
            fallback: (!left.is_empty()).then(|| left.join("; ")),
            revoked: (!revoked.is_empty()).then(|| revoked.join("; ")),
            left_out,
            threads: Some(threads),
            pixels,
            refined,
            refined_percent: percent(refined, pixels),
            refined_samples,
            refined_samples_percent: percent(refined_samples, pixels * u64::from(settings.samples)),
            ties: tally.count(DecidedBy::Exact),
            presumed: tally.count(DecidedBy::Presumed),
            presumed_at: tally.presumed_at().to_vec(),
            spot_checks: sum(&|worker| worker.activity.spot_checks),
            bands: sum(&|worker| u64::from(worker.bands)) as u32,
            seconds: Seconds {
                phases: watch.phases(),
                beside: devices()
                    .filter_map(|worker| worker.beside)
                    .fold(Beside::default(), Beside::and),
                stages: tally.times(),
                total: watch.total(),
            },
            decided: tally,
            workers,
        }
    }
}

/// Where the time of a rendering went, in seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// From the call of `render` to its end.
    pub total: f64,
    /// What the thread that renders did, or waited for: these follow each other, and add up to the total.
    pub phases: Phases,
    /// What others did meanwhile.
    pub beside: Beside,
    /// CPU time for pixels decided one by one, of all threads together, by what decided them.
    pub stages: CpuSeconds,
}

/// Seconds of what runs beside the threads that devices have, all devices together.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Beside {
    /// The GPU's kernels: by its own clock where it has one, else as waited for.
    pub kernel: f64,
    /// What of that went into pixels in f64, by the GPU's own clock.
    pub kernel_f64: f64,
    /// Deciding what the GPU left undecided, while it renders the next bands.
    pub refine: f64,
    /// Computing again some of what it was sure of, likewise.
    pub spot_checks: f64,
}

impl Beside {
    fn and(self, other: Self) -> Self {
        Self {
            kernel: self.kernel + other.kernel,
            kernel_f64: self.kernel_f64 + other.kernel_f64,
            refine: self.refine + other.refine,
            spot_checks: self.spot_checks + other.spot_checks,
        }
    }
}

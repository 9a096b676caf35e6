//! All ways for all scenes: the order in which things are measured, and what becomes of it.

use std::path::PathBuf;

use super::cold::processes;
use super::error::PictureError;
use super::machine::Machine;
use super::measure::{Measured, Subject, Unmeasured};
use super::ways::Way;
use super::{Report, SceneReport, Seconds, WayReport, truth};
use crate::gpu;
use crate::gpu::device::Gpu;
use crate::image::Picture;
use crate::render::Devices;
use crate::scene::{Scene, Shape};
use crate::settings::Settings;
use crate::shader::pack::Packed;

/// What is measured.
#[derive(Debug, Clone)]
pub struct Asked {
    /// The scenes at their final sizes, with what they are called and their files.
    pub scenes: Vec<(String, PathBuf, Scene)>,
    /// Measured runs of each kind, at least 1.
    pub repeat: u32,
    /// The program, with its version.
    pub software: String,
    /// The program that is run as a process of its own.
    pub program: PathBuf,
    /// Where adapters that passed the self-test are remembered.
    pub cache: Option<PathBuf>,
}

impl Asked {
    /// How many steps [`bench()`] tells of.
    #[must_use]
    pub fn steps(&self) -> u64 {
        // A way is measured, and run as a process; before the others come, the truth is found out.
        self.scenes.len() as u64 * (2 * Way::ALL.len() as u64 + 1)
    }
}

/// Why there is no report: a scene that cannot be rendered on the CPU either.
#[derive(Debug, thiserror::Error)]
#[error("{scene}: {source}")]
pub struct BenchError {
    /// What the scene is called.
    pub scene: String,
    /// What is wrong.
    pub source: Unmeasured,
}

/// Measures all ways on all scenes, and calls `step` after each of [`Asked::steps`].
///
/// # Errors
/// If a scene cannot be rendered on the CPU. What the GPU cannot do is in the report.
pub fn bench(asked: &Asked, step: &mut dyn FnMut()) -> Result<Report, BenchError> {
    let opened = gpu::adapters::shared(None);
    let gpu = opened.as_deref().map_err(ToString::to_string);
    let mut scenes = Vec::new();
    let devices = Devices::new();
    for (name, file, scene) in &asked.scenes {
        let gpu = gpu.as_ref().map(|gpu| *gpu).map_err(String::as_str);
        let report = one(asked, name, file, scene, (gpu, &devices), step);
        scenes.push(report.map_err(|source| BenchError {
            scene: name.clone(),
            source,
        })?);
    }
    Ok(Report {
        software: asked.software.clone(),
        machine: Machine::new(gpu),
        repeat: asked.repeat,
        scenes,
    })
}

fn one(
    asked: &Asked,
    name: &str,
    file: &std::path::Path,
    scene: &Scene,
    (gpu, devices): (Result<&Gpu, &str>, &Devices),
    step: &mut dyn FnMut(),
) -> Result<SceneReport, Unmeasured> {
    let settings = Settings::default();
    let rows = truth::rows(scene);
    let subject = Subject {
        scene,
        gpu,
        packed: gpu.is_ok().then(|| Packed::new(scene, &settings)),
        repeat: asked.repeat,
        cache: asked.cache.clone(),
        hits: truth::hits(scene, &settings, &rows),
        rows,
        devices,
    };
    let rays = truth::rays(scene, &settings);
    step();
    // The truth first: the others are compared with it.
    let truth = subject.measure(Way::CpuCertified)?;
    step();
    let picture = truth.picture.clone();
    let mut measured_truth = Some(truth);
    let mut ways = Vec::new();
    for way in Way::ALL {
        let measured = match measured_truth.take_if(|_| way == Way::CpuCertified) {
            Some(measured) => Ok(measured),
            None => {
                let measured = subject.measure(way);
                step();
                measured
            }
        };
        let cold = match (&measured, way.options()) {
            (Ok(_), Some(options)) => {
                let size = scene.camera.pixeldim;
                processes(&asked.program, file, size, options, asked.repeat)
                    .map_err(Unmeasured::NotAvailable)
            }
            _ => Ok([None, None]),
        };
        step();
        ways.push(match measured.and_then(|measured| Ok((measured, cold?))) {
            Ok((measured, cold)) => report(way, &picture, measured, cold, rays.all),
            Err(Unmeasured::NotAvailable(why)) => WayReport::unavailable(way, why),
            Err(failed) => return Err(failed),
        });
    }
    let is_sphere = |shape: &Shape| matches!(shape, Shape::Sphere { .. });
    Ok(SceneReport {
        scene: name.to_owned(),
        width: scene.camera.pixeldim[0],
        height: scene.camera.pixeldim[1],
        objects: scene.objects.len(),
        spheres: scene.objects.iter().filter(|o| is_sphere(&o.shape)).count(),
        lights: scene.lights.len(),
        rays,
        ways,
    })
}

fn report(
    way: Way,
    truth: &Picture,
    measured: Measured,
    [cold, warm]: [Option<super::statistics::Times>; 2],
    rays: f64,
) -> WayReport {
    let pixels = f64::from(truth.width) * f64::from(truth.height);
    // A clock may be too coarse for a picture of few pixels.
    let kernel = measured.kernel.median;
    let rate = |what: f64| (kernel > 0.0).then(|| what / kernel);
    WayReport {
        way,
        name: way.name(),
        not_available: None,
        error: PictureError::new(truth, &measured.picture).ok(),
        t: measured.t,
        doubtful_percent: measured.doubtful_percent,
        mpixels_per_second: rate(pixels * 1e-6),
        rays_per_second: rate(pixels * rays),
        seconds: Some(Seconds {
            kernel: measured.kernel,
            frame: measured.frame,
            cold,
            warm,
        }),
    }
}

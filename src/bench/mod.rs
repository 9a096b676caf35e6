//! Speed against error, way by way: what `plumb bench` measures, prints and draws.
//!
//! Stands beside `render`, above both tracers. The truth is the certified picture, as the CPU computes it:
//!
//! ```text
//! Scene ─► truth: picture, first hits, rays ─┐
//!       ─► measure: each way's picture, t,   ├─► error ─► Report ─► table, plot, JSON
//!          kernel, frame, processes (cold) ──┘
//! ```
//!
//! [`ways`] names the ways, [`textbook`] has the two that nobody should render with, [`dispatch`] runs what is no
//! shader of `shaders/` on its own: those two, and [`first_hit`], which asks our own shaders for t.

pub mod cold;
pub mod dispatch;
pub mod error;
pub mod first_hit;
mod labels;
pub mod machine;
mod markers;
pub mod measure;
pub mod plot;
pub mod scenes;
pub mod statistics;
pub mod svg;
pub mod table;
pub mod textbook;
pub mod truth;
pub mod ways;

use serde::Serialize;

use error::{PictureError, TError};
use machine::Machine;
use statistics::Times;
use truth::Rays;
use ways::Way;

pub use scenes::{Asked, BenchError, bench};

/// What `plumb bench` found out: what `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The program, with its version.
    pub software: String,
    /// What it was measured on.
    pub machine: Machine,
    /// Measured runs of each kind, the warm-up not counted.
    pub repeat: u32,
    /// One for each scene, in the order given.
    pub scenes: Vec<SceneReport>,
}

/// What was found out about a scene.
#[derive(Debug, Clone, Serialize)]
pub struct SceneReport {
    /// What the scene was called on the command line.
    pub scene: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Number of objects.
    pub objects: usize,
    /// How many of them are spheres.
    pub spheres: usize,
    /// Number of lights.
    pub lights: usize,
    /// Rays a pixel, on average.
    pub rays: Rays,
    /// One for each way, in the order of [`Way::ALL`].
    pub ways: Vec<WayReport>,
}

impl SceneReport {
    /// Pixels of the picture.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

/// What was found out about a way to render a scene.
#[derive(Debug, Clone, Serialize)]
pub struct WayReport {
    /// Its identifier.
    pub way: Way,
    /// Its name.
    pub name: &'static str,
    /// Why there is nothing to report, if so; the rest is empty then.
    pub not_available: Option<String>,
    /// How far its picture is from the certified one.
    pub error: Option<PictureError>,
    /// How far its distances to what the primary rays hit are from the true ones.
    pub t: Option<TError>,
    /// Pixels that it left to the CPU, in percent; none where no pixel can be in doubt.
    pub doubtful_percent: Option<f64>,
    /// Its times.
    pub seconds: Option<Seconds>,
    /// Millions of pixels a second of kernel time.
    pub mpixels_per_second: Option<f64>,
    /// Rays a second of kernel time.
    pub rays_per_second: Option<f64>,
}

impl WayReport {
    /// A way that there is nothing to report of.
    #[must_use]
    pub fn unavailable(way: Way, why: String) -> Self {
        Self {
            way,
            name: way.name(),
            not_available: Some(why),
            error: None,
            t: None,
            doubtful_percent: None,
            seconds: None,
            mpixels_per_second: None,
            rays_per_second: None,
        }
    }
}

/// Times of a way, in seconds.
#[derive(Debug, Clone, Serialize)]
pub struct Seconds {
    /// The dispatches of a picture, by the device's clock where it has one; on the CPU the tracing. The shader is
    /// compiled and has run before.
    pub kernel: Times,
    /// From the scene to the picture's bytes in memory: preparing, composing, compiling, uploading, tracing, reading
    /// back, deciding what is doubtful. Reading the file is not in it, nor are opening and closing the device.
    pub frame: Times,
    /// `plumb render` as a process of its own, seen from outside, with all caches of shaders and devices empty.
    pub cold: Option<Times>,
    /// The same once more, with the caches that the run before left.
    pub warm: Option<Times>,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A report of one scene in which each kind of thing occurs.
    pub(crate) fn report() -> Report {
        let times = |ms: f64| Times::new(Some(1.0), vec![ms * 1e-3, ms * 2e-3]).unwrap();
        let way = |way: Way, ms: f64, wrong: u64| {
            if way == Way::CpuPlain {
                return WayReport::unavailable(way, "no luck".into());
            }
            WayReport {
                way,
                name: way.name(),
                not_available: None,
                error: Some(PictureError {
                    wrong,
                    wrong_percent: wrong as f64 / 12.0,
                    worst: u8::from(wrong > 0),
                    worst_at: (wrong > 0).then_some([1, 2]),
                    rms: wrong as f64 * 0.01,
                }),
                t: Some(TError {
                    median: 0.5,
                    percentile_99: 1.5,
                    worst: 123_456.0,
                    compared: 1200 - wrong,
                    other_object: wrong,
                    left_out: 0,
                }),
                doubtful_percent: (way == Way::GpuCertified).then_some(0.25),
                seconds: Some(Seconds {
                    kernel: times(ms / 3.0),
                    frame: times(ms / 1.5),
                    cold: way.options().map(|_| times(100.0)),
                    warm: way.options().map(|_| times(50.0)),
                }),
                mpixels_per_second: Some(12.34),
                rays_per_second: Some(5.6e7),
            }
        };
        Report {
            software: "plumb 0.0.0".into(),
            machine: Machine {
                adapter: Some("Card".into()),
                driver: Some("Driver 1".into()),
                no_gpu: None,
                timestamps: true,
                cpu: "Processor".into(),
                threads: 2,
                system: "linux x86_64".into(),
            },
            repeat: 2,
            scenes: vec![SceneReport {
                scene: "room.txt".into(),
                width: 40,
                height: 30,
                objects: 3,
                spheres: 1,
                lights: 0,
                rays: Rays {
                    all: 1.0,
                    secondary: 0.0,
                    shadow: 0.0,
                    pixels: 1200,
                },
                ways: vec![
                    way(Way::GpuCertified, 2.0, 0),
                    way(Way::GpuFast, 1.5, 1),
                    way(Way::CpuCertified, 9.0, 0),
                    way(Way::CpuPlain, 0.0, 0),
                    way(Way::F32Quadratic, 3.0, 2),
                    way(Way::F32Naive, 1.0, 40),
                ],
            }],
        }
    }
}

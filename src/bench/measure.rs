//! A way at work: its picture, its distances, its kernel and its whole frame, run after run.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use rayon::prelude::*;

use super::error::TError;
use super::first_hit;
use super::statistics::Times;
use super::textbook::{self, Textbook, TextbookError};
use super::truth::{self, FirstObject, PixelHit};
use super::ways::Way;
use crate::certify::DecidedBy;
use crate::cpu::camera::camera_setpix;
use crate::cpu::trace::{Unobserved, ray_trace};
use crate::gpu::GpuError;
use crate::gpu::bands::{self, Rendered};
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::Pipeline;
use crate::image::Picture;
use crate::jitter::Jitter;
use crate::prepare::Prepared;
use crate::render::{self, Backend, Devices, Precision, Report, Settings, render_with};
use crate::scene::Scene;
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::pack::Packed;
use crate::stopwatch::{Phase, Stopwatch};

/// A scene at its final size, and how it is measured.
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The GPU, or why there is none.
    pub gpu: Result<&'a Gpu, &'a str>,
    /// The scene packed for it; none without a GPU.
    pub packed: Option<Packed>,
    /// Measured runs of each kind.
    pub repeat: u32,
    /// Where adapters that passed the self-test are remembered.
    pub cache: Option<PathBuf>,
    /// The rows whose distances are compared, from the bottom.
    pub rows: Vec<u32>,
    /// What their pixels truly see, and how far those distances may be off.
    pub hits: Vec<(PixelHit, f64)>,
    /// What frames are rendered on: opened once, since a frame is measured on an open device.
    pub devices: &'a Devices,
}

/// What a way was measured to do.
#[derive(Debug)]
pub struct Measured {
    /// Its picture.
    pub picture: Picture,
    /// Its distances, where any primary ray meets something.
    pub t: Option<TError>,
    /// Pixels left to the CPU, in percent.
    pub doubtful_percent: Option<f64>,
    /// Its kernel.
    pub kernel: Times,
    /// Its whole frame.
    pub frame: Times,
}

/// Why a way was not measured.
#[derive(Debug, thiserror::Error)]
pub enum Unmeasured {
    /// It does not do this scene on this machine, for this reason.
    #[error("{0}")]
    NotAvailable(String),
    /// A rendering failed.
    #[error(transparent)]
    Failed(#[from] render::Error),
}

impl From<GpuError> for Unmeasured {
    fn from(error: GpuError) -> Self {
        Self::NotAvailable(error.to_string())
    }
}

impl From<TextbookError> for Unmeasured {
    fn from(error: TextbookError) -> Self {
        Self::NotAvailable(error.to_string())
    }
}

/// A picture with its report, as `render` makes it.
struct Frame {
    picture: Picture,
    verdicts: Vec<DecidedBy>,
    report: Report,
    /// Seconds, on an open device.
    seconds: f64,
}

impl Subject<'_> {
    /// Settings for a way that `plumb render` has.
    fn settings(&self, way: Way) -> Settings {
        Settings {
            backend: if way.is_on_gpu() {
                Backend::Gpu
            } else {
                Backend::Cpu
            },
            precision: if way == Way::GpuFast {
                Precision::Fast
            } else {
                Precision::Certified
            },
            cache: self.cache.clone(),
            ..Settings::default()
        }
    }

    /// The rows and the picture of a way.
    ///
    /// # Errors
    /// If the way does not do this scene, or a rendering fails.
    pub fn measure(&self, way: Way) -> Result<Measured, Unmeasured> {
        match way {
            Way::GpuCertified | Way::GpuFast => self.on_gpu(way),
            Way::CpuCertified => self.on_cpu(),
            Way::CpuPlain => self.plain(),
            Way::F32Quadratic => self.textbook(true),
            Way::F32Naive => self.textbook(false),
        }
    }

    fn gpu(&self) -> Result<&Gpu, Unmeasured> {
        self.gpu
            .map_err(|why| Unmeasured::NotAvailable(why.to_owned()))
    }

    fn on_gpu(&self, way: Way) -> Result<Measured, Unmeasured> {
        let gpu = self.gpu()?;
        let settings = self.settings(way);
        let no_gpu = || Unmeasured::NotAvailable("the scene is not packed".into());
        let packed = self.packed.as_ref().ok_or_else(no_gpu)?;
        let warm_up = self.frame(&settings, true)?;
        if let Some(why) = warm_up.report.revoked.or(warm_up.report.fallback) {
            return Err(Unmeasured::NotAvailable(why));
        }
        let frame = self.times(warm_up.seconds, || {
            Ok(self.frame(&settings, false)?.seconds)
        })?;
        let kernel = self.kernel(gpu, packed, &settings)?;
        let width = self.scene.camera.pixeldim[0];
        let mut hits = first_hit::hits(gpu, packed, &settings, width, &self.rows)?;
        let certified = way == Way::GpuCertified;
        if certified {
            self.leave_out(&mut hits, &warm_up.verdicts);
        }
        Ok(Measured {
            picture: warm_up.picture,
            t: self.compared(&hits),
            doubtful_percent: certified.then_some(warm_up.report.refined_percent),
            kernel,
            frame,
        })
    }

    fn on_cpu(&self) -> Result<Measured, Unmeasured> {
        let settings = self.settings(Way::CpuCertified);
        let warm_up = self.frame(&settings, false)?;
        let mut frames = Vec::new();
        let mut kernels = Vec::new();
        for _ in 0..self.repeat {
            let frame = self.frame(&settings, false)?;
            frames.push(frame.seconds);
            kernels.push(traced(&frame.report));
        }
        // The true distances are those of this way, so it is compared with itself.
        let hits: Vec<PixelHit> = self.hits.iter().map(|(seen, _)| *seen).collect();
        Ok(Measured {
            picture: warm_up.picture,
            t: self.compared(&hits),
            doubtful_percent: None,
            kernel: times(traced(&warm_up.report), kernels)?,
            frame: times(warm_up.seconds, frames)?,
        })
    }

    /// One rendering with what it took.
    fn frame(&self, settings: &Settings, verdicts: bool) -> Result<Frame, Unmeasured> {
        let settings = Settings {
            verdicts,
            ..settings.clone()
        };
        let [width, height] = self.scene.camera.pixeldim;
        let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
        let mut verdicts = Vec::new();
        let report = render_with(self.scene, &settings, self.devices, &mut |band| {
            rgb.extend_from_slice(&band.rgb);
            verdicts.extend(band.verdicts.iter().flatten());
            Ok(())
        });
        let report = match report {
            // A device that cannot be used leaves the other ways; a scene that cannot be traced does not.
            Err(render::Error::Gpu(error)) => return Err(error.into()),
            report => report?,
        };
        Ok(Frame {
            picture: Picture { width, height, rgb },
            verdicts,
            seconds: report.seconds.total - report.seconds.phases.get(Phase::Devices),
            report,
        })
    }

    /// The dispatches alone, of a shader that is compiled once and has run before.
    fn kernel(&self, gpu: &Gpu, packed: &Packed, settings: &Settings) -> Result<Times, Unmeasured> {
        let features = FeatureSet::new(packed, settings, gpu.lanes).for_a_file(gpu.software);
        let wgsl = compose(packed, &features, Entry::Picture);
        let pipeline = Pipeline::new(gpu, packed, &features, &wgsl)?;
        let [width, height] = self.scene.camera.pixeldim;
        let frame = bands::Frame {
            dispatch_seconds: bands::DISPATCH_SECONDS,
            double: None,
            canvas: None,
            width,
            rows: 0..height,
            tests: packed.tests(),
            jitter: &Jitter::Once,
            band_rows: None,
        };
        let run = || -> Result<f64, Unmeasured> {
            let mut kernel = 0.0;
            let hand_on = &mut |rendered: Rendered| {
                kernel += rendered.kernel;
                ControlFlow::Continue(())
            };
            let watch = &mut Stopwatch::start();
            bands::run(
                gpu,
                &pipeline,
                &frame,
                &mut bands::from_the_top(0..height),
                &|| false,
                watch,
                hand_on,
            )?;
            Ok(kernel)
        };
        self.times(run()?, run)
    }

    /// The tracer in f64, without bounds.
    fn plain(&self) -> Result<Measured, Unmeasured> {
        let settings = self.settings(Way::CpuPlain);
        let (picture, kernel, frame) = plain(self.scene, &settings);
        let mut kernels = Vec::new();
        let mut frames = Vec::new();
        for _ in 0..self.repeat {
            let (_, kernel, frame) = plain(self.scene, &settings);
            kernels.push(kernel);
            frames.push(frame);
        }
        let hits = truth::plain_hits(self.scene, &settings, &self.rows);
        Ok(Measured {
            picture,
            t: self.compared(&hits),
            doubtful_percent: None,
            kernel: times(kernel, kernels)?,
            frame: times(frame, frames)?,
        })
    }

    fn textbook(&self, prepared: bool) -> Result<Measured, Unmeasured> {
        let gpu = self.gpu()?;
        let settings = self.settings(Way::F32Naive);
        let (warm_up, rendered) = textbook::frame(gpu, self.scene, &settings, prepared)?;
        let frame = self.times(warm_up, || {
            Ok(textbook::frame(gpu, self.scene, &settings, prepared)?.0)
        })?;
        let ready = Textbook::new(gpu, self.scene, &settings, prepared, false)?;
        let kernel = self.times(ready.render()?.kernel, || Ok(ready.render()?.kernel))?;
        let hits = Textbook::new(gpu, self.scene, &settings, prepared, true)?.hits(&self.rows)?;
        Ok(Measured {
            picture: rendered.picture,
            t: self.compared(&hits),
            doubtful_percent: None,
            kernel,
            frame,
        })
    }

    /// Runs it as often as asked for.
    fn times(
        &self,
        warm_up: f64,
        mut run: impl FnMut() -> Result<f64, Unmeasured>,
    ) -> Result<Times, Unmeasured> {
        let runs = (0..self.repeat)
            .map(|_| run())
            .collect::<Result<Vec<_>, _>>()?;
        times(warm_up, runs)
    }

    fn compared(&self, hits: &[PixelHit]) -> Option<TError> {
        TError::new(&self.hits, hits)
    }

    /// Pixels that the GPU was not sure of have no distance of its own: the CPU decided them.
    fn leave_out(&self, hits: &mut [PixelHit], verdicts: &[DecidedBy]) {
        let [width, height] = self.scene.camera.pixeldim.map(|n| n as usize);
        for (line, y) in hits.chunks_mut(width).zip(&self.rows) {
            // The picture's top row comes first.
            let row = height - 1 - *y as usize;
            let verdicts = &verdicts[row * width..(row + 1) * width];
            for (seen, by) in line.iter_mut().zip(verdicts) {
                if *by != DecidedBy::Gpu {
                    seen.object = FirstObject::Unsure;
                }
            }
        }
    }
}

/// Seconds that the CPU traced bands.
fn traced(report: &Report) -> f64 {
    let workers = report.workers.iter();
    workers.map(|worker| worker.phases.get(Phase::Trace)).sum()
}

fn times(warm_up: f64, runs: Vec<f64>) -> Result<Times, Unmeasured> {
    Times::new(Some(warm_up), runs)
        .ok_or_else(|| Unmeasured::NotAvailable("there was no run to measure".into()))
}

/// A picture in plain f64, on all cores; the seconds of tracing, and of all.
fn plain(scene: &Scene, settings: &Settings) -> (Picture, f64, f64) {
    let start = Instant::now();
    let prepared = Prepared::<f64>::new(scene, settings.view());
    let limits = settings.sample_limits();
    let [width, height] = scene.camera.pixeldim;
    let mut rgb = vec![0; 3 * width as usize * height as usize];
    let tracing = Instant::now();
    rgb.par_chunks_mut(3 * width as usize)
        .zip((0..height).into_par_iter().rev())
        .for_each(|(line, y)| {
            for (pixel, x) in line.as_chunks_mut::<3>().0.iter_mut().zip(0u32..) {
                let (x, y) = (f64::from(x), f64::from(y));
                let traced = ray_trace(&prepared, &limits, x, y, &mut Unobserved);
                // What is not a number stays black.
                *pixel = traced
                    .ok()
                    .and_then(|traced| camera_setpix(traced.color).ok())
                    .unwrap_or_default();
            }
        });
    let kernel = tracing.elapsed().as_secs_f64();
    let picture = Picture { width, height, rgb };
    (picture, kernel, start.elapsed().as_secs_f64())
}

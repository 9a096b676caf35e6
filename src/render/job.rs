//! A rendering under way, on one of the two tracers.

use std::ops::Range;
use std::sync::OnceLock;
use std::time::Instant;

use super::{Backend, Emit, Error, Report, Seconds, Settings};
use crate::cpu::pixel::{Stages, make_band};
use crate::cpu::trace::Limits;
use crate::gpu::device::Gpu;
use crate::gpu::features::FeatureSet;
use crate::gpu::pack::Packed;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::{GpuError, bands, compose};
use crate::jitter::Jitter;
use crate::prepare::{Prepared, View};
use crate::scene::Scene;

/// Everything that a tracer needs to know.
pub(super) struct Job<'a> {
    pub(super) scene: &'a Scene,
    pub(super) view: View,
    pub(super) jitter: Jitter,
    pub(super) limits: Limits,
    pub(super) width: u32,
    pub(super) rows: Range<u32>,
    pub(super) settings: &'a Settings,
}

impl Job<'_> {
    /// Renders on the GPU; pixels that it leaves undecided are traced on the CPU.
    pub(super) fn on_gpu(
        &self,
        gpu: &Gpu,
        emit: &mut Emit<'_>,
        report: &mut Report,
    ) -> Result<(), Error> {
        let start = Instant::now();
        let packed = Packed::new(&Prepared::new(self.scene, self.view));
        let (found, allowed) = (packed.loop_iterations(), compose::LOOP_ITERATIONS);
        if found > allowed {
            return Err(GpuError::TooMany { found, allowed }.into());
        }
        let features = FeatureSet::new(&packed, self.settings, gpu.lanes);
        let wgsl = compose::compose(&packed, &features);
        let packing = start.elapsed().as_secs_f64();
        let pipeline = Pipeline::new(gpu, &packed, &features, &wgsl)?;
        let stages = OnceLock::new();
        let refine = |x: u32, y: u32| {
            let row = self.jitter.row(y);
            let sampling = self
                .jitter
                .pixel(row.as_deref(), self.width as usize, x as usize);
            stages
                .get_or_init(|| Stages::new(self.scene, self.view))
                .trace(&self.limits, sampling, x, y)
        };
        let frame = bands::Frame {
            width: self.width,
            rows: self.rows.clone(),
            tests: packed.tests() * self.settings.samples as usize,
            jitter: &self.jitter,
            refine: &refine,
        };
        let times = bands::run(gpu, &pipeline, &frame, emit)?;
        report.refined = times.refined;
        report.backend = Backend::Gpu;
        report.adapter = Some(gpu.name.clone());
        report.bands = times.bands;
        let [instance, device] = gpu.seconds;
        let [compile, upload] = pipeline.seconds;
        report.seconds = Seconds {
            instance,
            device,
            compile,
            upload: packing + upload,
            kernel: times.kernel,
            readback: times.readback,
            emit: times.emit,
            total: 0.0,
        };
        Ok(())
    }

    /// Renders on the CPU.
    pub(super) fn on_cpu(&self, emit: &mut Emit<'_>, report: &mut Report) -> Result<(), Error> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.settings.threads.unwrap_or(0))
            .build()
            .map_err(|error| Error::Threads(error.to_string()))?;
        let stages = pool.install(|| Stages::new(self.scene, self.view));
        report.threads = Some(pool.current_num_threads());
        let mut height = 16.min(self.rows.end - self.rows.start);
        let mut end = self.rows.end;
        while end > self.rows.start {
            let kernel = Instant::now();
            let band = end - height..end;
            let values = self.settings.values;
            let band = pool.install(|| {
                make_band(
                    &stages,
                    &self.limits,
                    &self.jitter,
                    self.width,
                    band,
                    values,
                )
            })?;
            let seconds = kernel.elapsed().as_secs_f64();
            report.seconds.kernel += seconds;
            let emitting = Instant::now();
            emit(&band)?;
            report.seconds.emit += emitting.elapsed().as_secs_f64();
            report.bands += 1;
            end -= height;
            height = next_height(height, seconds, self.width).min(end - self.rows.start);
        }
        Ok(())
    }
}

/// Rows of the next band on the CPU: a quarter of a second's worth, so that progress shows, and at most four megapixels.
fn next_height(height: u32, seconds: f64, width: u32) -> u32 {
    let ideal = f64::from(height) * 0.25 / seconds.max(1e-6);
    let most = ((4 << 20) / width).max(1);
    (ideal as u32)
        .clamp(height / 4, height.saturating_mul(4))
        .clamp(1, most)
}

//! A rendering under way, on one of the two tracers.

use std::ops::{ControlFlow, Range};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use super::finish::{Digest, Finish, Stop, Wrong};
use super::{Backend, Emit, Error, Live, Report, Settings};
use crate::certify::lanes::Lanes;
use crate::certify::pixels::Tracer;
use crate::certify::{Tally, trust};
use crate::frame::Band;
use crate::gpu::features::FeatureSet;
use crate::gpu::pack::Packed;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::{GpuError, bands, compose};
use crate::jitter::Jitter;
use crate::scene::Scene;

/// Everything that a tracer needs to know.
pub(super) struct Job<'a> {
    pub(super) scene: &'a Scene,
    pub(super) jitter: &'a Jitter,
    pub(super) tracer: &'a Tracer<'a>,
    /// The threads that the CPU's part runs on, if not all.
    pub(super) pool: Option<&'a rayon::ThreadPool>,
    pub(super) width: u32,
    pub(super) rows: Range<u32>,
    pub(super) settings: &'a Settings,
}

impl Job<'_> {
    /// Renders on the GPU; pixels that it leaves undecided are decided on the CPU, band by band, while the next bands are
    /// rendered. Where it turns out to be wrong all is done again on the CPU.
    pub(super) fn on_gpu(
        &self,
        live: &Live<'_>,
        emit: &mut Emit<'_>,
        report: &mut Report,
    ) -> Result<(), Error> {
        let gpu = live.gpu;
        let start = Instant::now();
        // Prepared once, for the GPU and for the pixels that the CPU decides.
        let stages = self.on_threads(|| self.tracer.stages());
        let packed = Packed::prepared(stages.bounded(), self.scene, self.settings);
        let (found, allowed) = (packed.loop_iterations(), compose::LOOP_ITERATIONS);
        if found > allowed {
            return Err(GpuError::TooMany { found, allowed }.into());
        }
        let certified = self.settings.has_gpu_bounds();
        if let (true, Some(reason)) = (certified, packed.unprovable) {
            report.fallback = Some(format!(
                "{reason} for f32 with error bounds, so the CPU renders"
            ));
            return self.on_cpu(emit, report);
        }
        let mut features = FeatureSet::new(&packed, self.settings, gpu.lanes);
        if live.compiled.is_some() && !certified {
            features = features.while_moving();
        }
        let wgsl = compose::compose(&packed, &features);
        let packing = start.elapsed().as_secs_f64();
        let compile = || match live.compiled {
            Some(compiled) => compiled.get(gpu, &wgsl),
            None => gpu.compile(&wgsl, "main"),
        };
        let pipeline = Pipeline::with(gpu, &packed, &features, compile)?;
        report.seconds.compile = pipeline.seconds[0];
        report.seconds.upload = packing + pipeline.seconds[1];
        let frame = bands::Frame {
            width: self.width,
            rows: self.rows.clone(),
            tests: packed.tests() * self.settings.samples as usize,
            jitter: self.jitter,
            band_rows: self.settings.band_rows,
            dispatch_seconds: live.dispatch_seconds,
            canvas: live.canvas,
        };
        let mut finish = Finish::new(self.tracer, emit, certified, self.settings.verdicts);
        let ended = self.in_step(live, &pipeline, &frame, &mut finish, report);
        report.backend = Backend::Gpu;
        report.adapter = Some(gpu.name.clone());
        report.bands = finish.bands;
        report.spot_checks = finish.spot_checks;
        let [refine, spot_checks, emitting] = finish.seconds;
        report.seconds.refine = refine;
        report.seconds.spot_checks = spot_checks;
        report.seconds.emit = emitting;
        report.count(&finish.tally);
        let digest = finish.digest;
        match ended {
            Ok(()) => Ok(()),
            Err(Stop::Error(error)) => Err(error),
            Err(Stop::Wrong(wrong)) => {
                trust::revoke(gpu, self.settings.cache.as_deref());
                self.again(&wrong, &digest, emit, report)
            }
        }
    }

    /// The GPU's side on this thread, `finish` on another: at most one band is being finished while one waits.
    fn in_step(
        &self,
        live: &Live<'_>,
        pipeline: &Pipeline,
        frame: &bands::Frame<'_>,
        finish: &mut Finish<'_, '_, '_>,
        report: &mut Report,
    ) -> Result<(), Stop> {
        let (sender, receiver) = mpsc::sync_channel::<bands::Rendered>(1);
        let rendered = thread::scope(|scope| {
            let finisher = thread::Builder::new()
                .name("finish".into())
                .spawn_scoped(scope, || {
                    // Dropping the receiver is what tells the other side to stop.
                    receiver
                        .into_iter()
                        .try_for_each(|band| self.on_threads(|| finish.band(band)))
                })
                .map_err(|error| Error::Threads(error.to_string()))?;
            let rendered = bands::run(
                live.gpu,
                pipeline,
                frame,
                live.stop,
                &mut |band| match sender.send(band) {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(_) => ControlFlow::Break(()),
                },
            );
            drop(sender);
            match finisher.join() {
                Ok(finished) => finished?,
                Err(panic) => std::panic::resume_unwind(panic),
            }
            Ok::<_, Stop>(rendered?)
        })?;
        if (live.stop)() {
            return Err(Error::Stopped.into());
        }
        report.seconds.kernel = rendered.kernel;
        report.seconds.readback = rendered.readback;
        report.seconds.held = rendered.held;
        Ok(())
    }

    /// The GPU was sure of a pixel and wrong: the CPU renders the frame. Rows that were handed on already cannot be taken
    /// back, so they are computed again and compared: if they are right, the CPU goes on below them.
    fn again(
        &self,
        wrong: &Wrong,
        digest: &Digest,
        emit: &mut Emit<'_>,
        report: &mut Report,
    ) -> Result<(), Error> {
        let Wrong {
            at: [x, y],
            gpu,
            cpu,
        } = wrong;
        let revoked = format!(
            "{} was sure that pixel ({x}, {y}) has the bytes {gpu:?}, and they are {cpu:?}",
            report.adapter.as_deref().unwrap_or("the GPU")
        );
        let below = digest.down_to.unwrap_or(self.rows.end);
        report.backend = Backend::Cpu;
        report.revoked = Some(revoked.clone());
        report.bands = 0;
        report.count(&Tally::default());
        let mut again = Digest::default();
        let check = &mut |band: &Band| {
            again.add(band);
            Ok(())
        };
        self.trace(below..self.rows.end, check, report)?;
        if !again.agrees(digest) {
            return Err(Error::Revoked(revoked));
        }
        self.trace(self.rows.start..below, emit, report)
    }

    /// Renders on the CPU.
    pub(super) fn on_cpu(&self, emit: &mut Emit<'_>, report: &mut Report) -> Result<(), Error> {
        self.trace(self.rows.clone(), emit, report)
    }

    /// Traces rows on the CPU, and adds what that took to the report.
    fn trace(
        &self,
        rows: Range<u32>,
        emit: &mut Emit<'_>,
        report: &mut Report,
    ) -> Result<(), Error> {
        if rows.is_empty() {
            return Ok(());
        }
        let stages = self.on_threads(|| self.tracer.stages());
        let lanes = self.on_threads(|| Lanes::new(stages.bounded(), self.scene, self.settings));
        let most = ((4 << 20) / self.width).max(1);
        let fixed = self.settings.band_rows.map(|rows| rows.clamp(1, most));
        let mut height = fixed.unwrap_or(16).min(rows.end - rows.start);
        let mut tally = report.decided.clone();
        let mut end = rows.end;
        while end > rows.start {
            let kernel = Instant::now();
            let (band, counted) =
                self.on_threads(|| self.tracer.band(end - height..end, lanes.as_ref()))?;
            tally = tally.merge(counted);
            let seconds = kernel.elapsed().as_secs_f64();
            report.seconds.kernel += seconds;
            let emitting = Instant::now();
            emit(&band)?;
            report.seconds.emit += emitting.elapsed().as_secs_f64();
            report.bands += 1;
            end -= height;
            height = fixed
                .unwrap_or_else(|| next_height(height, seconds, most))
                .min(end - rows.start);
        }
        report.count(&tally);
        Ok(())
    }

    /// Runs on the threads that were asked for.
    fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Rows of the next band on the CPU: a quarter of a second's worth, so that progress shows, and at most so many.
fn next_height(height: u32, seconds: f64, most: u32) -> u32 {
    let ideal = f64::from(height) * 0.25 / seconds.max(1e-6);
    (ideal as u32)
        .clamp(height / 4, height.saturating_mul(4))
        .clamp(1, most)
}

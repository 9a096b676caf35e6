//! A rendering under way, on one of the two tracers.

use std::ops::{ControlFlow, Range};
use std::sync::mpsc;
use std::thread;

use super::choice::Choice;
use super::finish::{Digest, Finish, FinishError, Wrong};
use super::report::Done;
use super::{Backend, Beside, Emit, Error, Live, Settings};
use crate::certify::lanes::Lanes;
use crate::certify::pixels::PixelDecider;
use crate::certify::{Tally, trust};
use crate::frame::Band;
use crate::gpu::pipeline::{Pipeline, SceneBuffers};
use crate::gpu::{GpuError, bands};
use crate::jitter::Jitter;
use crate::scene::Scene;
use crate::shader::compose::{Entry, compose};
use crate::shader::constants::LOOP_ITERATIONS;
use crate::shader::feature_set::FeatureSet;
use crate::shader::pack::Packed;
use crate::stopwatch::{Phase, Stopwatch};

/// Everything that a tracer needs to know.
pub(super) struct Rendering<'a> {
    pub(super) scene: &'a Scene,
    pub(super) jitter: &'a Jitter,
    pub(super) decider: &'a PixelDecider<'a>,
    /// The threads that the CPU's part runs on, if not all.
    pub(super) pool: Option<&'a rayon::ThreadPool>,
    pub(super) width: u32,
    pub(super) rows: Range<u32>,
    pub(super) settings: &'a Settings,
}

impl Rendering<'_> {
    /// Renders on the tracer that was chosen; on the CPU where the scene turns out to be too much for the GPU, if any
    /// tracer will do.
    pub(super) fn run(
        &self,
        choice: &Choice<Live<'_>>,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<Done, Error> {
        let fallback = match choice {
            Choice::Cpu(why) => why.clone(),
            Choice::Gpu(live) => match self.on_gpu(live, emit, watch) {
                // These errors are found before the first band, so nothing is rendered twice.
                Err(Error::Gpu(
                    error @ (GpuError::TooMany { .. }
                    | GpuError::TooLarge { .. }
                    | GpuError::TooManyBuffers { .. }),
                )) if self.settings.backend == Backend::Auto => {
                    Some(format!("{error}, so the CPU renders"))
                }
                done => return done,
            },
        };
        Ok(Done {
            fallback,
            ..self.on_cpu(emit, watch)?
        })
    }

    /// Renders on the GPU; pixels that it leaves undecided are decided on the CPU, band by band, while the next bands
    /// are rendered. Where it turns out to be wrong all is done again on the CPU.
    fn on_gpu(
        &self,
        live: &Live<'_>,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<Done, Error> {
        // Prepared once, for the GPU and for the pixels that the CPU decides.
        let exact_tracer = self.on_threads(|| self.decider.exact_tracer());
        watch.lap(Phase::Prepare);
        let packed = Packed::prepared(exact_tracer.bounded(), self.scene, self.settings);
        let (found, allowed) = (packed.loop_iterations(), LOOP_ITERATIONS);
        if found > allowed {
            return Err(GpuError::TooMany { found, allowed }.into());
        }
        if let (true, Some(reason)) = (self.settings.has_gpu_bounds(), packed.unprovable) {
            let fallback = format!("{reason} for f32 with error bounds, so the CPU renders");
            return Ok(Done {
                fallback: Some(fallback),
                ..self.on_cpu(emit, watch)?
            });
        }
        let pipeline = self.pipeline(live, &packed, watch)?;
        let frame = bands::Frame {
            width: self.width,
            rows: self.rows.clone(),
            tests: packed.tests() * self.settings.samples as usize,
            jitter: self.jitter,
            band_rows: self.settings.band_rows,
            dispatch_seconds: live.dispatch_seconds,
            canvas: live.canvas,
        };
        let mut finish = Finish::new(self.decider, emit, self.settings);
        let ended = self.in_step(live, &pipeline, &frame, &mut finish, watch);
        let (done, digest) = finish.end();
        let done = Done {
            adapter: Some(live.gpu.name.clone()),
            ..done
        };
        match ended {
            Ok(kernel) => Ok(Done {
                beside: Beside {
                    kernel,
                    ..done.beside
                },
                ..done
            }),
            Err(FinishError::Error(error)) => Err(error),
            Err(FinishError::Wrong(wrong)) => {
                trust::revoke(live.gpu, self.settings.cache.as_deref());
                self.again(&wrong, &digest, done, emit, watch)
            }
        }
    }

    /// The shader for the packed scene, compiled and bound to it.
    fn pipeline(
        &self,
        live: &Live<'_>,
        packed: &Packed,
        watch: &mut Stopwatch,
    ) -> Result<Pipeline, GpuError> {
        let gpu = live.gpu;
        let mut features = FeatureSet::new(packed, self.settings, gpu.lanes);
        if live.compiled.is_some() && !features.certified {
            features = features.while_moving();
        }
        let wgsl = compose(packed, &features, Entry::Picture);
        watch.lap(Phase::Pack);
        let buffers = SceneBuffers::new(gpu, packed, &features)?;
        watch.lap(Phase::Upload);
        let shader = match live.compiled {
            Some(compiled) => compiled.get(gpu, &wgsl),
            None => gpu.compile(&wgsl, "main"),
        }?;
        watch.lap(Phase::Compile);
        Ok(Pipeline::of(shader, buffers, packed, &features))
    }

    /// The GPU's side on this thread, `finish` on another: at most one band is being finished while one waits. Returns
    /// the seconds of the kernels.
    fn in_step(
        &self,
        live: &Live<'_>,
        pipeline: &Pipeline,
        frame: &bands::Frame<'_>,
        finish: &mut Finish<'_, '_, '_>,
        watch: &mut Stopwatch,
    ) -> Result<f64, FinishError> {
        let (sender, receiver) = mpsc::sync_channel::<bands::Rendered>(1);
        let kernel = thread::scope(|scope| {
            let finisher = thread::Builder::new()
                .name("finish".into())
                .spawn_scoped(scope, || {
                    // Dropping the receiver is what tells the other side to stop.
                    receiver
                        .into_iter()
                        .try_for_each(|band| self.on_threads(|| finish.band(band)))
                })
                .map_err(|error| Error::Threads(error.to_string()))?;
            watch.lap(Phase::Threads);
            let hand_on = &mut |band| match sender.send(band) {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            };
            let kernel = bands::run(live.gpu, pipeline, frame, live.stop, watch, hand_on);
            watch.lap(Phase::Release);
            drop(sender);
            let finished = finisher.join();
            watch.lap(Phase::Drain);
            match finished {
                Ok(finished) => finished?,
                Err(panic) => std::panic::resume_unwind(panic),
            }
            Ok::<_, FinishError>(kernel?)
        })?;
        if (live.stop)() {
            return Err(Error::Stopped.into());
        }
        Ok(kernel)
    }

    /// The GPU was sure of a pixel and wrong: the CPU renders the frame. Rows that were handed on already cannot be
    /// taken back, so they are computed again and compared: if they are right, the CPU goes on below them.
    fn again(
        &self,
        wrong: &Wrong,
        digest: &Digest,
        done: Done,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<Done, Error> {
        let Wrong {
            at: [x, y],
            gpu,
            cpu,
        } = wrong;
        let revoked = format!(
            "{} was sure that pixel ({x}, {y}) has the bytes {gpu:?}, and they are {cpu:?}",
            done.adapter.as_deref().unwrap_or("the GPU")
        );
        let below = digest.down_to.unwrap_or(self.rows.end);
        let mut again = Digest::default();
        let check = &mut |band: &Band| {
            again.add(band);
            Ok(())
        };
        let (checked, checked_bands) = self.trace(below..self.rows.end, check, watch)?;
        if !again.agrees(digest) {
            return Err(Error::Revoked(revoked));
        }
        let (tally, bands) = self.trace(self.rows.start..below, emit, watch)?;
        Ok(Done {
            backend: Backend::Cpu,
            revoked: Some(revoked),
            tally: checked.merge(tally),
            bands: checked_bands + bands,
            ..done
        })
    }

    /// Renders on the CPU.
    fn on_cpu(&self, emit: &mut Emit<'_>, watch: &mut Stopwatch) -> Result<Done, Error> {
        let (tally, bands) = self.trace(self.rows.clone(), emit, watch)?;
        Ok(Done::on_cpu(tally, bands))
    }

    /// Traces rows on the CPU. Returns what decided them, and the number of bands.
    fn trace(
        &self,
        rows: Range<u32>,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<(Tally, u32), Error> {
        let (mut tally, mut bands) = (Tally::default(), 0);
        if rows.is_empty() {
            return Ok((tally, bands));
        }
        let exact_tracer = self.on_threads(|| self.decider.exact_tracer());
        watch.lap(Phase::Prepare);
        let lanes =
            self.on_threads(|| Lanes::new(exact_tracer.bounded(), self.scene, self.settings));
        watch.lap(Phase::Pack);
        let most = ((4 << 20) / self.width).max(1);
        let fixed = self.settings.band_rows.map(|rows| rows.clamp(1, most));
        let mut height = fixed.unwrap_or(16).min(rows.end - rows.start);
        let mut end = rows.end;
        while end > rows.start {
            let (band, counted) =
                self.on_threads(|| self.decider.band(end - height..end, lanes.as_ref()))?;
            tally = tally.merge(counted);
            let seconds = watch.lap(Phase::Trace);
            emit(&band)?;
            watch.lap(Phase::Emit);
            bands += 1;
            end -= height;
            height = fixed
                .unwrap_or_else(|| next_height(height, seconds, most))
                .min(end - rows.start);
        }
        Ok((tally, bands))
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

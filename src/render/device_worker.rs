//! A device as a worker: takes rows for it, and finishes what it rendered while it renders the next ones.
//!
//! Its thread ([`device_thread`]) is not waited for: if the device is lost, out of memory, wrong or silent, the worker
//! leaves, and others make what it had taken.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::bag::Taken;
use super::device_thread::{self, DeviceTask, Heights, Line, News, Use};
use super::devices::{Device, Devices};
use super::finish::{Finish, Unfinished};
use super::rendering::Rendering;
use super::report::{Beside, Instead, WorkerReport, WorkerSeconds, without};
use super::{Backend, Error, Live};
use crate::certify::trust;
use crate::frame::Halt;
use crate::gpu::GpuError;
use crate::gpu::bands::DISPATCH_SECONDS;
use crate::gpu::device::Gpu;
use crate::gpu::double::DoubleStage;
use crate::shader::constants::LOOP_ITERATIONS;
use crate::stopwatch::Phases;

/// Bands that a device is given at once: two that it works on, and one that is being finished.
const AT_ONCE: usize = 3;

/// So many pixels have to be known before it is said whether f64 on a device is worth its time.
const WEIGHED: u64 = 1024;

/// How long a device's thread has to say what it did.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// A device.
pub(super) enum Here<'a> {
    /// One that was opened for pictures.
    Opened {
        device: Arc<Device>,
        /// What opening it took.
        phases: Phases,
        /// Whose it is.
        devices: &'a Devices,
    },
    /// One that somebody else opened.
    Live(&'a Live<'a>),
}

impl Here<'_> {
    fn gpu(&self) -> &Gpu {
        match self {
            Self::Opened { device, .. } => &device.gpu,
            Self::Live(live) => live.gpu,
        }
    }
}

/// Why a device's worker ends before all is done.
enum Gone {
    /// There is nothing left for it to do.
    Done,
    /// The device's fault, or the scene's.
    Fault(GpuError),
    /// The scene cannot be certified on it.
    Unprovable(String),
    /// It was sure of a pixel, and wrong: this one.
    Wrong(String),
}

/// A device at work on a picture.
pub(super) struct DeviceWorker<'a, 'r> {
    rendering: &'a Rendering<'r>,
    me: usize,
    started: Instant,
    ready: Option<Instant>,
    beside: Beside,
    /// Where the time of its thread went, if that told.
    thread: Phases,
    /// How long the device may keep silent.
    patience: Duration,
    /// Pixels that f64 was asked for.
    listed: u64,
    /// Pixels that were left to the CPU.
    refined: u64,
}

impl<'a, 'r> DeviceWorker<'a, 'r> {
    pub(super) fn new(rendering: &'a Rendering<'r>, me: usize) -> Self {
        Self {
            rendering,
            me,
            started: Instant::now(),
            ready: None,
            beside: Beside::default(),
            thread: Phases::default(),
            patience: patience(),
            listed: 0,
            refined: 0,
        }
    }

    /// Works until there is nothing left to do, or it has to leave.
    pub(super) fn run(mut self, here: &Here<'_>, sender: Sender<News>, news: &Receiver<News>) {
        let gone = self.work(here, sender, news);
        let (bag, backend) = (&self.rendering.bag, self.rendering.settings.backend);
        let left = match gone {
            Gone::Done => return self.report(here, None),
            Gone::Wrong(why) => {
                trust::revoke(here.gpu(), self.rendering.settings.cache.as_deref());
                bag.revoke(self.me, &why);
                self.rendering.tell(|told| told.revoked.push(why.clone()));
                return self.report(here, Some(why));
            }
            Gone::Unprovable(why) => {
                bag.leave(self.me);
                without(&why, Instead::Cpu)
            }
            // Who asks for the GPU wants to know that the scene is too much for it, or that the shader is no good.
            Gone::Fault(
                error @ (GpuError::TooMany { .. }
                | GpuError::TooLarge { .. }
                | GpuError::TooManyBuffers { .. }
                | GpuError::Refused { .. }),
            ) => {
                if backend == Backend::Gpu || !bag.leave(self.me) {
                    return bag.fail(error.into());
                }
                without(&error, Instead::Cpu)
            }
            Gone::Fault(error) => {
                let left = without(&error, Instead::Rest);
                if !bag.leave(self.me) {
                    return bag.fail(error.into());
                }
                left
            }
        };
        self.rendering.tell(|told| told.left.push(left.clone()));
        self.report(here, Some(left));
    }

    fn work(&mut self, here: &Here<'_>, sender: Sender<News>, news: &Receiver<News>) -> Gone {
        let rendering = self.rendering;
        let packed = rendering.packed();
        let (found, allowed) = (packed.loop_iterations(), LOOP_ITERATIONS);
        if found > allowed {
            return Gone::Fault(GpuError::TooMany { found, allowed });
        }
        if let (true, Some(reason)) = (rendering.settings.has_gpu_bounds(), packed.unprovable) {
            return Gone::Unprovable(format!("{reason} for f32 with error bounds"));
        }
        let task = DeviceTask {
            packed,
            settings: rendering.settings.clone(),
            jitter: Arc::clone(rendering.jitter),
            width: rendering.width,
            rows: rendering.rows.clone(),
        };
        let (orders, receiver) = channel();
        let heights = Arc::new(Heights::default());
        let line = Line {
            orders: receiver,
            heights: Arc::clone(&heights),
            news: sender,
        };
        match here {
            Here::Opened {
                device, devices, ..
            } => {
                let pixels = rendering.pixels();
                let features = device.features(rendering.settings, &task.packed, pixels);
                let double = features.is_listed().then(Arc::<DoubleStage>::default);
                let (gpu, for_thread) = (Arc::clone(device), double.clone());
                let thread = move || {
                    let used = Use {
                        gpu: &gpu.gpu,
                        compiled: Some(&gpu.compiled),
                        moving: false,
                        canvas: None,
                        double: for_thread.as_deref(),
                        dispatch_seconds: DISPATCH_SECONDS,
                        stop: &|| false,
                    };
                    device_thread::run(&task, used, &line);
                };
                if let Err(error) = devices.spawn("kernels", thread) {
                    rendering.bag.fail(Error::Threads(error.to_string()));
                    return Gone::Done;
                }
                if let Some(double) = &double {
                    let packed = (rendering.packed(), rendering.packed_in_f64());
                    devices.make_double(device, packed, features, Arc::clone(double));
                }
                let gone = self.serve(here, orders, &heights, news, double.as_deref());
                if matches!(gone, Gone::Fault(GpuError::Silent { .. })) {
                    devices.abandon();
                }
                gone
            }
            Here::Live(live) => thread::scope(|scope| {
                let used = Use {
                    gpu: live.gpu,
                    compiled: live.compiled,
                    moving: live.compiled.is_some(),
                    canvas: live.canvas,
                    double: None,
                    dispatch_seconds: live.dispatch_seconds,
                    stop: live.stop,
                };
                let thread = move || device_thread::run(&task, used, &line);
                #[cfg(test)]
                let thread = super::tests::with_faults(thread);
                let started = thread::Builder::new()
                    .name("kernels".into())
                    .spawn_scoped(scope, thread);
                if let Err(error) = started {
                    rendering.bag.fail(Error::Threads(error.to_string()));
                    return Gone::Done;
                }
                self.serve(here, orders, &heights, news, None)
            }),
        }
    }

    /// Orders rows, and finishes what comes. The device's thread ends when nobody can order any more.
    fn serve(
        &mut self,
        here: &Here<'_>,
        orders: Sender<Range<u32>>,
        heights: &Heights,
        news: &Receiver<News>,
        double: Option<&DoubleStage>,
    ) -> Gone {
        let bag = &self.rendering.bag;
        let stop = self.rendering.stop;
        let mut finish = Finish::new(&self.rendering.decider, self.rendering.settings);
        let mut out = 0;
        let mut checked = 0;
        loop {
            while self.ready.is_some() && out < AT_ONCE {
                let [wish, most] =
                    [&heights.wish, &heights.most].map(|h| h.load(Ordering::Relaxed));
                match bag.take(self.me, wish, most, out == 0) {
                    Taken::Rows(rows) => {
                        // Counted in any case: who has rows does not wait for more.
                        out += 1;
                        if orders.send(rows).is_err() {
                            // A thread that has ended says why.
                            break;
                        }
                    }
                    Taken::Later => break,
                    Taken::End if out == 0 => {
                        drop(orders);
                        self.hear_out(news);
                        return Gone::Done;
                    }
                    Taken::End if bag.is_over() => return Gone::Done,
                    Taken::End => break,
                }
            }
            match news.recv_timeout(self.patience) {
                Ok(News::Ready) => {
                    self.ready = Some(Instant::now());
                    bag.ready(self.me);
                }
                Ok(News::Rendered(rendered)) => {
                    out -= 1;
                    self.beside.kernel += rendered.kernel;
                    self.beside.kernel_f64 += rendered.double;
                    self.listed += rendered.listed;
                    let doubtful = rendered.doubtful.len() as u64;
                    let rows = rendered.band.rows.clone();
                    if !bag.wants(&rows) {
                        continue;
                    }
                    let finished = {
                        let _refining = bag.refining();
                        let unwanted = || !bag.wants(&rows);
                        self.rendering.on_threads(|| {
                            finish.band(self.me, *rendered, &mut self.beside, &unwanted)
                        })
                    };
                    match finished {
                        Ok(finished) => {
                            checked += finished.spot_checks;
                            self.refined += doubtful;
                            bag.deliver(finished);
                            self.weigh(double, checked);
                        }
                        Err(Unfinished::Halt(Halt::Stopped)) if stop() => bag.fail(Error::Stopped),
                        // Another worker brought the band meanwhile.
                        Err(Unfinished::Halt(Halt::Stopped)) => {}
                        Err(Unfinished::Halt(halt)) => bag.halt(&rows, halt),
                        Err(Unfinished::Wrong(wrong)) => {
                            return Gone::Wrong(wrong.of(&here.gpu().name));
                        }
                    }
                }
                Ok(News::Ended(Err(error))) => return Gone::Fault(error),
                Ok(News::Ended(Ok(spent))) => {
                    self.thread = spent;
                    if stop() {
                        bag.fail(Error::Stopped);
                        return Gone::Done;
                    }
                    return Gone::Fault(here.gpu().lost(&"its thread ended"));
                }
                Ok(News::Over) => return Gone::Done,
                Ok(News::Found(_)) => {}
                Err(RecvTimeoutError::Timeout) => {
                    return Gone::Fault(GpuError::Silent {
                        adapter: here.gpu().name.clone(),
                        seconds: self.patience.as_secs(),
                    });
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Gone::Fault(here.gpu().lost(&"its thread ended"));
                }
            }
        }
    }

    /// Leaves pixels to the CPU where that decides them in less time: there are GPUs on which f64 takes 64 times what
    /// f32 takes. What the CPU would take is what it takes for those that are left to it, if these are enough to tell:
    /// it decides many at once; else what it takes for one that it checks.
    fn weigh(&self, double: Option<&DoubleStage>, checked: u64) {
        let a_pixel = |seconds: f64, pixels: u64| seconds / pixels.max(1) as f64;
        let device = a_pixel(self.beside.kernel_f64, self.listed);
        let cpu = if self.refined >= WEIGHED {
            a_pixel(self.beside.refine, self.refined)
        } else {
            a_pixel(self.beside.spot_checks, checked)
        };
        if let Some(double) = double
            && self.listed >= WEIGHED
        {
            double.judge(device <= cpu);
        }
    }

    /// Hears what a device's thread did that has nothing left to do.
    fn hear_out(&mut self, news: &Receiver<News>) {
        while let Ok(heard) = news.recv_timeout(LAST_WORDS) {
            if let News::Ended(ended) = heard {
                self.thread = ended.unwrap_or_default();
                return;
            }
        }
    }

    fn report(&self, here: &Here<'_>, left: Option<String>) {
        let wait = self.rendering.bag.activity(self.me).waited.as_secs_f64();
        let life = self.started.elapsed().as_secs_f64();
        let start = self
            .ready
            .map_or(life, |ready| (ready - self.started).as_secs_f64());
        let mut phases = self.thread;
        let mut opening = 0.0;
        if let Here::Opened { phases: before, .. } = here {
            opening = before.sum();
            phases = phases.and(before);
        }
        let seconds = WorkerSeconds {
            start: opening + start,
            work: (life - start - wait).max(0.0),
            wait,
        };
        let report = WorkerReport::new(&here.gpu().name, Some(self.beside), seconds, phases, left);
        self.rendering
            .tell(|told| told.workers.push((self.me, report)));
    }
}

/// How long a device may keep silent that has something to do: its dispatches are made such that they take less than a
/// second, but a large shader may take long to compile.
fn patience() -> Duration {
    #[cfg(test)]
    if let Some(patience) = super::tests::patience() {
        return patience;
    }
    Duration::from_secs(60)
}

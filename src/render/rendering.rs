//! A picture under way: who works on it, and how that ends.
//!
//! The CPU begins at once; devices join when they are open and have compiled the shader. Finished bands go out on the
//! thread that asked for the picture. When the last one has gone out nobody is waited for but who has borrowed
//! something, and those stop at once.

use std::ops::Range;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{self, Scope};
use std::time::Duration;

use super::bag::{Bag, Kind, Role};
use super::cpu_worker;
use super::device_thread::News;
use super::device_worker::{DeviceWorker, Here};
use super::devices::{Devices, Found, Wanted};
use super::report::WorkerReport;
use super::{Backend, Emit, Error, Live, Precision, Settings};
use crate::certify::lanes::Lanes;
use crate::certify::pixels::PixelDecider;
use crate::frame::StopRequested;
use crate::gpu::GpuError;
use crate::gpu::candidates::{is_named, may_be_hardware};
use crate::jitter::Jitter;
use crate::render::install_hint;
use crate::scene::Scene;
use crate::shader::pack::Packed;
use crate::stopwatch::{Phase, Stopwatch};

/// Loading a software driver and compiling a shader there takes about so long: what the CPU has done before then is not
/// worth it.
const STARTING: Duration = Duration::from_millis(100);

/// Everything that workers need to know.
pub(super) struct Rendering<'a> {
    pub(super) scene: &'a Scene,
    pub(super) jitter: &'a Arc<Jitter>,
    pub(super) decider: PixelDecider<'a>,
    /// The threads that the CPU's part runs on, if not all.
    pub(super) pool: Option<&'a rayon::ThreadPool>,
    pub(super) width: u32,
    pub(super) rows: Range<u32>,
    pub(super) settings: &'a Settings,
    /// Whether nobody wants the picture any more.
    pub(super) stop: &'a StopRequested<'a>,
    fewer_threads: OnceLock<Option<rayon::ThreadPool>>,
    packed: OnceLock<Arc<Packed>>,
    lanes: OnceLock<Option<Lanes>>,
    pub(super) bag: Bag,
    /// What is said of workers that left, or never came.
    pub(super) told: Mutex<Told>,
}

/// What is said of workers that left, or never came.
#[derive(Debug, Default)]
pub(super) struct Told {
    /// By their numbers.
    pub(super) workers: Vec<(usize, WorkerReport)>,
    pub(super) left: Vec<String>,
    pub(super) revoked: Option<String>,
    /// The name of an adapter that is software and was left out.
    pub(super) left_out: Option<String>,
}

/// Where devices come from.
#[derive(Clone, Copy)]
pub(super) enum Source<'a> {
    /// They are opened where they are not open yet.
    Devices(&'a Devices),
    /// There is this one.
    Live(&'a Live<'a>),
}

impl<'a> Rendering<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        jitter: &'a Arc<Jitter>,
        decider: PixelDecider<'a>,
        pool: Option<&'a rayon::ThreadPool>,
        stop: &'a StopRequested<'a>,
    ) -> Self {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        Self {
            scene,
            jitter,
            decider,
            pool,
            width,
            bag: Bag::new(width, rows.clone(), settings.band_rows),
            rows,
            settings,
            stop,
            fewer_threads: OnceLock::new(),
            packed: OnceLock::new(),
            lanes: OnceLock::new(),
            told: Mutex::default(),
        }
    }

    /// Runs on the threads that were asked for.
    pub(super) fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs on one thread less: the core is for a driver that is being loaded, or compiles.
    pub(super) fn on_fewer_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let new = || {
            let all = self.on_threads(rayon::current_num_threads);
            let fewer = rayon::ThreadPoolBuilder::new().num_threads(all - 1);
            if all > 1 { fewer.build().ok() } else { None }
        };
        match self.fewer_threads.get_or_init(new) {
            Some(pool) => pool.install(work),
            None => self.on_threads(work),
        }
    }

    /// The scene rounded to f32, for devices and lanes alike.
    pub(super) fn packed(&self) -> Arc<Packed> {
        let pack = || {
            let exact_tracer = self.on_threads(|| self.decider.exact_tracer());
            Arc::new(Packed::prepared(
                exact_tracer.bounded(),
                self.scene,
                self.settings,
            ))
        };
        Arc::clone(self.packed.get_or_init(pack))
    }

    /// What the CPU does eight pixels at once, if it does.
    pub(super) fn lanes(&self) -> Option<&Lanes> {
        let new = || {
            let prepared = self.decider.exact_tracer().bounded();
            Lanes::new(prepared, self.settings, || self.packed())
        };
        self.lanes.get_or_init(|| self.on_threads(new)).as_ref()
    }

    /// Whether the CPU makes the whole scene eight pixels at once. Software uses the same cores, and was never seen to be
    /// quicker then (docs/BENCH.md).
    fn is_quick_on_cpu(&self) -> bool {
        self.lanes().is_some_and(Lanes::are_whole)
    }

    pub(super) fn tell(&self, how: impl FnOnce(&mut Told)) {
        how(&mut self.told.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Whether devices are wanted, and why not if one might expect them to be.
    fn wants_devices(&self) -> Result<bool, Error> {
        let settings = self.settings;
        if settings.backend == Backend::Cpu {
            return Ok(false);
        }
        if settings.precision == Precision::Fast || settings.has_gpu_bounds() {
            return Ok(true);
        }
        if settings.backend == Backend::Gpu {
            return Err(Error::Values);
        }
        let why = "certified values are computed on the CPU, all of them; --precision fast takes the GPU's own f32";
        self.tell(|told| told.left.push(why.into()));
        Ok(false)
    }

    /// Renders. Returns what came of it.
    pub(super) fn run<'s>(
        &'s self,
        source: Source<'s>,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<Told, Error> {
        let (sender, news) = channel();
        let wants_devices = self.wants_devices()?;
        let certified = self.settings.precision == Precision::Certified;
        // Where a device was named, where it alone may make the bytes, or where the CPU is not wanted, it is waited for.
        let waits = self.settings.backend == Backend::Gpu
            || is_named(self.settings.adapter.as_deref())
            || !certified;
        let mut asked = false;
        if let (true, Source::Devices(devices)) = (wants_devices, source)
            && (waits || devices.are_given() || may_be_hardware())
        {
            devices.ask(Wanted::new(self.settings, waits), sender.clone());
            asked = true;
        }
        self.on_threads(|| self.decider.exact_tracer());
        watch.lap(Phase::Prepare);
        let found = match source {
            _ if !wants_devices => Vec::new(),
            Source::Live(live) => vec![Here::Live(live)],
            Source::Devices(devices) if waits => self.found(devices, &news)?,
            Source::Devices(_) => Vec::new(),
        };
        watch.lap(Phase::Devices);
        let cpu = match (&found[..], certified) {
            ([], _) => Some(Role::Works),
            (_, false) => None,
            // A device that was named is helped by the CPU, unless it is the CPU.
            ([Here::Opened { device, .. }], true)
                if self.settings.backend == Backend::Auto && !device.gpu.software =>
            {
                Some(Role::Works)
            }
            (_, true) => Some(Role::StandsBy),
        };
        let over = Mutex::new(vec![sender.clone()]);
        let late = found.is_empty() && wants_devices && !waits;
        let ended = thread::scope(|scope| {
            let crew = Crew {
                rendering: self,
                scope,
                over: &over,
            };
            // First those that others stand by for.
            for here in found {
                crew.device(here, Role::Works);
            }
            if let Some(role) = cpu {
                let worker = self.bag.join(Kind::Cpu, role);
                crew.spawn("cpu", move || cpu_worker::run(self, worker));
            }
            if let (true, Source::Devices(devices)) = (late, source) {
                crew.spawn("devices", move || crew.late(devices, asked, &news, &sender));
            }
            watch.lap(Phase::Threads);
            let ended = self.bag.emit(emit, watch);
            for listener in listeners(&over).drain(..) {
                // Who listens no more has ended.
                let _ = listener.send(News::Over);
            }
            ended
        });
        watch.lap(Phase::Drain);
        ended?;
        let mut told =
            std::mem::take(&mut *self.told.lock().unwrap_or_else(PoisonError::into_inner));
        // Only now is it known which bands went out.
        for (number, worker) in &mut told.workers {
            worker.did(self.bag.activity(*number));
        }
        told.workers
            .retain(|(_, worker)| worker.is_device() || worker.bands > 0);
        Ok(told)
    }

    /// The devices that were waited for; none where the CPU will do.
    fn found<'s>(
        &self,
        devices: &'s Devices,
        news: &Receiver<News>,
    ) -> Result<Vec<Here<'s>>, Error> {
        let found = match news.recv() {
            Ok(News::Found(found)) => found,
            // The thread that finds devices could not be started.
            _ => Found::None(GpuError::NoAdapter),
        };
        let any_tracer = self.settings.backend == Backend::Auto;
        match found {
            Found::Devices(found, phases) => {
                let mut here = Vec::new();
                for device in found {
                    match device {
                        Ok(device) => here.push(Here::Opened {
                            device,
                            phases,
                            devices,
                        }),
                        Err(error)
                            if any_tracer && !matches!(error, GpuError::NoSuchAdapter { .. }) =>
                        {
                            self.tell(|told| told.left.push(format!("{error}; the CPU renders")));
                        }
                        Err(error) => return Err(error.into()),
                    }
                }
                if self.settings.precision == Precision::Fast {
                    here.truncate(1);
                }
                Ok(here)
            }
            // Without any GPU the CPU gives the same picture; a GPU that was named has to be there.
            Found::None(error @ GpuError::NoAdapter) if any_tracer => {
                let hint = install_hint();
                self.tell(|told| {
                    told.left
                        .push(format!("{error}, so the CPU renders; {hint}"))
                });
                Ok(Vec::new())
            }
            Found::None(error) => Err(error.into()),
            Found::Software(_) => Ok(Vec::new()),
        }
    }
}

/// Who wants to hear that a rendering is over.
type Listeners = Mutex<Vec<Sender<News>>>;

fn listeners(over: &Listeners) -> MutexGuard<'_, Vec<Sender<News>>> {
    over.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The threads of a rendering.
#[derive(Clone, Copy)]
struct Crew<'scope, 'env, 'r> {
    rendering: &'env Rendering<'r>,
    scope: &'scope Scope<'scope, 'env>,
    over: &'env Listeners,
}

impl<'scope, 'env: 'scope, 'r: 'env> Crew<'scope, 'env, 'r> {
    /// Starts a thread; if that cannot be, the rendering ends.
    fn spawn(self, name: &str, work: impl FnOnce() + Send + 'scope) {
        #[cfg(test)]
        let work = super::tests::with_faults(work);
        let started = thread::Builder::new()
            .name(name.into())
            .spawn_scoped(self.scope, work);
        if let Err(error) = started {
            self.rendering.bag.fail(Error::Threads(error.to_string()));
        }
    }

    /// Lets a device work.
    fn device(self, here: Here<'env>, role: Role) {
        let (sender, news) = channel();
        listeners(self.over).push(sender.clone());
        // It may have ended before that listener was there to hear it.
        if self.rendering.bag.is_over() {
            return;
        }
        let number = self.rendering.bag.join(Kind::Device, role);
        let worker = DeviceWorker::new(self.rendering, number);
        self.spawn("device", move || worker.run(&here, sender, &news));
    }

    /// Waits for devices while the CPU works already, and lets them work.
    fn late(
        self,
        devices: &'env Devices,
        asked: bool,
        news: &Receiver<News>,
        sender: &Sender<News>,
    ) {
        let settings = self.rendering.settings;
        let bag = &self.rendering.bag;
        let ask_for_software = || {
            bag.expect(true);
            devices.ask(Wanted::new(settings, true), sender.clone());
        };
        if !asked {
            if self.rendering.is_quick_on_cpu() || !bag.lasts(STARTING) {
                return;
            }
            ask_for_software();
        }
        while let Ok(News::Found(found)) = news.recv() {
            match found {
                Found::Devices(devices_found, phases) => {
                    for device in devices_found {
                        match device {
                            Ok(device)
                                if device.gpu.software && self.rendering.is_quick_on_cpu() =>
                            {
                                self.rendering
                                    .tell(|told| told.left_out = Some(device.gpu.name.clone()));
                            }
                            Ok(device) => {
                                let role = if device.gpu.software {
                                    Role::OnTrial
                                } else {
                                    Role::Works
                                };
                                self.device(
                                    Here::Opened {
                                        device,
                                        phases,
                                        devices,
                                    },
                                    role,
                                );
                            }
                            Err(error) => {
                                bag.expect(false);
                                self.rendering.tell(|told| {
                                    told.left.push(format!("{error}; the CPU renders"))
                                });
                            }
                        }
                    }
                    return;
                }
                Found::Software(name) if self.rendering.is_quick_on_cpu() => {
                    self.rendering.tell(|told| told.left_out = Some(name));
                    return;
                }
                Found::Software(_) if !bag.lasts(STARTING) => return,
                Found::Software(_) => ask_for_software(),
                // That there is none is nothing to talk about: the CPU makes the same picture.
                Found::None(_) => return bag.expect(false),
            }
        }
    }
}

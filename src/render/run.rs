//! A rendering from its start to its end: who works on it, what goes out, what is told.
//!
//! The CPU begins at once; devices join when they are open and have compiled the shader. Finished bands go out on the
//! thread that asked for the picture. When the last one has gone out nobody is waited for but who has borrowed
//! something, and those stop at once.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::bag::{Kind, Role};
use super::cpu_worker;
use super::crew::{Crew, Over, RESTING, STARTING};
use super::device_thread::News;
use super::device_worker::Here;
use super::devices::{Devices, Found, Wanted};
use super::rendering::Rendering;
use super::report::{Instead, Told, without};
use super::turns::Turn;
use super::{Backend, Band, Emit, Error, Live, Precision, install_hint};
use crate::gpu::GpuError;
use crate::gpu::candidates::{is_named, may_be_hardware};
use crate::gpu::device::Gpu;
use crate::stopwatch::{Phase, Stopwatch};

/// Where devices come from.
#[derive(Clone, Copy)]
pub(super) enum Source<'a> {
    /// They are opened where they are not open yet.
    Devices(&'a Devices),
    /// There is this one.
    Live(&'a Live<'a>),
}

impl Rendering<'_> {
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

    /// Whether the CPU renders although there is this device: it is software, nobody named it, and the CPU makes the
    /// picture quicker.
    fn leaves_out(&self, gpu: &Gpu) -> bool {
        gpu.software
            && self.settings.backend == Backend::Auto
            && !is_named(self.settings.adapter.as_deref())
            && self.is_quick_on_cpu()
    }

    /// What can be done for a picture while another one is rendered: packing the scene, and compiling its shader for
    /// the devices that are open and will work on it.
    fn prepare_ahead(&self, source: Source<'_>, wants_devices: bool) {
        self.lanes();
        if let (true, Source::Devices(devices)) = (wants_devices, source) {
            let packed = self.packed();
            if packed.unprovable.is_none() || !self.settings.has_gpu_bounds() {
                let software = self.settings.backend == Backend::Gpu;
                devices.compile_ahead(&packed, self.settings, self.pixels(), software);
            }
        }
    }

    /// Asks for devices that use the same cores, while the CPU works on fewer of them.
    pub(super) fn ask_for_software(&self, devices: &Devices, sender: &Sender<News>) {
        self.bag.expect(Some(self.share_of_fewer_threads()));
        devices.ask(
            Wanted::new(self.settings, true),
            News::of_devices(sender.clone()),
        );
    }

    /// Renders. Returns what came of it.
    pub(super) fn run<'s>(
        &'s self,
        source: Source<'s>,
        turn: Option<&Turn<'_>>,
        emit: &mut Emit<'_>,
        watch: &mut Stopwatch,
    ) -> Result<Told, Error> {
        let (sender, news) = channel();
        let wants_devices = self.wants_devices()?;
        let certified = self.settings.precision == Precision::Certified;
        // Where a device was named, where it alone may make the bytes, or where the CPU is not wanted, it is waited
        // for.
        let waits = self.settings.backend == Backend::Gpu
            || is_named(self.settings.adapter.as_deref())
            || !certified;
        let mut asked = false;
        if let (true, Source::Devices(devices)) = (wants_devices, source)
            && (waits || devices.are_given() || may_be_hardware())
        {
            let wanted = Wanted::new(self.settings, waits);
            devices.ask(wanted, News::of_devices(sender.clone()));
            asked = true;
        }
        self.on_threads(|| self.decider.exact_tracer());
        watch.lap(Phase::Prepare);
        if let Some(turn) = turn {
            self.prepare_ahead(source, wants_devices);
            watch.lap(Phase::Pack);
            turn.wait();
            watch.lap(Phase::Held);
        }
        let found = match source {
            _ if !wants_devices => Vec::new(),
            Source::Live(live) if self.leaves_out(live.gpu) => {
                self.tell(|told| told.left_out = Some(live.gpu.name.clone()));
                Vec::new()
            }
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
        // Where there is software alone, it is asked for before the CPU has all cores, if it seems to be worth it.
        if let (true, false, Source::Devices(devices)) = (late, asked, source)
            && !self.is_quick_on_cpu()
        {
            let speed = self.tried_speed();
            let pixels = self.width as f64 * self.rows.len() as f64;
            if pixels / speed > STARTING.as_secs_f64() {
                self.ask_for_software(devices, &sender);
                self.bag.rest(RESTING, speed);
                asked = true;
            }
        }
        let ended = thread::scope(|scope| {
            let crew = Crew::new(self, scope, &over);
            // Whatever comes of it, all hear that it is over.
            let _over = Over::of(&self.bag, &over);
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
            let emit = &mut |band: &Band| {
                if let Some(turn) = turn.filter(|_| self.bag.is_made()) {
                    turn.pass();
                }
                emit(band)
            };
            self.bag.emit(emit, watch)
        });
        watch.lap(Phase::Drain);
        ended?;
        // A device may be found to be wrong by a band that another one brought, when the last one has gone out.
        if let Some(error) = self.bag.doubt() {
            return Err(error);
        }
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
            _ => Found::None(GpuError::NoAdapter),
        };
        let any_tracer = self.settings.backend == Backend::Auto;
        match found {
            Found::Devices(found, phases) => {
                let (mut here, mut not_here) = (Vec::new(), Vec::new());
                for device in found {
                    match device {
                        Ok(device) => here.push(Here::Opened {
                            device,
                            phases,
                            devices,
                        }),
                        Err(error) => not_here.push(error),
                    }
                }
                // Who asks for the GPU, and has several, may do with one of them.
                let others = !here.is_empty();
                for error in not_here {
                    if !any_tracer && !others {
                        return Err(error.into());
                    }
                    let instead = if others {
                        Instead::Devices
                    } else {
                        Instead::Cpu
                    };
                    self.tell(|told| told.left.push(without(&error, instead)));
                }
                if self.settings.precision == Precision::Fast {
                    here.truncate(1);
                }
                Ok(here)
            }
            // Without any GPU the CPU gives the same picture; a GPU that was named has to be there.
            Found::None(error @ GpuError::NoAdapter) if any_tracer => {
                let hint = install_hint();
                let why = without(&error, Instead::Cpu);
                self.tell(|told| told.left.push(format!("{why}; {hint}")));
                Ok(Vec::new())
            }
            Found::None(error) => Err(error.into()),
            Found::Software(_) => Ok(Vec::new()),
        }
    }
}

//! The devices of a process: opened in a thread of their own where they are first asked for, tried out, and kept with
//! the shaders that they compiled, for as many pictures as there are.
//!
//! Loading a driver takes longer than many a picture, so nobody waits for it who has something else to do.

use std::panic::{self, AssertUnwindSafe};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};

use crate::certify::trust;
use crate::gpu::GpuError;
use crate::gpu::adapters;
use crate::gpu::candidates::{Candidates, candidates};
use crate::gpu::device::Gpu;
use crate::gpu::double::DoubleStage;
use crate::gpu::pipeline::Compiled;
use crate::settings::{Precision, Settings};
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::format::Double;
use crate::shader::pack::Packed;
use crate::stopwatch::{Phase, Phases, Stopwatch};

/// A device that is open, and the shaders that it compiled lately.
#[derive(Debug)]
pub(super) struct Device {
    pub(super) gpu: Arc<Gpu>,
    pub(super) compiled: Compiled,
    /// Whether it is trusted with f64, once that was asked.
    doubles: OnceLock<bool>,
}

/// Scenes of more objects have no stage in f64: preparing them in pairs of f64 takes longer than it spares, since
/// little of them is in doubt.
const MOST_DOUBLED: usize = 4096;
/// Nor have pictures of fewer samples: compiling its shader takes longer than the CPU does for their doubts.
const LEAST_DOUBLED: u64 = 1 << 20;

impl Device {
    fn new(gpu: Arc<Gpu>) -> Arc<Self> {
        Arc::new(Self {
            gpu,
            compiled: Compiled::default(),
            doubles: OnceLock::new(),
        })
    }

    /// Whether it decides in f64 what f32 leaves open of such a picture, of so many pixels.
    fn doubles(&self, settings: &Settings, packed: &Packed, pixels: u64) -> bool {
        settings.has_gpu_bounds()
            && pixels.saturating_mul(settings.samples.into()) >= LEAST_DOUBLED
            && packed.objects.len() <= MOST_DOUBLED
            && *self
                .doubles
                .get_or_init(|| trust::has_doubles(&self.gpu, settings.cache.as_deref()))
    }

    /// What the shader of such a picture needs here.
    pub(super) fn features(&self, settings: &Settings, packed: &Packed, pixels: u64) -> FeatureSet {
        let features = FeatureSet::new(packed, settings, self.gpu.lanes);
        let features = features.for_a_file(self.gpu.software);
        if self.doubles(settings, packed, pixels) {
            features.with_a_list()
        } else {
            features
        }
    }
}

/// The devices that are open, or will be. When it is dropped, it waits for the threads that use them: a process that is
/// to end without waiting has to [forget](std::mem::forget) it, and to end in a way that runs nobody's destructors.
#[derive(Debug, Default)]
pub struct Devices {
    open: Arc<Mutex<Vec<Arc<Device>>>>,
    /// Whether only these are used, and no adapters looked for.
    given: bool,
    threads: Mutex<Vec<JoinHandle<()>>>,
}

/// What devices a picture asks for.
#[derive(Debug, Clone)]
pub(super) struct Wanted {
    adapter: Option<String>,
    /// Whether software will do.
    pub(super) software: bool,
    certified: bool,
    cache: Option<PathBuf>,
}

impl Wanted {
    pub(super) fn new(settings: &Settings, software: bool) -> Self {
        Self {
            adapter: settings.adapter.clone(),
            software,
            certified: settings.precision == Precision::Certified,
            cache: settings.cache.clone(),
        }
    }
}

/// What came of asking for devices.
#[derive(Debug)]
pub(super) enum Found {
    /// Each adapter, opened and trusted, or why not; and what that took.
    Devices(Vec<Result<Arc<Device>, GpuError>>, Phases),
    /// There is software only, called this, and it was not asked for.
    Software(String),
    /// No adapter, or not the one that was named.
    None(GpuError),
}

impl Devices {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// These, which are open, and no others.
    pub fn of(gpus: Vec<Gpu>) -> Self {
        let devices = gpus.into_iter().map(|gpu| Device::new(Arc::new(gpu)));
        Self {
            open: Arc::new(Mutex::new(devices.collect())),
            given: true,
            threads: Mutex::default(),
        }
    }

    /// Whether only those are used that were given, so that no driver has to be loaded.
    pub(super) fn are_given(&self) -> bool {
        self.given
    }

    /// Asks for devices, and returns at once; `tell` hears what came of it, on another thread as a rule.
    pub(super) fn ask(&self, wanted: Wanted, tell: impl Fn(Found) + Clone + Send + 'static) {
        let (open, given) = (Arc::clone(&self.open), self.given);
        let told = tell.clone();
        let answer = move || {
            // Drivers panic now and then, and somebody waits for this.
            let found = panic::catch_unwind(AssertUnwindSafe(|| find(&open, given, &wanted)));
            let found = found.unwrap_or(Found::None(GpuError::NoAdapter));
            told(found);
        };
        // If there can be no thread, there can be no device either.
        if self.spawn("devices", answer).is_err() {
            tell(Found::None(GpuError::NoAdapter));
        }
    }

    /// Compiles the shader of a picture that is to come, for the devices that are open now: those on software too, if
    /// asked for.
    pub(super) fn compile_ahead(
        &self,
        packed: &Packed,
        settings: &Settings,
        pixels: u64,
        software: bool,
    ) {
        // Where devices are being opened, they are not open yet.
        let Ok(open) = self.open.try_lock().map(|open| open.clone()) else {
            return;
        };
        for device in open {
            let gpu = &device.gpu;
            if software || !gpu.software {
                let features = device.features(settings, packed, pixels);
                // If this fails, so will compiling it when it is wanted, and that is told.
                let _ = device
                    .compiled
                    .get(gpu, &compose(packed, &features, Entry::Picture));
            }
        }
    }

    /// Has the stage in f64 made for a scene in both formats, while the device is at work without it.
    pub(super) fn make_double(
        &self,
        device: &Arc<Device>,
        (single, in_f64): (Arc<Packed>, Packed<Double>),
        features: FeatureSet,
        double: Arc<DoubleStage>,
    ) {
        let device = Arc::clone(device);
        let make = move || {
            if let Err(error) = double.make(&device.gpu, (&single, &in_f64), features) {
                log::info!("{} makes no pixels in f64: {error}", device.gpu.name);
            }
        };
        // Without it the CPU decides what it would have decided.
        let _ = self.spawn("f64", make);
    }

    /// Starts a thread that is waited for only when this is dropped.
    pub(super) fn spawn(
        &self,
        name: &str,
        work: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<()> {
        #[cfg(test)]
        let work = super::tests::with_faults(work);
        let thread = thread::Builder::new().name(name.into()).spawn(work)?;
        let mut threads = self.threads.lock().unwrap_or_else(PoisonError::into_inner);
        threads.retain(|thread| !thread.is_finished());
        threads.push(thread);
        Ok(())
    }

    /// The process goes on without these threads: one of them does not answer.
    pub(super) fn abandon(&self) {
        self.threads
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clear();
    }
}

impl Drop for Devices {
    fn drop(&mut self) {
        let threads = self
            .threads
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        for thread in threads.drain(..) {
            // What a thread had to say it said.
            let _ = thread.join();
        }
    }
}

/// Finds adapters, opens those that are not open yet, and tries them out.
fn find(open: &Mutex<Vec<Arc<Device>>>, given: bool, wanted: &Wanted) -> Found {
    let mut watch = Stopwatch::start();
    // Whoever else asks waits: devices are opened once.
    let mut open = open.lock().unwrap_or_else(PoisonError::into_inner);
    let opened: Vec<Result<Arc<Device>, GpuError>> = if given {
        open.iter().map(|device| Ok(Arc::clone(device))).collect()
    } else {
        let adapters = match candidates(wanted.adapter.as_deref(), wanted.software) {
            Ok(Candidates::Adapters(adapters)) => adapters,
            Ok(Candidates::Software(name)) => return Found::Software(name),
            Err(error) => return Found::None(error),
        };
        watch.lap(Phase::Instance);
        // What went wrong with a device does not pass.
        open.retain(|device| device.gpu.check().is_ok());
        let opened = adapters.iter().map(|adapter| {
            let gpu = adapters::shared_on(adapter)?;
            let known = open.iter().find(|device| Arc::ptr_eq(&device.gpu, &gpu));
            Ok(known.cloned().unwrap_or_else(|| {
                let device = Device::new(gpu);
                open.push(Arc::clone(&device));
                device
            }))
        });
        opened.collect()
    };
    drop(open);
    watch.lap(Phase::Device);
    let tested = opened.into_iter().map(|device| match device {
        Ok(device) if wanted.certified => {
            trust::check(&device.gpu, wanted.cache.as_deref()).map(|()| device)
        }
        device => device,
    });
    let tested = tested.collect();
    watch.lap(Phase::Selftest);
    Found::Devices(tested, watch.phases())
}

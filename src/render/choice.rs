//! Which tracer renders: the GPU if it is welcome, there, and trusted; else the CPU.

use std::borrow::Borrow;

use super::{Error, install_hint};
use crate::certify::trust;
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::settings::{Backend, Precision, Settings};
use crate::stopwatch::{Phase, Stopwatch};

/// Which tracer renders.
pub(super) enum Choice<G> {
    /// The GPU, with this.
    Gpu(G),
    /// The CPU; and why, if the GPU would have been welcome.
    Cpu(Option<String>),
}

/// Chooses; `open` is called for the device if the GPU is welcome.
pub(super) fn choose<G: Borrow<Gpu>>(
    settings: &Settings,
    watch: &mut Stopwatch,
    open: impl FnOnce(&mut Stopwatch) -> Result<G, GpuError>,
) -> Result<Choice<G>, Error> {
    if settings.backend == Backend::Cpu {
        return Ok(Choice::Cpu(None));
    }
    let certified = settings.precision == Precision::Certified;
    if certified && !settings.has_gpu_bounds() {
        if settings.backend == Backend::Gpu {
            return Err(Error::Values);
        }
        let why = "certified values are computed on the CPU, all of them; --precision fast takes the GPU's own f32";
        return Ok(Choice::Cpu(Some(why.into())));
    }
    let opened = open(watch);
    let tested = opened.and_then(|opened| {
        if certified {
            trusted(opened, settings)
        } else {
            Ok(opened)
        }
    });
    watch.lap(Phase::Selftest);
    match tested {
        Ok(opened) => Ok(Choice::Gpu(opened)),
        Err(error @ GpuError::Untrusted { .. }) if settings.backend == Backend::Auto => {
            Ok(Choice::Cpu(Some(format!("{error}; the CPU renders"))))
        }
        // Without any GPU the CPU gives the same picture; a GPU that was named has to be there.
        Err(GpuError::NoAdapter) if settings.backend == Backend::Auto => {
            let (error, hint) = (GpuError::NoAdapter, install_hint());
            let why = format!("{error}, so the CPU renders; {hint}");
            Ok(Choice::Cpu(Some(why)))
        }
        // What does not open has its driver, and the reason is in the error.
        Err(error @ GpuError::Device { .. }) if settings.backend == Backend::Auto => {
            Ok(Choice::Cpu(Some(format!("{error}; the CPU renders"))))
        }
        Err(error) => Err(error.into()),
    }
}

/// The device, if it passed the self-test.
fn trusted<G: Borrow<Gpu>>(opened: G, settings: &Settings) -> Result<G, GpuError> {
    let gpu: &Gpu = opened.borrow();
    match trust::doubts(gpu, settings.cache.as_deref()) {
        None => Ok(opened),
        Some(failures) => Err(GpuError::Untrusted {
            adapter: gpu.name.clone(),
            failures,
        }),
    }
}

//! The GPU: the only code that knows wgpu.
//!
//! [`adapters`] finds an adapter, [`candidates`] those that may make a picture together, [`device`] opens it,
//! [`pipeline`] compiles the shader that [`shader`](crate::shader) composed and binds the scene to it, [`bands`] runs
//! the frame in rectangles bounded in memory and time; [`selftest`] tries out a device before it is trusted. [`canvas`]
//! holds a picture that a window shows, [`single`] asks for one pixel.

pub mod adapters;
pub mod bands;
pub mod candidates;
pub mod canvas;
pub mod device;
pub mod double;
pub mod pipeline;
pub mod selftest;
pub mod single;
pub mod submit_gate;

/// What can go wrong on the way to or on the GPU.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No adapter at all.
    #[error("no GPU adapter found")]
    NoAdapter,
    /// None whose name holds what `--adapter` or the environment asks for.
    #[error("no GPU adapter's name contains `{wanted}`, as {asker} asks; there {}: {}",
        if .found.len() == 1 { "is" } else { "are" }, .found.join(", "))]
    NoSuchAdapter {
        /// What was asked for.
        wanted: String,
        /// By what: `--adapter`, or the environment's variable.
        asker: &'static str,
        /// The adapters that there are.
        found: Vec<String>,
    },
    /// The adapter would not open.
    #[error("{adapter} cannot be opened: {reason}")]
    Device {
        /// Its name.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
    /// A buffer that the scene needs is larger than the adapter allows.
    #[error("the scene's {what} take {needed} bytes in one buffer, and {adapter} allows {allowed}")]
    TooLarge {
        /// Which records.
        what: &'static str,
        /// How large they are.
        needed: u64,
        /// How large they may be.
        allowed: u64,
        /// Name of the adapter.
        adapter: String,
    },
    /// The scene needs more buffers at once than the adapter allows.
    #[error("the scene needs {needed} buffers at once, and {adapter} allows {allowed}")]
    TooManyBuffers {
        /// How many it needs.
        needed: u32,
        /// How many there may be.
        allowed: u32,
        /// Name of the adapter.
        adapter: String,
    },
    /// More objects than the loops of the shader are sure to reach.
    #[error(
        "the scene has {found} planes and spheres to go through one by one, and a shader's loops are sure to \
         reach {allowed} only"
    )]
    TooMany {
        /// Objects that a loop would ask.
        found: usize,
        /// Objects that it may.
        allowed: usize,
    },
    /// The device computes otherwise than the certified path takes for granted.
    #[error(
        "{adapter} does not compute as WGSL asks, so nothing it says can be certified ({failures}); \
         --precision fast takes it as it comes"
    )]
    Untrusted {
        /// Name of the adapter.
        adapter: String,
        /// What it got wrong.
        failures: String,
    },
    /// The device ran out of memory.
    #[error("{adapter} is out of memory: {reason}")]
    OutOfMemory {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
    /// wgpu or the driver refused something of ours.
    #[error("{adapter} refused the rendering: {reason}")]
    Refused {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
    /// The device does not answer.
    #[error("{adapter} has not answered for {seconds} s")]
    Silent {
        /// Name of the adapter.
        adapter: String,
        /// How long it was waited for.
        seconds: u64,
    },
    /// The device was lost while rendering.
    #[error("{adapter} was lost while rendering ({reason}); a driver reset, most likely")]
    Lost {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
}

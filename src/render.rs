//! One picture, band after band: chooses the tracer (GPU or CPU), runs it over the rows, hands each finished band on.
//!
//! Stands between the tracers (`gpu`, `cpu`) and what takes the rows (`image`, the preview, a test).

use std::io;
use std::ops::Range;

use serde::Serialize;

/// What to render, beyond what the scene says.
#[derive(Debug, Clone)]
pub struct Settings {
    /// The rows to render, half-open, counted from the bottom; all without.
    pub rows: Option<Range<u32>>,
    /// τ: a hit on a plane counts only where its z is ≤ this; 0 in the notes.
    pub screen_tolerance: f64,
    /// Which tracer.
    pub backend: Backend,
    /// Part of the name of the adapter to use, in any case of letters.
    pub adapter: Option<String>,
    /// CPU threads; all cores without.
    pub threads: Option<usize>,
    /// Whether bands carry the unquantised values too (for EXR).
    pub values: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { rows: None, screen_tolerance: 0.0, backend: Backend::Auto, adapter: None, threads: None, values: false }
    }
}

/// Which tracer renders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU if there is one, else the CPU.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The CPU.
    Cpu,
}

/// Finished rows, on their way into a picture. Bands come from the top of the picture downwards, without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Which rows, counted from the bottom.
    pub rows: Range<u32>,
    /// Red, green, blue of every pixel, the band's top row first: 3 · width · rows bytes.
    pub rgb: Vec<u8>,
    /// The values before quantising (1.0 is byte 255), in the same order, if they were asked for.
    pub values: Option<Vec<[f32; 3]>>,
}

/// Takes finished bands; an error ends the rendering.
pub type Emit<'a> = dyn FnMut(&Band) -> io::Result<()> + Send + 'a;

/// How a rendering went: what `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The rows rendered, from the bottom, half-open.
    pub rows: [u32; 2],
    /// The screen tolerance τ.
    pub screen_tolerance: f64,
    /// Which tracer rendered: `gpu` or `cpu`.
    pub backend: Backend,
    /// Adapter and driver, if the GPU rendered.
    pub adapter: Option<String>,
    /// Why the CPU rendered although the GPU was welcome.
    pub fallback: Option<String>,
    /// CPU threads used, if the CPU rendered.
    pub threads: Option<usize>,
    /// Number of bands.
    pub bands: u32,
    /// Where the time went.
    pub seconds: Seconds,
}

/// Where the time of a rendering went, in seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// Loading the driver and listing adapters.
    pub instance: f64,
    /// Opening the device.
    pub device: f64,
    /// Composing and compiling the shader.
    pub compile: f64,
    /// Packing and uploading the scene.
    pub upload: f64,
    /// Kernel time: from timestamps on the GPU where it has them, else as seen from the host.
    pub kernel: f64,
    /// Copying pictures back and waiting for them, the kernel's own time apart.
    pub readback: f64,
    /// Handing bands on: quantising, encoding, writing.
    pub emit: f64,
    /// All of the above and what lies between.
    pub total: f64,
}

//! The ways to render a scene that are compared.

use serde::Serialize;

/// A way to render a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    /// The GPU, and the CPU for what the GPU is not sure of: `plumb render`.
    GpuCertified,
    /// The GPU's f32 as it comes: `plumb render --precision fast`.
    GpuFast,
    /// f64 with error bounds, exact numbers where these leave something open: `plumb render --backend cpu`. The truth.
    CpuCertified,
    /// The same tracer in f64, without bounds.
    CpuPlain,
    /// f32 on the GPU as in a textbook, with what depends on the scene alone prepared in f64: spheres by b² − 4ac.
    F32Quadratic,
    /// The same with nothing prepared: f32 from the scene's own numbers to the picture.
    F32Naive,
}

impl Way {
    /// All, in the order of the report.
    pub const ALL: [Self; 6] = [
        Self::GpuCertified,
        Self::GpuFast,
        Self::CpuCertified,
        Self::CpuPlain,
        Self::F32Quadratic,
        Self::F32Naive,
    ];

    /// The name in tables and plots.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::GpuCertified => "GPU certified",
            Self::GpuFast => "GPU fast",
            Self::CpuCertified => "CPU certified",
            Self::CpuPlain => "CPU plain f64",
            Self::F32Quadratic => "f32 b²−4ac",
            Self::F32Naive => "f32 naive",
        }
    }

    /// What it is, in a line.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::GpuCertified => {
                "plumb render: f32 with error bounds, the CPU for the doubtful pixels"
            }
            Self::GpuFast => "plumb render --precision fast: the GPU's f32 as it comes",
            Self::CpuCertified => {
                "plumb render --backend cpu: f64 with error bounds, in the end exact; the truth"
            }
            Self::CpuPlain => "the same tracer in f64 without bounds; for comparison only",
            Self::F32Quadratic => {
                "a textbook's shader, prepared in f64 on the host; spheres by b²−4ac"
            }
            Self::F32Naive => "a textbook's shader, f32 from the scene's numbers on",
        }
    }

    /// Whether it runs on the GPU.
    #[must_use]
    pub fn is_on_gpu(self) -> bool {
        !matches!(self, Self::CpuCertified | Self::CpuPlain)
    }

    /// The options of `plumb render` that render this way; none where nothing does.
    #[must_use]
    pub fn options(self) -> Option<&'static [&'static str]> {
        match self {
            Self::GpuCertified => Some(&["--backend", "gpu"]),
            Self::GpuFast => Some(&["--backend", "gpu", "--precision", "fast"]),
            Self::CpuCertified => Some(&["--backend", "cpu"]),
            Self::CpuPlain | Self::F32Quadratic | Self::F32Naive => None,
        }
    }
}

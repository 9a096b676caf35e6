//! The options that several subcommands share; what their values may be is in `values`.

use std::path::PathBuf;
use std::thread;

use anyhow::{Result, bail};
use clap::ValueEnum;
use clap::builder::NonEmptyStringValueParser;
use plumb::cpu::debug::Shown;
use plumb::cpu::trace::Limits;
use plumb::image::Target;
use plumb::render::{Backend, Precision, SamplePattern, Settings};
use plumb::scene::Scene;
use plumb::settings::MAX_SAMPLES;

use super::cache;
use super::values::{Rows, path, rows, size, threads, tolerance, whole};

/// What changes which picture a scene is.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct PictureOptions {
    /// Columns and rows of the picture, in place of the scene's pixeldim
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Planes count only where z ≤ T: 0 in the notes, 0.01 in the course's final program
    #[arg(long, value_name = "T", default_value_t = 0.0, value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) screen_tolerance: f64,
    /// Samples a pixel: 1 ray through its middle, or N spread over it, whose mean is taken (smooth edges)
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = whole(1..=MAX_SAMPLES),
        long_help = "\
Samples a pixel, 1 to 65536. 1 is a ray through its middle; N are N rays spread over it, and the mean of their colours \
is taken, which smooths edges and takes N times as long. 16 is plenty for most pictures. Where a floor or wall runs \
through the screen's edge, the samples beyond it meet nothing: \
put it a little farther out, or give --screen-tolerance."
    )]
    pub(crate) samples: u32,
    /// How several samples are spread: by a hash, or as the course's program did
    #[arg(
        long,
        value_name = "SPREAD",
        value_enum,
        ignore_case = true,
        default_value_t
    )]
    pub(crate) jitter: JitterName,
    /// Mirror images and what is seen through things end where the path from the viewpoint is longer than D
    #[arg(
        long,
        value_name = "D",
        default_value_t = Limits::default().max_path,
        value_parser = path,
        allow_negative_numbers = true,
        long_help = "\
Mirror images and what is seen through transparent things end where the path from the viewpoint, in world units along \
the rays, is longer than D. 0 shows neither; the first ray is as long as it takes. It matters only in scenes with \
lights."
    )]
    pub(crate) max_path: f64,
    /// A sample that needs more rays than N is an error: mirrors and transparent things multiply them
    #[arg(
        long,
        value_name = "N",
        default_value_t = Limits::default().max_rays,
        value_parser = whole(1..=u32::MAX),
        long_help = "\
A sample that needs more rays than N is an error that names its pixel, and no picture is made: where something is a \
mirror and transparent too, every ray that meets it becomes two, and such a tree can have millions. Shadow rays do not \
count. A smaller --max-path makes the tree smaller; `plumb probe` shows it."
    )]
    pub(crate) max_rays: u32,
}

impl PictureOptions {
    /// Puts the size into the scene.
    pub(crate) fn apply(&self, scene: &mut Scene) {
        if let Some(size) = self.size {
            scene.camera.pixeldim = size;
        }
    }

    /// Settings with these options, everything else as it is without options.
    pub(crate) fn settings(&self) -> Settings {
        Settings {
            screen_tolerance: self.screen_tolerance,
            samples: self.samples,
            jitter: self.jitter.into(),
            limits: self.limits(),
            ..Settings::default()
        }
    }

    /// How far rays are followed.
    pub(crate) fn limits(&self) -> Limits {
        Limits {
            max_path: self.max_path,
            max_rays: self.max_rays,
            ..Limits::default()
        }
    }

    /// Refuses what would take memory without end; `scene` has its final size.
    pub(crate) fn check(&self, scene: &Scene) -> Result<()> {
        match self.settings().fault(scene.camera.pixeldim[0]) {
            Some(fault) => bail!(fault),
            None => Ok(()),
        }
    }
}

/// Everything that `plumb render` and the filter use share.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct RenderOptions {
    /// The picture, by its ending .ppm, .png or .exr (EXR: the values before quantising); `-` is stdout, as PPM
    #[arg(
        short,
        long,
        value_name = "OUT",
        long_help = "\
The picture, by its ending .ppm, .png or .exr (EXR holds the values before quantising); `-` is stdout, as PPM.

Each {} in the name stands for the scene's own, without its folder and ending: 'out/{}.png'. A folder, which has to be \
there, takes the scene's name with .ppm. Of several scenes stdout takes one picture after the other, in the order of \
the scenes; two that would be one file are refused before anything is rendered.

Without it: the scene's name with .ppm, in the current folder; stdout if the scene comes from stdin. A regular file is \
written beside and renamed when it is whole; devices, pipes and links are written through."
    )]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureOptions,
    /// Only rows A up to, not including, B, counted from the bottom: 0..100, ..100, 380.. (the picture has B−A rows)
    #[arg(long, value_name = "A..B", value_parser = rows)]
    pub(crate) rows: Option<Rows>,
    /// Who makes the picture: whoever is there (auto); GPUs, or an error; the CPU
    #[arg(
        long,
        value_name = "TRACER",
        value_enum,
        ignore_case = true,
        default_value_t,
        long_help = "\
Who makes the picture. It changes no byte.

auto: the CPU begins at once, every GPU joins as soon as its driver is loaded, and they share the picture. A driver \
that is software, such as lavapipe or SwiftShader, uses the CPU's cores: it takes part only where it is the quicker of \
the two.

gpu: GPUs alone, software too, or an error where there is none; what they are not sure of the CPU decides, and it goes \
on where they fail.

cpu: the CPU alone; no driver is loaded."
    )]
    pub(crate) backend: BackendName,
    /// Part of the name of the GPU adapter to use, in any case of letters (see `plumb doctor`); without it
    /// PLUMB_ADAPTER says it
    #[arg(long, value_name = "PART", value_parser = NonEmptyStringValueParser::new())]
    pub(crate) adapter: Option<String>,
    /// Every byte right, or the GPU's f32 as it comes
    #[arg(
        long,
        value_name = "WHAT",
        value_enum,
        ignore_case = true,
        default_value_t,
        long_help = "\
What is asked of the bytes.

certified: every byte is the one that the scene means in exact arithmetic, the same from every GPU, driver and CPU. \
The GPU tells with each pixel whether it is sure of it; those that it is not sure of are decided on the CPU, in \
the end exactly: of the scenes that come with plumb 0.1 to 2 % without lights, with lights mostly 0.2 to 5 %, and up \
to 20 % where mirrors show mirrors. The GPU is tested before it is trusted, and some of the pixels that it is sure of \
are computed again. EXR holds the f32 nearest each exact value; all of it is computed on the CPU.

fast: the GPU's f32 as it comes. A few bytes in a hundred thousand differ by one, which ones depends on the driver. \
With --backend cpu there is no difference."
    )]
    pub(crate) precision: PrecisionName,
    /// Exit 1 if any pixel is presumed to lie on a border, not proven
    #[arg(long)]
    pub(crate) strict: bool,
    /// A second picture that shows what decided each pixel, .png or .ppm
    #[arg(
        long,
        value_name = "OUT",
        long_help = "\
A second picture of the same size, .png or .ppm, that shows what decided each pixel:

  dark grey  the GPU, which was sure
  light grey f32 with error bounds, on the CPU
  blue       f64 with error bounds, on the CPU
  yellow     intervals of many bits
  white      exact arithmetic: the pixel lies on a border exactly
  red        presumed: nearer to a border than 1,024 bits can tell"
    )]
    pub(crate) verdicts: Option<PathBuf>,
    /// CPU threads; all cores without
    #[arg(
        long,
        value_name = "N",
        value_parser = threads,
        long_help = "\
Threads that plumb computes with on the CPU; without it as many as there are cores. A software driver, such as \
lavapipe or SwiftShader, computes on the CPU with threads of its own, which this does not bound: --backend cpu does \
without it."
    )]
    pub(crate) threads: Option<usize>,
    /// Rows of a band, the piece in which a picture is rendered and written; it changes no byte
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(1..=u32::MAX),
        long_help = "\
Rows of a band, the piece in which a picture is rendered and written. Without it bands are as high as takes a moment. \
It changes no byte, only memory and time; a band has fewer rows where so many would not fit."
    )]
    pub(crate) band_rows: Option<u32>,
    /// The notes' listing of pixels on stderr: any of pix, hit, drgb, irgb, offset
    #[arg(
        long,
        value_name = "WHAT,…",
        value_delimiter = ',',
        long_help = "\
The notes' listing of pixels, to stderr after the picture is done, bottom row first: any of pix, hit, drgb, irgb, \
offset, separated by commas. It is computed on the CPU, whatever rendered the picture. Lines are begun by pix. A pixel \
without a hit lists pix only. drgb is the colour (1 is full brightness), irgb the bytes, \
offset the pixel's number, from the top left of the whole picture."
    )]
    pub(crate) debug: Vec<DebugName>,
    /// Print a report as JSON: to stdout, or to stderr if the picture goes to stdout
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors and what was asked for
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

impl RenderOptions {
    /// The settings for rendering `scene`, which has its final size.
    pub(crate) fn settings(&self, scene: &Scene, values: bool) -> Result<Settings> {
        self.picture.check(scene)?;
        let height = scene.camera.pixeldim[1];
        let rows = self.rows.map(|rows| rows.of(height)).transpose()?;
        if self.adapter.is_some() && self.backend == BackendName::Cpu {
            bail!(
                "--adapter picks a GPU adapter, and --backend cpu uses none: leave one of them out"
            );
        }
        let picture = self.picture.settings();
        if picture.supersampling().is_some() && !self.debug.is_empty() {
            bail!(
                "--debug lists the ray through the middle of a pixel, and --samples takes others: leave one of them out"
            );
        }
        if self.strict && self.precision == PrecisionName::Fast {
            bail!(
                "--strict asks that every byte is proven, and --precision fast proves none: leave one of them out"
            );
        }
        if self.verdicts.is_some() && self.precision == PrecisionName::Fast {
            bail!(
                "--verdicts shows what decided each byte, and --precision fast decides none: leave one of them out"
            );
        }
        Ok(Settings {
            rows,
            backend: self.backend.into(),
            precision: self.precision.into(),
            adapter: self.adapter.clone(),
            threads: self.threads,
            values,
            verdicts: self.verdicts.is_some(),
            band_rows: self.band_rows,
            cache: cache::folder(),
            ..picture
        })
    }

    /// Whether stderr is for talk where the picture goes there: not if silence was asked for, nor if the report is the
    /// only thing to be there.
    pub(crate) fn talks(&self, picture: &Target) -> bool {
        !(self.quiet || self.json && picture.is_stdout())
    }

    /// What `--debug` asks for, if anything.
    pub(crate) fn shown(&self) -> Option<Shown> {
        let has = |name| self.debug.contains(&name);
        (!self.debug.is_empty()).then(|| Shown {
            pix: has(DebugName::Pix),
            hit: has(DebugName::Hit),
            drgb: has(DebugName::Drgb),
            irgb: has(DebugName::Irgb),
            offset: has(DebugName::Offset),
        })
    }
}

/// The tracers by their names on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum BackendName {
    #[default]
    Auto,
    Gpu,
    Cpu,
}

impl From<BackendName> for Backend {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Self::Auto,
            BackendName::Gpu => Self::Gpu,
            BackendName::Cpu => Self::Cpu,
        }
    }
}

/// What is asked of the bytes, by name on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum PrecisionName {
    #[default]
    Certified,
    Fast,
}

impl From<PrecisionName> for Precision {
    fn from(name: PrecisionName) -> Self {
        match name {
            PrecisionName::Certified => Self::Certified,
            PrecisionName::Fast => Self::Fast,
        }
    }
}

/// How samples are spread, by name on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum JitterName {
    /// A hash of column, row and sample: any rows are the same as in the whole picture
    #[default]
    Hash,
    /// The C library's random(), from the bottom row on, as the course's program drew it: with 16 samples, its pictures
    Course,
}

impl From<JitterName> for SamplePattern {
    fn from(name: JitterName) -> Self {
        match name {
            JitterName::Hash => Self::Hash,
            JitterName::Course => Self::Course,
        }
    }
}

/// The parts of the notes' listing by their names on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DebugName {
    Pix,
    Hit,
    Drgb,
    Irgb,
    Offset,
}

/// How many threads the CPU tracer takes when it may choose.
pub(crate) fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

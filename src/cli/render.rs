//! `plumb render`, and the filter use `plumb < scene > picture.ppm`: scene in, picture out, and a word about how it
//! went.

use std::ffi::OsStr;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use plumb::cores;
use plumb::cpu::debug::list_pixels;
use plumb::cpu::pixel::ExactTracer;
use plumb::diagnostic::visible_text;
use plumb::image::{Finished, Format, Metadata, Target};
use plumb::prepare::Prepared;
use plumb::render::{self, Backend, Band, Devices, PixelFault, Report, Settings};
use plumb::scene::{Scene, list_model};
use serde::Serialize;

use super::args::RenderOptions;
use super::outputs::Outputs;
use super::parts::{self, PartOptions};
use super::picture::{self, PictureFile};
use super::place::Place;
use super::progress::Progress;
use super::summary::{answer, summary, told};
use super::targets::Targets;
use super::{Answer, SOFTWARE, say, source};

/// What `plumb render` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
EXAMPLES
  plumb render scene.txt                 scene.ppm, in the current folder
  plumb render scene.txt -o big.png --size 3840x2160
  plumb render scene.txt -o values.exr   the values before they become bytes
  plumb render scene.txt -o - | display  PPM on stdout
  plumb render frames/*.txt -o 'out/{}.png'
                                         many pictures, each with its scene's name
  plumb render frames/*.txt -o - | ffmpeg -f image2pipe -c:v ppm -i - film.mp4
  plumb render scene.txt --rows ..100    the lowest 100 rows
  plumb render scene.txt --verdicts why.png --strict
                                         what decided each pixel; exit 1 if any
                                         byte is not proven
  plumb render scene.txt --debug pix,hit --rows 16..17 2> hits.txt
  plumb render scene.txt -o big.png --size 100000x100000 --resume
                                         goes on where it was stopped
  plumb render scene.txt -o big.png --size 100000x100000 --part 3/64
                                         one part, anywhere; `plumb join big.png`
                                         makes the picture of all (docs/CLUSTER.md)")]
pub(crate) struct Args {
    /// The scene file; `-` is stdin. Of several each becomes a picture
    #[arg(
        required = true,
        value_name = "SCENE",
        long_help = "\
The scene file; `-` is stdin. Several become as many pictures, in one run: devices and shaders are kept, and while one \
picture is made the next scene is read and the one before is written. Of those that are wrong it is told; the others \
are made, and the exit code is 2. With --json there is a line for each, {\"scene\": …, \"error\": …} where there is no \
picture."
    )]
    pub(crate) scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) options: RenderOptions,
    #[command(flatten)]
    pub(crate) parts: PartOptions,
}

/// What is rendered, and under which name.
pub(crate) struct RenderCommand<'a> {
    /// What errors and reports call the scene.
    pub(super) name: &'a str,
    /// The scene's file, if it has one.
    file: Option<&'a Path>,
    pub(super) targets: Targets,
    pub(super) scene: Scene,
    /// What may surprise in its picture.
    pub(super) remarks: Vec<String>,
    pub(super) options: &'a RenderOptions,
    /// Its place among many.
    place: Option<&'a Place<'a>>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct JsonReport<'a> {
    software: &'a str,
    scene: &'a str,
    output: String,
    format: String,
    bytes: u64,
    sha256: &'a str,
    #[serde(flatten)]
    report: &'a Report,
}

/// The file of a scene, which stdin has not.
pub(crate) fn file(scene: &Path) -> Option<&Path> {
    (!source::is_stdin(scene)).then_some(scene)
}

/// Renders a scene file, alone.
pub(crate) fn one(scene: &Path, args: &Args) -> Result<Answer> {
    let options = &args.options;
    start_threads(options);
    let name = source::name(scene);
    let loaded = source::load_with_text(scene)?;
    let targets = Targets::new(options, file(scene))?;
    let command = RenderCommand::new((&name, file(scene)), loaded, targets, options, None);
    match args.parts.job()? {
        None => command.run(),
        Some(job) => parts::run(&command, &job),
    }
}

/// Renders the scene on stdin, as the notes' program does: lists the model on stderr, writes the picture to stdout.
pub(crate) fn filter(options: &RenderOptions) -> Result<Answer> {
    if io::stdin().is_terminal() {
        return Ok(Answer::Nothing);
    }
    start_threads(options);
    let Some(loaded) = source::load_stdin()? else {
        return Ok(Answer::Nothing);
    };
    let targets = Targets::new(options, None)?;
    let command = RenderCommand::new((source::STDIN, None), loaded, targets, options, None);
    // What is refused is refused before the listing, which may be long.
    command.check(&command.targets.picture)?;
    if command.talks() {
        let mut listing = Vec::new();
        list_model(&command.scene, &mut listing).context("cannot list the model")?;
        say::talk(&String::from_utf8_lossy(&listing));
    }
    command.run()
}

/// Starts as many threads as were asked for, which the scene is read with and the picture compressed. If the system
/// refuses they are done without, and the rendering tells it.
pub(crate) fn start_threads(options: &RenderOptions) {
    if options.threads.is_some() {
        let _ = cores::start(options.threads);
    }
}

/// The process's devices. They are never closed, and the process does not end by returning from `main` (see `end`): who
/// has a picture does not wait for a driver that may still be loading.
pub(super) fn devices() -> &'static Devices {
    static DEVICES: OnceLock<Devices> = OnceLock::new();
    DEVICES.get_or_init(Devices::new)
}

impl<'a> RenderCommand<'a> {
    pub(crate) fn new(
        (name, file): (&'a str, Option<&'a Path>),
        (mut scene, text): (Scene, Vec<u8>),
        targets: Targets,
        options: &'a RenderOptions,
        place: Option<&'a Place<'a>>,
    ) -> Self {
        options.picture.apply(&mut scene);
        let mut command = Self {
            name,
            file,
            targets,
            scene,
            remarks: Vec::new(),
            options,
            place,
        };
        // Now, so that the text need not be kept.
        if command.talks() {
            let tolerance = options.picture.screen_tolerance;
            command.remarks = source::remarks(&command.scene, &text, tolerance);
        }
        command
    }

    /// Whether stderr is for talk.
    pub(super) fn talks(&self) -> bool {
        self.options.talks(&self.targets.picture)
    }

    /// Says something of the scene, by its name if there are others.
    fn note(&self, text: &str) {
        match self.place {
            Some(_) => say::note(&format!("{}: {text}", self.name)),
            None => say::note(text),
        }
    }

    /// Refuses what would be regretted: to overwrite what the scene was read from, to fill a terminal with bytes.
    pub(super) fn check(&self, target: &Target) -> Result<()> {
        if target.is_stdout() {
            picture::check_stdout()?;
        }
        let file = source::file(self.file);
        if let Some(what) = self.scene.is_made_from(file, target.path()) {
            bail!("{target} is {what}: give the picture another name with -o");
        }
        Ok(())
    }

    pub(crate) fn run(&self) -> Result<Answer> {
        let start = Instant::now();
        let target = &self.targets.picture;
        let format = target.format()?;
        let settings = self.options.settings(&self.scene, format.wants_values())?;
        self.check(target)?;
        let mut outputs = self.open(target, format, &settings)?;
        let rendered = match self.render(&settings, &mut outputs) {
            // What is written beside can be begun anew; what was written through cannot be taken back.
            Err(render::Error::Revoked(revoked)) if outputs.can_restart() => {
                drop(outputs);
                outputs = self.open(target, format, &settings)?;
                let cpu = Settings {
                    backend: Backend::Cpu,
                    ..settings.clone()
                };
                self.render(&cpu, &mut outputs).map(|report| Report {
                    revoked: Some(revoked),
                    ..report
                })
            }
            rendered => rendered,
        };
        if rendered.is_err() && !outputs.can_restart() {
            self.place.into_iter().for_each(Place::cut_off);
        }
        let report = match rendered {
            Ok(report) => report,
            Err(render::Error::Emit(source)) => return Err(outputs.failed(source)),
            Err(error) => return Err(self.explain(error)),
        };
        let finished = outputs.finish()?;
        if self.talks() {
            self.remarks.iter().for_each(|remark| self.note(remark));
            told(&report).iter().for_each(|line| self.note(line));
        }
        self.list(&settings, &report)?;
        self.report(target, format, &report, &finished)?;
        if self.talks() && !self.options.json {
            let summary = summary(target, &report, start.elapsed());
            say::talk(&format!("{}\n", visible_text(&summary)));
        }
        Ok(answer(self.options.strict, &report))
    }

    /// Opens the picture, and the one of its verdicts if it was asked for.
    fn open(&self, target: &Target, format: Format, settings: &Settings) -> Result<Outputs> {
        let [width, height] = self.scene.camera.pixeldim;
        let rows = settings.rows_of(height).len() as u32;
        let open = |target: &Target, format, hashed| {
            PictureFile::open(
                target,
                format,
                [width, rows],
                self.metadata(settings),
                hashed,
            )
        };
        Ok(Outputs {
            picture: open(target, format, self.options.json)?,
            verdicts: match self.verdicts(target)? {
                Some((target, format)) => Some(open(target, format, false)?),
                None => None,
            },
        })
    }

    /// Where the verdicts go.
    fn verdicts(&self, picture: &Target) -> Result<Option<(&Target, Format)>> {
        let Some(target) = &self.targets.verdicts else {
            return Ok(None);
        };
        let format = picture::bytes_format(target, "--verdicts")?;
        if target.is_stdout() {
            bail!("--verdicts goes to a file: give it a name that ends in .png or .ppm");
        }
        if picture.is_same(target) {
            bail!("{target} is the picture itself: give the verdicts another name");
        }
        self.check(target)?;
        Ok(Some((target, format)))
    }

    fn render(&self, settings: &Settings, outputs: &mut Outputs) -> Result<Report, render::Error> {
        let [_, height] = self.scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        let Some(place) = self.place else {
            let mut progress = Progress::new(rows.len() as u64, self.talks());
            let emit = &mut |band: &Band| {
                outputs.write(band)?;
                progress.add(band.rows.len() as u64);
                Ok(())
            };
            let rendered = render::render_with(&self.scene, settings, devices(), emit);
            progress.clear();
            return rendered;
        };
        let emit = &mut |band: &Band| {
            place.wait_to_write()?;
            outputs.write(band)?;
            place.wrote(band.rows.start - rows.start, rows.len() as u32);
            Ok(())
        };
        render::render_in_turn(&self.scene, settings, devices(), place.turn(), emit)
    }

    /// What the picture's file tells of how it was made.
    pub(super) fn metadata(&self, settings: &Settings) -> Metadata {
        let scene = self
            .file
            .and_then(Path::file_name)
            .unwrap_or(OsStr::new(self.name));
        Metadata::of(SOFTWARE, &scene.to_string_lossy(), &self.scene, settings)
    }

    /// The error, with what would mend it.
    pub(super) fn explain(&self, error: render::Error) -> anyhow::Error {
        match error {
            render::Error::Gpu(plumb::gpu::GpuError::NoAdapter) => {
                anyhow!(
                    "{error}; {}, or leave out --backend gpu",
                    render::install_hint()
                )
            }
            render::Error::TooManyRays(PixelFault { x, y, .. }) => {
                anyhow!("{error}; `plumb probe SCENE {x} {y}` shows what they do")
            }
            render::Error::Revoked(_) => {
                anyhow!("{error}, and cannot be taken back: write to a file, or with --backend cpu")
            }
            error => anyhow::Error::new(error),
        }
    }

    /// The notes' listing, if it was asked for.
    fn list(&self, settings: &Settings, report: &Report) -> Result<()> {
        let Some(shown) = self.options.shown() else {
            return Ok(());
        };
        let prepared = Prepared::new(&self.scene, settings.view());
        let mut limits = settings.sample_limits();
        if shown.drgb {
            // A picture is done with a sample at full brightness; this asks how bright it is.
            limits.enough = f64::INFINITY;
        }
        let [start, end] = report.rows;
        let mut stderr = io::BufWriter::new(io::stderr().lock());
        let listed = list_pixels(
            &self.scene,
            &prepared,
            &ExactTracer::new(&self.scene, settings.view()),
            &limits,
            start..end,
            shown,
            &mut stderr,
        )
        // The notes' listing begins lines and ends none; what follows begins one of its own.
        .and_then(|()| stderr.write_all(b"\n"))
        .and_then(|()| stderr.flush());
        listed.context("cannot list the pixels on stderr")
    }

    /// The report of `--json`.
    fn report(
        &self,
        target: &Target,
        format: Format,
        report: &Report,
        finished: &Finished,
    ) -> Result<()> {
        if !self.options.json {
            return Ok(());
        }
        let json = JsonReport {
            software: SOFTWARE,
            scene: self.name,
            output: target.to_string(),
            format: format.to_string().to_lowercase(),
            bytes: finished.bytes,
            sha256: finished.sha256.as_deref().unwrap_or_default(),
            report,
        };
        let text = match self.place {
            Some(_) => serde_json::to_string(&json)?,
            None => serde_json::to_string_pretty(&json)?,
        } + "\n";
        if target.is_stdout() {
            say::talk(&text);
            return Ok(());
        }
        say::data(&text)
    }
}

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
use plumb::files::is_stream;
use plumb::image::{Finished, Format, Metadata, Target};
use plumb::prepare::Prepared;
use plumb::render::{self, Backend, Devices, PixelFault, Report, Settings};
use plumb::scene::{Scene, list_model};
use serde::Serialize;

use super::args::RenderOptions;
use super::outputs::Outputs;
use super::parts::{self, PartOptions};
use super::picture::{self, PictureFile};
use super::progress::Progress;
use super::summary::{answer, summary, told};
use super::{Answer, SOFTWARE, say, source};

/// What `plumb render` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
EXAMPLES
  plumb render scene.txt                 scene.ppm, in the current folder
  plumb render scene.txt -o big.png --size 3840x2160
  plumb render scene.txt -o values.exr   the values before they become bytes
  plumb render scene.txt -o - | display  PPM on stdout
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
    /// The scene file; `-` is stdin
    scene: PathBuf,
    #[command(flatten)]
    options: RenderOptions,
    #[command(flatten)]
    parts: PartOptions,
}

/// What is rendered, and under which name.
pub(super) struct RenderCommand<'a> {
    /// What errors and reports call the scene.
    pub(super) name: &'a str,
    /// The scene's file, if it has one.
    file: Option<&'a Path>,
    pub(super) scene: Scene,
    /// What may surprise in its picture.
    pub(super) remarks: Vec<String>,
    pub(super) options: &'a RenderOptions,
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

/// Renders a scene file.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    start_threads(&args.options);
    let name = source::name(&args.scene);
    let loaded = source::load_with_text(&args.scene)?;
    let file = (!source::is_stdin(&args.scene)).then_some(args.scene.as_path());
    let command = RenderCommand::new(&name, file, loaded, &args.options);
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
    let command = RenderCommand::new(source::STDIN, None, loaded, options);
    // What is refused is refused before the listing, which may be long.
    command.check(&command.target()?)?;
    if command.talks() {
        let mut listing = Vec::new();
        list_model(&command.scene, &mut listing).context("cannot list the model")?;
        say::talk(&String::from_utf8_lossy(&listing));
    }
    command.run()
}

/// Refuses a folder where a picture's name belongs.
pub(super) fn refuse_folder(target: &Target) -> Result<()> {
    match target {
        Target::Path(path) if path.is_dir() => bail!(
            "cannot write {}: it is a folder; name the file too, such as picture.ppm",
            path.display()
        ),
        _ => Ok(()),
    }
}

/// Starts as many threads as were asked for, which the scene is read with and the picture compressed. If the system
/// refuses they are done without, and the rendering tells it.
fn start_threads(options: &RenderOptions) {
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
    fn new(
        name: &'a str,
        file: Option<&'a Path>,
        (mut scene, text): (Scene, Vec<u8>),
        options: &'a RenderOptions,
    ) -> Self {
        options.picture.apply(&mut scene);
        let mut command = Self {
            name,
            file,
            scene,
            remarks: Vec::new(),
            options,
        };
        // Now, so that the text need not be kept.
        if command.talks() {
            let tolerance = options.picture.screen_tolerance;
            command.remarks = source::remarks(&command.scene, &text, tolerance);
        }
        command
    }

    /// Whether stderr is for talk: not if silence was asked for, nor if the report is the only thing to be there.
    pub(super) fn talks(&self) -> bool {
        let report_on_stderr =
            self.options.json && self.target().is_ok_and(|target| target.is_stdout());
        !self.options.quiet && !report_on_stderr
    }

    /// Where the picture goes.
    pub(super) fn target(&self) -> Result<Target> {
        if let Some(output) = &self.options.output {
            return Ok(Target::from_argument(output.as_os_str()));
        }
        let Some(file) = self.file else {
            return Ok(Target::Stdout);
        };
        let stem = file.file_stem().filter(|stem| !stem.is_empty());
        let Some(stem) = stem.filter(|_| !is_stream(file)) else {
            bail!(
                "{} has no name to call the picture by: give one with -o",
                file.display()
            );
        };
        let mut name = stem.to_owned();
        name.push(".ppm");
        // A name such as `-.txt` must not turn into stdout.
        Ok(Target::Path(Path::new("").join(name)))
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

    fn run(&self) -> Result<Answer> {
        let start = Instant::now();
        let target = self.target()?;
        refuse_folder(&target)?;
        let format = target.format()?;
        let settings = self.options.settings(&self.scene, format.wants_values())?;
        self.check(&target)?;
        let mut outputs = self.open(&target, format, &settings)?;
        let rendered = match self.render(&settings, &mut outputs) {
            // What is written beside can be begun anew; what was written through cannot be taken back.
            Err(render::Error::Revoked(revoked)) if outputs.can_restart() => {
                drop(outputs);
                outputs = self.open(&target, format, &settings)?;
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
        let report = match rendered {
            Ok(report) => report,
            Err(render::Error::Emit(source)) => return Err(outputs.failed(source)),
            Err(error) => return Err(self.explain(error)),
        };
        let finished = outputs.finish()?;
        if self.talks() {
            self.remarks.iter().for_each(|remark| say::note(remark));
            told(&report).iter().for_each(|line| say::note(line));
        }
        self.list(&settings, &report)?;
        self.report(&target, format, &report, &finished)?;
        if self.talks() && !self.options.json {
            let summary = summary(&target, &report, start.elapsed());
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
                Some((target, format)) => Some(open(&target, format, false)?),
                None => None,
            },
        })
    }

    /// Where the verdicts go.
    fn verdicts(&self, picture: &Target) -> Result<Option<(Target, Format)>> {
        let Some(path) = &self.options.verdicts else {
            return Ok(None);
        };
        let target = Target::from_argument(path.as_os_str());
        let format = picture::bytes_format(&target, "--verdicts")?;
        if target.is_stdout() {
            bail!("--verdicts goes to a file: give it a name that ends in .png or .ppm");
        }
        if picture.is_same(&target) {
            bail!(
                "{} is the picture itself: give the verdicts another name",
                path.display()
            );
        }
        self.check(&target)?;
        Ok(Some((target, format)))
    }

    fn render(&self, settings: &Settings, outputs: &mut Outputs) -> Result<Report, render::Error> {
        let [_, height] = self.scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        let mut progress = Progress::new(rows.len() as u64, self.talks());
        let rendered = render::render_with(&self.scene, settings, devices(), &mut |band| {
            outputs.write(band)?;
            progress.add(band.rows.len() as u64);
            Ok(())
        });
        progress.clear();
        rendered
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
        let text = serde_json::to_string_pretty(&json)? + "\n";
        if target.is_stdout() {
            say::talk(&text);
            return Ok(());
        }
        say::data(&text)
    }
}

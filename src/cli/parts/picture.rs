//! A picture that is made in parts: one of them, or all that are missing and the picture of them.

use std::cell::Cell;
use std::fs;
use std::io;
use std::path::Path;
use std::time::Instant;

use anyhow::{Result, bail};
use plumb::cpu::pixel::ExactTracer;
use plumb::image::{Finished, Format, Metadata, OutputError, Target, check_size};
use plumb::parts::{Cut, Folder, Identity, PartError, Splitter, State, Survey, Work};
use plumb::probe::digits::count;
use plumb::render::{self, Backend, Band, Report, Settings};
use serde::Serialize;

use super::lock::Lock;
use super::{Job, folder_of, refuse};
use crate::cli::join::{self, Whole};
use crate::cli::progress::Progress;
use crate::cli::render::{RenderCommand, devices};
use crate::cli::summary::{summary, told};
use crate::cli::{Answer, SOFTWARE, say};

/// A picture in parts.
pub(super) struct Picture<'a> {
    command: &'a RenderCommand<'a>,
    target: Target,
    format: Format,
    settings: Settings,
    pub(super) folder: Folder,
    cut: Cut,
    identity: Identity,
    /// The scene as it was prepared for the estimate of its work, until the first rendering takes it.
    prepared: Cell<Option<ExactTracer<'a>>>,
}

/// What `--json` prints of a part.
#[derive(Serialize)]
struct PartJson<'a> {
    software: &'a str,
    scene: &'a str,
    output: String,
    part: u32,
    parts: u32,
    bytes: u64,
    presumed: u64,
    /// Whether it was made now; else it was there.
    made: bool,
    #[serde(flatten)]
    report: Option<&'a Report>,
}

/// What `--json` prints of a picture.
#[derive(Serialize)]
struct PictureJson<'a> {
    scene: &'a str,
    /// Parts that were made now.
    made: usize,
    #[serde(flatten)]
    whole: &'a Whole,
}

/// Parts so large that their files are about 64 MiB, or that they take about half a second on two cores; never too
/// many.
const PART_BYTES: u64 = 64 << 20;
const PART_WORK: f64 = 1e6;
const MOST_PARTS: u32 = 10_000;
impl<'a> Picture<'a> {
    pub(super) fn new(command: &'a RenderCommand<'a>, job: &Job<'_>) -> Result<Self> {
        let (scene, options) = (&command.scene, command.options);
        refuse(options)?;
        let target = command.targets.picture.clone();
        let format = target.format()?;
        let (Some(stem), false) = (target.path().file_stem(), target.is_stdout()) else {
            bail!("parts are called by their picture's name: give one with -o");
        };
        command.check(&target)?;
        let [width, height] = scene.camera.pixeldim;
        let mut settings = options.settings(scene, format.wants_values())?;
        if settings.values && settings.backend == Backend::Auto {
            // It computes them in any case, and what might be advised for a whole picture is none for parts.
            settings.backend = Backend::Cpu;
        }
        // What is presumed is counted part by part.
        settings.verdicts = true;
        let rows = settings.rows_of(height);
        check_size(format, width, rows.len() as u32)?;
        let parts = job.part.map(|part| part.parts);
        let prepared = ExactTracer::new(scene, settings.view());
        let prepared_scene = (scene, &prepared);
        let work = Work::estimate(prepared_scene, &settings, &rows, parts.unwrap_or(1));
        let parts = parts.unwrap_or_else(|| {
            let pixels = u64::from(width) * rows.len() as u64;
            let bytes = pixels * if settings.values { 15 } else { 3 };
            let rays = work.of_a_sample() * pixels as f64 * f64::from(settings.samples);
            let parts = (bytes / PART_BYTES).max((rays / PART_WORK) as u64);
            parts.clamp(1, u64::from(MOST_PARTS.min(rows.len() as u32))) as u32
        });
        let cut = Cut::new(rows, &work, parts)?;
        let folder = job.folder.map(Path::to_owned);
        let folder = folder.unwrap_or_else(|| folder_of(target.path()));
        Ok(Self {
            folder: Folder::new(folder, stem.to_owned()),
            identity: Identity::new(scene, &settings, &cut),
            command,
            target,
            format,
            settings,
            cut,
            prepared: Cell::new(Some(prepared)),
        })
    }

    /// What the picture's file tells of how it was made, but for the program's name, which is that of who joins.
    fn texts(&self) -> Metadata {
        let mut texts = self.command.metadata(&self.settings);
        texts.entries.retain(|(key, _)| key != join::SOFTWARE_KEY);
        texts
    }

    /// Makes a part, unless it is there and right.
    pub(super) fn part(&self, number: u32, start: Instant) -> Result<Answer> {
        let parts = self.cut.parts();
        let path = self.folder.part(number, parts);
        let json =
            |report: Option<&Report>, presumed| self.part_json(number, &path, presumed, report);
        match self.folder.check(number, &self.cut, self.identity) {
            Ok(part) => {
                if self.command.talks() && !self.command.options.json {
                    say::note(&format!(
                        "{} is there and right: it is not made again",
                        path.display()
                    ));
                }
                json(None, part.presumed())?;
                return Ok(self.answer(part.presumed()));
            }
            Err(PartError::Missing) => {}
            // What the system does not let us read it will not let us replace either; trying tells why.
            Err(wrong) => self.note(&format!("{}: {wrong}; it is made again", path.display())),
        }
        let report = self.render(number, number)?;
        self.tell(&report);
        json(Some(&report), report.presumed)?;
        if self.command.talks() && !self.command.options.json {
            let target = Target::Path(path.clone());
            let summary = summary(&target, &report, start.elapsed());
            say::talk(&format!("{}\n", plumb::diagnostic::visible_text(&summary)));
        }
        Ok(self.answer(report.presumed))
    }

    fn part_json(
        &self,
        part: u32,
        path: &Path,
        presumed: u64,
        report: Option<&Report>,
    ) -> Result<()> {
        if !self.command.options.json {
            return Ok(());
        }
        let json = PartJson {
            software: SOFTWARE,
            scene: self.command.name,
            output: path.display().to_string(),
            part,
            parts: self.cut.parts(),
            bytes: fs::metadata(path).map_or(0, |file| file.len()),
            presumed,
            made: report.is_some(),
            report,
        };
        say::data(&(serde_json::to_string_pretty(&json)? + "\n"))
    }

    /// Makes the parts that are missing, then the picture.
    pub(super) fn resume(&self, start: Instant) -> Result<Answer> {
        let lock = Lock::of(self.folder.path())?;
        self.folder.remove_unfinished()?;
        join::remove_left(&self.target)?;
        let parts = self.cut.parts();
        let mut survey = self.folder.survey(parts, Some(self.identity));
        survey.check_rows();
        let missing = self.missing(&survey);
        for run in missing.chunk_by(|a, b| a + 1 == *b) {
            if let [first, ..] = run {
                let report = self.render(*first, first + run.len() as u32 - 1)?;
                self.tell(&report);
            }
        }
        let survey = self.folder.survey(parts, Some(self.identity));
        let options = self.command.options;
        let joined = join::write(
            &survey,
            &self.target,
            self.format,
            options.json,
            self.command.talks(),
        )?;
        let Some(finished) = joined else {
            bail!("parts were damaged while they were joined; the same command makes them again");
        };
        drop(lock);
        self.folder.remove(parts)?;
        self.report(&survey, missing.len(), &finished, start)?;
        Ok(self.answer(survey.presumed()))
    }

    /// The numbers of the parts that are missing; says what there is.
    fn missing(&self, survey: &Survey) -> Vec<u32> {
        for (number, state) in (1..).zip(survey.states()) {
            if let State::Wrong(wrong @ (PartError::Wrong(_) | PartError::Io(_))) = state {
                let path = self.folder.part(number, self.cut.parts());
                self.note(&format!("{}: {wrong}; it is made again", path.display()));
            }
        }
        let missing = survey.missing();
        let there = survey.states().len() - missing.len();
        if there > 0 {
            let parts = count(survey.states().len(), "part");
            self.note(&format!("{there} of {parts} are there already"));
        }
        missing
    }

    /// Renders parts that follow each other. Where a device was wrong, the CPU makes all of them again.
    fn render(&self, first: u32, last: u32) -> Result<Report> {
        let rendered = self.attempt(first, last, self.settings.backend);
        let (Err(render::Error::Revoked(revoked)), made) = rendered else {
            return self.explained(rendered.0);
        };
        for number in made {
            fs::remove_file(self.folder.part(number, self.cut.parts()))?;
        }
        let (rendered, _) = self.attempt(first, last, Backend::Cpu);
        Ok(Report {
            revoked: Some(revoked),
            ..self.explained(rendered)?
        })
    }

    fn explained(&self, rendered: Result<Report, render::Error>) -> Result<Report> {
        match rendered {
            Ok(report) => Ok(report),
            // An error of a part's file comes back as it was.
            Err(render::Error::Emit(source)) => Err(match source.downcast::<OutputError>() {
                Ok(error) => error.into(),
                Err(source) => {
                    let path = self.folder.path().to_owned();
                    OutputError::Open { path, source }.into()
                }
            }),
            Err(error) => Err(self.command.explain(error)),
        }
    }

    /// Renders the parts from `first` to `last`; returns which of them are there.
    fn attempt(
        &self,
        first: u32,
        last: u32,
        backend: Backend,
    ) -> (Result<Report, render::Error>, Vec<u32>) {
        let scene = &self.command.scene;
        let rows = self.cut.rows(last).start..self.cut.rows(first).end;
        let settings = Settings {
            rows: Some(rows.clone()),
            backend,
            ..self.settings.clone()
        };
        let what = (scene, &self.settings);
        let mut splitter = Splitter::new(&self.folder, &self.cut, what, self.texts(), first);
        // A name that cannot be written costs no rendering.
        if let Err(error) = splitter.open() {
            return (Err(io::Error::other(error).into()), Vec::new());
        }
        let mut progress = Progress::new(rows.len() as u64, self.command.talks());
        let emit = &mut |band: &Band| {
            splitter.write(band)?;
            progress.add(band.rows.len() as u64);
            Ok(())
        };
        let prepared = self.prepared.take();
        let rendered = render::render_prepared(scene, &settings, devices(), prepared, emit);
        progress.clear();
        (rendered, splitter.made().to_vec())
    }

    fn note(&self, text: &str) {
        if self.command.talks() {
            say::note(text);
        }
    }

    /// What has to be said of a rendering.
    fn tell(&self, report: &Report) {
        self.command
            .remarks
            .iter()
            .for_each(|remark| self.note(remark));
        told(report).iter().for_each(|line| self.note(line));
    }

    fn answer(&self, presumed: u64) -> Answer {
        if self.command.options.strict && presumed > 0 {
            Answer::No
        } else {
            Answer::Yes
        }
    }

    fn report(
        &self,
        survey: &Survey,
        made: usize,
        finished: &Finished,
        start: Instant,
    ) -> Result<()> {
        let whole = Whole::new(survey, &self.target, self.format, finished);
        if self.command.options.json {
            let json = PictureJson {
                scene: self.command.name,
                made,
                whole: &whole,
            };
            return say::data(&(serde_json::to_string_pretty(&json)? + "\n"));
        }
        if self.command.talks() {
            let parts = survey.states().len();
            let made = format!("{made} of them made now");
            say::talk(&format!(
                "{}\n",
                whole.summary(&count(parts, "part"), &made, start.elapsed())
            ));
        }
        Ok(())
    }
}

//! `plumb join`: the picture of its parts, or which of them are missing.

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use plumb::diagnostic::visible_text;
use plumb::image::{Finished, Format, Metadata, Target, check_size, remove_left as remove_left_in};
use plumb::parts::{self, Folder, Header, JoinError, PartError, State, Survey};
use plumb::probe::digits::count;
use serde::Serialize;

use super::parts::folder_of;
use super::picture::{self, PictureFile};
use super::progress::Progress;
use super::values::parts as parts_value;
use super::{Answer, SOFTWARE, say};

/// The key of the text that names the program that wrote a picture.
pub(crate) const SOFTWARE_KEY: &str = "Software";

/// What `plumb join` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Parts are made by `plumb render SCENE -o OUT --part K/N`. All of them are checked: that they are parts of one picture, \
that none is missing, that every byte is as it was written. Which ones are missing or wrong goes to stdout, in a form \
that job arrays take, such as 3,17-19; why goes to stderr, and the exit code is 1. Made again, they mend it.

EXAMPLES
  plumb join big.png                     of the parts in big.png.parts
  plumb join big.png --remove            and then the parts are not needed
  plumb join big.png --parts 64 --check  only tell what is missing
  plumb join - --parts-in parts | …      PPM on stdout
  plumb join big.png --parts 64 --check | xargs -r -I {} sbatch --array={} job.sh
                                         makes again what is missing, if anything is")]
pub(crate) struct Args {
    /// The picture, by its ending .ppm, .png or .exr; `-` is stdout, as PPM
    output: PathBuf,
    /// The folder of the parts; OUT.parts without
    #[arg(long, value_name = "DIR")]
    parts_in: Option<PathBuf>,
    /// How many parts there are, needed only where the folder does not tell: it is empty, or has parts of several cuts
    #[arg(long, value_name = "N", value_parser = parts_value)]
    parts: Option<u32>,
    /// Only check the parts, and write no picture
    #[arg(long)]
    check: bool,
    /// Remove the parts when the picture is whole, and safe from a power cut
    #[arg(long, conflicts_with = "check")]
    remove: bool,
    /// Exit 1 if any pixel is presumed to lie on a border, not proven
    #[arg(long)]
    strict: bool,
    /// CPU threads; all cores without
    #[arg(long, value_name = "N", value_parser = super::values::threads)]
    threads: Option<usize>,
    /// Print a report as JSON: to stdout, or to stderr if the picture goes to stdout; none where parts are missing
    #[arg(long)]
    json: bool,
    /// Print nothing but errors and what was asked for
    #[arg(short, long)]
    quiet: bool,
}

/// Refuses a folder where a picture's name belongs.
fn refuse_folder(target: &Target) -> Result<()> {
    match target {
        Target::Path(path) if path.is_dir() => bail!(
            "cannot write {}: it is a folder; name the file too, such as picture.ppm",
            path.display()
        ),
        _ => Ok(()),
    }
}

/// A picture that is whole, as `--json` prints it.
#[derive(Debug, Serialize)]
pub(crate) struct Whole {
    software: &'static str,
    output: String,
    format: String,
    width: u32,
    rows: [u32; 2],
    parts: usize,
    bytes: u64,
    sha256: String,
    presumed: u64,
}

impl Whole {
    pub(crate) fn new(
        survey: &Survey,
        target: &Target,
        format: Format,
        finished: &Finished,
    ) -> Self {
        let (width, rows) = survey
            .picture()
            .map_or((0, 0..0), |header| (header.width, header.picture.clone()));
        Self {
            software: SOFTWARE,
            output: target.to_string(),
            format: format.to_string().to_lowercase(),
            width,
            rows: [rows.start, rows.end],
            parts: survey.states().len(),
            bytes: finished.bytes,
            sha256: finished.sha256.clone().unwrap_or_default(),
            presumed: survey.presumed(),
        }
    }

    /// `big.png: 3840×2160, 64 parts, 12 of them made now, 3.21 s`.
    pub(crate) fn summary(&self, parts: &str, more: &str, took: Duration) -> String {
        let [start, end] = self.rows;
        let (output, width, rows) = (&self.output, self.width, end - start);
        let (seconds, comma) = (took.as_secs_f64(), if more.is_empty() { "" } else { ", " });
        let mut line = format!("{output}: {width}×{rows}, {parts}{comma}{more}, {seconds:.2} s");
        if self.presumed > 0 {
            let pixels = count(self.presumed as usize, "pixel");
            line += &format!("; {pixels} presumed, not proven, to lie on a border");
        }
        visible_text(&line)
    }
}

/// Joins parts.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let start = Instant::now();
    if args.threads.is_some() {
        let _ = plumb::cores::start(args.threads);
    }
    let target = Target::from_argument(args.output.as_os_str());
    refuse_folder(&target)?;
    let format = target.format()?;
    if target.is_stdout() && !args.check {
        picture::check_stdout()?;
    }
    let folder = folder(args, &target)?;
    let Some(parts) = parts(args, &folder)? else {
        bail!(
            "there are no parts of this picture in {}: make some with `plumb render SCENE -o OUT --part K/N`, or say \
             with --parts how many there are to be",
            folder.path().display()
        );
    };
    let mut survey = folder.survey(parts, None);
    // What is written through cannot be taken back, so that all has to be right before.
    let through = target.is_stdout() || target.path().exists() && !target.path().is_file();
    if args.check || through || !survey.missing().is_empty() {
        survey.check_rows();
    }
    let missing = survey.missing();
    if !missing.is_empty() {
        return tell_missing(args, &survey, &target);
    }
    if args.check {
        if !args.quiet {
            say::note(&format!("all {parts} parts are there and right"));
        }
        return Ok(answer(args, &survey));
    }
    let talks = !(args.quiet || args.json && target.is_stdout());
    let Some(finished) = write(&survey, &target, format, args.json, talks)? else {
        survey.check_rows();
        return tell_missing(args, &survey, &target);
    };
    if args.remove {
        let failed = || format!("{target} is whole, but its parts cannot be removed");
        survey.folder().remove(parts).with_context(failed)?;
    }
    let whole = Whole::new(&survey, &target, format, &finished);
    if args.json {
        let json = serde_json::to_string_pretty(&whole)? + "\n";
        if target.is_stdout() {
            say::talk(&json);
        } else {
            say::data(&json)?;
        }
    } else if talks {
        let parts = count(parts as usize, "part");
        say::talk(&format!("{}\n", whole.summary(&parts, "", start.elapsed())));
    }
    Ok(answer(args, &survey))
}

fn answer(args: &Args, survey: &Survey) -> Answer {
    if args.strict && survey.presumed() > 0 {
        Answer::No
    } else {
        Answer::Yes
    }
}

/// Where the parts are. What has no name of its own, as stdout, takes those that are there, if they are of one picture.
fn folder(args: &Args, target: &Target) -> Result<Folder> {
    let stream = target.is_stdout() || target.path().exists() && !target.path().is_file();
    let path = match &args.parts_in {
        Some(path) => path.clone(),
        None if stream => {
            bail!("{target} is no file beside which parts lie: say where with --parts-in")
        }
        None => folder_of(target.path()),
    };
    let stem = target.path().file_stem().filter(|_| !stream);
    if let Some(stem) = stem {
        return Ok(Folder::new(path, stem.to_owned()));
    }
    let stems = Folder::stems(&path).with_context(|| cannot_read(&path))?;
    let mut stems = stems.into_iter();
    match (stems.next(), stems.next()) {
        (Some(stem), None) => Ok(Folder::new(path, stem)),
        (None, _) => bail!("there are no parts in {}", path.display()),
        (Some(_), Some(_)) => bail!(
            "{} has parts of several pictures, and {target} does not say of which: join into a file of that name",
            path.display()
        ),
    }
}

fn cannot_read(path: &Path) -> String {
    format!("cannot read the folder {}", path.display())
}

/// How many parts there are.
fn parts(args: &Args, folder: &Folder) -> Result<Option<u32>> {
    if let Some(parts) = args.parts {
        return Ok(Some(parts));
    }
    let cuts = match folder.cuts() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        cuts => cuts.with_context(|| cannot_read(folder.path()))?,
    };
    let all: Vec<String> = cuts.iter().map(u32::to_string).collect();
    match cuts.first() {
        Some(_) if cuts.len() > 1 => bail!(
            "{} has parts of several cuts, into {} parts: say with --parts which are meant",
            folder.path().display(),
            all.join(" and ")
        ),
        parts => Ok(parts.copied()),
    }
}

/// Says which parts have to be made, and why.
fn tell_missing(args: &Args, survey: &Survey, target: &Target) -> Result<Answer> {
    let parts = survey.states().len() as u32;
    let missing = survey.missing();
    if !args.quiet {
        let mut absent = Vec::new();
        for (number, state) in (1..).zip(survey.states()) {
            match state {
                State::Wrong(PartError::Missing) => absent.push(number),
                State::Wrong(wrong) => {
                    let path = survey.folder().part(number, parts);
                    say::note(&format!("{}: {wrong}", path.display()));
                }
                State::Right(_) => {}
            }
        }
        if !absent.is_empty() {
            let what = if absent.len() == 1 {
                "this part is"
            } else {
                "these parts are"
            };
            let path = survey.folder().path().display();
            say::note(&format!("{what} not in {path}: {}", parts::list(&absent)));
        }
        if survey.pictures().len() > 1 {
            say::note(&several(survey.pictures()));
        }
        let left = match missing.len() {
            1 => "1 part is".to_owned(),
            many => format!("{many} parts are"),
        };
        let not_made = if args.check {
            String::new()
        } else {
            format!("{target} is not made: ")
        };
        say::note(&format!("{not_made}{left} to be made, of {parts}"));
    }
    say::data(&format!("{}\n", parts::list(&missing)))?;
    Ok(Answer::No)
}

/// How the pictures differ that parts are of.
fn several(pictures: &[(Header, Vec<u32>)]) -> String {
    let mut text = format!(
        "these are parts of {} pictures. Which one is wanted they do not tell, so all are to be made: `plumb render` \
         keeps those that are right",
        pictures.len()
    );
    for (header, numbers) in pictures {
        let of_another = |text: &&(String, String)| {
            pictures
                .iter()
                .any(|(other, _)| !other.texts.contains(text))
        };
        let differs = header.texts.iter().filter(of_another);
        let mut told: Vec<String> = differs
            .map(|(key, text)| format!("{} {text}", key.strip_prefix("plumb:").unwrap_or(key)))
            .collect();
        if told.is_empty() {
            let id = format!("{:?}", header.identity);
            told.push(format!("a scene or a cut of its own ({})", &id[..8]));
        }
        text += &format!("\n  {}: {}", parts::list(numbers), told.join(", "));
    }
    text
}

/// Writes the picture, durably. None where a part turned out not to be right; then there is none.
pub(crate) fn write(
    survey: &Survey,
    target: &Target,
    format: Format,
    hashed: bool,
    talks: bool,
) -> Result<Option<Finished>> {
    let Some(header) = survey.picture() else {
        bail!("there are no parts");
    };
    if header.values != format.wants_values() {
        let (has, ending) = if header.values {
            ("values, for .exr", "EXR")
        } else {
            ("bytes, for .ppm and .png", "PPM or PNG")
        };
        bail!(
            "{target} is to be {format}, but the parts have {has}: they were rendered with -o of an {ending}"
        );
    }
    let rows = header.picture.len() as u32;
    check_size(format, header.width, rows)?;
    let software = (SOFTWARE_KEY.to_owned(), SOFTWARE.to_owned());
    let entries = [software].into_iter().chain(header.texts.clone()).collect();
    let size = [header.width, rows];
    let metadata = Metadata { entries };
    let mut picture = PictureFile::open(target, format, size, metadata, hashed)?.durable();
    let mut progress = Progress::new(u64::from(rows), talks);
    let joined = parts::join(survey, &mut |band| {
        picture.write(band)?;
        progress.add(band.rows.len() as u64);
        Ok(())
    });
    progress.clear();
    match joined {
        Ok(_) => Ok(Some(picture.finish()?)),
        Err(JoinError::Emit(source)) => Err(picture.failed(source)),
        Err(JoinError::Part { .. }) => Ok(None),
    }
}

/// Removes what a killed process has left beside a picture that it wrote. Nobody may be writing it.
pub(crate) fn remove_left(target: &Target) -> Result<()> {
    let path = target.path();
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let is_ours = |name: &str| path.file_name().is_some_and(|own| own == name);
    remove_left_in(folder, &is_ours).with_context(|| cannot_read(folder))
}

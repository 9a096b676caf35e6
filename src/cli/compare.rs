//! `plumb compare`: whether two pictures are the same, and how they differ; the exit code is the answer.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use plumb::files::is_same_file;
use plumb::image::{self, Comparison, Format, Metadata, Picture, ReadError, SizesDiffer, Target};
use serde_json::json;

use super::{Answer, SOFTWARE, picture, say};

/// What `plumb compare` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Pictures are read as PPM, PNG or EXR, whatever their names say; EXR is quantised as a rendering is. Rows count from \
the bottom. Exit 0: the same; 1: different pixels or sizes; 2: one cannot be read.")]
pub(crate) struct Args {
    /// One picture
    a: PathBuf,
    /// The other
    b: PathBuf,
    /// Write a picture of where they differ, by its ending .ppm or .png: bright where they do, dark grey where they do
    /// not
    #[arg(long, value_name = "OUT")]
    diff: Option<PathBuf>,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
}

/// Compares the pictures.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let diff = args
        .diff
        .as_ref()
        .map(|out| target(out, args))
        .transpose()?;
    let read = |path: &Path| {
        let (picture, remark) = image::read_with_remark(path)?;
        if let Some(odd) = remark {
            say::note(&format!("{} {odd}", path.display()));
        }
        Ok::<_, ReadError>(picture)
    };
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let compared = image::compare(&a, &b);
    if let Some((target, format)) = &diff {
        match image::difference(&a, &b) {
            Ok(picture) => write(picture, target, *format)?,
            Err(_) => say::note(&format!(
                "{target} is not written: pictures of different sizes have no difference picture"
            )),
        }
    }
    let same = compared.as_ref().is_ok_and(Comparison::is_same);
    let text = if args.json {
        to_json(args, &compared)
    } else {
        to_text(args, &compared)
    };
    match &diff {
        // The difference picture has stdout for itself.
        Some((target, _)) if target.is_stdout() => say::talk(&text),
        _ => say::data(&text)?,
    }
    Ok(if same { Answer::Yes } else { Answer::No })
}

/// Where the difference picture goes.
fn target(out: &Path, args: &Args) -> Result<(Target, Format)> {
    let target = Target::from_argument(out.as_os_str());
    let format = picture::bytes_format(&target, "--diff")?;
    if target.is_stdout() {
        picture::check_stdout()?;
    }
    if [&args.a, &args.b]
        .iter()
        .any(|read| is_same_file(out, read))
    {
        bail!(
            "{} is one of the pictures to compare: give the difference another name",
            out.display()
        );
    }
    Ok((target, format))
}

/// Writes the difference picture.
fn write(picture: Picture, target: &Target, format: Format) -> Result<()> {
    let metadata = Metadata {
        entries: vec![("Software".to_owned(), SOFTWARE.to_owned())],
    };
    let mut out = picture::PictureFile::open(
        target,
        format,
        [picture.width, picture.height],
        metadata,
        false,
    )?;
    match out.write(&picture.into_band()) {
        Ok(()) => out.finish().map(drop).map_err(Into::into),
        Err(source) => Err(out.failed(source)),
    }
}

fn to_text(args: &Args, compared: &Result<Comparison, SizesDiffer>) -> String {
    let names = format!("{} and {}", args.a.display(), args.b.display());
    let c = match compared {
        Ok(c) => c,
        Err(SizesDiffer { a, b }) => {
            return format!(
                "{names} have different sizes: {}×{} and {}×{}\n",
                a.0, a.1, b.0, b.1
            );
        }
    };
    let size = format!("{}×{}", c.width, c.height);
    let Some(worst) = &c.worst else {
        return format!("{names} are the same: {size}, all {} pixels\n", c.pixels);
    };
    let mut text = format!("{names} differ: {size}\n");
    let [red, green, blue] = c.channels;
    let percent = significant(c.percent);
    let _ = writeln!(
        text,
        "  pixels that differ  {} of {} ({percent} %); in red {red}, green {green}, blue {blue}",
        c.different, c.pixels
    );
    let _ = writeln!(
        text,
        "  worst channel       {} at ({}, {}) from the bottom left: {} and {}, {} apart",
        worst.channel, worst.x, worst.y, worst.a, worst.b, worst.difference
    );
    let _ = writeln!(text, "  RMS                 {} of 255", significant(c.rms));
    text
}

/// Three digits that say something, however small the number: a single pixel must not read as 0.00 %.
fn significant(value: f64) -> String {
    if value <= 0.0 {
        return "0".to_owned();
    }
    let decimals = (2 - value.log10().floor() as i32).clamp(0, 20) as usize;
    format!("{value:.decimals$}")
}

fn to_json(args: &Args, compared: &Result<Comparison, SizesDiffer>) -> String {
    let (a, b) = (args.a.display().to_string(), args.b.display().to_string());
    let value = match compared {
        Ok(c) => {
            json!({ "a": a, "b": b, "same": c.is_same(), "sizes_differ": false, "comparison": c })
        }
        Err(differ) => json!({
            "a": a,
            "b": b,
            "same": false,
            "sizes_differ": true,
            "sizes": [[differ.a.0, differ.a.1], [differ.b.0, differ.b.1]],
        }),
    };
    format!("{value:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pixel_of_many_is_not_nothing() {
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(100.0), "100");
        assert_eq!(significant(12.345), "12.3");
        assert_eq!(significant(1e-6), "0.00000100");
    }
}

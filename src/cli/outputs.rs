//! The pictures of a rendering on their way out: the picture itself, and the one of its verdicts.

use std::{io, iter};

use plumb::certify::verdict;
use plumb::image::{Finished, OutputError};
use plumb::render::Band;

use super::picture::PictureFile;

/// The picture, and the one of its verdicts, on their way out.
pub(crate) struct Outputs {
    pub(crate) picture: PictureFile,
    pub(crate) verdicts: Option<PictureFile>,
}

impl Outputs {
    /// Writes the next rows.
    pub(crate) fn write(&mut self, band: &Band) -> io::Result<()> {
        if let Some(verdicts) = &mut self.verdicts
            && let Some(painted) = verdict::paint(band)
        {
            verdicts.write(&painted).map_err(|source| {
                io::Error::other(OutputError::Write {
                    target: verdicts.target().clone(),
                    source,
                })
            })?;
        }
        self.picture.write(band)
    }

    /// Whether nothing has reached its place before the end.
    pub(crate) fn can_restart(&self) -> bool {
        let mut all = iter::once(&self.picture).chain(&self.verdicts);
        all.all(PictureFile::can_restart)
    }

    /// What an error of [`Outputs::write`] means.
    pub(crate) fn failed(self, source: io::Error) -> anyhow::Error {
        self.picture.failed(source)
    }

    /// Gives both their names.
    pub(crate) fn finish(self) -> Result<Finished, OutputError> {
        let finished = self.picture.finish()?;
        if let Some(verdicts) = self.verdicts {
            verdicts.finish()?;
        }
        Ok(finished)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use plumb::certify::DecidedBy;
    use plumb::image::{Format, Metadata, Target};

    use super::*;

    fn open(folder: &std::path::Path) -> Outputs {
        let picture = |name: &str| {
            let target = Target::Path(folder.join(name));
            PictureFile::open(&target, Format::Ppm, [1, 2], Metadata::default(), false).unwrap()
        };
        Outputs {
            picture: picture("a.ppm"),
            verdicts: Some(picture("b.ppm")),
        }
    }

    fn band(row: u32, byte: u8) -> Band {
        Band {
            rows: row..row + 1,
            rgb: vec![byte; 3],
            values: None,
            verdicts: Some(vec![DecidedBy::Gpu]),
        }
    }

    /// What was written before is dropped without a trace, and what comes then is whole.
    #[test]
    fn pictures_written_beside_can_be_begun_anew() {
        let folder = tempfile::tempdir().unwrap();
        let mut outputs = open(folder.path());
        outputs.write(&band(1, 7)).unwrap();
        assert!(outputs.can_restart());
        drop(outputs);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let mut outputs = open(folder.path());
        outputs.write(&band(1, 8)).unwrap();
        outputs.write(&band(0, 9)).unwrap();
        outputs.finish().unwrap();
        let picture = fs::read(folder.path().join("a.ppm")).unwrap();
        assert!(picture.ends_with(&[8, 8, 8, 9, 9, 9]));
        let verdicts = fs::read(folder.path().join("b.ppm")).unwrap();
        assert!(verdicts.ends_with(&verdict::color(DecidedBy::Gpu)));
    }

    #[cfg(unix)]
    #[test]
    fn what_is_written_through_cannot_be_begun_anew() {
        let target = Target::Path("/dev/null".into());
        let mut outputs = Outputs {
            picture: PictureFile::open(&target, Format::Ppm, [1, 2], Metadata::default(), false)
                .unwrap(),
            verdicts: None,
        };
        outputs.write(&band(1, 7)).unwrap();
        assert!(!outputs.can_restart());
    }
}

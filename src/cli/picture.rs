//! A picture on its way from the command line's jobs into `plumb::image`: opened early, but stdout late.

use std::io::{self, IsTerminal};

use anyhow::{Result, bail};
use plumb::image::{Finished, Format, Metadata, Output, OutputError, Target};
use plumb::render::Band;

use super::inherited::check_stdout as check_open;

/// Refuses to write a picture to stdout where it would be regretted, or lost.
pub(crate) fn check_stdout() -> Result<()> {
    check_open()?;
    if io::stdout().is_terminal() {
        bail!(
            "the picture would go to the terminal: redirect it, `> picture.ppm`, or give a name with -o"
        );
    }
    Ok(())
}

/// The format of a picture that is made of bytes alone; `what` is what it is for.
pub(crate) fn bytes_format(target: &Target, what: &str) -> Result<Format> {
    match target.format() {
        Ok(format) if !format.wants_values() => Ok(format),
        _ => {
            bail!("{what} is a picture of bytes, and {target} names none: write it as .png or .ppm")
        }
    }
}

/// The picture on its way out. A file is opened before anything is rendered, so that a name that cannot be written
/// costs no time; stdout, which cannot fail to open, when there is something to write: an error before leaves it empty.
pub(crate) struct PictureFile {
    target: Target,
    format: Format,
    width: u32,
    rows: u32,
    metadata: Metadata,
    /// Whether its hash is wanted, whatever its format.
    hashed: bool,
    output: Option<Output>,
}

impl PictureFile {
    /// Opens what is not stdout, for `rows` rows of `width` pixels.
    pub(crate) fn open(
        target: &Target,
        format: Format,
        [width, rows]: [u32; 2],
        metadata: Metadata,
        hashed: bool,
    ) -> Result<Self, OutputError> {
        let mut picture = Self {
            target: target.clone(),
            format,
            width,
            rows,
            metadata,
            hashed,
            output: None,
        };
        if !target.is_stdout() {
            picture.opened()?;
        }
        Ok(picture)
    }

    /// Has the picture outlive a power cut once it is finished, where it is a file.
    pub(crate) fn durable(self) -> Self {
        // What is opened late is stdout, where nothing stays.
        Self {
            output: self.output.map(Output::durable),
            ..self
        }
    }

    fn opened(&mut self) -> Result<&mut Output, OutputError> {
        let output = match self.output.take() {
            Some(output) => output,
            None => {
                let output = Output::open(
                    self.target.clone(),
                    self.format,
                    self.width,
                    self.rows,
                    self.metadata.clone(),
                )?;
                if self.hashed {
                    output.hashing()
                } else {
                    output
                }
            }
        };
        Ok(self.output.insert(output))
    }

    /// Where it goes.
    pub(crate) fn target(&self) -> &Target {
        &self.target
    }

    /// Whether dropping it leaves everything as it was, so that it can be begun anew.
    pub(crate) fn can_restart(&self) -> bool {
        self.output.as_ref().is_none_or(Output::is_beside)
    }

    /// Writes the next rows.
    pub(crate) fn write(&mut self, band: &Band) -> io::Result<()> {
        self.opened().map_err(io::Error::other)?.write(band)
    }

    /// What an error of [`PictureFile::write`] means, when it comes back from the rendering.
    pub(crate) fn failed(self, source: io::Error) -> anyhow::Error {
        // An error that came from `opened` is returned as it was.
        match source.downcast::<OutputError>() {
            Ok(error) => error.into(),
            Err(source) => OutputError::Write {
                target: self.target,
                source,
            }
            .into(),
        }
    }

    /// Ends the picture and gives it its name.
    pub(crate) fn finish(mut self) -> Result<Finished, OutputError> {
        self.opened()?;
        let Self {
            target,
            rows,
            output,
            ..
        } = self;
        output.map_or(
            Err(OutputError::Unfinished {
                target,
                written: 0,
                rows,
            }),
            Output::finish,
        )
    }
}

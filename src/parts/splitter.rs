//! Rows on their way into parts: bands as they are rendered, of whatever height, end in the parts that they belong to.

use std::io;

use super::cut::Cut;
use super::folder::Folder;
use super::header::Header;
use super::identity::Identity;
use super::writer::{PartFile, Rows};
use crate::frame::Band;
use crate::image::{Metadata, OutputError, Target};
use crate::scene::Scene;
use crate::settings::Settings;

/// Makes parts out of bands. Each has its name as soon as its last row has come.
pub struct Splitter<'a> {
    folder: &'a Folder,
    cut: &'a Cut,
    like: Header,
    current: Option<PartFile>,
    next: u32,
    made: Vec<u32>,
}

impl<'a> Splitter<'a> {
    /// Of the scene's picture, whose next rows are those of part `first`.
    pub fn new(
        folder: &'a Folder,
        cut: &'a Cut,
        (scene, settings): (&Scene, &Settings),
        texts: Metadata,
        first: u32,
    ) -> Self {
        Self {
            folder,
            cut,
            like: Header {
                identity: Identity::new(scene, settings, cut),
                width: scene.camera.pixeldim[0],
                picture: cut.picture(),
                number: first,
                parts: cut.parts(),
                rows: cut.rows(first),
                values: settings.values,
                texts: texts.entries,
            },
            current: None,
            next: first,
            made: Vec::new(),
        }
    }

    /// What the next part says of itself.
    fn header(&self) -> Header {
        Header {
            number: self.next,
            rows: self.cut.rows(self.next),
            ..self.like.clone()
        }
    }

    /// Opens the file of the first part: a name that cannot be written costs no rendering.
    ///
    /// # Errors
    /// As for a picture.
    pub fn open(&mut self) -> Result<&mut PartFile, OutputError> {
        let part = match self.current.take() {
            Some(part) => part,
            None => {
                let path = self.folder.part(self.next, self.cut.parts());
                PartFile::open(&path, self.header())?
            }
        };
        Ok(self.current.insert(part))
    }

    /// Takes the next rows.
    ///
    /// # Errors
    /// What the system says, or an [`OutputError`] inside.
    pub fn write(&mut self, band: &Band) -> io::Result<()> {
        let width = self.like.width as usize;
        let mut end = band.rows.end;
        while end > band.rows.start {
            let path = self.folder.part(self.next, self.cut.parts());
            let part = self.open().map_err(io::Error::other)?;
            let missing = part.missing();
            if missing.end != end {
                let misfit = "a band that is not the next one of the part";
                return Err(io::Error::new(io::ErrorKind::InvalidInput, misfit));
            }
            let start = missing.start.max(band.rows.start);
            let above = |row: u32| (band.rows.end - row) as usize * width;
            let range = above(end)..above(start);
            let rows = Rows {
                rgb: &band.rgb[3 * range.start..3 * range.end],
                values: band.values.as_ref().map(|values| &values[range.clone()]),
                verdicts: band.verdicts.as_ref().map(|verdicts| &verdicts[range]),
            };
            part.write(end - start, rows).map_err(|source| {
                let target = Target::Path(path);
                io::Error::other(OutputError::Write { target, source })
            })?;
            if start == missing.start
                && let Some(part) = self.current.take()
            {
                part.finish().map_err(io::Error::other)?;
                self.made.push(self.next);
                self.next += 1;
            }
            end = start;
        }
        Ok(())
    }

    /// The parts that were made, and have their names.
    pub fn made(&self) -> &[u32] {
        &self.made
    }
}

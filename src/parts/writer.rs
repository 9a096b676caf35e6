//! One part on its way into its file: whole there under its name, or not there.

use std::io;
use std::ops::Range;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::header::{Header, Layout};
use crate::frame::DecidedBy;
use crate::image::{Document, OutputError, Target};

/// Rows of a picture, the top one first: what a part takes, and what is kept of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows<'a> {
    pub(super) rgb: &'a [u8],
    pub(super) values: Option<&'a [[f32; 3]]>,
    pub(super) verdicts: Option<&'a [DecidedBy]>,
}

/// A part on its way. [`finish`](PartFile::finish) gives it its name; dropped without, nothing remains.
pub struct PartFile {
    document: Document,
    target: Target,
    header: Header,
    layout: Layout,
    /// Hashes the header, then the footer.
    seal: Sha256,
    hashes: Vec<u8>,
    /// The rows that there are of the chunk that is not whole yet.
    chunk: Vec<u8>,
    values: Vec<u8>,
    presumed: u64,
    /// Rows that have come, and chunks that have been written.
    came: u32,
    written: u32,
}

impl PartFile {
    /// Opens the file.
    ///
    /// # Errors
    /// As for a picture.
    pub fn open(path: &Path, header: Header) -> Result<Self, OutputError> {
        let target = Target::Path(path.to_owned());
        let mut document = Document::open(&target)?;
        let bytes = header.encode();
        document
            .append(&bytes)
            .map_err(|source| OutputError::Write {
                target: target.clone(),
                source,
            })?;
        Ok(Self {
            document,
            target,
            layout: header.layout(),
            header,
            seal: Sha256::new_with_prefix(&bytes),
            hashes: Vec::new(),
            chunk: Vec::new(),
            values: Vec::new(),
            presumed: 0,
            came: 0,
            written: 0,
        })
    }

    /// The rows that have not come yet, counted from the bottom.
    pub(super) fn missing(&self) -> Range<u32> {
        let Range { start, end } = self.header.rows;
        start..end - self.came
    }

    /// Takes so many rows, the next ones.
    pub(super) fn write(&mut self, rows: u32, from: Rows<'_>) -> io::Result<()> {
        let pixels = self.header.width as usize * rows as usize;
        let values = from.values.map(<[[f32; 3]]>::len);
        let fits = from.rgb.len() == 3 * pixels
            && values == self.header.values.then_some(pixels)
            && rows <= self.missing().len() as u32;
        if !fits {
            let misfit = "rows that are not the next ones of the part, or not whole";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, misfit));
        }
        let is_presumed = |by: &&DecidedBy| **by == DecidedBy::Presumed;
        let verdicts = from.verdicts.unwrap_or_default();
        self.presumed += verdicts.iter().filter(is_presumed).count() as u64;
        let mut done = 0;
        while done < rows {
            let Range { end, .. } = self.layout.rows_of(self.written);
            let next = (end - self.came).min(rows - done);
            let width = self.header.width as usize;
            let range = done as usize * width..(done + next) as usize * width;
            self.chunk
                .extend_from_slice(&from.rgb[3 * range.start..3 * range.end]);
            let values = from.values.and_then(|values| values.get(range));
            for value in values.unwrap_or_default().as_flattened() {
                self.values.extend(value.to_le_bytes());
            }
            self.came += next;
            done += next;
            if self.came == end {
                self.end_chunk()?;
            }
        }
        Ok(())
    }

    /// Writes the chunk, which is whole.
    fn end_chunk(&mut self) -> io::Result<()> {
        self.chunk.append(&mut self.values);
        self.hashes.extend(Sha256::digest(&self.chunk));
        self.written += 1;
        self.document.append(&self.chunk)?;
        self.chunk.clear();
        Ok(())
    }

    /// Ends the part and gives it its name; it outlives a power cut from here on. Returns the length of its file.
    ///
    /// # Errors
    /// As for a picture.
    pub fn finish(self) -> Result<u64, OutputError> {
        let Self {
            mut document,
            target,
            header,
            layout,
            mut seal,
            hashes,
            presumed,
            came,
            ..
        } = self;
        let rows = header.rows.len() as u32;
        if came != rows {
            return Err(OutputError::Unfinished {
                target,
                written: came,
                rows,
            });
        }
        let mut footer = presumed.to_le_bytes().to_vec();
        footer.extend(hashes);
        seal.update(&footer);
        footer.extend(seal.finalize());
        match document.append(&footer) {
            Ok(()) => document.finish(true)?,
            Err(source) => return Err(OutputError::Write { target, source }),
        }
        Ok(layout.length())
    }
}

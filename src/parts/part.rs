//! A part's file on its way back. It may come from anywhere: nothing is believed that was not checked, and no memory
//! taken for what a header claims before the file is known to be as long.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::header::{FIXED, HASH, Header, Layout, Malformed};
use crate::files::reason;

/// Why a part cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// There is no file by that name.
    #[error("it is not there")]
    Missing,
    /// The system does not let us read it.
    #[error("it cannot be read: {}", reason(.0))]
    Io(io::Error),
    /// It is not what it should be; how, after "it".
    #[error("{0}")]
    Wrong(String),
}

impl From<io::Error> for PartError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            // It was longer when its length was asked for.
            io::ErrorKind::UnexpectedEof => {
                Self::Wrong("it was cut short while it was read".into())
            }
            _ => Self::Io(error),
        }
    }
}

impl From<Malformed> for PartError {
    fn from(malformed: Malformed) -> Self {
        Self::Wrong(match malformed {
            Malformed::Magic => "it is no part of a picture".into(),
            Malformed::Version(what) => format!("{what}: it is another plumb's"),
            Malformed::Numbers(which) => format!("its header is damaged: {which}"),
        })
    }
}

/// A part whose header and footer are right. Its rows are checked as they are read.
#[derive(Debug)]
pub struct Part {
    path: PathBuf,
    file: File,
    header: Header,
    layout: Layout,
    presumed: u64,
    hashes: Vec<u8>,
}

impl Part {
    /// Opens it, and checks all but the rows.
    ///
    /// # Errors
    /// If it is not there, or not right.
    pub fn open(path: &Path) -> Result<Self, PartError> {
        // What is no file (a pipe) might never be opened.
        if !fs::metadata(path)?.is_file() {
            return Err(PartError::Wrong("it is no file".into()));
        }
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let short = || PartError::Wrong(format!("it is cut short: {length} bytes are no part"));
        if length < FIXED as u64 {
            return Err(short());
        }
        let mut fixed = [0; FIXED];
        read_at(&file, &mut fixed, 0)?;
        let (header, texts) = Header::decode(&fixed)?;
        let layout = header.layout_with(texts);
        let whole = layout.length();
        if length != whole {
            let how = if length < whole {
                "cut short"
            } else {
                "too long"
            };
            let what = format!("it is {how}: {length} bytes of {whole}");
            return Err(PartError::Wrong(what));
        }
        // From here on what is allocated is less than the file has.
        let mut texts = vec![0; texts as usize];
        read_at(&file, &mut texts, FIXED as u64)?;
        let mut footer = vec![0; layout.footer_length() as usize];
        read_at(&file, &mut footer, layout.footer())?;
        let damaged = |what: &str| PartError::Wrong(format!("it is damaged: {what}"));
        let (footer, seal) = footer.split_at(footer.len() - HASH);
        let mut hash = Sha256::new_with_prefix(fixed);
        hash.update(&texts);
        hash.update(footer);
        if hash.finalize()[..] != *seal {
            return Err(damaged("its header's hash is another"));
        }
        let texts = Header::decode_texts(&texts).ok_or_else(|| damaged("its texts"))?;
        let (presumed, hashes) = footer
            .split_first_chunk::<8>()
            .ok_or_else(|| damaged("its end"))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            header: Header { texts, ..header },
            layout,
            presumed: u64::from_le_bytes(*presumed),
            hashes: hashes.to_vec(),
        })
    }

    /// What it says of itself.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Its file's name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Pixels of it that are presumed, not proven.
    pub fn presumed(&self) -> u64 {
        self.presumed
    }

    /// How many chunks it has.
    pub(super) fn chunks(&self) -> u32 {
        self.layout.chunks()
    }

    /// Where what is.
    pub(super) fn layout(&self) -> Layout {
        self.layout
    }

    /// Reads a chunk in place of what `read` holds, and checks it.
    pub(super) fn read(&self, chunk: u32, read: &mut Vec<u8>) -> Result<(), PartError> {
        let bytes = self.layout.bytes_of(chunk);
        read.resize((bytes.end - bytes.start) as usize, 0);
        read_at(&self.file, read, bytes.start)?;
        let at = chunk as usize * HASH;
        if self.hashes.get(at..at + HASH) == Some(&Sha256::digest(&read)[..]) {
            return Ok(());
        }
        let rows = self.layout.rows_of(chunk);
        let top = self.header.rows.end;
        let (first, last) = (top - rows.end, top - rows.start - 1);
        let what = format!("it is damaged: the hash of its rows {first} to {last} is another");
        Err(PartError::Wrong(what))
    }

    /// Checks all of its rows.
    ///
    /// # Errors
    /// If they are not right.
    pub fn check(&self) -> Result<(), PartError> {
        (0..self.chunks())
            .into_par_iter()
            .try_for_each_init(Vec::new, |read, chunk| self.read(chunk, read))
    }
}

/// Reads from a place, however many threads do so.
#[cfg(unix)]
fn read_at(file: &File, bytes: &mut [u8], at: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, at)
}

/// Reads from a place, however many threads do so.
#[cfg(windows)]
fn read_at(file: &File, mut bytes: &mut [u8], mut at: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match std::os::windows::fs::FileExt::seek_read(file, bytes, at)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            read => {
                bytes = &mut bytes[read..];
                at += read as u64;
            }
        }
    }
    Ok(())
}

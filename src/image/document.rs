//! A file that is no picture, such as a plot or a part of a picture: written like one, whole or not at all.

use std::io::{self, Write};

use super::sink::Sink;
use super::{OutputError, Target};

/// A file on its way: opened early, so that a name that cannot be written costs no work.
#[derive(Debug)]
pub struct Document {
    target: Target,
    sink: Sink,
}

impl Document {
    /// Opens the target.
    ///
    /// # Errors
    /// As for a picture.
    pub fn open(target: &Target) -> Result<Self, OutputError> {
        Ok(Self {
            target: target.clone(),
            sink: Sink::open(target)?,
        })
    }

    /// Writes all of it, and gives it its name.
    ///
    /// # Errors
    /// If writing fails; then nothing is there that was not there before.
    pub fn write(mut self, bytes: &[u8]) -> Result<(), OutputError> {
        match self.append(bytes) {
            Ok(()) => self.finish(false),
            Err(source) => Err(OutputError::Write {
                target: self.target,
                source,
            }),
        }
    }

    /// Writes more of it.
    ///
    /// # Errors
    /// What the system says.
    pub fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sink.write_all(bytes)
    }

    /// All of it is written: gives it its name. A `durable` one outlives a power cut from here on.
    ///
    /// # Errors
    /// If what was still to be written cannot be, or the name not given; then nothing is there that was not there
    /// before.
    pub fn finish(self, durable: bool) -> Result<(), OutputError> {
        let Self { target, sink } = self;
        sink.commit(durable)
            .map_err(|source| OutputError::Write { target, source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_replaces_the_old_one_when_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        std::fs::write(&path, "old").unwrap();
        let target = Target::Path(path.clone());
        drop(Document::open(&target).unwrap());
        let document = Document::open(&target).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        document.write(b"new one").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new one");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = Target::Path(folder.path().join("none/a.svg"));
        assert!(Document::open(&nowhere).is_err());
    }
}

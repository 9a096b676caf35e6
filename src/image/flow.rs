//! The file that a `sink` writes, and when the system puts its bytes on the disk.
//!
//! Left to itself it waits until much is there, or until it is told to at the end; the disk does nothing meanwhile.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};

/// About so many bytes are handed to the disk at a time.
const PIECE: u64 = 16 << 20;

/// A file that is written from its start to its end.
#[derive(Debug)]
pub(super) struct Flow {
    pub(super) file: File,
    /// Where the bytes begin that are not on their way to the disk yet; none where it is left to the system.
    pub(super) early: Option<u64>,
    /// Where the next byte goes.
    at: u64,
}

impl Flow {
    pub(super) fn new(file: File) -> Self {
        Self {
            file,
            early: None,
            at: 0,
        }
    }

    /// Has the system begin with what has come.
    fn begin(&mut self) {
        if let Some(from) = self.early
            && self.at >= from + PIECE
        {
            begin(&self.file, from..self.at);
            self.early = Some(self.at);
        }
    }
}

/// Has the system put these bytes on the disk, and does not wait. It is a hint: where it fails, so will the end, which
/// waits.
#[cfg(target_os = "linux")]
#[expect(
    unsafe_code,
    reason = "the system's call is unsafe to call, as all of C's"
)]
fn begin(file: &File, bytes: std::ops::Range<u64>) {
    use std::os::fd::AsRawFd as _;
    let (Ok(from), Ok(length)) = (
        libc::off64_t::try_from(bytes.start),
        libc::off64_t::try_from(bytes.end - bytes.start),
    ) else {
        return;
    };
    // SAFETY: the call takes numbers alone, and the file is open.
    let _ = unsafe {
        libc::sync_file_range(file.as_raw_fd(), from, length, libc::SYNC_FILE_RANGE_WRITE)
    };
}

/// Elsewhere the system is not asked.
#[cfg(not(target_os = "linux"))]
fn begin(_file: &File, _bytes: std::ops::Range<u64>) {}

impl Write for Flow {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.at += written as u64;
        self.begin();
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Flow {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.file.seek(to)?;
        Ok(self.at)
    }
}

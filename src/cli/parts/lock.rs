//! A folder that one process alone may use at a time.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

/// A file that is locked while it is there.
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Keeps two processes from making the same picture in the same folder.
    pub(super) fn of(folder: &Path) -> Result<Self> {
        let path = folder.join(".plumb-lock");
        let failed = || format!("cannot write {}", path.display());
        let file = File::create(&path).with_context(failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => bail!(
                "another plumb makes this picture: {} is locked",
                path.display()
            ),
            // Some file systems have no locks.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self { path, file }),
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Whoever comes next makes one of its own; where this fails, the lock ends with the process.
        let _ = fs::remove_file(&self.path);
        let _ = self.file.unlock();
    }
}

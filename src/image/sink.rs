//! Where the encoders' bytes go, so that a good name only ever stands for a whole picture.
//!
//! Below `output` and the encoders; `target` has told what the name stands for.
//!
//! - A regular file is written beside, in the same folder, and renamed at the end: who reads the name sees the old file
//!   or the new one. It gets the mode of the file it replaces, or that of any newly created file. Access lists and
//!   extended attributes are not carried over.
//! - A file that renaming would change in more than its bytes (it has other hard links, or another owner) is written
//!   beside too, and copied into the old one at the end. Writing into it from the start would lose the old picture to
//!   every error and every Ctrl-C; this loses it only to an error in the middle of the copy, and the copy takes the
//!   space it needs before it touches an old byte.
//! - Devices, named pipes and stdout are written through.
//!
//! The files beside are removed when a [`Sink`] is dropped, and by [`remove_unfinished`] when the process is about to
//! end without dropping anything. Only a process that is killed outright leaves one, `.plumb-NAME-…`; who takes over
//! its work removes that ([`remove_left`]).

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use tempfile::TempPath;

use super::OutputError;
use super::flow::Flow;
use super::left::prefix;
use super::target::{self, Found, Target};

/// Bytes gathered before they are handed to the system. What comes in larger pieces is not copied.
const BUFFER: usize = 1 << 17;

/// An open target: takes bytes, and at the end [`commit`](Sink::commit)s them. Dropped without, nothing remains.
#[derive(Debug)]
pub(super) struct Sink {
    writer: BufWriter<Flow>,
    ending: Ending,
}

/// What makes the bytes written a finished picture.
#[derive(Debug)]
enum Ending {
    /// They are where they belong.
    Through,
    /// The file beside gets the name.
    Rename(Unfinished, PathBuf),
    /// The file beside is copied into the one that is there.
    Copy(Unfinished, File),
}

impl Sink {
    /// Opens the target: from here on, only running out of space and the like can fail.
    ///
    /// Opening a named pipe waits until someone reads it.
    pub(super) fn open(target: &Target) -> Result<Self, OutputError> {
        let path = match target {
            Target::Path(path) if !target.is_stdout() => path,
            _ => {
                return Self::stdout().map_err(|source| OutputError::Open {
                    path: "stdout".into(),
                    source,
                });
            }
        };
        let failed = |source| OutputError::Open {
            path: path.clone(),
            source,
        };
        match target::find(path)? {
            Found::Nothing(end) => {
                let (file, unfinished) = beside(path, &end)?;
                Ok(Self::new(file, Ending::Rename(unfinished, end)))
            }
            Found::File(end, old) => {
                // Renaming needs no right to write the old file; without this a protected file would be replaced.
                let protected = OpenOptions::new().write(true).open(&end).map_err(failed)?;
                let (file, unfinished) = beside(path, &end)?;
                let ending = if take_mode(&file, &old).map_err(failed)? {
                    Ending::Rename(unfinished, end)
                } else {
                    Ending::Copy(unfinished, protected)
                };
                Ok(Self::new(file, ending))
            }
            Found::Special => {
                let file = OpenOptions::new().write(true).open(path).map_err(failed)?;
                Ok(Self::new(file, Ending::Through))
            }
        }
    }

    /// A second handle to stdout. Not `io::stdout`, which looks for line ends in what it is given.
    fn stdout() -> io::Result<Self> {
        #[cfg(unix)]
        let stdout = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned()?;
        #[cfg(windows)]
        let stdout =
            std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned()?;
        Ok(Self::new(File::from(stdout), Ending::Through))
    }

    fn new(file: File, ending: Ending) -> Self {
        Self {
            writer: BufWriter::with_capacity(BUFFER, Flow::new(file)),
            ending,
        }
    }

    /// The file, for an encoder that goes back in it; of use only where nothing reaches the target before the end.
    pub(super) fn seekable(&mut self) -> &mut BufWriter<Flow> {
        &mut self.writer
    }

    /// Has the system begin to put the file on the disk while it is written, since [`commit`](Sink::commit) is going to
    /// wait for it.
    pub(super) fn begin_early(&mut self) {
        if self.is_beside() {
            self.writer.get_mut().early = Some(0);
        }
    }

    /// Whether nothing reaches the target before the end.
    pub(super) fn is_beside(&self) -> bool {
        !matches!(self.ending, Ending::Through)
    }

    /// Everything written becomes the target. A `durable` one outlives a power cut from here on: the system has put it
    /// where it stays, name and all.
    pub(super) fn commit(self, durable: bool) -> io::Result<()> {
        let flow = self.writer.into_inner();
        let mut file = flow.map_err(io::IntoInnerError::into_error)?.file;
        match self.ending {
            Ending::Through => Ok(()),
            // Closed before it is renamed: some network file systems keep the last errors, and the last bytes, for
            // then.
            Ending::Rename(unfinished, end) => {
                if durable {
                    file.sync_all()?;
                }
                drop(file);
                unfinished.rename(&end)?;
                if durable { sync_folder(&end) } else { Ok(()) }
            }
            Ending::Copy(unfinished, mut old) => {
                // The lock is held until the copy is whole, so that Ctrl-C waits for it.
                let registry = registry();
                let copied = copy_into(&mut file, &mut old);
                drop(registry);
                let copied = copied.and_then(|()| if durable { old.sync_all() } else { Ok(()) });
                drop(file);
                drop(unfinished);
                copied
            }
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Has the system keep the name of a file.
#[cfg(unix)]
fn sync_folder(end: &Path) -> io::Result<()> {
    File::open(end.parent().unwrap_or(Path::new(".")))?.sync_all()
}

/// Elsewhere folders cannot be opened; the system sees to their names itself.
#[cfg(not(unix))]
fn sync_folder(_end: &Path) -> io::Result<()> {
    Ok(())
}

/// A new file in the folder of `end`, with the mode that any new file gets.
fn beside(path: &Path, end: &Path) -> Result<(File, Unfinished), OutputError> {
    let folder = end.parent().unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    let prefix = prefix(end);
    builder.prefix(&prefix);
    #[cfg(unix)]
    {
        // The umask is taken off by the system, as for any file; tempfile alone would make it private.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut registry = registry();
    let (file, temporary) = builder
        .tempfile_in(folder)
        .map_err(|source| OutputError::Create {
            path: path.to_owned(),
            folder: folder.to_owned(),
            source,
        })?
        .into_parts();
    registry.unfinished.push(temporary.to_path_buf());
    Ok((file, Unfinished(Some(temporary))))
}

/// Gives `file` the mode of the file it is to replace. False if that is not all that tells the two apart, so that
/// replacing would change more than the bytes.
#[cfg(unix)]
fn take_mode(file: &File, old: &fs::Metadata) -> io::Result<bool> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let new = file.metadata()?;
    if old.nlink() != 1 || (old.uid(), old.gid()) != (new.uid(), new.gid()) {
        return Ok(false);
    }
    // Writing into a file takes set-user-id and its like off; so do we.
    Ok(file
        .set_permissions(fs::Permissions::from_mode(old.mode() & 0o777))
        .is_ok())
}

/// Elsewhere modes and owners are inherited from the folder, and links cannot be counted.
#[cfg(not(unix))]
fn take_mode(_file: &File, _old: &fs::Metadata) -> io::Result<bool> {
    Ok(true)
}

/// Makes `old` hold the bytes of `new`. What may run out of space comes first, while every old byte is still there.
fn copy_into(new: &mut File, old: &mut File) -> io::Result<()> {
    let new_length = new.metadata()?.len();
    let old_length = old.metadata()?.len();
    if new_length > old_length {
        let grown = copy_range(new, old, old_length, new_length);
        if grown.is_err() {
            // The error that is told is the first one.
            let _ = old.set_len(old_length);
            return grown;
        }
    }
    let copied =
        copy_range(new, old, 0, new_length.min(old_length)).and_then(|()| old.set_len(new_length));
    if copied.is_err() {
        // The file is half old and half new now; it is emptied, since no picture is better than one that is neither.
        let _ = old.set_len(0);
    }
    copied
}

/// Copies the bytes from `start` to `end` to the same place.
fn copy_range(from: &mut File, to: &mut File, start: u64, end: u64) -> io::Result<()> {
    from.seek(SeekFrom::Start(start))?;
    to.seek(SeekFrom::Start(start))?;
    let copied = io::copy(&mut from.take(end - start), to)?;
    if copied == end - start {
        Ok(())
    } else {
        Err(io::ErrorKind::UnexpectedEof.into())
    }
}

/// A file beside, which disappears when dropped, unless it was renamed. `None` only once it is renamed.
#[derive(Debug)]
struct Unfinished(Option<TempPath>);

impl Unfinished {
    /// Gives the file its name.
    fn rename(mut self, end: &Path) -> io::Result<()> {
        let mut registry = registry();
        let Some(temporary) = self.0.take() else {
            return Ok(());
        };
        registry.forget(&temporary);
        // Where this fails, the error holds the file and removes it.
        temporary.persist(end).map_err(|failed| failed.error)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Some(temporary) = self.0.take() {
            let mut registry = registry();
            registry.forget(&temporary);
            drop(temporary);
        }
    }
}

/// Every file beside that is there now.
#[derive(Debug)]
struct Registry {
    unfinished: Vec<PathBuf>,
    /// Set for good once the process is about to end.
    ending: bool,
}

impl Registry {
    fn forget(&mut self, path: &Path) {
        self.unfinished.retain(|known| known != path);
    }
}

static REGISTRY: Mutex<Registry> = Mutex::new(Registry {
    unfinished: Vec::new(),
    ending: false,
});

/// The registry, for who creates, renames or removes a file; held while doing so, so that it never tells of less than
/// there is. Does not return once the process is about to end: a file created or named now would stay.
fn registry() -> MutexGuard<'static, Registry> {
    let registry = lock();
    if registry.ending {
        drop(registry);
        loop {
            thread::park();
        }
    }
    registry
}

/// A panic elsewhere does not make the list of files wrong.
fn lock() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file that is not finished yet: for a handler of Ctrl-C that ends the process right afterwards.
///
/// A file that is being renamed, or copied into one with several links, is waited for. From here on whoever opens,
/// finishes or drops an [`Output`](super::Output) waits for the end of the process, so that nothing appears, and no
/// error is told, between this and the exit.
pub fn remove_unfinished() {
    let mut registry = lock();
    registry.ending = true;
    for path in registry.unfinished.drain(..) {
        // A file that cannot be removed, or is gone already, is passed over: there is nobody left to tell.
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with these bytes, open for both.
    fn file(bytes: &[u8]) -> File {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(bytes).unwrap();
        file
    }

    fn read(file: &mut File) -> Vec<u8> {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(0)).unwrap();
        file.read_to_end(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn a_copy_is_whole_whether_it_grows_or_shrinks() {
        for (old, new) in [
            ("", "abc"),
            ("abc", ""),
            ("abc", "defgh"),
            ("abcde", "fg"),
            ("abc", "def"),
        ] {
            let mut into = file(old.as_bytes());
            copy_into(&mut file(new.as_bytes()), &mut into).unwrap();
            assert_eq!(read(&mut into), new.as_bytes());
        }
    }

    #[test]
    fn a_copy_that_cannot_grow_leaves_the_old_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("old");
        fs::write(&path, "old").unwrap();
        // Not open for writing: growing fails, as on a full disk.
        let mut old = File::open(&path).unwrap();
        assert!(copy_into(&mut file(b"longer"), &mut old).is_err());
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }
}

//! Watching the scene's file: from what happens in its folder to news for the window.
//!
//! ```text
//! listen: the system's events ─ a sign ─┐
//!         every half second, a look ────┴─► read ─► settle: is it quiet? ─► News
//! ```
//!
//! Editors save in many ways: over the file, beside it and then renamed over it, after deleting it, twice. So nothing
//! is made of the kind of an event: it is only a sign to look. What is found counts once it stays, which [`settle`]
//! decides.

mod listen;
mod settle;
#[cfg(test)]
mod tests;
mod textures;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use crate::scene::{LoadError, read_file};
use listen::Ears;
use settle::Settle;
pub(super) use textures::{TextureWatch, textures};

/// Between looks without a sign: some file systems (those of a network) send none, and a folder may be replaced as a
/// whole.
const LOOK: Duration = Duration::from_millis(500);

/// The same while the system sends no signs at all.
const LOOK_DEAF: Duration = Duration::from_millis(100);

/// How long after a change the file is read at every look, even if it seems untouched: the time of its last change is
/// told in steps of up to 2 s (FAT), and a second change may fall into the same one.
const FRESH: Duration = Duration::from_secs(3);

/// The least time between two looks, however many signs there are.
const BREATH: Duration = Duration::from_millis(2);

/// What became of the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum News {
    /// Its content, other than what was told last: new, or back again.
    Text(Vec<u8>),
    /// There is no such file any more, or its folder is gone.
    Gone,
    /// It is there and cannot be read; why, with its path, in the words of [`LoadError`].
    Unreadable(String),
}

/// Tells of the file until it is dropped.
#[derive(Debug)]
pub(super) struct Watcher {
    stopped: Arc<AtomicBool>,
    wake: SyncSender<()>,
}

/// Where signs come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Senses {
    /// Whether to listen to what the system tells.
    listen: bool,
    /// Between looks without a sign, while it is listened to.
    look: Duration,
}

impl Watcher {
    /// Starts to watch `path`. `tell` runs on a thread of its own: first, at once, with what there is now, whatever it
    /// is; then with each change. The same news never comes twice in a row: what is told is always other than what was
    /// told before it, so after [`News::Gone`] the same text is news again.
    ///
    /// Nothing has to be there yet; neither the file nor its folder. `path` is looked up anew each time: links may
    /// change.
    ///
    /// # Errors
    /// When there can be no thread.
    pub(super) fn new(path: &Path, tell: impl FnMut(News) + Send + 'static) -> io::Result<Watcher> {
        let senses = Senses {
            listen: true,
            look: LOOK,
        };
        Watcher::with(senses, path, tell)
    }

    fn with(
        senses: Senses,
        path: &Path,
        tell: impl FnMut(News) + Send + 'static,
    ) -> io::Result<Watcher> {
        let stopped = Arc::new(AtomicBool::new(false));
        // The channel has room for one sign, since one says all that many would.
        let (wake, signs) = mpsc::sync_channel(1);
        let watch = Watch {
            path: path.to_owned(),
            senses,
            ears: Ears::new(wake.clone()),
            signs,
            stopped: Arc::clone(&stopped),
        };
        thread::Builder::new()
            .name(String::from("watch"))
            .spawn(move || watch.run(tell))?;
        Ok(Watcher { stopped, wake })
    }
}

impl Drop for Watcher {
    /// The thread ends by itself, which is not waited for: a file on a server that does not answer must not hold up who
    /// closes the window. What it is telling at that moment may still arrive; nothing after it.
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Relaxed);
        // A full channel is a sign that is waiting already.
        let _ = self.wake.try_send(());
    }
}

/// What the thread has.
struct Watch {
    path: PathBuf,
    senses: Senses,
    ears: Ears,
    signs: Receiver<()>,
    stopped: Arc<AtomicBool>,
}

impl Watch {
    fn run(mut self, mut tell: impl FnMut(News)) {
        let started = Instant::now();
        let mut settle = Settle::default();
        let mut stamp = None;
        let mut fresh_until = Duration::ZERO;
        let mut sign = true;
        loop {
            // Ears first: what changes after they are set up is heard, what changed before is read now.
            if self.senses.listen {
                self.ears.turn_to(&self.path);
            }
            let now = started.elapsed();
            let found = Stamp::of(&self.path);
            if stamp != found {
                stamp = found;
                fresh_until = now + FRESH;
            }
            if sign || stamp.is_none() || now < fresh_until || settle.next().is_some() {
                let news = settle.look(now, read(&self.path));
                if self.stopped.load(Ordering::Relaxed) {
                    return;
                }
                if let Some(news) = news {
                    tell(news);
                }
            }
            let pause = if self.ears.hear() {
                self.senses.look
            } else {
                LOOK_DEAF
            };
            let due = settle.next().map_or(now + pause, |d| d.min(now + pause));
            sign = self.wait(due.saturating_sub(started.elapsed()));
            if self.stopped.load(Ordering::Relaxed) {
                return;
            }
            if sign && let Some(early) = (now + BREATH).checked_sub(started.elapsed()) {
                thread::sleep(early);
            }
        }
    }

    /// Waits for a sign, and says whether there was one.
    fn wait(&self, at_most: Duration) -> bool {
        match self.signs.recv_timeout(at_most) {
            Ok(()) => true,
            // The ears have a sender, so there always is one.
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => false,
        }
    }
}

/// What tells, without reading it, that a file was written or replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    length: u64,
    modified: Option<SystemTime>,
    /// Device, inode, and the time of its last change, which nothing sets back.
    #[cfg(unix)]
    identity: [i128; 4],
}

impl Stamp {
    /// Of the file that `path` leads to; none where there is none.
    fn of(path: &Path) -> Option<Stamp> {
        let metadata = fs::metadata(path).ok()?;
        Some(Stamp {
            length: metadata.len(),
            modified: metadata.modified().ok(),
            #[cfg(unix)]
            identity: unix_identity(&metadata),
        })
    }
}

#[cfg(unix)]
fn unix_identity(metadata: &fs::Metadata) -> [i128; 4] {
    use std::os::unix::fs::MetadataExt;
    [
        metadata.dev().into(),
        metadata.ino().into(),
        metadata.ctime().into(),
        metadata.ctime_nsec().into(),
    ]
}

/// What there is at this moment.
pub(super) fn read(path: &Path) -> News {
    // Opening a pipe would wait for its writer.
    if fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        return News::Unreadable(format!(
            "{}: not a file, which alone can be watched",
            path.display()
        ));
    }
    // Absence is asked for first, since the loader would search for similar names.
    if fs::metadata(path).is_err_and(|error| is_absence(&error)) {
        return News::Gone;
    }
    match read_file(path) {
        Ok(bytes) => News::Text(bytes),
        Err(LoadError::Io { source, .. }) if is_absence(&source) => News::Gone,
        Err(error) => News::Unreadable(error.to_string()),
    }
}

/// Whether an error says that there is no such file. A folder on the way to it may have become a file.
fn is_absence(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
    )
}

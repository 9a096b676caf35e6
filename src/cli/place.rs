//! The place of a picture among many: whose turn it is to be rendered, and to be written.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use plumb::render::{Turn, Turns};

use super::progress::Progress;

/// Steps of the bar for each picture.
const STEPS: u64 = 1000;

/// What the pictures of a run share.
pub(crate) struct Queue {
    count: usize,
    rendering: Turns,
    writing: Turns,
    progress: Mutex<Progress>,
    /// Whether a stream ends in the middle of a picture, so that nothing may come behind it.
    cut: AtomicBool,
}

impl Queue {
    /// Of so many; a bar is shown if it is wanted.
    pub(crate) fn new(count: usize, bar: bool) -> Self {
        Self {
            count,
            rendering: Turns::default(),
            writing: Turns::default(),
            progress: Mutex::new(Progress::new(count as u64 * STEPS, bar)),
            cut: AtomicBool::new(false),
        }
    }

    /// The place of a picture, which is called this.
    pub(crate) fn place<'a>(&'a self, number: usize, name: &'a str) -> Place<'a> {
        Place {
            queue: self,
            name,
            rendering: self.rendering.turn(number),
            writing: self.writing.turn(number),
        }
    }

    /// Whether a stream ends in the middle of a picture.
    pub(crate) fn is_cut(&self) -> bool {
        self.cut.load(Ordering::Relaxed)
    }

    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.progress().clear();
    }
}

/// The place of a picture. When it is dropped, the next picture has its turn.
pub(crate) struct Place<'a> {
    queue: &'a Queue,
    name: &'a str,
    rendering: Turn<'a>,
    writing: Turn<'a>,
}

impl Place<'_> {
    /// Waits until the scene may be read: until the picture before is the one that is being made. So no more than one
    /// scene waits in memory.
    pub(crate) fn wait_to_read(&self) {
        self.rendering.wait_until_next();
    }

    /// The turn to be rendered.
    pub(crate) fn turn(&self) -> &Turn<'_> {
        &self.rendering
    }

    /// Waits until the pictures before are written, and what was to be said of them is said.
    ///
    /// # Errors
    /// If one of them was cut off, so that nothing may be written behind it.
    pub(crate) fn wait_to_write(&self) -> io::Result<()> {
        self.writing.wait();
        if self.queue.is_cut() {
            return Err(io::Error::other("the picture before was cut off"));
        }
        Ok(())
    }

    /// Rows of the picture were written, and so many of so many are left.
    pub(crate) fn wrote(&self, left: u32, rows: u32) {
        let number = self.writing.number();
        let part = STEPS * u64::from(rows - left) / u64::from(rows);
        let doing = format!("{} of {}, {}", number + 1, self.queue.count, self.name);
        self.queue
            .progress()
            .reach(number as u64 * STEPS + part, &doing);
    }

    /// The picture went into a stream, and is not whole.
    pub(crate) fn cut_off(&self) {
        self.queue.cut.store(true, Ordering::Relaxed);
    }
}

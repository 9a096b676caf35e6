//! A bar on stderr for work that takes a while, where somebody may be watching.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);

/// Whether a bar stands on the terminal now, for who ends the process without taking it away.
static SHOWN: AtomicBool = AtomicBool::new(false);

/// Whether a bar stands on the terminal now.
pub(crate) fn is_shown() -> bool {
    SHOWN.load(Ordering::Relaxed)
}

/// Steps done, of all: rows of a picture, or whatever the work has.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// When to begin to show it; None once it is shown, or if it never will be.
    pending: Option<Instant>,
}

impl Progress {
    /// Of so many steps; shown if it is `wanted` and stderr is a terminal.
    pub(crate) fn new(steps: u64, wanted: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left") {
            bar.set_style(style);
        }
        let watched = wanted && io::stderr().is_terminal();
        Self {
            bar,
            pending: watched.then(|| Instant::now() + PATIENCE),
        }
    }

    /// So many steps more are done.
    pub(crate) fn add(&mut self, steps: u64) {
        self.bar.inc(steps);
        if self.pending.is_some_and(|when| Instant::now() >= when) {
            self.pending = None;
            SHOWN.store(true, Ordering::Relaxed);
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// Takes the bar away, whatever came of the work.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
        SHOWN.store(false, Ordering::Relaxed);
    }
}

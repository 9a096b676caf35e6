//! A bar on stderr for work that takes a while, where somebody may be watching.

use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);

/// The bar that stands on the terminal now.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Whether a bar stands on the terminal now, for who ends the process without taking it away.
pub(crate) fn is_shown() -> bool {
    // Whoever holds it is drawing, or may wait for ever for a terminal that takes nothing.
    SHOWN.try_lock().is_ok_and(|shown| shown.is_some())
}

/// Lets `write` write to the terminal, with the bar out of the way.
pub(crate) fn aside<T>(write: impl FnOnce() -> T) -> T {
    let shown = SHOWN.lock().unwrap_or_else(PoisonError::into_inner).clone();
    match shown {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
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
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left{msg}")
        {
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
        self.show();
    }

    /// So many steps are done, and this is what is done now.
    pub(crate) fn reach(&mut self, steps: u64, doing: &str) {
        self.bar.set_position(steps);
        if !self.bar.is_hidden() || self.pending.is_some() {
            self.bar.set_message(format!("; {doing}"));
        }
        self.show();
    }

    /// Shows the bar when it is time.
    fn show(&mut self) {
        if self.pending.is_some_and(|when| Instant::now() >= when) {
            self.pending = None;
            *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self.bar.clone());
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// Takes the bar away, whatever came of the work.
    pub(crate) fn clear(&self) {
        SHOWN.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.bar.finish_and_clear();
    }
}

//! What is being done for the picture that was wished for, and how far it is: written by the worker, read by the window
//! for its status line.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::settings::Precision;

/// What is being done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Doing {
    /// Nothing: the picture is all that was wished for.
    Nothing,
    /// The shader is composed and compiled. Some drivers do so when the first dispatch is handed in, so it ends with
    /// the first rows.
    Compiling,
    /// Rows are made.
    Rendering {
        /// What the bytes are going to be.
        precision: Precision,
        /// The share of the rows that is done.
        share: f64,
        /// About how many seconds the others take; none where it is too early to tell.
        left: Option<f64>,
    },
    /// A fast picture is there; if nothing moves it is certified next.
    Waiting,
}

impl Doing {
    /// In a few words; none where nothing is done.
    pub(super) fn words(self) -> Option<String> {
        match self {
            Self::Nothing => None,
            Self::Compiling => Some("compiling".into()),
            Self::Waiting => Some("certified next".into()),
            Self::Rendering {
                precision,
                share,
                left,
            } => {
                let verb = match precision {
                    Precision::Fast => "rendering",
                    Precision::Certified => "certifying",
                };
                let left = left.map(|seconds| match seconds {
                    ..0.1 => String::new(),
                    0.1..9.95 => format!(", about {seconds:.1} s left"),
                    _ => format!(", about {seconds:.0} s left"),
                });
                let left = left.unwrap_or_default();
                // All of it is done only when the picture is there.
                let percent = (100.0 * share).floor().min(99.0);
                Some(format!("{verb} {percent} %{left}"))
            }
        }
    }
}

/// What the worker does, under a lock that nobody holds for long.
#[derive(Debug)]
pub(super) struct Progress(Mutex<Stage>);

#[derive(Debug)]
enum Stage {
    Nothing,
    Compiling(Precision),
    Rendering {
        precision: Precision,
        share: f64,
        /// When the first rows came, and which share they were.
        since: (Instant, f64),
    },
    Waiting,
}

/// From less than this nothing is foretold.
const TOLD: (Duration, f64) = (Duration::from_millis(200), 0.02);

impl Default for Progress {
    fn default() -> Self {
        Self(Mutex::new(Stage::Nothing))
    }
}

impl Progress {
    /// What is being done now.
    pub(super) fn doing(&self) -> Doing {
        self.doing_at(Instant::now())
    }

    fn doing_at(&self, now: Instant) -> Doing {
        match *self.stage() {
            Stage::Nothing => Doing::Nothing,
            Stage::Compiling(_) => Doing::Compiling,
            Stage::Waiting => Doing::Waiting,
            Stage::Rendering {
                precision,
                share,
                since: (since, first),
            } => {
                let (took, done) = (now.saturating_duration_since(since), share - first);
                let known = took >= TOLD.0 && done >= TOLD.1;
                Doing::Rendering {
                    precision,
                    share,
                    left: known.then(|| took.as_secs_f64() / done * (1.0 - share)),
                }
            }
        }
    }

    /// A picture is begun.
    pub(super) fn begin(&self, precision: Precision) {
        *self.stage() = Stage::Compiling(precision);
    }

    /// So much of it is done.
    pub(super) fn reached(&self, done: f64) {
        self.reached_at(done, Instant::now());
    }

    fn reached_at(&self, done: f64, now: Instant) {
        let mut stage = self.stage();
        match &mut *stage {
            Stage::Rendering { share, .. } => *share = done,
            Stage::Compiling(precision) => {
                *stage = Stage::Rendering {
                    precision: *precision,
                    share: done,
                    since: (now, done),
                };
            }
            Stage::Nothing | Stage::Waiting => {}
        }
    }

    /// The picture is done, or given up.
    pub(super) fn end(&self) {
        *self.stage() = Stage::Nothing;
    }

    /// It is waited whether anything moves.
    pub(super) fn wait(&self) {
        *self.stage() = Stage::Waiting;
    }

    fn stage(&self) -> MutexGuard<'_, Stage> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_moment_of_a_picture_has_its_words() {
        let progress = Progress::default();
        let start = Instant::now();
        let at = |seconds: f64| start + Duration::from_secs_f64(seconds);
        let said = |seconds: f64| progress.doing_at(at(seconds)).words();
        assert_eq!(said(0.0), None);
        progress.begin(Precision::Fast);
        assert_eq!(said(0.0).unwrap(), "compiling");
        progress.reached_at(0.1, at(1.0));
        // What compiling took says nothing about the rows.
        assert_eq!(said(1.0).unwrap(), "rendering 10 %");
        progress.reached_at(0.4, at(1.6));
        assert_eq!(said(1.6).unwrap(), "rendering 40 %, about 1.2 s left");
        progress.end();
        progress.wait();
        assert_eq!(said(2.0).unwrap(), "certified next");
        progress.begin(Precision::Certified);
        progress.reached_at(0.01, at(3.0));
        progress.reached_at(0.02, at(4.0));
        assert_eq!(said(4.0).unwrap(), "certifying 2 %");
        progress.reached_at(0.51, at(23.0));
        assert_eq!(said(23.0).unwrap(), "certifying 51 %, about 20 s left");
        progress.reached_at(1.0, at(50.0));
        assert_eq!(said(50.0).unwrap(), "certifying 99 %");
        progress.end();
        assert_eq!(said(51.0), None);
    }
}

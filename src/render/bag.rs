//! The picture as a bag of bands: whoever makes pixels takes rows from it, from the top, and brings them back finished.
//!
//! All workers make the same bytes, so it does not matter who makes which band. Finished bands go out in order, on the
//! thread that asked for the picture, and no more of them than a few million pixels are made ahead. A worker that
//! leaves, whatever the fault, gives its bands back; where it was found to be wrong, the rows of it that went out
//! already become work for the CPU, to be compared. [`share`] says how large a band is to be, and when one is made
//! twice. Knows nothing of how bands are made.

mod share;
mod state;
#[cfg(test)]
mod tests;
mod worker;

use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::Error;
use crate::frame::spare;
use crate::frame::{Emit, Halt};
use crate::stopwatch::{Phase, Stopwatch};
use state::State;

pub(super) use worker::{Activity, Finished, Kind, Role};

/// How often a worker that waits for a slower one looks whether it would be quicker itself.
const LOOK: Duration = Duration::from_millis(5);

/// The rows of a picture, and how far they are.
pub(super) struct Bag {
    state: Mutex<State>,
    changed: Condvar,
}

/// What a worker gets that asks for rows.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Taken {
    /// These are to be made.
    Rows(Range<u32>),
    /// There are none now, but there may be soon.
    Later,
    /// There will be none any more.
    End,
}

impl Bag {
    /// With rows of so many pixels; bands have `band_rows` rows, if that was asked for.
    pub(super) fn new(width: u32, rows: Range<u32>, band_rows: Option<u32>) -> Self {
        Self {
            state: Mutex::new(State::new(width, rows, band_rows)),
            changed: Condvar::new(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state and wakes all who wait for a change.
    fn change<T>(&self, how: impl FnOnce(&mut State) -> T) -> T {
        let result = how(&mut self.lock());
        self.changed.notify_all();
        result
    }

    /// A worker joins; returns its number.
    pub(super) fn join(&self, kind: Kind, role: Role) -> usize {
        self.change(|state| state.join(kind, role))
    }

    /// From now on the worker is able to work.
    pub(super) fn ready(&self, worker: usize) {
        self.change(|state| state.ready(worker));
    }

    /// Rows for a worker that would like `wish` of them, and can do with bands of `most` where they were cut by others;
    /// waits for them if asked to. For the CPU there may be some until the rendering is over.
    pub(super) fn take(&self, worker: usize, wish: u32, most: u32, wait: bool) -> Taken {
        let started = Instant::now();
        let mut state = self.lock();
        let taken = loop {
            match state.take(worker, wish, most) {
                Taken::Later if wait => {
                    state = match self.changed.wait_timeout(state, LOOK) {
                        Ok((state, _)) => state,
                        Err(poisoned) => poisoned.into_inner().0,
                    };
                }
                taken => break taken,
            }
        };
        if wait {
            state.waited(worker, started.elapsed());
        }
        taken
    }

    /// A band is finished.
    pub(super) fn deliver(&self, finished: Finished) {
        let compares = self.lock().compares(&finished.band.rows);
        let hash = compares.then(|| worker::hash(&finished.band));
        self.change(|state| state.deliver(finished, hash));
    }

    /// A band cannot be made, since one of its pixels needs too many rays. Bands above it come first.
    pub(super) fn halt(&self, rows: &Range<u32>, halt: Halt) {
        self.change(|state| state.halt(rows, halt));
    }

    /// The rendering ends with this error, unless it ended before.
    pub(super) fn fail(&self, error: Error) {
        self.change(|state| state.fail(error));
    }

    /// Whether nobody has brought these rows yet, and somebody wants them.
    pub(super) fn wants(&self, rows: &Range<u32>) -> bool {
        self.lock().wants(rows)
    }

    /// Waits until the workers of now are seen to need longer than this for what is left: rows below may be harder than
    /// those above. False if the rendering ends before that.
    pub(super) fn lasts(&self, time: Duration) -> bool {
        let mut state = self.lock();
        loop {
            if state.is_over() {
                return false;
            }
            if state.lasts(time) {
                return true;
            }
            state = self
                .changed
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// A worker that uses the same cores is getting ready, while the others work on this part of them; or it will not
    /// come.
    pub(super) fn expect(&self, expected: Option<f64>) {
        self.change(|state| state.expected = expected);
    }

    /// The CPU, which would make so many pixels a second, leaves all cores to the worker that is expected, for this
    /// time.
    pub(super) fn rest(&self, time: Duration, speed: f64) {
        self.change(|state| state.rest = Some((Instant::now() + time, speed)));
    }

    /// Whether one is.
    pub(super) fn is_warming(&self) -> bool {
        self.lock().is_warming()
    }

    /// Whether all rows are made, whether they went out or not.
    pub(super) fn is_made(&self) -> bool {
        self.lock().is_made()
    }

    /// Whether no other worker makes bands, or may make some.
    pub(super) fn is_alone(&self, worker: usize) -> bool {
        self.lock().is_alone(worker)
    }

    /// The rendering is over, whatever came of it.
    pub(super) fn end(&self) {
        self.change(|state| state.over = true);
    }

    /// Why rows that went out may be wrong, if that was found when there was nobody any more to compare them.
    pub(super) fn doubt(&self) -> Option<Error> {
        let why = self.lock().doubt()?;
        Some(Error::Revoked(why.to_string()))
    }

    /// Whether the rendering has ended.
    pub(super) fn is_over(&self) -> bool {
        self.lock().is_over()
    }

    /// The worker leaves; others make what it had taken. Returns whether there are others.
    pub(super) fn leave(&self, worker: usize) -> bool {
        self.change(|state| state.leave(worker))
    }

    /// The worker was sure and wrong: it leaves, and what it had brought counts only as far as others bring the same.
    /// If they do not, and it went out already, `why` is the error.
    pub(super) fn revoke(&self, worker: usize, why: &str) {
        self.change(|state| state.revoke(worker, why));
    }

    /// While it lives, the CPU is busy with what a device left open, and takes no bands itself.
    pub(super) fn refining(&self) -> Refining<'_> {
        self.lock().refining += 1;
        Refining(self)
    }

    /// What a worker did so far.
    pub(super) fn activity(&self, worker: usize) -> Activity {
        self.lock().activity(worker)
    }

    /// Hands all bands on in order, from the top, as they are finished. Returns when the last row went out and nothing
    /// is left to be compared, or with the error that ended the rendering.
    pub(super) fn emit(&self, emit: &mut Emit<'_>, watch: &mut Stopwatch) -> Result<(), Error> {
        let mut state = self.lock();
        loop {
            if let Some(error) = state.error.take() {
                state.over = true;
                self.changed.notify_all();
                return Err(error);
            }
            if state.is_whole() {
                state.over = true;
                self.changed.notify_all();
                return Ok(());
            }
            let finished = match state.next_to_emit() {
                Some(Ok(finished)) => finished,
                Some(Err(halt)) => {
                    state.fail(halt.into());
                    continue;
                }
                None => {
                    state = self
                        .changed
                        .wait(state)
                        .unwrap_or_else(PoisonError::into_inner);
                    continue;
                }
            };
            drop(state);
            watch.lap(Phase::Bands);
            let emitted = emit(&finished.band);
            watch.lap(Phase::Emit);
            state = self.lock();
            match emitted {
                Ok(()) => state.emitted(&finished),
                Err(error) => state.fail(error.into()),
            }
            self.changed.notify_all();
            spare::give(finished.band.rgb);
        }
    }
}

/// See [`Bag::refining`].
pub(super) struct Refining<'a>(&'a Bag);

impl Drop for Refining<'_> {
    fn drop(&mut self) {
        self.0.change(|state| state.refining -= 1);
    }
}

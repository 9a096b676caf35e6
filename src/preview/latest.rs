//! A letter box that holds one letter: whoever works on wishes gets the newest, and is told when what it works on is
//! old.
//!
//! Between the window's thread, which never waits, and those that render and explain.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The side that puts wishes in.
#[derive(Debug)]
pub(super) struct LatestSender<T> {
    shared: Arc<Shared<T>>,
}

/// The side that takes them out.
#[derive(Debug)]
pub(super) struct LatestReceiver<T> {
    shared: Arc<Shared<T>>,
}

#[derive(Debug)]
struct Shared<T> {
    /// The newest wish that was not taken, with its number.
    slot: Mutex<Option<(u64, T)>>,
    bell: Condvar,
    /// The number of the newest wish; [`CLOSED`] once there will be none.
    newest: AtomicU64,
}

/// In place of a number: nobody puts wishes in any more.
const CLOSED: u64 = u64::MAX;

impl<T> Shared<T> {
    fn slot(&self) -> MutexGuard<'_, Option<(u64, T)>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Both sides of a new box.
pub(super) fn latest<T>() -> (LatestSender<T>, LatestReceiver<T>) {
    let shared = Arc::new(Shared {
        slot: Mutex::new(None),
        bell: Condvar::new(),
        newest: AtomicU64::new(0),
    });
    let other = Arc::clone(&shared);
    (LatestSender { shared }, LatestReceiver { shared: other })
}

impl<T> LatestSender<T> {
    /// Puts a wish in, in place of one that was not taken yet. Returns its number: they rise.
    pub(super) fn put(&self, wish: T) -> u64 {
        let mut slot = self.shared.slot();
        let newest = self.shared.newest.load(Ordering::Relaxed);
        if newest == CLOSED {
            return CLOSED;
        }
        let number = newest + 1;
        self.shared.newest.store(number, Ordering::Release);
        *slot = Some((number, wish));
        self.shared.bell.notify_one();
        number
    }
}

impl<T> LatestSender<T> {
    /// Ends it: there will be no more wishes, and the newest is old.
    pub(super) fn close(&self) {
        let mut slot = self.shared.slot();
        self.shared.newest.store(CLOSED, Ordering::Release);
        *slot = None;
        self.shared.bell.notify_one();
    }
}

impl<T> Drop for LatestSender<T> {
    fn drop(&mut self) {
        self.close();
    }
}

impl<T> LatestReceiver<T> {
    /// Waits for a wish, and takes it with its number. None once there will be none.
    pub(super) fn take(&self) -> Option<(u64, T)> {
        let mut slot = self.shared.slot();
        loop {
            if let Some(wish) = slot.take() {
                return Some(wish);
            }
            if self.shared.newest.load(Ordering::Acquire) == CLOSED {
                return None;
            }
            slot = self
                .shared
                .bell
                .wait(slot)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether the wish of this number is not the newest any more, or nobody wants any.
    pub(super) fn is_old(&self, number: u64) -> bool {
        self.shared.newest.load(Ordering::Acquire) != number
    }

    /// Waits until then, unless the wish of this number becomes old before: whether it is still the newest.
    pub(super) fn rest(&self, number: u64, until: Instant) -> bool {
        let mut slot = self.shared.slot();
        loop {
            if self.is_old(number) {
                return false;
            }
            let left = until.saturating_duration_since(Instant::now());
            if left == Duration::ZERO {
                return true;
            }
            (slot, _) = self
                .shared
                .bell
                .wait_timeout(slot, left)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn only_the_newest_is_taken() {
        let (newest, receiver) = latest();
        for wish in 1..=5 {
            assert_eq!(newest.put(wish), wish);
        }
        assert_eq!(receiver.take(), Some((5, 5)));
        assert!(!receiver.is_old(5));
        newest.put(6);
        assert!(receiver.is_old(5));
        assert_eq!(receiver.take(), Some((6, 6)));
        newest.close();
        assert!(receiver.is_old(6));
        assert_eq!(receiver.take(), None);
        newest.put(7);
        assert_eq!(receiver.take(), None);
    }

    #[test]
    fn a_rest_ends_early_where_there_is_a_newer_wish() {
        let (newest, receiver) = latest();
        let number = newest.put(());
        assert!(receiver.take().is_some());
        let soon = Instant::now() + Duration::from_millis(5);
        assert!(receiver.rest(number, soon));
        assert!(Instant::now() >= soon);
        let never = Instant::now() + Duration::from_secs(600);
        let rested = thread::scope(|scope| {
            let rests = scope.spawn(|| receiver.rest(number, never));
            newest.put(());
            rests.join().unwrap()
        });
        assert!(!rested);
    }

    #[test]
    fn a_taker_that_waits_is_woken() {
        let (newest, receiver) = latest();
        let taken = thread::spawn(move || (receiver.take(), receiver.take()));
        newest.put(7);
        // It may or may not have been taken by now; either way it is the end that comes next.
        thread::sleep(Duration::from_millis(20));
        drop(newest);
        assert_eq!(taken.join().unwrap(), (Some((1, 7)), None));
    }
}

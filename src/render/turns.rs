//! Pictures that several threads render, one after the other: while one is being made, the next scene is prepared, and
//! the last rows of the picture before go out.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Whose turn it is, of all who are numbered from 0 without a gap.
#[derive(Debug, Default)]
pub struct Turns {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    /// Whose turn it is.
    now: usize,
    /// Those after it who will not take theirs.
    passed: BTreeSet<usize>,
}

/// A place among [`Turns`]. When it is dropped, it is somebody else's turn.
#[derive(Debug)]
pub struct Turn<'a> {
    turns: &'a Turns,
    number: usize,
    passed: AtomicBool,
}

impl Turns {
    /// The turn of this number, of which there is to be one.
    pub fn turn(&self, number: usize) -> Turn<'_> {
        Turn {
            turns: self,
            number,
            passed: AtomicBool::new(false),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait_for(&self, number: usize) {
        let mut state = self.lock();
        while state.now < number {
            state = self
                .changed
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Turn<'_> {
    /// The place in the order.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Waits for this turn; no longer once it came.
    pub fn wait(&self) {
        self.turns.wait_for(self.number);
    }

    /// Waits for the turn before this one.
    pub fn wait_until_next(&self) {
        self.turns.wait_for(self.number.saturating_sub(1));
    }

    /// Ends this turn, or gives it away before it came.
    pub fn pass(&self) {
        if self.passed.swap(true, Ordering::Relaxed) {
            return;
        }
        let mut state = self.turns.lock();
        state.passed.insert(self.number);
        loop {
            let now = state.now;
            if !state.passed.remove(&now) {
                break;
            }
            state.now += 1;
        }
        drop(state);
        self.turns.changed.notify_all();
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.pass();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;

    use super::*;

    #[test]
    fn turns_come_in_order_whoever_comes_first() {
        let turns = Turns::default();
        let (sender, receiver) = channel();
        thread::scope(|scope| {
            // The last one is there first, and one never takes its turn.
            for number in [3, 1, 2, 0] {
                let (turn, sender) = (turns.turn(number), sender.clone());
                scope.spawn(move || {
                    if number == 2 {
                        return;
                    }
                    turn.wait_until_next();
                    turn.wait();
                    sender.send(number).unwrap();
                    turn.pass();
                    // It came, and is not waited for again.
                    turn.wait();
                });
            }
        });
        drop(sender);
        assert_eq!(receiver.iter().collect::<Vec<_>>(), [0, 1, 3]);
    }

    #[test]
    fn who_is_next_waits_for_the_one_before_to_begin_and_not_to_end() {
        let turns = Turns::default();
        let (first, second, third) = (turns.turn(0), turns.turn(1), turns.turn(2));
        first.wait();
        second.wait_until_next();
        assert_eq!(turns.lock().now, 0);
        first.pass();
        third.wait_until_next();
        assert_eq!(turns.lock().now, 1);
    }
}

//! A gate for submissions to the device: it is closed while a window's surface is set up anew, and open otherwise.
//!
//! wgpu waits for the device to be idle then, and fails if another thread hands in work meanwhile.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Whether work may be handed in.
#[derive(Debug, Default)]
pub struct SubmitGate {
    closed: Mutex<bool>,
    bell: Condvar,
}

impl SubmitGate {
    /// Hands work in, once that is allowed.
    pub(super) fn pass<T>(&self, submit: impl FnOnce() -> T) -> T {
        let mut closed = self.lock();
        while *closed {
            closed = self
                .bell
                .wait(closed)
                .unwrap_or_else(PoisonError::into_inner);
        }
        submit()
    }

    /// Closes the gate: whoever wants to submit work waits until [`open`](Self::open). The thread that closes it must
    /// not submit anything itself.
    pub fn close(&self) {
        *self.lock() = true;
    }

    /// Lets everybody go on.
    pub fn open(&self) {
        *self.lock() = false;
        self.bell.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, bool> {
        self.closed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;

    #[test]
    fn nobody_hands_work_in_while_it_is_closed() {
        let gate = SubmitGate::default();
        assert_eq!(gate.pass(|| 1), 1);
        let may = AtomicBool::new(false);
        gate.close();
        thread::scope(|scope| {
            let work = || gate.pass(|| may.load(Ordering::SeqCst));
            let workers = [scope.spawn(work), scope.spawn(work)];
            thread::sleep(std::time::Duration::from_millis(20));
            may.store(true, Ordering::SeqCst);
            gate.open();
            for worker in workers {
                assert!(
                    worker.join().unwrap(),
                    "work was handed in while it was closed"
                );
            }
        });
    }
}

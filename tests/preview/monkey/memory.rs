//! The memory of a window that is used: it grows at first, and is to be steady then.

use std::fmt;
use std::time::{Duration, Instant};

/// Until then shaders, canvases and texts of all kinds are met for the first time, and kept: memory grows. So only runs
/// of several minutes say whether it is steady.
pub(crate) const WARM_UP: Duration = Duration::from_secs(60);

/// The most that a window has in the last quarter of its warm life may be so much more than in the quarter before: what
/// grows ever more slowly is steady in the end, and what grows evenly is not, once it has lived long enough.
const GROWTH_KIB: u64 = 30 * 1024;

/// What a window had, the most in each stretch of time, in KiB.
pub(crate) struct Memory {
    since: Instant,
    stretch: Duration,
    most: Vec<u64>,
}

impl Memory {
    /// Of a window that was just opened.
    pub(crate) fn new(stretch: Duration) -> Self {
        Self {
            since: Instant::now(),
            stretch,
            most: Vec::new(),
        }
    }

    /// Takes what it has now.
    pub(crate) fn is(&mut self, kib: u64) {
        let at = self.since.elapsed().as_secs_f64() / self.stretch.as_secs_f64();
        self.at(at as usize, kib);
    }

    fn at(&mut self, stretch: usize, kib: u64) {
        self.most.resize(self.most.len().max(stretch + 1), 0);
        self.most[stretch] = self.most[stretch].max(kib);
    }

    /// Whether it does not grow any more, as far as is known.
    pub(crate) fn is_steady(&self) -> bool {
        let warm = self.most.get(1..).unwrap_or_default();
        let quarter = warm.len() / 4;
        let last = warm.iter().rev();
        let most = |before: usize| last.clone().skip(before).take(quarter).max();
        most(0) <= most(quarter).map(|most| most + GROWTH_KIB).as_ref()
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stretch = self.stretch.as_secs();
        let most: Vec<_> = self.most.iter().map(|kib| kib / 1024).collect();
        write!(f, "a window had at most {most:?} MiB, each in {stretch} s")
    }
}

#[test]
fn memory_that_grows_is_noticed() {
    let steady = |most: &[u64]| {
        let mut memory = Memory::new(WARM_UP);
        for (i, mib) in most.iter().enumerate() {
            memory.at(i, 1024 * mib);
        }
        memory.is_steady()
    };
    assert!(steady(&[]) && steady(&[100]) && steady(&[100, 300]));
    assert!(steady(&[100, 250, 300, 310, 339]));
    assert!(!steady(&[100, 250, 300, 310, 341]));
    // It grows more slowly all the time, or it does not.
    assert!(steady(&[100, 200, 250, 280, 300, 310, 316, 320, 322]));
    assert!(!steady(&[100, 200, 220, 240, 260, 280, 300, 320, 340]));
}

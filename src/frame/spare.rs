//! Bytes of bands that have gone out, for the next bands: memory that was never touched before takes four times as long
//! to fill as memory in use.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// So many are kept: a band that is being filled, one that is finished, and one that is written, for two workers.
const KEPT: usize = 6;

static SPARE: Mutex<Vec<Vec<u8>>> = Mutex::new(Vec::new());

fn lock() -> MutexGuard<'static, Vec<Vec<u8>>> {
    SPARE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// So many bytes, whatever they are: whoever takes them has to write them all.
pub fn take(bytes: usize) -> Vec<u8> {
    let mut spare = lock();
    let fitting = spare.iter().enumerate();
    let fitting = fitting.filter(|(_, held)| held.capacity() >= bytes);
    let smallest = fitting.min_by_key(|(_, held)| held.capacity());
    let Some((place, _)) = smallest else {
        drop(spare);
        return vec![0; bytes];
    };
    let mut taken = spare.swap_remove(place);
    drop(spare);
    taken.resize(bytes, 0);
    taken
}

/// Keeps what is not needed any more.
pub fn give(bytes: Vec<u8>) {
    let mut spare = lock();
    spare.push(bytes);
    if spare.len() > KEPT {
        // Small ones are of no use to large bands.
        spare.sort_unstable_by_key(|held| std::cmp::Reverse(held.capacity()));
        spare.truncate(KEPT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Other tests give and take meanwhile, so no more is known than this.
    #[test]
    fn what_is_taken_is_as_long_as_was_asked_for() {
        for bytes in [10, 1000, 3, 0, 999] {
            let taken = take(bytes);
            assert_eq!(taken.len(), bytes);
            give(taken);
        }
        (0..20).for_each(|_| give(vec![1; 10]));
        assert!(lock().len() <= KEPT);
    }
}

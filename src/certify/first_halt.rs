//! Which of the pixels that are decided at the same time halts first, in the order of the picture: the complaint names
//! that one, whatever the threads do. Used by `pixels`.

use std::sync::{Mutex, PoisonError};

use crate::frame::Halt;

/// The first piece that halted, by its place, and why.
#[derive(Debug, Default)]
pub(super) struct FirstHalt(Mutex<Option<(usize, Halt)>>);

impl FirstHalt {
    /// Does the work of the piece at `place`, unless one before it has halted: then nobody asks for its result. Pieces
    /// before the first that halted are always worked on.
    pub(super) fn unless_later<T: Default>(
        &self,
        place: usize,
        work: impl FnOnce() -> Result<T, Halt>,
    ) -> T {
        if self.0.lock().is_ok_and(|first| is_before(&first, place)) {
            return T::default();
        }
        work().unwrap_or_else(|halt| {
            let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if !is_before(&first, place) {
                *first = Some((place, halt));
            }
            T::default()
        })
    }

    /// Why nothing came of it, if so.
    pub(super) fn end(self) -> Result<(), Halt> {
        let first = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        first.map_or(Ok(()), |(_, halt)| Err(halt))
    }
}

/// Whether a piece before this place has halted.
fn is_before(first: &Option<(usize, Halt)>, place: usize) -> bool {
    first.is_some_and(|(first, _)| first < place)
}

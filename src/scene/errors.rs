//! Collects what the parser (text → lex → parse → [`Scene`](super::Scene)) complains about, within bounds.

use crate::diagnostic::{Diagnostic, MAX_SHOWN};

/// The complaints about a file: the first ones whole, the rest counted.
#[derive(Debug, Default)]
pub(super) struct Errors {
    list: Vec<Diagnostic>,
    total: usize,
}

impl Errors {
    /// After so many the rest of the file is not read: it is no scene.
    pub(super) const MAX_COUNTED: usize = 10_000;

    /// Takes a complaint. Returns its number, to add to it later.
    pub(super) fn report(&mut self, error: Diagnostic) -> usize {
        let number = self.total;
        if self.list.len() < MAX_SHOWN && self.list.len() == number {
            self.list.push(error);
        }
        self.total += 1;
        number
    }

    /// Counts a complaint that need not be worded: enough were.
    pub(super) fn count_one(&mut self) {
        self.total += 1;
    }

    /// The complaint of a number that [`Errors::report`] returned, if it is among those that are shown.
    pub(super) fn at(&mut self, number: usize) -> Option<&mut Diagnostic> {
        self.list.get_mut(number)
    }

    /// Are there as many as are ever shown?
    pub(super) fn are_enough(&self) -> bool {
        self.list.len() >= MAX_SHOWN
    }

    /// Are there so many that reading on is of no use?
    pub(super) fn are_too_many(&self) -> bool {
        self.total >= Self::MAX_COUNTED
    }

    /// Is there none?
    pub(super) fn is_empty(&self) -> bool {
        self.total == 0
    }

    /// All of them, and their number.
    pub(super) fn into_parts(self) -> (Vec<Diagnostic>, usize) {
        (self.list, self.total)
    }
}

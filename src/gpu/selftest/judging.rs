//! What the self-tests with f32 and with f64 share: a check, what it says of a device's results, and a number that
//! changes with the checks.

use std::fmt::Debug;
use std::hash::{DefaultHasher, Hash, Hasher as _};
use std::ops::Range;

use super::Outcome;

/// A check: which of the words of a pair of operands it looks at, and whether they are right. None where the operands
/// are outside what the certified path needs.
pub(super) struct Check<P, W: 'static> {
    pub(super) name: &'static str,
    pub(super) asked: &'static str,
    pub(super) words: Range<usize>,
    pub(super) judge: fn(P, &[W]) -> Option<bool>,
}

/// A pair of operands that can be told.
pub(super) trait Operands: Copy {
    /// For people.
    fn shown(self) -> String;
}

/// Compares the words that a device wrote for these pairs, so many for each, with what they have to be.
pub(super) fn judge<P: Operands, W: Debug>(
    checks: &[Check<P, W>],
    pairs: &[P],
    results: &[W],
    each: usize,
) -> Vec<Outcome> {
    let outcome = |check: &Check<P, W>| {
        let mut cases = 0;
        let mut failure = None;
        for (pair, words) in pairs.iter().zip(results.chunks_exact(each)) {
            let words = &words[check.words.clone()];
            let Some(right) = (check.judge)(*pair, words) else {
                continue;
            };
            cases += 1;
            if !right && failure.is_none() {
                failure = Some(format!("{} gave {words:08x?}", pair.shown()));
            }
        }
        if results.len() != each * pairs.len() {
            failure = Some("results are missing".into());
        }
        Outcome {
            check: check.name,
            asked: check.asked,
            cases,
            failure,
        }
    };
    checks.iter().map(outcome).collect()
}

/// A number that changes when these checks do, or what else they depend on.
pub(super) fn version<P, W>(checks: &[Check<P, W>], rest: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    for check in checks {
        (check.name, check.asked).hash(&mut hasher);
    }
    (env!("CARGO_PKG_VERSION"), rest).hash(&mut hasher);
    hasher.finish()
}

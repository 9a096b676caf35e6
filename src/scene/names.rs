//! What names mean: which material or texture a reference is to, and what a misspelt word was meant to be.
//!
//! Used by the parser (text → lex → parse → [`Scene`](super::Scene)). A name means the first definition before its
//! use; whether a name that is unknown is defined later is known at the end of the file only, so complaints about
//! references wait until then.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use super::errors::Errors;
use super::lex::Token;
use crate::diagnostic::{Diagnostic, quote};

/// The longest word that is searched for, and the number of names, from the first, that are searched.
const MAX_WORD: usize = 64;
const MAX_CANDIDATES: usize = 1_000;

/// The definitions of one kind, and the references that found none.
#[derive(Debug)]
pub(super) struct Names<'t> {
    /// `material` or `texture`.
    kind: &'static str,
    /// How many there are, repeated names included.
    count: usize,
    /// The first definition of each name: its number, and the token of its name.
    defined: HashMap<&'t [u8], (usize, Token<'t>)>,
    /// The first names with their numbers: what a reference to nothing may have meant.
    candidates: Vec<(usize, &'t [u8])>,
    /// Names of entities that were not understood: they may be what a reference means.
    excused: HashSet<&'t [u8]>,
    /// References to nothing so far, each with the number of definitions at that point.
    unknown: Vec<(Token<'t>, usize)>,
}

impl<'t> Names<'t> {
    /// No definitions yet.
    pub(super) fn new(kind: &'static str) -> Self {
        Self {
            kind,
            count: 0,
            defined: HashMap::new(),
            candidates: Vec::new(),
            excused: HashSet::new(),
            unknown: Vec::new(),
        }
    }

    /// Counts a definition; without a name nothing can refer to it.
    pub(super) fn define(&mut self, name: Option<Token<'t>>) {
        if let Some(token) = name
            && let Entry::Vacant(entry) = self.defined.entry(token.text)
        {
            entry.insert((self.count, token));
            if self.candidates.len() < MAX_CANDIDATES {
                self.candidates.push((self.count, token.text));
            }
        }
        self.count += 1;
    }

    /// No complaint about references to this name: what it names was not understood, and that was said.
    pub(super) fn excuse(&mut self, name: Token<'t>) {
        self.excused.insert(name.text);
    }

    /// The definition that a name means.
    pub(super) fn known(&self, name: &[u8]) -> Option<usize> {
        self.defined.get(name).map(|(index, _)| *index)
    }

    /// The definition that a name means. Where there is none, the complaint is noted for the end of the file.
    pub(super) fn find(&mut self, name: Token<'t>, errors: &mut Errors) -> Option<usize> {
        let found = self.known(name.text);
        if found.is_none() {
            if errors.are_enough() || self.unknown.len() >= Errors::MAX_COUNTED {
                errors.count_one();
            } else {
                self.unknown.push((name, self.count));
            }
        }
        found
    }

    /// Complains about all references that found nothing.
    pub(super) fn complain(&self, errors: &mut Errors) {
        for (token, known) in &self.unknown {
            if self.excused.contains(token.text) {
                continue;
            }
            if errors.are_enough() {
                errors.count_one();
                continue;
            }
            let (kind, name) = (self.kind, token.quoted());
            let error = match self.defined.get(token.text) {
                Some((_, later)) => Diagnostic::new(
                    token.span(),
                    format!("{kind} {name} is used before it is defined"),
                )
                .also(later.span(), "defined here")
                .help_at(
                    format!("{name} is defined later, at line "),
                    later.start,
                    "; move it before its use",
                ),
                None => {
                    let error = Diagnostic::new(token.span(), format!("there is no {kind} {name}"));
                    // Other languages end a value.
                    let ended = token
                        .text
                        .strip_suffix(b";")
                        .or(token.text.strip_suffix(b","));
                    if let Some(meant) = ended.filter(|meant| self.defined.contains_key(meant)) {
                        let help = format!("write {}: white space ends a name", quote(meant));
                        errors.report(error.help(help));
                        continue;
                    }
                    // What is defined later is no good advice.
                    let before = self.candidates.iter().filter(|(index, _)| index < known);
                    match nearest(token.text, before.map(|(_, name)| *name)) {
                        Some(meant) => error.help(format!("did you mean {}?", quote(meant))),
                        None if *known == 0 => {
                            error.help(format!("no {kind} is defined before this"))
                        }
                        None => error.help(format!("define {kind} {name} before this")),
                    }
                }
            };
            errors.report(error);
        }
    }
}

/// The candidate that a misspelt word most likely means, if any is near enough; of equally near ones the first in
/// alphabetical order, whatever the order of the candidates.
pub(super) fn nearest<'c>(
    word: &[u8],
    candidates: impl Iterator<Item = &'c [u8]>,
) -> Option<&'c [u8]> {
    if word.len() > MAX_WORD {
        return None;
    }
    let word = String::from_utf8_lossy(word).to_lowercase();
    let letters = word.chars().count();
    let limit = if letters < 3 {
        0
    } else {
        letters.div_ceil(4).min(3)
    };
    let distance = |candidate: &&[u8]| {
        let candidate = String::from_utf8_lossy(candidate).to_lowercase();
        strsim::osa_distance(&word, &candidate)
    };
    let near = candidates.filter(|candidate| candidate.len().abs_diff(word.len()) <= 2 * limit + 4);
    let near = near.filter(|candidate| candidate.len() <= 2 * MAX_WORD);
    let ranked = near
        .map(|candidate| (distance(&candidate), candidate))
        .filter(|(distance, _)| *distance <= limit);
    ranked.min().map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meant(word: &str) -> Option<&'static str> {
        let names = super::super::table::ENTITIES
            .iter()
            .map(|entity| entity.name);
        nearest(word.as_bytes(), names.map(str::as_bytes))
            .map(|name| std::str::from_utf8(name).unwrap())
    }

    #[test]
    fn near_words_are_suggested() {
        assert_eq!(meant("tilled_plane"), Some("tiled_plane"));
        assert_eq!(meant("PLANE"), Some("plane"));
        assert_eq!(meant("sfere"), Some("sphere"));
        assert_eq!(meant("speher"), Some("sphere"));
        assert_eq!(meant("spere"), Some("sphere"));
        assert_eq!(meant("camra"), Some("camera"));
        assert_eq!(meant("materail"), Some("material"));
        assert_eq!(meant("teapot"), None);
        assert_eq!(meant("x"), None);
        assert_eq!(meant(&"x".repeat(100_000)), None);
    }
}

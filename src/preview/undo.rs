//! Undo and redo: which changes lay on top of the file before, step by step.
//!
//! A step is what the user takes for one: a drag from press to release, a run of the wheel or of a key. Steps are whole
//! sets of [`Changes`], so going back is putting one in the place of the other. When the file is saved, nothing happens
//! to them; when it is written by somebody else, they are moved onto that ([`History::rebase`]).

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::entities::title;
use crate::edit::{Changes, Target};
use crate::scene::Scene;

/// As many steps can be undone.
const STEPS: usize = 1000;

/// Changes of one number by keys or the wheel are one step while not more time than this lies between them.
const RUN: Duration = Duration::from_millis(700);

/// What a change is part of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    /// It is a step by itself.
    Alone,
    /// Changes of this while a button of the mouse is held are one; the number of times that one was pressed.
    Held(Target, u64),
    /// Changes of this by keys or the wheel, at this time, are one while they follow each other.
    Run(Target, Instant),
}

impl Step {
    fn continues(self, last: Self) -> bool {
        match (last, self) {
            (Self::Held(..), Self::Held(..)) => last == self,
            (Self::Run(last, then), Self::Run(this, now)) => {
                last == this && now.saturating_duration_since(then) < RUN
            }
            (Self::Alone | Self::Held(..) | Self::Run(..), _) => false,
        }
    }
}

/// Which way to go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    /// To what was before.
    Undo,
    /// To what was undone.
    Redo,
}

impl Direction {
    /// What is said where there is no such step.
    pub(super) fn nothing(self) -> &'static str {
        match self {
            Self::Undo => "nothing to undo",
            Self::Redo => "nothing to redo",
        }
    }

    /// What is said of a step, before what it changed.
    pub(super) fn done(self) -> &'static str {
        match self {
            Self::Undo => "undone:",
            Self::Redo => "redone:",
        }
    }
}

/// The steps before the changes as they are, and those after, which were undone.
#[derive(Debug, Default)]
pub(super) struct History {
    past: VecDeque<Changes>,
    future: Vec<Changes>,
    /// What the last change was part of; nothing where the next is certainly another step.
    last: Option<Step>,
}

impl History {
    /// Something was changed: this is how it was before. Whether that continues the last step.
    pub(super) fn record(&mut self, before: Changes, step: Step) -> bool {
        let continues = self.last.is_some_and(|last| step.continues(last));
        self.last = Some(step);
        self.future.clear();
        if !continues {
            self.past.push_back(before);
            if self.past.len() > STEPS {
                self.past.pop_front();
            }
        }
        continues
    }

    /// What comes next is another step: what was saved can be gone back to.
    pub(super) fn end_step(&mut self) {
        self.last = None;
    }

    /// The changes a step before or after these; nothing where there is none. What is the same as now is no step.
    pub(super) fn go(&mut self, direction: Direction, now: &Changes) -> Option<Changes> {
        self.last = None;
        loop {
            let step = match direction {
                Direction::Undo => self.past.pop_back(),
                Direction::Redo => self.future.pop(),
            }?;
            if step != *now {
                match direction {
                    Direction::Undo => self.future.push(now.clone()),
                    Direction::Redo => self.past.push_back(now.clone()),
                }
                return Some(step);
            }
        }
    }

    /// Whether there is such a step.
    pub(super) fn can_go(&self, direction: Direction, now: &Changes) -> bool {
        match direction {
            Direction::Undo => self.past.iter().any(|step| step != now),
            Direction::Redo => self.future.iter().any(|step| step != now),
        }
    }

    /// The file was written by somebody else: from the first of these scenes, which is the scene `origin` with the
    /// changes `saved`, it became the second. Steps lie on top of that from now on, and where both changed a number,
    /// going back to a step brings that step's.
    pub(super) fn rebase(&mut self, saved: &Changes, origin: &Scene, [old, new]: [&Scene; 2]) {
        self.last = None;
        for step in self.past.iter_mut().chain(&mut self.future) {
            *step = step.beyond(saved, origin);
        }
        Changes::rebase_earlier(self.past.iter_mut().chain(&mut self.future), old, new);
    }
}

/// What was changed, in a few words.
pub(super) fn described(changes: &Changes, scene: &Scene) -> String {
    let mut targets = changes.iter().map(|(target, _)| target);
    let first = targets.next();
    let first = first.and_then(|target| Some((target.attribute(), title(scene, target.entity())?)));
    match (first, targets.count()) {
        (Some((attribute, (kind, name))), 0) => format!("{attribute} of {kind} {name}"),
        (Some((attribute, (kind, name))), more) => {
            format!("{attribute} of {kind} {name}, and {more} more")
        }
        (None, _) => String::from("nothing"),
    }
}

#[cfg(test)]
mod tests;

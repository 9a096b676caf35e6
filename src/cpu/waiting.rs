//! The rays that wait to be followed; those on the same way become one.
//!
//! Between parallel half mirrors a sample has a number of rays that grows with a power of 2, and few ways: rays that
//! have been through as much of each gap, in whatever order, go on from the same point, in the same direction, after
//! the same path. What they bring is their weights times the same colour. A number type that has one number for two
//! that may be equal need not know that they are: all that is said of that number holds for both.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::observer::Branch;
use crate::real::{Real, V3};

/// Fewer rays than this are seldom on the same way.
const WORTHWHILE: usize = 12;

/// The rays of a sample that wait.
pub(super) struct Waiting<R> {
    /// The next to be followed, from the last on.
    now: Vec<Branch<R>>,
    /// Those that come after all of these: where rays are joined, one more surface lies behind them.
    later: Vec<Branch<R>>,
}

impl<R: Real> Waiting<R> {
    pub(super) fn new() -> Self {
        Self {
            now: Vec::new(),
            later: Vec::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.now.len() + self.later.len()
    }

    pub(super) fn push(&mut self, ray: Branch<R>) {
        if R::JOINS {
            self.later.push(ray);
        } else {
            self.now.push(ray);
        }
    }

    pub(super) fn next(&mut self) -> Option<Branch<R>> {
        if self.now.is_empty() {
            self.now = if self.later.len() < WORTHWHILE {
                std::mem::take(&mut self.later)
            } else {
                joined(std::mem::take(&mut self.later))
            };
        }
        self.now.pop()
    }
}

/// The rays, those on the same way as one.
fn joined<R: Real>(rays: Vec<Branch<R>>) -> Vec<Branch<R>> {
    let mut places = HashMap::with_capacity(rays.len());
    let mut kept: Vec<Branch<R>> = Vec::with_capacity(rays.len());
    for ray in rays {
        match places.entry(key(&ray)) {
            Entry::Vacant(entry) => {
                entry.insert(kept.len());
                kept.push(ray);
            }
            Entry::Occupied(entry) => {
                let like = &mut kept[*entry.get()];
                match join(like, &ray) {
                    Some(both) => *like = both,
                    None => kept.push(ray),
                }
            }
        }
    }
    kept
}

/// The same for rays that are worth a look; those on the same way may have different ones, and stay apart then.
fn key<R: Real>(ray: &Branch<R>) -> ([u32; 7], Option<u32>) {
    let Branch {
        base, dir, total, ..
    } = ray;
    let numbers = [base.x, base.y, base.z, dir.x, dir.y, dir.z, *total];
    (
        numbers.map(|number| (number.quick_enclosure().value as f32).to_bits()),
        ray.last,
    )
}

/// Two rays as one, if they may be on the same way.
fn join<R: Real>(a: &Branch<R>, b: &Branch<R>) -> Option<Branch<R>> {
    let both = |a: V3<R>, b: V3<R>| {
        Some(V3::new(
            a.x.joined(b.x)?,
            a.y.joined(b.y)?,
            a.z.joined(b.z)?,
        ))
    };
    Some(Branch {
        base: both(a.base, b.base)?,
        dir: both(a.dir, b.dir)?,
        total: a.total.joined(b.total)?,
        weight: a.weight + b.weight,
        counts: [0, 1, 2].map(|i| a.counts[i] || b.counts[i]),
        most: [0, 1, 2].map(|i| a.most[i] + b.most[i]),
        rays: a.rays.saturating_add(b.rays),
        ..*a
    })
}

//! How large a band is to be, when one is made twice, and which of two workers that use the same cores is the quicker.

use std::ops::Range;
use std::time::Duration;

use super::state::Role;

/// No band need have fewer pixels than this so that all end together: handing it out takes longer than making it.
const LEAST: u64 = 4096;

/// Rows of a band for a worker that would like `wish`, of `rows` left of this width: all who work end together if each
/// takes half of its share of them, again and again. Whoever has not brought a band yet counts as quick as the asker.
pub(super) fn height(
    wish: u32,
    rows: u64,
    width: u64,
    mine: Option<f64>,
    others: &[Option<f64>],
) -> u32 {
    let (Some(mine), false) = (mine, others.is_empty()) else {
        return wish;
    };
    let all: f64 = mine
        + others
            .iter()
            .map(|other| other.unwrap_or(mine))
            .sum::<f64>();
    let share = (rows as f64 * mine / all / 2.0).ceil() as u64;
    let least = LEAST.div_ceil(width);
    wish.min(share.max(least).min(u64::from(u32::MAX)) as u32)
}

/// Whether a worker that makes `mine` pixels a second should make a band that another one has had for so long: if it
/// brings it in half the time that the other one still needs. Who is later than it should be, or whose speed is not
/// known, is taken to need as long again.
pub(super) fn pays_twice(pixels: f64, mine: f64, other: Option<f64>, since: Duration) -> bool {
    let since = since.as_secs_f64();
    let expected = other.map_or(0.0, |other| pixels / other - since);
    let needs = if expected > 0.0 { expected } else { since };
    pixels / mine < needs / 2.0
}

/// A worker that uses the same cores as another is tried: it brings a band beside the other's, since the first one takes
/// longer than those that follow; then each of the two makes one alone, and the quicker one makes the rest.
#[derive(Debug, Default)]
pub(super) enum Trial {
    /// The one on trial has not brought its first band.
    #[default]
    Warming,
    /// The other one makes a band alone, these rows if it has begun.
    Reference(Option<Range<u32>>),
    /// The one on trial does, and has this speed to beat.
    Tried(f64),
    /// It is decided.
    Decided,
}

/// Seconds of work that have to be left for a trial to be worth it.
const WORTH: f64 = 0.1;

impl Trial {
    /// Whether the one on trial has not brought its first band.
    pub(super) fn is_warming(&self) -> bool {
        matches!(self, Self::Warming)
    }

    /// Whether a worker with this role may take a band now; `has_some` if it has one already.
    pub(super) fn admits(&self, role: Role, has_some: bool) -> bool {
        match (self, role) {
            (Self::Warming, Role::OnTrial) => !has_some,
            (Self::Reference(_), Role::OnTrial) => false,
            (Self::Reference(begun), Role::Works) => begun.is_none(),
            (Self::Tried(_), Role::OnTrial) => !has_some,
            (Self::Tried(_), Role::Works) => false,
            _ => true,
        }
    }

    /// A worker with this role took these rows.
    pub(super) fn took(&mut self, role: Role, rows: &Range<u32>) {
        if let (Self::Reference(begun @ None), Role::Works) = (&mut *self, role) {
            *begun = Some(rows.clone());
        }
    }

    /// A worker with this role brought these rows, at so many pixels a second; so many pixels are left. Returns which
    /// one is quicker, if that is decided.
    pub(super) fn learns(
        &mut self,
        role: Role,
        rows: &Range<u32>,
        speed: f64,
        left: f64,
    ) -> Option<Role> {
        let (next, quicker) = match (&*self, role) {
            (Self::Warming, Role::OnTrial) => (Self::Reference(None), None),
            (Self::Reference(Some(reference)), Role::Works) if reference == rows => {
                if left < WORTH * speed {
                    (Self::Decided, Some(Role::Works))
                } else {
                    (Self::Tried(speed), None)
                }
            }
            (Self::Tried(reference), Role::OnTrial) => {
                let quicker = if speed > *reference {
                    Role::OnTrial
                } else {
                    Role::Works
                };
                (Self::Decided, Some(quicker))
            }
            _ => return None,
        };
        *self = next;
        quicker
    }
}

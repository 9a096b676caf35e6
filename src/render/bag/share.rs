//! How large a band is to be, when one is made twice, and which of two workers that use the same cores is the quicker.

use std::time::Duration;

use super::worker::Role;

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

/// A worker that uses the same cores as another is tried: it brings a band beside the other's, since the first one
/// takes longer than those that follow; then it makes one alone, and whoever is the quicker makes the rest.
#[derive(Debug, Default)]
pub(super) enum Trial {
    /// The one on trial has not brought its first band.
    #[default]
    Warming,
    /// It makes a band alone, and has this speed to beat.
    Tried(f64),
    /// It is decided.
    Decided,
}

/// Seconds of work that have to be left for a trial to be worth it.
const WORTH: f64 = 0.05;

impl Trial {
    /// Whether the one on trial has not brought its first band.
    pub(super) fn is_warming(&self) -> bool {
        matches!(self, Self::Warming)
    }

    /// The speed that the one on trial has to beat with the band that it has.
    pub(super) fn reference(&self) -> Option<f64> {
        match self {
            Self::Tried(reference) => Some(*reference),
            _ => None,
        }
    }

    /// Whether a worker with this role may take a band now; `has_some` if it has one already.
    pub(super) fn admits(&self, role: Role, has_some: bool) -> bool {
        match (self, role) {
            (Self::Warming | Self::Tried(_), Role::OnTrial) => !has_some,
            (Self::Tried(_), Role::Works) => false,
            _ => true,
        }
    }

    /// The one on trial brought a band, at so many pixels a second; so many pixels are left. The other one has this
    /// speed alone, if it was seen to bring anything. Returns which one is quicker, if that is decided.
    pub(super) fn learns(&mut self, speed: f64, other: Option<f64>, left: f64) -> Option<Role> {
        let (next, quicker) = match (&*self, other) {
            (Self::Warming, None) => (Self::Decided, Some(Role::OnTrial)),
            // Its first band takes longer than those that follow, and others used the cores beside it.
            (Self::Warming, Some(other)) if speed > other => (Self::Decided, Some(Role::OnTrial)),
            (Self::Warming, Some(other)) if left < WORTH * other => {
                (Self::Decided, Some(Role::Works))
            }
            (Self::Warming, Some(other)) => (Self::Tried(other), None),
            (Self::Tried(reference), _) => {
                let quicker = if speed > *reference {
                    Role::OnTrial
                } else {
                    Role::Works
                };
                (Self::Decided, Some(quicker))
            }
            (Self::Decided, _) => return None,
        };
        *self = next;
        quicker
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_alone_gets_what_it_wishes_and_others_their_share() {
        assert_eq!(height(77, 1000, 1000, Some(5.0), &[]), 77);
        assert_eq!(height(77, 1000, 1000, None, &[Some(1.0)]), 77);
        // A quarter of the speed: half of a quarter of the rows.
        assert_eq!(height(999, 1000, 1000, Some(1.0), &[Some(3.0)]), 125);
        assert_eq!(height(100, 1000, 1000, Some(1.0), &[Some(3.0)]), 100);
        // One that has not brought anything counts as quick as the asker.
        assert_eq!(height(999, 1000, 1000, Some(1.0), &[None]), 250);
        // Near the end bands become small, but not too small to be worth it.
        assert_eq!(height(999, 3, 1000, Some(1.0), &[Some(100.0)]), 5);
        assert_eq!(height(999, 3, 10_000, Some(1.0), &[Some(100.0)]), 1);
    }

    /// All end together: whatever the speeds are, the last band of each ends within a band of the others.
    #[test]
    fn shares_shrink_so_that_all_end_together() {
        for speeds in [[1.0, 1.0], [1.0, 7.0], [1.0, 90.0]] {
            let (mut free, mut left) = ([0.0f64; 2], 10_000u64);
            while left > 0 {
                let next = usize::from(free[1] < free[0]);
                let rows = height(
                    u32::MAX,
                    left,
                    10_000,
                    Some(speeds[next]),
                    &[Some(speeds[1 - next])],
                );
                let rows = u64::from(rows).min(left);
                left -= rows;
                free[next] += rows as f64 / speeds[next];
            }
            let ideal = 10_000.0 / (speeds[0] + speeds[1]);
            let end = free[0].max(free[1]);
            assert!(end < 1.02 * ideal + 1.0, "{speeds:?}: {end} of {ideal}");
        }
    }

    #[test]
    fn a_band_is_made_twice_only_where_that_is_quicker() {
        let seconds = Duration::from_secs_f64;
        // 10 s of work, begun 2 s ago; in 4 s at most it must be there.
        assert!(pays_twice(100.0, 26.0, Some(10.0), seconds(2.0)));
        assert!(!pays_twice(100.0, 24.0, Some(10.0), seconds(2.0)));
        // Late, or never seen to bring anything: it needs as long again.
        assert!(pays_twice(100.0, 10.0, Some(10.0), seconds(21.0)));
        assert!(!pays_twice(100.0, 10.0, None, seconds(19.0)));
        assert!(pays_twice(100.0, 10.0, None, seconds(21.0)));
    }

    /// A trial up to its decision; `quick` is the speed of the one on trial, against the other's.
    fn decided(quick: f64, other: Option<f64>, left: f64) -> Option<Role> {
        use Role::{OnTrial, Works};
        let mut trial = Trial::default();
        // Both work until the one on trial has brought a band, of which it has one.
        assert!(
            trial.admits(Works, true)
                && trial.admits(OnTrial, false)
                && !trial.admits(OnTrial, true)
        );
        assert!(trial.is_warming());
        // How long that took does not count.
        if let Some(decided) = trial.learns(1.0, other, left) {
            return Some(decided);
        }
        assert!(
            !trial.admits(Works, false)
                && trial.admits(OnTrial, false)
                && !trial.admits(OnTrial, true)
        );
        let decided = trial.learns(quick, other, left);
        assert!(trial.admits(Works, false) && trial.admits(OnTrial, true));
        assert_eq!(trial.learns(99.0, other, left), None);
        decided
    }

    #[test]
    fn who_is_quicker_at_its_first_band_makes_the_rest_at_once() {
        for left in [0.4, 1e6] {
            let quicker = Trial::default().learns(11.0, Some(10.0), left);
            assert_eq!(quicker, Some(Role::OnTrial));
        }
    }

    #[test]
    fn the_quicker_one_makes_the_rest() {
        assert_eq!(decided(11.0, Some(10.0), 1e6), Some(Role::OnTrial));
        assert_eq!(decided(9.0, Some(10.0), 1e6), Some(Role::Works));
        // The other one brought nothing while this one even came.
        assert_eq!(decided(1.0, None, 1e6), Some(Role::OnTrial));
        // There is not enough left for a trial.
        assert_eq!(decided(1000.0, Some(10.0), 0.4), Some(Role::Works));
    }
}

//! Medians, quantiles, spreads, and which points of a plane nothing beats. Pure functions over what `measure` and
//! `error` collect.

use serde::Serialize;

/// Several runs of the same.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Times {
    /// The middle one, or the mean of the two in the middle.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// All of them, in order, in seconds; the warm-up is not among them.
    pub runs: Vec<f64>,
    /// The run before, which does not count.
    pub warm_up: Option<f64>,
}

impl Times {
    /// From the runs; none if there are none.
    #[must_use]
    pub fn new(warm_up: Option<f64>, runs: Vec<f64>) -> Option<Self> {
        let sorted = sorted(runs.clone());
        Some(Self {
            median: quantile(&sorted, 0.5)?,
            min: *sorted.first()?,
            max: *sorted.last()?,
            runs,
            warm_up,
        })
    }
}

/// The numbers in rising order.
#[must_use]
pub fn sorted(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// The number below which a share `q` (0 to 1) of the sorted numbers lies, linear between two of them; none of none.
#[must_use]
pub fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = q.clamp(0.0, 1.0) * last as f64;
    let below = place.floor() as usize;
    let (a, b) = (sorted[below], sorted[(below + 1).min(last)]);
    let share = place - below as f64;
    // Equal values are returned as they are: between two infinities a + (b − a)·s would be NaN.
    Some(if a == b { a } else { a + (b - a) * share })
}

/// Indices of the points (time, error) that no other point beats in both, from the fastest to the slowest. A point that
/// another equals in one and beats in the other is beaten; of equal points the first counts.
#[must_use]
pub fn pareto(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len())
        .filter(|&i| !points[i].0.is_nan() && !points[i].1.is_nan())
        .collect();
    order.sort_by(|&a, &b| {
        let by_time = points[a].0.total_cmp(&points[b].0);
        by_time.then(points[a].1.total_cmp(&points[b].1))
    });
    let mut front: Vec<usize> = Vec::new();
    for i in order {
        if front
            .last()
            .is_none_or(|&best| points[i].1 < points[best].1)
        {
            front.push(i);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_spreads() {
        let times = Times::new(Some(9.0), vec![3.0, 1.0, 2.0]).unwrap();
        assert_eq!((times.median, times.min, times.max), (2.0, 1.0, 3.0));
        assert_eq!(times.runs, [3.0, 1.0, 2.0]);
        let even = Times::new(None, vec![4.0, 1.0, 2.0, 8.0]).unwrap();
        assert_eq!(even.median, 3.0);
        assert_eq!(Times::new(Some(1.0), Vec::new()), None);
    }

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        let hundred: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(quantile(&hundred, 0.99), Some(99.0));
        assert_eq!(quantile(&hundred, 1.0), Some(100.0));
        assert_eq!(quantile(&[1.0, 2.0], 0.25), Some(1.25));
        assert_eq!(quantile(&[1.0, f64::INFINITY], 1.0), Some(f64::INFINITY));
        assert_eq!(
            quantile(&[f64::INFINITY, f64::INFINITY], 0.5),
            Some(f64::INFINITY)
        );
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [
            (5.0, 0.0), // slow and exact
            (1.0, 0.5), // fast and wrong
            (2.0, 0.6), // beaten by the one before
            (2.0, 0.1),
            (2.0, 0.1), // the same once more
            (6.0, 0.0), // as exact, slower
            (1.0, 0.7), // as fast, more wrong
        ];
        assert_eq!(pareto(&points), [1, 3, 0]);
        assert_eq!(pareto(&[]), Vec::<usize>::new());
        assert_eq!(pareto(&[(f64::NAN, 1.0), (1.0, 1.0)]), [1]);
    }
}

//! Certified pixels, the host's side: the CPU decides what the GPU is not sure of, and checks some of what it is sure
//! of.
//!
//! Stands between the tracers (`gpu`, `cpu`) and `render`, which runs it band by band. [`lanes`] does on the CPU what
//! the GPU does, [`pixels`] decides single pixels and whole bands on all cores, [`cascade`] says who decides after
//! whom, [`spot`] which sure pixels of a band are computed again, [`trust`] which devices passed the self-test,
//! [`Tally`] counts what decided how many, [`verdict`] has a colour for each.

pub mod cascade;
mod first_halt;
pub mod lanes;
pub mod pixels;
pub mod spot;
pub mod trust;
pub mod verdict;

use std::time::Duration;

use serde::ser::{Serialize, SerializeMap, Serializer};

pub use crate::frame::{Decided, DecidedBy};

/// Places of presumed pixels that are kept to be named; of more only the number is known.
const NAMED: usize = 8;

/// How many pixels each kind of arithmetic decided.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    counts: [u64; DecidedBy::ALL.len()],
    /// Seconds of CPU time, of all threads together; only single pixels are timed, not whole bands.
    seconds: [f64; DecidedBy::ALL.len()],
    /// Samples that the CPU traced.
    samples: u64,
    /// Column and row (from the bottom) of the first presumed pixels met.
    presumed_at: Vec<[u32; 2]>,
}

impl Tally {
    /// Counts pixels that one kind of arithmetic decided, without their time.
    pub fn add(&mut self, by: DecidedBy, pixels: u64) {
        self.counts[by as usize] += pixels;
    }

    /// Counts a pixel that the CPU decided, and the samples that it traced for it.
    pub fn decided(&mut self, by: DecidedBy, at: [u32; 2], samples: u32, took: Duration) {
        self.samples += u64::from(samples);
        self.add(by, 1);
        self.seconds[by as usize] += took.as_secs_f64();
        if by == DecidedBy::Presumed && self.presumed_at.len() < NAMED {
            self.presumed_at.push(at);
        }
    }

    /// Counts what another counted.
    pub fn merge(mut self, other: Self) -> Self {
        for by in DecidedBy::ALL {
            self.counts[by as usize] += other.counts[by as usize];
            self.seconds[by as usize] += other.seconds[by as usize];
        }
        self.samples += other.samples;
        let room = NAMED - self.presumed_at.len();
        self.presumed_at
            .extend(other.presumed_at.into_iter().take(room));
        self
    }

    /// How many pixels one kind of arithmetic decided.
    pub fn count(&self, by: DecidedBy) -> u64 {
        self.counts[by as usize]
    }

    /// All pixels.
    pub fn pixels(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Samples that the CPU traced for pixels that it decided.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Column and row (from the bottom) of the first presumed pixels met.
    pub fn presumed_at(&self) -> &[[u32; 2]] {
        &self.presumed_at
    }

    /// The CPU seconds of each kind of arithmetic that was timed, to be printed.
    pub fn times(&self) -> CpuSeconds {
        CpuSeconds(self.seconds)
    }
}

/// As a map from the name of what decided to its number of pixels.
impl Serialize for Tally {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        map(&self.counts, serializer)
    }
}

/// Seconds of CPU time by what decided, of all threads together, for pixels that were decided one by one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CpuSeconds([f64; DecidedBy::ALL.len()]);

/// As a map from the name of what decided to its seconds; the GPU's are counted elsewhere.
impl Serialize for CpuSeconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(DecidedBy::ALL.len() - 2))?;
        for by in &DecidedBy::ALL[2..] {
            map.serialize_entry(by.name(), &self.0[*by as usize])?;
        }
        map.end()
    }
}

fn map<S: Serializer>(
    values: &[u64; DecidedBy::ALL.len()],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(DecidedBy::ALL.len()))?;
    for by in DecidedBy::ALL {
        map.serialize_entry(by.name(), &values[by as usize])?;
    }
    map.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_stand_at_their_own_numbers() {
        for (i, by) in DecidedBy::ALL.into_iter().enumerate() {
            assert_eq!(by as usize, i);
        }
        assert!(DecidedBy::ALL.is_sorted());
    }

    #[test]
    fn tallies_add_up_and_name_few() {
        let mut a = Tally::default();
        a.add(DecidedBy::Gpu, 100);
        let mut b = Tally::default();
        for x in 0..20 {
            b.decided(DecidedBy::Presumed, [x, 7], 3, Duration::from_secs(1));
        }
        let sum = a.merge(b);
        assert_eq!((sum.pixels(), sum.count(DecidedBy::Presumed)), (120, 20));
        assert_eq!(sum.samples(), 60);
        assert_eq!(sum.presumed_at().len(), NAMED);
        let json = serde_json::to_value(&sum).unwrap();
        assert_eq!((&json["gpu"], &json["presumed"]), (&100.into(), &20.into()));
        assert_eq!(
            serde_json::to_value(sum.times()).unwrap()["presumed"],
            serde_json::json!(20.0)
        );
    }
}

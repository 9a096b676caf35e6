//! Certified pixels, the host's side: the CPU decides what the GPU is not sure of, and checks some of what it is sure
//! of.
//!
//! Stands between the tracers (`gpu`, `cpu`) and `render`, which runs it band by band. [`lanes`] does on the CPU what
//! the GPU does, [`pixels`] decides single pixels and whole bands on all cores, [`spot`] says which sure pixels of a
//! band are computed again, [`trust`] which devices passed the self-test, [`Tally`] counts what decided how many,
//! [`verdict`] has a colour for each.

pub mod lanes;
pub mod pixels;
pub mod spot;
pub mod trust;
pub mod verdict;

use std::time::Duration;

use serde::ser::{Serialize, SerializeMap, Serializer};

pub use crate::frame::{Decided, Stage};

/// Places of presumed pixels that are kept to be named; of more only the number is known.
const NAMED: usize = 8;

/// How many pixels each stage decided.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    counts: [u64; Stage::ALL.len()],
    /// Seconds of CPU time, of all threads together; only single pixels are timed, not whole bands.
    seconds: [f64; Stage::ALL.len()],
    /// Samples that the CPU traced.
    samples: u64,
    /// Column and row (from the bottom) of the first presumed pixels met.
    presumed_at: Vec<[u32; 2]>,
}

impl Tally {
    /// Counts pixels that were decided at a stage, without their time.
    pub fn add(&mut self, stage: Stage, pixels: u64) {
        self.counts[stage as usize] += pixels;
    }

    /// Counts a pixel that the CPU decided, and the samples that it traced for it.
    pub fn decided(&mut self, stage: Stage, at: [u32; 2], samples: u32, took: Duration) {
        self.samples += u64::from(samples);
        self.add(stage, 1);
        self.seconds[stage as usize] += took.as_secs_f64();
        if stage == Stage::Presumed && self.presumed_at.len() < NAMED {
            self.presumed_at.push(at);
        }
    }

    /// Counts what another counted.
    pub fn merge(mut self, other: Self) -> Self {
        for stage in Stage::ALL {
            self.counts[stage as usize] += other.counts[stage as usize];
            self.seconds[stage as usize] += other.seconds[stage as usize];
        }
        self.samples += other.samples;
        let room = NAMED - self.presumed_at.len();
        self.presumed_at
            .extend(other.presumed_at.into_iter().take(room));
        self
    }

    /// How many pixels a stage decided.
    pub fn count(&self, stage: Stage) -> u64 {
        self.counts[stage as usize]
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

    /// The CPU seconds of each stage that was timed, to be printed.
    pub fn times(&self) -> StageSeconds {
        StageSeconds(self.seconds)
    }
}

/// As a map from the stage's name to its number of pixels.
impl Serialize for Tally {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        map(&self.counts, serializer)
    }
}

/// Seconds of CPU time by stage, of all threads together, for pixels that were decided one by one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StageSeconds([f64; Stage::ALL.len()]);

/// As a map from the stage's name to its seconds; the GPU's are counted elsewhere.
impl Serialize for StageSeconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(Stage::ALL.len() - 1))?;
        for stage in &Stage::ALL[1..] {
            map.serialize_entry(stage.name(), &self.0[*stage as usize])?;
        }
        map.end()
    }
}

fn map<S: Serializer>(values: &[u64; Stage::ALL.len()], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(Stage::ALL.len()))?;
    for stage in Stage::ALL {
        map.serialize_entry(stage.name(), &values[stage as usize])?;
    }
    map.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_stand_at_their_own_numbers() {
        for (i, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, i);
        }
        assert!(Stage::ALL.is_sorted());
    }

    #[test]
    fn tallies_add_up_and_name_few() {
        let mut a = Tally::default();
        a.add(Stage::Gpu, 100);
        let mut b = Tally::default();
        for x in 0..20 {
            b.decided(Stage::Presumed, [x, 7], 3, Duration::from_secs(1));
        }
        let sum = a.merge(b);
        assert_eq!((sum.pixels(), sum.count(Stage::Presumed)), (120, 20));
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

//! Where the time of a rendering goes: phases that follow each other, so that they add up to the whole.
//!
//! Stands below the tracers, beside `frame`. Whoever renders holds one [`Stopwatch`] and hands it on; at each seam of
//! the work [`Stopwatch::lap`] says what the time since the seam before was for. So no time can be in none of the
//! phases.

use std::time::Instant;

use serde::ser::{Serialize, SerializeMap, Serializer};

/// What a stretch of time of a thread was for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Loading the driver, once a process, and listing adapters.
    Instance,
    /// Opening the device.
    Device,
    /// Finding out whether the device can be trusted: the self-test, or looking up that it was passed.
    Selftest,
    /// Waiting for devices, where the CPU cannot begin.
    Devices,
    /// Starting threads.
    Threads,
    /// Preparing the scene, exactly, and where the samples pass.
    Prepare,
    /// Rounding the scene to the records of f32, and composing the shader.
    Pack,
    /// Making the scene's buffers.
    Upload,
    /// Compiling the shader.
    Compile,
    /// Making the buffers that dispatches write to, and those that they are read back from.
    Buffers,
    /// Handing dispatches in, with the offsets of their samples.
    Submit,
    /// Waiting for the device to render and to copy.
    Wait,
    /// Taking pixels from the device's memory into bands.
    Readback,
    /// Waiting for rows to make.
    Held,
    /// Waiting, after the last band, for those who had not heard yet that it was the last.
    Drain,
    /// Tracing whole bands on the CPU.
    Trace,
    /// Waiting for the next band in order.
    Bands,
    /// Handing bands on: encoding, writing.
    Emit,
    /// Giving back the memory of scene, shader and buffers.
    Release,
}

impl Phase {
    /// Every phase, in about the order in which they come; each stands at its own number.
    pub const ALL: [Self; 19] = [
        Self::Instance,
        Self::Device,
        Self::Selftest,
        Self::Devices,
        Self::Threads,
        Self::Prepare,
        Self::Pack,
        Self::Upload,
        Self::Compile,
        Self::Buffers,
        Self::Submit,
        Self::Wait,
        Self::Readback,
        Self::Held,
        Self::Drain,
        Self::Trace,
        Self::Bands,
        Self::Emit,
        Self::Release,
    ];

    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instance => "instance",
            Self::Device => "device",
            Self::Selftest => "selftest",
            Self::Devices => "devices",
            Self::Threads => "threads",
            Self::Prepare => "prepare",
            Self::Pack => "pack",
            Self::Upload => "upload",
            Self::Compile => "compile",
            Self::Buffers => "buffers",
            Self::Submit => "submit",
            Self::Wait => "wait",
            Self::Readback => "readback",
            Self::Held => "held",
            Self::Drain => "drain",
            Self::Trace => "trace",
            Self::Bands => "bands",
            Self::Emit => "emit",
            Self::Release => "release",
        }
    }
}

/// Seconds by [`Phase`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Phases([f64; Phase::ALL.len()]);

impl Phases {
    /// What a phase took.
    pub fn get(&self, phase: Phase) -> f64 {
        self.0[phase as usize]
    }

    /// Both together.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        for (mine, other) in self.0.iter_mut().zip(other.0) {
            *mine += other;
        }
        self
    }

    /// What all of them took.
    pub fn sum(&self) -> f64 {
        self.0.iter().sum()
    }
}

/// As a map from the phase's name to its seconds.
impl Serialize for Phases {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(Phase::ALL.len()))?;
        for phase in Phase::ALL {
            map.serialize_entry(phase.name(), &self.get(phase))?;
        }
        map.end()
    }
}

/// Measures phases that follow each other.
#[derive(Debug, Clone)]
pub struct Stopwatch {
    started: Instant,
    seam: Instant,
    phases: Phases,
}

impl Stopwatch {
    /// From now on.
    pub fn start() -> Self {
        let now = Instant::now();
        Self {
            started: now,
            seam: now,
            phases: Phases::default(),
        }
    }

    /// The time since the last call, or since the start, was for this phase; returns it, in seconds.
    pub fn lap(&mut self, phase: Phase) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.seam).as_secs_f64();
        self.seam = now;
        self.phases.0[phase as usize] += seconds;
        seconds
    }

    /// What the phases took so far.
    pub fn phases(&self) -> Phases {
        self.phases
    }

    /// Seconds since the start.
    pub fn total(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;
    use std::time::Duration;

    #[test]
    fn parts_stand_at_their_own_numbers_and_have_names_of_their_own() {
        for (i, phase) in Phase::ALL.into_iter().enumerate() {
            assert_eq!(phase as usize, i);
        }
        let names: std::collections::BTreeSet<_> = Phase::ALL.map(Phase::name).into();
        assert_eq!(names.len(), Phase::ALL.len());
    }

    #[test]
    fn laps_add_up_to_the_whole() {
        let mut watch = Stopwatch::start();
        sleep(Duration::from_millis(3));
        let first = watch.lap(Phase::Pack);
        watch.lap(Phase::Wait);
        sleep(Duration::from_millis(2));
        let second = watch.lap(Phase::Pack);
        let phases = watch.phases();
        assert!(first >= 3e-3 && second >= 2e-3);
        assert_eq!(phases.get(Phase::Pack), first + second);
        assert!((phases.sum() - (watch.seam - watch.started).as_secs_f64()).abs() < 1e-9);
        assert!(phases.sum() <= watch.total());
    }
}

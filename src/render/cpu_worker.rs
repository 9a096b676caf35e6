//! The CPU as a worker: whole bands on all cores, many pixels at once as far as that is sure, the others one by one.

use std::time::Instant;

use super::Error;
use super::bag::{Finished, Taken};
use super::rendering::Rendering;
use super::report::{WorkerReport, WorkerSeconds};
use crate::frame::Halt;
use crate::stopwatch::{Phase, Stopwatch};

/// Most pixels of a band, as of one that a device is given.
const MOST: u32 = 2 << 20;

/// Pixels of the first band, when nobody knows yet how long they take.
const FIRST: u32 = 8192;

/// Makes bands until there are none left to make.
pub(super) fn run(rendering: &Rendering<'_>, me: usize) {
    let bag = &rendering.bag;
    let mut watch = Stopwatch::start();
    let most = (MOST / rendering.width).max(1);
    let fixed = rendering.settings.band_rows.map(|rows| rows.clamp(1, most));
    let mut height = fixed.unwrap_or(FIRST.div_ceil(rendering.width)).min(most);
    while let Taken::Rows(rows) = bag.take(me, height, u32::MAX, true) {
        watch.lap(Phase::Held);
        let lanes = rendering.lanes();
        bag.ready(me);
        watch.lap(Phase::Pack);
        let started = Instant::now();
        let unwanted = || !bag.wants(&rows);
        let trace = || rendering.decider.band(rows.clone(), lanes, &unwanted);
        let traced = if bag.is_warming() {
            rendering.on_fewer_threads(trace)
        } else {
            rendering.on_threads(trace)
        };
        match traced {
            Ok((band, tally)) => bag.deliver(Finished::new(me, band, tally)),
            Err(Halt::Stopped) if (rendering.stop)() => bag.fail(Error::Stopped),
            // Another worker brought it. (It may be wanted again by now, from somebody else.)
            Err(Halt::Stopped) => {}
            Err(halt) => bag.halt(&rows, halt),
        }
        watch.lap(Phase::Trace);
        let seconds = if bag.is_alone(me) { 0.25 } else { 0.02 };
        let ideal = rows.len() as f64 * seconds / started.elapsed().as_secs_f64().max(1e-6);
        height = fixed.unwrap_or_else(|| next_height(rows.len() as u32, ideal, most));
    }
    watch.lap(Phase::Held);
    let phases = watch.phases();
    let seconds = WorkerSeconds {
        start: phases.get(Phase::Pack),
        work: phases.get(Phase::Trace),
        wait: phases.get(Phase::Held),
    };
    rendering.tell(|told| {
        told.workers
            .push((me, WorkerReport::new("CPU", None, seconds, phases, None)))
    });
}

/// Rows of the next band: the ideal, but no more than four times as many as the last one, or as few.
fn next_height(last: u32, ideal: f64, most: u32) -> u32 {
    (ideal as u32)
        .clamp(last / 4, last.saturating_mul(4))
        .clamp(1, most)
}

//! Who made, makes and may make which rows: [`hand_out`] gives rows to workers, [`bring_back`] takes what they made,
//! and [`leave`] gives back what they had.

mod bring_back;
mod hand_out;
mod leave;

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Taken;
use super::share::{Trial, height, pays_twice};
use super::worker::{Activity, Finished, Kind, Role, Worker, hash};
use crate::frame::Halt;
use crate::render::Error;

/// Pixels that may be made or under way below the first row that has not gone out: three of the largest bands, 18 MiB
/// of bytes.
const AHEAD: u64 = 6 << 20;

/// Seconds that the one on trial has at least, however quick the other one is.
const PATIENCE: f64 = 0.5;

/// What rows that went out already must come to: the hash of their bytes, and the error if they do not.
type Check = (u64, Arc<str>);

/// Rows that nobody makes at the moment.
#[derive(Debug, Clone)]
struct Job {
    rows: Range<u32>,
    check: Option<Check>,
}

/// Rows that are being made.
#[derive(Debug)]
struct Out {
    job: Job,
    /// By whom, and since when.
    by: Vec<(usize, Instant)>,
}

pub(super) struct State {
    width: u64,
    rows: Range<u32>,
    /// Rows of a band, if that was asked for.
    band_rows: Option<u32>,
    /// The rows below this were never given to anybody.
    next: u32,
    /// Others that are to be made, from the top.
    jobs: BTreeMap<Reverse<u32>, Job>,
    out: Vec<Out>,
    /// Bands that are finished and cannot go out yet, by their ends.
    finished: BTreeMap<u32, Result<Finished, Halt>>,
    /// Rows from here on went out, or are on their way.
    emitted: u32,
    /// What went out and may turn out to be wrong: by whom, which rows, and their hash.
    history: Vec<(usize, Range<u32>, u64)>,
    revoked: Vec<(usize, Arc<str>)>,
    workers: Vec<Worker>,
    trial: Trial,
    /// If a worker on trial has come or will: the part of their cores that the others use until it has brought a band.
    pub(super) expected: Option<f64>,
    /// Until when the CPU leaves all cores to it, and the pixels a second that the CPU would make meanwhile.
    pub(super) rest: Option<(Instant, f64)>,
    /// How many devices' bands the CPU refines at the moment.
    pub(super) refining: u32,
    pub(super) error: Option<Error>,
    pub(super) over: bool,
}

impl State {
    pub(super) fn new(width: u32, rows: Range<u32>, band_rows: Option<u32>) -> Self {
        Self {
            width: u64::from(width),
            band_rows,
            next: rows.end,
            emitted: rows.end,
            rows,
            jobs: BTreeMap::new(),
            out: Vec::new(),
            finished: BTreeMap::new(),
            history: Vec::new(),
            revoked: Vec::new(),
            workers: Vec::new(),
            trial: Trial::default(),
            expected: None,
            rest: None,
            refining: 0,
            error: None,
            over: false,
        }
    }

    pub(super) fn join(&mut self, kind: Kind, role: Role) -> usize {
        self.workers.push(Worker::new(kind, role));
        self.workers.len() - 1
    }

    pub(super) fn ready(&mut self, worker: usize) {
        self.workers[worker].ready = true;
    }

    /// Whether what is left takes the workers of now longer than this; not before they have brought something, and a
    /// sixteenth of the picture was handed out: first bands are small, and slow for their size.
    pub(super) fn lasts(&self, time: Duration) -> bool {
        if 16 * (self.rows.len() as u64 - self.rows_left()) < self.rows.len() as u64 {
            return false;
        }
        let speeds = self
            .at_work()
            .filter_map(|(_, worker)| worker.activity.speed);
        let speed: f64 = speeds.sum();
        speed > 0.0 && self.rows_left() as f64 * self.width as f64 > time.as_secs_f64() * speed
    }

    /// Whether a worker is getting ready that uses the same cores.
    pub(super) fn is_warming(&self) -> bool {
        self.expected.is_some() && self.trial.is_warming()
    }

    pub(super) fn is_alone(&self, me: usize) -> bool {
        let is_gone = |(other, worker): (usize, &Worker)| other == me || worker.left;
        !self.is_warming() && self.workers.iter().enumerate().all(is_gone)
    }

    pub(super) fn waited(&mut self, worker: usize, time: Duration) {
        self.workers[worker].activity.waited += time;
    }

    pub(super) fn activity(&self, worker: usize) -> Activity {
        self.workers[worker].activity.clone()
    }

    pub(super) fn is_over(&self) -> bool {
        self.over || self.error.is_some()
    }

    /// Whether all rows went out, and none of them is still to be compared.
    pub(super) fn is_whole(&self) -> bool {
        self.emitted == self.rows.start
            && self.jobs.is_empty()
            && self.out.iter().all(|out| out.job.check.is_none())
    }

    /// Whether nobody makes rows any more, nor is to.
    pub(super) fn is_made(&self) -> bool {
        self.rows_left() == 0 && self.out.is_empty()
    }

    /// Rows that have not been given to anybody, or were given back.
    fn rows_left(&self) -> u64 {
        let jobs = self.jobs.values().map(|job| job.rows.len() as u64);
        u64::from(self.next - self.rows.start) + jobs.sum::<u64>()
    }

    /// Workers that make bands, or will as soon as they can.
    fn at_work(&self) -> impl Iterator<Item = (usize, &Worker)> {
        let works = |worker: &&Worker| !worker.left && worker.role != Role::StandsBy;
        self.workers
            .iter()
            .enumerate()
            .filter(move |(_, worker)| works(worker))
    }

    fn give_back(&mut self, job: Job) {
        if !job.rows.is_empty() {
            self.jobs.insert(Reverse(job.rows.end), job);
        }
    }

    pub(super) fn fail(&mut self, error: Error) {
        if !self.over {
            self.error.get_or_insert(error);
        }
    }
}

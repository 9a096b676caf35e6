//! Who made, makes and may make which rows.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher as _};
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Taken;
use super::share::{Trial, height, pays_twice};
use crate::certify::Tally;
use crate::frame::{Band, Halt};
use crate::render::Error;

/// Pixels that may be made or under way below the first row that has not gone out: three of the largest bands, 18 MiB.
const AHEAD: u64 = 6 << 20;

/// What a worker is here for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It takes bands.
    Works,
    /// It takes bands when all who work have left.
    StandsBy,
    /// It is tried against those who work: it uses the same cores, so only one of them is worth its bands.
    OnTrial,
}

/// What a worker did.
#[derive(Debug, Clone, Default)]
pub(crate) struct Activity {
    /// Bands of it that went out, or that showed others to be right.
    pub(crate) bands: u32,
    /// What decided their pixels.
    pub(crate) tally: Tally,
    /// Sure pixels of them that were computed again, and were right.
    pub(crate) spot_checks: u64,
    /// How long it waited for rows.
    pub(crate) waited: Duration,
    /// Pixels a second, lately; none before its first band.
    pub(crate) speed: Option<f64>,
    /// Whether it was tried, and others were quicker.
    pub(crate) outrun: bool,
}

/// What a worker is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The CPU, whose cores also decide what devices leave open: that comes first.
    Cpu,
    /// A device.
    Device,
}

#[derive(Debug)]
struct Worker {
    kind: Kind,
    role: Role,
    /// Whether it could take rows now, as far as it itself is concerned.
    ready: bool,
    left: bool,
    activity: Activity,
    last_delivery: Option<Instant>,
}

impl Worker {
    fn new(kind: Kind, role: Role) -> Self {
        Self {
            kind,
            role,
            ready: false,
            left: false,
            activity: Activity::default(),
            last_delivery: None,
        }
    }
}

/// A band that was brought back.
#[derive(Debug)]
pub(crate) struct Finished {
    worker: usize,
    pub(super) band: Band,
    pub(super) tally: Tally,
    pub(super) spot_checks: u64,
    /// A hash of its bytes, where the worker may be found to be wrong later.
    hash: Option<u64>,
}

impl Finished {
    pub(crate) fn new(worker: usize, band: Band, tally: Tally) -> Self {
        Self {
            worker,
            band,
            tally,
            spot_checks: 0,
            hash: None,
        }
    }

    /// The same from a worker that computed so many of its pixels once more, and may still be found to be wrong.
    pub(crate) fn checked(self, spot_checks: u64) -> Self {
        let hash = Some(hash(&self.band));
        Self {
            spot_checks,
            hash,
            ..self
        }
    }
}

pub(super) fn hash(band: &Band) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(&band.rgb);
    hasher.finish()
}

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
    /// Whether a worker on trial has come or will.
    pub(super) expected: bool,
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
            expected: false,
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

    /// Whether what is left takes the workers of now longer than this; not before they have brought something.
    pub(super) fn lasts(&self, time: Duration) -> bool {
        let speeds = self
            .at_work()
            .filter_map(|(_, worker)| worker.activity.speed);
        let speed: f64 = speeds.sum();
        speed > 0.0 && self.rows_left() as f64 * self.width as f64 > time.as_secs_f64() * speed
    }

    /// Whether a worker is getting ready that uses the same cores.
    pub(super) fn is_warming(&self) -> bool {
        self.expected && self.trial.is_warming()
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

    pub(super) fn take(&mut self, me: usize, wish: u32, most: u32) -> Taken {
        if self.is_over() || self.workers[me].left {
            return Taken::End;
        }
        let stands_by = self.workers[me].role == Role::StandsBy && self.at_work().next().is_some();
        let is_busy = self.refining > 0 && self.workers[me].kind == Kind::Cpu;
        let has_some = self
            .out
            .iter()
            .any(|out| out.by.iter().any(|(worker, _)| *worker == me));
        if stands_by || is_busy || !self.trial.admits(self.workers[me].role, has_some) {
            return Taken::Later;
        }
        let Some(job) = self.next_job(me, wish, most) else {
            return self.twice(me, most);
        };
        let rows = job.rows.clone();
        self.trial.took(self.workers[me].role, &rows);
        self.out.push(Out {
            job,
            by: vec![(me, Instant::now())],
        });
        Taken::Rows(rows)
    }

    /// The uppermost rows that nobody makes; not if they are too far ahead of what went out.
    fn next_job(&mut self, me: usize, wish: u32, most: u32) -> Option<Job> {
        let (key, job) = match self.jobs.first_key_value() {
            Some((key, job)) => (Some(*key), job.clone()),
            None if self.next > self.rows.start => {
                let rows = self.rows.start..self.next;
                (None, Job { rows, check: None })
            }
            None => return None,
        };
        // What is compared is compared as it went out.
        if job.check.is_some() {
            if job.rows.len() > most as usize {
                return None;
            }
            return key.and_then(|key| self.jobs.remove(&key));
        }
        let wish = if self.band_rows.is_some() {
            wish
        } else {
            self.fair(me, wish)
        };
        let height = wish.max(1).min(job.rows.len() as u32);
        let start = job.rows.end - height;
        let ahead = u64::from(self.emitted - start) * self.width;
        // The first band that has not gone out has to be made, however large it is.
        if ahead > AHEAD && job.rows.end != self.emitted {
            return None;
        }
        let taken = start..job.rows.end;
        match key {
            None => self.next = start,
            Some(key) => {
                self.jobs.remove(&key);
                self.give_back(Job {
                    rows: job.rows.start..start,
                    check: None,
                });
            }
        }
        Some(Job {
            rows: taken,
            check: None,
        })
    }

    /// So many rows that all who work end together.
    fn fair(&self, me: usize, wish: u32) -> u32 {
        let speed = |worker: &Worker| worker.activity.speed;
        let others = self
            .at_work()
            .filter(|(other, worker)| *other != me && worker.ready);
        let others: Vec<_> = others.map(|(_, worker)| speed(worker)).collect();
        height(
            wish,
            self.rows_left(),
            self.width,
            speed(&self.workers[me]),
            &others,
        )
    }

    /// A band that somebody else makes, if that is the quicker way to it.
    fn twice(&mut self, me: usize, most: u32) -> Taken {
        let nothing_left = if self.rows_left() == 0 && self.out.is_empty() {
            Taken::End
        } else {
            Taken::Later
        };
        let (Some(mine), now) = (self.workers[me].activity.speed, Instant::now()) else {
            return nothing_left;
        };
        let width = self.width;
        let workers = &self.workers;
        let slow = |out: &&mut Out| match out.by[..] {
            [(other, since)] if other != me && out.job.rows.len() <= most as usize => {
                let pixels = out.job.rows.len() as f64 * width as f64;
                pays_twice(pixels, mine, workers[other].activity.speed, now - since)
            }
            _ => false,
        };
        match self.out.iter_mut().find(slow) {
            Some(out) => {
                out.by.push((me, now));
                Taken::Rows(out.job.rows.clone())
            }
            None => nothing_left,
        }
    }

    fn give_back(&mut self, job: Job) {
        if !job.rows.is_empty() {
            self.jobs.insert(Reverse(job.rows.end), job);
        }
    }

    pub(super) fn wants(&self, rows: &Range<u32>) -> bool {
        !self.is_over() && self.out.iter().any(|out| out.job.rows == *rows)
    }

    /// Whether these rows went out already, and are made again to be compared.
    pub(super) fn compares(&self, rows: &Range<u32>) -> bool {
        self.out
            .iter()
            .any(|out| out.job.rows == *rows && out.job.check.is_some())
    }

    /// Takes the rows from who makes them, if they are not there yet.
    fn close(&mut self, rows: &Range<u32>) -> Option<Out> {
        let place = self.out.iter().position(|out| out.job.rows == *rows)?;
        Some(self.out.swap_remove(place))
    }

    /// The first who brings a band counts.
    pub(super) fn deliver(&mut self, finished: Finished, hash: Option<u64>) {
        let me = finished.worker;
        let Some(out) = self.close(&finished.band.rows) else {
            return;
        };
        self.learn(me, &out);
        match out.job.check {
            None => {
                self.finished.insert(finished.band.rows.end, Ok(finished));
            }
            Some((expected, _)) if hash == Some(expected) => self.count(&finished),
            Some((_, why)) => self.fail(Error::Revoked(why.to_string())),
        }
    }

    /// How quick a worker is, from a band of it.
    fn learn(&mut self, me: usize, out: &Out) {
        let now = Instant::now();
        let worker = &mut self.workers[me];
        let Some((_, taken)) = out.by.iter().find(|(worker, _)| *worker == me) else {
            return;
        };
        // Who has several bands at once makes one after the other.
        let since = worker
            .last_delivery
            .replace(now)
            .map_or(*taken, |last| last.max(*taken));
        let pixels = out.job.rows.len() as f64 * self.width as f64;
        let speed = pixels / (now - since).as_secs_f64().max(1e-6);
        let activity = &mut worker.activity;
        activity.speed = Some(
            activity
                .speed
                .map_or(speed, |before| (before + speed) / 2.0),
        );
        let left = self.rows_left() as f64 * self.width as f64;
        if let Some(quicker) = self
            .trial
            .learns(self.workers[me].role, &out.job.rows, speed, left)
        {
            for worker in &mut self.workers {
                match (worker.role, quicker) {
                    (Role::OnTrial, Role::OnTrial) => worker.role = Role::Works,
                    (Role::OnTrial, _) => {
                        worker.left = true;
                        worker.activity.outrun = true;
                    }
                    (Role::Works, Role::OnTrial) => worker.role = Role::StandsBy,
                    _ => {}
                }
            }
        }
    }

    pub(super) fn halt(&mut self, rows: &Range<u32>, halt: Halt) {
        if let Some(out) = self.close(rows) {
            match out.job.check {
                None => {
                    self.finished.insert(rows.end, Err(halt));
                }
                Some(_) => self.fail(halt.into()),
            }
        }
    }

    pub(super) fn fail(&mut self, error: Error) {
        if !self.over {
            self.error.get_or_insert(error);
        }
    }

    pub(super) fn leave(&mut self, me: usize) -> bool {
        self.workers[me].left = true;
        if self.workers[me].role == Role::OnTrial {
            self.trial = Trial::default();
            self.expected = false;
        }
        let mut kept = Vec::new();
        for mut out in std::mem::take(&mut self.out) {
            out.by.retain(|(worker, _)| *worker != me);
            if out.by.is_empty() {
                self.give_back(out.job);
            } else {
                kept.push(out);
            }
        }
        self.out = kept;
        self.workers.iter().any(|worker| !worker.left)
    }

    pub(super) fn revoke(&mut self, me: usize, why: &str) {
        let why: Arc<str> = why.into();
        self.leave(me);
        self.workers[me].activity = Activity::default();
        let (wrong, right) =
            std::mem::take(&mut self.finished)
                .into_iter()
                .partition(|(_, finished)| {
                    finished
                        .as_ref()
                        .is_ok_and(|finished| finished.worker == me)
                });
        self.finished = right;
        let dropped: BTreeMap<u32, Result<Finished, Halt>> = wrong;
        for finished in dropped.into_values().flatten() {
            self.give_back(Job {
                rows: finished.band.rows,
                check: None,
            });
        }
        for (worker, rows, hash) in std::mem::take(&mut self.history) {
            if worker == me {
                let check = Some((hash, Arc::clone(&why)));
                self.give_back(Job { rows, check });
            } else {
                self.history.push((worker, rows, hash));
            }
        }
        self.revoked.push((me, why));
    }

    /// The next band to go out, if it is there.
    pub(super) fn next_to_emit(&mut self) -> Option<Result<Finished, Halt>> {
        let finished = self.finished.remove(&self.emitted)?;
        if let Ok(finished) = &finished {
            self.emitted = finished.band.rows.start;
        }
        Some(finished)
    }

    /// A band went out.
    pub(super) fn emitted(&mut self, finished: &Finished) {
        let rows = finished.band.rows.clone();
        let revoked = self
            .revoked
            .iter()
            .find(|(worker, _)| *worker == finished.worker);
        match (revoked, finished.hash) {
            (Some((_, why)), Some(hash)) => {
                let check = Some((hash, Arc::clone(why)));
                self.give_back(Job { rows, check });
            }
            (_, hash) => {
                self.history
                    .extend(hash.map(|hash| (finished.worker, rows, hash)));
                self.count(finished);
            }
        }
    }

    fn count(&mut self, finished: &Finished) {
        let activity = &mut self.workers[finished.worker].activity;
        activity.bands += 1;
        activity.spot_checks += finished.spot_checks;
        activity.tally = std::mem::take(&mut activity.tally).merge(finished.tally.clone());
    }
}

//! Who made, makes and may make which rows.

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

/// Pixels that may be made or under way below the first row that has not gone out: three of the largest bands, 18 MiB of
/// bytes.
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

    pub(super) fn take(&mut self, me: usize, wish: u32, most: u32) -> Taken {
        if self.is_over() || self.workers[me].left {
            return Taken::End;
        }
        let is_cpu = self.workers[me].kind == Kind::Cpu;
        if is_cpu && self.refining > 0 {
            return Taken::Later;
        }
        // What went out and may be wrong is for the CPU alone, whatever else it does: another device may be of the
        // same kind, and wrong alike.
        if is_cpu && let Some(job) = self.next_check() {
            return self.hand_out(me, job);
        }
        if self.workers[me].role == Role::Works && self.is_overdue() {
            self.decide(Role::Works);
        }
        let stands_by = self.workers[me].role == Role::StandsBy && self.at_work().next().is_some();
        let has_some = self
            .out
            .iter()
            .any(|out| out.by.iter().any(|(worker, _)| *worker == me));
        if stands_by || !self.trial.admits(self.workers[me].role, has_some) {
            return Taken::Later;
        }
        let Some(job) = self.next_job(me, wish) else {
            return self.twice(me, most);
        };
        self.hand_out(me, job)
    }

    fn hand_out(&mut self, me: usize, job: Job) -> Taken {
        let rows = job.rows.clone();
        self.out.push(Out {
            job,
            by: vec![(me, Instant::now())],
        });
        Taken::Rows(rows)
    }

    /// Rows that went out and are to be compared: just as they went out.
    fn next_check(&mut self) -> Option<Job> {
        let mut jobs = self.jobs.iter();
        let key = *jobs.find(|(_, job)| job.check.is_some())?.0;
        self.jobs.remove(&key)
    }

    /// The uppermost rows that nobody makes; not if they are too far ahead of what went out.
    fn next_job(&mut self, me: usize, wish: u32) -> Option<Job> {
        let mut jobs = self.jobs.iter();
        let (key, job) = match jobs.find(|(_, job)| job.check.is_none()) {
            Some((key, job)) => (Some(*key), job.clone()),
            None if self.next > self.rows.start => {
                let rows = self.rows.start..self.next;
                (None, Job { rows, check: None })
            }
            None => return None,
        };
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
        // The CPU stays until all is over: a device that is still busy with a band that another one brought may be found
        // to be wrong, and all that it brought is to be made again then. Nobody stands by for a device that is done.
        let is_device = self.workers[me].kind == Kind::Device;
        if is_device && self.is_made() {
            self.leave(me);
            return Taken::End;
        }
        let (Some(mine), now) = (self.workers[me].activity.speed, Instant::now()) else {
            return Taken::Later;
        };
        let width = self.width;
        let workers = &self.workers;
        let slow = |out: &&mut Out| match out.by[..] {
            [(other, since)]
                if other != me
                    && out.job.check.is_none()
                    && out.job.rows.len() <= most as usize =>
            {
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
            None => Taken::Later,
        }
    }

    /// Why rows that went out may be wrong, if nobody has compared them.
    pub(super) fn doubt(&self) -> Option<Arc<str>> {
        let mut checks = self.jobs.values().filter_map(|job| job.check.as_ref());
        checks.next().map(|(_, why)| Arc::clone(why))
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
    pub(super) fn deliver(&mut self, finished: Finished, known: Option<u64>) {
        let me = finished.worker;
        let Some(out) = self.close(&finished.band.rows) else {
            return;
        };
        self.learn(me, &out);
        let Some((expected, why)) = out.job.check else {
            self.finished.insert(finished.band.rows.end, Ok(finished));
            return;
        };
        // That it is to be compared may be news since the caller asked.
        let found = known.or(finished.hash);
        if found.unwrap_or_else(|| hash(&finished.band)) == expected {
            self.count(&finished);
        } else {
            self.fail(Error::Revoked(why.to_string()));
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
        if self.workers[me].role == Role::OnTrial {
            let left = self.rows_left() as f64 * self.width as f64;
            let other = self.speed_against_trial();
            if let Some(quicker) = self.trial.learns(speed, other, left) {
                self.decide(quicker);
            }
        }
    }

    /// How quick those are that another one is tried against, on all their cores; none if they brought nothing yet.
    fn speed_against_trial(&self) -> Option<f64> {
        let works = |worker: &&Worker| worker.role == Role::Works && !worker.left;
        let speeds = self.workers.iter().filter(works);
        let speed: f64 = speeds.filter_map(|worker| worker.activity.speed).sum();
        (speed > 0.0).then(|| speed / self.expected.unwrap_or(1.0))
    }

    /// The trial is over: whoever was quicker makes the rest.
    fn decide(&mut self, quicker: Role) {
        for number in 0..self.workers.len() {
            let worker = &mut self.workers[number];
            match (worker.role, quicker) {
                (Role::OnTrial, Role::OnTrial) => worker.role = Role::Works,
                (Role::OnTrial, _) => {
                    worker.activity.outrun = true;
                    self.leave(number);
                }
                (Role::Works, Role::OnTrial) => worker.role = Role::StandsBy,
                _ => {}
            }
        }
    }

    /// Whether the one on trial has had its band for so long that it is the slower one, whenever it brings it.
    fn is_overdue(&self) -> bool {
        let Some(reference) = self.trial.reference() else {
            return false;
        };
        let on_trial = |number: usize| self.workers[number].role == Role::OnTrial;
        self.out.iter().any(|out| {
            let pixels = out.job.rows.len() as f64 * self.width as f64;
            let is_late = |since: Instant| {
                since.elapsed().as_secs_f64() > PATIENCE.max(4.0 * pixels / reference)
            };
            out.by
                .iter()
                .any(|(number, since)| on_trial(*number) && is_late(*since))
        })
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
            self.expected = None;
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
        let activity = &mut self.workers[me].activity;
        *activity = Activity {
            waited: activity.waited,
            ..Activity::default()
        };
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

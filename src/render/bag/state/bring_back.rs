//! What is brought back: bands that are finished or cannot be made, how quick who brought them is, and which go out
//! next.

use super::*;

impl State {
    pub(in super::super) fn wants(&self, rows: &Range<u32>) -> bool {
        !self.is_over() && self.out.iter().any(|out| out.job.rows == *rows)
    }

    /// Whether these rows went out already, and are made again to be compared.
    pub(in super::super) fn compares(&self, rows: &Range<u32>) -> bool {
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
    pub(in super::super) fn deliver(&mut self, finished: Finished, known: Option<u64>) {
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

    /// How quick those are that another one is tried against, on all their cores; as far as they brought nothing yet,
    /// by what they were seen to do before. None if nothing is known.
    fn speed_against_trial(&self) -> Option<f64> {
        let works = |worker: &&Worker| worker.role == Role::Works && !worker.left;
        let speeds = self.workers.iter().filter(works);
        let speed: f64 = speeds.filter_map(|worker| worker.activity.speed).sum();
        if speed > 0.0 {
            return Some(speed / self.expected.unwrap_or(1.0));
        }
        self.rest.map(|(_, speed)| speed)
    }

    pub(in super::super) fn halt(&mut self, rows: &Range<u32>, halt: Halt) {
        if let Some(out) = self.close(rows) {
            match out.job.check {
                None => {
                    self.finished.insert(rows.end, Err(halt));
                }
                Some(_) => self.fail(halt.into()),
            }
        }
    }

    /// The next band to go out, if it is there.
    pub(in super::super) fn next_to_emit(&mut self) -> Option<Result<Finished, Halt>> {
        let finished = self.finished.remove(&self.emitted)?;
        if let Ok(finished) = &finished {
            self.emitted = finished.band.rows.start;
        }
        Some(finished)
    }

    /// A band went out.
    pub(in super::super) fn emitted(&mut self, finished: &Finished) {
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

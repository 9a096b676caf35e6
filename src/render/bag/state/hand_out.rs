//! Who gets which rows next, and when a band is made twice.

use super::*;

impl State {
    pub(in super::super) fn take(&mut self, me: usize, wish: u32, most: u32) -> Taken {
        if self.is_over() || self.workers[me].left {
            return Taken::End;
        }
        let is_cpu = self.workers[me].kind == Kind::Cpu;
        if is_cpu && (self.refining > 0 || self.is_resting()) {
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

    /// Whether the CPU still leaves all cores to a worker that is getting ready.
    fn is_resting(&self) -> bool {
        let until = self.rest.map(|(until, _)| until);
        self.is_warming() && until.is_some_and(|until| Instant::now() < until)
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
        // The CPU stays until all is over: a device that is still busy with a band that another one brought may be
        // found to be wrong, and all that it brought is to be made again then. Nobody stands by for a device that is
        // done.
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
}

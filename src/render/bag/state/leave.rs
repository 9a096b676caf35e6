//! Who leaves: a device that is lost or slower, or one that was found to be wrong, whose rows are made again.

use super::*;

impl State {
    /// Why rows that went out may be wrong, if nobody has compared them.
    pub(in super::super) fn doubt(&self) -> Option<Arc<str>> {
        let mut checks = self.jobs.values().filter_map(|job| job.check.as_ref());
        checks.next().map(|(_, why)| Arc::clone(why))
    }

    /// The trial is over: whoever was quicker makes the rest.
    pub(super) fn decide(&mut self, quicker: Role) {
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

    pub(in super::super) fn leave(&mut self, me: usize) -> bool {
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

    pub(in super::super) fn revoke(&mut self, me: usize, why: &str) {
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
}

//! The threads of a rendering: how they start, and how all of them hear that it is over.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, Scope};
use std::time::Duration;

use super::Error;
use super::bag::{Bag, Kind, Role};
use super::device_thread::News;
use super::device_worker::{DeviceWorker, Here};
use super::devices::{Devices, Found};
use super::rendering::Rendering;
use super::report::{Instead, without};

/// What the CPU does in this time it does alone: loading a software driver, compiling a shader there and making the
/// picture takes it about so long, even if it is three times as quick then (docs/BENCH.md).
pub(super) const STARTING: Duration = Duration::from_millis(125);

/// Who wants to hear that a rendering is over.
pub(super) type Listeners = Mutex<Vec<Sender<News>>>;

fn listeners(over: &Listeners) -> MutexGuard<'_, Vec<Sender<News>>> {
    over.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tells all that the rendering is over when it is dropped: also where what takes the bands panics.
pub(super) struct Over<'a>(&'a Bag, &'a Listeners);

impl<'a> Over<'a> {
    pub(super) fn of(bag: &'a Bag, over: &'a Listeners) -> Self {
        Self(bag, over)
    }
}

impl Drop for Over<'_> {
    fn drop(&mut self) {
        let Self(bag, over) = self;
        bag.end();
        for listener in listeners(over).drain(..) {
            // Who listens no more has ended.
            let _ = listener.send(News::Over);
        }
    }
}

/// Ends a rendering one of whose threads panics: what it had taken nobody would make. (The panic goes on where threads
/// are joined.)
struct EndsIfPanicking<'a>(&'a Bag);

impl Drop for EndsIfPanicking<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.fail(Error::Threads("one of them panicked".into()));
        }
    }
}

/// The threads of a rendering.
#[derive(Clone, Copy)]
pub(super) struct Crew<'scope, 'env, 'r> {
    rendering: &'env Rendering<'r>,
    scope: &'scope Scope<'scope, 'env>,
    over: &'env Listeners,
}

impl<'scope, 'env: 'scope, 'r: 'env> Crew<'scope, 'env, 'r> {
    pub(super) fn new(
        rendering: &'env Rendering<'r>,
        scope: &'scope Scope<'scope, 'env>,
        over: &'env Listeners,
    ) -> Self {
        Self {
            rendering,
            scope,
            over,
        }
    }

    /// Starts a thread; if that cannot be, the rendering ends.
    pub(super) fn spawn(self, name: &str, work: impl FnOnce() + Send + 'scope) {
        #[cfg(test)]
        let work = super::tests::with_faults(work);
        let bag = &self.rendering.bag;
        let started =
            thread::Builder::new()
                .name(name.into())
                .spawn_scoped(self.scope, move || {
                    let _watched = EndsIfPanicking(bag);
                    work();
                });
        if let Err(error) = started {
            self.rendering.bag.fail(Error::Threads(error.to_string()));
        }
    }

    /// Lets a device work.
    pub(super) fn device(self, here: Here<'env>, role: Role) {
        let (sender, news) = channel();
        listeners(self.over).push(sender.clone());
        // It may have ended before that listener was there to hear it.
        if self.rendering.bag.is_over() {
            return;
        }
        let number = self.rendering.bag.join(Kind::Device, role);
        let worker = DeviceWorker::new(self.rendering, number);
        self.spawn("device", move || worker.run(&here, sender, &news));
    }

    /// Waits for devices while the CPU works already, and lets them work.
    pub(super) fn late(
        self,
        devices: &'env Devices,
        asked: bool,
        news: &Receiver<News>,
        sender: &Sender<News>,
    ) {
        let bag = &self.rendering.bag;
        let ask_for_software = || self.rendering.ask_for_software(devices, sender);
        if !asked {
            // By pixels from all over the picture it is quick; its bands may tell otherwise.
            if self.rendering.is_quick_on_cpu() || !bag.lasts(STARTING) {
                return;
            }
            ask_for_software();
        }
        while let Ok(News::Found(found)) = news.recv() {
            match found {
                Found::Devices(devices_found, phases) => {
                    for device in devices_found {
                        match device {
                            Ok(device)
                                if device.gpu.software && self.rendering.is_quick_on_cpu() =>
                            {
                                self.rendering
                                    .tell(|told| told.left_out = Some(device.gpu.name.clone()));
                            }
                            Ok(device) => {
                                let role = if device.gpu.software {
                                    Role::OnTrial
                                } else {
                                    Role::Works
                                };
                                self.device(
                                    Here::Opened {
                                        device,
                                        phases,
                                        devices,
                                    },
                                    role,
                                );
                            }
                            Err(error) => {
                                bag.expect(None);
                                self.rendering
                                    .tell(|told| told.left.push(without(&error, Instead::Cpu)));
                            }
                        }
                    }
                    return;
                }
                Found::Software(name) if self.rendering.is_quick_on_cpu() => {
                    self.rendering.tell(|told| told.left_out = Some(name));
                    return;
                }
                Found::Software(_) if !bag.lasts(STARTING) => return,
                Found::Software(_) => ask_for_software(),
                // That there is none is nothing to talk about: the CPU makes the same picture.
                Found::None(_) => return bag.expect(None),
            }
        }
    }
}

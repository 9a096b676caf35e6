//! What all workers of a rendering know: the scene, prepared once for all of them, the bag, and what is to be told.

use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use super::bag::Bag;
use super::report::Told;
use super::{Precision, Settings};
use crate::certify::lanes::{LANES, Lanes};
use crate::certify::pixels::PixelDecider;
use crate::frame::StopRequested;
use crate::jitter::Jitter;
use crate::scene::Scene;
use crate::shader::format::Double;
use crate::shader::pack::Packed;

/// So many pixels are tried a thread, or as many as this time allows, before it is said how long a picture will take.
const TRIED_PIXELS: u64 = 512;
const TRYING: Duration = Duration::from_millis(2);

/// Everything that workers need to know.
pub(super) struct Rendering<'a> {
    pub(super) scene: &'a Scene,
    pub(super) jitter: &'a Arc<Jitter>,
    pub(super) decider: PixelDecider<'a>,
    /// The threads that the CPU's part runs on, if not all.
    pub(super) pool: Option<&'a rayon::ThreadPool>,
    pub(super) width: u32,
    pub(super) rows: Range<u32>,
    pub(super) settings: &'a Settings,
    /// Whether nobody wants the picture any more.
    pub(super) stop: &'a StopRequested<'a>,
    fewer_threads: OnceLock<Option<rayon::ThreadPool>>,
    packed: OnceLock<Arc<Packed>>,
    lanes: OnceLock<Option<Lanes>>,
    pub(super) bag: Bag,
    /// What is said of workers that left, or never came.
    pub(super) told: Mutex<Told>,
}

impl<'a> Rendering<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        jitter: &'a Arc<Jitter>,
        decider: PixelDecider<'a>,
        pool: Option<&'a rayon::ThreadPool>,
        stop: &'a StopRequested<'a>,
    ) -> Self {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        Self {
            scene,
            jitter,
            decider,
            pool,
            width,
            bag: Bag::new(width, rows.clone(), settings.band_rows),
            rows,
            settings,
            stop,
            fewer_threads: OnceLock::new(),
            packed: OnceLock::new(),
            lanes: OnceLock::new(),
            told: Mutex::default(),
        }
    }

    /// All pixels of the rows that are rendered.
    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.width) * self.rows.len() as u64
    }

    /// Runs on the threads that were asked for.
    pub(super) fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs on one thread less: the core is for a driver that is being loaded, or compiles.
    pub(super) fn on_fewer_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let new = || {
            let all = self.on_threads(rayon::current_num_threads);
            let fewer = rayon::ThreadPoolBuilder::new().num_threads(all - 1);
            if all > 1 { fewer.build().ok() } else { None }
        };
        match self.fewer_threads.get_or_init(new) {
            Some(pool) => pool.install(work),
            None => self.on_threads(work),
        }
    }

    /// The part of all threads that [`on_fewer_threads`](Self::on_fewer_threads) uses.
    pub(super) fn share_of_fewer_threads(&self) -> f64 {
        let all = self.on_threads(rayon::current_num_threads);
        if all > 1 {
            (all - 1) as f64 / all as f64
        } else {
            1.0
        }
    }

    /// How many pixels a second the CPU makes, by a few from all over the picture that all threads try at once: what
    /// two of them do is not twice what one does where they share a core. Infinite where a pixel cannot be made.
    pub(super) fn tried_speed(&self) -> f64 {
        let lanes = self.lanes();
        let speeds = self.on_threads(|| {
            rayon::broadcast(|thread| {
                let threads = thread.num_threads();
                self.try_pixels(thread.index() as u32, threads as u32, lanes)
            })
        });
        speeds.into_iter().sum()
    }

    /// Pixels a second of one of so many threads.
    fn try_pixels(&self, thread: u32, threads: u32, lanes: Option<&Lanes>) -> f64 {
        let [width, rows] = [self.width, self.rows.len() as u32].map(f64::from);
        let mut started = Instant::now();
        let mut tried = 0;
        for strip in 0.. {
            // Multiples of the plastic ratio's inverse and its square are spread evenly, however many there are.
            let number = f64::from(strip * threads + thread + 1);
            let at = |step: f64, of: f64| ((number * step).fract() * of) as u32;
            let (column, row) = (at(0.754_877_67, width), at(0.569_840_29, rows));
            let first = column / LANES as u32 * LANES as u32;
            let Ok(traced) = self
                .decider
                .try_pixels([first, self.rows.end - 1 - row], lanes)
            else {
                // The rendering will end, or find that it is one that cannot be.
                return f64::INFINITY;
            };
            // The first ones find nothing in the processor's caches.
            if strip == 0 {
                started = Instant::now();
                continue;
            }
            tried += traced.pixels();
            if tried >= TRIED_PIXELS || started.elapsed() >= TRYING {
                break;
            }
        }
        tried as f64 / started.elapsed().as_secs_f64().max(1e-9)
    }

    /// The scene rounded to f32, for devices and lanes alike.
    pub(super) fn packed(&self) -> Arc<Packed> {
        // On the thread that asks: one of those that were asked for may be waiting for this, and be the only one.
        Arc::clone(self.packed.get_or_init(|| self.pack(self.settings)))
    }

    fn pack(&self, settings: &Settings) -> Arc<Packed> {
        let prepared = self.decider.exact_tracer().bounded();
        Arc::new(Packed::prepared(prepared, self.scene, settings))
    }

    /// The scene rounded to f64, for devices that have it.
    pub(super) fn packed_in_f64(&self) -> Packed<Double> {
        Packed::in_f64(self.scene, self.settings)
    }

    /// What the CPU does as many pixels at once as its vectors hold, if it does.
    pub(super) fn lanes(&self) -> Option<&Lanes> {
        let new = || match self.settings.precision {
            Precision::Certified => Lanes::new(self.settings, || self.packed()),
            // A fast picture is packed without what bounds lean on, and the CPU's bytes are certified in any case.
            Precision::Fast => {
                let certified = Settings {
                    precision: Precision::Certified,
                    ..self.settings.clone()
                };
                Lanes::new(&certified, || self.pack(&certified))
            }
        };
        self.lanes.get_or_init(|| self.on_threads(new)).as_ref()
    }

    /// Whether the CPU makes the scene as many pixels at once as its vectors hold. Software uses the same cores, and
    /// was never seen to be quicker then (docs/BENCH.md).
    pub(super) fn is_quick_on_cpu(&self) -> bool {
        self.lanes().is_some()
    }

    pub(super) fn tell(&self, how: impl FnOnce(&mut Told)) {
        how(&mut self.told.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

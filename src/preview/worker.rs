//! The thread that renders what the window wants to show: at once and small if need be, then whole if that is much
//! quicker than what comes last, the certified picture. Where the CPU renders, every whole picture is certified.
//!
//! Between the window, which leaves [`Wish`]es, and `render`, which makes the pictures. The newest wish wins: what is
//! under way for an older one is given up, but for the first picture of each, without which a steady drag would show
//! nothing.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::adaptive_resolution::{AdaptiveResolution, MOST_PIXELS, sized, smaller};
use super::canvases::Canvases;
use super::draw::Pixels;
use super::latest::{LatestReceiver, LatestSender, latest};
use super::priority;
use super::progress::Progress;
use super::rendering::Rendering;
use crate::edit::Changes;
use crate::gpu::GpuError;
use crate::gpu::canvas::Canvas;
use crate::gpu::device::Gpu;
use crate::gpu::pipeline::Compiled;
use crate::render::{self, Backend, Live, Precision, Report, Settings, render_live};
use crate::scene::Scene;

/// Nothing moves once nothing was asked for so long: a picture is certified then, if it is not yet.
pub(super) const STILL: Duration = Duration::from_millis(150);
/// Seconds that a dispatch is to take: the window's own frames wait behind two of them.
const DISPATCH: f64 = 0.015;
/// A first picture is not given up for a newer one before so many seconds.
const FIRST: f64 = 0.25;

/// What is to be shown.
#[derive(Debug, Clone)]
pub(super) struct Wish {
    /// The scene as the file has it.
    pub(super) scene: Arc<Scene>,
    /// What is changed on top of it.
    pub(super) changes: Changes,
    /// How it is rendered.
    pub(super) rendering: Rendering,
    /// When it was wished for.
    pub(super) since: Instant,
}

/// A picture on the GPU, with what is known of it.
#[derive(Debug)]
pub(super) struct PreviewPicture {
    /// The number of its wish.
    pub(super) number: u64,
    /// The scene that it shows, changes and all; its pixeldim is the size that is shown.
    pub(super) scene: Arc<Scene>,
    /// Columns and rows as the file says, if that is more than can be shown.
    pub(super) whole: [u32; 2],
    /// The picture, perhaps of fewer pixels.
    pub(super) pixels: Arc<Pixels>,
    /// The same where it was made, if the window is drawn there.
    pub(super) canvas: Option<Arc<Canvas>>,
    /// Whether its bytes are certified.
    pub(super) precision: Precision,
    /// How it was rendered.
    pub(super) report: Report,
    /// Seconds from the wish to the picture; of a certified one, without the rest before.
    pub(super) seconds: f64,
}

/// What the worker tells.
#[derive(Debug)]
pub(super) enum News {
    /// A picture is there.
    Picture(Box<PreviewPicture>),
    /// The wish of this number is fulfilled to the last byte, and nothing moves.
    Rests(u64),
    /// A wish cannot be fulfilled.
    Failed {
        /// The number of the wish.
        number: u64,
        /// Why.
        why: String,
    },
}

/// The worker, as the window has it. Dropped, it ends soon.
#[derive(Debug)]
pub(super) struct Worker {
    /// Where wishes are left, by whoever has them.
    pub(super) wishes: Arc<LatestSender<Wish>>,
    thread: Option<JoinHandle<()>>,
    /// What it does now, and how far it is.
    pub(super) progress: Arc<Progress>,
}

impl Worker {
    /// Begins to work on this device. `tell` is called on the worker's thread.
    ///
    /// # Errors
    /// If the thread cannot be started.
    pub(super) fn new(
        gpu: Arc<Gpu>,
        canvases: Canvases,
        settings: Settings,
        tell: impl FnMut(News) + Send + 'static,
    ) -> std::io::Result<Self> {
        let (wishes, receiver) = latest();
        let progress = Arc::new(Progress::default());
        let work = Work {
            gpu,
            canvases,
            settings,
            receiver,
            progress: Arc::clone(&progress),
            resolution: AdaptiveResolution::default(),
            compiled: Compiled::default(),
        };
        let thread = std::thread::Builder::new()
            .name("render".into())
            .spawn(move || {
                priority::lower();
                work.run(tell);
            })?;
        Ok(Self {
            wishes: Arc::new(wishes),
            thread: Some(thread),
            progress,
        })
    }
}

impl Worker {
    /// Gives up what is under way, and waits until nothing of it uses the device any more. The gate for submissions has
    /// to be open, since the work may wait there.
    pub(super) fn end(&mut self) {
        self.wishes.close();
        if let Some(thread) = self.thread.take() {
            // A panic of the worker was printed when it happened.
            let _ = thread.join();
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.end();
    }
}

/// The worker's own side.
struct Work {
    gpu: Arc<Gpu>,
    canvases: Canvases,
    settings: Settings,
    receiver: LatestReceiver<Wish>,
    progress: Arc<Progress>,
    resolution: AdaptiveResolution,
    compiled: Compiled,
}

/// A wish that is being worked on.
struct PreviewTask {
    number: u64,
    /// The scene, its picture no larger than can be shown.
    scene: Arc<Scene>,
    /// Columns and rows of its picture as the file says.
    whole: [u32; 2],
}

/// Why a picture was not made.
enum Unmade {
    /// Nobody wants it any more, or it took too long; this share of it was done.
    GivenUp(f64),
    Failed(String),
}

impl Work {
    fn run(mut self, mut tell: impl FnMut(News)) {
        while let Some((number, wish)) = self.receiver.take() {
            if let Err(Unmade::Failed(why)) = self.fulfil(number, &wish, &mut tell) {
                tell(News::Failed { number, why });
            }
            self.progress.end();
        }
    }

    fn fulfil(
        &mut self,
        number: u64,
        wish: &Wish,
        tell: &mut impl FnMut(News),
    ) -> Result<(), Unmade> {
        let scene = if wish.changes.is_empty() {
            Arc::clone(&wish.scene)
        } else {
            Arc::new(wish.changes.apply(&wish.scene))
        };
        self.settings = wish.rendering.over(&self.settings);
        let most = MOST_PIXELS.min(self.canvases.most());
        let whole = scene.camera.pixeldim;
        let task = PreviewTask {
            number,
            scene: sized(&scene, smaller(whole, most)).map_or(scene, Arc::new),
            whole,
        };
        let (first, mut precision) = self.make_first(&task, wish.since, tell)?;
        // Where nothing moves the certified picture is next, and the more so where a fast one takes as long: its shader
        // is one for all viewpoints.
        if first > 1 && self.resolution.is_whole_worth_it() {
            let started = Instant::now();
            let picture = self.make(&task, 1, Precision::Fast, |old| old)?;
            self.resolution.took(1, started.elapsed().as_secs_f64());
            precision = picture.precision;
            tell(done(picture, wish.since.elapsed()));
        }
        if precision != Precision::Certified {
            self.progress.wait();
        }
        if !self.receiver.rest(number, wish.since + STILL) {
            return Ok(());
        }
        if precision != Precision::Certified {
            let started = Instant::now();
            let picture = self.make(&task, 1, Precision::Certified, |old| old)?;
            let seconds = started.elapsed().as_secs_f64();
            match picture.report.backend {
                // There the first pictures are made as this one is.
                Backend::Cpu => self.resolution.took(1, seconds),
                _ => self.resolution.took_certified(seconds),
            }
            tell(done(picture, started.elapsed()));
        }
        tell(News::Rests(number));
        Ok(())
    }

    /// Makes a picture that is there at once, and tells it. Returns how many times smaller it had to be, and what its
    /// bytes are.
    fn make_first(
        &mut self,
        task: &PreviewTask,
        since: Instant,
        tell: &mut impl FnMut(News),
    ) -> Result<(u32, Precision), Unmade> {
        let mut first = self.resolution.first();
        let patience = self.resolution.patience();
        loop {
            let started = Instant::now();
            let patience = patience.filter(|_| first == 1);
            let made = self.make(task, first, Precision::Fast, |old| {
                let seconds = started.elapsed().as_secs_f64();
                patience.is_some_and(|most| seconds > most) || old && seconds > FIRST
            });
            let seconds = started.elapsed().as_secs_f64();
            match made {
                Ok(picture) => {
                    self.resolution.took(first, seconds);
                    let precision = picture.precision;
                    tell(done(picture, since.elapsed()));
                    return Ok((first, precision));
                }
                Err(Unmade::GivenUp(share)) if first == 1 => {
                    self.resolution.gave_up(seconds, share);
                    if self.receiver.is_old(task.number) {
                        return Err(Unmade::GivenUp(share));
                    }
                    first = self.resolution.first();
                }
                Err(unmade) => return Err(unmade),
            }
        }
    }

    /// Renders a picture, `smaller` times smaller in each direction; `stop` is told whether the wish is old.
    fn make(
        &mut self,
        task: &PreviewTask,
        smaller: u32,
        precision: Precision,
        stop: impl Fn(bool) -> bool + Sync,
    ) -> Result<PreviewPicture, Unmade> {
        let small = sized(&task.scene, smaller);
        let scene = small.as_ref().unwrap_or(&task.scene);
        let [width, height] = scene.camera.pixeldim;
        self.progress.begin(precision);
        let begun = self.canvases.begin([width, height])?;
        let mut settings = Settings {
            precision,
            backend: Backend::Auto,
            verdicts: true,
            ..self.settings.clone()
        };
        let stop = || stop(self.receiver.is_old(task.number));
        let live = Live {
            gpu: &self.gpu,
            canvas: begun.as_deref(),
            compiled: Some(&self.compiled),
            dispatch_seconds: DISPATCH,
            stop: &stop,
        };
        loop {
            let pixels = width as usize * height as usize;
            let mut rgb = Vec::with_capacity(3 * pixels);
            let mut verdicts = Vec::with_capacity(pixels);
            let mut trouble = None;
            let rendered = render_live(scene, &settings, &live, &mut |band| {
                if let Err(error) = self.canvases.put(begun.as_deref(), band) {
                    trouble = Some(error);
                    return Err(std::io::Error::other("the GPU's fault"));
                }
                rgb.extend_from_slice(&band.rgb);
                verdicts.extend(band.verdicts.iter().flatten());
                let rows = height - band.rows.start;
                self.progress.reached(f64::from(rows) / f64::from(height));
                Ok(())
            });
            self.progress.end();
            return match (rendered, trouble) {
                (Ok(report), _) => Ok(PreviewPicture {
                    number: task.number,
                    scene: Arc::clone(&task.scene),
                    whole: task.whole,
                    pixels: Arc::new(Pixels {
                        size: [width, height],
                        rgb,
                        verdicts,
                    }),
                    canvas: begun,
                    // The CPU's bytes are certified, and so is the picture if it has all of its pixels.
                    precision: match report.backend {
                        Backend::Cpu if smaller == 1 => Precision::Certified,
                        _ => precision,
                    },
                    report,
                    seconds: 0.0,
                }),
                (Err(render::Error::Stopped), _) => {
                    Err(Unmade::GivenUp(verdicts.len() as f64 / pixels as f64))
                }
                // Rows that were handed on are wrong, so the CPU renders the whole picture again.
                (Err(render::Error::Revoked(_)), _) if settings.backend == Backend::Auto => {
                    settings.backend = Backend::Cpu;
                    self.progress.begin(precision);
                    continue;
                }
                (Err(_), Some(error)) => Err(error.into()),
                (Err(error), None) => Err(Unmade::Failed(error.to_string())),
            };
        }
    }
}

impl From<GpuError> for Unmade {
    fn from(error: GpuError) -> Self {
        Self::Failed(error.to_string())
    }
}

fn done(picture: PreviewPicture, took: Duration) -> News {
    News::Picture(Box::new(PreviewPicture {
        seconds: took.as_secs_f64(),
        ..picture
    }))
}

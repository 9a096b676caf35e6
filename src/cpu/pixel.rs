//! A pixel in the number types that it takes to be sure of it; `sample` makes it in one of them.
//!
//! [`ExactTracer`] decides every pixel with the cheapest numbers that can: f64 that knows its error, pairs of f64, then
//! numbers that are exact in the end. `first_hit` asks these what a ray meets.

mod first_hit;

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::camera::{camera_getdir, camera_setpix};
use super::sample::{Value, color, make_pixel, mean};
use super::surface::getamb;
use super::trace::{Fault, Limits, find_closest_object, locate};
use crate::frame::{Decided, DecidedBy, Part, PixelFault};
use crate::jitter::Sampling;
use crate::prepare::on_demand::OnDemandSources;
use crate::prepare::{Prepared, ViewParameters};
use crate::real::rational::two_to;
use crate::real::{Bounded, Effort, Lazy, Mark, Pair, Real, Undecided, V3};
use crate::scene::Scene;
pub use first_hit::FirstHit;

/// The value of pixel (x, y) in one number type, if that suffices to tell what its rays meet.
pub(crate) fn pixel_value<R: Real>(
    prepared: &Prepared<R>,
    limits: &Limits,
    sampling: Sampling<'_>,
    x: u32,
    y: u32,
) -> Option<V3<R>> {
    let value = make_pixel(prepared, limits, sampling, x, y).ok()?;
    value.closed()
}

/// By which powers of two a ray may be fainter than others and yet be followed, where bytes hang on it; in the end all
/// are.
const FAINTER: [Option<i32>; 3] = [Some(-100), Some(-900), None];

/// What is added to the error of a part: more than all that was flushed to 0 in its sums.
const FLUSHED: f64 = 1.0 / (1_u128 << 100) as f64;

/// A channel from 255 times its value, and how far that may be off.
pub(crate) fn of_bytes(value: f64, error: f64) -> Bounded {
    Bounded { value, error } / Bounded::exact(255.0)
}

/// The scene on the CPU: f64 with error bounds decides nearly every pixel, and exact numbers decide the others. Only a
/// pixel that is too much for these is presumed.
#[derive(Debug)]
pub struct ExactTracer<'a> {
    scene: &'a Scene,
    view: ViewParameters,
    values: bool,
    /// Tells the scenes of a thread's exact numbers apart.
    number: u64,
    bounded: Prepared<Bounded>,
    sources: OnceLock<OnDemandSources>,
    pairs: OnceLock<Prepared<Pair>>,
    plain: OnceLock<Prepared<f64>>,
}

/// A scene in exact numbers: they are a thread's own.
struct ThreadScene {
    /// Which [`ExactTracer`] it is of.
    number: u64,
    prepared: Rc<Prepared<Lazy>>,
    /// Where its numbers end.
    end: Mark,
}

thread_local! {
    static THREAD_SCENE: RefCell<Option<ThreadScene>> = const { RefCell::new(None) };
}

static NUMBERS: AtomicU64 = AtomicU64::new(0);

impl<'a> ExactTracer<'a> {
    /// Prepares the scene.
    pub fn new(scene: &'a Scene, view: ViewParameters) -> Self {
        Self {
            scene,
            view,
            values: false,
            number: NUMBERS.fetch_add(1, Ordering::Relaxed),
            bounded: Prepared::new(scene, view),
            sources: OnceLock::new(),
            pairs: OnceLock::new(),
            plain: OnceLock::new(),
        }
    }

    /// The scene in f64 with error bounds.
    pub fn bounded(&self) -> &Prepared<Bounded> {
        &self.bounded
    }

    /// Whether the values have to be the f32 nearest to the exact ones, as the bytes always are exact.
    pub fn with_values(mut self, wanted: bool) -> Self {
        self.values = wanted;
        self
    }

    /// The value of pixel (x, y) in f64 with error bounds, if they suffice to tell what its rays meet.
    pub fn pixel_enclosure(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        x: u32,
        y: u32,
    ) -> Option<[Bounded; 3]> {
        let v = pixel_value(&self.bounded, limits, sampling, x, y)?;
        // The bound is kept low by its own roundings until it is used.
        let used = |c: Bounded| Bounded {
            error: c.error * Bounded::GROW,
            ..c
        };
        Some([used(v.x), used(v.y), used(v.z)])
    }

    /// Pixel (x, y).
    pub fn trace(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        x: u32,
        y: u32,
    ) -> Result<Decided, PixelFault> {
        let fault = PixelFault {
            x,
            y,
            max_rays: limits.max_rays,
        };
        let quick = make_pixel(&self.bounded, limits, sampling, x, y)
            .and_then(|v| Ok(self.decided(v, DecidedBy::Bounded)?));
        match quick {
            Ok(decided) => return Ok(decided),
            Err(Fault::TooManyRays) => return Err(fault),
            Err(Fault::Undecided) => {}
        }
        if matches!(sampling, Sampling::Once) {
            if self.pairs_may_tell(f64::from(x), f64::from(y)) {
                let v = make_pixel(self.pairs(), limits, sampling, x, y);
                match v.and_then(|v| Ok(self.decided(v, DecidedBy::Pairs)?)) {
                    Ok(decided) => return Ok(decided),
                    Err(Fault::TooManyRays) => return Err(fault),
                    Err(Fault::Undecided) => {}
                }
            }
        } else {
            // Only the samples that f64 leaves open are traced in exact numbers; their mean is taken in f64 with
            // bounds.
            let v = self.mean_bounded(limits, sampling, [x, y], |_| true, &[]);
            match v.and_then(|(v, by)| Ok(self.decided(v, by)?)) {
                Ok(decided) => return Ok(decided),
                Err(Fault::TooManyRays) => return Err(fault),
                Err(Fault::Undecided) => {}
            }
        }
        match self.pixel_exactly(limits, sampling, x, y) {
            (Ok(decided), by) => Ok(Decided { by, ..decided }),
            (Err(Fault::TooManyRays), _) => Err(fault),
            (Err(Fault::Undecided), _) => {
                let v = make_pixel(self.plain(), limits, sampling, x, y);
                match v.and_then(|v| Ok(self.decided(v, DecidedBy::Presumed)?)) {
                    Ok(decided) => Ok(decided),
                    Err(Fault::TooManyRays) => Err(fault),
                    // Even plain f64 gives no number here.
                    Err(Fault::Undecided) => Ok(Decided {
                        value: [0.0; 3],
                        bytes: [0; 3],
                        by: DecidedBy::Presumed,
                    }),
                }
            }
        }
    }

    /// Pixel (x, y), of which a part is known: only the other samples are traced, and of these only those of which
    /// `brought`, which has one after the other, does not say what they bring. None where that does not tell its bytes.
    pub fn complete(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        [x, y]: [u32; 2],
        part: &Part<'_>,
        brought: &[Option<[Bounded; 3]>],
    ) -> Result<Option<Decided>, PixelFault> {
        let missing = |sample| !part.holds(sample);
        let rest = self.mean_bounded(limits, sampling, [x, y], missing, brought);
        let [r, g, b] = [0, 1, 2].map(|i| {
            let (value, error) = (f64::from(part.sum[i]), f64::from(part.error[i]) + FLUSHED);
            of_bytes(value, error)
        });
        let whole = |rest: Value<Bounded>| Value {
            color: V3::new(r, g, b) + rest.color,
            ..rest
        };
        match rest.and_then(|(rest, by)| Ok(self.decided(whole(rest), by)?)) {
            Ok(decided) => Ok(Some(decided)),
            Err(Fault::Undecided) => Ok(None),
            Err(Fault::TooManyRays) => Err(PixelFault {
                x,
                y,
                max_rays: limits.max_rays,
            }),
        }
    }

    /// What the samples that are `wanted` bring to the mean of pixel (x, y), each by the numbers that it needs, and the
    /// hardest that they took. Of the first of them `brought` may tell. Of presumed samples nothing is certain, and
    /// their errors count as 0.
    fn mean_bounded(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        [x, y]: [u32; 2],
        wanted: impl Fn(u32) -> bool,
        brought: &[Option<[Bounded; 3]>],
    ) -> Result<(Value<Bounded>, DecidedBy), Fault> {
        let mut by = DecidedBy::Bounded;
        let mut brought = brought.iter();
        let v = mean(sampling, x, y, wanted, |x, y| {
            if let Some(Some([r, g, b])) = brought.next() {
                return Ok(Value {
                    color: V3::new(*r, *g, *b),
                    open: [0.0; 3],
                });
            }
            let (v, hardest) = self.sample_bounded(limits, x, y)?;
            by = by.max(hardest);
            Ok(v)
        })?;
        Ok((v, by))
    }

    /// The colour of a sample.
    fn sample_bounded(
        &self,
        limits: &Limits,
        x: f64,
        y: f64,
    ) -> Result<(Value<Bounded>, DecidedBy), Fault> {
        match color(&self.bounded, limits, x, y) {
            Err(Fault::Undecided) => {}
            decided => return Ok((decided?, DecidedBy::Bounded)),
        }
        let value = |[r, g, b]: [Bounded; 3], open| Value {
            color: V3::new(r, g, b),
            open,
        };
        if self.pairs_may_tell(x, y) {
            match color(self.pairs(), limits, x, y) {
                Err(Fault::Undecided) => {}
                decided => {
                    let Value { color, open } = decided?;
                    let enclosures = [color.x, color.y, color.z].map(Real::enclosure);
                    return Ok((value(enclosures, open), DecidedBy::Pairs));
                }
            }
        }
        let exact = self.exactly(|scene| {
            let Value { color, open } = color(scene, limits, x, y)?;
            Ok(value([color.x, color.y, color.z].map(Lazy::bounded), open))
        });
        match exact {
            (Err(Fault::Undecided), _) => {
                let near = match color(self.plain(), limits, x, y) {
                    Err(Fault::Undecided) => [0.0; 3],
                    v => v?.color.to_f64().to_array(),
                };
                Ok((
                    value(near.map(Real::enclosure), [0.0; 3]),
                    DecidedBy::Presumed,
                ))
            }
            (v, by) => Ok((v?, by)),
        }
    }

    /// Whether what f64 leaves open there may be told by more digits: not where two numbers are equal, as most are that
    /// f64 does not tell apart at the first hit. What lies behind that is of lit scenes.
    fn pairs_may_tell(&self, x: f64, y: f64) -> bool {
        let scene = &self.bounded;
        let ray = camera_getdir(&scene.camera, x, y);
        scene.world.is_some()
            && find_closest_object(scene, &ray).is_ok_and(|hit| {
                hit.is_none_or(|hit| getamb(scene, &locate(scene, &ray, &hit)).is_ok())
            })
    }

    /// The scene in pairs of f64.
    pub fn pairs(&self) -> &Prepared<Pair> {
        self.pairs
            .get_or_init(|| Prepared::again(self.scene, self.view, &self.bounded, self.sources()))
    }

    fn sources(&self) -> &OnDemandSources {
        self.sources
            .get_or_init(|| self.bounded.sources(self.scene, self.view))
    }

    /// Pixel (x, y) in exact numbers. If its bytes hang on rays that are too faint to be followed, then more are.
    fn pixel_exactly(
        &self,
        limits: &Limits,
        sampling: Sampling<'_>,
        x: u32,
        y: u32,
    ) -> (Result<Decided, Fault>, DecidedBy) {
        let attempt = |fainter: Option<i32>| {
            let mut open = false;
            let decided = self.exactly(|scene| {
                let faint = limits.faint * fainter.map_or(0.0, two_to);
                let v = make_pixel(scene, &Limits { faint, ..*limits }, sampling, x, y)?;
                open = v.open != [0.0; 3];
                Ok(self.decided(v, DecidedBy::Bounded)?)
            });
            (decided, open)
        };
        let mut last = attempt(Some(0));
        for fainter in FAINTER {
            if !matches!(last, ((Err(Fault::Undecided), _), true)) {
                break;
            }
            last = attempt(fainter);
        }
        last.0
    }

    /// Does something with the scene in this thread's exact numbers, and tells what it took.
    fn exactly<T>(
        &self,
        work: impl FnOnce(&Prepared<Lazy>) -> Result<T, Fault>,
    ) -> (Result<T, Fault>, DecidedBy) {
        let found = THREAD_SCENE.with_borrow(|found| {
            let found = found.as_ref().filter(|found| found.number == self.number)?;
            Some((Rc::clone(&found.prepared), found.end))
        });
        let (prepared, end) = found.unwrap_or_else(|| {
            let sources = self.sources();
            Lazy::clear();
            let prepared = Prepared::again(self.scene, self.view, &self.bounded, sources);
            let (prepared, end) = (Rc::new(prepared), Lazy::mark());
            THREAD_SCENE.set(Some(ThreadScene {
                number: self.number,
                prepared: Rc::clone(&prepared),
                end,
            }));
            (prepared, end)
        });
        Lazy::effort();
        let result = work(&prepared);
        let by = match Lazy::effort() {
            Effort::Bounds | Effort::Precision => DecidedBy::Multiprecision,
            Effort::Proven => DecidedBy::Exact,
            Effort::Presumed => DecidedBy::Presumed,
        };
        Lazy::release(end);
        (result, by)
    }

    /// The scene in f64, for what has to be presumed, and for people to read.
    pub fn plain(&self) -> &Prepared<f64> {
        self.plain
            .get_or_init(|| Prepared::new(self.scene, self.view))
    }

    /// A pixel from its value.
    fn decided<R: Real>(&self, v: Value<R>, by: DecidedBy) -> Result<Decided, Undecided> {
        let (v, bytes) = match v.closed() {
            Some(v) => (v, camera_setpix(v)?),
            None => {
                // The least and the most that it may be have the same bytes, or it is not known well enough.
                let bytes = camera_setpix(v.color)?;
                if camera_setpix(v.most())? != bytes || self.values {
                    return Err(Undecided);
                }
                (v.color, bytes)
            }
        };
        let value = if self.values {
            [v.x.nearest_f32()?, v.y.nearest_f32()?, v.z.nearest_f32()?]
        } else {
            v.to_f64().to_array().map(|c| c as f32)
        };
        Ok(Decided { value, bytes, by })
    }
}

#[cfg(test)]
mod tests;

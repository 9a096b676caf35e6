//! How much is computed for a pixel: a scene that takes long is a fault too. Counted in rays and words, as the clock
//! depends on what else runs.

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::ray_trace;
use plumb::frame::DecidedBy;
use plumb::real::Lazy;

use super::kinds::{KINDS, SurfaceKind, case};
use super::random::settings;
use super::scene;
use super::trees::Followed;

/// Scenes of each kind.
const SCENES: u64 = 100;

/// Most rays that f64 follows for a sample, and most words that exact numbers take for a pixel.
fn most(kind: SurfaceKind) -> [u64; 2] {
    match kind {
        // Where mirrors and panes add to the light there is no end but the limits (docs/NUMERICS.md, "What takes
        // long").
        SurfaceKind::Chain => [1 << 16, 1 << 27],
        SurfaceKind::Stuff => [1 << 10, 1 << 22],
        _ => [1 << 6, 1 << 19],
    }
}

#[test]
fn no_pixel_takes_much_work() {
    for kind in KINDS {
        let (mut rays, mut words) = ((0, 0), (0, 0));
        let mut presumed = 0;
        for number in 3_000..3_000 + SCENES {
            let case = case(kind, number);
            let (scene, settings) = (scene(&case.text), settings(&case));
            let limits = settings.sample_limits();
            let tracer = ExactTracer::new(&scene, settings.view());
            let [width, height] = scene.camera.pixeldim;
            let jitter = settings.sampling(width, height);
            for y in 0..height {
                let offsets = jitter.row(y);
                for x in 0..width {
                    let mut followed = Followed::default();
                    let (sx, sy) = (f64::from(x), f64::from(y));
                    // What f64 does not decide is asked of exact numbers below.
                    let _ = ray_trace(tracer.bounded(), &limits, sx, sy, &mut followed);
                    rays = rays.max((followed.rays, number));
                    let sampling = jitter.pixel(offsets.as_deref(), width as usize, x as usize);
                    let before = Lazy::work();
                    let decided = tracer.trace(&limits, sampling, x, y);
                    words = words.max((Lazy::work() - before, number));
                    presumed += u32::from(decided.is_ok_and(|d| d.by == DecidedBy::Presumed));
                }
            }
        }
        println!("{kind:?}: (most, in scene) {rays:?} rays, {words:?} words; {presumed} presumed");
        let [most_rays, most_words] = most(kind);
        assert!(rays.0 < most_rays, "{kind:?}: {rays:?}");
        assert!(words.0 < most_words, "{kind:?}: {words:?}");
        assert!(
            presumed <= u32::from(kind == SurfaceKind::Chain) * 20,
            "{kind:?}: {presumed}"
        );
    }
}

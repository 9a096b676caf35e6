//! How much is computed for a pixel: a scene that takes long is a fault too. Counted in rays and words, as the clock
//! depends on what else runs.

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::trace::ray_trace;
use plumb::frame::DecidedBy;
use plumb::real::Lazy;
use plumb::scene::{Material, Scene};

use super::kinds::{Case, KINDS, SurfaceKind, case};
use super::random::settings;
use super::scene;
use super::trees::Followed;

/// Scenes of each kind.
const SCENES: u64 = 100;

/// Most rays that f64 follows for a sample, and most words that exact numbers take for a pixel. Where mirrors and panes
/// add to the light there is no end but the limits (docs/NUMERICS.md, "What takes long").
const MOST: [u64; 2] = [1 << 9, 1 << 19];
const MOST_WITH_GAIN: [u64; 2] = [1 << 16, 1 << 27];

/// Whether a mirror or pane may leave more of a weight than there was.
fn gains(scene: &Scene) -> bool {
    let gain = |material: &Material| material.specular.max_element() + material.transparency;
    scene.materials.iter().any(|material| gain(material) > 1.0)
}

/// What the pixels of some scenes took at most, and in which of them.
#[derive(Debug, Default)]
struct Most {
    rays: (u64, u64),
    words: (u64, u64),
    presumed: u32,
}

impl Most {
    fn look(&mut self, case: &Case, scene: &Scene, number: u64) {
        let settings = settings(case);
        let limits = settings.sample_limits();
        let tracer = ExactTracer::new(scene, settings.view());
        let [width, height] = scene.camera.pixeldim;
        let jitter = settings.sampling(width, height);
        for y in 0..height {
            let offsets = jitter.row(y);
            for x in 0..width {
                let mut followed = Followed::default();
                // What f64 does not decide is asked of exact numbers below.
                let _ = ray_trace(tracer.bounded(), &limits, x.into(), y.into(), &mut followed);
                self.rays = self.rays.max((followed.rays, number));
                let sampling = jitter.pixel(offsets.as_deref(), width as usize, x as usize);
                let before = Lazy::work();
                let decided = tracer.trace(&limits, sampling, x, y);
                self.words = self.words.max((Lazy::work() - before, number));
                self.presumed += u32::from(decided.is_ok_and(|d| d.by == DecidedBy::Presumed));
            }
        }
    }

    fn judge(&self, kind: SurfaceKind, [rays, words]: [u64; 2]) {
        assert!(self.rays.0 < rays, "{kind:?}: {self:?}");
        assert!(self.words.0 < words, "{kind:?}: {self:?}");
    }
}

#[test]
fn no_pixel_takes_much_work() {
    for kind in KINDS {
        let (mut most, mut with_gain) = (Most::default(), Most::default());
        for number in 3_000..3_000 + SCENES {
            let case = case(kind, number);
            let scene = scene(&case.text);
            let most = if gains(&scene) {
                &mut with_gain
            } else {
                &mut most
            };
            most.look(&case, &scene, number);
        }
        most.judge(kind, MOST);
        with_gain.judge(kind, MOST_WITH_GAIN);
        assert_eq!(most.presumed, 0, "{kind:?}");
    }
}

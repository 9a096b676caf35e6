//! How large a picture may be that has to be there at once: in lower resolution where the whole one takes too long.
//!
//! Learns from what the last pictures took; the worker asks.

use crate::scene::Scene;

/// A picture that takes no longer than so many seconds is rendered as large as it is.
const QUICK: f64 = 0.15;
/// A smaller one is made to take about so many seconds.
const AIM: f64 = 0.08;
/// Pictures are made smaller at most so many times in each direction.
const MOST: u32 = 16;
/// Most pixels that are shown; a larger picture is shown smaller.
pub(super) const MOST_PIXELS: u64 = 16 << 20;

/// What pictures of a scene took lately.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AdaptiveResolution {
    /// Seconds that any picture takes, however small, such as for compiling: the least that one took.
    least: Option<f64>,
    /// Seconds of the whole picture.
    whole: Option<f64>,
    /// Seconds of the certified picture.
    certified: Option<f64>,
}

impl AdaptiveResolution {
    /// How many times smaller in each direction the first picture should be.
    pub(super) fn first(&self) -> u32 {
        match self.whole {
            // Whoever renders has to look at the clock.
            None => 1,
            Some(whole) if whole <= QUICK => 1,
            Some(whole) => {
                let fixed = self.least.unwrap_or(0.0).min(AIM / 2.0);
                let times = (whole - fixed) / (AIM - fixed);
                (times.sqrt().ceil() as u32).clamp(2, MOST)
            }
        }
    }

    /// How long a first picture, as large as it is, may take before it is given up for a smaller one: none if that is
    /// known to be quick.
    pub(super) fn patience(&self) -> Option<f64> {
        self.whole.is_none().then_some(QUICK)
    }

    /// A picture so many times smaller took so long.
    pub(super) fn took(&mut self, smaller: u32, seconds: f64) {
        self.least = Some(self.least.map_or(seconds, |least| least.min(seconds)));
        if smaller == 1 {
            self.whole = Some(seconds);
        } else if let Some(whole) = &mut self.whole {
            // The estimate moves half of the way to this measurement: one picture says little on a machine that does
            // other things.
            let fixed = self.least.unwrap_or(0.0).min(AIM / 2.0);
            let says = fixed + (seconds - fixed) * f64::from(smaller * smaller);
            *whole = 0.5 * (*whole + says);
        }
    }

    /// Whether a whole fast picture should come between a smaller one and the certified one: only where it is known to
    /// be there in less than half of the time. On a driver that computes on the CPU it is not: a shader that serves
    /// every viewpoint loads what a certified picture's shader has in its text.
    pub(super) fn is_whole_worth_it(&self) -> bool {
        self.whole
            .zip(self.certified)
            .is_some_and(|(whole, certified)| whole < 0.5 * certified)
    }

    /// The certified picture took so long.
    pub(super) fn took_certified(&mut self, seconds: f64) {
        self.certified = Some(seconds);
    }

    /// A whole picture was given up after so long, when this share of it was done.
    pub(super) fn gave_up(&mut self, seconds: f64, share: f64) {
        let whole = seconds / share.clamp(1e-3, 1.0);
        self.whole = Some(whole.max(1.01 * QUICK));
    }
}

/// The scene with a picture so many times smaller in each direction; none if that is the scene itself.
pub(super) fn sized(scene: &Scene, smaller: u32) -> Option<Scene> {
    (smaller > 1).then(|| {
        let mut scene = scene.clone();
        scene.camera.pixeldim = scene.camera.pixeldim.map(|pixels| pixels.div_ceil(smaller));
        scene
    })
}

/// How many times smaller in each direction a picture has to be to have so many pixels at most.
pub(super) fn smaller(pixeldim: [u32; 2], most: u64) -> u32 {
    let pixels = |smaller: u32| {
        let [width, height] = pixeldim.map(|pixels| u64::from(pixels.div_ceil(smaller)));
        width * height
    };
    let [width, height] = pixeldim.map(f64::from);
    let mut smaller = ((width * height / most as f64).sqrt() as u32).max(1);
    while pixels(smaller) > most {
        smaller += 1;
    }
    smaller
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quick_scene_is_never_made_smaller() {
        let mut resolution = AdaptiveResolution::default();
        assert_eq!(
            (resolution.first(), resolution.patience()),
            (1, Some(QUICK))
        );
        resolution.took(1, 0.06);
        assert_eq!((resolution.first(), resolution.patience()), (1, None));
        resolution.took(1, 0.149);
        assert_eq!(resolution.first(), 1);
    }

    #[test]
    fn a_slow_scene_begins_small_and_takes_about_as_long_as_it_may() {
        // So long for compiling, and so long a picture.
        for (fixed, whole) in [(0.0, 1.0), (0.03, 0.3), (0.05, 4.0), (0.02, 60.0)] {
            let seconds = |smaller: u32| fixed + whole / f64::from(smaller * smaller);
            let mut resolution = AdaptiveResolution::default();
            resolution.gave_up(0.2, 0.2 / seconds(1));
            for _ in 0..5 {
                let smaller = resolution.first();
                assert!(smaller > 1, "{fixed} {whole}");
                resolution.took(smaller, seconds(smaller));
            }
            let smaller = resolution.first();
            assert!(
                seconds(smaller) <= 0.13 || smaller == MOST,
                "{fixed} {whole} {smaller}"
            );
            // No smaller than it has to be.
            assert!(
                smaller <= 2 || seconds(smaller - 1) > 0.07,
                "{fixed} {whole} {smaller}"
            );
        }
    }

    #[test]
    fn a_scene_that_became_quick_is_noticed() {
        let mut resolution = AdaptiveResolution::default();
        resolution.took(1, 2.0);
        assert!(resolution.first() > 4);
        // An edit removed what made it slow.
        for _ in 0..8 {
            let smaller = resolution.first();
            resolution.took(smaller, 0.02);
            assert!(resolution.first() <= smaller);
        }
        assert_eq!(resolution.first(), 1);
    }

    #[test]
    fn a_whole_fast_picture_is_made_where_it_is_known_to_be_quicker() {
        let mut resolution = AdaptiveResolution::default();
        resolution.took(1, 2.0);
        assert!(!resolution.is_whole_worth_it());
        resolution.took_certified(5.0);
        assert!(resolution.is_whole_worth_it());
        resolution.took_certified(3.0);
        assert!(!resolution.is_whole_worth_it());
    }

    #[test]
    fn a_scene_that_became_slow_is_noticed() {
        let mut resolution = AdaptiveResolution::default();
        resolution.took(1, 0.05);
        resolution.took(1, 3.0);
        assert!(resolution.first() > 4);
    }

    #[test]
    fn pictures_are_as_large_as_they_may_be() {
        assert_eq!(smaller([640, 480], MOST_PIXELS), 1);
        assert_eq!(smaller([4096, 4096], MOST_PIXELS), 1);
        assert_eq!(smaller([4097, 4096], MOST_PIXELS), 2);
        for pixeldim in [
            [1_000_000, 1_000_000],
            [1_000_000, 17],
            [3, 999_999],
            [32768, 32768],
        ] {
            let k = smaller(pixeldim, MOST_PIXELS);
            let pixels = |k: u32| {
                pixeldim
                    .iter()
                    .map(|n: &u32| u64::from(n.div_ceil(k)))
                    .product::<u64>()
            };
            assert!(pixels(k) <= MOST_PIXELS, "{pixeldim:?} {k}");
            assert!(k == 1 || pixels(k - 1) > MOST_PIXELS, "{pixeldim:?} {k}");
        }
    }
}

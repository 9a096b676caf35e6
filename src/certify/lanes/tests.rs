//! Where lanes are put together something may be wrong: a lane, a mask, a ray. The referee notices each.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fearless_simd::{Simd, prelude::*};

use super::doubles::DoubleLanes;
use super::mean::{Means, Shares};
use super::scene::numbers;
use super::vector::{F, M};
use super::{Lanes, OPEN};
use crate::cpu::pixel::ExactTracer;
use crate::cpu::trace::Limits;
use crate::jitter::Sampling;
use crate::real::Bounded;
use crate::scene::{Scene, load};
use crate::settings::Settings;
use crate::shader::pack::Packed;

/// What may be wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fault {
    /// The first two pixels of a vector change places.
    PixelsSwapped,
    /// A colour's channel goes to the samples beside.
    SamplesShifted,
    /// Of a vector's samples one is lost, and counts as if it were black.
    SampleLost,
    /// Where numbers are chosen by a mask, it is taken the other way round.
    ChoiceInverted,
    /// A branch that some lanes go, and not all, is gone by none.
    BranchSkipped,
    /// Lanes read the records of those beside.
    RecordsShifted,
    /// What is met of an object in a cell of the screen counts for the pixels of the other cells.
    CellInverted,
    /// A box of a tree is entered for the lanes alone that are off.
    BoxInverted,
    /// Shadow rays are looked after where they have found something, and not where they have not.
    ShadowInverted,
    /// Objects that one ray misses are left out for all.
    MissedByOne,
}

impl Fault {
    const ALL: [Self; 10] = [
        Self::PixelsSwapped,
        Self::SamplesShifted,
        Self::SampleLost,
        Self::ChoiceInverted,
        Self::BranchSkipped,
        Self::RecordsShifted,
        Self::CellInverted,
        Self::BoxInverted,
        Self::ShadowInverted,
        Self::MissedByOne,
    ];

    /// Whether it is one of pixels of several samples.
    fn is_of_samples(self) -> bool {
        matches!(self, Self::SamplesShifted | Self::SampleLost)
    }

    /// Whether it may be in f64 too, which has no rows with means.
    fn is_of_lists(self) -> bool {
        !self.is_of_samples()
    }
}

/// A fault shows every so many times: loops come to an end then.
const EVERY: u32 = 7;

thread_local! {
    static FAULT: Cell<Option<Fault>> = const { Cell::new(None) };
    static ASKED: Cell<u32> = const { Cell::new(0) };
}

/// Whether this is wrong now.
pub(super) fn is_wrong(fault: Fault) -> bool {
    FAULT.get() == Some(fault) && {
        ASKED.set(ASKED.get().wrapping_add(1));
        ASKED.get().is_multiple_of(EVERY)
    }
}

/// A mask, inverted if that is wrong now.
pub(super) fn inverted<S: Simd>(fault: Fault, mask: M<S>) -> M<S> {
    if is_wrong(fault) { !mask } else { mask }
}

/// Numbers, each in the lane beside if that is wrong now.
pub(super) fn shifted<S: Simd>(fault: Fault, numbers: F<S>) -> F<S> {
    let all = numbers.as_slice();
    if is_wrong(fault) {
        F::from_fn(numbers.0.token(), |lane| all[(lane + 1) % all.len()])
    } else {
        numbers
    }
}

const SIZE: [u32; 2] = [45, 31];

/// A picture, and what is right.
struct Referee {
    lanes: Lanes,
    /// Scenes with lights in f64, with each kind of vectors.
    doubles: Vec<(&'static str, DoubleLanes)>,
    settings: Settings,
    bytes: Vec<[u8; 3]>,
}

impl Referee {
    fn new(scene: &Scene, samples: u32) -> Self {
        let settings = Settings {
            samples,
            ..Settings::default()
        };
        let exact_tracer = ExactTracer::new(scene, settings.view());
        let (limits, jitter) = (
            settings.sample_limits(),
            settings.sampling(SIZE[0], SIZE[1]),
        );
        let packed = Packed::prepared(exact_tracer.bounded(), scene, &settings);
        let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        let bytes = places.map(|[x, y]| {
            let sampling = jitter.pixel(None, SIZE[0] as usize, x as usize);
            exact_tracer.trace(&limits, sampling, x, y).unwrap().bytes
        });
        let doubles = DoubleLanes::may_be(scene, &settings).then(|| {
            DoubleLanes::new(scene, &settings)
                .unwrap()
                .with_each_vector()
        });
        Self {
            doubles: doubles.unwrap_or_default(),
            bytes: bytes.collect(),
            lanes: Lanes::of(Arc::new(packed), &settings).unwrap(),
            settings,
        }
    }

    /// How many pixels each kind of vectors is sure of, and wrong about.
    fn counts(&self) -> Vec<(&'static str, [usize; 2])> {
        let kinds = self.lanes.with_each_vector();
        kinds
            .into_iter()
            .map(|(name, lanes)| (name, self.count(&lanes)))
            .collect()
    }

    /// The same in f64, of one in so many pixels, in an order in which no two neighbours are side by side.
    fn counts_of_doubles(&self, step: usize) -> Vec<(&'static str, [usize; 2])> {
        let all = self.bytes.len();
        // A step that no side of the picture divides.
        let order: Vec<usize> = (0..all).step_by(step).map(|i| i * 457 % all).collect();
        let pixels = order.len();
        let width = SIZE[0] as usize;
        let places: Vec<_> = order
            .iter()
            .map(|i| [i % width, i / width].map(|i| i as u32))
            .collect();
        let count = |(name, doubles): &(&'static str, DoubleLanes)| {
            let mut words = vec![OPEN; pixels];
            match self.settings.samples {
                1 => doubles.pixels(&places, &mut words),
                samples => words = means(doubles, &places, samples),
            }
            let right = order.iter().map(|i| &self.bytes[*i]);
            (*name, counted(&words, right))
        };
        self.doubles.iter().map(count).collect()
    }

    fn count(&self, lanes: &Lanes) -> [usize; 2] {
        let mut words = vec![OPEN; SIZE[0] as usize];
        let (mut sure, mut wrong) = (0, 0);
        for (y, right) in (0..).zip(self.bytes.chunks(SIZE[0] as usize)) {
            match lanes.means() {
                None => lanes.strip([0, y], &mut words),
                Some(mut means) => lanes.sampled([0, y], None, &mut words, &mut means),
            }
            let row = counted(&words, right.iter());
            sure += row[0];
            wrong += row[1];
        }
        [sure, wrong]
    }
}

/// The words of pixels of which f64 is sure of all samples, by the hash.
fn means(doubles: &DoubleLanes, places: &[[u32; 2]], samples: u32) -> Vec<u32> {
    let (mut all, mut offsets) = (Vec::new(), Vec::new());
    for at in places {
        all.extend((0..samples).map(|_| *at));
        offsets.extend(Sampling::Hash(samples).offsets(at[0], at[1]));
    }
    let mut brought = vec![None; all.len()];
    doubles.samples(&all, &offsets, &mut brought);
    let word = |brought: &[Option<[Bounded; 3]>]| {
        let brought: Vec<_> = brought.iter().copied().collect::<Option<_>>()?;
        let mut bytes = [0; 4];
        for (channel, byte) in bytes.iter_mut().take(3).enumerate() {
            let sum = |of: fn(Bounded) -> f64| -> f64 {
                brought.iter().map(|brought| of(brought[channel])).sum()
            };
            let mean = |sum: f64| 255.0 * sum / f64::from(samples);
            let [value, error] = [mean(sum(|b| b.value)), mean(sum(|b| b.error))];
            let ends = [-1.0, 1.0].map(|way| value + way * (1.01 * error + 1e-9));
            let [least, most] = ends.map(|end| end.clamp(0.0, 255.0) as u8);
            *byte = (least == most).then_some(least)?;
        }
        Some(u32::from_le_bytes(bytes))
    };
    let pixels = brought.chunks(samples as usize);
    pixels
        .map(|brought| word(brought).unwrap_or(OPEN))
        .collect()
}

/// How many words are sure, and wrong.
fn counted<'a>(words: &[u32], right: impl Iterator<Item = &'a [u8; 3]>) -> [usize; 2] {
    let (mut sure, mut wrong) = (0, 0);
    for (word, right) in words.iter().zip(right) {
        let [red, green, blue, verdict] = word.to_le_bytes();
        sure += usize::from(verdict == 0);
        wrong += usize::from(verdict == 0 && [red, green, blue] != *right);
    }
    [sure, wrong]
}

fn scene(name: &str) -> Scene {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes", name]
        .iter()
        .collect();
    let mut scene = load(Path::new(&path)).unwrap();
    scene.camera.pixeldim = SIZE;
    scene
}

#[test]
fn what_is_wrong_where_lanes_are_put_together_is_noticed() {
    let tree = scene("hard/lit_balls_twice.txt");
    let mut cells = tree.clone();
    cells.lights.clear();
    let scenes = [
        scene("gallery/spheres_over_tiles.txt"),
        cells,
        tree,
        scene("lit/mirror_balls.txt"),
        scene("lit/gem.txt"),
    ];
    let of = |samples| -> Vec<_> {
        scenes
            .iter()
            .map(|scene| Referee::new(scene, samples))
            .collect()
    };
    let [one, several] = [1, 3].map(of);
    for referee in one.iter().chain(&several) {
        for (name, [sure, wrong]) in referee.counts() {
            assert_eq!(wrong, 0, "{name}, {} samples", referee.settings.samples);
            assert!(2 * sure > referee.bytes.len(), "{name}: {sure} sure");
        }
        for (name, [sure, wrong]) in referee.counts_of_doubles(1) {
            let samples = referee.settings.samples;
            println!(
                "{name}, in f64: {sure} of {} sure, {samples} samples",
                referee.bytes.len()
            );
            assert_eq!(wrong, 0, "{name}, in f64");
            assert!(100 * sure > 95 * referee.bytes.len(), "{name}: {sure} sure");
        }
    }
    for fault in Fault::ALL {
        let referees = if fault.is_of_samples() {
            &several
        } else {
            &one
        };
        FAULT.set(Some(fault));
        let counts: Vec<_> = referees.iter().map(Referee::counts).collect();
        FAULT.set(None);
        for (kind, (name, _)) in counts[0].iter().enumerate() {
            let wrong: Vec<_> = counts.iter().map(|counts| counts[kind].1[1]).collect();
            println!("{fault:?}, {name}: {wrong:?} wrong");
            assert!(wrong.iter().sum::<usize>() > 0, "{fault:?}, {name}");
        }
        if !fault.is_of_lists() {
            continue;
        }
        // Samples come from a list as pixels do; what is traced is the same.
        let swapped = fault == Fault::PixelsSwapped;
        let lists = [(&one, 2), (&several, 3)];
        for (referees, step) in lists.into_iter().take(1 + usize::from(swapped)) {
            FAULT.set(Some(fault));
            let counts = referees.iter().map(|one| one.counts_of_doubles(step));
            let lit: Vec<_> = counts.filter(|counts| !counts.is_empty()).collect();
            FAULT.set(None);
            let first = lit.first().into_iter().flatten();
            for (kind, (name, _)) in first.enumerate() {
                let wrong: Vec<_> = lit.iter().map(|counts| counts[kind].1[1]).collect();
                println!("{fault:?}, {name}, in f64: {wrong:?} wrong");
                assert!(wrong.iter().sum::<usize>() > 0, "{fault:?}, {name}, in f64");
            }
        }
    }
}

/// Whatever the vectors are, and however pixels lie in them: the bits are those of the fine samples, and the sums hold
/// the exact ones.
#[test]
fn means_hold_what_was_added() {
    let mut seed = 1_u64;
    let mut next = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f32 / 16_777_216.0
    };
    for (samples, width) in [(2, 16), (3, 4), (16, 16), (33, 8), (40, 16), (70, 16)] {
        let mut means = Means::new(samples);
        let (pixels, [share, error_share]) = (5, means.shares());
        means.begin(pixels);
        let all: Vec<_> = (0..pixels as u32 * samples)
            .map(|_| (255.0 * next(), 0.01 * next(), next() < 0.9, next() < 0.7))
            .collect();
        for new in all.chunks(width) {
            let color: Vec<_> = new.iter().map(|(color, ..)| color * share).collect();
            let error: Vec<_> = new
                .iter()
                .map(|(_, error, ..)| error * error_share)
                .collect();
            let bits = |of: fn(bool, bool) -> bool| {
                let on = |(lane, (_, _, sure, fine)): (usize, &(f32, f32, bool, bool))| {
                    u64::from(of(*sure, *fine)) << lane
                };
                new.iter().enumerate().map(on).sum()
            };
            means.add(&Shares {
                color: [&color; 3],
                error: [&error; 3],
                sure: bits(|sure, _| sure),
                fine: bits(|sure, fine| sure && fine),
                count: new.len(),
            });
        }
        for (pixel, all) in all.chunks(samples as usize).enumerate() {
            let mean = |counts: fn(bool, bool) -> bool| -> f64 {
                let counted = all.iter().filter(|(_, _, sure, fine)| counts(*sure, *fine));
                counted.map(|(color, ..)| f64::from(*color)).sum::<f64>() / f64::from(samples)
            };
            let holds = |sum: f32, error: f32, exact: f64| {
                error < 0.011 && (f64::from(sum) - exact).abs() <= f64::from(error)
            };
            let [color, error] = means.sum(pixel);
            assert!(holds(color[0], error[0], mean(|sure, _| sure)));
            let is_sure = all.iter().all(|(_, _, sure, _)| *sure);
            assert_eq!(means.verdict(pixel), if is_sure { 0 } else { OPEN });
            let fine: Vec<_> = (0..)
                .zip(all)
                .filter(|(_, s)| s.2 && s.3)
                .map(|(i, _)| i)
                .collect();
            let some = (1..all.len()).contains(&fine.len());
            assert_eq!(means.part(pixel).is_some(), some);
            if let Some(part) = means.part(pixel) {
                let held: Vec<u32> = (0..samples).filter(|sample| part.holds(*sample)).collect();
                assert_eq!(held, fine, "{samples} samples");
                assert!(holds(
                    part.sum[1],
                    part.error[1],
                    mean(|sure, fine| sure && fine)
                ));
            }
        }
    }
}

#[test]
fn what_no_bound_counts_is_not_taken() {
    let scene = scene("lit/glass_panes.txt");
    let settings = Settings {
        limits: Limits {
            max_rays: u32::MAX,
            ..Settings::default().limits
        },
        ..Settings::default()
    };
    let packed = Packed::new(&scene, &settings);
    // Sums of more rays might leave the range.
    assert_eq!(numbers(&packed, &settings).max_rays, 1 << 16);
    // A ray may pass more panes than bounds count.
    for (objects, taken) in [(450_000, true), (450_001, false)] {
        let mut packed = packed.clone();
        let lit = packed.lit.as_mut().unwrap();
        lit.objects = vec![lit.objects[0]; objects];
        let lanes = Lanes::of(Arc::new(packed), &settings);
        assert_eq!(lanes.is_some(), taken, "{objects}");
    }
}

//! Who decides after whom changes no byte, and loses no pixel and no sample.

use std::path::PathBuf;

use super::*;
use crate::scene::load;
use crate::settings::SamplePattern;

const SIZE: [u32; 2] = [40, 30];

/// How often each pixel of a picture is handed back, the bytes that it has, and how many samples that took, if all
/// are handed in once.
fn decided(
    cascade: &Cascade<'_>,
    settings: &Settings,
    decides: Decides,
) -> Vec<(usize, [u8; 3], u32)> {
    let jitter = settings.sampling(SIZE[0], SIZE[1]);
    let rows: Vec<_> = (0..SIZE[1]).map(|y| jitter.row(y)).collect();
    let open: Vec<_> = (0..SIZE[0] * SIZE[1])
        .map(|i| {
            let [x, y] = [i % SIZE[0], i / SIZE[0]];
            let row = rows[y as usize].as_deref();
            Open {
                at: [x, y],
                sampling: jitter.pixel(row, SIZE[0] as usize, x as usize),
                part: None,
            }
        })
        .collect();
    let mut all = vec![(0, [0; 3], 0); open.len()];
    cascade
        .decide(&open, decides, &mut |i, decided, effort| {
            all[i] = (all[i].0 + 1, decided.bytes, effort.samples);
        })
        .unwrap();
    all
}

fn gem() -> Scene {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "scenes/lit/gem.txt"]
        .iter()
        .collect();
    let mut scene = load(&path).unwrap();
    scene.camera.pixeldim = SIZE;
    scene
}

#[test]
fn every_pixel_is_decided_once_whoever_decides() {
    let scene = gem();
    for (samples, jitter) in [
        (1, SamplePattern::Hash),
        (5, SamplePattern::Hash),
        (4, SamplePattern::Course),
    ] {
        let settings = Settings {
            samples,
            jitter,
            ..Settings::default()
        };
        let cascade = Cascade::new(&scene, &settings);
        let alone = decided(&cascade, &settings, Decides::Referee);
        assert!(cascade.doubles.made.get().is_none());
        let any = decided(&cascade, &settings, Decides::Any);
        assert!(cascade.takes_many());
        assert!(cascade.doubles.made.get().unwrap().is_some());
        for (alone, any) in alone.iter().zip(&any) {
            assert_eq!(*any, *alone);
            assert_eq!((any.0, any.2), (1, samples));
        }
    }
}

/// Some pixels are left by f64 for many at once, and are decided too.
#[test]
fn some_is_left_for_numbers_of_more_bits() {
    let scene = gem();
    let doubles = DoubleLanes::new(&scene, &Settings::default()).unwrap();
    let at: Vec<_> = (0..SIZE[0] * SIZE[1])
        .map(|i| [i % SIZE[0], i / SIZE[0]])
        .collect();
    let mut words = vec![0; at.len()];
    doubles.pixels(&at, &mut words);
    let left = words.iter().filter(|word| **word >= OPEN).count();
    assert!((1..at.len() / 4).contains(&left), "{left} left");
    let mut brought = vec![None; at.len()];
    doubles.samples(&at, &vec![[0.0; 2]; at.len()], &mut brought);
    let without = brought.iter().filter(|brought| brought.is_none()).count();
    assert!((1..=left).contains(&without), "{without} without");
}

/// Whatever is known of pixels, the samples that are missing are those that are traced, each for its own pixel, and
/// together they are not too many.
#[test]
fn what_is_missing_of_pixels_is_traced_for_each() {
    let scene = gem();
    let settings = Settings {
        samples: 40,
        ..Settings::default()
    };
    let doubles = DoubleLanes::new(&scene, &settings).unwrap();
    let summed = [[0x0f0f_0001, 0x3], [!0, 0xff], [0, 0x80]];
    let open: Vec<_> = (0..SIZE[0] * SIZE[1])
        .map(|i| Open {
            at: [i % SIZE[0], i / SIZE[0]],
            sampling: Sampling::Hash(40),
            part: summed.get(i as usize % 4).map(|summed| Part {
                summed,
                ..Part::NOTHING
            }),
        })
        .collect();
    let (mut seen, mut all_samples, mut certain) = (0, 0, 0);
    for group in groups(&open) {
        assert_eq!(group.start, seen);
        seen = group.end;
        let missing = open[group.clone()].iter().map(Open::missing);
        assert!(missing.clone().sum::<u32>() < AT_ONCE + 40);
        let brought = Brought::new(&doubles, &open[group.clone()], group.start);
        for i in group {
            let Open { at, sampling, part } = open[i];
            let offsets: Vec<_> = (0..)
                .zip(sampling.offsets(at[0], at[1]))
                .filter(|(sample, _)| !part.is_some_and(|part| part.holds(*sample)))
                .map(|(_, offset)| offset)
                .collect();
            let mut alone = vec![None; offsets.len()];
            doubles.samples(&vec![at; offsets.len()], &offsets, &mut alone);
            assert_eq!(offsets.len() as u32, open[i].missing());
            // All but those that are in doubt where lanes walk together, if others are beside them.
            let values = |brought: &[Option<[Bounded; 3]>]| -> Vec<_> {
                let value = |b: &Option<[Bounded; 3]>| b.map(|b| b.map(|b| b.value));
                brought.iter().map(value).collect()
            };
            let [all, alone] = [values(brought.of(i)), values(&alone)];
            assert_eq!(all.len(), alone.len());
            all_samples += all.len();
            certain += all.iter().flatten().count();
            let differ = all.iter().zip(&alone).filter(|(a, b)| a != b);
            assert_eq!(
                differ.filter(|(a, b)| a.is_some() && b.is_some()).count(),
                0
            );
        }
    }
    assert_eq!(seen, open.len());
    assert!(
        certain * 100 > all_samples * 95,
        "{certain} of {all_samples}"
    );
}

#[test]
fn few_pixels_are_not_worth_the_preparation() {
    let scene = gem();
    let doubles = Doubles::new(&scene, &Settings::default());
    assert!(doubles.ask(&scene, WORTH).is_none());
    assert!(doubles.ask(&scene, 0).is_none());
    assert!(doubles.ask(&scene, 1).is_some());
    // Values are nothing for it.
    let settings = Settings {
        values: true,
        ..Settings::default()
    };
    let doubles = Doubles::new(&scene, &settings);
    assert!(doubles.ask(&scene, 2 * WORTH).is_none());
}

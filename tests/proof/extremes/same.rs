//! What must not change a picture does not: no oracle is needed for that, and no size is too much for it.

use std::collections::HashSet;

use plumb::prepare::groups::groups;
use plumb::render::Settings;

use super::chance::Random;
use super::kinds::{KINDS, case};
use super::random::settings;
use super::{picture, scene};

/// Scenes of each kind.
const SCENES: u64 = 12;

/// For scenes of all kinds: the picture is that of what `change` makes of the text and the settings.
fn unchanged(name: &str, change: impl Fn(&str, &mut Settings) -> Option<String>) {
    alike(name, |text, settings| {
        Some([text.to_owned(), change(text, settings)?])
    });
}

/// For scenes of all kinds: the two that `change` makes of it have the same picture, the second one with the settings
/// that it makes.
fn alike(name: &str, change: impl Fn(&str, &mut Settings) -> Option<[String; 2]>) {
    let mut tried = 0;
    for kind in KINDS {
        // Numbers that the oracle's test does not try.
        for number in 1_000..1_000 + SCENES {
            let case = case(kind, number);
            let before = settings(&case);
            let mut after = before.clone();
            let Some([first, second]) = change(&case.text, &mut after) else {
                continue;
            };
            tried += 1;
            let (one, other) = (
                picture(&scene(&first), &before),
                picture(&scene(&second), &after),
            );
            assert_eq!(one, other, "{name}, {kind:?} {number}:\n{first}\n{second}");
        }
    }
    assert!(tried > 20, "only {tried} scenes");
}

/// A power of two for the unit of length, if no number is lost: all lengths times 2^k, and colours too, as they are
/// divided by lengths.
#[test]
fn lengths_may_be_in_any_unit() {
    for power in [-300, -40, 7, 300] {
        unchanged("scaled", |text, settings| {
            settings.limits.max_path *= 2_f64.powi(power);
            in_units(text, power)
        });
    }
}

/// The scene with all its lengths, and what is divided by them, times 2^power (diffuse light is divided by two, and is
/// the product of two colours); None if that is not exact, or a rule has a length of its own.
fn in_units(text: &str, power: i32) -> Option<String> {
    let lengths = [
        "worlddim",
        "viewpoint",
        "point",
        "center",
        "radius",
        "dimension",
        "dimensions",
        "location",
        "ambient",
        "diffuse",
        "emissivity",
    ];
    if ["tiled_plane", "pplane"]
        .iter()
        .any(|kind| text.contains(kind))
    {
        return None;
    }
    let mut scales = false;
    let words = text.split_whitespace().map(|word| {
        let number: Option<f64> = word.parse().ok();
        match number {
            None => {
                scales = lengths.contains(&word);
                Some(word.to_owned())
            }
            Some(number) if !scales || number == 0.0 => Some(word.to_owned()),
            Some(number) => {
                let scaled = number * 2_f64.powi(power);
                let exact = scaled.is_normal() && number.is_normal();
                exact.then(|| format!("{scaled:?}"))
            }
        }
    });
    let words: Option<Vec<String>> = words.collect();
    Some(words?.join(" "))
}

/// Neither the order of the lights nor that of the materials counts.
#[test]
fn lights_and_materials_may_be_in_any_order() {
    unchanged("permuted", |text, _| {
        let is = |line: &&str, kinds: &[&str]| {
            kinds.iter().any(|kind| line.trim_start().starts_with(kind))
        };
        let lines: Vec<&str> = text
            .lines()
            .filter(|line| !line.trim().is_empty())
            .collect();
        let (materials, lights) = (["material "], ["light ", "spotlight "]);
        let part = |kinds: &[&str]| {
            lines
                .iter()
                .copied()
                .filter(|line| is(line, kinds))
                .rev()
                .collect::<Vec<_>>()
        };
        let others: Vec<&str> = lines
            .iter()
            .copied()
            .filter(|line| !is(line, &materials) && !is(line, &lights))
            .collect();
        Some(
            [part(&materials), part(&lights), others]
                .concat()
                .join("\n"),
        )
    });
}

/// Neither does that of the objects where no two are met at the same place: which is the first in the file decides
/// nothing else.
#[test]
fn objects_may_be_in_any_order() {
    let number = std::cell::Cell::new(0);
    alike("permuted", |text, _| {
        number.set(number.get() + 1);
        let text = moved_a_little(text, &mut Random::new(number.get()))?;
        let (groups, _) = groups(&scene(&text), true);
        let surfaces: HashSet<u32> = groups.iter().copied().collect();
        if groups.len() < 2 || surfaces.len() < groups.len() {
            return None;
        }
        let (mut objects, others): (Vec<&str>, Vec<&str>) =
            text.lines().partition(|line| is_object(line));
        if number.get().is_multiple_of(2) {
            objects.reverse();
        } else {
            objects.rotate_left(1);
        }
        let permuted = [others, objects].concat().join("\n");
        Some([text, permuted])
    });
}

fn is_object(line: &str) -> bool {
    let kinds = ["plane", "tiled_plane", "fplane", "pplane", "sphere"];
    line.split_whitespace()
        .next()
        .is_some_and(|word| kinds.contains(&word))
}

/// The scene with all its objects moved by less than 10⁻¹⁰ of where they are, each number by another share, so that
/// edges and outlines do not run through rays any more; None if a number cannot be moved by so little.
fn moved_a_little(text: &str, random: &mut Random) -> Option<String> {
    let lines = text.lines().map(|line| {
        if !is_object(line) {
            return Some(line.to_owned());
        }
        let mut moves = 0;
        let words = line.split_whitespace().map(|word| {
            if ["point", "center"].contains(&word) {
                moves = 3;
                return Some(word.to_owned());
            }
            if moves == 0 {
                return Some(word.to_owned());
            }
            moves -= 1;
            let number: f64 = word.parse().unwrap();
            let moved = number * (1.0 + 1e-10 * random.between(0.1, 1.0));
            (moved != number || number == 0.0).then(|| format!("{moved:?}"))
        });
        let words: Option<Vec<String>> = words.collect();
        Some(words?.join(" "))
    });
    let lines: Option<Vec<String>> = lines.collect();
    Some(lines?.join("\n"))
}

/// Left and right change places, if no number is lost by it.
#[test]
fn scenes_may_be_flipped() {
    let mut tried = 0;
    for kind in KINDS {
        for number in 1_000..1_000 + 3 * SCENES {
            let case = case(kind, number);
            let Some(text) = flipped(&case.text).filter(|_| case.samples == 1) else {
                continue;
            };
            tried += 1;
            let settings = settings(&case);
            let (one, other) = (
                picture(&scene(&case.text), &settings),
                picture(&scene(&text), &settings),
            );
            let width = scene(&text).camera.pixeldim[0] as usize;
            let turned = other.map(|rgb| {
                let rows = rgb.chunks_exact(3 * width);
                rows.flat_map(|row| row.chunks_exact(3).rev())
                    .flatten()
                    .copied()
                    .collect::<Vec<u8>>()
            });
            match (one, turned) {
                (Ok(one), Ok(turned)) => {
                    assert_eq!(one, turned, "{kind:?} {number}:\n{}\n{text}", case.text)
                }
                (one, turned) => assert!(one.is_err() && turned.is_err(), "{kind:?} {number}"),
            }
        }
    }
    assert!(tried > 20, "only {tried} scenes");
}

/// x becomes worlddim.x − x; None where that is not exact, or where left and right are not alike.
fn flipped(text: &str) -> Option<String> {
    if ["tiled_plane", "pplane", "fplane", "projector"]
        .iter()
        .any(|kind| text.contains(kind))
    {
        return None;
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    let at = words.iter().position(|word| *word == "worlddim")?;
    let width: f64 = words[at + 1].parse().ok()?;
    let turned = words.iter().enumerate().map(|(i, word)| {
        let before = if i > 0 { words[i - 1] } else { "" };
        if ["point", "center", "location", "viewpoint"].contains(&before) {
            let x: f64 = word.parse().ok()?;
            let other = width - x;
            let exact = width - other == x && (x - width) + other == 0.0;
            exact.then(|| format!("{other:?}"))
        } else if before == "normal" {
            let x: f64 = word.parse().ok()?;
            Some(format!("{:?}", -x))
        } else {
            Some((*word).to_owned())
        }
    });
    Some(turned.collect::<Option<Vec<_>>>()?.join(" "))
}

/// What no ray can meet, and light that is none, changes nothing.
#[test]
fn what_is_not_seen_may_be_added() {
    unchanged("hidden", |text, _| {
        let lit = text.contains("light ") || text.contains("spotlight ");
        if !text.contains("material a {") {
            return None;
        }
        let mut text = format!(
            "{text}
             sphere far {{ material a center 0 0 1e305 radius 1e290 }}
             plane front {{ material a normal 0 0 1 point 0 0 1e-320 }}"
        );
        // (Without light there is none to add: a light changes how a scene is lit.)
        if lit {
            text += " light none { location 1 2 3 emissivity 0 0 0 }";
        }
        Some(text)
    });
}

/// Rows, threads and what a band holds change no byte.
#[test]
fn rows_bands_and_threads_change_nothing() {
    for kind in KINDS {
        for number in 1_000..1_000 + SCENES {
            let case = case(kind, number);
            let (scene, whole) = (scene(&case.text), settings(&case));
            let want = picture(&scene, &whole);
            let bands = Settings {
                band_rows: Some(1),
                threads: Some(2),
                ..whole.clone()
            };
            assert_eq!(
                want,
                picture(&scene, &bands),
                "{kind:?} {number}:\n{}",
                case.text
            );
            let height = scene.camera.pixeldim[1];
            let Ok(want) = want else { continue };
            let rows = (0..height).rev().map(|y| {
                let rows = Some(y..y + 1);
                picture(
                    &scene,
                    &Settings {
                        rows,
                        ..whole.clone()
                    },
                )
                .unwrap()
            });
            assert_eq!(
                want,
                rows.collect::<Vec<_>>().concat(),
                "{kind:?} {number}:\n{}",
                case.text
            );
        }
    }
}

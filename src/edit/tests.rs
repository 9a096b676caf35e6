//! Tests of changes as a whole: over all our scenes, what is written means what is shown, and changes nothing else.

use std::path::Path;

use super::*;
use crate::scene::{EntityId, Scene, number_at, number_rows, parse_text, places};

/// The texts of our scenes that are right.
fn texts() -> Vec<(String, Vec<u8>)> {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut found = vec![scenes.join("showcase.txt")];
    for folder in ["notes", "gallery", "known", "hard", "lit"] {
        let entries = std::fs::read_dir(scenes.join(folder)).unwrap();
        found.extend(entries.map(|entry| entry.unwrap().path()));
    }
    found.retain(|path| path.extension().is_some_and(|extension| extension == "txt"));
    found.sort();
    assert!(found.len() > 100, "only {} scenes found", found.len());
    let read =
        |path: std::path::PathBuf| (path.display().to_string(), std::fs::read(path).unwrap());
    found.into_iter().map(read).collect()
}

/// The same scene with other ends of lines, with a byte order mark, and all on one line.
fn layouts(text: &[u8]) -> Vec<Vec<u8>> {
    let text = String::from_utf8(text.to_vec()).unwrap();
    let words = text
        .lines()
        .flat_map(|line| line.split('#').next().unwrap().split_whitespace());
    let packed = words.collect::<Vec<_>>().join(" ");
    let all = [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{FEFF}{text}"),
        packed.replace(" {", "{").replace(" }", "}"),
        packed.replace(" } ", " }\n"),
        text,
    ];
    all.map(String::into_bytes).into()
}

/// Repeatable random numbers: SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ bits >> 31
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// A number that something may be changed to: ordinary, extreme, or as it is.
    fn number(&mut self, now: f64) -> f64 {
        match self.below(8) {
            0 => f64::from_bits(self.bits()),
            1 => [5e-324, f64::MAX, 1e16, 1e-5, -0.0, 1e300][self.below(6)],
            2 => self.below(10) as f64,
            3 => f64::from_bits(now.to_bits() + 1),
            4 | 5 => now,
            _ => self.below(1000) as f64 / 100.0,
        }
    }

    /// The same for all numbers of an attribute, which may be left out if it can be.
    fn value(&mut self, scene: &Scene, target: Target) -> Value {
        let mut now = target.value_in(scene).unwrap();
        let mut rows = number_rows(scene, target.entity());
        let row = rows.find(|row| row.name() == target.attribute()).unwrap();
        if row.may_be_left_out() && self.below(3) == 0 {
            return Value::LEFT_OUT;
        }
        if now == Value::LEFT_OUT {
            now = [1.0, 2.0, 3.0].into();
        }
        let one = self.number(now.numbers()[0]);
        let all_alike = self.below(4) == 0;
        let numbers = now.numbers().iter();
        let numbers = numbers.map(|now| if all_alike { one } else { self.number(*now) });
        Value::new(&numbers.collect::<Vec<_>>()).unwrap()
    }
}

/// Everything that can be changed.
fn targets(scene: &Scene) -> Vec<Target> {
    let all = [EntityId::Camera].into_iter();
    let all = all.chain((0..scene.materials.len()).map(EntityId::Material));
    let all = all.chain((0..scene.objects.len()).map(EntityId::Object));
    let all = all.chain((0..scene.lights.len()).map(EntityId::Light));
    all.flat_map(|entity| Target::all_of(scene, entity))
        .filter(|target| target.value_in(scene).is_some())
        .collect()
}

/// Is this text read as this scene, to the last bit?
fn means(text: &[u8], scene: &Scene) -> bool {
    let bits = |scene: &Scene| -> Vec<u64> {
        let values = targets(scene)
            .into_iter()
            .filter_map(|target| target.value_in(scene));
        values
            .flat_map(|value| value.numbers().to_vec())
            .map(f64::to_bits)
            .collect()
    };
    let read = parse_text("written", text).unwrap();
    read == *scene && bits(&read) == bits(scene)
}

/// A text without its words: what must never change. And how many words there are.
fn frame(text: &[u8]) -> (Vec<Vec<u8>>, usize) {
    let mut gaps = vec![Vec::new()];
    let (mut comment, mut word) = (false, false);
    for byte in text {
        let is_end = matches!(byte, b'\n' | b'\r');
        comment = (comment && !is_end) || *byte == b'#';
        let in_word = !comment && !byte.is_ascii_whitespace() && !matches!(byte, b'{' | b'}');
        if in_word && !word {
            gaps.push(Vec::new());
        }
        word = in_word;
        if let (false, Some(gap)) = (in_word, gaps.last_mut()) {
            gap.push(*byte);
        }
    }
    let words = gaps.len() - 1;
    (gaps, words)
}

/// The comments of a text.
fn comments(text: &[u8]) -> Vec<Vec<u8>> {
    let lines = text.split(|byte| matches!(byte, b'\n' | b'\r'));
    let comment = |line: &[u8]| {
        line.iter()
            .position(|byte| *byte == b'#')
            .map(|at| line[at..].to_vec())
    };
    lines.filter_map(comment).collect()
}

#[test]
fn what_is_written_means_what_is_shown() {
    let mut random = Random(6);
    let (mut exchanged, mut longer, mut shorter, mut refused) = (0, 0, 0, 0);
    for (name, text) in texts() {
        for (layout, text) in layouts(&text).into_iter().enumerate() {
            let scene = parse_text(&name, &text).unwrap();
            let targets = targets(&scene);
            for _ in 0..4 {
                let mut changes = Changes::new();
                for _ in 0..1 + random.below(5) {
                    let target = targets[random.below(targets.len())];
                    let value = random.value(&scene, target);
                    refused += usize::from(changes.set(&scene, target, value).is_err());
                }
                let written = changes.write(&text).unwrap();
                let shown = changes.apply(&scene);
                let told = || String::from_utf8_lossy(&written).into_owned();
                assert!(
                    means(&written, &shown),
                    "{name}, layout {layout}: {changes:?}\n{}",
                    told()
                );
                assert_eq!(means(&text, &shown), written == text, "{name}: {changes:?}");
                assert_eq!(
                    comments(&written),
                    comments(&text),
                    "{name}: {changes:?}\n{}",
                    told()
                );
                let (before, after) = (frame(&text), frame(&written));
                let removes = changes.iter().any(|(_, value)| value == Value::LEFT_OUT);
                assert!(after.1 >= before.1 || removes);
                if removes {
                    shorter += usize::from(after.1 < before.1);
                } else if before.1 == after.1 {
                    exchanged += usize::from(written != text);
                    assert_eq!(before, after, "{name}: {changes:?}\n{}", told());
                } else {
                    longer += 1;
                }
                // Written again, nothing changes; and the way back leads to the same scene.
                assert_eq!(changes.write(&written).unwrap(), written);
                let mut back = Changes::new();
                for (target, _) in changes.iter() {
                    back.values.insert(target, target.value_in(&scene).unwrap());
                }
                assert!(
                    means(&back.write(&written).unwrap(), &scene),
                    "{name}: {changes:?}"
                );
            }
        }
    }
    println!(
        "{exchanged} times numbers alone, {longer} times more, {shorter} times less, {refused} values refused"
    );
    assert!(exchanged > 1_000 && longer > 1_000 && shorter > 10 && refused > 1_000);
}

#[test]
fn a_wrong_write_is_noticed() {
    let (mut noticed, mut refused) = (0, 0);
    for (name, text) in texts() {
        let scene = parse_text(&name, &text).unwrap();
        // Each is a text written and read: of a thousand panes some will do.
        let all = targets(&scene);
        let each = 1 + all.len() / 100;
        for target in all.into_iter().step_by(each) {
            // One number is off by its last bit; 0 becomes the least number. Whole numbers have neither.
            let mut numbers = target.value_in(&scene).unwrap().numbers().to_vec();
            if numbers.is_empty() {
                continue;
            }
            numbers[0] = f64::from_bits(numbers[0].to_bits() + 1);
            let raised = Value::new(&numbers).unwrap();
            let mut changes = Changes::new();
            if changes.set(&scene, target, raised).is_err() {
                refused += 1;
                continue;
            }
            let written = changes.write(&text).unwrap();
            assert!(!means(&written, &scene), "{name}: {changes:?}");
            assert!(!means(&text, &changes.apply(&scene)), "{name}: {changes:?}");
            noticed += 1;
        }
    }
    println!("{noticed} noticed, {refused} refused");
    assert!(
        noticed > 1_500 && refused < noticed / 2,
        "{noticed}, {refused}"
    );
    // What must not change is noticed, too.
    let text = b"material a { # b\n ambient 1 2 3 }";
    for wrong in [
        "material a { # b\n ambient  1 2 3 }",
        "material a { # c\n ambient 1 2 3 }",
        "material a {\n ambient 1 2 3 }",
    ] {
        assert_ne!(frame(text), frame(wrong.as_bytes()));
    }
    assert_eq!(
        frame(text),
        frame(b"material a { # b\n ambient 9 0.5 1e3 }")
    );
    assert_ne!(
        comments(text),
        comments(b"material a { # b \n ambient 1 2 3 }")
    );
}

/// How many entities and values stand elsewhere than in the scene.
fn strays(text: &[u8], scene: &Scene) -> usize {
    let places = places(text);
    let materials = (0..scene.materials.len()).map(EntityId::Material);
    let textures = (0..scene.textures.len()).map(EntityId::Texture);
    let objects = (0..scene.objects.len()).map(EntityId::Object);
    let lights = (0..scene.lights.len()).map(EntityId::Light);
    let all = [EntityId::Camera]
        .into_iter()
        .chain(materials)
        .chain(textures)
        .chain(objects)
        .chain(lights);
    let is_stray = |id: &EntityId| {
        let Some(place) = places.of(text, *id) else {
            return true;
        };
        let (kind, name) = target::kind_and_name(scene, *id).unwrap();
        // The only type that has another spelling.
        let spelt = match &text[place.kind] {
            b"tri" => b"triangle",
            spelt => spelt,
        };
        spelt != kind.as_bytes() || text[place.name] != *name.as_bytes()
    };
    let is_stray_value = |target: &Target| {
        let Some(place) = places.of(text, target.entity()) else {
            return true;
        };
        let value = target.value_in(scene).unwrap();
        let numbers = value.numbers();
        let Some(given) = place.given(target.attribute()) else {
            return numbers.iter().any(|number| *number != 0.0);
        };
        let mut read: Vec<f64> = given
            .values
            .iter()
            .map(|value| number_at(text, value).unwrap())
            .collect();
        if read.len() < numbers.len() {
            read = vec![read[0]; 3];
        }
        read != numbers
    };
    all.filter(is_stray).count()
        + targets(scene)
            .iter()
            .filter(|target| is_stray_value(target))
            .count()
}

#[test]
fn places_agree_with_the_parser_in_all_scenes() {
    for (name, text) in texts() {
        for text in layouts(&text) {
            let scene = parse_text(&name, &text).unwrap();
            assert_eq!(strays(&text, &scene), 0, "{name}");
            let mut other = scene.clone();
            other.camera.viewpoint.z *= 2.0;
            other.camera.name += "x";
            assert_eq!(strays(&text, &other), 2, "{name}");
            let one_more = [&b"material another { ambient 1 1 1 } "[..], &text].concat();
            if !scene.materials.is_empty() && !text.starts_with("\u{FEFF}".as_bytes()) {
                assert!(strays(&one_more, &scene) > 0, "{name}");
            }
        }
    }
}

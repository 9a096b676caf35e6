use std::path::Path;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::gpu::GpuError;
use crate::probe::{self, Probe};
use crate::scene::{load, load_from};
use crate::settings::Settings;

struct Shown {
    panel: Panel,
    over: Option<[u32; 2]>,
    let_go: bool,
    verdict: Option<&'static str>,
}

fn shown(panel: Panel, over: Option<[u32; 2]>, size: [f32; 2]) -> Harness<'static, Shown> {
    let mut harness = Harness::builder().with_size(size).build_ui_state(
        |ui, shown: &mut Shown| {
            let wanted = shown.panel.held.or(shown.over);
            shown.let_go |= show(ui, &shown.panel, wanted, shown.verdict);
        },
        Shown {
            panel,
            over,
            let_go: false,
            verdict: None,
        },
    );
    harness.run();
    harness
}

/// What `plumb probe` tells.
fn explained(scene: &crate::scene::Scene, pixel: [u32; 2]) -> String {
    explained_with(scene, pixel, &Settings::default())
}

fn explained_with(scene: &crate::scene::Scene, pixel: [u32; 2], settings: &Settings) -> String {
    let none = GpuError::NoAdapter;
    let probe = Probe::new(scene, settings, Err(&none));
    let mut text = Vec::new();
    let ended = probe.write("room.txt", pixel, probe::Options::default(), &mut text);
    ended.unwrap().unwrap();
    String::from_utf8(text).unwrap()
}

fn scene(name: &str) -> crate::scene::Scene {
    load(
        &Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(name),
    )
    .unwrap()
}

fn names(sections: &Sections<'_>) -> Vec<String> {
    let names = sections.first.iter().map(|(name, _)| (*name).to_owned());
    names.collect()
}

const FIRST: [&str; 4] = ["hit", "colour", "bytes", "decided by"];

#[test]
fn explanations_are_sorted_to_the_last_line() {
    let text = explained(&scene("lit/mirror_and_glass.txt"), [200, 150]);
    let sections = Sections::of(&text);
    assert_eq!(names(&sections), FIRST);
    let starts = |lines: &[&str], words: &[&str]| {
        let of = |line: &&str| line.trim_start_matches([' ', '*']).to_owned();
        let lines: Vec<String> = lines.iter().map(of).collect();
        lines.len() == words.len()
            && lines
                .iter()
                .zip(words)
                .all(|(line, word)| line.starts_with(word))
    };
    assert!(
        starts(&sections.hits, &["floor", "back", "pane"]),
        "{sections:?}"
    );
    assert!(sections.hits[2].starts_with("  *"));
    assert!(
        starts(&sections.misses, &["bubble", "a ", "b ", "c "]),
        "{sections:?}"
    );
    assert_eq!(sections.missed, 4);
    assert!(
        sections
            .rays
            .iter()
            .any(|line| line.contains("mirror in 0"))
    );
    assert!(sections.trouble.is_empty(), "{sections:?}");
    let all = sections.first.len()
        + sections.hits.len()
        + sections.misses.len()
        + sections.rays.len()
        + sections.rest.len();
    // The line that the objects are counted in is the panel's own.
    assert_eq!(all + 1, text.lines().count());
}

/// All lines of all scenes of ours have their place.
#[test]
fn no_line_is_unknown() {
    for folder in ["known", "lit", "gallery"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(folder);
        for file in path.read_dir().unwrap() {
            let mut scene = load(&file.unwrap().path()).unwrap();
            scene.camera.pixeldim = [7, 5];
            for (pixel, samples) in [([3, 2], 1), ([0, 4], 2)] {
                let settings = Settings {
                    samples,
                    ..Settings::default()
                };
                let text = explained_with(&scene, pixel, &settings);
                let sections = Sections::of(&text);
                assert_eq!(sections.trouble, [""; 0], "{text}");
                assert!(names(&sections).contains(&"bytes".to_owned()), "{text}");
            }
        }
    }
}

#[test]
fn misleading_names_do_not_mislead() {
    let text = "camera c { pixeldim 41 31 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
        sphere * { material m center 4 3 -5 radius 3 } sphere hit { material m center 40 3 -5 radius 3 }
        sphere miss { material m center 4 3 -15 radius 3 } sphere sphere { material m center 4 30 -5 radius 3 }";
    let scene = load_from("test", text.as_bytes(), Path::new("")).unwrap();
    let text = explained(&scene, [20, 15]);
    let sections = Sections::of(&text);
    assert_eq!(
        (sections.hits.len(), sections.misses.len()),
        (2, 2),
        "{text}"
    );
    assert!(sections.hits[1].contains("miss"), "{text}");
}

// This text has every character that `plumb probe` prints; few fonts have all of them.
const TEXT: &str = "weight ∘ (ambient + diffuse) · 1 ± 2 × 3 … 640×480 ≤ ≥ √ — − ÷ ²";

#[test]
fn a_pixel_is_explained_once_that_is_known() {
    let explained = Some((
        1,
        [3, 4],
        format!("bytes        {TEXT}\ndecided by   f64\n"),
    ));
    let panel = Panel {
        held: None,
        explained,
    };
    let mut harness = shown(panel, Some([3, 4]), [800.0, 600.0]);
    harness.get_by_label("pixel (3, 4)");
    harness.get_by_label(TEXT);
    harness.get_by_label("f64");
    // What the picture knows better.
    harness.state_mut().verdict = Some("the GPU, which is sure");
    harness.run();
    harness.get_by_label("the GPU, which is sure");
    assert!(harness.query_by_label("f64").is_none());
    // The explanation at hand belongs to another pixel.
    harness.state_mut().over = Some([5, 4]);
    harness.run();
    harness.get_by_label("pixel (5, 4)");
    assert!(harness.query_by_label(TEXT).is_none());
}

#[test]
fn what_one_wants_is_seen_first_and_the_rest_is_folded() {
    let text = explained(&scene("lit/mirror_and_glass.txt"), [200, 150]);
    let panel = Panel {
        held: None,
        explained: Some((1, [200, 150], text)),
    };
    // As wide as the panel is in a small window, and higher, so that all can be clicked.
    let mut harness = shown(panel, Some([200, 150]), [400.0, 500.0]);
    let [hit, colour] =
        ["pane at (1.54", "(0.293"].map(|it| harness.get_by_label_contains(it).rect());
    assert!(
        hit.height() > 20.0 && colour.top() >= hit.bottom(),
        "{hit} {colour}"
    );
    let bytes = harness.get_by_label("74 100 93").rect();
    assert!(bytes.bottom() < 190.0, "{bytes}");
    harness.get_by_label_contains("pane at (1.54");
    assert!(
        harness
            .query_by_label_contains("the ray passes by")
            .is_none()
    );
    harness.get_by_label("Misses (4)").click();
    harness.run();
    let missed: Vec<_> = harness
        .query_all_by_label_contains("the ray passes by")
        .collect();
    assert_eq!(missed.len(), 4);
}

#[test]
fn long_lines_wrap() {
    let long = "word ".repeat(100);
    let panel = Panel {
        held: None,
        explained: Some((1, [0, 0], format!("hit          {long}\n"))),
    };
    let harness = shown(panel, Some([0, 0]), [300.0, 600.0]);
    let rect = harness.get_by_label_contains("word word").rect();
    assert!(rect.right() <= 300.0 && rect.height() > 50.0, "{rect}");
}

#[test]
fn a_pixel_that_is_held_can_be_let_go() {
    let panel = Panel {
        held: Some([3, 4]),
        explained: None,
    };
    let mut harness = shown(panel, Some([7, 7]), [800.0, 600.0]);
    harness.get_by_label("pixel (3, 4)");
    harness.get_by_label("let go (Esc)").click();
    harness.run();
    assert!(harness.state().let_go);
}

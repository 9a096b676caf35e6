//! The commands that look: compare, probe, dump.

use std::fs;

use super::desk::{Desk, ROOM, ppm};

#[test]
fn compare_finds_a_difference_of_one_and_equality() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "a.ppm"])
        .ends(0);
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "b.png"])
        .ends(0);
    let same = desk.run(&["compare", "a.ppm", "b.png"]).ends(0);
    assert!(
        same.text().contains("are the same: 40×30"),
        "{}",
        same.text()
    );
    let mut bytes = desk.read("a.ppm");
    // Green of pixel (3, 28): the second row from the top.
    let at = bytes.len() - 3 * 40 * 30 + 3 * (40 + 3) + 1;
    bytes[at] ^= 1;
    fs::write(desk.path("c.ppm"), &bytes).unwrap();
    let differ = desk
        .run(&["compare", "a.ppm", "c.ppm", "--diff", "d.png"])
        .ends(1)
        .text();
    assert!(
        differ.contains("1 of 1200 (0.0833 %)") && differ.contains("green at (3, 28)"),
        "{differ}"
    );
    assert!(differ.contains("1 apart"), "{differ}");
    assert_eq!(
        plumb::image::read(&desk.path("d.png")).unwrap().rgb[3 * 43..3 * 44],
        [0, 128, 0]
    );
    let json = desk.run(&["compare", "a.ppm", "c.ppm", "--json"]).ends(1);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(
        (&json["same"], &json["comparison"]["different"]),
        (&false.into(), &1.into())
    );
    assert_eq!(json["comparison"]["worst"]["y"], 28);
}

#[test]
fn compare_answers_no_for_sizes_and_fails_for_what_is_no_picture() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu", "-o", "a.ppm"])
        .ends(0);
    desk.run(&[
        "render",
        "room.txt",
        "--backend",
        "cpu",
        "-o",
        "b.ppm",
        "--rows",
        "0..29",
    ])
    .ends(0);
    let sizes = desk
        .run(&["compare", "a.ppm", "b.ppm", "--diff", "d.ppm"])
        .ends(1);
    assert!(sizes.text().contains("40×30 and 40×29"), "{}", sizes.text());
    desk.run(&["compare", "a.ppm", "room.txt"])
        .fails_with(&["plumb: error: cannot read room.txt"]);
    desk.run(&["compare", "a.ppm", "none.ppm"])
        .fails_with(&["none.ppm"]);
    desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "d.exr"])
        .fails_with(&[".png"]);
    // What is refused is not proposed.
    let gif = desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "d.gif"]);
    assert!(!gif.stderr.contains(".exr"), "{}", gif.stderr);
    gif.fails_with(&["d.gif", ".png or .ppm"]);
    desk.run(&["compare", "a.ppm", "b.ppm", "--diff", "b.ppm"])
        .fails_with(&["one of the pictures"]);
    assert_eq!(desk.names(), ["a.ppm", "b.ppm", "room.txt"]);
}

#[test]
fn probe_agrees_with_the_picture() {
    let desk = Desk::new();
    desk.run(&["render", "room.txt", "--backend", "cpu"])
        .ends(0);
    let picture = desk.read("room.ppm");
    let bytes = ppm(&picture).2;
    for (x, y) in [
        (0, 0),
        (39, 29),
        (0, 29),
        (25, 15),
        (12, 7),
        (20, 1),
        (33, 4),
    ] {
        let text = desk
            .run(&["probe", "room.txt", &x.to_string(), &y.to_string()])
            .ends(0)
            .text();
        let at = 3 * ((29 - y) * 40 + x);
        let expected = format!(
            "bytes        {} {} {}",
            bytes[at],
            bytes[at + 1],
            bytes[at + 2]
        );
        assert!(
            text.lines().any(|line| line == expected),
            "({x}, {y}): no {expected:?} in {text}"
        );
        let marked = text.lines().filter(|line| line.starts_with("  * ")).count();
        assert_eq!(
            marked,
            usize::from(!text.contains("hit          nothing")),
            "{text}"
        );
        for object in ["wall", "floor", "ball"] {
            assert!(text.contains(object), "{text}");
        }
    }
    desk.run(&["probe", "room.txt", "40", "0"])
        .fails_with(&["columns are 0 to 39"]);
    desk.run(&["probe", "room.txt", "0", "-1"])
        .fails_with(&["rows 0 to 29"]);
    desk.run(&["probe", "room.txt", "0", "1.5"])
        .fails_with(&["whole numbers from 0"]);
}

#[test]
fn probe_lists_only_hits_of_many_objects() {
    let desk = Desk::new();
    let spheres: String = (0..60)
        .map(|i| format!("sphere s{i} {{ material red center {i} 40 -4 radius 0.1 }}\n"))
        .collect();
    desk.write("many.txt", &(ROOM.to_owned() + &spheres));
    let text = desk.run(&["probe", "many.txt", "5", "5"]).ends(0).text();
    assert!(
        text.contains("objects      63, ") && !text.contains(" miss ") && text.contains("--all"),
        "{text}"
    );
    let all = desk
        .run(&["probe", "many.txt", "5", "5", "--all"])
        .ends(0)
        .text();
    assert_eq!(
        all.matches("the ray passes by").count(),
        61 - all.matches("ball  sphere  hit").count(),
        "{all}"
    );
}

#[test]
fn dump_shows_every_stage() {
    let desk = Desk::new();
    for (stage, word) in [
        ("model", "tiled_plane"),
        ("features", "plane"),
        ("buffers", "records"),
        ("wgsl", "@compute"),
    ] {
        let ran = desk.run(&["dump", "room.txt", "--stage", stage]).ends(0);
        assert!(ran.text().contains(word), "{stage}: {}", ran.text());
        assert_eq!(ran.stderr, "");
    }
}

/// Where they are so many that they stand in cells of the screen, too.
#[test]
fn probe_lists_every_triangle_that_is_hit() {
    let gem = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lit/gem.txt");
    let desk = Desk::new();
    let asked = ["probe", gem, "320", "280"];
    let text = desk.run(&asked).ends(0).text();
    let listed = |name: &str| {
        let mut lines = text.lines().map(|line| line.trim_start_matches([' ', '*']));
        lines.any(|line| line.starts_with(name) && line.contains("hit   t = "))
    };
    let hit = text
        .lines()
        .find_map(|line| line.strip_prefix("hit          "));
    let (first, _) = hit.unwrap().split_once(" at ").unwrap();
    assert!(first.starts_with("facet") && listed(first), "{text}");
}

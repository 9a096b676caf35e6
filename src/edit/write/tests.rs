//! Tests of writing changes: what a text looks like afterwards, to the byte. That it means what it should is tested for
//! all scenes in [`edit`](crate::edit)'s own tests.

use super::super::target::Value;
use super::*;

const CAMERA: &str = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6.0 } ";

fn changes<V: Into<Value>>(text: &str, list: impl IntoIterator<Item = (Target, V)>) -> Changes {
    let scene = parse_text("test", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let mut changes = Changes::new();
    for (target, value) in list {
        changes.set(&scene, target, value).unwrap();
    }
    changes
}

fn written(text: &str, changes: &Changes) -> String {
    let text = changes
        .write(text.as_bytes())
        .unwrap_or_else(|error| panic!("{error}"));
    String::from_utf8(text).unwrap()
}

/// A text with a camera behind it, after reflectivities of its first material were changed.
fn with(text: &str, list: &[(&'static str, [f64; 3])]) -> String {
    let list = list
        .iter()
        .map(|(which, value)| (Target::new(EntityId::Material(0), which), *value));
    let text = text.to_owned() + "\n" + CAMERA;
    let written = written(&text, &changes(&text, list));
    written
        .strip_suffix(&("\n".to_owned() + CAMERA))
        .unwrap()
        .to_owned()
}

#[test]
fn only_the_numbers_that_change_are_exchanged() {
    let known = [
        ("ambient 1 2 3", "ambient 1 0.5 3"),
        ("ambient 1.0 2.0 0x1.8p1", "ambient 1.0 0.5 0x1.8p1"),
        ("ambient +1 2e0 3.", "ambient +1 0.5 3."),
        ("ambient 1 .5 3", "ambient 1 .5 3"),
        (
            "ambient\t01#red 1\r\n2#green\n\n3",
            "ambient\t01#red 1\r\n0.5#green\n\n3",
        ),
        (
            "shininess 2 ambient 2 2 2#}",
            "shininess 2 ambient 1 0.5 3#}",
        ),
    ];
    for (before, after) in known {
        let block = |inside: &str| format!("# a {{ 2 }}\nmaterial a{{{inside}\n}} # {{");
        assert_eq!(
            with(&block(before), &[("ambient", [1.0, 0.5, 3.0])]),
            block(after)
        );
    }
}

#[test]
fn a_value_that_is_in_the_file_changes_nothing() {
    let text = format!("material a {{ specular 0.50 }}\n{CAMERA}");
    let same = changes(
        &text,
        [
            (Target::new(EntityId::Material(0), "specular"), [0.5; 3]),
            (Target::new(EntityId::Material(0), "ambient"), [0.0; 3]),
            (Target::VIEWPOINT, [4.0, 3.0, 6.0]),
        ],
    );
    assert_eq!(written(&text, &same), text);
    let other = changes(&text, [(Target::VIEWPOINT, [4.0, 3.0, 6.5])]);
    assert_eq!(written(&text, &other), text.replace("6.0", "6.5"));
}

#[test]
fn one_number_for_three_becomes_three_where_they_differ() {
    let text = |values: &str| format!("material a {{ specular {values}#x\n }}");
    let after = |values: [f64; 3]| with(&text("0.50"), &[("specular", values)]);
    assert_eq!(after([0.5; 3]), text("0.50"));
    assert_eq!(after([0.25; 3]), text("0.25"));
    assert_eq!(after([0.25, 0.5, 1.0]), text("0.25 0.50 1"));
    // Three stay three.
    assert_eq!(
        with(&text("1.0 2 3"), &[("specular", [1.0; 3])]),
        text("1.0 1 1")
    );
}

#[test]
fn attributes_are_added_in_the_layout_of_the_block() {
    let known = [
        (
            "material a\n{\n  ambient 1 1 1\n}",
            "material a\n{\n  ambient 1 1 1\n  diffuse 1 2 3\n}",
        ),
        // Behind the comment of its neighbour, before the attributes that follow.
        (
            "material a {\r\n\tambient\t1 1 1 # red\r\n\tshininess\t5\r\n\t# end\r\n}",
            "material a {\r\n\tambient\t1 1 1 # red\r\n\tdiffuse\t1 2 3\r\n\tshininess\t5\r\n\t# end\r\n}",
        ),
        (
            "material a {\r ambient 1 1 1 # b\r}",
            "material a {\r ambient 1 1 1 # b\r diffuse 1 2 3\r}",
        ),
        // In columns.
        (
            "material a\n{\n  specular     0.5\n  transparency 0.5\n}",
            "material a\n{\n  specular     0.5\n  transparency 0.5\n  diffuse      1 2 3\n}",
        ),
        (
            "material a\n{\n  specular 0.5\n  transparency 0.5\n}",
            "material a\n{\n  specular 0.5\n  transparency 0.5\n  diffuse 1 2 3\n}",
        ),
        // A `}` behind it.
        (
            "material a {\n  shininess 5 }",
            "material a {\n  shininess 5\n  diffuse 1 2 3 }",
        ),
        (
            "material a {\r\n  shininess 5}",
            "material a {\r\n  shininess 5\r\n  diffuse 1 2 3}",
        ),
        // All on one line.
        (
            "material a { ambient 1 1 1 }",
            "material a { ambient 1 1 1 diffuse 1 2 3 }",
        ),
        (
            "material a{ambient 1 1 1}",
            "material a{ambient 1 1 1 diffuse 1 2 3}",
        ),
        (
            "material a{ambient 1 1 1#}\n}",
            "material a{ambient 1 1 1 diffuse 1 2 3#}\n}",
        ),
        (
            "material a { ambient 1 1 1   shininess 5 }",
            "material a { ambient 1 1 1   diffuse 1 2 3   shininess 5 }",
        ),
        (
            "material a {\n  ambient 1 1 1  shininess 5\n}",
            "material a {\n  ambient 1 1 1  diffuse 1 2 3  shininess 5\n}",
        ),
        // Values over several lines.
        (
            "material a {\n  ambient\n    1\n    1 # b\n    1 # c\n}",
            "material a {\n  ambient\n    1\n    1 # b\n    1 # c\n  diffuse 1 2 3\n}",
        ),
        (
            "material a { # b\n ambient#\n1 1 1\n}",
            "material a { # b\n ambient#\n1 1 1\n diffuse 1 2 3\n}",
        ),
    ];
    for (before, after) in known {
        assert_eq!(with(before, &[("diffuse", [1.0, 2.0, 3.0])]), after);
    }
}

#[test]
fn numbers_are_added_to_a_material_in_the_order_of_the_table() {
    let text = format!("material a {{ ambient 1 1 1 transparency 0.50 }} {CAMERA}");
    let list = [("shininess", 5.0), ("transparency", 1.0)];
    let list = list.map(|(name, value)| (Target::new(EntityId::Material(0), name), value));
    let after = text.replace("transparency 0.50", "transparency 1");
    let after = after.replace("1 1 1 ", "1 1 1 shininess 5 ");
    assert_eq!(written(&text, &changes(&text, list)), after);
}

#[test]
fn several_are_added_in_order() {
    let all = [
        ("specular", [3.0; 3]),
        ("ambient", [1.0; 3]),
        ("diffuse", [2.0; 3]),
    ];
    let text = "material a\n{\n  shininess 5\n}";
    let after =
        "material a\n{\n  shininess 5\n  ambient 1 1 1\n  diffuse 2 2 2\n  specular 3 3 3\n}";
    assert_eq!(with(text, &all), after);
    let text = "material a { ambient 5 5 5 shininess 6 }";
    let after = "material a { ambient 1 1 1 diffuse 2 2 2 specular 3 3 3 shininess 6 }";
    assert_eq!(with(text, &all), after);
}

#[test]
fn of_equal_names_the_one_that_is_meant_is_changed() {
    let text = |second: &str| {
        format!(
            "material a {{ ambient 1 1 1 }} material a {{ ambient {second} }} material a {{ ambient 1 1 1 }} {CAMERA}"
        )
    };
    let change = changes(
        &text("1 1 1"),
        [(
            Target::new(EntityId::Material(1), "ambient"),
            [1.0, 2.0, 1.0],
        )],
    );
    assert_eq!(written(&text("1 1 1"), &change), text("1 2 1"));
}

#[test]
fn spheres_and_lights_of_every_kind_are_written() {
    let text = |ball: &str, marble: &str, lamp: &str, beam: &str| {
        format!(
            "{CAMERA} material m {{ ambient 1 1 1 }} plane p {{ material m normal 0 0 1 point 0 0 0 }} \
             sphere s {{ {ball} material m }} psphere q {{ material m shader 0 {marble} }} \
             light l {{ location 0 0 0 {lamp} }} spotlight b {{ {beam} location 0 0 0 point 1 1 1 theta 5 }}"
        )
    };
    let old = text(
        "radius 1 center 0 0 0",
        "center 1 1 1 radius 2",
        "emissivity 1 1 1",
        "emissivity 2 2 2",
    );
    let mut change = changes(
        &old,
        [
            (Target::new(EntityId::Object(1), "radius"), 3.0),
            (Target::new(EntityId::Object(2), "radius"), 4.0),
        ],
    );
    for (target, value) in [
        (Target::new(EntityId::Object(1), "center"), [0.0, -1.0, 0.0]),
        (
            Target::new(EntityId::Light(0), "emissivity"),
            [1.0, 0.0, 1.0],
        ),
        (
            Target::new(EntityId::Light(1), "emissivity"),
            [2.0, 2.0, 0.5],
        ),
    ] {
        change
            .set(&parse_text("old", old.as_bytes()).unwrap(), target, value)
            .unwrap();
    }
    let new = text(
        "radius 3 center 0 -1 0",
        "center 1 1 1 radius 4",
        "emissivity 1 0 1",
        "emissivity 2 2 0.5",
    );
    assert_eq!(written(&old, &change), new);
}

#[test]
fn what_cannot_be_written_is_told() {
    let good = format!(
        "{CAMERA} material m {{ ambient 1 1 1 }} plane p {{ material m normal 0 0 1 point 0 0 0 }}"
    );
    let all = format!(
        "{CAMERA} material m {{ ambient 1 1 1 }} material n {{ ambient 1 1 1 }}
         sphere s {{ material m center 0 0 0 radius 2 }} light l {{ location 0 0 0 emissivity 0 0 0 }}"
    );
    let fails = |target, value: Value, text: &str| {
        let error = changes(&all, [(target, value)])
            .write(text.as_bytes())
            .unwrap_err()
            .to_string();
        // The first line, and what the first complaint is.
        error.lines().take(2).collect::<Vec<_>>().join(" / ")
    };
    let viewpoint = |text: &str| fails(Target::VIEWPOINT, [1.0, 1.0, 1.0].into(), text);
    let twice = good.replace("normal", "point 1 1 1 normal");
    let mistake = "a scene with mistakes cannot be changed / error: ";
    assert_eq!(
        viewpoint(""),
        mistake.to_owned() + "this scene is empty: it has no camera"
    );
    assert_eq!(
        viewpoint(&twice),
        mistake.to_owned() + "`point` is given twice"
    );
    assert_eq!(
        viewpoint(&good[..good.len() - 1]),
        mistake.to_owned() + "the file ends inside the block of this `plane`"
    );
    assert!(viewpoint("\0\0").starts_with(mistake));
    assert_eq!(
        fails(
            Target::new(EntityId::Object(0), "radius"),
            1.0.into(),
            &good
        ),
        "radius cannot be written: this text has no object number 1 with it"
    );
    assert_eq!(
        fails(
            Target::new(EntityId::Material(1), "ambient"),
            [1.0; 3].into(),
            &good
        ),
        "ambient cannot be written: this text has no material number 2 with it"
    );
    assert_eq!(
        fails(
            Target::new(EntityId::Light(0), "emissivity"),
            [1.0; 3].into(),
            &good
        ),
        "emissivity cannot be written: this text has no light number 1 with it"
    );
    // A picture that is not there is no mistake of the text.
    let texture = good.clone() + " texture t { filename no/such/file.ppm }";
    assert!(
        changes(&good, [(Target::VIEWPOINT, [1.0; 3])])
            .write(texture.as_bytes())
            .is_ok()
    );
}

#[test]
fn a_text_that_would_be_too_large_is_refused() {
    let edits = || {
        [
            Edit {
                place: 1..2,
                bytes: b"xyz".to_vec(),
            },
            Edit {
                place: 2..2,
                bytes: b"-".to_vec(),
            },
        ]
    };
    assert_eq!(exchange(b"abc", &edits(), 6).unwrap(), b"axyz-c");
    assert_eq!(exchange(b"abc", &edits(), 5), None);
}

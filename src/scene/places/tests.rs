//! Tests of the places in a text. That they agree with the parser in all our scenes is tested in `edit`.

use super::super::parse_text;
use super::*;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Everything that is allowed and unusual.
const ODD: &str = "\u{FEFF}# camera no { }\r\n\
    material normal{ambient 1#red\r2 # green } {\n\n3}material m{specular .5 diffuse\t0x1p1 +2. 3e0 }\r\n\
    texture normal { filename ambient } texture t { filename a.ppm }\n\
    texplane plane { texname normal material normal normal 0 0 1 mode 0 point 0 0 -1 xdir 1 0 0 dimensions 4 3 }\n\
    tiled_plane \u{E4}\u{1F600} { dimensions 1 2 altmaterial m normal 0 1 0 material m point 0 0 0 } camera c {\n\
    viewpoint 4 3 6 worlddim 8 6 pixeldim 4 3 }\n\
    sphere m { center 1 2 -3 radius\n\n 1.5#\n material m}\n\
    light l { location 0 0 0 emissivity 1 1 1 } spotlight s { theta 5 point 1 1 1 location 0 0 0 emissivity 2 2 2 }";

/// An entity as `type name: attribute value value, …`.
fn told(text: &[u8], id: EntityId) -> Option<String> {
    let at = |range: &Range<usize>| std::str::from_utf8(&text[range.clone()]).unwrap();
    let place = places(text).of(text, id)?;
    assert_eq!(text[place.open], b'{');
    assert_eq!(text[place.close], b'}');
    assert_eq!(place.span, place.kind.start..place.close + 1);
    let given = place.given.iter().map(|given| {
        assert_eq!(place.given(given.name), Some(given));
        let values: Vec<&str> = given.values.iter().map(at).collect();
        format!("{}={} {}", given.name, at(&given.key), values.join(" "))
    });
    let given = given.collect::<Vec<_>>().join(", ");
    Some(format!("{} {}: {given}", at(&place.kind), at(&place.name)))
}

#[test]
fn unusual_texts_are_read_as_the_parser_reads_them() {
    use EntityId::{Camera, Light, Material, Object, Texture};
    let text = ODD.as_bytes();
    parse_text("odd", text).unwrap();
    let known = [
        (Material(0), "material normal: ambient=ambient 1 2 3"),
        (
            Material(1),
            "material m: specular=specular .5, diffuse=diffuse 0x1p1 +2. 3e0",
        ),
        (Texture(0), "texture normal: filename=filename ambient"),
        (Texture(1), "texture t: filename=filename a.ppm"),
        (
            Object(0),
            "texplane plane: texname=texname normal, material=material normal, normal=normal 0 0 1, mode=mode 0, \
             point=point 0 0 -1, xdir=xdir 1 0 0, dimensions=dimensions 4 3",
        ),
        (
            Object(1),
            "tiled_plane \u{E4}\u{1F600}: dimension=dimensions 1 2, altmaterial=altmaterial m, normal=normal 0 1 0, \
             material=material m, point=point 0 0 0",
        ),
        (
            Camera,
            "camera c: viewpoint=viewpoint 4 3 6, worlddim=worlddim 8 6, pixeldim=pixeldim 4 3",
        ),
        (
            Object(2),
            "sphere m: center=center 1 2 -3, radius=radius 1.5, material=material m",
        ),
        (
            Light(0),
            "light l: location=location 0 0 0, emissivity=emissivity 1 1 1",
        ),
        (
            Light(1),
            "spotlight s: theta=theta 5, point=point 1 1 1, location=location 0 0 0, emissivity=emissivity 2 2 2",
        ),
    ];
    for (id, line) in known {
        assert_eq!(told(text, id).as_deref(), Some(line), "{id:?}");
    }
    for id in [Material(2), Texture(2), Object(3), Light(2)] {
        assert_eq!(told(text, id), None, "{id:?}");
    }
}

#[test]
fn texts_that_are_no_scenes_have_what_stands_before() {
    let text = ODD.as_bytes();
    let all = [
        EntityId::Camera,
        EntityId::Material(1),
        EntityId::Texture(1),
        EntityId::Object(2),
        EntityId::Light(1),
    ];
    let whole = places(text);
    for length in 0..text.len() {
        let short = &text[..length];
        for id in all {
            // Cut off behind an entity it is there, elsewhere it is not; and places of another text are no danger.
            let end = whole.of(text, id).unwrap().span.end;
            assert_eq!(places(short).of(short, id).is_some(), end <= length);
            assert_eq!(whole.of(short, id).is_some(), end <= length);
            let _ = whole.of(&text[text.len() - length..], id);
        }
    }
    for wrong in [
        "material a { { } } camera",
        "}",
        "mat a { }",
        "material { ambient 1 1 1 }",
        "\u{FEFF}",
    ] {
        assert_eq!(places(wrong.as_bytes()), Places::default(), "{wrong}");
    }
    // Its end is found, but inside something is not understood.
    for inside in ["ambient", "ambient 1 1 1 colour 2", "shininess }", "1 1 1"] {
        let text = format!("material a {{ {inside} }} material b {{ shininess 1 }}");
        assert_eq!(
            told(text.as_bytes(), EntityId::Material(0)),
            None,
            "{inside}"
        );
    }
}

#[test]
fn lines_are_those_of_diagnostics() {
    let text = [ODD, "\n\r\r\n\n\u{1F600}\r\n\u{E4}x\r"].concat();
    let text = text.as_bytes();
    let mut last = (1, 1);
    for offset in 0..=text.len() {
        let complaint = Diagnostic::new(offset..offset, "here");
        let diagnostics = Diagnostics::new("odd", text, vec![complaint], 1);
        let told = diagnostics
            .messages()
            .next()
            .map(|(line, column, _)| (line, column));
        assert_eq!(Some(line(text, offset)), told, "byte {offset}");
        last = line(text, offset);
    }
    assert_eq!(last, (20, 1));
    assert_eq!(line(text, text.len() + 9), last, "no byte of the text");
    assert_eq!(line(b"", 0), (1, 1));
    assert_eq!(line(b"a\r\n  b", 5), (2, 3));
}

//! How numbers and a camera are written: what [`write`](super::write) puts into a text, and what goes to the clipboard.

use crate::scene::Camera;

/// A number in the shortest decimal text that reads back as the same f64, as a person writes it: `5`, `0.2`, `1e300`.
pub(super) fn number(value: f64) -> String {
    let mut text = format!("{:?}", value + 0.0);
    if let Some(whole) = text.strip_suffix(".0") {
        text.truncate(whole.len());
    }
    text
}

/// Numbers with a space between.
pub(super) fn numbers(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| number(*value)).collect();
    texts.join(" ")
}

/// A camera as a block of a scene file, in the layout of the course notes, with a newline at the end. It reads back as
/// the same camera.
pub fn camera_block(camera: &Camera) -> String {
    let [columns, rows] = camera.pixeldim;
    format!(
        "camera {}\n{{\n  pixeldim {columns} {rows}\n  worlddim {}\n  viewpoint {}\n}}\n",
        camera.name,
        numbers(camera.worlddim.as_ref()),
        numbers(camera.viewpoint.as_ref())
    )
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::parse;

    #[test]
    fn numbers_are_short() {
        let known = [
            (5.0, "5"),
            (-0.0, "0"),
            (0.1 + 0.2, "0.30000000000000004"),
            (-12.5, "-12.5"),
            (1e300, "1e300"),
            (1000.0, "1000"),
            (0.00001, "1e-5"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e308"),
        ];
        for (value, text) in known {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_camera_reads_back() {
        let mut camera = Camera {
            name: "cam1".into(),
            pixeldim: [640, 480],
            worlddim: [8.0, 6.0].into(),
            viewpoint: [4.0, 3.0, 6.5].into(),
        };
        let block = camera_block(&camera);
        let lines = [
            "camera cam1",
            "{",
            "  pixeldim 640 480",
            "  worlddim 8 6",
            "  viewpoint 4 3 6.5",
            "}",
            "",
        ];
        assert_eq!(block.lines().chain([""]).collect::<Vec<_>>(), lines);
        camera.viewpoint = [1.0 / 3.0, -1e-300, 5e-324].into();
        let back = |camera: &Camera| {
            let block = camera_block(camera);
            parse("block", block.as_bytes(), Path::new(""))
                .unwrap()
                .camera
        };
        assert_eq!(back(&camera), camera);
        camera.viewpoint.x = f64::from_bits(camera.viewpoint.x.to_bits() + 1);
        assert_eq!(back(&camera), camera, "to the last bit");
        camera.worlddim = [f64::MAX, 1.0].into();
        assert_eq!(back(&camera), camera);
    }
}

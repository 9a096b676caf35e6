//! The exact text of what is said about each wrong scene: message, place, line, caret and mend.

mod blocks;
mod bytes;
mod files;
mod limits;
mod lookalikes;
mod names;
mod reports;
mod triangles;
mod values;

use std::path::Path;

use expect_test::Expect;
use plumb::scene;

/// A camera on line 1.
const CAMERA: &str = "camera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }\n";
/// A material on line 2.
const GREEN: &str = "material green { ambient 0 5 0 }\n";

/// The diagnostics of a scene, as they are printed.
fn complaints(text: impl AsRef<[u8]>) -> String {
    match scene::parse("scene.txt", text.as_ref(), Path::new("")) {
        Ok(scene) => format!("no complaint: {scene:?}"),
        Err(diagnostics) => diagnostics.render(false),
    }
}

/// Checks what is said about a text.
fn check(text: impl AsRef<[u8]>, expected: Expect) {
    expected.assert_eq(&complaints(text));
}

/// Checks what is said about lines behind a camera and a material `green`.
fn check_rest(text: &str, expected: Expect) {
    check(format!("{CAMERA}{GREEN}{text}"), expected);
}

/// Checks what is said about a texture whose file holds these bytes.
fn check_texture(bytes: &[u8], expected: Expect) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wood.ppm"), bytes).unwrap();
    let text = format!("{CAMERA}texture wood {{ filename wood.ppm }}\n");
    let diagnostics = scene::parse("scene.txt", text.as_bytes(), folder.path()).unwrap_err();
    expected.assert_eq(&diagnostics.render(false));
}

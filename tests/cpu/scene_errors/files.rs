//! Textures and scenes as files: damaged, of another kind, not there, not ours to read, without end.

use std::path::Path;

use expect_test::expect;
use plumb::scene::{self, LoadError};

use super::{CAMERA, check, check_texture};

#[test]
fn texture_files() {
    check_texture(
        b"P6 65536 65536 255\n0123456789",
        expect![[r#"
            error: texture `wood.ppm`: ends early: 65536 x 65536 pixels are 12884901888 bytes, and there are 10
              --> scene.txt:2:25
              |
            2 | texture wood { filename wood.ppm }
              |                         ^^^^^^^^
        "#]],
    );
    check_texture(
        b"P6 2 2 255\n0123456789",
        expect![[r#"
            error: texture `wood.ppm`: ends early: 2 x 2 pixels are 12 bytes, and there are 10
              --> scene.txt:2:25
              |
            2 | texture wood { filename wood.ppm }
              |                         ^^^^^^^^
        "#]],
    );
    check_texture(
        b"P6 0 0 255\n",
        expect![[r#"
            error: texture `wood.ppm`: has no pixels: it is 0 x 0
              --> scene.txt:2:25
              |
            2 | texture wood { filename wood.ppm }
              |                         ^^^^^^^^
        "#]],
    );
    check_texture(
        b"P6 1 1 65535\nabcdef",
        expect![[r#"
        error: texture `wood.ppm`: has maxval 65535; it must be 255
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"P3 1 1 255\n1 2 3",
        expect![[r#"
        error: texture `wood.ppm`: is a text PPM (P3), not a binary one (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"hello",
        expect![[r#"
        error: texture `wood.ppm`: is no picture that is known, not a binary PPM (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"",
        expect![[r#"
        error: texture `wood.ppm`: is empty
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
    check_texture(
        b"\x89PNG\r\n\x1A\n",
        expect![[r#"
        error: texture `wood.ppm`: is a PNG picture, not a binary PPM (P6)
          --> scene.txt:2:25
          |
        2 | texture wood { filename wood.ppm }
          |                         ^^^^^^^^
          |
          = help: textures are binary PPM (P6) with maxval 255; convert the picture to that
    "#]],
    );
}

#[test]
fn missing_texture_file() {
    check(
        format!(
            "{CAMERA}texture wood {{ filename no/such/wood.ppm }}\ntexture none {{ filename }}\n\
             texture marked {{ filename \"wood.ppm\" }}"
        ),
        expect![[r#"
            error: texture `no/such/wood.ppm`: there is no such file
              --> scene.txt:2:25
              |
            2 | texture wood { filename no/such/wood.ppm }
              |                         ^^^^^^^^^^^^^^^^
              |
              = help: looked for at `no/such/wood.ppm`, in the current folder

            error: `filename` takes a file name, found none
              --> scene.txt:3:16
              |
            3 | texture none { filename }
              |                ^^^^^^^^

            error: texture `"wood.ppm"`: there is no such file
              --> scene.txt:4:27
              |
            4 | texture marked { filename "wood.ppm" }
              |                           ^^^^^^^^^^
              |
              = help: a file name stands without quotation marks
        "#]],
    );
}

#[test]
fn other_files() {
    check(
        b"\xFF\xD8\xFF\xE0\0\x10JFIF",
        expect![[r#"
        error: this is a JPEG picture, not a scene
          --> scene.txt:1:1
          |
        1 | ������JFIF
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"\x89PNG\r\n\x1A\n\0",
        expect![[r#"
        error: this is a PNG picture, not a scene
          --> scene.txt:1:1
          |
        1 | �PNG
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"P6 1 1 255\nabc",
        expect![[r#"
        error: this is a PPM picture, not a scene
          --> scene.txt:1:1
          |
        1 | P6 1 1 255
          | ^
          |
          = help: a scene is a text file
    "#]],
    );
    check(
        b"\xFF\xFEc\0a\0",
        expect![[r#"
        error: this text is encoded in UTF-16; a scene is UTF-8
          --> scene.txt:1:1
          |
        1 | ��c�a�
          | ^
          |
          = help: save it as UTF-8
    "#]],
    );
    check(
        b"c\0a\0m\0",
        expect![[r#"
        error: this is not a scene: it holds a NUL byte
          --> scene.txt:1:2
          |
        1 | c�a�m�
          |  ^ the first one
          |
          = help: a scene is a text file in UTF-8; this may be UTF-16, or no text at all
    "#]],
    );
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| {
        let text = scene::load(&folder.path().join(name))
            .unwrap_err()
            .to_string();
        text.replace(&folder.path().display().to_string(), "FOLDER")
            .replace('\\', "/")
    };
    std::fs::write(folder.path().join("gallery.txt"), CAMERA).unwrap();
    expect!["FOLDER/galery.txt: there is no such file (did you mean FOLDER/gallery.txt?)"]
        .assert_eq(&message("galery.txt"));
    expect!["FOLDER/gallery: there is no such file (did you mean FOLDER/gallery.txt?)"]
        .assert_eq(&message("gallery"));
    expect!["FOLDER/nothing-like-it: there is no such file"].assert_eq(&message("nothing-like-it"));
    std::fs::create_dir(folder.path().join("inner")).unwrap();
    expect!["FOLDER/inner: is a directory, not a scene"].assert_eq(&message("inner"));
    std::fs::File::create(folder.path().join("large"))
        .unwrap()
        .set_len(scene::MAX_FILE + 1)
        .unwrap();
    expect!["FOLDER/large: too large for a scene: more than 256 MiB"].assert_eq(&message("large"));
}

#[cfg(unix)]
#[test]
fn a_file_without_permission() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("secret.txt");
    std::fs::write(&path, CAMERA).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o0)).unwrap();
    match scene::load(&path) {
        // The superuser may read everything.
        Ok(_) => assert!(std::fs::read(&path).is_ok()),
        Err(error) => assert!(
            error.to_string().ends_with("secret.txt: permission denied"),
            "{error}"
        ),
    }
}

#[test]
fn a_stream_is_bounded() {
    let error = scene::load_from("<stdin>", std::io::repeat(b' '), Path::new("")).unwrap_err();
    assert!(matches!(error, LoadError::TooLarge { .. }));
    expect!["<stdin>: too large for a scene: more than 256 MiB"].assert_eq(&error.to_string());
    let error = scene::load_from("<stdin>", &b"}"[..], Path::new("")).unwrap_err();
    assert!(error.to_string().contains("<stdin>:1:1"), "{error}");
}

//! Tests of the whole of text → lex → parse → [`Scene`]: good scenes, the builder, the listing.

use std::path::Path;

use glam::{DVec2, DVec3};

use super::*;

const CAMERA: &str = "camera cam { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }\n";

fn read(text: &str) -> Scene {
    match parse("test", text.as_bytes(), Path::new("")) {
        Ok(scene) => scene,
        Err(diagnostics) => panic!("{diagnostics}"),
    }
}

fn listing(scene: &Scene) -> String {
    let mut out = Vec::new();
    list_model(scene, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// A scene with every entity, built in code.
fn everything() -> SceneBuilder {
    let mut scene = SceneBuilder::new();
    scene.camera("cam", [640, 480], [8.0, 6.0], [4.0, 3.0, 6.5]);
    let green = scene.material(Material {
        name: "green".into(),
        ambient: DVec3::new(0.0, 5.0, 0.1),
        ..Material::default()
    });
    let glass = scene.material(Material {
        name: "glass".into(),
        diffuse: DVec3::ONE,
        specular: DVec3::splat(0.25),
        shininess: 20.0,
        transparency: 0.75,
        ..Material::default()
    });
    let texels = Texels {
        width: 1,
        height: 2,
        rgb: vec![0, 1, 2, 3, 4, 5],
    };
    let wood = scene.texture_of("wood", "wood.ppm", texels);
    let (up, origin, x) = (DVec3::Y, DVec3::ZERO, DVec3::X);
    scene.plane("floor", green, [0.0, 1.0, -0.0], origin);
    scene.sphere("ball", glass, [1.0, 2.0, -3.0], 1.5);
    scene.tiled_plane("tiles", green, up, origin, glass, [0.5, 1.0], None);
    scene.tiled_plane(
        "turned",
        green,
        up,
        origin,
        glass,
        [0.5, 1.0],
        Some(DVec3::new(1.0, 1.0, 0.0)),
    );
    scene.pplane("procedural", green, up, origin, 2);
    scene.psphere("marble", green, origin, 1e-300, 0);
    scene.fplane("board", glass, up, origin, x, [1.0, 2.0]);
    scene.texplane(
        "picture",
        glass,
        up,
        origin,
        x,
        [1.0, 2.0],
        wood,
        TextureMode::Tile,
    );
    scene.light("lamp", [0.0, 4.0, 0.0], DVec3::ONE);
    scene.spotlight("beam", [0.0, 4.0, 0.0], DVec3::ONE, [4.0, 0.0, -3.0], 15.0);
    let (at, sides) = ([0.0, 4.0, 0.0], [1.0, 2.0]);
    let mode = TextureMode::Fit;
    scene.projector("lantern", at, DVec3::ONE, up, origin, x, sides, wood, mode);
    scene
}

#[test]
fn attributes_come_in_any_order_and_names_repeat() {
    let scene = read(&format!(
        "light l {{ emissivity 1 2 3 location 4 5 6 }}\n\
         material a {{ specular 0.5 }} material a {{ specular 1 2 3 }}\n\
         plane a {{ point 0 0 0 normal 0 0x1p-1 1 material a }}{CAMERA}"
    ));
    assert_eq!(scene.materials[0].specular, DVec3::splat(0.5));
    assert_eq!(scene.materials[1].specular, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.objects[0].material, 0, "the first of that name");
    let normal = DVec3::new(0.0, 0.5, 1.0);
    assert_eq!(
        scene.objects[0].shape,
        Shape::Plane {
            normal,
            point: DVec3::ZERO,
            extent: Extent::Unbounded
        }
    );
    assert_eq!(scene.lights[0].location, DVec3::new(4.0, 5.0, 6.0));
}

#[test]
fn keywords_and_numbers_are_names_too() {
    let scene = read(&format!(
        "{CAMERA}material material {{ ambient 1 1 1 }} material 5 {{ ambient 1 1 1 }} material normal {{ ambient 1 1 1 }}\n\
         sphere sphere {{ material 5 center 0 0 0 radius 1 }}\n\
         sphere center {{ center 0 0 0 radius 1 material material }}\n\
         plane normal {{ material normal normal 0 0 1 point 0 0 0 }}"
    ));
    let materials: Vec<_> = scene.objects.iter().map(|object| object.material).collect();
    assert_eq!(materials, [1, 0, 2]);
}

#[test]
fn names_have_no_limit_of_length() {
    let name = "ä".repeat(5_000);
    let scene = read(&format!(
        "{CAMERA}material {name} {{ ambient 1 1 1 }} sphere s{{material {name} center 0 0 0 radius 1}}"
    ));
    assert_eq!(scene.materials[0].name, name);
}

#[test]
fn both_spellings_of_the_size_of_a_tile() {
    for word in ["dimension", "dimensions"] {
        let scene = read(&format!(
            "{CAMERA}material a {{ ambient 1 1 1 }}\n\
             tiled_plane t {{ material a normal 0 1 0 point 0 0 0 altmaterial a {word} 2 3 }}"
        ));
        let tiled = Surface::Tiled {
            dimension: DVec2::new(2.0, 3.0),
            altmaterial: 0,
            xdir: None,
        };
        assert_eq!(scene.objects[0].surface, tiled);
    }
}

#[test]
fn a_picture_that_two_textures_use_is_read_once() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("a.ppm"),
        b"P6 # two texels\n2 1\n255\nabcdef, and more",
    )
    .unwrap();
    let text = format!("{CAMERA}texture a {{ filename a.ppm }} texture b {{ filename ./a.ppm }}");
    let scene = parse("test", text.as_bytes(), folder.path()).unwrap();
    assert_eq!(scene.textures[0].texels.rgb, b"abcdef");
    assert!(std::sync::Arc::ptr_eq(
        &scene.textures[0].texels,
        &scene.textures[1].texels
    ));
    assert_eq!(scene.textures[1].filename, "./a.ppm");
}

#[test]
fn the_listing_shows_every_entity() {
    let scene = everything().build().unwrap();
    expect_test::expect![[r#"
        camera          cam
            pixeldim    640  480
            worlddim    8.0  6.0
            viewpoint   4.0  3.0  6.5

        material        green
            ambient     0.0  5.0  0.1
            diffuse     0.0  0.0  0.0
            specular    0.0  0.0  0.0
            shininess   0.0
            transparency 0.0

        material        glass
            ambient     0.0  0.0  0.0
            diffuse     1.0  1.0  1.0
            specular    0.25  0.25  0.25
            shininess   20.0
            transparency 0.75

        texture         wood
            filename    wood.ppm

        plane           floor
        material        green
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0

        sphere          ball
        material        glass
            center      1.0  2.0  -3.0
            radius      1.5

        tiled_plane     tiles
        material        green
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            altmaterial glass
            dimension   0.5  1.0

        tiled_plane     turned
        material        green
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            altmaterial glass
            dimension   0.5  1.0
            xdir        1.0  1.0  0.0

        pplane          procedural
        material        green
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            shader      2

        psphere         marble
        material        green
            center      0.0  0.0  0.0
            radius      1e-300
            shader      0

        fplane          board
        material        glass
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            xdir        1.0  0.0  0.0
            dimensions  1.0  2.0

        texplane        picture
        material        glass
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            xdir        1.0  0.0  0.0
            dimensions  1.0  2.0
            texname     wood
            mode        1

        light           lamp
            location    0.0  4.0  0.0
            emissivity  1.0  1.0  1.0

        spotlight       beam
            location    0.0  4.0  0.0
            emissivity  1.0  1.0  1.0
            point       4.0  0.0  -3.0
            theta       15.0

        projector       lantern
            location    0.0  4.0  0.0
            emissivity  1.0  1.0  1.0
            normal      0.0  1.0  0.0
            point       0.0  0.0  0.0
            xdir        1.0  0.0  0.0
            dimensions  1.0  2.0
            texname     wood
            mode        0

    "#]]
    .assert_eq(&listing(&scene));
}

#[test]
fn a_listing_with_braces_is_the_same_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("wood.ppm"),
        b"P6 1 2 255\n\0\x01\x02\x03\x04\x05",
    )
    .unwrap();
    let mut built = everything().build().unwrap();
    built.textures[0].path = folder.path().join("wood.ppm");
    let text = listing(&built);
    let entities = text
        .trim_end()
        .split("\n\n")
        .map(|entity| entity.replacen('\n', " {\n", 1) + "}\n");
    let text: String = entities.collect();
    let read = parse("listing", text.as_bytes(), folder.path()).unwrap();
    assert_eq!(read, built);
}

#[test]
fn the_builder_tells_everything_that_is_wrong() {
    let mut scene = SceneBuilder::new();
    let material = Material {
        name: "two words".into(),
        transparency: 1.5,
        ..Material::default()
    };
    let id = scene.material(material.clone());
    scene.material(material);
    scene.sphere("ball", id, [0.0, f64::NAN, 0.0], -1.0);
    scene.fplane(
        "board",
        id,
        [0.0, 2.0, 0.0],
        [0.0; 3],
        [0.0, -1.0, 0.0],
        [1.0, 1.0],
    );
    scene.spotlight("beam", [1.0, 2.0, 3.0], DVec3::ONE, [1.0, 2.0, 3.0], 15.0);
    scene.texture("wood", Path::new("no/such/file.ppm"));
    scene.texture_of(
        "small",
        "small.ppm",
        Texels {
            width: 2,
            height: 2,
            rgb: vec![0; 3],
        },
    );
    expect_test::expect![[r#"
        material `two words`: a name is not empty, and holds no white space, braces or `#`
        material `two words`: `transparency` must be 0 to 1, and is [1.5]
        material `two words`: this name is taken: in a file it means the first of that name
        material `two words`: a name is not empty, and holds no white space, braces or `#`
        material `two words`: `transparency` must be 0 to 1, and is [1.5]
        sphere `ball`: `center` must be finite
        sphere `ball`: `radius` must be greater than 0, and is [-1.0]
        fplane `board`: `xdir` must not be parallel to `normal`: it is projected onto the plane
        spotlight `beam`: `point` must differ from `location`: the two give the direction of the light
        texture `wood`: `no/such/file.ppm` there is no such file
        texture `small`: 2 x 2 texels do not fit 3 bytes
        camera ``: a scene has exactly one camera, and this has none"#]].assert_eq(&scene.build().unwrap_err().to_string());
    let mut scene = everything();
    scene.camera("other", [1, 0], [1.0, 1.0], DVec3::Z);
    expect_test::expect![[r#"
        camera `other`: a scene has exactly one camera
        camera `other`: `pixeldim` must be 1 to 1,000,000, and is [1.0, 0.0]"#]]
    .assert_eq(&scene.build().unwrap_err().to_string());
}

#[test]
fn a_triangle_that_was_built_is_the_one_of_the_text() {
    let mut built = SceneBuilder::new();
    built.camera("cam", [64, 48], [8.0, 6.0], [4.0, 3.0, 6.0]);
    let material = built.material(Material {
        name: "m".into(),
        ambient: DVec3::ONE,
        ..Material::default()
    });
    let vertices = [[0.0; 3], [8.0, 0.0, -1.0], [4.0, 6.0, -2.0]].map(DVec3::from);
    built.triangle("t", material, vertices, Some(DVec3::Z));
    let text =
        "camera cam { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }
        triangle t { material m vertex1 0 0 0 vertex2 8 0 -1 vertex3 4 6 -2 normal 0 0 1 }";
    let read = parse("t", text.as_bytes(), Path::new("")).unwrap();
    assert_eq!(built.build().unwrap(), read);
    let mut flat = SceneBuilder::new();
    flat.camera("cam", [64, 48], [8.0, 6.0], [4.0, 3.0, 6.0]);
    let material = flat.material(Material {
        name: "m".into(),
        ..Material::default()
    });
    flat.triangle("t", material, [DVec3::ZERO, DVec3::X, DVec3::X * 3.0], None);
    let error = flat.build().unwrap_err().to_string();
    assert!(error.contains("must not lie in a line"), "{error}");
}

#[test]
fn ids_of_another_builder_are_told() {
    let mut one = SceneBuilder::new();
    let id = one.material(Material {
        name: "a".into(),
        ..Material::default()
    });
    let mut other = SceneBuilder::new();
    other.sphere("ball", id, DVec3::ZERO, 1.0);
    assert!(
        other
            .build()
            .unwrap_err()
            .to_string()
            .contains("another builder")
    );
}

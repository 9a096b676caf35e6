//! The textbook's ways are nearly right where the notes are, and measurably wrong where f32 is. Needs an adapter.

use std::path::Path;

use super::*;
use crate::image::compare;
use crate::render::{Backend, Settings, render};
use crate::scene::{load, load_from};

fn gpu() -> std::sync::Arc<Gpu> {
    let gpu = crate::gpu::adapters::shared(None);
    gpu.expect("this test needs a GPU adapter; a software one will do")
}

/// Pixels of a scene of ours that differ from the certified picture, with and without preparation; of how many.
fn wrong(gpu: &Gpu, scene: &Scene) -> [u64; 2] {
    let settings = Settings {
        backend: Backend::Cpu,
        ..Settings::default()
    };
    let mut rgb = Vec::new();
    render(scene, &settings, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    })
    .unwrap();
    let [width, height] = scene.camera.pixeldim;
    let truth = Picture { width, height, rgb };
    [true, false].map(|prepared| {
        let (_, rendered) = frame(gpu, scene, &settings, prepared).unwrap();
        compare(&truth, &rendered.picture).unwrap().different
    })
}

fn of_ours(name: &str, size: [u32; 2]) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scene = load(&folder.join(name)).unwrap();
    scene.camera.pixeldim = size;
    scene
}

/// Honest code: where nothing is hard it gets no more wrong than f32 does. That is one in fifty pixels at most: bytes
/// off by one under a wheel of cosines; rows and columns of walls that meet the screen's edge, where z is 0 exactly.
#[test]
fn nearly_right_where_nothing_is_hard() {
    let gpu = gpu();
    for name in [
        "notes/walls.txt",
        "notes/procedural.txt",
        "gallery/spheres_over_tiles.txt",
        "gallery/procedural_all.txt",
        "gallery/tiles_side_wall.txt",
        "lit/shadows_balls.txt",
        "lit/mirror_balls.txt",
        "lit/glass_balls.txt",
        "lit/spotlight_stage.txt",
        "lit/glint.txt",
        "lit/magic_lantern.txt",
        "lit/fplanes_slanted.txt",
        "lit/tiles_xdir.txt",
        "lit/texture_repeated.txt",
        "lit/texture_stretched.txt",
    ] {
        let scene = of_ours(name, [160, 120]);
        let wrong = wrong(&gpu, &scene);
        assert!(wrong.iter().all(|wrong| *wrong < 384), "{name}: {wrong:?}");
    }
}

/// b² − 4ac loses a small sphere that is far away; without preparation tiles far off fall apart, too.
#[test]
fn wrong_where_it_is_hard() {
    let gpu = gpu();
    let far = of_ours("hard/sphere_tiny_far.txt", [160, 120]);
    let [quadratic, naive] = wrong(&gpu, &far);
    assert!(quadratic > 192 && naive > 192, "{quadratic} {naive}");
    let millimetres = of_ours("hard/millimetres.txt", [160, 120]);
    let [quadratic, naive] = wrong(&gpu, &millimetres);
    assert!(
        quadratic > 50 && naive > 3 * quadratic,
        "{quadratic} {naive}"
    );
}

#[test]
fn too_many_spheres_are_refused() {
    let gpu = gpu();
    let mut text = "camera c { pixeldim 2 2 worlddim 2 2 viewpoint 1 1 1 }
        material m { ambient 1 1 1 }"
        .to_owned();
    for i in 0..=MOST_SPHERES {
        text += &format!("sphere s{i} {{ material m center {i} 0 -9 radius 1 }}\n");
    }
    let mut scene = load_from("scene", text.as_bytes(), Path::new(".")).unwrap();
    let frame = |scene: &Scene| frame(&gpu, scene, &Settings::default(), true);
    let refused = frame(&scene).unwrap_err().to_string();
    assert!(
        refused.contains("1000 spheres") && refused.contains("1001"),
        "{refused}"
    );
    scene.objects.pop();
    assert!(frame(&scene).is_ok());
}

#[test]
fn what_no_textbook_has_is_refused() {
    let gpu = gpu();
    let scene = of_ours("known/triangle_edges.txt", [3, 3]);
    let refused = frame(&gpu, &scene, &Settings::default(), true).unwrap_err();
    assert_eq!(refused.to_string(), "the textbook's ways have no triangle");
}

/// What the shader says of a pixel's hit is what the picture shows.
#[test]
fn hits_are_told_with_their_distances() {
    let gpu = gpu();
    let scene = of_ours("notes/walls.txt", [64, 48]);
    let settings = Settings::default();
    let truth = crate::bench::truth::hits(&scene, &settings, &[7, 8, 20]);
    for prepared in [true, false] {
        let textbook = Textbook::new(&gpu, &scene, &settings, prepared, true).unwrap();
        let hits = textbook.hits(&[7, 8, 20]).unwrap();
        assert_eq!(hits.len(), truth.len());
        for (i, (hit, (truth, _))) in hits.iter().zip(&truth).enumerate() {
            if i % 64 == 0 || i % 64 == 63 {
                // The screen's edge, where two walls are equally far.
                continue;
            }
            assert_eq!(hit.object, truth.object);
            assert!(
                (hit.t - truth.t).abs() < 1e-5 * truth.t,
                "{hit:?} {truth:?}"
            );
        }
    }
}

/// Sixteen rows of it are more than a dispatch takes.
#[test]
fn hits_of_wide_pictures_are_told() {
    let gpu = gpu();
    let scene = of_ours("notes/walls.txt", [70_000, 16]);
    let rows: Vec<u32> = (0..16).collect();
    let textbook = Textbook::new(&gpu, &scene, &Settings::default(), true, true).unwrap();
    let hits = textbook.hits(&rows).unwrap();
    assert_eq!(hits.len(), 16 * 70_000);
    // In the middle of each row there is a floor or a wall.
    let mut middles = hits.iter().skip(35_000).step_by(70_000);
    assert!(middles.all(|hit| hit.object != FirstObject::Nothing && (7.0..20.5).contains(&hit.t)));
}

//! What a driver or a machine limits changes no picture: loops that lavapipe would cut, bands, dispatches, samples.

use glam::{DVec2, DVec3};
use plumb::gpu::adapters;
use plumb::render::{Backend, SamplePattern, Settings, render};
use plumb::scene::{Camera, Extent, Light, Material, Object, Scene, Shape, Surface};

use crate::common::{light, on, picture};

fn scene(pixeldim: [u32; 2], objects: Vec<Object>) -> Scene {
    let material = |name: &str, ambient| Material {
        name: name.into(),
        ambient,
        diffuse: ambient,
        ..Material::default()
    };
    Scene {
        camera: Camera {
            name: "c".into(),
            pixeldim,
            worlddim: DVec2::new(2.0, 2.0),
            viewpoint: DVec3::new(1.0, 1.0, 1.0),
        },
        materials: vec![
            material("red", DVec3::new(4e4, 0.0, 0.0)),
            material("blue", DVec3::new(0.0, 0.0, 3.0)),
        ],
        objects,
        lights: vec![],
        textures: vec![],
    }
}

fn wall(z: f64, material: usize) -> Object {
    let shape = Shape::Plane {
        normal: DVec3::Z,
        point: DVec3::new(0.0, 0.0, z),
        extent: Extent::Unbounded,
    };
    Object {
        name: "wall".into(),
        material,
        shape,
        surface: Surface::Plain,
    }
}

fn ball(center: DVec3, radius: f64, material: usize) -> Object {
    Object {
        name: "ball".into(),
        material,
        shape: Shape::Sphere { center, radius },
        surface: Surface::Plain,
    }
}

/// lavapipe ends a loop after 65,535 iterations without a word; ours has to reach the last object, which is the
/// nearest.
#[test]
fn the_last_of_many_planes_is_seen() {
    let mut objects: Vec<Object> = (0..32_000).map(|i| wall(-2.0 - f64::from(i), 0)).collect();
    objects.push(wall(-1.0, 1));
    let scene = scene([3, 2], objects);
    let (gpu, report) = picture(&scene, &on(Backend::Gpu));
    assert_eq!(report.refined, 0, "the GPU itself has to reach it");
    assert_eq!(gpu, picture(&scene, &on(Backend::Cpu)).0);
    assert!(
        gpu.chunks_exact(3).all(|p| p[0] == 0 && p[2] > 0),
        "{gpu:?}"
    );
}

/// More than the loops are sure to reach is never cut: refused with --backend gpu, rendered by the CPU with auto.
#[test]
fn too_many_planes_are_not_cut() {
    let mut objects: Vec<Object> = (0..70_000).map(|i| wall(-2.0 - f64::from(i), 0)).collect();
    objects.push(wall(-1.0, 1));
    let scene = scene([2, 2], objects);
    let refused = render(&scene, &on(Backend::Gpu), &mut |_| Ok(())).unwrap_err();
    assert!(
        refused.to_string().contains("70001 planes and spheres"),
        "{refused}"
    );
    // Named, if only by a name that all have: the CPU would not wait for others.
    let auto = Settings {
        adapter: Some(String::new()),
        ..on(Backend::Auto)
    };
    let (auto, report) = picture(&scene, &auto);
    assert_eq!(report.backend, Backend::Cpu);
    assert!(report.fallback.unwrap().contains("so the CPU renders"));
    assert!(auto.chunks_exact(3).all(|p| p[0] == 0 && p[2] > 0));
}

/// A ray whose list of spheres is longer than a loop is sure to go round, and that misses every one: the GPU hands the
/// pixel to the CPU instead of losing the wall behind them. A list that is a little shorter it goes through itself.
#[test]
fn a_list_that_takes_too_long_is_handed_to_the_cpu() {
    // A round counts for all lanes of a vector, where the driver has those, up to 50,000 of one invocation.
    let lanes = adapters::shared(None).unwrap().lanes;
    for (rounds, handed_over) in [(40_000, 0), (60_000, 1)] {
        // The ray along −z at (1, 1) passes the corner of each box, 1.34 radii from the center.
        let place = |i| DVec3::new(1.95, 1.95, -3.0 - 2.1 * f64::from(i));
        let balls = (0..rounds / lanes).map(|i| ball(place(i), 1.0, 0));
        let mut objects: Vec<Object> = balls.collect();
        objects.push(wall(-2e5, 0));
        let scene = scene([1, 1], objects);
        let (gpu, report) = picture(&scene, &on(Backend::Gpu));
        assert_eq!(report.refined, handed_over, "{rounds} rounds");
        assert_eq!(gpu, [50, 0, 0], "4·10⁴/200001 of 255 is 50.99");
        assert_eq!(gpu, picture(&scene, &on(Backend::Cpu)).0);
    }
}

/// The same for shadow rays: the light would be lost, or the shadow.
#[test]
fn a_shadow_ray_that_takes_too_long_is_handed_to_the_cpu() {
    let balls = (0..70_000).map(|i| ball(DVec3::new(1.95, 1.95, 3.0 + 2.1 * f64::from(i)), 1.0, 0));
    let mut objects: Vec<Object> = balls.collect();
    objects.push(wall(-1.0, 1));
    let mut scene = scene([1, 1], objects);
    let location = DVec3::new(1.0, 1.0, 2e5);
    scene.lights.push(Light {
        emissivity: DVec3::splat(1e4),
        ..light(location)
    });
    let (gpu, report) = picture(&scene, &on(Backend::Gpu));
    assert_eq!(report.refined, 1, "{:?}", report.fallback);
    assert_eq!(gpu, picture(&scene, &on(Backend::Cpu)).0);
    assert!(gpu[2] > 0, "{gpu:?}");
}

/// A driver counts the rounds of a vector's lanes together: where some of its pixels have light at one sample and some
/// at another, that is more than any of them goes round. (lavapipe drops a lamp or a sample then.)
#[test]
fn lanes_that_have_light_at_different_samples_are_not_cut() {
    let mut differ = 0;
    for (lamps, samples) in [(1800, 64), (40, 2000)] {
        let mut scene = scene([16, 16], vec![ball(DVec3::new(4.0, 4.0, -4.0), 4.3, 0)]);
        scene.camera.worlddim = DVec2::new(8.0, 8.0);
        scene.camera.viewpoint = DVec3::new(4.0, 4.0, 8.0);
        scene.materials[0].ambient = DVec3::splat(0.5);
        scene.materials[0].diffuse = DVec3::ONE;
        scene.lights = (0..lamps)
            .map(|i| {
                let turn = 2.4 * f64::from(i);
                let far = 6.0 * (f64::from(i) / f64::from(lamps)).sqrt();
                let (sin, cos) = turn.sin_cos();
                Light {
                    emissivity: DVec3::splat(60.0 / f64::from(lamps)),
                    ..light(DVec3::new(4.0 + far * cos, 4.0 + far * sin, 9.0))
                }
            })
            .collect();
        let on = |backend| Settings {
            samples,
            ..on(backend)
        };
        let (gpu, report) = picture(&scene, &on(Backend::Gpu));
        assert_eq!(report.revoked, None);
        let (cpu, _) = picture(&scene, &on(Backend::Cpu));
        let wrong = gpu.chunks(3).zip(cpu.chunks(3)).filter(|(a, b)| a != b);
        differ += wrong.count();
    }
    assert_eq!(differ, 0);
}

/// More samples than the loops are sure to make are taken by the CPU, not dropped.
#[test]
fn many_samples_are_not_cut() {
    let objects: Vec<Object> = (1..100)
        .map(|i| wall(-2.0 - f64::from(100 - i), 1))
        .collect();
    let scene = scene([2, 1], objects);
    let settings = Settings {
        samples: 1000,
        ..on(Backend::Gpu)
    };
    let (gpu, report) = picture(&scene, &settings);
    assert_eq!(
        report.refined, 2,
        "1,000 times 99 objects are more than 65,535"
    );
    assert_eq!(
        gpu,
        picture(
            &scene,
            &Settings {
                backend: Backend::Cpu,
                ..settings
            }
        )
        .0
    );
}

/// 100,000 spheres, found through the tree: the GPU's picture is the CPU's.
#[test]
fn a_hundred_thousand_spheres_agree() {
    let mut state = 1_u64;
    let mut next = |from: f64, to: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        from + (to - from) * ((state >> 33) as f64 / f64::from(1_u32 << 31))
    };
    let balls = (0..100_000).map(|i| {
        let center = DVec3::new(next(-15.0, 17.0), next(-15.0, 17.0), next(-40.0, -2.0));
        ball(center, next(0.02, 0.1), usize::from(i % 2 == 0))
    });
    let mut scene = scene([160, 120], balls.collect());
    scene.materials[0].ambient = DVec3::new(9.0, 4.0, 1.0);
    let (gpu, report) = picture(&scene, &on(Backend::Gpu));
    assert!(
        report.refined < 190,
        "{} pixels are doubtful",
        report.refined
    );
    let (cpu, _) = picture(&scene, &on(Backend::Cpu));
    assert!(gpu == cpu, "the pictures differ");
    let lit = gpu
        .chunks_exact(3)
        .filter(|p| p.iter().any(|c| *c > 0))
        .count();
    assert!(lit > 9000, "only {lit} pixels show a sphere");
}

/// A picture wider than high, higher than wide, of one pixel: every dispatch shape gives the CPU's picture.
#[test]
fn odd_sizes_agree() {
    let objects = || {
        vec![
            wall(-4.037, 1),
            ball(DVec3::new(1.013, 0.971, -3.03), 0.87, 1),
        ]
    };
    for pixeldim in [[1, 1], [1, 517], [517, 1], [17, 16], [15, 33], [70_000, 1]] {
        let scene = scene(pixeldim, objects());
        let (gpu, _) = picture(&scene, &on(Backend::Gpu));
        let (cpu, _) = picture(&scene, &on(Backend::Cpu));
        let differ = gpu
            .chunks_exact(3)
            .zip(cpu.chunks_exact(3))
            .filter(|(g, c)| g != c)
            .count();
        assert!(
            differ * 2000 <= gpu.len() / 3,
            "{pixeldim:?}: {differ} pixels differ"
        );
    }
}

/// Rows rendered alone are the rows of the whole picture, with either spread of the samples, on both tracers.
#[test]
fn rows_alone_are_rows_of_the_whole() {
    let mut scene = scene(
        [37, 29],
        vec![wall(-4.0, 1), ball(DVec3::new(1.0, 1.0, -3.0), 0.7, 1)],
    );
    scene.lights.push(Light {
        emissivity: DVec3::splat(0.5),
        ..light(DVec3::new(0.0, 2.0, 0.0))
    });
    for backend in [Backend::Gpu, Backend::Cpu] {
        for (samples, jitter) in [
            (1, SamplePattern::Hash),
            (4, SamplePattern::Hash),
            (4, SamplePattern::Course),
        ] {
            let settings = Settings {
                samples,
                jitter,
                ..on(backend)
            };
            let (whole, _) = picture(&scene, &settings);
            let mut pieces = Vec::new();
            for rows in [17..29, 5..17, 4..5, 0..4] {
                pieces.extend(
                    picture(
                        &scene,
                        &Settings {
                            rows: Some(rows),
                            ..settings.clone()
                        },
                    )
                    .0,
                );
            }
            assert!(
                whole == pieces,
                "{backend:?}, {samples} samples, {jitter:?}"
            );
        }
    }
}

/// One thread or many: the same bytes.
#[test]
fn threads_change_nothing() {
    let scene = scene(
        [64, 64],
        vec![wall(-4.0, 1), ball(DVec3::new(1.0, 1.0, -3.0), 0.7, 1)],
    );
    let threads = |n| {
        picture(
            &scene,
            &Settings {
                threads: Some(n),
                ..on(Backend::Cpu)
            },
        )
        .0
    };
    assert!(threads(1) == threads(3));
}

/// Of equal spheres the first counts. In a tree, too, that makes no pixel doubtful, with lights or without.
#[test]
fn spheres_that_stand_twice_are_seen_once() {
    let balls = |times: usize| {
        let ball = |i: i32| {
            let center = DVec3::new(
                -0.8 + 0.4 * f64::from(i % 10),
                -0.8 + 0.4 * f64::from(i / 10),
                -1.0,
            );
            [ball(center, 0.15, 1), ball(center, 0.15, 0)]
        };
        scene(
            [64, 64],
            (0..100)
                .flat_map(|i| ball(i).into_iter().take(times))
                .collect(),
        )
    };
    let lamp = light(DVec3::new(1.0, 1.5, 2.0));
    for lights in [vec![], vec![lamp]] {
        let [once, twice] = [1, 2].map(|times| Scene {
            lights: lights.clone(),
            ..balls(times)
        });
        let (gpu, report) = picture(&twice, &on(Backend::Gpu));
        assert!(report.refined < 200, "{} are doubtful", report.refined);
        assert!(gpu.iter().any(|byte| *byte > 0), "all is black");
        assert_eq!(gpu, picture(&twice, &on(Backend::Cpu)).0);
        assert_eq!(gpu, picture(&once, &on(Backend::Cpu)).0);
    }
}

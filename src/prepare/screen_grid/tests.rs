use glam::{DVec2, DVec3};

use super::*;
use crate::cpu::camera::camera_getdir;
use crate::cpu::trace::find_closest_object;
use crate::prepare::Prepared;
use crate::scene::{Camera, Material, Object, Surface};
use crate::settings::Settings;

/// Numbers in [0, 1), the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

fn scene(pixeldim: [u32; 2], balls: Vec<(DVec3, f64)>) -> Scene {
    let object = |(center, radius)| Object {
        name: "ball".into(),
        material: 0,
        shape: Shape::Sphere { center, radius },
        surface: Surface::Plain,
    };
    Scene {
        camera: Camera {
            name: "c".into(),
            pixeldim,
            worlddim: DVec2::new(4.0, 3.0),
            viewpoint: DVec3::new(1.5, 1.25, 2.0),
        },
        materials: vec![Material::default()],
        objects: balls.into_iter().map(object).collect(),
        lights: vec![],
        textures: vec![],
    }
}

/// Balls before, beside, around and behind the viewpoint, from specks to more than the screen.
fn balls(numbers: &mut Numbers, count: usize) -> Vec<(DVec3, f64)> {
    let mut ball = |_| {
        let scale = 10_f64.powf(numbers.between(-1.0, 2.0));
        let mut at = |from: f64| from + scale * numbers.between(-1.0, 1.0);
        let center = DVec3::new(at(1.5), at(1.25), at(2.0 - 0.8 * scale));
        let radius = scale * 10_f64.powf(numbers.between(-3.0, 0.2));
        (center, radius)
    };
    (0..count).map(&mut ball).collect()
}

/// The objects seen in the pixels, by their cells' lists and by asking all.
fn both(scene: &Scene, prepared: &Prepared<f64>, margin: f64) -> [Vec<Option<usize>>; 2] {
    let pixels = scene.camera.pixeldim;
    let sphere = |(index, object): (usize, &Object)| match object.shape {
        Shape::Sphere { center, radius } => {
            let viewpoint = scene.camera.viewpoint;
            Sphere::new(viewpoint, &prepared.camera, index, center, radius)
        }
        Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => None,
    };
    let all = Prepared {
        screen_grid: None,
        spheres: scene
            .objects
            .iter()
            .enumerate()
            .filter_map(sphere)
            .collect(),
        ..prepared.clone()
    };
    [prepared, &all].map(|scene| {
        let mut seen = Vec::new();
        for y in 0..pixels[1] {
            for x in 0..pixels[0] {
                for [a, b] in [
                    [0.0, 0.0],
                    [-1.0, 1.0],
                    [1.0, -0.7],
                    [0.9, 1.0],
                    [-1.0, -1.0],
                ] {
                    let at = [f64::from(x) + a * margin, f64::from(y) + b * margin];
                    let ray = camera_getdir(&scene.camera, at[0], at[1]);
                    seen.push(
                        find_closest_object(scene, &ray)
                            .unwrap()
                            .map(|hit| hit.object),
                    );
                }
            }
        }
        seen
    })
}

#[test]
fn the_lists_miss_nothing() {
    let mut numbers = Numbers(7);
    let mut hits = 0;
    for round in 0..60 {
        let pixels = [[61, 45], [1, 40], [40, 1], [16, 8]][round % 4];
        let count = [40, 200, 700][round % 3];
        let scene = scene(pixels, balls(&mut numbers, count));
        let samples = 1 + 15 * (round as u32 % 2);
        let view = Settings {
            samples,
            ..Settings::default()
        }
        .view();
        let prepared = Prepared::new(&scene, view);
        assert!(prepared.screen_grid.is_some());
        let [listed, all] = both(&scene, &prepared, view.margin);
        assert_eq!(listed, all, "round {round}");
        hits += listed.iter().flatten().count();
    }
    assert!(hits > 10_000, "{hits}");
}

#[test]
fn what_a_list_lacks_is_noticed() {
    let scene = scene([61, 45], balls(&mut Numbers(7), 200));
    let mut prepared = Prepared::<f64>::new(&scene, 0.0);
    let mut screen_grid = ScreenGrid::clone(prepared.screen_grid.as_ref().unwrap());
    let [_, all] = both(&scene, &prepared, 0.0);
    let seen = all.iter().flatten().next().unwrap();
    let place = prepared
        .spheres
        .iter()
        .position(|s| s.object == *seen)
        .unwrap();
    let other = (place as u32 + 1) % prepared.spheres.len() as u32;
    for member in screen_grid
        .members
        .iter_mut()
        .filter(|m| **m as usize == place)
    {
        *member = other;
    }
    prepared.screen_grid = Some(screen_grid.into());
    let [listed, all] = both(&scene, &prepared, 0.0);
    assert_ne!(listed, all);
}

#[test]
fn boxes_are_as_tight_as_outlines() {
    // A ball of radius 1 whose center is 10 before the viewpoint, on the axis: it is seen within d/√(10² − 1) of it.
    let scene = scene([4001, 3001], vec![(DVec3::new(1.5, 1.25, -8.0), 1.0); 40]);
    let prepared = Prepared::<f64>::new(&scene, 0.0);
    let view = ViewParameters::from(0.0);
    let outlines = Outlines::new(&scene, &prepared.camera, view);
    let (max_inverse, covered) = outlines.of(DVec3::new(1.5, 1.25, -8.0), 1.0).unwrap();
    let reach = 2.0 / 99_f64.sqrt() * 1000.0;
    let range = |middle: f64| {
        [
            (middle - reach).ceil() as u32,
            (middle + reach).floor() as u32,
        ]
    };
    assert_eq!(covered, [range(1500.0), range(1250.0)]);
    let units = f64::from(max_inverse) * 9.0 / 2.0;
    assert!(units > 1.0 && units < 1.000_002, "{units}");
}

#[test]
fn lists_run_from_the_nearest_and_name_equal_spheres_once() {
    let mut balls = balls(&mut Numbers(3), 300);
    let again: Vec<_> = balls.iter().rev().copied().collect();
    balls.extend(again);
    let scene = scene([61, 45], balls);
    let prepared = Prepared::<f64>::new(&scene, 0.0);
    let screen_grid = prepared.screen_grid.as_ref().unwrap();
    let mut listed = 0;
    for range in screen_grid.starts.windows(2) {
        let list = &screen_grid.members[range[0] as usize..range[1] as usize];
        assert!(list.is_sorted_by(
            |a, b| screen_grid.max_inverse[*a as usize] >= screen_grid.max_inverse[*b as usize]
        ));
        assert!(
            list.iter()
                .all(|m| prepared.spheres[*m as usize].object < 300)
        );
        listed += list.len();
    }
    assert_eq!(listed, screen_grid.members.len());
    let [listed, all] = both(&scene, &prepared, 0.0);
    assert_eq!(listed, all);
}

#[test]
fn the_lists_stay_short() {
    // Each of these covers the whole screen.
    let scene = scene([2000, 2000], vec![(DVec3::new(1.5, 1.25, 2.0), 3.0); 50]);
    assert!(
        Prepared::<f64>::new(&scene, 0.0).screen_grid.is_none(),
        "the viewpoint is inside"
    );
    let walls = |i| (DVec3::new(1.5, 1.25, -1000.0 - f64::from(i)), 1001.0);
    let scene = self::scene([20_000, 20_000], (0..20_000).map(walls).collect());
    let screen_grid = Prepared::<f64>::new(&scene, 0.0).screen_grid.unwrap();
    assert!(screen_grid.members.len() as u64 <= ENTRIES + 8 * 20_000);
    assert!(screen_grid.starts.len() as u64 <= MOST_CELLS + 1);
}

#[test]
fn few_spheres_are_not_sorted() {
    let scene = scene([61, 45], balls(&mut Numbers(7), WORTHWHILE - 1));
    assert!(Prepared::<f64>::new(&scene, 0.0).screen_grid.is_none());
}

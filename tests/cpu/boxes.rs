//! Boxes around what no tree holds change nothing that a ray meets, and one that is too small is noticed.

use std::path::Path;
use std::sync::Arc;

use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::world::{Range, hits_from};
use plumb::prepare::boxes::{Bounds, Boxes};
use plumb::prepare::{ViewParameters, World};
use plumb::real::{Bounded, Real, V3};
use plumb::scene::load_from;

/// Everything that has an end: a rectangle and a triangle that are slanted, balls, ellipsoids along the axes and not,
/// and what is cut of quadrics that have none.
const SCENE: &str = "
camera c { pixeldim 4 4 worlddim 4 4 viewpoint 1 2 6 }
material m { ambient 1 1 1 }
fplane rectangle { material m normal 1 2 1 point -2 0 -3 xdir 1 0 0.3 dimensions 3 1.5 }
fplane upright { material m normal 0 0 1 point 1 0 -7 xdir 1 0 0 dimensions 2 3 }
triangle t { material m vertex1 -1 3 -2 vertex2 2 3.5 -4 vertex3 0.3 1 -5 }
sphere near { material m center 0.5 0.5 -2 radius 0.7 }
sphere far { material m center 300 -200 -900 radius 120 }
quadric egg { material m coefficients 1 2 3 0 0 0 -4 -4 18 -27 }
quadric slanted { material m coefficients 3 2 2 1.5 -1 0.5 0 -8 12 -24 }
quadric inside_out { material m coefficients -1 -1 -4 0 0 0 2 0 -24 33 }
quadric cup { material m coefficients 1 0 1 0 0 0 0 -1 6 -8 lower -2 -1 -5 upper 2 1 -1 }
light l { location 0 9 0 emissivity 1 1 1 }";

/// What the rays from anywhere to everywhere meet, by object; of those that f64 decides.
fn met(world: &World<Bounded>) -> Vec<(usize, Vec<usize>)> {
    let mut seed = 7_u64;
    let mut next = move |size: f64| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        size * ((seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0)
    };
    let range = Range {
        skip: None,
        light: None,
        through: true,
    };
    let mut all = Vec::new();
    for ray in 0..20_000 {
        let mut vector = |size: f64| V3::new(next(size), next(size), next(size)).map_exact();
        let base = vector(2.0);
        // Some run along an axis, so that boxes are met edge on.
        let mut dir = vector(1.0);
        if ray % 5 == 0 {
            dir = dir.with_axis(ray / 5 % 3, Bounded::exact(0.0));
        }
        if ray % 11 == 0 {
            dir = V3::exact([glam::DVec3::X, glam::DVec3::NEG_Y, glam::DVec3::Z][ray % 3]);
        }
        let mut objects = Vec::new();
        let decided = hits_from(world, base, dir.unit(), &range, &mut |hit| {
            objects.push(hit.point.object);
            Ok(f64::INFINITY)
        });
        if decided.is_ok() {
            all.push((ray, objects));
        }
    }
    all
}

/// A vector of numbers that are exact.
trait MapExact {
    fn map_exact(self) -> V3<Bounded>;
}

impl MapExact for V3<f64> {
    fn map_exact(self) -> V3<Bounded> {
        V3::new(
            Bounded::exact(self.x),
            Bounded::exact(self.y),
            Bounded::exact(self.z),
        )
    }
}

fn with_boxes(world: &World<Bounded>, boxes: Boxes) -> World<Bounded> {
    let mut world = world.clone();
    world.boxes = Arc::new(boxes);
    world
}

#[test]
fn boxes_change_nothing_that_is_met() {
    let scene = load_from("test", SCENE.as_bytes(), Path::new(".")).unwrap();
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(1e6));
    let world = exact_tracer.bounded().world.clone().unwrap();
    let all = [
        &world.boxes.planes,
        &world.boxes.quadrics,
        &world.boxes.spheres,
    ];
    assert!(all.iter().all(|boxes| !boxes.is_empty()));
    assert!(
        all.into_iter().flatten().all(Option::is_some),
        "everything here has an end"
    );
    let expected = met(&with_boxes(&world, Boxes::default()));
    assert!(expected.len() > 17_000, "{}", expected.len());
    let hit = |object: usize| expected.iter().filter(|(_, o)| o.contains(&object)).count();
    let hits: Vec<usize> = (0..9).map(hit).collect();
    assert!(hits.iter().all(|hits| *hits > 20), "{hits:?}");
    let found = met(&world);
    // What f64 does not decide of an object need not be asked where its box says that it is passed by.
    assert!(found.len() >= expected.len());
    let found: std::collections::HashMap<usize, Vec<usize>> = found.into_iter().collect();
    for (ray, objects) in &expected {
        assert_eq!(&found[ray], objects, "ray {ray}");
    }

    // Each box must not be smaller than it is by a quarter.
    let shrunk = |bounds: &Option<Bounds>| {
        bounds.map(|b| Bounds {
            min: [0, 1, 2].map(|i| b.min[i] + 0.12 * (b.max[i] - b.min[i])),
            max: [0, 1, 2].map(|i| b.max[i] - 0.12 * (b.max[i] - b.min[i])),
        })
    };
    for kind in 0..3 {
        let mut boxes = Boxes::clone(&world.boxes);
        let shrinks = [&mut boxes.planes, &mut boxes.quadrics, &mut boxes.spheres];
        for (i, boxes) in shrinks.into_iter().enumerate() {
            if i == kind {
                *boxes = boxes.iter().map(shrunk).collect();
            }
        }
        let found = met(&with_boxes(&world, boxes));
        let found: std::collections::HashMap<usize, Vec<usize>> = found.into_iter().collect();
        let wrong = expected
            .iter()
            .filter(|(ray, objects)| found[ray] != *objects)
            .count();
        assert!(wrong > 0, "{kind}");
    }
}

//! Tests of triangles made ready: facts decided exactly, numbers as good as a plane's.

use std::path::Path;

use super::*;
use crate::prepare::Prepared;
use crate::scene::load_from;

fn triangle(vertices: [[f64; 3]; 3]) -> Triangle {
    Triangle {
        vertices: vertices.map(DVec3::from),
        normal: None,
        point: None,
    }
}

/// A needle so thin that f64 cannot have its normal has it all the same, with a bound.
#[test]
fn normals_of_needles_are_known() {
    for thin in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        let t = triangle([[0.1, 0.2, 0.3], [1.1, 1.2, 1.3], [5.1, 5.2, 5.3 + thin]]);
        let n = normal::<Bounded>(&t);
        assert!(is_known(n), "{thin}");
        // Perpendicular to both sides, as far as f64 tells.
        for to in [1, 2] {
            let along = n.dot(edge(&t, 0, to));
            assert!(along.value.abs() <= along.error * 1.1 + 1e-15, "{thin}");
        }
    }
}

#[test]
fn sides_are_told_exactly() {
    let t = triangle([[0.1, 0.1, -1.0], [0.2, 0.2, -2.0], [0.3, 0.1, -5.0]]);
    assert_eq!(side_of(&t, t.vertices[1]), Ordering::Equal);
    // The middle of two vertices that f64 has, and points a hair off.
    let flat = triangle([[0.0, 0.0, -1.0], [4.0, 0.0, -1.0], [0.0, 4.0, -1.0]]);
    assert_eq!(
        side_of(&flat, DVec3::new(1e300, -1e300, -1.0)),
        Ordering::Equal
    );
    let hair = |z: f64| side_of(&flat, DVec3::new(1.0, 1.0, z));
    assert_eq!(hair((-1.0_f64).next_up()), Ordering::Greater);
    assert_eq!(hair((-1.0_f64).next_down()), Ordering::Less);
}

#[test]
fn a_normal_turns_the_front_over() {
    let mut t = triangle([[0.0, 0.0, -1.0], [4.0, 0.0, -1.0], [0.0, 4.0, -1.0]]);
    assert!(!is_turned(&t));
    for (facing, turned) in [([9.0, 9.0, 1e-300], false), ([9.0, -9.0, -1e-300], true)] {
        t.normal = Some(facing.into());
        assert_eq!(is_turned(&t), turned);
        let plane = WorldPlane::<Bounded>::of_triangle(DVec3::Z, &[], 0, 0, &t);
        let z = plane.normal.z.value;
        assert_eq!(z, if turned { -1.0 } else { 1.0 });
    }
}

/// A triangle of a size that f64's squares do not have is still one, or is left to exact numbers; it is not dropped.
#[test]
fn triangles_of_any_size_are_there() {
    for power in [-300, -200, -100, 0, 100, 140] {
        let size = 10_f64.powi(power);
        let text = format!(
            "camera c {{ pixeldim 3 3 worlddim {size:e} {size:e} viewpoint 0 0 {size:e} }}
             material a {{ ambient 1 1 1 }}
             triangle t {{ material a vertex1 -{size:e} -{size:e} -{size:e} vertex2 {size:e} 0 -{size:e} vertex3 0 {size:e} -{size:e} }}
             light l {{ location 0 0 -{size:e} emissivity 1 1 1 }}"
        );
        let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
        let prepared = Prepared::<Bounded>::new(&scene, 0.0);
        assert_eq!(prepared.planes.len(), 1, "{power}");
        let world = prepared.world.unwrap();
        assert_eq!(world.planes[0].lights_on_surface, [0], "{power}");
    }
}

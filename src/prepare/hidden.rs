//! Objects that no ray hits first, whatever the ray: neither tracer is told of them.

use super::triangle::is_before;
use crate::scene::{Extent, Object, Scene, Shape};

/// For each object whether an object that comes before covers all of it, or all of it is before the screen. `groups`
/// has the numbers of their surfaces.
pub fn hidden(scene: &Scene, groups: &[u32], screen_tolerance: f64) -> Vec<bool> {
    let mut covered = vec![false; groups.iter().map(|g| *g as usize + 1).max().unwrap_or(0)];
    let of = |(object, group): (&Object, &u32)| {
        let (before, whole) = match object.shape {
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                // Whatever plane it is on, one of constant z before τ is never hit.
                let facing = normal.x == 0.0 && normal.y == 0.0;
                let whole = match extent {
                    Extent::Unbounded => true,
                    Extent::Rectangle(_) => false,
                };
                (facing && point.z > screen_tolerance, whole)
            }
            Shape::Triangle(ref triangle) => (is_before(triangle, screen_tolerance), false),
            Shape::Sphere { .. } | Shape::Quadric(_) => (false, true),
        };
        let hides = before || covered[*group as usize];
        if whole {
            covered[*group as usize] = true;
        }
        hides
    };
    scene.objects.iter().zip(groups).map(of).collect()
}

//! Which objects lie on the same surface, exactly: such objects share a number.

use std::collections::HashMap;

use dashu_ratio::RBig;
use glam::DVec3;

use super::quadric::Equation;
use super::triangle::exact_normal;
use crate::real::rational::{Ratio, dot, is_zero, ratio3};
use crate::scene::{Beam, Light, Object, ProjectorPicture, Scene, Shape};

/// For each object the number of the surface that it is or is part of: the same for the same set of points. Where equal
/// spheres need not be told, spheres have none in common. Then for each light the number of the plane of its picture;
/// one that no object has, if it has none.
pub fn groups(scene: &Scene, equal_spheres: bool) -> (Vec<u32>, Vec<u32>) {
    let mut groups = Groups::default();
    let of = |object: &Object| match object.shape {
        Shape::Sphere { .. } if !equal_spheres => groups.one_more(),
        Shape::Sphere { .. } | Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => {
            groups.of(&object.shape)
        }
    };
    let objects = scene.objects.iter().map(of).collect();
    let picture = |light: &Light| match light.beam {
        Beam::Picture(ProjectorPicture { normal, point, .. }) => {
            groups.plane(carrier(&ratio3(normal), point))
        }
        Beam::Everywhere | Beam::Cone(_) => u32::MAX,
    };
    (objects, scene.lights.iter().map(picture).collect())
}

/// Numbers for surfaces, the same for the same point set.
#[derive(Debug, Default)]
struct Groups {
    planes: HashMap<[RBig; 4], u32>,
    spheres: HashMap<[u64; 4], u32>,
    count: u32,
}

impl Groups {
    fn of(&mut self, shape: &Shape) -> u32 {
        let new = self.count;
        let group = match *shape {
            Shape::Plane { normal, point, .. } => self.plane(carrier(&ratio3(normal), point)),
            Shape::Triangle(ref triangle) => {
                let normal = exact_normal(triangle);
                self.plane(carrier(&normal, triangle.vertices[0]))
            }
            // Rays that leave a curved one may meet another one of the same equation again.
            Shape::Quadric(_) => match Equation::of(shape).and_then(|equation| equation.plane()) {
                Some((normal, offset)) => self.plane(scaled(&normal, offset)),
                None => new,
            },
            Shape::Sphere { center, radius } => {
                // Adding 0 makes −0 and 0 the same.
                let key =
                    [center.x + 0.0, center.y + 0.0, center.z + 0.0, radius].map(f64::to_bits);
                *self.spheres.entry(key).or_insert(new)
            }
        };
        if group == new {
            self.one_more();
        }
        group
    }

    /// The number of a plane with these numbers, the next one if it is new.
    fn plane(&mut self, carrier: [Ratio; 4]) -> u32 {
        let key = carrier.map(Ratio::canonicalize);
        *self.planes.entry(key).or_insert(self.count)
    }

    /// The number of a surface that nothing shares.
    fn one_more(&mut self) -> u32 {
        self.count += 1;
        self.count - 1
    }
}

/// Numbers that are the same for the same plane, exactly: N over its first component that is
/// not 0, and N·Q over that.
fn carrier(normal: &[Ratio; 3], point: DVec3) -> [Ratio; 4] {
    scaled(normal, dot(normal, &ratio3(point)))
}

/// The same of the plane N·X = offset.
fn scaled(normal: &[Ratio; 3], offset: Ratio) -> [Ratio; 4] {
    let lead = normal.iter().find(|c| !is_zero(c)).cloned();
    let lead = lead.unwrap_or(Ratio::ONE);
    let [x, y, z] = normal.clone().map(|c| c / &lead);
    [x, y, z, offset / lead]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: [f64; 3], point: [f64; 3]) -> Shape {
        Shape::Plane {
            normal: normal.into(),
            point: point.into(),
            extent: crate::scene::Extent::Unbounded,
        }
    }

    fn same_group(a: &Shape, b: &Shape) -> bool {
        let mut groups = Groups::default();
        groups.of(a) == groups.of(b)
    }

    #[test]
    fn coincident_surfaces_share_a_group() {
        let wall = plane([3.0, 0.0, 1.0], [0.0, 0.0, 0.0]);
        assert!(same_group(
            &wall,
            &plane([-6.0, 0.0, -2.0], [1.0, 7.0, -3.0])
        ));
        assert!(!same_group(
            &wall,
            &plane([-6.0, 0.0, -2.0], [1.0, 7.0, -3.0 - 1e-15])
        ));
        assert!(!same_group(
            &wall,
            &plane([3.0, 1e-300, 1.0], [0.0, 0.0, 0.0])
        ));
        let ball = |z: f64| Shape::Sphere {
            center: DVec3::new(0.0, 1.0, z),
            radius: 2.0,
        };
        assert!(same_group(&ball(0.0), &ball(-0.0)));
        assert!(!same_group(&ball(0.0), &ball(f64::MIN_POSITIVE)));
    }
}

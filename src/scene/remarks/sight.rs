//! Objects that no ray from the viewpoint meets: around it, behind it, before the screen, beside what is seen through
//! the screen.

use glam::{DVec2, DVec3};

use super::bounds::{DOUBT, Hull, hull};
use super::{List, Names};
use crate::real::rational::{dot, is_zero, ratio, ratio3, sub};
use crate::scene::{Camera, EntityId, Extent, Object, Scene, Shape};

/// Why an object is not on the picture, in the order in which it is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hidden {
    /// The viewpoint is in it or on it, and a ray that starts there misses it.
    Around,
    /// The viewpoint is in its plane.
    Edgewise,
    /// It is no nearer to the screen than the viewpoint.
    Behind,
    /// It is before the screen, where only spheres are seen.
    Before,
    /// It is beside what is seen through the screen: above, below, left or right of that.
    Above,
    Below,
    Left,
    Right,
}

impl Hidden {
    const ALL: [Self; 8] = [
        Self::Around,
        Self::Edgewise,
        Self::Behind,
        Self::Before,
        Self::Above,
        Self::Below,
        Self::Left,
        Self::Right,
    ];

    fn told(self, list: &List, names: &Names<'_>, tolerance: f64) -> String {
        let these = names.typed_list(list);
        let verb = |one, several| list.verb(one, several);
        let it = verb("it", "them");
        match self {
            Self::Around => format!(
                "the viewpoint is inside {these}: a ray that starts in a sphere does not meet {it}"
            ),
            Self::Edgewise => {
                format!("the viewpoint lies in the plane of {these}: no ray from there meets {it}")
            }
            Self::Behind => format!(
                "{these} {} behind the viewpoint, and not on the picture",
                verb("lies", "lie")
            ),
            Self::Before => format!(
                "{these} {} before the screen, and not on the picture: all but spheres is seen only where z ≤ {}",
                verb("lies", "lie"),
                tolerance + 0.0
            ),
            Self::Above | Self::Below | Self::Left | Self::Right => {
                let side = match self {
                    Self::Above => "above",
                    Self::Below => "below",
                    Self::Left => "to the left of",
                    _ => "to the right of",
                };
                format!(
                    "{these} {} {side} what is seen through the screen, and not on the picture",
                    verb("lies", "lie")
                )
            }
        }
    }
}

/// Tells of objects that are not on the picture.
pub(super) fn remarks(scene: &Scene, tolerance: f64, names: &Names<'_>, found: &mut Vec<String>) {
    let sight = Sight::new(&scene.camera, tolerance);
    // Mirrors show what the viewpoint does not see; they count where there is a light.
    let mirrors = !scene.lights.is_empty()
        && scene
            .objects
            .iter()
            .any(|object| scene.materials[object.material].specular != DVec3::ZERO);
    let mut lists: [List; Hidden::ALL.len()] = Default::default();
    for (i, object) in scene.objects.iter().enumerate() {
        let Some(hidden) = sight.hidden(object) else {
            continue;
        };
        let anywhere = matches!(hidden, Hidden::Before | Hidden::Around);
        if mirrors && !anywhere {
            continue;
        }
        lists[hidden as usize].push(EntityId::Object(i));
    }
    for (hidden, list) in Hidden::ALL.into_iter().zip(&lists) {
        if !list.is_empty() {
            found.push(hidden.told(list, names, tolerance));
        }
    }
}

/// What is seen: the viewpoint, and the screen as far as samples go.
struct Sight {
    viewpoint: DVec3,
    least: DVec2,
    most: DVec2,
    tolerance: f64,
}

impl Sight {
    fn new(camera: &Camera, tolerance: f64) -> Self {
        // Several samples go half a pixel beyond the middles of the outermost pixels, which lie on the edges.
        let pixels = camera.pixeldim.map(|n| f64::from(n.max(2) - 1));
        let half = 0.5 * camera.worlddim / DVec2::from_array(pixels);
        Self {
            viewpoint: camera.viewpoint,
            least: -half,
            most: camera.worlddim + half,
            tolerance,
        }
    }

    /// Why no ray from the viewpoint meets an object; none where one may.
    fn hidden(&self, object: &Object) -> Option<Hidden> {
        let viewpoint = self.viewpoint;
        match &object.shape {
            Shape::Sphere { center, radius } => {
                if self.is_around(*center, *radius) {
                    return Some(Hidden::Around);
                }
            }
            Shape::Plane {
                normal,
                point,
                extent,
            } => {
                if is_in_plane(viewpoint, *normal, *point) {
                    return Some(Hidden::Edgewise);
                }
                if *extent == Extent::Unbounded {
                    return self.plane_hidden(*normal, *point);
                }
            }
            Shape::Triangle(_) | Shape::Quadric(_) => {}
        }
        let hull = hull(object)?;
        self.hull_hidden(&hull)
    }

    fn hull_hidden(&self, hull: &Hull) -> Option<Hidden> {
        let Self {
            viewpoint: from,
            least,
            most,
            ..
        } = *self;
        if hull.is_beyond(from, DVec3::NEG_Z) {
            return Some(Hidden::Behind);
        }
        if hull.least_z().is_some_and(|z| z > self.tolerance) {
            return Some(Hidden::Before);
        }
        // Planes through the viewpoint and an edge of the screen; what is seen is on the side that these point to.
        let sides = [
            (Hidden::Above, DVec3::new(0.0, -from.z, from.y - most.y)),
            (Hidden::Below, DVec3::new(0.0, from.z, least.y - from.y)),
            (Hidden::Left, DVec3::new(from.z, 0.0, least.x - from.x)),
            (Hidden::Right, DVec3::new(-from.z, 0.0, from.x - most.x)),
        ];
        let beyond = |(_, inward): &(Hidden, DVec3)| hull.is_beyond(from, *inward);
        sides.into_iter().find(beyond).map(|(hidden, _)| hidden)
    }

    /// The same of a plane without end. 1/s, with the viewpoint at s = 0 and the screen at s = 1, is linear over the
    /// screen, so its corners tell of all of it.
    fn plane_hidden(&self, normal: DVec3, point: DVec3) -> Option<Hidden> {
        let normal = normal / normal.abs().max_element();
        let far = (point - self.viewpoint).dot(normal);
        let rounded = DOUBT * (point.abs() + self.viewpoint.abs()).dot(normal.abs());
        if far.abs() <= rounded {
            return None;
        }
        // H.z = (1 − s) V.z ≤ τ where 1/s ≤ this.
        let most = if self.tolerance < self.viewpoint.z {
            self.viewpoint.z / (self.viewpoint.z - self.tolerance)
        } else {
            f64::INFINITY
        };
        let corners = [self.least.x, self.most.x].into_iter().flat_map(|x| {
            [self.least.y, self.most.y].map(|y| DVec3::new(x, y, 0.0) - self.viewpoint)
        });
        let (mut behind, mut before) = (true, true);
        for way in corners {
            let inverse = way.dot(normal) / far;
            let sizes = (way.abs() + self.viewpoint.abs()).dot(normal.abs());
            let doubt = (DOUBT * sizes + inverse.abs() * rounded) / far.abs();
            behind &= inverse < -doubt;
            before &= inverse - doubt > most * (1.0 + DOUBT);
        }
        if behind {
            Some(Hidden::Behind)
        } else {
            before.then_some(Hidden::Before)
        }
    }

    /// Whether the viewpoint is in a sphere or on it.
    fn is_around(&self, center: DVec3, radius: f64) -> bool {
        is_in_ball(self.viewpoint, center, radius, true)
    }
}

/// Whether a point lies in a plane, decided exactly.
fn is_in_plane(at: DVec3, normal: DVec3, point: DVec3) -> bool {
    let scaled = normal / normal.abs().max_element();
    let rounded = DOUBT * (point.abs() + at.abs()).dot(scaled.abs());
    if (point - at).dot(scaled).abs() > rounded {
        return false;
    }
    let way = sub(&ratio3(point), &ratio3(at));
    is_zero(&dot(&ratio3(normal), &way))
}

/// Whether a point is in a ball, decided exactly; or on it, if that counts.
pub(super) fn is_in_ball(point: DVec3, center: DVec3, radius: f64, surface: bool) -> bool {
    // There may be a million of them, and nearly all are far away: farther along one axis than rounding explains.
    let apart = (point - center).abs().max_element();
    if apart > radius * (1.0 + DOUBT) {
        return false;
    }
    let way = sub(&ratio3(point), &ratio3(center));
    let (square, radius) = (dot(&way, &way), ratio(radius));
    let radius = &radius * &radius;
    square < radius || surface && square == radius
}

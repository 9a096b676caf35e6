//! Handles on the picture for what is selected: the places that its attributes say, and a sphere's radius, each to be
//! dragged with the mouse. Where they are and what a drag makes of them; no window is needed.
//!
//! A place is dragged parallel to the screen, so that it stays under the mouse; with Shift to the screen and away from
//! it. A radius is where the ray under the mouse touches the sphere.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Stroke};
use glam::{DVec2, DVec3};

use super::session::Session;
use super::values;
use crate::edit::{Target, Value};
use crate::scene::{self, EntityId, Quantity};

/// A handle is hit within so many points.
const REACH: f64 = 10.0;

/// How the world is seen through the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    viewpoint: DVec3,
    worlddim: DVec2,
    /// Columns and rows of the picture.
    size: DVec2,
}

/// What a handle does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// It is a place.
    Place(DVec3),
    /// It is at the edge of a sphere with this center.
    Radius(DVec3),
}

/// A handle. Places of the picture are columns from the left and rows from the top, with fractions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Handle {
    /// What it changes.
    pub(super) target: Target,
    kind: Kind,
    /// Where it is.
    pub(super) at: [f64; 2],
}

/// A handle that the mouse has hold of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grabbed {
    /// As it was when it was grabbed.
    handle: Handle,
    /// From the mouse to it.
    offset: [f64; 2],
    /// Entities have other indices if this is not the session's any more.
    generation: u64,
}

impl View {
    /// That of a session, with its changes.
    pub(super) fn of(session: &Session) -> Option<Self> {
        let (scene, changes) = session.wanted()?;
        let mut camera = scene.camera.clone();
        let number = |name| changes.get(Target::new(EntityId::Camera, name));
        if let Some([x, y, z]) = number("viewpoint").as_ref().map(Value::numbers) {
            camera.viewpoint = DVec3::new(*x, *y, *z);
        }
        if let Some([x, y]) = number("worlddim").as_ref().map(Value::numbers) {
            camera.worlddim = DVec2::new(*x, *y);
        }
        let mut size = camera.pixeldim.map(f64::from);
        if let Some([columns, rows]) = number("pixeldim").as_ref().map(Value::numbers) {
            size = [*columns, *rows];
        }
        Some(Self {
            viewpoint: camera.viewpoint,
            worlddim: camera.worlddim,
            size: size.into(),
        })
    }

    /// World units from a pixel to the next, on the screen.
    fn step(&self) -> DVec2 {
        self.worlddim / (self.size - 1.0).max(DVec2::ONE)
    }

    /// Where a place of the world is seen; nothing where it is not before the viewpoint.
    fn project(&self, place: DVec3) -> Option<[f64; 2]> {
        let ahead = self.viewpoint.z - place.z;
        if ahead <= 0.0 {
            return None;
        }
        let on_screen = self.viewpoint + (place - self.viewpoint) * (self.viewpoint.z / ahead);
        let pixel = on_screen.truncate() / self.step();
        let at = [pixel.x + 0.5, self.size.y - 0.5 - pixel.y];
        at.iter().all(|at| at.is_finite()).then_some(at)
    }

    /// The direction of the ray through a place of the picture.
    fn ray(&self, [column, row]: [f64; 2]) -> DVec3 {
        let pixel = DVec2::new(column - 0.5, self.size.y - 0.5 - row);
        (pixel * self.step()).extend(0.0) - self.viewpoint
    }

    /// The place with this z that is seen at a place of the picture.
    fn place(&self, at: [f64; 2], z: f64) -> DVec3 {
        let ray = self.ray(at);
        let place = self.viewpoint + ray * ((self.viewpoint.z - z) / self.viewpoint.z);
        place.with_z(z)
    }

    /// Where a ray touches a sphere, on its right side as it is seen; nothing where none does.
    fn touch(&self, center: DVec3, radius: f64) -> Option<[f64; 2]> {
        let to_center = center - self.viewpoint;
        let sine = radius / to_center.length();
        let ahead = to_center.normalize();
        let aside = (DVec3::X - ahead * ahead.x).normalize();
        if sine.is_nan() || sine >= 1.0 || aside.is_nan() {
            return None;
        }
        let ray = ahead * (1.0 - sine * sine).sqrt() + aside * sine;
        self.project(self.viewpoint + ray * to_center.length())
    }

    /// How far a place is from the ray through a place of the picture.
    fn distance(&self, place: DVec3, at: [f64; 2]) -> f64 {
        let ray = self.ray(at).normalize();
        (place - self.viewpoint).cross(ray).length()
    }
}

/// The handles of what is selected, as the session has it.
pub(super) fn of(session: &Session, entity: Option<EntityId>) -> Vec<Handle> {
    let (Some(entity), Some(view), Some((scene, _))) =
        (entity, View::of(session), session.wanted())
    else {
        return Vec::new();
    };
    let mut handles = Vec::new();
    if entity == EntityId::Camera {
        return handles;
    }
    for row in scene::number_rows(scene, entity) {
        let target = Target::new(entity, row.name());
        let place = |target| session.value(target).and_then(|value| value.vector());
        let found = match row.quantity() {
            Quantity::Place => place(target).map(|place| (Kind::Place(place), view.project(place))),
            _ if row.name() == "radius" => {
                let center = place(Target::new(entity, "center"));
                center.zip(session.value(target)).map(|(center, radius)| {
                    let at = view.touch(center, radius.numbers()[0]);
                    (Kind::Radius(center), at)
                })
            }
            _ => None,
        };
        if let Some((kind, Some(at))) = found {
            handles.push(Handle { target, kind, at });
        }
    }
    handles
}

/// The handle that is hit at a place of the picture, of which `zoom` points of the window are a pixel.
pub(super) fn hit(handles: &[Handle], at: [f64; 2], zoom: f64) -> Option<Handle> {
    let distance = |handle: &Handle| {
        let [x, y] = [0, 1].map(|i| handle.at[i] - at[i]);
        zoom * x.hypot(y)
    };
    let near = handles.iter().filter(|handle| distance(handle) <= REACH);
    near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .copied()
}

impl Grabbed {
    /// Takes hold of a handle with the mouse at this place of the picture.
    pub(super) fn new(handle: Handle, at: [f64; 2], session: &Session) -> Self {
        Self {
            handle,
            offset: [0, 1].map(|i| handle.at[i] - at[i]),
            generation: session.generation,
        }
    }

    /// What it changes.
    pub(super) fn target(&self) -> Target {
        self.handle.target
    }

    /// The value with the mouse at this place of the picture, in numbers that a person would write; with `depth` along
    /// z. Nothing where that is none.
    pub(super) fn value(&self, session: &Session, mouse: [f64; 2], depth: bool) -> Option<Value> {
        if self.generation != session.generation {
            return None;
        }
        let view = View::of(session)?;
        let at = [0, 1].map(|i| mouse[i] + self.offset[i]);
        let unit = view.worlddim.x;
        let neat = |number: f64| values::neat(number, unit);
        let numbers = match self.handle.kind {
            Kind::Radius(center) => {
                let radius = neat(view.distance(center, at));
                return (radius > 0.0 && radius.is_finite()).then(|| radius.into());
            }
            Kind::Place(place) if depth => {
                // Up is away. As much as the same way aside.
                let scale = view.step().y * (view.viewpoint.z - place.z) / view.viewpoint.z;
                let z = place.z + scale * (at[1] - self.handle.at[1]);
                place.with_z(neat(z)).to_array()
            }
            Kind::Place(place) => {
                let to = view.place(at, place.z);
                [neat(to.x), neat(to.y), place.z]
            }
        };
        numbers
            .iter()
            .all(|number| number.is_finite())
            .then(|| numbers.into())
    }
}

/// Draws handles; `to_window` is where in the window a place of the picture is. The one that is hit or grabbed says its
/// name.
pub(super) fn draw(
    painter: &Painter,
    handles: &[Handle],
    to_window: impl Fn([f64; 2]) -> Pos2,
    active: Option<Target>,
) {
    let (dark, light) = (Color32::from_black_alpha(200), Color32::WHITE);
    let named = |name: &str| {
        let mut found = handles
            .iter()
            .filter(|handle| handle.target.attribute() == name);
        found.next().map(|handle| to_window(handle.at))
    };
    // From a light to what it is aimed at, from a center to the edge.
    for (from, to) in [("location", "point"), ("center", "radius")] {
        if let (Some(from), Some(to)) = (named(from), named(to)) {
            painter.line_segment([from, to], Stroke::new(3.0, dark));
            painter.line_segment([from, to], Stroke::new(1.0, light));
        }
    }
    for handle in handles {
        let at = to_window(handle.at);
        let is_active = active == Some(handle.target);
        let fill = if is_active {
            Color32::from_rgb(255, 140, 0)
        } else {
            light
        };
        painter.circle(at, 5.0, fill, Stroke::new(2.0, dark));
        if is_active {
            let name = handle.target.attribute();
            let font = FontId::proportional(13.0);
            let beside = at + eframe::egui::vec2(9.0, -7.0);
            let text = painter.layout_no_wrap(name.to_owned(), font, light);
            let rect = Align2::LEFT_BOTTOM.anchor_size(beside, text.size());
            painter.rect_filled(rect.expand(2.0), 2.0, dark);
            painter.galley(rect.min, text, light);
        }
    }
}

#[cfg(test)]
mod tests;

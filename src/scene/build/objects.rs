//! Objects and lights of a scene built in code: what a [`SceneBuilder`] can add, one method an entity type.

use glam::{DVec2, DVec3};

use super::{MaterialId, SceneBuilder, TextureId, named};
use crate::scene::draft::Draft;
use crate::scene::kind::{Class, EntityKind, LightClass};
use crate::scene::model::TextureMode;

impl SceneBuilder {
    /// Adds a plane: its normal (not 0) and a point on it.
    pub fn plane(
        &mut self,
        name: &str,
        material: MaterialId,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
    ) -> &mut Self {
        let draft = plane(name, material, normal, point);
        self.add(EntityKind::Object(Class::Plane), draft)
    }

    /// Adds a sphere: its center and radius (> 0).
    pub fn sphere(
        &mut self,
        name: &str,
        material: MaterialId,
        center: impl Into<DVec3>,
        radius: f64,
    ) -> &mut Self {
        let draft = sphere(name, material, center, radius);
        self.add(EntityKind::Object(Class::Sphere), draft)
    }

    /// Adds a plane with tiles of two materials: the size of a tile (> 0), and the direction of its first side (not
    /// parallel to the normal), if tiles do not follow world x and z.
    #[expect(clippy::too_many_arguments, reason = "one a line of the scene file")]
    pub fn tiled_plane(
        &mut self,
        name: &str,
        material: MaterialId,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
        altmaterial: MaterialId,
        dimension: impl Into<DVec2>,
        xdir: Option<DVec3>,
    ) -> &mut Self {
        let mut draft = plane(name, material, normal, point);
        draft.altmaterial = altmaterial.0;
        draft.dimension = dimension.into().to_array();
        draft.xdir = xdir.map(|xdir| xdir.to_array());
        self.add(EntityKind::Object(Class::Tiled), draft)
    }

    /// Adds a plane with a procedural shader, below [`PPLANE_SHADERS`](crate::scene::table::PPLANE_SHADERS).
    pub fn pplane(
        &mut self,
        name: &str,
        material: MaterialId,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
        shader: u32,
    ) -> &mut Self {
        let draft = Draft {
            shader: [f64::from(shader)],
            ..plane(name, material, normal, point)
        };
        self.add(EntityKind::Object(Class::ProceduralPlane), draft)
    }

    /// Adds a sphere with a procedural shader, below [`PSPHERE_SHADERS`](crate::scene::table::PSPHERE_SHADERS).
    pub fn psphere(
        &mut self,
        name: &str,
        material: MaterialId,
        center: impl Into<DVec3>,
        radius: f64,
        shader: u32,
    ) -> &mut Self {
        let draft = Draft {
            shader: [f64::from(shader)],
            ..sphere(name, material, center, radius)
        };
        self.add(EntityKind::Object(Class::ProceduralSphere), draft)
    }

    /// Adds a rectangle with a corner at `point`: the direction of its first side (not parallel to the normal) and the
    /// lengths of its sides (> 0).
    pub fn fplane(
        &mut self,
        name: &str,
        material: MaterialId,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
        xdir: impl Into<DVec3>,
        dimensions: impl Into<DVec2>,
    ) -> &mut Self {
        let draft = finite(plane(name, material, normal, point), xdir, dimensions);
        self.add(EntityKind::Object(Class::Finite), draft)
    }

    /// Adds a rectangle with a picture on it.
    #[expect(clippy::too_many_arguments, reason = "one a line of the scene file")]
    pub fn texplane(
        &mut self,
        name: &str,
        material: MaterialId,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
        xdir: impl Into<DVec3>,
        dimensions: impl Into<DVec2>,
        texture: TextureId,
        mode: TextureMode,
    ) -> &mut Self {
        let mut draft = finite(plane(name, material, normal, point), xdir, dimensions);
        draft.set_texture(texture.0, mode);
        self.add(EntityKind::Object(Class::Textured), draft)
    }

    /// Adds a light: where it is, and how bright (≥ 0).
    pub fn light(
        &mut self,
        name: &str,
        location: impl Into<DVec3>,
        emissivity: impl Into<DVec3>,
    ) -> &mut Self {
        let draft = light(name, location, emissivity);
        self.add(EntityKind::Light(LightClass::Light), draft)
    }

    /// Adds a spotlight: a light with a cone towards `point` (not its location), of half angle `theta` in degrees
    /// (0 < theta ≤ 180).
    pub fn spotlight(
        &mut self,
        name: &str,
        location: impl Into<DVec3>,
        emissivity: impl Into<DVec3>,
        point: impl Into<DVec3>,
        theta: f64,
    ) -> &mut Self {
        let point = point.into().to_array();
        let draft = Draft {
            point,
            theta: [theta],
            ..light(name, location, emissivity)
        };
        self.add(EntityKind::Light(LightClass::Spotlight), draft)
    }

    /// Adds a projector: a light that comes through the rectangle of a texplane alone, with its colours.
    #[expect(clippy::too_many_arguments, reason = "one a line of the scene file")]
    pub fn projector(
        &mut self,
        name: &str,
        location: impl Into<DVec3>,
        emissivity: impl Into<DVec3>,
        normal: impl Into<DVec3>,
        point: impl Into<DVec3>,
        xdir: impl Into<DVec3>,
        dimensions: impl Into<DVec2>,
        texture: TextureId,
        mode: TextureMode,
    ) -> &mut Self {
        let Draft {
            location,
            emissivity,
            ..
        } = light(name, location, emissivity);
        let mut draft = finite(plane(name, MaterialId(0), normal, point), xdir, dimensions);
        (draft.location, draft.emissivity) = (location, emissivity);
        draft.set_texture(texture.0, mode);
        self.add(EntityKind::Light(LightClass::Projector), draft)
    }

    /// Adds a triangle: its vertices (not in a line), and a direction to the side that is its front (not in its plane),
    /// if that is not (v2 − v1) × (v3 − v1).
    pub fn triangle(
        &mut self,
        name: &str,
        material: MaterialId,
        vertices: [DVec3; 3],
        normal: Option<DVec3>,
    ) -> &mut Self {
        let draft = Draft {
            material: material.0,
            vertices: vertices.map(|vertex| vertex.to_array()),
            facing: normal.map(|normal| normal.to_array()),
            ..named(name)
        };
        self.add(EntityKind::Object(Class::Triangle), draft)
    }
}

fn plane(
    name: &str,
    material: MaterialId,
    normal: impl Into<DVec3>,
    point: impl Into<DVec3>,
) -> Draft {
    Draft {
        material: material.0,
        normal: normal.into().to_array(),
        point: point.into().to_array(),
        ..named(name)
    }
}

fn sphere(name: &str, material: MaterialId, center: impl Into<DVec3>, radius: f64) -> Draft {
    Draft {
        material: material.0,
        center: center.into().to_array(),
        radius: [radius],
        ..named(name)
    }
}

fn finite(plane: Draft, xdir: impl Into<DVec3>, dimensions: impl Into<DVec2>) -> Draft {
    Draft {
        xdir: Some(xdir.into().to_array()),
        dimension: dimensions.into().to_array(),
        ..plane
    }
}

fn light(name: &str, location: impl Into<DVec3>, emissivity: impl Into<DVec3>) -> Draft {
    Draft {
        location: location.into().to_array(),
        emissivity: emissivity.into().to_array(),
        ..named(name)
    }
}

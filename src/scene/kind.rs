//! The kinds of entities: what `table` has a row list for, and `draft` makes a part of the model of.

/// The entity types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EntityKind {
    /// The viewpoint and the screen.
    Camera,
    /// How a surface answers light.
    Material,
    /// A picture to lay on a `texplane`.
    Texture,
    /// A visible object.
    Object(Class),
    /// A light.
    Light(LightClass),
}

/// The classes of lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LightClass {
    /// `light`
    Light,
    /// `spotlight`
    Spotlight,
    /// `projector`
    Projector,
}

/// The classes of visible objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// `plane`
    Plane,
    /// `tiled_plane`
    Tiled,
    /// `pplane`
    ProceduralPlane,
    /// `fplane`
    Finite,
    /// `texplane`
    Textured,
    /// `sphere`
    Sphere,
    /// `psphere`
    ProceduralSphere,
    /// `triangle`
    Triangle,
    /// `ptriangle`
    ProceduralTriangle,
    /// `quadric`
    Quadric,
    /// `pquadric`
    ProceduralQuadric,
}

impl EntityKind {
    /// The entity type in the file.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Material => "material",
            Self::Texture => "texture",
            Self::Light(class) => match class {
                LightClass::Light => "light",
                LightClass::Spotlight => "spotlight",
                LightClass::Projector => "projector",
            },
            Self::Object(class) => match class {
                Class::Plane => "plane",
                Class::Tiled => "tiled_plane",
                Class::ProceduralPlane => "pplane",
                Class::Finite => "fplane",
                Class::Textured => "texplane",
                Class::Sphere => "sphere",
                Class::ProceduralSphere => "psphere",
                Class::Triangle => "triangle",
                Class::ProceduralTriangle => "ptriangle",
                Class::Quadric => "quadric",
                Class::ProceduralQuadric => "pquadric",
            },
        }
    }
}

//! The kinds of surface that the shader tells apart: their codes in [`Object::kind`](super::records::Object::kind), and
//! the WGSL of what each does to the ambient reflectivity.

use crate::procedural::{Family, Shader};

/// What modulates an object's material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SurfaceKind {
    /// Nothing.
    Plain,
    /// A `tiled_plane`.
    Tiled,
    /// A `texplane`.
    Textured,
    /// A `pplane` with this shader.
    Pplane(u32),
    /// A `psphere` with this shader.
    Psphere(u32),
}

impl SurfaceKind {
    /// The low byte of `Object::kind`: families of up to 64 shaders each.
    pub fn code(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Tiled => 1,
            Self::Textured => 2,
            Self::Pplane(shader) => 64 + shader,
            Self::Psphere(shader) => 128 + shader,
        }
    }

    /// The name of the code in WGSL.
    pub fn name(self) -> String {
        match self {
            Self::Plain => "KIND_PLAIN".into(),
            Self::Tiled => "KIND_TILED".into(),
            Self::Pplane(shader) => format!("KIND_PPLANE_{shader}"),
            Self::Psphere(shader) => format!("KIND_PSPHERE_{shader}"),
            Self::Textured => "KIND_TEXTURED".into(),
        }
    }

    /// Its number in a family of procedural shaders, if it is of that.
    pub fn shader_of(self, of: Family) -> Option<u32> {
        match (self, of) {
            (Self::Pplane(shader), Family::Pplane) | (Self::Psphere(shader), Family::Psphere) => {
                Some(shader)
            }
            (
                Self::Pplane(_) | Self::Psphere(_) | Self::Plain | Self::Tiled | Self::Textured,
                _,
            ) => None,
        }
    }

    /// The procedural shader, if it is one.
    pub fn shader(self) -> Option<&'static Shader> {
        [Family::Pplane, Family::Psphere]
            .into_iter()
            .find_map(|family| family.shaders().get(self.shader_of(family)? as usize))
    }

    /// The brightest channel that it makes of an ambient reflectivity with this brightest channel. (Of a tiled plane's
    /// other material too, which counts as a material of its own.)
    pub fn brightest(self, ambient: f64) -> f64 {
        match self {
            // A texel is at most 255/256.
            Self::Plain | Self::Tiled | Self::Textured => ambient,
            Self::Pplane(_) | Self::Psphere(_) => self
                .shader()
                .map_or(f64::INFINITY, |shader| (shader.brightest)(ambient)),
        }
    }

    /// Whether `getamb` has to look at it; in lit scenes a tile's material is found before.
    pub fn modulates_ambient(self, lit: bool) -> bool {
        match self {
            Self::Plain => false,
            Self::Tiled => !lit,
            Self::Textured | Self::Pplane(_) | Self::Psphere(_) => true,
        }
    }

    /// Its case in `getamb` of `shaders/surface.wgsl`, which has made `shade.color` the material's ambient
    /// reflectivity.
    pub fn ambient_case(self, lit: bool, certified: bool) -> Option<String> {
        if !self.modulates_ambient(lit) {
            return None;
        }
        let call = |point: &str| {
            let function = self.shader().map_or("", |shader| shader.name);
            format!("return {function}({point});")
        };
        let does = match self {
            Self::Plain => return None,
            Self::Tiled => "let plane = tiled_planes[record];
            shade.color = select(plane.altmaterial, shade.color, tplane_foreground(plane, point));"
                .into(),
            Self::Textured => "shade.color *= texel(texplanes[record], point);".into(),
            Self::Pplane(_) => call("PlanePoint(point, shade.color, pplanes[record])"),
            Self::Psphere(_) if certified => {
                call("SpherePoint(point.from_center, point.from_center_error, shade.color)")
            }
            Self::Psphere(_) => call("SpherePoint(point.from_center, 0.0, shade.color)"),
        };
        Some(format!(
            "        case {}: {{\n            {does}\n        }}\n",
            self.name()
        ))
    }
}

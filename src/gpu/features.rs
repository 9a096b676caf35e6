//! What a scene needs of the shader: the names that `//#if` in `shaders/` asks for, and nothing else.

use std::collections::BTreeSet;

use super::pack::{Kind, Packed};

/// Which parts of the shader a scene needs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FeatureSet {
    /// There are planes.
    pub planes: bool,
    /// Some plane crosses the screen, so that the z > τ rule decides pixels.
    pub front: bool,
    /// There are spheres seen small.
    pub small_spheres: bool,
    /// The small spheres are many and have a tree.
    pub bvh: bool,
    /// There are other spheres.
    pub wide_spheres: bool,
    /// Objects stand in the text of the shader, not in buffers.
    pub unrolled: bool,
    /// The kinds of surface.
    pub kinds: BTreeSet<Kind>,
    /// The unquantised values are wanted too.
    pub values: bool,
}

/// Scenes of up to this many objects stand in the text of the shader: loads are what costs on a CPU's driver, and
/// compiling costs about a millisecond an object.
pub const UNROLLED_OBJECTS: usize = 32;

impl FeatureSet {
    /// The features of a packed scene.
    pub fn new(packed: &Packed, values: bool) -> Self {
        Self {
            planes: !packed.planes.is_empty(),
            front: packed.planes.iter().any(|p| p.front != [0.0; 3]),
            small_spheres: !packed.small_spheres.is_empty(),
            bvh: !packed.bvh.is_empty(),
            wide_spheres: !packed.wide_spheres.is_empty(),
            unrolled: (1..=UNROLLED_OBJECTS).contains(&packed.tested()),
            kinds: packed.kinds.iter().copied().collect(),
            values,
        }
    }

    /// Whether a ray can hit anything at all.
    pub fn any_object(&self) -> bool {
        self.planes || self.small_spheres || self.wide_spheres
    }

    /// Numbers of the `pplane` shaders used.
    pub fn pplanes(&self) -> BTreeSet<u32> {
        self.numbers(|kind| if let Kind::Pplane(shader) = kind { Some(shader) } else { None })
    }

    /// Numbers of the `psphere` shaders used on small or wide spheres.
    pub fn pspheres(&self) -> BTreeSet<u32> {
        self.numbers(|kind| match kind {
            Kind::SmallPsphere(shader) | Kind::WidePsphere(shader) => Some(shader),
            _ => None,
        })
    }

    fn numbers(&self, number: impl Fn(Kind) -> Option<u32>) -> BTreeSet<u32> {
        self.kinds.iter().copied().filter_map(number).collect()
    }

    /// The names that hold, for `//#if`.
    pub fn names(&self) -> BTreeSet<&'static str> {
        let small_point = self.kinds.iter().any(|k| matches!(k, Kind::SmallPsphere(_)));
        let wide_point = self.kinds.iter().any(|k| matches!(k, Kind::WidePsphere(_)));
        [
            ("any_object", self.any_object()),
            ("objects", self.any_object()),
            ("plane", self.planes),
            ("front", self.front),
            ("plane_loop", self.planes && !self.unrolled),
            ("small_sphere", self.small_spheres),
            ("small_sphere_loop", self.small_spheres && !self.unrolled && !self.bvh),
            ("bvh", self.bvh),
            ("small_sphere_buffer", self.small_spheres && (!self.unrolled || small_point)),
            ("small_sphere_point", small_point),
            ("wide_sphere", self.wide_spheres),
            ("wide_sphere_loop", self.wide_spheres && !self.unrolled),
            ("wide_sphere_buffer", self.wide_spheres && (!self.unrolled || wide_point)),
            ("wide_sphere_point", wide_point),
            // Where objects do not come in the order of the file.
            ("mixed", self.bvh || [self.planes, self.small_spheres, self.wide_spheres].iter().filter(|x| **x).count() > 1),
            ("modulated", self.kinds.iter().any(|k| *k != Kind::Plain)),
            ("tiled", self.kinds.contains(&Kind::Tiled)),
            ("pplane", !self.pplanes().is_empty()),
            ("psphere", !self.pspheres().is_empty()),
            ("values", self.values),
        ]
        .into_iter()
        .filter_map(|(name, holds)| holds.then_some(name))
        .collect()
    }
}

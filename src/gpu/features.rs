//! What a scene needs of the shader: the names that `//#if` in `shaders/` asks for, and nothing else.

use std::collections::BTreeSet;

use super::pack::{Kind, Packed};
use crate::prepare::exact::two_to;
use crate::settings::{Settings, Spread};

/// Which parts of the shader a scene needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FeatureSet {
    /// There are planes without end.
    pub planes: bool,
    /// There are rectangles that primary rays can hit.
    pub rectangles: bool,
    /// Some plane crosses the screen, so that the z > τ rule decides pixels.
    pub front: bool,
    /// There are spheres that primary rays can hit.
    pub spheres: bool,
    /// They are many, in tiles of the screen.
    pub tiles: bool,
    /// Some objects share a surface.
    pub groups: bool,
    /// There are tables of indices along columns and rows.
    pub tables: bool,
    /// Pixels come with a verdict.
    pub certified: bool,
    /// Spheres of a lit scene are many and have a tree.
    pub bvh: bool,
    /// Objects stand in the text of the shader, not in buffers.
    pub unrolled: bool,
    /// An invocation makes four pixels side by side: of scenes so simple that storing is what costs.
    pub quad: bool,
    /// The camera and all objects stand in buffers, so that another viewpoint is not another shader.
    pub moving: bool,
    /// The kinds of surface.
    pub kinds: BTreeSet<Kind>,
    /// The unquantised values are wanted too.
    pub values: bool,
    /// Rays a pixel.
    pub samples: u32,
    /// The samples are spread as the course's program did.
    pub course: bool,
    /// Invocations that share a driver's limit on loops; 1 where there is none.
    pub lanes: u32,
    /// There are lights.
    pub lit: Option<LitFeatures>,
}

/// What a lit scene needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LitFeatures {
    /// Some object is a mirror.
    pub mirror: bool,
    /// Some object lets light through.
    pub clear: bool,
    /// Some object glints.
    pub glint: bool,
    /// Some light is a spotlight.
    pub cone: bool,
    /// Some light lies in a plane or on a sphere.
    pub level: bool,
    /// There are planes, of either kind.
    pub planes: bool,
    /// There are rectangles.
    pub rectangles: bool,
    /// There are spheres.
    pub spheres: bool,
    /// Some of them are outside the tree.
    pub loose_spheres: bool,
    /// Longest path, in units of 2^scale.
    pub max_path: f32,
    /// Most rays of a sample.
    pub max_rays: u32,
}

/// Scenes of up to this many objects stand in the text of the shader: loads are what costs on a CPU's driver, and
/// compiling costs about a millisecond an object.
pub const UNROLLED_OBJECTS: usize = 32;

/// Of pixels with more samples than this no record is left, as it would be too long: if one sample is in doubt, the CPU
/// computes all.
pub const MOST_PARTIAL: u32 = 1024;

/// Words of such a record before the bits of its samples: place, three sums, three errors.
pub const PARTIAL_HEAD: u32 = 7;

/// Pixels that an invocation makes where it makes several.
pub const QUAD: u32 = 4;

/// Scenes of up to this many objects have several pixels an invocation, fast and certified: beyond, storing is not what
/// costs, and the registers are missed (docs/BENCH.md).
const QUAD_OBJECTS: [usize; 2] = [8, 4];

impl FeatureSet {
    /// The features of a packed scene, rendered as the settings say, on a device where `lanes` invocations share a limit on
    /// loops (see [`Gpu::lanes`](super::device::Gpu::lanes)).
    pub fn new(packed: &Packed, settings: &Settings, lanes: u32) -> Self {
        let objects = packed
            .lit
            .as_ref()
            .map_or(packed.tested(), |lit| lit.planes.len() + lit.spheres.len());
        let fronts = packed
            .planes
            .iter()
            .map(|p| p.front)
            .chain(packed.rectangles.iter().map(|r| r.front));
        let certified = settings.has_gpu_bounds();
        let several = settings.supersampling();
        Self {
            planes: !packed.planes.is_empty(),
            rectangles: !packed.rectangles.is_empty(),
            front: fronts.into_iter().any(|front| front != [0.0, 0.0, 1.0]),
            spheres: !packed.spheres.is_empty(),
            tiles: packed.tiles.is_some(),
            groups: packed.planes.iter().any(|p| p.group != 0)
                || packed.rectangles.iter().any(|r| r.group != 0),
            tables: !packed.tables.words.is_empty(),
            certified,
            bvh: !packed.bvh.is_empty(),
            unrolled: packed.tiles.is_none() && (1..=UNROLLED_OBJECTS).contains(&objects),
            quad: packed.tiles.is_none()
                && packed.lit.is_none()
                && (1..=QUAD_OBJECTS[usize::from(certified)]).contains(&objects)
                && several.is_none()
                && !settings.values,
            moving: false,
            kinds: packed.kinds.iter().copied().collect(),
            values: settings.values,
            samples: settings.samples,
            course: several.is_some_and(|several| several.spread == Spread::Course),
            lanes,
            lit: packed.lit.as_ref().map(|lit| LitFeatures {
                mirror: lit.mirror,
                clear: lit.clear,
                glint: lit.glint,
                cone: lit.lights.iter().any(|light| light.cosine >= -1.0),
                level: lit.planes.iter().any(|plane| plane.level != 0)
                    || lit.spheres.iter().any(|sphere| sphere.level != 0),
                planes: !lit.planes.is_empty(),
                rectangles: lit.planes.iter().any(|plane| plane.bounded != 0),
                spheres: !lit.spheres.is_empty(),
                loose_spheres: lit.in_tree < lit.spheres.len(),
                max_path: (settings.limits.max_path * two_to(-packed.scale)) as f32,
                max_rays: settings.limits.max_rays,
            }),
        }
    }

    /// The same with as little of the scene's numbers in the text as may be: for pictures of which each is a little different
    /// from the one before. Not for certified ones, whose bounds are in the text.
    #[must_use]
    pub fn while_moving(self) -> Self {
        Self {
            unrolled: false,
            moving: true,
            ..self
        }
    }

    /// Whether a ray can hit anything at all.
    pub fn any_object(&self) -> bool {
        self.planes || self.rectangles || self.spheres
    }

    /// Words of a record that the shader leaves of a pixel of which only some samples are sure; 0 where it leaves none.
    pub fn partial_words(&self) -> u32 {
        let some = self.any_object() && self.certified;
        if some && (2..=MOST_PARTIAL).contains(&self.samples) {
            PARTIAL_HEAD + self.samples.div_ceil(32)
        } else {
            0
        }
    }

    /// Numbers of the `pplane` shaders used.
    pub fn pplanes(&self) -> BTreeSet<u32> {
        self.numbers(|kind| {
            if let Kind::Pplane(shader) = kind {
                Some(shader)
            } else {
                None
            }
        })
    }

    /// Numbers of the `psphere` shaders used.
    pub fn pspheres(&self) -> BTreeSet<u32> {
        self.numbers(|kind| match kind {
            Kind::Psphere(shader) => Some(shader),
            _ => None,
        })
    }

    fn numbers(&self, number: impl Fn(Kind) -> Option<u32>) -> BTreeSet<u32> {
        self.kinds.iter().copied().filter_map(number).collect()
    }

    /// The names that hold, for `//#if`.
    pub fn names(&self) -> BTreeSet<&'static str> {
        // Without anything to hit no surface is looked at.
        let any = self.any_object();
        let tiled = any && self.kinds.contains(&Kind::Tiled);
        let textured = any && self.kinds.contains(&Kind::Textured);
        let pplane = any && !self.pplanes().is_empty();
        let psphere = any && !self.pspheres().is_empty();
        // Without anything to hit there is nothing to light.
        let is_lit = any && self.lit.is_some();
        let lit = self.lit.filter(|_| any).unwrap_or_default();
        let certified = any && self.certified;
        let bvh = is_lit && self.bvh;
        // In a lit scene with a tree, hits on spheres are looked at as those of rays from anywhere are.
        let sphere_point = self.spheres && if is_lit { !bvh } else { psphere };
        let loops = !self.unrolled;
        let kinds_of_shape = [self.planes, self.rectangles, self.spheres];
        [
            ("any_object", any),
            ("ambient_only", any && !is_lit),
            ("plane", self.planes),
            ("rectangle", self.rectangles),
            ("front", self.front),
            ("plane_loop", self.planes && loops),
            ("rectangle_loop", self.rectangles && loops),
            ("sphere", self.spheres),
            ("tiles", self.spheres && self.tiles),
            ("sphere_loop", self.spheres && loops && !self.tiles),
            ("sphere_buffer", self.spheres && (loops || sphere_point)),
            ("sphere_point", sphere_point),
            // Spheres hit by rays from elsewhere, or as by such.
            (
                "sphere_beyond",
                lit.spheres && (lit.mirror || lit.clear || bvh),
            ),
            ("bvh", bvh),
            // Where the error of a hit goes on into positions.
            (
                "first_order",
                certified && !is_lit && (tiled || textured || pplane || psphere),
            ),
            ("certified", certified),
            ("moving", any && self.moving),
            (
                "barrier",
                is_lit || pplane || psphere || (certified && self.spheres),
            ),
            ("groups", self.groups && certified),
            ("tables", certified && self.tables),
            ("index", certified && (tiled || textured || pplane)),
            (
                "doubtful",
                certified && (is_lit || tiled || textured || pplane || psphere),
            ),
            // Where objects do not come in the order of the file.
            (
                "mixed",
                self.tiles || kinds_of_shape.iter().filter(|shape| **shape).count() > 1,
            ),
            (
                "modulated",
                self.kinds
                    .iter()
                    .any(|k| *k != Kind::Plain && (!is_lit || *k != Kind::Tiled)),
            ),
            ("tiled", tiled),
            ("tiled_ambient", tiled && !is_lit),
            ("textured", textured),
            ("pplane", pplane),
            ("psphere", psphere),
            ("position", is_lit || tiled || textured || pplane),
            ("from_center", psphere || lit.spheres),
            ("quad", any && self.quad),
            ("values", self.values),
            ("samples", any && self.samples > 1),
            ("partial", self.partial_words() > 0),
            ("course", any && self.course),
            ("counted", any && (is_lit || self.tiles || self.samples > 1)),
            ("lit", is_lit),
            ("lit_sphere", lit.spheres),
            ("lit_plane", lit.planes),
            ("world_planes", lit.planes),
            (
                "world_spheres",
                lit.spheres && (loops || lit.mirror || lit.clear || bvh),
            ),
            ("mirror", lit.mirror),
            ("clear", lit.clear),
            ("branches", lit.mirror || lit.clear),
            ("stack", lit.mirror && lit.clear),
            ("any_hit", is_lit && !lit.clear),
            ("glint", lit.glint),
            ("cone", lit.cone),
            ("level", lit.level),
            ("rectangle_anywhere", lit.rectangles),
            (
                "world_loop",
                is_lit && loops && (lit.planes || lit.loose_spheres),
            ),
            ("world_plane_loop", is_lit && loops && lit.planes),
            ("world_sphere_loop", is_lit && loops && lit.loose_spheres),
        ]
        .into_iter()
        .filter_map(|(name, holds)| holds.then_some(name))
        .collect()
    }
}

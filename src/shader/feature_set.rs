//! What a packed scene needs of the shader, and which features follow from that.

mod conditions;

use std::collections::BTreeSet;

use super::kind::SurfaceKind;
use super::pack::Packed;
use crate::procedural::{self, Family, Shader};
use crate::real::rational::two_to;
use crate::settings::{SamplePattern, Settings};

/// Which parts of the shader a scene needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FeatureSet {
    /// There are planes without end.
    pub planes: bool,
    /// There are rectangles or triangles that primary rays can hit.
    pub polygons: bool,
    /// Some plane crosses the screen, so that the z > τ rule decides pixels.
    pub front: bool,
    /// There are spheres that primary rays can hit.
    pub spheres: bool,
    /// There are quadrics.
    pub quadrics: bool,
    /// There are so many spheres that they are in cells of the screen.
    pub screen_grid: bool,
    /// Some objects share a surface.
    pub groups: bool,
    /// There are tables of indices along columns and rows.
    pub tables: bool,
    /// Pixels come with a verdict.
    pub certified: bool,
    /// Spheres of a lit scene are many and have a tree.
    pub sphere_tree: bool,
    /// Triangles of a lit scene are many and have a tree.
    pub triangle_tree: bool,
    /// There are triangles in the cells of the screen.
    pub grid_triangles: bool,
    /// There are rectangles or triangles that are in no cell.
    pub loose_polygons: bool,
    /// Objects stand in the text of the shader, not in buffers.
    pub unrolled: bool,
    /// An invocation makes four pixels side by side: of scenes so simple that storing is what costs.
    pub quad: bool,
    /// The camera and all objects stand in buffers, so that another viewpoint is not another shader.
    pub moving: bool,
    /// The kinds of surface.
    pub kinds: BTreeSet<SurfaceKind>,
    /// The unquantised values are wanted too.
    pub values: bool,
    /// Pixels are stored as a picture's file has them, unless their values are wanted (see
    /// [`Form`](super::form::Form)).
    pub packed: bool,
    /// Rays a pixel.
    pub samples: u32,
    /// The samples are spread as the course's program did.
    pub course: bool,
    /// Invocations that share a driver's limit on loops; 1 where there is none.
    pub lanes: u32,
    /// Pixels in doubt are listed, for a shader with f64, where that can be.
    pub listed: bool,
    /// Numbers are f64: the shader takes its pixels from such a list.
    pub double: bool,
    /// There are lights.
    pub lit: Option<LitFeatures>,
}

/// What a lit scene needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LitFeatures {
    /// Some object is a mirror.
    pub mirror: bool,
    /// Some object lets light through.
    pub transparent: bool,
    /// Some object glints.
    pub glint: bool,
    /// Some light is a spotlight.
    pub cone: bool,
    /// Some light is a projector.
    pub projectors: bool,
    /// Some light lies in a plane or on a sphere.
    pub lights_on_surface: bool,
    /// Some light is next to a plane.
    pub low_light: bool,
    /// There are planes, of any kind.
    pub planes: bool,
    /// Some of them are outside the tree.
    pub loose_planes: bool,
    /// There are rectangles or triangles.
    pub sides: bool,
    /// There are triangles.
    pub triangles: bool,
    /// There are spheres.
    pub spheres: bool,
    /// Some of them are outside the tree.
    pub loose_spheres: bool,
    /// Longest path, in units of 2^scale.
    pub max_path: f64,
    /// Most rays of a sample.
    pub max_rays: u32,
}

/// Scenes of up to this many objects stand in the text of the shader: loads are what costs on a CPU's driver, and
/// compiling costs about a millisecond an object.
pub const UNROLLED_OBJECTS: usize = 32;

/// Of pixels with more samples than this no record is left, as it would be too long: if one sample is in doubt, the CPU
/// computes all.
pub const MOST_PARTIAL: u32 = 1024;

/// Words of a record of a pixel in doubt: place, and what becomes of it in f64.
pub const LISTED_WORDS: u32 = 2;

/// Words of a record of a pixel of several samples before the bits of these: three sums and three errors more.
pub const RECORD_HEAD: u32 = LISTED_WORDS + 6;

/// Pixels that an invocation makes where it makes several.
pub const QUAD: u32 = 4;

/// Scenes of up to this many objects have several pixels an invocation, fast and certified: beyond, storing is not what
/// costs, and the registers are missed (docs/BENCH.md).
const QUAD_OBJECTS: [usize; 2] = [8, 4];

/// Lanes of a software driver's vectors, 256 bits wide as a rule.
pub const SOFTWARE_LANES: u32 = 8;

impl FeatureSet {
    /// The features of a packed scene, rendered as the settings say, on a device where `lanes` invocations share a
    /// limit on loops (see [`Gpu::lanes`](crate::gpu::device::Gpu::lanes)).
    pub fn new(packed: &Packed, settings: &Settings, lanes: u32) -> Self {
        let objects = packed.lit.as_ref().map_or(packed.tested(), |lit| {
            lit.planes.len() + lit.spheres.len() + packed.quadrics.len()
        });
        let fronts = packed
            .planes
            .iter()
            .map(|p| p.front)
            .chain(packed.polygons.iter().map(|r| r.front));
        let certified = settings.has_gpu_bounds();
        let several = settings.supersampling();
        Self {
            planes: !packed.planes.is_empty(),
            polygons: !packed.polygons.is_empty(),
            front: fronts.into_iter().any(|front| front != [0.0, 0.0, 1.0]),
            spheres: !packed.spheres.is_empty(),
            quadrics: !packed.quadrics.is_empty(),
            screen_grid: packed.screen_grid.is_some(),
            groups: packed.planes.iter().any(|p| p.group != 0)
                || packed.polygons.iter().any(|r| r.group != 0),
            tables: !packed.tables.words.is_empty(),
            certified,
            sphere_tree: packed.lit.as_ref().is_some_and(|lit| lit.in_tree > 0),
            triangle_tree: packed.triangle_root.is_some(),
            grid_triangles: packed.grid_polygons > 0,
            loose_polygons: packed.loose_polygons() > 0,
            unrolled: packed.screen_grid.is_none() && (1..=UNROLLED_OBJECTS).contains(&objects),
            quad: packed.screen_grid.is_none()
                && packed.lit.is_none()
                && (1..=QUAD_OBJECTS[usize::from(certified)]).contains(&objects)
                && several.is_none()
                && !settings.values,
            moving: false,
            kinds: packed.kinds.iter().copied().collect(),
            values: settings.values,
            packed: false,
            samples: settings.samples,
            course: several.is_some_and(|several| several.spread == SamplePattern::Course),
            lanes,
            listed: false,
            double: false,
            lit: packed.lit.as_ref().map(|lit| LitFeatures {
                mirror: lit.mirror,
                transparent: lit.transparent,
                glint: lit.glint,
                cone: lit.lights.iter().any(|light| light.cosine >= -1.0),
                projectors: !lit.projectors.is_empty(),
                lights_on_surface: lit.planes.iter().any(|plane| plane.lights_on_surface != 0)
                    || lit
                        .spheres
                        .iter()
                        .any(|sphere| sphere.lights_on_surface != 0)
                    || packed.quadrics.iter().any(|q| q.lights_on_surface != 0),
                low_light: lit.planes.iter().any(|plane| plane.height != 0.0),
                planes: !lit.planes.is_empty(),
                loose_planes: lit.loose_planes > 0,
                sides: lit.planes.iter().any(|plane| plane.bounded != 0),
                triangles: !lit.third_sides.is_empty(),
                spheres: !lit.spheres.is_empty(),
                loose_spheres: lit.in_tree < lit.spheres.len(),
                max_path: settings.limits.max_path * two_to(-packed.scale),
                max_rays: settings.limits.max_rays,
            }),
        }
    }

    /// The same with as little of the scene's numbers in the text as may be: for pictures of which each is a little
    /// different from the one before. Not for certified ones, whose bounds are in the text.
    #[must_use]
    pub fn while_moving(self) -> Self {
        Self {
            unrolled: false,
            moving: true,
            ..self
        }
    }

    /// The same for a picture that goes into a file, not onto a canvas. Where invocations make one pixel each, packing
    /// them takes a barrier: nothing on a GPU, but up to a third of the kernel's time on a software driver, which
    /// would spare the same processor less.
    #[must_use]
    pub fn for_a_file(self, software: bool) -> Self {
        Self {
            packed: self.quad || !software,
            ..self
        }
    }

    /// The same that lists the pixels that it leaves in doubt, for a shader with f64.
    #[must_use]
    pub fn with_a_list(self) -> Self {
        Self {
            listed: true,
            ..self
        }
    }

    /// The shader with f64 that takes its pixels from the list of such a one.
    #[must_use]
    pub fn for_the_list(self) -> Self {
        Self {
            double: true,
            ..self
        }
    }

    /// Whether pixels in doubt are listed: not where four pixels go into a vector of words, nor where offsets of
    /// samples are handed over, which are f32.
    pub fn is_listed(&self) -> bool {
        self.listed
            && self.certified
            && self.any_object()
            && (self.samples <= 1 || self.partial_words() > 0 && !self.course)
            && !self.values
            && (self.packed || !self.quad)
    }

    /// Words of a record of a pixel; 0 where there are none.
    pub fn record_words(&self) -> u32 {
        match self.partial_words() {
            0 if self.is_listed() => LISTED_WORDS,
            words => words,
        }
    }

    /// Whether a ray can hit anything at all.
    pub fn any_object(&self) -> bool {
        self.planes || self.polygons || self.spheres || self.quadrics
    }

    /// Words of a record that the shader leaves of a pixel of which only some samples are sure; 0 where it leaves none.
    pub fn partial_words(&self) -> u32 {
        let some = self.any_object() && self.certified && !self.values;
        if some && (2..=MOST_PARTIAL).contains(&self.samples) {
            RECORD_HEAD + self.samples.div_ceil(32)
        } else {
            0
        }
    }

    /// The procedural shaders used, and those that they call: planes' before spheres'.
    pub fn procedural(&self) -> Vec<&'static Shader> {
        let used = |family: Family| {
            let numbers = self.kinds.iter().filter_map(|kind| kind.shader_of(family));
            procedural::with_called(family, numbers.collect())
        };
        [used(Family::Pplane), used(Family::Psphere)].concat()
    }
}

//! The features of the shader: what `//#if name` in `shaders/` may ask for.

use std::collections::BTreeSet;

macro_rules! features {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// Something that a scene may need of the shader.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Feature {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Feature {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// Its name in `shaders/`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }
        }
    };
}

features! {
    /// A ray can hit something; without that no surface is looked at.
    AnyObject = "any_object",
    /// There is something, and no light.
    AmbientOnly = "ambient_only",
    /// Primary rays can hit planes without end.
    Plane = "plane",
    /// Primary rays can hit rectangles or triangles.
    Polygon = "polygon",
    /// The z ≤ τ rule decides pixels.
    Front = "front",
    /// Planes stand in a buffer.
    PlaneLoop = "plane_loop",
    /// Some of them stand in a buffer and are asked one after the other.
    PolygonLoop = "polygon_loop",
    /// Primary rays can hit spheres.
    Sphere = "sphere",
    /// Spheres or triangles are many, in cells of the screen.
    ScreenGrid = "screen_grid",
    /// There are spheres among them.
    GridSpheres = "grid_spheres",
    /// There are triangles among them.
    GridTriangles = "grid_triangles",
    /// Spheres stand in a buffer and are asked one by one.
    SphereLoop = "sphere_loop",
    /// Spheres stand in a buffer.
    SphereBuffer = "sphere_buffer",
    /// There are quadrics.
    Quadric = "quadric",
    /// Quadrics stand in a buffer.
    QuadricBuffer = "quadric_buffer",
    /// Quadrics stand in a buffer and are asked one by one.
    QuadricLoop = "quadric_loop",
    /// There are quadrics, and lights.
    LitQuadric = "lit_quadric",
    /// Where a primary ray hits a sphere is looked at.
    SpherePoint = "sphere_point",
    /// Spheres are hit by rays from elsewhere, or looked at as if by such.
    SphereBeyond = "sphere_beyond",
    /// Spheres or triangles of a lit scene have a tree.
    Bvh = "bvh",
    /// There is one over spheres.
    SphereTree = "sphere_tree",
    /// There is one over triangles.
    TriangleTree = "triangle_tree",
    /// Of surfaces that several objects share not all come in the order of the file, to rays from anywhere.
    Unordered = "unordered",
    /// The error of a hit goes on into positions.
    FirstOrder = "first_order",
    /// Pixels come with a verdict.
    Certified = "certified",
    /// The camera stands in a buffer.
    Moving = "moving",
    /// Numbers are f64.
    Double = "double",
    /// Sums are protected from being simplified away.
    Barrier = "barrier",
    /// Some objects share a surface, and which of them is hit is certified.
    Groups = "groups",
    /// There are tables of indices along columns and rows.
    Tables = "tables",
    /// Indices of tiles, blocks or texels are certified.
    Index = "index",
    /// Indices are certified: those, or those of texels that projectors throw.
    SureIndex = "sure_index",
    /// A decision that the colour depends on may be in doubt.
    Doubtful = "doubtful",
    /// Objects do not come in the order of the file.
    Mixed = "mixed",
    /// Some surface modulates its ambient reflectivity.
    Modulated = "modulated",
    /// There are tiled planes.
    Tiled = "tiled",
    /// There are planes with procedural shaders.
    Pplane = "pplane",
    /// There are spheres with procedural shaders.
    Psphere = "psphere",
    /// There are rectangles with pictures.
    Textured = "textured",
    /// There are pictures, on rectangles or projected.
    Texels = "texels",
    /// Where something is hit matters.
    Position = "position",
    /// Where a sphere is hit, from its center, matters.
    FromCenter = "from_center",
    /// An invocation makes four pixels.
    Quad = "quad",
    /// The unquantised values are wanted.
    Values = "values",
    /// Pixels are stored as a picture's file has them, their verdicts behind them.
    Packed = "packed",
    /// There are several samples a pixel.
    Samples = "samples",
    /// Pixels with sure and doubtful samples leave a record.
    Partial = "partial",
    /// Pixels in doubt leave a record for f64.
    Listed = "listed",
    /// Pixels of some kind leave records.
    Records = "records",
    /// Samples are spread as the course's program did.
    Course = "course",
    /// Iterations of loops are counted.
    Counted = "counted",
    /// There are lights.
    Lit = "lit",
    /// There are spheres, and lights.
    LitSphere = "lit_sphere",
    /// There are planes of either kind for rays from anywhere.
    WorldPlanes = "world_planes",
    /// There is a buffer of spheres for rays from anywhere.
    WorldSpheres = "world_spheres",
    /// Something is a mirror.
    Mirror = "mirror",
    /// Something lets light through.
    Transparent = "transparent",
    /// Rays go on from where they hit.
    Branches = "branches",
    /// Rays go on two ways.
    Stack = "stack",
    /// Shadow rays ask only whether something stands in their way.
    AnyHit = "any_hit",
    /// Something glints.
    Glint = "glint",
    /// There are spotlights.
    Cone = "cone",
    /// There are projectors.
    Projector = "projector",
    /// Some light lies in a plane or on a sphere.
    LightsOnSurface = "lights_on_surface",
    /// Some light is so near to a plane that its height above it is told.
    LowLight = "low_light",
    /// Rays from anywhere can hit rectangles or triangles.
    SidesAnywhere = "sides_anywhere",
    /// Rays from anywhere can hit triangles.
    TriangleAnywhere = "triangle_anywhere",
    /// Rays from anywhere go through a loop.
    WorldLoop = "world_loop",
    /// Rays from anywhere go through planes in a loop.
    WorldPlaneLoop = "world_plane_loop",
    /// Rays from anywhere go through spheres in a loop.
    WorldSphereLoop = "world_sphere_loop",
    /// A procedural shader calls `color_wheel`.
    ColorWheel = "color_wheel",
    /// A procedural shader calls `pplane_odd`.
    PplaneOdd = "pplane_odd",
    /// A procedural shader calls `pplane_from_point`.
    PplaneFromPoint = "pplane_from_point",
    /// Something asks for parities.
    Odd = "odd",
    /// Something asks for whole numbers.
    Whole = "whole",
}

impl Feature {
    /// The feature of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|feature| feature.name() == name)
    }
}

/// The features that hold.
pub type Features = BTreeSet<Feature>;

//! Which features follow from what a scene needs.

use super::{FeatureSet, LitFeatures};
use crate::shader::feature::{Feature, Features};
use crate::shader::kind::SurfaceKind;

impl FeatureSet {
    /// What `//#if` in `shaders/` finds to hold.
    pub fn features(&self) -> Features {
        let holds = Conditions::new(self);
        Feature::ALL
            .iter()
            .copied()
            .filter(|feature| holds.feature(*feature))
            .collect()
    }
}

/// A feature set, and what several features ask of it.
struct Conditions<'a> {
    set: &'a FeatureSet,
    /// A ray can hit something.
    any: bool,
    lit: bool,
    /// What lights need; nothing without lights.
    light: LitFeatures,
    certified: bool,
    sphere_tree: bool,
    triangle_tree: bool,
    /// Objects stand in buffers.
    loops: bool,
    tiled: bool,
    textured: bool,
    pplane: bool,
    psphere: bool,
}

impl<'a> Conditions<'a> {
    fn new(set: &'a FeatureSet) -> Self {
        let any = set.any_object();
        // Without anything to hit there is nothing to light.
        let lit = any && set.lit.is_some();
        Self {
            set,
            any,
            lit,
            light: set.lit.filter(|_| any).unwrap_or_default(),
            certified: any && set.certified,
            sphere_tree: lit && set.sphere_tree,
            triangle_tree: lit && set.triangle_tree,
            loops: !set.unrolled,
            tiled: any && set.kinds.contains(&SurfaceKind::Tiled),
            textured: any && set.kinds.contains(&SurfaceKind::Textured),
            pplane: any
                && set
                    .kinds
                    .iter()
                    .any(|kind| matches!(kind, SurfaceKind::Pplane(_))),
            psphere: any
                && set
                    .kinds
                    .iter()
                    .any(|kind| matches!(kind, SurfaceKind::Psphere(_))),
        }
    }

    fn feature(&self, feature: Feature) -> bool {
        let Self {
            set,
            any,
            lit,
            light,
            certified,
            sphere_tree,
            triangle_tree,
            loops,
            tiled,
            textured,
            pplane,
            psphere,
        } = *self;
        match feature {
            Feature::AnyObject => any,
            Feature::AmbientOnly => any && !lit,
            Feature::Plane => set.planes,
            Feature::Polygon => set.polygons,
            Feature::Front => set.front,
            Feature::PlaneLoop => set.planes && loops,
            Feature::PolygonLoop => set.loose_polygons && loops,
            Feature::Sphere => set.spheres,
            Feature::Quadric => set.quadrics,
            Feature::QuadricBuffer => set.quadrics && (lit || loops),
            Feature::QuadricLoop => set.quadrics && loops,
            Feature::LitQuadric => set.quadrics && lit,
            Feature::ScreenGrid => (set.spheres || set.grid_triangles) && set.screen_grid,
            Feature::GridSpheres => set.spheres && set.screen_grid,
            Feature::GridTriangles => set.grid_triangles,
            Feature::SphereLoop => set.spheres && loops && !set.screen_grid,
            Feature::SphereBuffer => set.spheres && (loops || self.feature(Feature::SpherePoint)),
            // In a lit scene with a tree, hits on spheres are looked at as those of rays from anywhere are.
            Feature::SpherePoint => set.spheres && if lit { !sphere_tree } else { psphere },
            Feature::SphereBeyond => {
                light.spheres && (light.mirror || light.transparent || sphere_tree)
            }
            Feature::Bvh => sphere_tree || triangle_tree,
            Feature::SphereTree => sphere_tree,
            Feature::TriangleTree => triangle_tree,
            // Quadrics come behind planes, and may be flat.
            Feature::Unordered => triangle_tree || (set.quadrics && light.planes),
            Feature::FirstOrder => certified && !lit && (tiled || textured || pplane || psphere),
            Feature::Certified => certified,
            Feature::Moving => any && set.moving,
            Feature::Barrier => {
                lit || pplane
                    || psphere
                    || set.quadrics
                    || (certified && (set.spheres || tiled || textured))
            }
            Feature::Groups => set.groups && certified,
            Feature::Tables => certified && set.tables,
            Feature::Index => certified && (tiled || textured || pplane),
            Feature::SureIndex => certified && (tiled || textured || pplane || light.projectors),
            Feature::Doubtful => certified && (lit || tiled || textured || pplane || psphere),
            Feature::Mixed => {
                let shapes = [set.planes, set.polygons, set.spheres, set.quadrics];
                set.screen_grid || shapes.iter().filter(|shape| **shape).count() > 1
            }
            Feature::Modulated => set.kinds.iter().any(|kind| kind.modulates_ambient(lit)),
            Feature::Tiled => tiled,
            Feature::Pplane => pplane,
            Feature::Psphere => psphere,
            Feature::Textured => textured,
            Feature::Texels => textured || light.projectors,
            Feature::Position => lit || tiled || textured || pplane,
            Feature::FromCenter => psphere || light.spheres,
            Feature::Quad => any && set.quad,
            Feature::Values => set.values,
            Feature::Packed => set.packed && !set.values,
            Feature::Samples => any && set.samples > 1,
            Feature::Partial => set.partial_words() > 0,
            Feature::Listed => set.is_listed(),
            Feature::Records => set.record_words() > 0,
            Feature::Double => any && set.double,
            Feature::Course => any && set.course,
            Feature::Counted => any && (lit || set.screen_grid || set.samples > 1),
            Feature::Lit => lit,
            Feature::LitSphere => light.spheres,
            Feature::WorldPlanes => light.planes,
            Feature::WorldSpheres => {
                light.spheres && (loops || light.mirror || light.transparent || sphere_tree)
            }
            Feature::Mirror => light.mirror,
            Feature::Transparent => light.transparent,
            Feature::Branches => light.mirror || light.transparent,
            Feature::Stack => light.mirror && light.transparent,
            Feature::AnyHit => lit && !light.transparent,
            Feature::Glint => light.glint,
            Feature::Cone => light.cone,
            Feature::Projector => light.projectors,
            Feature::LightsOnSurface => light.lights_on_surface,
            Feature::LowLight => light.low_light,
            Feature::SidesAnywhere => light.sides,
            Feature::TriangleAnywhere => light.triangles,
            Feature::WorldLoop => {
                lit && loops && (light.loose_planes || light.loose_spheres || set.quadrics)
            }
            Feature::WorldPlaneLoop => lit && loops && light.loose_planes,
            Feature::WorldSphereLoop => lit && loops && light.loose_spheres,
            // A helper comes in where a chosen shader names it, or another helper does.
            Feature::ColorWheel => self.asks("color_wheel("),
            Feature::PplaneOdd => self.asks("pplane_odd("),
            Feature::PplaneFromPoint => self.asks("pplane_from_point("),
            Feature::Odd => tiled || self.asks("pplane_odd("),
            Feature::Whole => tiled || textured || light.projectors || self.asks("pplane_odd("),
        }
    }

    /// Whether a procedural shader in use names `helper`.
    fn asks(&self, helper: &str) -> bool {
        self.any
            && self
                .set
                .procedural()
                .iter()
                .any(|shader| shader.wgsl.contains(helper))
    }
}

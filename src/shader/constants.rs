//! The constants that the shader's text refers to by name: the camera, counts, limits, and what error bounds need.

use super::bounds;
use super::feature::{Feature, Features};
use super::feature_set::{FeatureSet, RECORD_HEAD};
use super::form;
use super::format::Format;
use super::kind::SurfaceKind;
use super::pack::Packed;
use super::record::Record as _;

/// Side of the square workgroup: 16×16 or 256×1 were a fifth faster than 8×8 on lavapipe.
pub const WORKGROUP: u32 = 16;

/// Pixels of a list that a workgroup takes.
pub const LIST_GROUP: u32 = 64;

/// lavapipe ends every loop, without a word, once the loops of an invocation have gone round 65,535 times together; and
/// counts for all invocations that are lanes of one vector, as long as any of them goes round.
const LOOP_LIMIT: usize = 65_535;

/// Most iterations of the loops outside the screen grid, for one primary ray. The shader counts those of the others.
pub const LOOP_ITERATIONS: usize = LOOP_LIMIT / 2;

/// Most rays that wait while another is followed; a pixel that needs more is handed to the CPU.
const STACK: usize = 8;

/// Of a pixel that the GPU does not decide, samples off by more than this (255 is a full byte) are left to the CPU too:
/// what they leave open would cost all others. Tried from 1/1000 to 1: around 1/8 the CPU has the fewest samples to
/// compute.
pub const FINE: f32 = 0.125;

/// The numbers that the text refers to by name.
pub(super) fn constants<F: Format>(
    packed: &Packed<F>,
    set: &FeatureSet,
    features: &Features,
) -> String {
    let mut lines = vec![format!("const WORKGROUP = {WORKGROUP};")];
    if features.contains(&Feature::AnyObject) {
        if !features.contains(&Feature::Moving) {
            lines.extend(camera(packed, features));
        }
        lines.extend(error_constants(packed, features));
    }
    lines.extend(counts(packed, set, features));
    if let (Some(lit), true) = (set.lit, features.contains(&Feature::Branches)) {
        lines.push(format!("const MAX_PATH = {};", F::literal(lit.max_path)));
        lines.push(format!("const MAX_RAYS = {}u;", lit.max_rays));
    }
    for kind in set.kinds.iter().filter(|kind| **kind != SurfaceKind::Plain) {
        lines.push(format!("const {} = {}u;", kind.name(), kind.code()));
    }
    if features.contains(&Feature::Partial) {
        lines.push(format!("const FINE = {};", F::literal(FINE.into())));
    }
    if features.contains(&Feature::Samples) {
        // Not quotients, as a driver may divide f64 when the shader runs.
        let samples = f64::from(set.samples);
        let error = F::round_up(bounds::SAMPLE_GROWTH / samples);
        lines.extend([
            format!("const SAMPLE_SHARE = {};", F::literal(1.0 / samples)),
            format!("const SAMPLE_ERROR = {};", F::literal(error)),
        ]);
    }
    lines.join("\n") + "\n"
}

/// The camera, where it does not move.
fn camera<F: Format>(packed: &Packed<F>, features: &Features) -> Vec<String> {
    let numbers = packed.camera.numbers.literals().into_iter();
    numbers
        // Lengths in world units matter to lights only.
        .filter(|(name, _)| *name != "unit" || features.contains(&Feature::Lit))
        .map(|(name, value)| format!("const CAMERA_{} = {value};", name.to_uppercase()))
        .collect()
}

/// How many there are of what, and how many rounds their loops take.
fn counts<F: Format>(packed: &Packed<F>, set: &FeatureSet, features: &Features) -> Vec<String> {
    let has = |feature: Feature| features.contains(&feature);
    let mut counts = vec![
        (Feature::PlaneLoop, "PLANES", packed.planes.len()),
        (Feature::PolygonLoop, "POLYGONS", packed.loose_polygons()),
        (Feature::SphereLoop, "SPHERES", packed.spheres.len()),
        (Feature::GridTriangles, "GRID_SPHERES", packed.spheres.len()),
        (
            Feature::GridTriangles,
            "LOOSE_POLYGONS",
            packed.loose_polygons(),
        ),
        (
            Feature::TriangleTree,
            "TRIANGLE_ROOT",
            packed.triangle_root.unwrap_or(0),
        ),
        (Feature::QuadricLoop, "QUADRICS", packed.quadrics.len()),
        (Feature::Tables, "TABLES", packed.objects.len()),
        (Feature::Tables, "COLUMNS", packed.tables.columns as usize),
        (Feature::Bvh, "BVH_DEPTH", packed.bvh_depth),
        (Feature::Samples, "SAMPLES", set.samples as usize),
    ];
    if let Some(screen_grid) = &packed.screen_grid {
        counts.extend([
            (
                Feature::ScreenGrid,
                "CELL_WIDTH",
                screen_grid.sides[0] as usize,
            ),
            (
                Feature::ScreenGrid,
                "CELL_HEIGHT",
                screen_grid.sides[1] as usize,
            ),
            (
                Feature::ScreenGrid,
                "GRID_COLUMNS",
                screen_grid.count[0] as usize,
            ),
        ]);
    }
    let words = set.partial_words();
    // Where lanes trace several samples, each may take longest with another one.
    let apart = if set.samples > 1 { set.lanes } else { 1 } as usize;
    // Each of up to five loops takes one more iteration, which only finds its end. Lanes go round together, but where
    // they trace the samples that are missing.
    let primary_steps = (packed.loop_iterations() + 5) * if set.double { apart } else { 1 };
    counts.extend([
        (Feature::Packed, "PACKED_GROUP", form::GROUP as usize),
        (Feature::Packed, "PACKED_WORDS", form::GROUP_WORDS as usize),
        (
            Feature::Records,
            "RECORD_WORDS",
            set.record_words() as usize,
        ),
        (Feature::Listed, "LIST_GROUP", LIST_GROUP as usize),
        (
            Feature::Partial,
            "SUMMED_WORDS",
            words.saturating_sub(RECORD_HEAD) as usize,
        ),
        (Feature::Partial, "RECORD_HEAD", RECORD_HEAD as usize),
        (Feature::Counted, "LANES", set.lanes as usize),
        (
            Feature::Counted,
            "PRIMARY_STEPS",
            if set.unrolled { 0 } else { primary_steps },
        ),
    ]);
    if let Some(lit) = &packed.lit {
        // Each of three loops takes one more iteration, which only finds its end.
        let steps = lit.loop_iterations() + packed.quadrics.len() + 3;
        let in_shadows = has(Feature::WorldLoop) && has(Feature::AnyHit);
        counts.extend([
            (Feature::Lit, "APART", apart),
            (Feature::Lit, "LIGHTS", lit.lights.len()),
            (Feature::WorldLoop, "WORLD_STEPS", steps),
            (
                Feature::Lit,
                "SHADOW_STEPS",
                if in_shadows { steps } else { 0 },
            ),
            (
                Feature::TriangleAnywhere,
                "THIRD_SIDES",
                lit.objects.len() + packed.tables.words.len(),
            ),
            (Feature::WorldPlaneLoop, "WORLD_PLANES", lit.loose_planes),
            (Feature::WorldSphereLoop, "WORLD_TREE", lit.in_tree),
            (Feature::WorldSphereLoop, "WORLD_SPHERES", lit.spheres.len()),
            (Feature::Stack, "STACK", STACK),
        ]);
    }
    let counts = counts.into_iter().filter(|(feature, ..)| has(*feature));
    counts
        .map(|(_, name, value)| format!("const {name} = {value}u;"))
        .collect()
}

/// What the error bounds in the shader refer to by name.
fn error_constants<F: Format>(packed: &Packed<F>, features: &Features) -> Vec<String> {
    let line =
        |name: &str, value: f64| format!("const {name} = {};", F::literal(F::round_up(value)));
    if !features.contains(&Feature::Certified) {
        // Fast pictures keep away from 0 too where they take a root.
        return vec![line("TINY_SQUARE", bounds::TINY_SQUARE)];
    }
    let camera = &packed.camera;
    let for_spread = |roundings: f64| roundings * f64::from(camera.condition) * F::U;
    let [length, dir] = bounds::direction_roundings(features.contains(&Feature::Samples));
    let named = bounds::NAMED.iter();
    let named = named.map(|constant| match constant.name {
        "U" => line("U", F::U),
        name => line(name, constant.value),
    });
    let mut lines: Vec<String> = named.collect();
    lines.extend([
        line("W_ERROR", f64::from(camera.w_error)),
        line("LENGTH_ERROR", for_spread(length)),
        line("DIR_ERROR", for_spread(dir)),
        line("VALUE_ERROR", for_spread(bounds::VALUE_ROUNDINGS)),
        line("DARK", packed.dark.into()),
        line("BRIGHT", packed.brightest()),
    ]);
    if features.contains(&Feature::Lit) {
        lines.extend([
            line("LIGHT_NEAREST", packed.light_nearest()),
            line("TOTAL_LEAST", packed.total_least()),
        ]);
    }
    if features.contains(&Feature::Bvh) {
        lines.push(line("BVH_SIZE", f64::from(packed.tree_size)));
    }
    lines
}

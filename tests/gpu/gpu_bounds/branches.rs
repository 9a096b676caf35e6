//! Running bounds along a path: what a ray is known to within after several mirrors and panes.

use glam::DVec3;
use plumb::gpu::device::Gpu;
use plumb::shader::bounds::ROUNDING;

use super::support::{BoundStatistics, Rng, TrueRay, run};
use super::world::{
    CALL, RayErrors, TruePlane, World, inputs, ray, told, toward_sphere, true_hit, true_plane,
};

/// Mirrors and panes on a path.
const BOUNCES: usize = 4;

/// A path as it truly is.
struct TruePath {
    /// Where its last ray starts, and its direction.
    start: DVec3,
    dir: DVec3,
    /// Length up to there.
    length: f64,
}

/// Follows the ray, to planes chosen so that it meets them, and notes their records; the highest bit says pane.
fn follow(
    rng: &mut Rng,
    planes: &[TruePlane],
    ray: &TrueRay,
    items: &mut Vec<f32>,
) -> Option<TruePath> {
    let (mut start, mut dir, mut length) = (ray.base, ray.dir, 0.0);
    let mut records = [0_u32; BOUNCES];
    let mut last = usize::MAX;
    for record in &mut records {
        let met = (0..200).find_map(|_| {
            let candidate = rng.below(planes.len());
            let t = planes[candidate].meets(start, dir)?;
            (candidate != last && t < 100.0).then_some((candidate, t))
        });
        let (candidate, t) = met?;
        let pane = rng.chance(0.3);
        *record = candidate as u32 | u32::from(pane) << 31;
        (start, length, last) = (start + t * dir, length + t, candidate);
        if !pane {
            let normal = planes[candidate].normal;
            dir -= 2.0 * normal.dot(dir) * normal;
        }
    }
    items.extend(records.map(f32::from_bits));
    Some(TruePath { start, dir, length })
}

/// The ray after some mirrors and panes: how far its line is off at its base, its direction, its start along it, and
/// the length of the path.
pub(crate) fn branches(
    gpu: &Gpu,
    world: &World,
    wgsl: &str,
    errors: RayErrors,
    count: usize,
    names: [&'static str; 4],
) -> [BoundStatistics; 4] {
    let records = &world.packed.lit.as_ref().unwrap().planes;
    let planes: Vec<_> = records
        .iter()
        .map(|r| true_plane(&world.scene.objects[r.object as usize].shape))
        .collect();
    let (mut rng, mut items) = (Rng(12), Vec::new());
    let mut paths = Vec::new();
    while paths.len() < count {
        let size = rng.log(-1.0, 1.0);
        let base = rng.within(size);
        let dir = rng.unit();
        let first = ray(&mut rng, errors, base, dir, dir);
        let begin = items.len();
        items.extend(first.told);
        match follow(&mut rng, &planes, &first, &mut items) {
            Some(path) => paths.push(path),
            None => items.truncate(begin),
        }
    }
    let body = format!(
        "
    let a = items[4u * i];
    let b = items[4u * i + 1u];
    let c = items[4u * i + 2u];
    let path = bitcast<vec4u>(items[4u * i + 3u]);
    let range = Range(NOTHING, 0u, 0.0, T_MAX, 0.0, 0.0);
    var branch: Branch;
    branch.ray = SecondaryRay(a.xyz, b.xyz, b.w, c.x, b.w, c.y);
    branch.total_error = b.w;
    var sure = true;
    for (var k = 0u; k < {BOUNCES}u; k += 1u) {{
        let record = path[k] & 0x7fffffffu;
        let m = plane_hits_from(world_planes[record], branch.ray, range);
        sure &= m.hit & (branch.ray.dir_error < DIR_LIMIT);
        var hit: SecondaryHit;
        hit.t = m.t;
        hit.error = m.error;
        hit.object = world_planes[record].object;
        var at: PathPoint;
        at.point = locate_secondary(branch.ray, hit);
        at.t = hit.t;
        at.t_error = hit.error;
        at.slip = mirror_slip(branch.ray, at);
        branch.total += at.t;
        branch.total_error += U * branch.total;
        if (path[k] >> 31u) != 0u {{
            branch = through_branch(branch, at, 0.0);
        }} else {{
            branch = mirror_branch(branch, at, vec3f(1.0));
        }}
    }}
    answers[3u * i] = vec4f(branch.ray.base, select(0.0, 1.0, sure));
    answers[3u * i + 1u] = vec4f(branch.ray.dir, branch.ray.base_error);
    answers[3u * i + 2u] = vec4f(branch.ray.dir_error, branch.ray.start_error, branch.total, branch.total_error);"
    );
    // What tints panes, which the text names too.
    let lit = world.packed.lit.as_ref().unwrap();
    let tints = [
        (8, bytemuck::cast_slice(&world.packed.tiled_planes)),
        (12, bytemuck::cast_slice(&lit.materials)),
    ];
    let bound = [&inputs(world)[..], &tints].concat();
    let answers = run(gpu, wgsl, &body, &items, &bound, count, 3);
    let mut seen = names.map(BoundStatistics::new);
    for (answer, path) in answers.chunks(3).zip(&paths) {
        let [base, dir, rest] = [answer[0], answer[1], answer[2]].map(|v| v.map(f64::from));
        if base[3] == 0.0 {
            seen[0].decision(false, true, true);
            continue;
        }
        let off = DVec3::from_slice(&base[..3]) - path.start;
        let along = off.dot(path.dir);
        let line = (off - along * path.dir).length();
        let turned = (DVec3::from_slice(&dir[..3]) - path.dir).length();
        let length = path.length + along;
        seen[0].error(line, dir[3]);
        seen[1].error(turned, rest[0]);
        seen[2].error(along.abs(), rest[1]);
        seen[3].error((rest[2] - length).abs(), rest[3]);
    }
    seen
}

/// The ray after a mirror that is a sphere: its direction, how far its line is off at its base, and its length, which
/// may be off by 3.6 roundings.
pub(crate) fn at_spheres(
    gpu: &Gpu,
    world: &World,
    wgsl: &str,
    errors: RayErrors,
    count: usize,
    names: [&'static str; 3],
) -> [BoundStatistics; 3] {
    let truth = world.true_spheres();
    let (mut rng, mut items) = (Rng(13), Vec::new());
    let rays: Vec<_> = (0..count)
        .map(|i| {
            let (center, radius) = truth[i % truth.len()];
            let ray = toward_sphere(&mut rng, center, radius, errors);
            told(&mut items, &ray, i % truth.len());
            ray
        })
        .collect();
    let body = format!(
        "{CALL}let m = sphere_hits_from(world_spheres[record], ray, range);
    var hit: SecondaryHit;
    hit.t = m.t;
    hit.error = m.error;
    hit.object = world_spheres[record].object;
    var at: PathPoint;
    at.point = locate_secondary(ray, hit);
    at.t = hit.t;
    at.t_error = hit.error;
    at.slip = mirror_slip(ray, at);
    var branch: Branch;
    branch.ray = ray;
    let mirror = mirror_branch(branch, at, vec3f(1.0));
    let sure = m.hit & (mirror.ray.dir_error <= DIR_LIMIT);
    answers[2u * i] = vec4f(mirror.ray.dir, select(-1.0, mirror.ray.dir_error, sure));
    answers[2u * i + 1u] = vec4f(mirror.ray.base, mirror.ray.base_error);"
    );
    let answers = run(gpu, wgsl, &body, &items, &inputs(world), count, 2);
    let mut seen = names.map(BoundStatistics::new);
    for (i, ray) in rays.iter().enumerate() {
        let [dir, base] = [0, 1].map(|k| answers[2 * i + k].map(f64::from));
        if dir[3] < 0.0 {
            seen[0].decision(false, true, true);
            continue;
        }
        let (center, radius) = truth[i % truth.len()];
        let hit = ray.base + true_hit(ray, center, radius).1 * ray.dir;
        let normal = (hit - center) / radius;
        let mirrored = ray.dir - 2.0 * normal.dot(ray.dir) * normal;
        let found = DVec3::from_slice(&dir[..3]);
        seen[0].error((found - mirrored).length(), dir[3]);
        let off = DVec3::from_slice(&base[..3]) - hit;
        seen[1].error((off - off.dot(mirrored) * mirrored).length(), base[3]);
        seen[2].error((found.length() - 1.0).abs(), 3.6 * ROUNDING);
    }
    seen
}

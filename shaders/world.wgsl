// What a ray from anywhere meets first. Referee: src/cpu/world.rs.

// A ray from anywhere; positions are from the viewpoint.
struct SecondaryRay {
    base: vec3f,
    // Of unit length.
    dir: vec3f,
//#if certified
    // How far base may be from a point of the true ray's line (in the tree of rays, from the nearest), and dir from its
    // direction.
    base_error: f32,
    dir_error: f32,
    // How far that point may be from where the true ray starts.
    start_error: f32,
    // |base.x| + |base.y| + |base.z|
    size: f32,
//#end
}

// What of the scene a ray sees.
struct Range {
    // The group of surfaces that it left from, which it cannot meet.
    skip: u32,
    // The bit of the light that a shadow ray goes to, else 0.
    light: u32,
    // Hits count only beyond and before these.
    beyond: f32,
    limit: f32,
//#if certified
    beyond_error: f32,
    limit_error: f32,
//#end
}

// A surface as a ray meets it.
struct Intersection {
    // Distance along the ray, where `hit`.
    t: f32,
    // For sure, where pixels are certified.
    hit: bool,
//#if certified
    error: f32,
    // Whether it is met at all; if so, not before `low`.
    possible: bool,
    low: f32,
//#if transparent
    // And not after this.
    high: f32,
//#end
//#end
}

// The closest hit: its distance, and the object; NOTHING if there is none.
struct SecondaryHit {
    t: f32,
    object: u32,
//#if certified
    error: f32,
    low: f32,
    // Nothing else is met before this.
    rival: f32,
    // Its group: of the objects that share it the first in the file is met first, and the others do not count.
    group: u32,
//#end
}

const NOTHING = 0xffffffffu;
// More than any distance, and still a number when multiplied by a direction.
const T_MAX = 1e30f;

// Takes a hit if it is nearer, or as near and first in the file.
fn nearer_secondary(closest: ptr<function, SecondaryHit>, intersection: Intersection, object: u32, group: u32,
    range: Range) {
//#if certified
//#if unordered
    // What comes before the closest on its surface, in the file, and not here, takes its place.
    let same = group == (*closest).group;
    let fresh = !same | (object < (*closest).object);
//#else
    let fresh = group != (*closest).group;
//#end
    var hit = intersection.hit & fresh;
    var possible = intersection.possible & fresh;
//#if transparent
    let from_start = range.beyond == 0.0;
    possible &= from_start | (intersection.high - range.beyond > -range.beyond_error);
    hit &= from_start | (intersection.low - range.beyond > range.beyond_error);
//#end
    let low = select(T_MAX, intersection.low, possible);
//#if unordered
    let takes = hit & ((intersection.t < (*closest).t) | same);
    let rival = select(low, select((*closest).low, T_MAX, same), takes);
//#else
    let takes = hit & (intersection.t < (*closest).t);
    let rival = select(low, (*closest).low, takes);
//#end
    (*closest).rival = min((*closest).rival, rival);
    (*closest).low = select((*closest).low, low, takes);
    (*closest).error = select((*closest).error, intersection.error, takes);
    (*closest).group = select((*closest).group, group, takes);
//#else
    let nearer = (intersection.t < (*closest).t) | ((intersection.t == (*closest).t) & (object < (*closest).object));
    let takes = intersection.hit & (intersection.t > range.beyond) & nearer;
//#end
    (*closest).t = select((*closest).t, intersection.t, takes);
    (*closest).object = select((*closest).object, object, takes);
}

// The first object that the ray meets in range. The rounds of its loops count `weight` times: APART where all lanes of
// a vector ask together, LANES where they ask on their own. Certified, whether it is the first for sure is left to
// `surely_closest`.
fn closest_hit(ray: SecondaryRay, range: Range, weight: u32) -> SecondaryHit {
    var closest: SecondaryHit;
    closest.object = NOTHING;
//#if certified
    closest.t = T_MAX;
    closest.low = T_MAX;
    closest.rival = T_MAX;
    closest.group = NOTHING;
//#else
    closest.t = range.limit;
//#end
//#insert unrolled_closest
//#if world_loop
    steps += weight * WORLD_STEPS;
    if steps > STEPS_LIMIT {
        return closest;
    }
//#end
//#if world_plane_loop
    for (var i = 0u; i < WORLD_PLANES; i += 1u) {
        nearer_secondary(&closest, plane_hits_from(world_planes[i], ray, range), world_planes[i].object,
            world_planes[i].group, range);
    }
//#end
//#if quadric_loop
    for (var i = 0u; i < QUADRICS; i += 1u) {
        nearer_secondary(&closest, quadric_hits_from(quadrics[i], ray, range), quadrics[i].object, quadrics[i].group,
            range);
    }
//#end
//#if world_sphere_loop
    for (var i = WORLD_TREE; i < WORLD_SPHERES; i += 1u) {
        nearer_secondary(&closest, sphere_hits_from(world_spheres[i], ray, range), world_spheres[i].object,
            world_spheres[i].group, range);
    }
//#end
//#if sphere_tree
    var walk = bvh_begin(ray.base, ray.dir, 0u);
    bvh_widen(&walk, ray); //~
    loop {
        let node = bvh[walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            break;
        }
        for (var i = node.first; i < node.first + node.count; i += 1u) {
            nearer_secondary(&closest, sphere_hits_from(world_spheres[i], ray, range), world_spheres[i].object,
                world_spheres[i].group, range);
        }
//#if certified
        // What is truly nearer than the closest is entered before it.
        if !bvh_next(&walk, min(closest.t + closest.error, range.limit + range.limit_error)) {
            break;
        }
//#else
        if !bvh_next(&walk, closest.t) {
            break;
        }
//#end
    }
//#end
//#if triangle_tree
    var triangle_walk = bvh_begin(ray.base, ray.dir, TRIANGLE_ROOT);
    bvh_widen(&triangle_walk, ray); //~
    loop {
        let node = bvh[triangle_walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            break;
        }
        for (var i = node.first; i < node.first + node.count; i += 1u) {
            nearer_secondary(&closest, plane_hits_from(world_planes[i], ray, range), world_planes[i].object,
                world_planes[i].group, range);
        }
//#if certified
        // What is truly nearer than the closest is entered before it.
        if !bvh_next(&triangle_walk, min(closest.t + closest.error, range.limit + range.limit_error)) {
            break;
        }
//#else
        if !bvh_next(&triangle_walk, closest.t) {
            break;
        }
//#end
    }
//#end
    return closest;
}
//#if certified

// Whether nothing else can be nearer than what was met, or nothing at all is met.
fn surely_closest(hit: SecondaryHit) -> bool {
    return (hit.rival - hit.t > hit.error + RIVAL_ROUNDINGS * U * abs(hit.t))
        | ((hit.object == NOTHING) & (hit.rival >= T_MAX));
}
//#end
//#if any_hit

// Nothing, perhaps something, or something stands in range: 0, 1, 2.
fn any_hit(ray: SecondaryRay, range: Range) -> u32 {
    var found = 0u;
//#insert unrolled_any
//#if world_loop
    // The rounds are counted where the lights are gone through, as lanes ask for different ones.
    if steps > STEPS_LIMIT {
        return 2u;
    }
//#end
//#if world_plane_loop
    for (var i = 0u; (i < WORLD_PLANES) & (found != 2u); i += 1u) {
        found = max(found, occludes(plane_hits_from(world_planes[i], ray, range), range));
    }
//#end
//#if quadric_loop
    for (var i = 0u; (i < QUADRICS) & (found != 2u); i += 1u) {
        found = max(found, occludes(quadric_hits_from(quadrics[i], ray, range), range));
    }
//#end
//#if world_sphere_loop
    for (var i = WORLD_TREE; (i < WORLD_SPHERES) & (found != 2u); i += 1u) {
        found = max(found, occludes(sphere_hits_from(world_spheres[i], ray, range), range));
    }
//#end
//#if sphere_tree
    if found == 2u {
        return found;
    }
    var walk = bvh_begin(ray.base, ray.dir, 0u);
    bvh_widen(&walk, ray); //~
    loop {
        let node = bvh[walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            return 2u;
        }
        for (var i = node.first; (i < node.first + node.count) & (found != 2u); i += 1u) {
            found = max(found, occludes(sphere_hits_from(world_spheres[i], ray, range), range));
        }
//#if certified
        if found == 2u || !bvh_next(&walk, range.limit + range.limit_error) {
            break;
        }
//#else
        if found == 2u || !bvh_next(&walk, range.limit) {
            break;
        }
//#end
    }
//#end
//#if triangle_tree
    if found == 2u {
        return found;
    }
    var triangle_walk = bvh_begin(ray.base, ray.dir, TRIANGLE_ROOT);
    bvh_widen(&triangle_walk, ray); //~
    loop {
        let node = bvh[triangle_walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            return 2u;
        }
        for (var i = node.first; (i < node.first + node.count) & (found != 2u); i += 1u) {
            found = max(found, occludes(plane_hits_from(world_planes[i], ray, range), range));
        }
//#if certified
        if found == 2u || !bvh_next(&triangle_walk, range.limit + range.limit_error) {
            break;
        }
//#else
        if found == 2u || !bvh_next(&triangle_walk, range.limit) {
            break;
        }
//#end
    }
//#end
    return found;
}

// Whether a surface stands before the end of the range: 0 no, 1 perhaps, 2 yes.
fn occludes(intersection: Intersection, range: Range) -> u32 {
//#if certified
    let left = range.limit - intersection.t;
    let yes = intersection.hit & (left > intersection.error + range.limit_error);
    let no = !intersection.possible | (intersection.low - range.limit > range.limit_error);
    return select(select(1u, 0u, no), 2u, yes);
//#else
    return select(0u, 2u, intersection.hit & (intersection.t < range.limit));
//#end
}
//#end

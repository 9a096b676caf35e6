// What a ray from anywhere meets first. Twin: src/cpu/world.rs.

// What of the scene a ray sees.
struct Range {
    // The group of surfaces that it left from, which it cannot meet.
    skip: u32,
    // The bit of the light that a shadow ray goes to, else 0.
    light: u32,
    // Hits count only beyond and before these.
    beyond: f32,
    limit: f32,
}

// A hit: its distance, and the object; NOTHING if there is none.
struct Met {
    t: f32,
    object: u32,
}

const NOTHING = 0xffffffffu;
// More than any distance, and still a number when multiplied by a direction.
const T_MAX = 1e30f;

// Takes a hit if it is nearer, or as near and first in the file.
fn met_nearer(closest: ptr<function, Met>, t: f32, object: u32) {
    if t > 0.0 && (t < (*closest).t || (t == (*closest).t && object < (*closest).object)) {
        (*closest).t = t;
        (*closest).object = object;
    }
}

// The first object that the ray from `base` along the unit vector `dir` meets in range. The rounds of its loops count
// `weight` times: 1 where all lanes of a vector ask together, LANES where they ask on their own.
fn closest_from(base: vec3f, dir: vec3f, range: Range, weight: u32) -> Met {
    var closest = Met(range.limit, NOTHING);
//#insert unrolled_closest
//#if world_loop
    steps += weight * WORLD_STEPS;
    if steps > STEPS_LIMIT {
        return closest;
    }
//#end
//#if world_plane_loop
    for (var i = 0u; i < WORLD_PLANES; i += 1u) {
        met_nearer(&closest, plane_hits_from(world_planes[i], base, dir, range), world_planes[i].object);
    }
//#end
//#if world_sphere_loop
    for (var i = WORLD_TREE; i < WORLD_SPHERES; i += 1u) {
        met_nearer(&closest, sphere_hits_from(world_spheres[i], base, dir, range), world_spheres[i].object);
    }
//#end
//#if world_bvh
    var walk = bvh_begin(base, dir);
    loop {
        let node = bvh[walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            break;
        }
        for (var i = node.first; i < node.first + node.count; i += 1u) {
            met_nearer(&closest, sphere_hits_from(world_spheres[i], base, dir, range), world_spheres[i].object);
        }
        if !bvh_next(&walk, closest.t) {
            break;
        }
    }
//#end
    return closest;
}
//#if any_hit

// Whether anything stands in range.
fn anything_from(base: vec3f, dir: vec3f, range: Range) -> bool {
    var hit = false;
//#insert unrolled_any
//#if world_loop
    // The rounds are counted where the lights are gone through, as lanes ask for different ones.
    if steps > STEPS_LIMIT {
        return true;
    }
//#end
//#if world_plane_loop
    for (var i = 0u; i < WORLD_PLANES && !hit; i += 1u) {
        hit = plane_hits_from(world_planes[i], base, dir, range) > 0.0;
    }
//#end
//#if world_sphere_loop
    for (var i = WORLD_TREE; i < WORLD_SPHERES && !hit; i += 1u) {
        hit = sphere_hits_from(world_spheres[i], base, dir, range) > 0.0;
    }
//#end
//#if world_bvh
    if hit {
        return true;
    }
    var walk = bvh_begin(base, dir);
    loop {
        let node = bvh[walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            return true;
        }
        for (var i = node.first; i < node.first + node.count && !hit; i += 1u) {
            hit = sphere_hits_from(world_spheres[i], base, dir, range) > 0.0;
        }
        if hit || !bvh_next(&walk, range.limit) {
            break;
        }
    }
//#end
    return hit;
}
//#end

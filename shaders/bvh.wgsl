// The tree over many spheres: which of them a ray may hit. Twin: src/cpu/bvh.rs.

struct BvhNode {
    // The box, padded outward on the host by more than the slab test errs.
    min: vec3f,
    // A leaf's first sphere, or an inner node's first child; the second is its neighbour.
    first: u32,
    max: vec3f,
    // Spheres of a leaf; 0 for an inner node.
    count: u32,
}

// Where the ray enters the box, in units of w, or a negative number where it does not. `inverse` is 1/w by components.
fn bvh_enters(index: u32, inverse: vec3f) -> f32 {
    let a = bvh[index].min * inverse;
    let b = bvh[index].max * inverse;
    let low = min(a, b);
    let high = max(a, b);
    let near = max(max(low.x, low.y), max(low.z, 0.0));
    let far = min(min(high.x, high.y), high.z);
    return select(-1.0, near, near <= far);
}

// Tests the spheres that the ray may hit, near boxes first. Returns false if that took too many steps to be sure that
// the driver did not end the loop early (lavapipe counts 65,535 iterations for all loops of an invocation together).
fn bvh_hits(ray: Ray, closest: ptr<function, Hit>) -> bool {
    // A zero component becomes tiny: the ray stays in its slab or out of it.
    let inverse = 1.0 / select(ray.w, vec3f(1e-30), abs(ray.w) < vec3f(1e-30));
    var stack: array<u32, BVH_DEPTH>;
    var waiting = 0u;
    var index = 0u;
    for (var steps = 0u; steps < BVH_STEPS; steps += 1u) {
        let node = bvh[index];
        var descends = false;
        if node.count > 0u {
            for (var i = node.first; i < node.first + node.count; i += 1u) {
                nearer(closest, small_sphere_hits(small_spheres[i], ray), small_spheres[i].object);
            }
        } else {
            // Boxes beyond the closest hit so far cannot hold a nearer one; the padding keeps equal ones in.
            let reach = 1.0 / max((*closest).inverse, 1e-37);
            let left = bvh_enters(node.first, inverse);
            let right = bvh_enters(node.first + 1u, inverse);
            let go_left = left >= 0.0 && left <= reach;
            let go_right = right >= 0.0 && right <= reach;
            descends = go_left || go_right;
            let left_first = go_left && (!go_right || left <= right);
            if go_left && go_right {
                stack[waiting] = node.first + select(0u, 1u, left_first);
                waiting += 1u;
            }
            index = node.first + select(1u, 0u, left_first);
        }
        if !descends {
            if waiting == 0u {
                return true;
            }
            waiting -= 1u;
            index = stack[waiting];
        }
    }
    return false;
}

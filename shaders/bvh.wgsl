// The trees over many spheres and over many triangles: which of them a ray may hit. Twin of the boxes' tests on the
// CPU: src/certify/lanes/lit/walk.rs. Referee: src/cpu/bvh.rs.

//#insert struct BvhNode

// The slack of a box's near and far side: the roundings of the test are relative, a few ulp.
const BVH_NEAR: f32 = 0.999998;
const BVH_FAR: f32 = 1.000004;

// Where the ray enters the box, in units of its direction, or a negative number where it does not. `inverse` is 1/dir
// by components.
fn bvh_enters(index: u32, walk: ptr<function, Walk>) -> f32 {
    let base = (*walk).base;
    let inverse = (*walk).inverse;
    var min_from_base = bvh[index].min - base;
    var max_from_base = bvh[index].max - base;
    min_from_base -= (*walk).pad; //~
    max_from_base += (*walk).pad; //~
    let a = min_from_base * inverse;
    let b = max_from_base * inverse;
    let low = min(a, b);
    let high = max(a, b);
    let near = max(max(low.x, low.y), max(low.z, 0.0));
    let far = min(min(high.x, high.y), high.z);
    return select(-1.0, near * BVH_NEAR, near <= far * BVH_FAR);
}

// A walk down the tree: the boxes that wait, the one looked at, and the leaf found.
struct Walk {
    base: vec3f,
    inverse: vec3f,
    // What the boxes are widened by for a ray that is not known exactly.
    pad: f32, //~
    waiting: u32,
    index: u32,
    stack: array<u32, BVH_DEPTH>,
}

// Begins at the root of a tree.
fn bvh_begin(base: vec3f, dir: vec3f, root: u32) -> Walk {
    var walk: Walk;
    walk.index = root;
    walk.base = base;
    // A zero component becomes tiny: the ray stays in its slab or out of it.
    walk.inverse = 1.0 / select(dir, vec3f(1e-20), abs(dir) < vec3f(1e-20));
    return walk;
}

//#if certified

// Widens the boxes by as much as the ray may be off where it meets them.
fn bvh_widen(walk: ptr<function, Walk>, ray: SecondaryRay) {
    let moved = ray.base_error + ray.start_error;
    (*walk).pad = SECOND_ORDER * (moved + ray.dir_error * (ray.size + BVH_SIZE + moved))
        + BOX_ROUNDINGS * U * (ray.size + BVH_SIZE);
}
//#end

// Goes on to the next box, the nearer child first, as long as it is entered before `reach`. False at the end.
fn bvh_next(walk: ptr<function, Walk>, reach: f32) -> bool {
    let node = bvh[(*walk).index];
    if node.count == 0u {
        let left = bvh_enters(node.first, walk);
        let right = bvh_enters(node.first + 1u, walk);
        let go_left = (left >= 0.0) & (left <= reach);
        let go_right = (right >= 0.0) & (right <= reach);
        let left_first = go_left & (!go_right | (left <= right));
        if go_left & go_right {
            (*walk).stack[(*walk).waiting] = node.first + select(0u, 1u, left_first);
            (*walk).waiting += 1u;
        }
        if go_left | go_right {
            (*walk).index = node.first + select(1u, 0u, left_first);
            return true;
        }
    }
    if (*walk).waiting == 0u {
        return false;
    }
    (*walk).waiting -= 1u;
    (*walk).index = (*walk).stack[(*walk).waiting];
    return true;
}

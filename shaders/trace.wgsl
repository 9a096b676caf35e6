// The closest hit of a ray, and its colour: the entry point. Twin: src/cpu/trace.rs.

//#if any_object
struct Hit {
    // 1/s: the larger, the nearer; 0 is no hit.
    inverse: f32,
    object: u32,
//#if bvh
    // Whether every object was asked.
    decided: bool,
//#end
}

// Takes a hit if it is nearer, or as near and first in the file.
fn nearer(closest: ptr<function, Hit>, inverse: f32, object: u32) {
//#if mixed
    let best = *closest;
    if inverse > best.inverse || (inverse == best.inverse && inverse > 0.0 && object < best.object) {
//#else
    // Objects of one kind come in the order of the file.
    if inverse > (*closest).inverse {
//#end
        (*closest).inverse = inverse;
        (*closest).object = object;
    }
}

// The closest object that the ray hits.
fn find_closest_object(ray: Ray) -> Hit {
    var closest: Hit;
//#insert unrolled
//#if plane_loop
    for (var i = 0u; i < PLANES; i += 1u) {
        nearer(&closest, plane_hits(planes[i], ray), planes[i].object);
    }
//#end
//#if small_sphere_loop
    for (var i = 0u; i < SMALL_SPHERES; i += 1u) {
        nearer(&closest, small_sphere_hits(small_spheres[i], ray), small_spheres[i].object);
    }
//#end
//#if wide_sphere_loop
    for (var i = 0u; i < WIDE_SPHERES; i += 1u) {
        nearer(&closest, wide_sphere_hits(wide_spheres[i], ray), wide_spheres[i].object);
    }
//#end
//#if bvh
    closest.decided = bvh_hits(ray, &closest);
//#end
    return closest;
}

//#end
// The highest byte of a pixel that the CPU has to decide.
const UNDECIDED = 0xff000000u;

// What a ray brings: 255 times its colour, and 0 or UNDECIDED.
struct Traced {
    color: vec3f,
    verdict: u32,
}

// Traces the ray through a pixel.
fn ray_trace(pixel: vec2i) -> Traced {
    var traced: Traced;
//#if any_object
    let ray = camera_getdir(pixel);
    let hit = find_closest_object(ray);
//#if bvh
    if !hit.decided {
        traced.verdict = UNDECIDED;
        return traced;
    }
//#end
    if hit.inverse > 0.0 {
        traced.color = getamb(ray, hit) * inverse_distance(ray, hit.inverse);
    }
//#end
    return traced;
}

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= job.size) {
        return;
    }
    // Rows of the picture go down, y goes up.
    let pixel = vec2i(i32(job.first.x + id.x), i32(job.first.y) - i32(id.y));
    let traced = ray_trace(pixel);
    let bytes = camera_setpix(traced.color) | traced.verdict;
    let place = id.y * job.size.x + id.x;
//#if values
    pixels[place] = vec4u(bitcast<vec3u>(traced.color), bytes);
//#else
    pixels[place] = bytes;
//#end
}

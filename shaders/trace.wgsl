// The closest hit of a primary ray, the colour that a ray brings, and the entry point. Twin: src/cpu/trace.rs.

//#if counted
// Iterations of the loops so far, of all samples, the last one of each, which only finds the end, included: the driver may
// end loops early that go round too often (lavapipe counts 65,535 for all loops together, and for all invocations that it
// runs as the lanes of one vector), so a pixel that comes near is handed to the CPU. Loops that go round differently in
// different lanes count for all LANES.
var<private> steps: u32;
const STEPS_LIMIT = 50000u;
//#end

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
//#if rectangle_loop
    for (var i = 0u; i < RECTANGLES; i += 1u) {
        nearer(&closest, rectangle_hits(rectangles[i], ray), rectangles[i].object);
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
//#if small_sphere_tree
    var walk = bvh_begin(vec3f(0.0), ray.w);
    loop {
        let node = bvh[walk.index];
        steps += LANES * (2u + node.count);
        if steps > STEPS_LIMIT {
            break;
        }
        for (var i = node.first; i < node.first + node.count; i += 1u) {
            nearer(&closest, small_sphere_hits(small_spheres[i], ray), small_spheres[i].object);
        }
        if !bvh_next(&walk, 1.0 / max(closest.inverse, 1e-37)) {
            closest.decided = true;
            break;
        }
    }
//#end
//#if world_bvh
    // In a lit scene one tree serves all rays.
    let length = sqrt(ray.w2);
    let met = closest_from(vec3f(0.0), ray.w / length, Range(NOTHING, 0u, 0.0, T_MAX), 1u);
    if met.object != NOTHING {
        nearer(&closest, length / met.t, met.object);
    }
    closest.decided = steps <= STEPS_LIMIT;
//#end
    return closest;
}

// Where a primary ray hit.
fn locate(ray: Ray, hit: Hit) -> Point {
    var point: Point;
    point.object = hit.object;
//#if position
    point.position = ray.w / hit.inverse;
//#end
//#if lit
    complete(&point);
//#end
//#if from_center
    let object = objects[hit.object];
//#insert from_center_cases
//#end
//#if lit_sphere
    if (objects[hit.object].place & SPHERE_BIT) != 0u {
        point.normal = normalize3(point.from_center);
    }
//#end
    return point;
}
//#if lit

const SPHERE_BIT = 0x80000000u;

fn normalize3(v: vec3f) -> vec3f {
    return v / length3(v);
}

// Fills in what follows from the object and the position.
fn complete(point: ptr<function, Point>) {
    let object = objects[(*point).object];
    (*point).group = object.group;
    if (object.place & SPHERE_BIT) != 0u {
//#if lit_sphere
        let sphere = world_spheres[object.place & ~SPHERE_BIT];
        (*point).from_center = (*point).position - sphere.center;
        (*point).normal = normalize3((*point).from_center);
//#end
    } else {
//#if lit_plane
        let plane = world_planes[object.place];
        (*point).normal = plane.normal;
        (*point).position = (*point).position * plane.keep + plane.own;
//#end
//#if level
        (*point).level = plane.level;
//#end
    }
}

// Where a ray from anywhere hit.
fn locate_met(base: vec3f, dir: vec3f, met: Met) -> Point {
    var point: Point;
    point.object = met.object;
    point.position = base + met.t * dir;
    complete(&point);
    return point;
}

// What the lights and the light that is everywhere make of a point, seen by a ray from `base`.
fn shade(point: Point, base: vec3f) -> vec3f {
    var color = getamb(point);
    let diffuse = getdiff(point);
    steps += 1u;
    for (var i = 0u; i < LIGHTS; i += 1u) {
        steps += 1u + SHADOW_STEPS;
        if steps > STEPS_LIMIT {
            break;
        }
        color += light_term(i, point, base, diffuse);
    }
    return color;
}

// A ray of the tree that a sample grows.
struct Branch {
    base: vec3f,
    // Length of the path before it.
    total: f32,
    dir: vec3f,
    // The group of surfaces that it left from.
    last: u32,
    // What its colour counts for.
    weight: vec3f,
}
//#end

// The highest byte of a pixel that the CPU has to decide.
const UNDECIDED = 0xff000000u;
//#end

// What a ray brings: 255 times its colour, and 0 or UNDECIDED.
struct Traced {
    color: vec3f,
    verdict: u32,
}

//#if any_object
// Traces a primary ray.
fn ray_trace(ray: Ray) -> Traced {
    var traced: Traced;
//#if counted
    steps += PRIMARY_STEPS;
    if steps > STEPS_LIMIT {
        traced.verdict = UNDECIDED;
        return traced;
    }
//#end
    let hit = find_closest_object(ray);
//#if bvh
    if !hit.decided {
        traced.verdict = UNDECIDED;
        return traced;
    }
//#end
    if !(hit.inverse > 0.0) {
        return traced;
    }
//#if lit
    let length = sqrt(ray.w2);
    var point = locate(ray, hit);
    var branch = Branch(vec3f(0.0), 0.0, ray.w / length, NOTHING, vec3f(1.0));
    var t = length / hit.inverse;
//#if stack
    var stack: array<Branch, STACK>;
    var waiting = 0u;
//#end
//#if branches
    var rays = 1u;
    loop {
        if steps > STEPS_LIMIT {
            traced.verdict = UNDECIDED;
            break;
        }
        steps += 2u;
//#end
        let total = branch.total + t;
        let material = materials[objects[point.object].material];
        traced.color += branch.weight * shade(point, branch.base) * ((1.0 - material.transparency) / total * CAMERA_GAIN);
//#if branches
        // The rays that go on from here.
//#if mirror
        let along = -dot(point.normal, branch.dir);
        let mirrored = 2.0 * along * point.normal + branch.dir;
        var mirror = Branch(point.position, total, mirrored, point.group, branch.weight * material.specular);
//#end
//#if clear
        var through = Branch(point.position, total, branch.dir, point.group, branch.weight);
        if material.transparency > 0.0 {
            through.weight *= materials[tile_material(point)].tint * material.transparency;
        } else {
            through.weight = vec3f(0.0);
        }
//#end
//#if stack
        if any(mirror.weight > vec3f(0.0)) && total <= MAX_PATH {
            if waiting == STACK {
                traced.verdict = UNDECIDED;
                break;
            }
            stack[waiting] = mirror;
            waiting += 1u;
        }
        if any(through.weight > vec3f(0.0)) && total <= MAX_PATH {
            if waiting == STACK {
                traced.verdict = UNDECIDED;
                break;
            }
            stack[waiting] = through;
            waiting += 1u;
        }
        var met = Met(0.0, NOTHING);
        while waiting > 0u && met.object == NOTHING && rays < MAX_RAYS {
            steps += 2u * LANES;
            rays += 1u;
            waiting -= 1u;
            branch = stack[waiting];
            met = closest_from(branch.base, branch.dir, Range(branch.last, 0u, 0.0, T_MAX), LANES);
        }
        if met.object == NOTHING && waiting > 0u {
            // More rays than allowed: the CPU says which pixel it is.
            traced.verdict = UNDECIDED;
            break;
        }
//#else
//#if mirror
        branch = mirror;
//#else
        branch = through;
//#end
        if total > MAX_PATH || !any(branch.weight > vec3f(0.0)) {
            break;
        }
        if rays == MAX_RAYS {
            traced.verdict = UNDECIDED;
            break;
        }
        rays += 1u;
        let met = closest_from(branch.base, branch.dir, Range(branch.last, 0u, 0.0, T_MAX), 1u);
//#end
        if met.object == NOTHING {
            break;
        }
        t = met.t;
        point = locate_met(branch.base, branch.dir, met);
    }
//#end
    if steps > STEPS_LIMIT {
        traced.verdict = UNDECIDED;
    }
//#else
    traced.color = getamb(locate(ray, hit)) * inverse_distance(ray, hit.inverse);
//#end
    return traced;
}
//#end

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= job.size) {
        return;
    }
    // Rows of the picture go down, y goes up.
    let pixel = vec2i(i32(job.first.x + id.x), i32(job.first.y) - i32(id.y));
    let place = id.y * job.size.x + id.x;
//#if any_object
//#if samples
    var traced: Traced;
    for (var sample = 0u; sample < SAMPLES; sample += 1u) {
        steps += 1u;
//#if course
        let offset = offsets[place * SAMPLES + sample];
//#else
        let offset = jitter_hash(pixel, sample);
//#end
        let one = ray_trace(camera_getdir(pixel, offset));
        traced.color += one.color / f32(SAMPLES);
        traced.verdict |= one.verdict;
        if traced.verdict != 0u {
            break;
        }
    }
//#else
    let traced = ray_trace(camera_getdir(pixel));
//#end
//#else
    let traced = Traced();
//#end
    let bytes = camera_setpix(traced.color) | traced.verdict;
//#if values
    pixels[place] = vec4u(bitcast<vec3u>(traced.color), bytes);
//#else
    pixels[place] = bytes;
//#end
}

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
// An object as a primary ray meets it.
struct Candidate {
    // 1/s, where it is hit: the larger, the nearer; 0 or less is a miss.
    inverse: f32,
    // For sure, where pixels are certified.
    hit: bool,
//#if certified
    error: f32,
    // Whether it may be hit.
    possible: bool,
//#end
}

struct Hit {
    // 1/s: the larger, the nearer; 0 is no hit.
    inverse: f32,
    object: u32,
//#if sphere_point
    // Number among the spheres or planes.
    index: u32,
//#end
//#if certified
    error: f32,
    // Of everything else that may be hit, the largest that 1/s may be.
    rival: f32,
//#if groups
    // Its surface, if others share it: of these the first in the file is hit first, and the others do not count.
    group: u32,
//#end
//#end
//#if tiles
    // Whether every object was asked.
    decided: bool,
//#end
}

// Takes a hit if it is nearer, or as near and first in the file.
fn nearer(closest: ptr<function, Hit>, candidate: Candidate, object: u32, index: u32, group: u32) {
//#if certified
    var hit = candidate.hit;
    var possible = candidate.possible;
//#if groups
    let fresh = (group == 0u) | (group != (*closest).group);
    hit &= fresh;
    possible &= fresh;
//#end
    let takes = hit & (candidate.inverse > (*closest).inverse);
    let high = select(0.0, candidate.inverse + candidate.error, possible);
    (*closest).rival = max((*closest).rival, select(high, (*closest).inverse + (*closest).error, takes));
    (*closest).error = select((*closest).error, candidate.error, takes);
//#if groups
    (*closest).group = select((*closest).group, group, takes);
//#end
//#else
//#if mixed
    let best = *closest;
    let takes = candidate.hit & (candidate.inverse > 0.0)
        & ((candidate.inverse > best.inverse) | ((candidate.inverse == best.inverse) & (object < best.object)));
//#else
    // Objects of one kind come in the order of the file.
    let takes = candidate.hit & (candidate.inverse > (*closest).inverse);
//#end
//#end
    (*closest).inverse = select((*closest).inverse, candidate.inverse, takes);
    (*closest).object = select((*closest).object, object, takes);
//#if sphere_point
    (*closest).index = select((*closest).index, index, takes);
//#end
}

// The closest object that the ray hits.
fn find_closest_object(ray: Ray) -> Hit {
    var closest: Hit;
//#insert unrolled
//#if rectangle_loop
    for (var i = 0u; i < RECTANGLES; i += 1u) {
        nearer(&closest, rectangle_hits(rectangles[i], ray), rectangles[i].object, i, rectangles[i].group);
    }
//#end
//#if plane_loop
    for (var i = 0u; i < PLANES; i += 1u) {
        nearer(&closest, plane_hits(planes[i], ray), planes[i].object, i, planes[i].group);
    }
//#end
//#if sphere_loop
    for (var i = 0u; i < SPHERES; i += 1u) {
        let sphere = sphere_at(i);
        nearer(&closest, sphere_hits(sphere, ray), sphere.object, i, 0u);
    }
//#end
//#if tiles
    // Those that may be seen in this tile of the screen, the nearest first: once one is hit, those farther off do not count.
    let tile = u32(ray.pixel.y) / TILE_HEIGHT * TILE_COLUMNS + u32(ray.pixel.x) / TILE_WIDTH;
    let first = tiles[tile];
    let end = tiles[tile + 1u];
    let last = min(end, first + (STEPS_LIMIT - min(steps, STEPS_LIMIT)) / LANES);
    closest.decided = last == end;
    var place = first;
    for (; place < last; place += 1u) {
        let index = tiles[place];
        let sphere = sphere_at(index);
//#if certified
        let least = closest.inverse - closest.error;
//#else
        let least = closest.inverse;
//#end
        if sphere.most < least {
            closest.decided = true;
            break;
        }
        nearer(&closest, sphere_hits(sphere, ray), sphere.object, index, 0u);
    }
    steps += LANES * (place - first + 1u);
//#end
    return closest;
}
//#if lit

// The primary ray as one from anywhere.
fn primary_beam(ray: Ray) -> Beam {
//#if certified
    return Beam(vec3f(0.0), ray.w * ray.inverse_length, 0.0, DIR_ERROR, 0.0);
//#else
    return Beam(vec3f(0.0), ray.w * ray.inverse_length);
//#end
}
//#end

// Where a primary ray hit.
fn locate(ray: Ray, hit: Hit) -> Point {
    var point: Point;
    point.object = hit.object;
//#if tables
    point.pixel = ray.pixel;
    point.direct = true;
//#end
//#if position
    let s = 1.0 / hit.inverse;
    point.position = ray.w * s;
//#if certified
    let length = ray.w2 * ray.inverse_length;
    point.error = 1.01 * s * (W_ERROR + length * (s * hit.error + 5.0 * U));
    point.size = abs(point.position.x) + abs(point.position.y) + abs(point.position.z);
//#end
//#end
//#if lit
    complete(&point);
//#if sphere_point
    if (objects[hit.object].place & SPHERE_BIT) != 0u {
        on_sphere(&point, sphere_normal(hit.index, ray, hit));
    }
//#end
//#if bvh
//#if lit_sphere
    if (objects[hit.object].place & SPHERE_BIT) != 0u {
        on_sphere(&point, sphere_met(world_spheres[objects[hit.object].place & ~SPHERE_BIT], primary_beam(ray)));
    }
//#end
//#end
//#else
//#if sphere_point
    if (objects[hit.object].kind & 128u) != 0u {
        let normal = sphere_normal(hit.index, ray, hit);
        point.from_center = normal.xyz;
        point.from_center_error = normal.w; //~
    }
//#end
//#end
    return point;
}
//#if lit

const SPHERE_BIT = 0x80000000u;

// Fills in what follows from the object alone, on a plane.
fn complete(point: ptr<function, Point>) {
    let object = objects[(*point).object];
    (*point).group = object.group;
//#if lit_plane
    if (object.place & SPHERE_BIT) == 0u {
        let plane = world_planes[object.place];
        (*point).normal = plane.normal;
        (*point).normal_error = 2.0 * U; //~
        (*point).position = (*point).position * plane.keep + plane.own;
//#if level
        (*point).level = plane.level;
//#end
    }
//#end
}
//#if lit_sphere

// Takes the normal of a sphere, with the bound of its error.
fn on_sphere(point: ptr<function, Point>, normal: vec4f) {
    (*point).from_center = normal.xyz;
    (*point).normal = normal.xyz;
//#if certified
    (*point).from_center_error = normal.w;
    (*point).normal_error = normal.w;
//#else
    (*point).normal /= length3(normal.xyz);
//#end
}
//#end

// Where a ray from anywhere hit.
fn locate_met(beam: Beam, met: Met) -> Point {
    var point: Point;
    point.object = met.object;
    point.position = barrier(beam.base + met.t * beam.dir);
//#if certified
    point.error = 1.01 * (beam.base_error + met.t * beam.dir_error + met.error) + POSITION_ROUNDINGS * U * (beam.size + met.t);
//#end
    complete(&point);
//#if sphere_beyond
    let object = objects[met.object];
    if (object.place & SPHERE_BIT) != 0u {
        let sphere = world_spheres[object.place & ~SPHERE_BIT];
        let normal = sphere_met(sphere, beam);
        on_sphere(&point, normal);
        point.position = barrier(sphere.center + sphere.radius * normal.xyz);
        point.error = 1.01 * sphere.radius * normal.w + POSITION_ROUNDINGS * U * sphere.size; //~
    }
//#end
//#if certified
    point.size = abs(point.position.x) + abs(point.position.y) + abs(point.position.z);
//#end
    return point;
}

// What the lights and the light that is everywhere make of a point, seen by a ray.
fn shade(point: Point, seen: Beam) -> Shade {
    var sum = getamb(point);
    let diffuse = getdiff(point);
    steps += 1u;
    for (var i = 0u; i < LIGHTS; i += 1u) {
        steps += 1u + SHADOW_STEPS;
        if steps > STEPS_LIMIT {
            break;
        }
        let term = light_term(i, point, seen, diffuse);
        sum.color += term.color;
        sum.error += term.error + 2.0 * U * sum.color; //~
    }
    return sum;
}
//#if branches

// A ray of the tree that a sample grows.
struct Branch {
    beam: Beam,
    // Length of the path before it.
    total: f32,
    total_error: f32, //~
    // The group of surfaces that it left from.
    last: u32,
    // What its colour counts for; certified, by a factor within 1 ± this.
    weight: vec3f,
    weight_error: f32, //~
}
//#if stack

// The mirror rays that wait while another ray is followed. (Not a variable of the function: that made one driver's code
// twice as slow, and its compile time grows with the stack's size.)
var<private> stack: array<Branch, STACK>;
var<private> waiting: u32;
//#end
//#end
//#end
//#end

// The highest byte of a pixel that the CPU has to decide.
const UNDECIDED = 0xff000000u;

// What a ray brings: 255 times its colour, and 0 or UNDECIDED.
struct Traced {
    color: vec3f,
    error: vec3f, //~
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
//#if tiles
    if !hit.decided {
        traced.verdict = UNDECIDED;
        return traced;
    }
//#end
//#if certified
//#if ambient_only
    // So far away that the byte is 0, whatever is hit.
    let dark = max(hit.inverse + hit.error, hit.rival) * ray.inverse_length < DARK;
    var sure = hit.inverse - hit.rival > hit.error;
//#if first_order
    sure &= hit.inverse > 128.0 * hit.error;
//#end
    if dark | !sure {
        traced.verdict = select(UNDECIDED, 0u, dark);
//#if samples
        // Other samples may be brighter: it brings something from 0 to as much as it may be.
        let most = max(hit.inverse + hit.error, hit.rival) * ray.inverse_length * BRIGHT;
        traced.color = vec3f(0.5 * most);
        traced.error = vec3f(0.51 * most);
//#end
        return traced;
    }
//#else
    let nothing = (hit.inverse + hit.error <= 0.0) & (hit.rival <= 0.0);
    let sure = (hit.inverse - hit.rival > hit.error) & (hit.inverse > LEAST_INVERSE) & (hit.inverse > 128.0 * hit.error);
    if nothing | !sure {
        traced.verdict = select(UNDECIDED, 0u, nothing);
        return traced;
    }
//#end
    doubt = false;
//#else
    if !(hit.inverse > 0.0) {
        return traced;
    }
//#end
//#if lit
    var point = locate(ray, hit);
    var t = ray.w2 * ray.inverse_length / hit.inverse;
    var t_error = t * (1.01 * hit.error / hit.inverse + LENGTH_ERROR); //~
//#if branches
    var branch: Branch;
    branch.beam = primary_beam(ray);
    branch.last = NOTHING;
    branch.weight = vec3f(1.0);
//#if stack
    waiting = 0u;
//#end
    var rays = 1u;
    loop {
        if steps > STEPS_LIMIT {
            traced.verdict = UNDECIDED;
            break;
        }
        steps += 2u;
        let total = branch.total + t;
        let total_error = branch.total_error + t_error + U * total; //~
        let material = materials[objects[point.object].material];
        let lit = shade(point, branch.beam);
        let share = branch.weight * (material.kept / total * CAMERA_GAIN);
        traced.color += share * lit.color;
//#if certified
        traced.error += share * (lit.error * (1.0 + branch.weight_error) + lit.color * (branch.weight_error + 1.01 * total_error / total + 12.0 * U))
            + 2.0 * U * traced.color;
        if doubt | (total_error > 0.01 * total) {
            traced.verdict = UNDECIDED;
            break;
        }
        let short = MAX_PATH - total;
        let goes_on = any(branch.weight * material.specular > vec3f(0.0)) | (material.transparency > 0.0);
        if goes_on & !(abs(short) > total_error + 2.0 * U * MAX_PATH) {
            // Whether the path ends here is not certain.
            traced.verdict = UNDECIDED;
            break;
        }
//#end
        // The rays that go on from here.
//#if mirror
        let along = -dot(point.normal, branch.beam.dir);
        var mirror: Branch;
        mirror.beam.base = point.position;
        mirror.total = total;
        mirror.last = point.group;
        mirror.weight = branch.weight * material.specular;
//#if certified
        mirror.beam.dir = barrier(2.0 * along * point.normal + branch.beam.dir);
        mirror.beam.dir_error = 1.01 * branch.beam.dir_error + 4.04 * point.normal_error + MIRROR_ROUNDINGS * U;
        mirror.beam.base_error = point.error;
        mirror.beam.size = point.size;
        mirror.total_error = total_error;
        mirror.weight_error = branch.weight_error + 2.0 * U;
//#else
        mirror.beam.dir = 2.0 * along * point.normal + branch.beam.dir;
//#end
//#end
//#if clear
        var through = branch;
        through.beam.base = point.position;
        through.total = total;
        through.last = point.group;
//#if certified
        through.beam.base_error = point.error;
        through.beam.size = point.size;
        through.total_error = total_error;
        through.weight_error = branch.weight_error + 5.0 * U;
//#end
        if material.transparency > 0.0 {
            through.weight *= materials[tile_material(point)].tint * material.transparency;
        } else {
            through.weight = vec3f(0.0);
        }
//#end
//#if stack
        // What goes through is followed at once; the mirror image waits if both go on.
        let mirrors = any(mirror.weight > vec3f(0.0)) & (total <= MAX_PATH);
        let passes = any(through.weight > vec3f(0.0)) & (total <= MAX_PATH);
        if mirrors & passes {
            if waiting == STACK {
                traced.verdict = UNDECIDED;
                break;
            }
            stack[waiting] = mirror;
            waiting += 1u;
        }
        branch = mirror;
        if passes {
            branch = through;
        }
        var met: Met;
        met.object = NOTHING;
        var follows = mirrors | passes;
        loop {
            if !follows {
                if waiting == 0u {
                    break;
                }
                waiting -= 1u;
                branch = stack[waiting];
            }
            if rays == MAX_RAYS {
                // More rays than allowed: the CPU says which pixel it is.
                traced.verdict = UNDECIDED;
                break;
            }
            rays += 1u;
            steps += 2u * LANES;
//#if certified
            met = closest_from(branch.beam, Range(branch.last, 0u, 0.0, T_MAX, 0.0, 0.0), LANES);
            doubt |= !met_sure(met) | (branch.beam.dir_error > DIR_LIMIT);
            if (met.object != NOTHING) | doubt {
                break;
            }
//#else
            met = closest_from(branch.beam, Range(branch.last, 0u, 0.0, T_MAX), LANES);
            if met.object != NOTHING {
                break;
            }
//#end
            follows = false;
        }
//#else
//#if mirror
        branch = mirror;
//#else
        branch = through;
//#end
        if (total > MAX_PATH) | !any(branch.weight > vec3f(0.0)) {
            break;
        }
        if rays == MAX_RAYS {
            traced.verdict = UNDECIDED;
            break;
        }
        rays += 1u;
//#if certified
        let met = closest_from(branch.beam, Range(branch.last, 0u, 0.0, T_MAX, 0.0, 0.0), 1u);
        doubt |= !met_sure(met) | (branch.beam.dir_error > DIR_LIMIT);
//#else
        let met = closest_from(branch.beam, Range(branch.last, 0u, 0.0, T_MAX), 1u);
//#end
//#end
//#if certified
        if doubt {
            traced.verdict = UNDECIDED;
            break;
        }
//#end
        if met.object == NOTHING {
            break;
        }
        t = met.t;
        t_error = met.error; //~
        point = locate_met(branch.beam, met);
    }
//#else
    let lit = shade(point, primary_beam(ray));
    let share = CAMERA_GAIN / t;
    traced.color = share * lit.color;
    traced.error = share * (lit.error + lit.color * (1.01 * t_error / t + 12.0 * U)); //~
//#end
    if steps > STEPS_LIMIT {
        traced.verdict = UNDECIDED;
    }
//#else
    let ambient = getamb(locate(ray, hit));
    let share = CAMERA_GAIN * ray.inverse_length;
    traced.color = ambient.color * (share * hit.inverse);
//#if certified
    traced.error = ambient.color * (share * (1.01 * hit.error + VALUE_ERROR * hit.inverse));
//#if modulated
    traced.error += ambient.error * (1.01 * share * hit.inverse);
//#end
//#end
//#end
//#if certified
//#if doubtful
    if doubt {
        traced.verdict = UNDECIDED;
    }
//#end
//#end
    return traced;
}
//#end
//#if partial

// Adds a sample's share to a pixel, if it counts: what a doubtful one brings means nothing.
fn add_sample(sum: ptr<function, Traced>, one: Traced, counts: bool) {
    (*sum).color += select(vec3f(0.0), one.color * (1.0 / f32(SAMPLES)), counts);
    (*sum).error += select(vec3f(0.0), one.error * (1.01 / f32(SAMPLES)), counts) + 3.0 * U * (*sum).color;
}
//#end
//#if quad

// A pixel's bytes, and its verdict.
fn make_pixel(pixel: vec2i) -> u32 {
    let traced = ray_trace(camera_getdir(pixel));
//#if certified
    return camera_setpix(traced.color, traced.error) | traced.verdict;
//#else
    return camera_setpix(traced.color) | traced.verdict;
//#end
}

// Four pixels side by side, as far as there are any: one store costs less than four.
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let column = 4u * id.x;
    if (column >= job.size.x) | (id.y >= job.size.y) {
        return;
    }
    // Rows of the picture go down, y goes up.
    let pixel = vec2i(i32(job.first.x + column), i32(job.first.y) - i32(id.y));
    pixels[id.y * ((job.size.x + 3u) / 4u) + id.x] = vec4u(make_pixel(pixel), make_pixel(pixel + vec2i(1, 0)),
        make_pixel(pixel + vec2i(2, 0)), make_pixel(pixel + vec2i(3, 0)));
}
//#else

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
//#if partial
    // The same of the samples that are worth keeping should the pixel be doubtful: their bits, and how many they are. What
    // is not among them, for whatever reason, the CPU adds.
    var part: Traced;
    var summed: array<u32, SUMMED_WORDS>;
    var kept = 0u;
    var sure = 0u;
//#end
    for (var sample = 0u; sample < SAMPLES; sample += 1u) {
        steps += 1u;
//#if course
        let offset = offsets[place * SAMPLES + sample];
//#else
        let offset = jitter_hash(pixel, sample);
//#end
        let one = ray_trace(camera_getdir(pixel, offset));
//#if partial
        let fine = (one.verdict == 0u) & all(one.error < vec3f(FINE));
        add_sample(&traced, one, one.verdict == 0u);
        add_sample(&part, one, fine);
        summed[sample / 32u] |= select(0u, 1u << (sample % 32u), fine);
        kept += select(0u, 1u, fine);
        sure += select(0u, 1u, one.verdict == 0u);
        if steps > STEPS_LIMIT {
            break;
        }
//#else
        traced.color += one.color * (1.0 / f32(SAMPLES));
        traced.error += one.error * (1.01 / f32(SAMPLES)) + 3.0 * U * traced.color; //~
        traced.verdict |= one.verdict;
        if traced.verdict != 0u {
            break;
        }
//#end
    }
//#if partial
    traced.verdict = select(UNDECIDED, 0u, sure == SAMPLES);
//#end
//#else
    let traced = ray_trace(camera_getdir(pixel));
//#end
//#else
    let traced = Traced();
//#end
//#if certified
//#if any_object
    let bytes = camera_setpix(traced.color, traced.error) | traced.verdict;
//#else
    let bytes = 0u;
//#end
//#else
    let bytes = camera_setpix(traced.color) | traced.verdict;
//#end
//#if partial
    if (bytes >= UNDECIDED) & (kept > 0u) & (kept < SAMPLES) {
        let record = atomicAdd(&pixels.partials, 1u);
        if record < job.room {
            let first = job.size.x * job.size.y + record * PARTIAL_WORDS;
            let color = bitcast<vec3u>(part.color);
            let error = bitcast<vec3u>(part.error);
            pixels.words[first] = place;
            pixels.words[first + 1u] = color.x;
            pixels.words[first + 2u] = color.y;
            pixels.words[first + 3u] = color.z;
            pixels.words[first + 4u] = error.x;
            pixels.words[first + 5u] = error.y;
            pixels.words[first + 6u] = error.z;
            for (var i = 0u; i < SUMMED_WORDS; i += 1u) {
                pixels.words[first + 7u + i] = summed[i];
            }
        }
    }
    pixels.words[place] = bytes;
//#else
//#if values
    pixels[place] = vec4u(bitcast<vec3u>(traced.color), bytes);
//#else
    pixels[place] = bytes;
//#end
//#end
}
//#end

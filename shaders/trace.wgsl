// What the lights make of a hit, and the colour that a ray brings. Twin of `ray_trace` without lights, the same in f32
// on the CPU: src/certify/lanes/shade.rs. Referee: src/cpu/trace.rs.

//#if counted
// Iterations of the loops so far, of all samples, the last one of each, which only finds the end, included: the driver may
// end loops early that go round too often (lavapipe counts 65,535 for all loops together, and for all invocations that it
// runs as the lanes of one vector), so a pixel that comes near is handed to the CPU. Loops that go round differently in
// different lanes count for all LANES.
var<private> steps: u32;
const STEPS_LIMIT = 50000u;
//#end
//#if lit

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

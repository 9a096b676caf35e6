// What the lights make of a hit, and the colour that a ray brings. Referee: src/cpu/trace.rs.

//#if counted
// Iterations of the loops so far, of all samples, the last one of each, which only finds the end, included: the driver
// may end loops early that go round too often (lavapipe counts 65,535 for all loops together, and for all invocations
// that it runs as the lanes of one vector), so a pixel that comes near is handed to the CPU. Loops that go round
// differently in different lanes count for all LANES. Those that go on for as long as the path does count once where a
// pixel has one sample, as the lane with the longest path goes along all the way; of several samples each may take
// longest in another lane, and they count APART times.
var<private> steps: u32;
const STEPS_LIMIT = 50000u;
//#end
//#if lit

// What the lights and the light that is everywhere make of a point, seen by a ray.
fn shade(point: Point, seen: SecondaryRay) -> Shade {
    var sum = getamb(point);
    let diffuse = getdiff(point);
    steps += APART;
    for (var i = 0u; i < LIGHTS; i += 1u) {
        steps += APART * (1u + SHADOW_STEPS);
        if steps > STEPS_LIMIT {
            break;
        }
        let term = light_term(i, point, seen, diffuse);
        sum.color += term.color;
        sum.error += term.error + SUM_ROUNDINGS * U * (sum.color + sum.error); //~
    }
    return sum;
}
//#end

// The highest byte of a pixel that the CPU has to decide.
const UNDECIDED = 0xff000000u;

// What a ray brings: 255 times its colour, and 0 or UNDECIDED.
struct Traced {
    color: vec3f,
    error: vec3f, //~
    verdict: u32,
}

//#if partial

// Adds a sample's share to a pixel, if it counts: what a doubtful one brings means nothing.
fn add_sample(sum: ptr<function, Traced>, one: Traced, counts: bool) {
    (*sum).color += select(vec3f(0.0), one.color * SAMPLE_SHARE, counts);
    (*sum).error += select(vec3f(0.0), one.error * SAMPLE_ERROR, counts) + SAMPLE_ROUNDINGS * U * (*sum).color;
}
//#end
//#if any_object
//#if certified

// Whether the primary ray's hit leaves nothing to look at: nothing is met, or it is in doubt what; `traced` then is
// all.
fn hit_decides(traced: ptr<function, Traced>, ray: Ray, hit: Hit) -> bool {
//#if ambient_only
    // So far away that the byte is 0, whatever is hit.
    let dark = max(hit.inverse + hit.error, hit.rival) * ray.inverse_length < DARK;
    var sure = hit.inverse - hit.rival > hit.error;
//#if first_order
    sure &= hit.inverse > FIRST_ORDER * hit.error;
//#end
    if dark | !sure {
        (*traced).verdict = select(UNDECIDED, 0u, dark);
//#if samples
        // Other samples may be brighter: it brings something from 0 to as much as it may be.
        let most = max(hit.inverse + hit.error, hit.rival) * ray.inverse_length * BRIGHT;
        (*traced).color = vec3f(0.5 * most);
        (*traced).error = vec3f(HALF_OPEN * most);
//#end
        return true;
    }
//#else
    let nothing = (hit.inverse + hit.error <= 0.0) & (hit.rival <= 0.0);
    let sure = (hit.inverse - hit.rival > hit.error) & (hit.inverse * ray.inverse_length > LEAST_INVERSE)
        & (hit.inverse > FIRST_ORDER * hit.error);
    if nothing | !sure {
        (*traced).verdict = select(UNDECIDED, 0u, nothing);
        return true;
    }
//#end
    return false;
}
//#end

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
//#if screen_grid
    if !hit.decided {
        traced.verdict = UNDECIDED;
        return traced;
    }
//#end
//#if certified
    if hit_decides(&traced, ray, hit) {
        return traced;
    }
    doubt = false;
//#else
    if !(hit.inverse > 0.0) {
        return traced;
    }
//#end
//#if lit
    let t = ray.w2 * ray.inverse_length / hit.inverse;
    let t_error = t * (SECOND_ORDER * hit.error / hit.inverse + LENGTH_ERROR); //~
//#if branches
    var next_hit: PathPoint;
    next_hit.point = locate(ray, hit);
    next_hit.t = t;
    next_hit.t_error = t_error; //~
//#if mirror
    next_hit.slip = vec2f(next_hit.point.error, next_hit.point.error + t_error); //~
//#end
    follow(&traced, as_secondary_ray(ray), next_hit);
//#else
    let lit = shade(locate(ray, hit), as_secondary_ray(ray));
    let share = CAMERA_GAIN / t;
    traced.color = share * lit.color;
    traced.error = share //~
        * (SECOND_ORDER * lit.error + lit.color * (SECOND_ORDER * t_error / t + SHARE_ROUNDINGS * U)); //~
    doubt |= t < TOTAL_LEAST; //~
//#end
    traced.error += FLUSHED; //~
    if steps > STEPS_LIMIT {
        traced.verdict = UNDECIDED;
    }
//#else
    let ambient = getamb(locate(ray, hit));
    let share = CAMERA_GAIN * ray.inverse_length;
    traced.color = ambient.color * (share * hit.inverse);
//#if certified
    traced.error = ambient.color * (share * (SECOND_ORDER * hit.error + VALUE_ERROR * hit.inverse));
//#if modulated
    traced.error += ambient.error * (SECOND_ORDER * share * hit.inverse);
//#end
//#end
//#end
//#if doubtful
    if doubt {
        traced.verdict = UNDECIDED;
    }
//#end
    return traced;
}
//#end

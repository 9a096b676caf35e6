// The tree of rays that grows behind a primary ray: mirror images, and what is seen through things. Referee:
// src/cpu/tree.rs.

// A ray of the tree.
struct Branch {
    ray: SecondaryRay,
    // Length of the path up to its base; certified, within this of the true length up to the nearest point of the true
    // ray's line, which may lie before the point where that ray starts.
    total: f32,
    total_error: f32, //~
    // The group of surfaces that it left from.
    last: u32,
    // What its colour counts for; certified, by a factor within 1 ± this.
    weight: vec3f,
    weight_error: f32, //~
}

// Where a ray of the tree hit, and how far that is along it.
struct PathPoint {
    point: Point,
    t: f32,
    t_error: f32, //~
//#if mirror
    // What a mirror here adds to the errors of the ray's line and of the path's length.
    slip: vec2f, //~
//#end
}
//#if certified

// Whether every channel of a weight is of ordinary size, or 0 because a factor of it is 0: not because f32 could not
// hold it. That is asked of exponents, since a compiler may take it for granted that no number is too large for f32.
fn ordinary(before: vec3f, factor: vec3f, weight: vec3f) -> bool {
//#if double
    let exponent = (bitcast<vec3u>(vec3<single>(weight)) >> vec3u(23u)) & vec3u(255u);
//#else
    let exponent = (bitcast<vec3u>(weight) >> vec3u(23u)) & vec3u(255u);
//#end
//#if double
    // naga does not fold the conversion of an f64 that it knows.
    let limits = vec2u(vec2f(WEIGHT_LEAST, WEIGHT_MOST) + f32(dispatch.zero));
    let least = limits.x;
    let inside = exponent - vec3u(least) <= vec3u(limits.y - least);
//#else
    let least = u32(WEIGHT_LEAST);
    let inside = exponent - vec3u(least) <= vec3u(u32(WEIGHT_MOST) - least);
//#end
    return all(inside | (before == vec3f(0.0)) | (factor == vec3f(0.0)));
}
//#end
//#if stack

// The mirror rays that wait while another ray is followed. (Not a variable of the function: that made one driver's code
// twice as slow, and its compile time grows with the stack's size.)
var<private> stack: array<Branch, STACK>;
var<private> waiting: u32;
//#end

// Adds what a point brings that a branch ends at; `ended` is the branch with the length of its path up to there.
fn add_shade(traced: ptr<function, Traced>, ended: Branch, kept: f32, lit: Shade) {
    let share = ended.weight * (kept / ended.total * CAMERA_GAIN);
    (*traced).color += share * lit.color;
//#if certified
    let off = SECOND_ORDER * (ended.weight_error + ended.total_error / ended.total);
    (*traced).error += share
        * (lit.error * (SECOND_ORDER + SECOND_ORDER * ended.weight_error) + lit.color * (off + SHARE_ROUNDINGS * U))
        + SUM_ROUNDINGS * U * ((*traced).color + (*traced).error);
//#end
}
//#if mirror

//#if certified
// What a mirror where a ray from anywhere ended adds to the errors of the line and of the path's length.
fn mirror_slip(ray: SecondaryRay, at: PathPoint) -> vec2f {
    let slip = vec2f(at.t * ray.dir_error + BOUNCE_ROUNDINGS * U * (ray.size + at.t));
    // A curved mirror is met elsewhere, at another normal: the new line is known as well as the point.
    let curved = objects[at.point.object].place >= QUADRIC_BIT;
    return select(slip, vec2f(max(at.point.error - ray.base_error, 0.0), at.t_error + at.point.error), curved);
}
//#end

// The mirror image of the ray that ended at a point.
fn mirror_branch(ended: Branch, at: PathPoint, specular: vec3f) -> Branch {
    let point = at.point;
    let along = barrier1(-dot(point.normal, ended.ray.dir));
    var mirror: Branch;
    mirror.ray.base = point.position;
    mirror.total = ended.total;
    mirror.last = point.group;
//#if certified
    mirror.weight = barrier(ended.weight * specular);
    doubt |= !ordinary(ended.weight, specular, mirror.weight);
    mirror.ray.dir = unit_step(barrier(2.0 * along * point.normal + ended.ray.dir));
    mirror.ray.dir_error = MIRROR_GROWTH * ended.ray.dir_error + MIRROR_TURN * point.normal_error
        + MIRROR_ROUNDINGS * U;
    // A mirror is an isometry: how far off the line is does not depend on the angle at which it is met.
    mirror.ray.base_error = (1.0 + LINE_ROUNDINGS * U) * (ended.ray.base_error + at.slip.x);
    mirror.ray.start_error = at.t_error + at.slip.y;
    mirror.ray.size = point.size;
    mirror.total_error = (1.0 + LINE_ROUNDINGS * U) * (ended.total_error + at.slip.y);
    mirror.weight_error = (1.0 + WEIGHT_GROWTH * U) * ended.weight_error + WEIGHT_ROUNDINGS * U;
//#else
    mirror.weight = ended.weight * specular;
    mirror.ray.dir = 2.0 * along * point.normal + ended.ray.dir;
//#end
    return mirror;
}
//#end
//#if transparent

// The ray that goes on behind the point at which a ray ended.
fn through_branch(ended: Branch, at: PathPoint, transparency: f32) -> Branch {
    let point = at.point;
    var through = ended;
    through.last = point.group;
//#if certified
    // It stays on the same line.
    let base = barrier(ended.ray.base + at.t * ended.ray.dir);
    let slip = at.t * ended.ray.dir_error + POSITION_ROUNDINGS * U * (ended.ray.size + at.t);
    through.ray.base = base;
    through.ray.base_error = (1.0 + LINE_ROUNDINGS * U) * (ended.ray.base_error + slip);
    through.ray.start_error = at.t_error + slip;
    through.ray.size = abs(base.x) + abs(base.y) + abs(base.z);
    through.total_error = (1.0 + LINE_ROUNDINGS * U) * (ended.total_error + slip);
    through.weight_error = (1.0 + WEIGHT_GROWTH * U) * ended.weight_error + PANE_WEIGHT_ROUNDINGS * U;
//#else
    through.ray.base = point.position;
//#end
    if transparency > 0.0 {
        let factor = materials[tile_material(point)].tint * transparency;
//#if certified
        through.weight = barrier(ended.weight * factor);
        doubt |= !ordinary(ended.weight, factor, through.weight);
//#else
        through.weight = ended.weight * factor;
//#end
    } else {
        through.weight = vec3f(0.0);
    }
    return through;
}
//#end

// Follows the tree from where the primary ray hit.
fn follow(traced: ptr<function, Traced>, primary: SecondaryRay, first: PathPoint) {
    var at = first;
    var branch: Branch;
    branch.ray = primary;
    branch.last = NOTHING;
    branch.weight = vec3f(1.0);
//#if stack
    waiting = 0u;
//#end
    var rays = 1u;
    loop {
        if steps > STEPS_LIMIT {
            (*traced).verdict = UNDECIDED;
            break;
        }
        steps += 2u * APART;
        let material = materials[objects[at.point.object].material];
        let lit = shade(at.point, branch.ray);
        branch.total += at.t;
        branch.total_error += U * branch.total; //~
        var ended = branch;
        ended.total_error += at.t_error; //~
        add_shade(traced, ended, material.kept, lit);
//#if certified
        if doubt | (FIRST_ORDER * ended.total_error > ended.total) | (ended.total < TOTAL_LEAST) {
            (*traced).verdict = UNDECIDED;
            break;
        }
//#end
        // The rays that go on from here.
//#if mirror
        let mirror = mirror_branch(branch, at, material.specular);
        var mirrors = any(mirror.weight > vec3f(0.0));
//#else
        let mirrors = false;
//#end
//#if transparent
        let through = through_branch(branch, at, material.transparency);
        var passes = any(through.weight > vec3f(0.0));
//#else
        let passes = false;
//#end
//#if certified
        let short = MAX_PATH - branch.total;
        let short_sure = abs(short) > ended.total_error + PATH_ROUNDINGS * U * MAX_PATH;
        if doubt | ((mirrors | passes) & !short_sure) {
            // Whether the path ends here is not certain, or a weight is not known.
            (*traced).verdict = UNDECIDED;
            break;
        }
//#end
        let within = branch.total <= MAX_PATH;
//#if stack
        // What goes through is followed at once; the mirror image waits if both go on.
        mirrors &= within;
        passes &= within;
        if mirrors & passes {
            if waiting == STACK {
                (*traced).verdict = UNDECIDED;
                break;
            }
            stack[waiting] = mirror;
            waiting += 1u;
        }
        branch = mirror;
        if passes {
            branch = through;
        }
        var hit: SecondaryHit;
        hit.object = NOTHING;
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
                (*traced).verdict = UNDECIDED;
                break;
            }
            rays += 1u;
            steps += 2u * LANES;
//#if certified
            hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX, 0.0, 0.0), LANES);
            doubt |= !surely_closest(hit) | (branch.ray.dir_error > DIR_LIMIT);
            if (hit.object != NOTHING) | doubt {
                break;
            }
//#else
            hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX), LANES);
            if hit.object != NOTHING {
                break;
            }
//#end
            follows = false;
        }
//#else
        if !within | !(mirrors | passes) {
            break;
        }
//#if mirror
        branch = mirror;
//#else
        branch = through;
//#end
        if rays == MAX_RAYS {
            (*traced).verdict = UNDECIDED;
            break;
        }
        rays += 1u;
//#if certified
        let hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX, 0.0, 0.0), APART);
        doubt |= !surely_closest(hit) | (branch.ray.dir_error > DIR_LIMIT);
//#else
        let hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX), APART);
//#end
//#end
//#if certified
        if doubt {
            (*traced).verdict = UNDECIDED;
            break;
        }
//#end
        if hit.object == NOTHING {
            break;
        }
        at.point = locate_secondary(branch.ray, hit);
        at.t = hit.t;
        at.t_error = hit.error; //~
//#if mirror
        at.slip = mirror_slip(branch.ray, at); //~
//#end
    }
}

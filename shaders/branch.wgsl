// The tree of rays that grows behind a primary ray: mirror images, and what is seen through things. src/cpu/trace.rs
// decides what is left in doubt here.

// A ray of the tree.
struct Branch {
    ray: SecondaryRay,
    // Length of the path before it.
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
}
//#if certified

// Whether every channel of a weight is of ordinary size, or 0 because a factor of it is 0: not because f32 could not
// hold it. That is asked of exponents, since a compiler may take it for granted that no number is too large for f32.
fn ordinary(before: vec3f, factor: vec3f, weight: vec3f) -> bool {
    let exponent = (bitcast<vec3u>(weight) >> vec3u(23u)) & vec3u(255u);
    let least = u32(WEIGHT_LEAST);
    let inside = exponent - vec3u(least) <= vec3u(u32(WEIGHT_MOST) - least);
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
    (*traced).error += share
        * (lit.error * (1.0 + ended.weight_error)
        + lit.color * (ended.weight_error + SECOND_ORDER * ended.total_error / ended.total + 12.0 * U))
        + 2.0 * U * (*traced).color;
//#end
}
//#if mirror

// The mirror image of the ray that ended at a point.
fn mirror_branch(ended: Branch, point: Point, specular: vec3f) -> Branch {
    let along = -dot(point.normal, ended.ray.dir);
    var mirror: Branch;
    mirror.ray.base = point.position;
    mirror.total = ended.total;
    mirror.last = point.group;
//#if certified
    mirror.weight = barrier(ended.weight * specular);
    doubt |= !ordinary(ended.weight, specular, mirror.weight);
    mirror.ray.dir = barrier(2.0 * along * point.normal + ended.ray.dir);
    mirror.ray.dir_error = SECOND_ORDER * ended.ray.dir_error + 4.04 * point.normal_error + MIRROR_ROUNDINGS * U;
    mirror.ray.base_error = point.error;
    mirror.ray.size = point.size;
    mirror.total_error = ended.total_error;
    mirror.weight_error = ended.weight_error + 2.0 * U;
//#else
    mirror.weight = ended.weight * specular;
    mirror.ray.dir = 2.0 * along * point.normal + ended.ray.dir;
//#end
    return mirror;
}
//#end
//#if transparent

// The ray that goes on behind the point at which a ray ended.
fn through_branch(ended: Branch, point: Point, transparency: f32) -> Branch {
    var through = ended;
    through.ray.base = point.position;
    through.last = point.group;
//#if certified
    through.ray.base_error = point.error;
    through.ray.size = point.size;
    through.weight_error = ended.weight_error + 5.0 * U;
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
        steps += 2u;
        let material = materials[objects[at.point.object].material];
        let lit = shade(at.point, branch.ray);
        branch.total += at.t;
        branch.total_error += at.t_error + U * branch.total; //~
        add_shade(traced, branch, material.kept, lit);
//#if certified
        if doubt | (branch.total_error > 0.01 * branch.total) | (branch.total < TOTAL_LEAST) {
            (*traced).verdict = UNDECIDED;
            break;
        }
//#end
        // The rays that go on from here.
//#if mirror
        let mirror = mirror_branch(branch, at.point, material.specular);
        var mirrors = any(mirror.weight > vec3f(0.0));
//#else
        let mirrors = false;
//#end
//#if transparent
        let through = through_branch(branch, at.point, material.transparency);
        var passes = any(through.weight > vec3f(0.0));
//#else
        let passes = false;
//#end
//#if certified
        let short = MAX_PATH - branch.total;
        let short_sure = abs(short) > branch.total_error + 2.0 * U * MAX_PATH;
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
        let hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX, 0.0, 0.0), 1u);
        doubt |= !surely_closest(hit) | (branch.ray.dir_error > DIR_LIMIT);
//#else
        let hit = closest_hit(branch.ray, Range(branch.last, 0u, 0.0, T_MAX), 1u);
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
    }
}

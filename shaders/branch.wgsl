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
        * (lit.error * (SECOND_ORDER + ended.weight_error)
        + lit.color * (ended.weight_error + SECOND_ORDER * ended.total_error / ended.total + SHARE_ROUNDINGS * U))
        + SUM_ROUNDINGS * U * (*traced).color;
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
    mirror.weight = ended.weight * specular;
//#if certified
    mirror.ray.dir = barrier(2.0 * along * point.normal + ended.ray.dir);
    mirror.ray.dir_error = SECOND_ORDER * ended.ray.dir_error + MIRROR_TURN * point.normal_error + MIRROR_ROUNDINGS * U;
    mirror.ray.base_error = point.error;
    mirror.ray.size = point.size;
    mirror.total_error = ended.total_error;
    mirror.weight_error = ended.weight_error + WEIGHT_ROUNDINGS * U;
//#else
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
    through.weight_error = ended.weight_error + PANE_WEIGHT_ROUNDINGS * U;
//#end
    if transparency > 0.0 {
        through.weight *= materials[tile_material(point)].tint * transparency;
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
        if doubt | (FIRST_ORDER * branch.total_error > branch.total) {
            (*traced).verdict = UNDECIDED;
            break;
        }
        let short = MAX_PATH - branch.total;
        let goes_on = any(branch.weight * material.specular > vec3f(0.0)) | (material.transparency > 0.0);
        if goes_on & !(abs(short) > branch.total_error + PATH_ROUNDINGS * U * MAX_PATH) {
            // Whether the path ends here is not certain.
            (*traced).verdict = UNDECIDED;
            break;
        }
//#end
        // The rays that go on from here.
        let within = branch.total <= MAX_PATH;
//#if stack
        // What goes through is followed at once; the mirror image waits if both go on.
        let mirror = mirror_branch(branch, at.point, material.specular);
        let through = through_branch(branch, at.point, material.transparency);
        let mirrors = any(mirror.weight > vec3f(0.0)) & within;
        let passes = any(through.weight > vec3f(0.0)) & within;
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
//#if mirror
        branch = mirror_branch(branch, at.point, material.specular);
//#else
        branch = through_branch(branch, at.point, material.transparency);
//#end
        if !within | !any(branch.weight > vec3f(0.0)) {
            break;
        }
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

// Quadrics, for rays from anywhere, primary rays among them. Referee: src/cpu/quadric.rs.
//
// About a point C next to a quadric its left side is p·Ap + 2 v·p + k, p = H − C. A line is asked by its direction D and
// the perpendicular p from C to it, as spheres are: with the moment m = p × D the discriminant is
//
//     −m·adj(A)m + 2 m·(AD × v) + (v·D)² − k D·AD,
//
// in which nothing is as large as the two sides of b² − 4ac, whose difference it is.

//#insert struct Quadric

struct QuadricRay {
    base: vec3f,
    // Of unit length.
    dir: vec3f,
//#if certified
    // As in `SecondaryRay`.
    base_error: f32,
    dir_error: f32,
    size: f32,
//#end
}

// How a line passes a quadric.
struct Passage {
    // From C to the line, at right angles, and where along the ray that is.
    perpendicular: vec3f,
    along: f32,
    // Half the gradient there, and how it changes along the line: Ap + v and AD.
    gradient: vec3f,
    turn: vec3f,
//#if certified
    // How far the perpendicular, as a vector, and `along` may be off.
    off: f32,
    // How far `turn` may be off.
    turn_error: f32,
    // How far `gradient` may be.
    gradient_error: f32,
//#end
}

// Rows of a symmetric matrix: its diagonal, then what stands beside it (yz, xz, xy).
fn symmetric(diagonal: vec3f, beside: vec3f, v: vec3f) -> vec3f {
    return vec3f(diagonal.x * v.x + beside.z * v.y + beside.y * v.z,
        beside.z * v.x + diagonal.y * v.y + beside.x * v.z,
        beside.y * v.x + beside.x * v.y + diagonal.z * v.z);
}

fn quadric_passage(quadric: Quadric, ray: QuadricRay) -> Passage {
    var passage: Passage;
    let from_center = barrier(ray.base - quadric.center);
    passage.along = barrier1(-dot(from_center, ray.dir));
    passage.perpendicular = barrier(from_center + passage.along * ray.dir);
    let p = passage.perpendicular;
    passage.gradient = barrier(symmetric(quadric.diagonal, quadric.beside, p) + quadric.slope);
    passage.turn = barrier(symmetric(quadric.diagonal, quadric.beside, ray.dir));
//#if certified
    let far = QUADRIC_FAR * (abs(passage.along) + abs(p.x) + abs(p.y) + abs(p.z));
    passage.off = SECOND_ORDER * ray.base_error + U * quadric.size
        + far * ((TURN + TURN_MORE * ray.dir_error) * ray.dir_error + PERPENDICULAR_ROUNDINGS * U);
    let moved = symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(p)) + abs(quadric.slope);
    passage.gradient_error = quadric.norm * passage.off + GRADIENT_ROUNDINGS * U * (moved.x + moved.y + moved.z);
    passage.turn_error = quadric.norm * (ray.dir_error + GRADIENT_ROUNDINGS * U);
//#end
    return passage;
}

// The roots: where along the ray its line meets the surface, the nearer one first.
struct Roots {
    t: vec2f,
//#if certified
    error: vec2f,
    // Whether there are two roots, for sure; or whether there may be.
    two: bool,
    possible: bool,
    // Whether a root is known no better than that it is farther away from `along` than this, on either side.
    far: vec2<bool>,
    beyond: f32,
    along: f32,
//#else
    two: bool,
//#end
}

fn quadric_roots(quadric: Quadric, ray: QuadricRay) -> Roots {
    var roots: Roots;
    let passage = quadric_passage(quadric, ray);
    let p = passage.perpendicular;
    let e = passage.turn;
    let moment = barrier(cross(p, ray.dir));
    let turned = barrier(symmetric(quadric.adjoint_diagonal, quadric.adjoint_beside, moment));
    let slanted = barrier(cross(e, quadric.slope));
    let slope = dot(quadric.slope, ray.dir);
    let a = barrier1(dot(ray.dir, e));
    let h = barrier1(dot(p, e) + slope);
    let c = barrier1(dot(p, passage.gradient + quadric.slope) + quadric.constant);
    let disc = barrier1(2.0 * dot(moment, slanted) - dot(moment, turned) + slope * slope - quadric.constant * a);
//#if certified
    let u = MOMENT_ROUNDINGS * U;
    let length_p = abs(p.x) + abs(p.y) + abs(p.z);
    let length_v = quadric.slope_size;
    // The moment turns with the line.
    let moment_error = SECOND_ORDER * (passage.off + length_p * ray.dir_error) + MOMENT_ROUNDINGS * U * length_p;
    let size = abs(moment);
    let length_m = size.x + size.y + size.z;
    let all_turned = dot(size, symmetric(abs(quadric.adjoint_diagonal), abs(quadric.adjoint_beside), size));
    let length_turned = abs(turned.x) + abs(turned.y) + abs(turned.z);
    let length_e = abs(e.x) + abs(e.y) + abs(e.z);
    let all_e = dot(abs(ray.dir), symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(ray.dir)));
    let a_error = 2.0 * SECOND_ORDER * length_e * ray.dir_error + quadric.norm * ray.dir_error * ray.dir_error + u * all_e;
    let slope_error = length_v * (ray.dir_error + u);
    let all_p = dot(abs(p), symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(p)));
    let all_h = dot(abs(p), symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(ray.dir)));
    let length_g = abs(passage.gradient.x) + abs(passage.gradient.y) + abs(passage.gradient.z);
    let h_error = SECOND_ORDER * (length_e * passage.off + length_g * ray.dir_error) + u * (all_h + length_v)
        + quadric.norm * passage.off * ray.dir_error;
    let c_error = 2.0 * SECOND_ORDER * length_g * passage.off + quadric.norm * passage.off * passage.off
        + u * (all_p + 2.0 * length_v * length_p + abs(quadric.constant));
    let disc_error = moment_error * (2.0 * SECOND_ORDER * length_turned + quadric.adjoint_norm * moment_error)
        + u * (all_turned + slope * slope + abs(quadric.constant) * all_e)
        + 2.0 * SECOND_ORDER * length_v * (length_e * moment_error + (length_m + moment_error) * (passage.turn_error + u * length_e))
        + slope_error * (2.0 * abs(slope) + slope_error) + abs(quadric.constant) * a_error + TINY_SQUARE;
    roots.two = disc > disc_error;
    roots.possible = disc > -disc_error;
    let least = barrier1(max(disc, disc_error));
    let inverse_root = inverseSqrt(least);
    let root = least * inverse_root;
    let reach_error = root_error(least, disc_error, inverse_root) + ROOT_ROUNDINGS * U * root;
//#else
    roots.two = disc > 0.0;
    let root = sqrt(max(disc, 0.0));
//#end
    // h and the root have the same sign here, so that nothing cancels.
    let sum = barrier1(-(h + select(root, -root, h < 0.0)));
    let first = c / sum;
    let second = sum / a;
//#if certified
    let sum_error = h_error + reach_error + 2.0 * U * abs(sum);
    let first_known = abs(sum) > FIRST_ORDER_ROOT * sum_error;
    let second_known = abs(a) > FIRST_ORDER_ROOT * a_error;
    let first_error = SECOND_ORDER_ROOT * (c_error + abs(first) * sum_error) / abs(sum) + 4.0 * U * abs(first);
    let second_error = SECOND_ORDER_ROOT * (sum_error + abs(second) * a_error) / abs(a) + 4.0 * U * abs(second);
    roots.beyond = max(abs(sum) - sum_error, 0.0) / (abs(a) + a_error) * LOWERED;
    roots.along = passage.along;
    roots.two &= first_known;
    let swap = first > second;
    let values = vec2f(first, select(second, 0.0, !second_known));
    let errors = vec2f(first_error, second_error);
    let rounding = passage.off + 4.0 * U * (abs(passage.along) + abs(values));
    let t = passage.along + values;
    let error = errors + rounding;
    // A root that is not known stands second.
    let change = swap & second_known;
    roots.t = select(t, t.yx, change);
    roots.error = select(error, error.yx, change);
    roots.far = vec2<bool>(!first_known, !second_known);
//#else
    let t = vec2f(passage.along + first, passage.along + second);
    roots.t = vec2f(min(t.x, t.y), max(t.x, t.y));
//#end
    return roots;
}

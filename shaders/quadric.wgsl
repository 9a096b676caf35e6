// Quadrics, for all rays. Referee: src/cpu/quadric.rs.
//
// About a point C next to a quadric its left side is p·Ap + 2 v·p + k, p = H − C. As of a sphere, a line is known by
// its direction D and the perpendicular p from C to it. With the moment m = p × D its discriminant is
//
//     −m·adj(A)m + 2 m·(AD × v) + (v·D)² − k D·AD,
//
// whose terms are not much larger than it: the two sides of b² − 4ac, of which it is the difference, may be.

//#insert struct Quadric

// A ray as quadrics see it.
struct QuadricRay {
    base: vec3f,
    // Of unit length.
    dir: vec3f,
    // Hits count only beyond this.
    start: f32,
//#if certified
    // As in `SecondaryRay`.
    base_error: f32,
    dir_error: f32,
    size: f32,
    // How far `start` may be off.
    start_error: f32,
//#end
}

// How a line passes a quadric.
struct QuadricPassage {
    // From C to the line, at right angles, and where along the ray that is.
    perpendicular: vec3f,
    along: f32,
    // Half the gradient there, and how it changes along the line: Ap + v and AD.
    gradient: vec3f,
    turn: vec3f,
//#if certified
    // How far the perpendicular, as a vector, and `along` may be off; and the others.
    off: f32,
    gradient_error: f32,
    turn_error: f32,
//#end
}

// The product of a symmetric matrix, its diagonal and what stands beside it (yz, xz, xy), with a vector.
fn symmetric(diagonal: vec3f, beside: vec3f, v: vec3f) -> vec3f {
    return vec3f(diagonal.x * v.x + beside.z * v.y + beside.y * v.z,
        beside.z * v.x + diagonal.y * v.y + beside.x * v.z,
        beside.y * v.x + beside.x * v.y + diagonal.z * v.z);
}

fn quadric_passage(quadric: Quadric, ray: QuadricRay) -> QuadricPassage {
    var passage: QuadricPassage;
    let from_center = barrier(ray.base - quadric.center);
    passage.along = barrier1(-dot(from_center, ray.dir));
    passage.perpendicular = barrier(from_center + passage.along * ray.dir);
    let p = passage.perpendicular;
    passage.gradient = barrier(symmetric(quadric.diagonal, quadric.beside, p) + quadric.slope);
    passage.turn = barrier(symmetric(quadric.diagonal, quadric.beside, ray.dir));
//#if certified
    let far = FAR_GROWTH * (abs(passage.along) + sum3(p) + ray.base_error);
    passage.off = SECOND_ORDER * ray.base_error + U * quadric.size
        + far * ((TURN + TURN_MORE * ray.dir_error) * ray.dir_error + PERPENDICULAR_ROUNDINGS * U);
    let moved = symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(p)) + abs(quadric.slope);
    passage.gradient_error = quadric.norm * passage.off + GRADIENT_ROUNDINGS * U * sum3(moved);
    passage.turn_error = quadric.norm * (ray.dir_error + GRADIENT_ROUNDINGS * U);
//#end
    return passage;
}
//#if certified

fn sum3(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// A root: where the line meets the surface.
struct Root {
    t: f32,
    error: f32,
    // Whether it is within the quadric's borders and beyond the ray's start: for sure, or surely not.
    counts: bool,
    out: bool,
}

// What a root comes to.
fn quadric_root(quadric: Quadric, ray: QuadricRay, t: f32, error: f32) -> Root {
    let ahead = t - ray.start;
    let ahead_error = error + ray.start_error;
    let position = ray.base + t * ray.dir;
    let above = position - quadric.lower;
    let below = quadric.upper - position;
    let position_error = SECOND_ORDER * (error + ray.base_error + abs(t) * ray.dir_error)
        + (POSITION_ROUNDINGS + BORDER_ROUNDINGS) * U * (ray.size + abs(t));
    let above_error = position_error + BORDER_ROUNDINGS * U * abs(quadric.lower);
    let below_error = position_error + BORDER_ROUNDINGS * U * abs(quadric.upper);
    var root: Root;
    root.t = t;
    root.error = error;
    root.counts = (ahead > ahead_error) & all(above > above_error) & all(below > below_error)
        & (abs(t) < FARTHEST);
    root.out = (ahead < -ahead_error) | any(above < -above_error) | any(below < -below_error);
    return root;
}
//#end

// Where a ray meets a quadric first.
struct QuadricHit {
    t: f32,
    // For sure, where pixels are certified.
    hit: bool,
//#if certified
    error: f32,
    // Whether it may be met; if so, from `low` to `high`.
    possible: bool,
    low: f32,
    high: f32,
//#end
}

// `light` is where a shadow ray's light lies on the surface, which hides nothing from itself; else before the start.
//#if certified
fn quadric_meets(quadric: Quadric, ray: QuadricRay, light: f32, light_error: f32) -> QuadricHit {
//#else
fn quadric_meets(quadric: Quadric, ray: QuadricRay, light: f32) -> QuadricHit {
//#end
    let passage = quadric_passage(quadric, ray);
    let p = passage.perpendicular;
    let e = passage.turn;
    let g = passage.gradient;
    let k = quadric.constant;
    let moment = barrier(cross(p, ray.dir));
    let turned = barrier(symmetric(quadric.adjoint_diagonal, quadric.adjoint_beside, moment));
    let slanted = barrier(cross(e, quadric.slope));
    let slope = barrier1(dot(quadric.slope, ray.dir));
    let a = barrier1(dot(ray.dir, e));
    let h = barrier1(dot(p, e) + slope);
    let c = barrier1(dot(p, g + quadric.slope) + k);
    let disc = barrier1(2.0 * dot(moment, slanted) - dot(moment, turned) + slope * slope - k * a);
    var met: QuadricHit;
//#if certified
    let u = MOMENT_ROUNDINGS * U;
    let length_p = sum3(p);
    let length_e = sum3(e);
    let length_g = sum3(g);
    let length_v = quadric.slope_size;
    let length_m = sum3(moment);
    let d_error = ray.dir_error;
    // Sums of the terms, none of them negative.
    let all_turned = dot(abs(moment),
        symmetric(abs(quadric.adjoint_diagonal), abs(quadric.adjoint_beside), abs(moment)));
    let along_d = symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(ray.dir));
    let all_a = dot(abs(ray.dir), along_d);
    let all_h = dot(abs(p), along_d) + length_v;
    let all_c = dot(abs(p), symmetric(abs(quadric.diagonal), abs(quadric.beside), abs(p)))
        + 2.0 * length_v * length_p + abs(k);
    let a_error = 2.0 * d_error * (SECOND_ORDER * length_e + quadric.norm * d_error) + u * all_a + LEAST_SLOPE;
    let h_error = SECOND_ORDER * (length_e * passage.off + length_g * d_error)
        + 2.0 * quadric.norm * passage.off * d_error + u * all_h + LEAST_SLOPE;
    let c_error = 2.0 * passage.off * (SECOND_ORDER * length_g + quadric.norm * passage.off) + u * all_c;
    let moment_error = SECOND_ORDER * (passage.off + length_p * d_error) + u * length_p;
    let slope_error = length_v * (d_error + u);
    let disc_error = 2.0 * moment_error * (SECOND_ORDER * sum3(turned) + quadric.adjoint_norm * moment_error)
        + 2.0 * SECOND_ORDER * length_v
            * (length_e * moment_error + (length_m + moment_error) * (passage.turn_error + u * length_e))
        + slope_error * (2.0 * abs(slope) + slope_error) + abs(k) * a_error
        + u * (all_turned + slope * slope + abs(k) * all_a) + TINY_SQUARE
        + QUADRIC_FLUSHED * ((length_m + moment_error + length_e) * (length_m + moment_error));
    let least = barrier1(max(disc, disc_error));
    let inverse_root = inverseSqrt(least);
    let root = least * inverse_root;
    let reach_error = disc_error * inverse_root * select(ROOT_NEAR, ROOT_FAR, least > ROOT_FAR_FROM * disc_error)
        + ROOT_ROUNDINGS * U * root;
    // h and the root have one sign in the sum, so that nothing cancels; in the difference they may.
    let signed = select(root, -root, h < 0.0);
    let sum = barrier1(-(h + signed));
    let sum_error = h_error + reach_error + ROOT_ROUNDINGS * U * abs(sum);
    let sum_known = abs(sum) > QUOTIENT_FROM * sum_error;
    let a_known = abs(a) > QUOTIENT_FROM * a_error;
    let by_sum = 1.0 / select(1.0, sum, sum_known);
    let by_a = 1.0 / select(1.0, a, a_known);
    // The roots are c/sum, which is difference/a, and sum/a.
    let difference = signed - h;
    let other = difference * by_a;
    let other_error = QUOTIENT_GROWTH * (h_error + reach_error + abs(other) * a_error) * abs(by_a)
        + ROOT_ROUNDINGS * U * (abs(other) + (abs(h) + root) * abs(by_a));
    let quotient = c * by_sum;
    let quotient_error = QUOTIENT_GROWTH * (c_error + abs(quotient) * sum_error) * abs(by_sum)
        + ROOT_ROUNDINGS * U * abs(quotient);
    let takes_other = a_known & (!sum_known | (other_error < quotient_error));
    let one = select(quotient, other, takes_other);
    let one_error = select(quotient_error, other_error, takes_other);
    let two = sum * by_a;
    let two_error = QUOTIENT_GROWTH * (sum_error + abs(two) * a_error) * abs(by_a) + ROOT_ROUNDINGS * U * abs(two);
    let along = passage.along;
    let places = barrier(vec3f(along + one, along + two, 0.0));
    let place_errors = vec2f(one_error, two_error) + passage.off
        + DISTANCE_ROUNDINGS * U * (abs(along) + vec2f(abs(one), abs(two)));
    let swap = a_known & (one > two);
    let near = quadric_root(quadric, ray, select(places.x, places.y, swap),
        select(place_errors.x, place_errors.y, swap));
    var far = quadric_root(quadric, ray, select(places.y, places.x, swap),
        select(place_errors.y, place_errors.x, swap));
    var first = near;
    // A light on the surface is one of the roots.
    if light > ray.start {
        let near_apart = abs(near.t - light) > near.error + light_error;
        let far_apart = abs(far.t - light) > far.error + light_error;
        first.out |= !near_apart & far_apart;
        first.counts &= near_apart;
        far.out |= !far_apart & near_apart;
        far.counts &= far_apart;
    }
    met.possible = (disc > -disc_error) & !(first.out & far.out & a_known);
    let second = first.out & a_known;
    met.t = select(first.t, far.t, second);
    met.error = select(first.error, far.error, second);
    met.hit = (disc > disc_error) & select(first.counts, far.counts, second);
    met.low = met.t - met.error;
    met.high = select(far.t + far.error, met.t + met.error, met.hit);
    if !a_known {
        // The other root is far away, before or behind: so far at least.
        let away = max(abs(sum) - sum_error, 0.0) / (abs(a) + a_error) * LOWERED
            - (passage.off + DISTANCE_ROUNDINGS * U * abs(along));
        let behind = (along - away < ray.start - ray.start_error) & sum_known;
        let beyond = along + away;
        met.possible = disc > -disc_error;
        met.hit &= behind & (met.low + 2.0 * met.error < beyond);
        met.low = select(ray.start - ray.start_error, select(min(met.low, beyond), beyond, first.out), behind);
        met.high = select(T_FAR, met.high, met.hit);
    }
//#else
    let root = sqrt(max(disc, 0.0));
    let sum = -(h + select(root, -root, h < 0.0));
    let roots = passage.along + vec2f(select(0.0, c / sum, sum != 0.0), select(T_FAR, sum / a, a != 0.0));
    let near = min(roots.x, roots.y);
    let far = max(roots.x, roots.y);
    let near_counts = quadric_counts(quadric, ray, near) & !is_light(near, light, ray);
    let far_counts = quadric_counts(quadric, ray, far) & !is_light(far, light, ray);
    met.hit = (disc > 0.0) & (near_counts | far_counts);
    met.t = select(far, near, near_counts);
//#end
    return met;
}
//#if certified
//#else

// Whether a root is within the quadric's borders and beyond the ray's start.
fn quadric_counts(quadric: Quadric, ray: QuadricRay, t: f32) -> bool {
    let position = ray.base + t * ray.dir;
    return (t > ray.start) & all(position >= quadric.lower) & all(position <= quadric.upper);
}

// Whether a root is the light that lies on the surface.
fn is_light(t: f32, light: f32, ray: QuadricRay) -> bool {
    return (light > ray.start) & (abs(t - light) < 1e-4 * light);
}
//#end

// More than any distance, and still a number when multiplied by a direction.
const T_FAR = 1e30f;
//#if quadric

// The quadric as a primary ray meets it.
fn quadric_hits(quadric: Quadric, ray: Ray) -> PrimaryIntersection {
    let length = ray.w2 * ray.inverse_length;
    var intersection: PrimaryIntersection;
//#if certified
    let seen = QuadricRay(vec3f(0.0), unit_direction(ray), 0.0, 0.0, DIR_ERROR, 0.0, 0.0);
    let met = quadric_meets(quadric, seen, -1.0, 0.0);
    let limit = NEAREST * length;
    intersection.hit = met.hit & (met.t > FIRST_ORDER * met.error) & (met.t > limit);
    intersection.possible = met.possible;
    // What is not hit for sure may be as near as `low`, or nearer than all else.
    let nearest = max(select(met.low, met.t, intersection.hit), limit);
    let is_closest = !intersection.hit & (met.low < limit);
    intersection.inverse = select(length / nearest, CLOSEST, is_closest);
    intersection.error = intersection.inverse
        * (select(0.0, SECOND_ORDER * met.error / nearest, intersection.hit) + LENGTH_ERROR);
//#else
    let met = quadric_meets(quadric, QuadricRay(vec3f(0.0), ray.w * ray.inverse_length, 0.0), -1.0);
    intersection.hit = met.hit;
    intersection.inverse = length / max(met.t, 1e-30);
//#end
    return intersection;
}
//#end
//#if lit

// The quadric as a ray from anywhere meets it.
fn quadric_hits_from(quadric: Quadric, ray: SecondaryRay, range: Range) -> Intersection {
    let on_surface = (quadric.lights_on_surface & range.light) != 0u;
    let light = select(-1.0, range.limit, on_surface);
    var intersection: Intersection;
//#if certified
    let start_error = select(range.beyond_error, ray.start_error, range.beyond == 0.0);
    let seen = QuadricRay(ray.base, ray.dir, range.beyond, ray.base_error, ray.dir_error, ray.size, start_error);
    let met = quadric_meets(quadric, seen, light, range.limit_error);
    let left = quadric.group == range.skip;
    intersection.t = met.t;
    intersection.error = met.error;
    intersection.hit = met.hit & !left;
    intersection.possible = met.possible & !left;
    intersection.low = met.low;
//#if transparent
    intersection.high = met.high;
//#end
//#else
    let met = quadric_meets(quadric, QuadricRay(ray.base, ray.dir, range.beyond), light);
    intersection.t = met.t;
    intersection.hit = met.hit & (quadric.group != range.skip);
//#end
    return intersection;
}

// The unit normal where a ray meets a quadric at a distance; in the fourth component the bound of its error.
//#if certified
fn quadric_normal(quadric: Quadric, ray: SecondaryRay, t: f32, error: f32) -> vec4f {
    let seen = QuadricRay(ray.base, ray.dir, 0.0, ray.base_error, ray.dir_error, ray.size, 0.0);
//#else
fn quadric_normal(quadric: Quadric, ray: SecondaryRay, t: f32) -> vec4f {
    let seen = QuadricRay(ray.base, ray.dir, 0.0);
//#end
    let passage = quadric_passage(quadric, seen);
    let further = t - passage.along;
    let gradient = barrier(passage.gradient + further * passage.turn);
    let square = dot(gradient, gradient);
    let inverse = barrier1(inverseSqrt(max(square, TINY_SQUARE)));
//#if certified
    let turn = sum3(passage.turn);
    let off = passage.gradient_error + abs(further) * passage.turn_error
        + SECOND_ORDER * turn * (error + passage.off + U * (abs(t) + abs(passage.along)))
        + GRADIENT_ROUNDINGS * U * (sum3(passage.gradient) + abs(further) * turn);
    let share = off * inverse;
    // A gradient that is hardly known has no direction.
    let known = (share * FIRST_ORDER < 1.0) & (square > TINY_SQUARE);
    return vec4f(gradient * inverse, select(2.0, SECOND_ORDER * share + NORMAL_ROUNDINGS * U, known));
//#else
    return vec4f(gradient * inverse, 0.0);
//#end
}
//#end

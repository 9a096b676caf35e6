// Spheres. Referee: src/cpu/sphere.rs.
//#if certified

// What an error in `square`, which is at least that error, is to its root.
fn root_error(square: f32, error: f32, inverse_root: f32) -> f32 {
    return error * inverse_root * select(ROOT_NEAR, ROOT_FAR, square > ROOT_FAR_FROM * error);
}
//#end

//#if sphere
//#insert struct Sphere

// Above 0 where the ray through the pixel `at`, from the sphere's anchor, meets the sphere.
fn sphere_disc(sphere: Sphere, at: vec2f) -> f32 {
    return (sphere.square.x * at.x + sphere.square.y * at.y + sphere.affine.x) * at.x
        + (sphere.square.z * at.y + sphere.affine.y) * at.y + sphere.affine.z;
}

// The sphere as a primary ray meets it; a tangent ray misses.
fn sphere_hits(sphere: Sphere, ray: Ray) -> PrimaryIntersection {
    let at = from_pixel(ray, sphere.anchor);
    let along = sphere.along.x * at.x + sphere.along.y * at.y + sphere.along.z;
    let disc = sphere_disc(sphere, at);
    var intersection: PrimaryIntersection;
//#if certified
    intersection.hit = (disc > sphere.disc_error) & (along > sphere.along_error);
    intersection.possible = (disc > -sphere.disc_error) & (along > -sphere.along_error);
    let least = barrier1(max(disc, sphere.disc_error));
    let inverse_root = inverseSqrt(least);
    intersection.inverse = sphere.gain * (along + least * inverse_root);
    intersection.error = sphere.gain * (sphere.along_error + root_error(least, sphere.disc_error, inverse_root))
        + ROOT_ROUNDINGS * U * abs(intersection.inverse);
//#else
    intersection.hit = (disc > 0.0) & (along > 0.0);
    intersection.inverse = sphere.gain * (along + sqrt(max(disc, 0.0)));
//#end
    return intersection;
}
//#end
//#if sphere_buffer

fn sphere_at(index: u32) -> Sphere {
//#if sphere_point
    return spheres[index].sphere;
//#else
    return spheres[index];
//#end
}
//#end
//#if lit_sphere
//#if certified

// The unit normal that a vector within `error` of it stands for; in its fourth component the bound of its error: that
// of its direction and that of its length together.
fn unit_normal(v: vec3f, error: f32) -> vec4f {
    let off = barrier1(min(error, 1.0));
    // Of a normal that is hardly known none at all says as much: that is off by 1, however large the error is.
    let known = off < 1.0;
    return vec4f(unit_step(select(vec3f(0.0), v, known)),
        select(1.0, off + 2.5 * off * off + UNIT_ROUNDINGS * U, known));
}
//#end
//#end
//#if sphere_point

//#insert struct SphereHit

//#insert struct SphereAndHit

// The unit normal at the hit, outward; in its fourth component the bound of its error.
fn sphere_normal(index: u32, ray: Ray, hit: Hit) -> vec4f {
    let sphere = spheres[index].sphere;
    let point = spheres[index].hit;
    let at = vec3f(from_pixel(ray, sphere.anchor), 1.0);
    let disc = sphere_disc(sphere, at.xy);
    let s = 1.0 / hit.inverse;
//#if certified
    let least = barrier1(max(disc, sphere.disc_error));
    let inverse_root = inverseSqrt(least);
    let root = least * inverse_root;
    let normal =
        barrier((vec3f(dot(point.form_x, at), dot(point.form_y, at), dot(point.form_z, at)) - point.center * root) * s);
    let parts_error = point.form_error
        + point.center_size * (root_error(least, sphere.disc_error, inverse_root) + ROOT_ROUNDINGS * U * root);
    let error = SECOND_ORDER * s * (parts_error + hit.error) + NORMAL_ROUNDINGS * U;
//#if lit
    return unit_normal(normal, error);
//#else
    return vec4f(normal, error);
//#end
//#else
    let root = sqrt(max(disc, 0.0));
    let normal = (vec3f(dot(point.form_x, at), dot(point.form_y, at), dot(point.form_z, at)) - point.center * root) * s;
    return vec4f(normal / sqrt(dot(normal, normal)), 0.0);
//#end
}
//#end
//#if lit

//#insert struct WorldSphere

// How a ray passes a sphere.
struct ClosestApproach {
    // From the ray to the center, at right angles; and its square.
    perpendicular: vec3f,
    apart: f32,
    // Where along the ray that is.
    along: f32,
    // How far the perpendicular, as a vector, and `along` may be off. Where the ray meets the sphere, that is, or seems
    // to: the bound takes the perpendicular for no longer than the radius.
    off: f32, //~
}

fn closest_approach(center: vec3f, radius: f32, size: f32, ray: SecondaryRay) -> ClosestApproach {
    var approach: ClosestApproach;
    let to_center = barrier(center - ray.base);
    approach.along = dot(to_center, ray.dir);
    approach.perpendicular = barrier(to_center - approach.along * ray.dir);
    approach.apart = dot(approach.perpendicular, approach.perpendicular);
//#if certified
    let far = abs(approach.along) + radius + ray.base_error;
    approach.off = SECOND_ORDER * ray.base_error + U * size
        + far * ((TURN + TURN_MORE * ray.dir_error) * ray.dir_error + PERPENDICULAR_ROUNDINGS * U);
//#end
    return approach;
}

// The nearer hit, by the perpendicular from the ray to the center.
fn sphere_hits_from(sphere: WorldSphere, ray: SecondaryRay, range: Range) -> Intersection {
    var intersection: Intersection;
    let approach = closest_approach(sphere.center, sphere.radius, sphere.size, ray);
    let disc = sphere.radius * sphere.radius - approach.apart;
//#if certified
    let disc_error = approach.off * (SQUARE_SLOPE * sphere.radius + approach.off)
        + DISC_ROUNDINGS * U * sphere.radius * sphere.radius;
    let least = barrier1(max(disc, disc_error));
    let inverse_root = inverseSqrt(least);
    let root = least * inverse_root;
    let t = approach.along - root;
    let error = approach.off + root_error(least, disc_error, inverse_root)
        + ROOT_ROUNDINGS * U * (abs(approach.along) + root);
    intersection.t = t;
    intersection.error = error;
    intersection.low = t - error;
//#if transparent
    intersection.high = select(approach.along + approach.off, t + error, disc > disc_error);
//#end
    let start = error + ray.start_error;
    var out = (disc < -disc_error) | (t < -start) | (sphere.group == range.skip);
    intersection.hit = !out & (disc > disc_error) & (t > start);
//#if lights_on_surface
    // From outside, a light on the sphere is where the ray would enter it: at the light, not before; or where it
    // leaves.
    let on_surface = (sphere.lights_on_surface & range.light) != 0u;
    let entry = range.limit - approach.along;
    out |= on_surface & (entry < -(range.limit_error + error));
    intersection.hit &= !on_surface | (entry > range.limit_error + error);
//#end
    intersection.possible = !out;
//#else
    intersection.t = approach.along - sqrt(max(disc, 0.0));
    // From outside, a light on the sphere is where the ray would enter it: at the light, not before.
    let at_light = ((sphere.lights_on_surface & range.light) != 0u) & (range.limit < approach.along);
    intersection.hit = (disc > 0.0) & (approach.along > 0.0) & (intersection.t > 0.0) & (sphere.group != range.skip)
        & !at_light;
//#end
    return intersection;
}
//#end
//#if sphere_beyond

// H − C over the radius, where a ray from anywhere meets the sphere; in the fourth component the bound of its error.
fn sphere_normal_from(sphere: WorldSphere, ray: SecondaryRay) -> vec4f {
    let approach = closest_approach(sphere.center, sphere.radius, sphere.size, ray);
    let disc = sphere.radius * sphere.radius - approach.apart;
//#if certified
    let disc_error = approach.off * (SQUARE_SLOPE * sqrt(approach.apart) + approach.off)
        + DISC_ROUNDINGS * U * sphere.radius * sphere.radius;
    let least = barrier1(max(disc, disc_error));
//#else
    let least = max(disc, TINY_SQUARE);
//#end
    let inverse_root = inverseSqrt(least);
    let root = least * inverse_root;
    let normal = barrier((approach.perpendicular + root * ray.dir) * -sphere.inverse_radius);
//#if certified
    let reach_error = root_error(least, disc_error, inverse_root) + ROOT_ROUNDINGS * U * root;
    let error = SECOND_ORDER * (approach.off + reach_error + root * ray.dir_error);
    return unit_normal(normal, error * sphere.inverse_radius + NORMAL_ROUNDINGS * U);
//#else
    return vec4f(normal, 0.0);
//#end
}
//#end

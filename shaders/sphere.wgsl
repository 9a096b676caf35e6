// Spheres. Twin: src/cpu/sphere.rs, which has one type for both forms.

//#if small_sphere
// A sphere seen small enough that its center's projection onto the screen serves as origin.
struct SmallSphere {
    // e = C/|C|
    toward: vec3f,
    // ρ² = (r/|C|)²
    rho2: f32,
    // |C|/(|C|² − r²)
    gain: f32,
    // |C|
    distance: f32,
    // W − W_c at pixel `anchor`
    offset: vec2f,
    anchor: vec2i,
    object: u32,
    unused: u32,
}

// W − W_c on the screen: how far the ray passes from the projected center.
fn small_sphere_offset(sphere: SmallSphere, ray: Ray) -> vec2f {
    return from_pixel(ray, sphere.anchor) * CAMERA_STEP + sphere.offset;
}

// (r² − |perpendicular|²)·W·W / |C|²: > 0 where the ray's line meets the sphere. Both terms keep their relative accuracy.
fn small_sphere_disc(sphere: SmallSphere, ray: Ray) -> f32 {
    let offset = small_sphere_offset(sphere, ray);
    let turn = sphere.toward.x * offset.y - sphere.toward.y * offset.x;
    return sphere.rho2 * ray.w2 - (sphere.toward.z * sphere.toward.z * dot(offset, offset) + turn * turn);
}

// 1/s of the nearer hit; 0 or less for a miss; a tangent ray misses.
fn small_sphere_hits(sphere: SmallSphere, ray: Ray) -> f32 {
    let along = dot(sphere.toward, ray.w);
    let disc = small_sphere_disc(sphere, ray);
    return select(0.0, sphere.gain * (along + sqrt(max(disc, 0.0))), disc > 0.0 && along > 0.0);
}
//#end
//#if small_sphere_point

// H − C at the nearer hit: s·U + (s/s_c − 1)·C, U = W − W_c; see the twin.
fn small_sphere_from_center(sphere: SmallSphere, ray: Ray, inverse: f32) -> vec3f {
    let offset = small_sphere_offset(sphere, ray);
    let disc = max(small_sphere_disc(sphere, ray), 0.0);
    let to_center = CAMERA_DISTANCE / -sphere.toward.z;
    let nearer = -(to_center * (dot(sphere.toward.xy, offset) + sqrt(disc)) + dot(offset, offset)) / ray.w2;
    return vec3f(offset / inverse, 0.0) + nearer * sphere.distance * sphere.toward;
}
//#end
//#if wide_sphere

// A sphere seen under more than a right angle, or whose center is not on the screen's side.
struct WideSphere {
    // e = C/|C|
    toward: vec3f,
    // κ² = (|C|² − r²)/|C|²
    kappa2: f32,
    // |C|/(|C|² − r²)
    gain: f32,
    // |C|
    distance: f32,
    object: u32,
    unused: u32,
}

// 1/s of the nearer hit; 0 or less for a miss; a tangent ray misses.
fn wide_sphere_hits(sphere: WideSphere, ray: Ray) -> f32 {
    let along = dot(sphere.toward, ray.w);
    let disc = along * along - sphere.kappa2 * ray.w2;
    return select(0.0, sphere.gain * (along + sqrt(max(disc, 0.0))), disc > 0.0 && along > 0.0);
}
//#end
//#if wide_sphere_point

// H − C at the nearer hit.
fn wide_sphere_from_center(sphere: WideSphere, ray: Ray, inverse: f32) -> vec3f {
    return ray.w / inverse - sphere.distance * sphere.toward;
}
//#end
//#if lit

// A sphere for rays from anywhere; its center is from the viewpoint.
struct WorldSphere {
    center: vec3f,
    radius: f32,
    group: u32,
    object: u32,
    // Bit i: light i lies on the sphere.
    level: u32,
    // Its number among the small spheres plus one; 0 for none.
    seen: u32,
}

// t of the nearer hit, by the perpendicular from the center to the ray; 0 for a miss. `dir` is of unit length.
fn sphere_hits_from(sphere: WorldSphere, base: vec3f, dir: vec3f, range: Range) -> f32 {
    let to_center = sphere.center - base;
    let along = dot(to_center, dir);
    let perpendicular = to_center - along * dir;
    let disc = sphere.radius * sphere.radius - dot(perpendicular, perpendicular);
    let t = along - sqrt(max(disc, 0.0));
    // From outside, a light on the sphere is where the ray would enter it: at the light, not before.
    let at_light = (sphere.level & range.light) != 0u && range.limit < along;
    let hit = disc > 0.0 && along > 0.0 && t > range.beyond && t < range.limit && sphere.group != range.skip && !at_light;
    return select(0.0, t, hit);
}
//#end

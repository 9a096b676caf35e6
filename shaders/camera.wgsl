// From a pixel to its ray, from a colour to its bytes. Referee: src/cpu/camera.rs.
//
// `src/lower` writes the same in Rust, for the CPU's f32. In all files a line that ends in //~ is there only where
// pixels are certified: it carries an error bound or asks one. Bounds are derived in docs/NUMERICS.md; U and the
// constants named after what they bound come from the host.

//#if double
// A driver's own function may be as far off as that of f32.
fn inverse_root(square: f32) -> f32 {
    return 1.0 / sqrt(square);
}

// The f64 of two words, the lower half first.
fn double_of(low: u32, high: u32) -> f32 {
    return bitcast<f32>(u64(low) | (u64(high) << 32u));
}

//#end
//#if any_object
// A primary ray: base viewpoint (the origin), direction w through the screen, not of unit length.
struct Ray {
    pixel: vec2i,
//#if samples
    // Where in its pixel the ray passes.
    offset: vec2f,
//#end
    w: vec3f,
    w2: f32,
    // 1/|w|
    inverse_length: f32,
}

// How far the ray passes from the middle of pixel `anchor`, in pixels.
fn from_pixel(ray: Ray, anchor: vec2i) -> vec2f {
//#if samples
    return vec2f(ray.pixel - anchor) + ray.offset;
//#else
    return vec2f(ray.pixel - anchor);
//#end
}

// The ray through a pixel, (0, 0) at the bottom left. Near the viewpoint's own column and row (CAMERA_ANCHOR) w.x and
// w.y are small, and keep their relative accuracy.
//#if samples
fn camera_getdir(pixel: vec2i, offset: vec2f) -> Ray {
    var ray: Ray;
    ray.offset = offset;
//#else
fn camera_getdir(pixel: vec2i) -> Ray {
    var ray: Ray;
//#end
    ray.pixel = pixel;
    ray.w = vec3f(from_pixel(ray, CAMERA_ANCHOR) * CAMERA_STEP + CAMERA_OFFSET, -CAMERA_DISTANCE);
    ray.w2 = dot(ray.w, ray.w);
    ray.inverse_length = inverseSqrt(ray.w2);
    return ray;
}
//#end

// The bytes of a pixel from 255 times its value, truncated; red lowest.
//#if certified
fn camera_setpix(color: vec3f, error: vec3f) -> u32 {
    // Below 1 the byte is 0 and from 255 on it is 255, however far that is.
    let value = clamp(color, vec3f(0.5), vec3f(255.5));
    // Sure where no integer is as near as the bound, or all is above 255.
    let nearest = round(value);
    let decided = (abs(value - nearest) > error) | (color - error > vec3f(255.5));
    // The side of the nearest integer that is certain, not a truncation that the driver may round anew for.
    let bytes = min(vec3u(nearest) - select(vec3u(0u), vec3u(1u), value - nearest < vec3f(0.0)), vec3u(255u));
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | select(UNDECIDED, 0u, all(decided));
}
//#else
fn camera_setpix(color: vec3f) -> u32 {
    let bytes = vec3u(min(color, vec3f(255.0)));
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u);
}
//#end
//#if barrier

// Keeps the compiler from looking through: what stands behind this was rounded as it is, whatever the driver does with
// the rest. `dispatch.zero` is 0, which only the host knows.
//#if certified
//#if double
fn barrier(v: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3<u64>>(v) ^ vec3<u64>(u64(dispatch.zero)));
}
fn barrier1(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u64>(v) ^ u64(dispatch.zero));
}
//#else
fn barrier(v: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(v) ^ vec3u(dispatch.zero));
}
fn barrier1(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(v) ^ dispatch.zero);
}
//#end
//#else
fn barrier(v: vec3f) -> vec3f {
    return v;
}
fn barrier1(v: f32) -> f32 {
    return v;
}
//#end
//#end

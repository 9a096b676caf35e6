// From a pixel to its ray, from a colour to its bytes. Twin: src/cpu/camera.rs.

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
}

// How far the ray passes from the middle of pixel `anchor`, in pixels.
fn from_pixel(ray: Ray, anchor: vec2i) -> vec2f {
//#if samples
    return vec2f(ray.pixel - anchor) + ray.offset;
//#else
    return vec2f(ray.pixel - anchor);
//#end
}

// The ray through a pixel, (0, 0) at the bottom left. Near the viewpoint's own column and row (CAMERA_ANCHOR) w.x and w.y
// are small, and keep their relative accuracy.
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
    return ray;
}
//#if ambient_only

// From a reflectivity to 255 times the pixel's value: 255/t, t = s·|W| in world units.
fn inverse_distance(ray: Ray, inverse: f32) -> f32 {
    return CAMERA_GAIN * inverse / sqrt(ray.w2);
}
//#end
//#end

// The bytes of a pixel from 255 times its value, truncated; red lowest.
fn camera_setpix(color: vec3f) -> u32 {
    let bytes = vec3u(min(color, vec3f(255.0)));
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u);
}
